//! Several tops at once in SIMD lanes: each lane is, bit for bit, a top of its own.

use checks::any_scalar::Top;
use checks::random::Random;
use liestep::methods::CompositionScheme;
use liestep::motion::{Batch, Batchable, Integrator};
use liestep::numbers::{Lanes, Real};
use liestep::prelude::*;
use nalgebra::{Matrix3, RealField, SimdValue, UnitQuaternion, Vector3};
use simba::simd::{AutoF64x8, WideF32x8, WideF64x4};

/// One lane: a body, its attitude and its initial velocity.
#[derive(Clone)]
struct Lane<E: Real> {
    top: Top<E>,
    attitude: SO3<E>,
    velocity: Vector3<E>,
}

fn lane<E: Real + RealField>(random: &mut Random, speed: f64) -> Lane<E> {
    let vector = |v: Vector3<f64>| v.map(nalgebra::convert::<f64, E>);
    let moments = Vector3::new(2.5, 3.0, 4.0) + random.vector() * 0.4;
    let top = Top {
        J_d: DiagonalNonstandardInertia::from_principal_moments(vector(moments)).unwrap(),
        weight: nalgebra::convert(9.81 + random.signed()),
        rho: vector(random.vector()),
        up: Vector3::z(),
    };
    let attitude = UnitQuaternion::from_scaled_axis(vector(random.vector())).into();
    Lane { top, attitude, velocity: vector(random.direction() * speed) }
}

type TopRun<T> = (Stepper<Top<T>>, liestep::State<SO3<T>, Vector3<T>>);

fn start<T: Real>(top: Top<T>, h: f64, attitude: SO3<T>, velocity: Vector3<T>) -> TopRun<T> {
    let stepper = Stepper::new(top, nalgebra::convert(h)).unwrap();
    let state = stepper.start(attitude, velocity).unwrap();
    (stepper, state)
}

fn together<T: LaneScalar>(lanes: &[Lane<T::Element>], h: f64) -> TopRun<T> {
    let top = Top::gathered(&of_each(lanes, |lane| lane.top)).unwrap();
    let attitude = SO3::gathered(&of_each(lanes, |lane| lane.attitude)).unwrap();
    start(top, h, attitude, Vector3::gathered(&of_each(lanes, |lane| lane.velocity)).unwrap())
}

fn alone<T: LaneScalar>(lanes: &[Lane<T::Element>], h: f64) -> Vec<TopRun<T::Element>> {
    of_each(lanes, |lane| start(lane.top, h, lane.attitude, lane.velocity))
}

fn of_each<L, V>(lanes: &[L], value: impl Fn(&L) -> V) -> Vec<V> {
    lanes.iter().map(value).collect()
}

/// The scalar of several lanes.
trait LaneScalar: Real<Element: Real + RealField> {}

impl<T: Real<Element: Real + RealField>> LaneScalar for T {}

/// Compares each lane with a scalar run after every step; returns how often the lanes' iteration counts differed.
fn assert_independent<T: LaneScalar>(lanes: &[Lane<T::Element>], h: f64, steps: u32) -> u32 {
    let (stepper, mut state) = together::<T>(lanes, h);
    let mut singles = alone::<T>(lanes, h);
    let mut unequal = 0;
    for step in 0..steps {
        let report = stepper.step(&mut state).unwrap();
        let counted = singles.iter_mut().map(|(stepper, state)| stepper.step(state).unwrap().iterations);
        let iterations: Vec<u32> = counted.collect();
        unequal += u32::from(iterations.iter().any(|count| *count != iterations[0]));
        assert_eq!(report.iterations, iterations.into_iter().max().unwrap(), "step {step}");
        for (k, (_, single)) in singles.iter().enumerate() {
            assert_eq!(state.lane(k), *single, "step {step}, lane {k}");
        }
    }
    unequal
}

/// Lanes from slow to fast, so that they need unequal numbers of iterations.
#[allow(clippy::cast_precision_loss)] // a lane's number
fn spread<E: Real + RealField, const N: usize>(seed: u64, fastest: f64) -> [Lane<E>; N] {
    let mut random = Random::new(seed);
    core::array::from_fn(|k| lane(&mut random, fastest * 0.01_f64.powf(k as f64 / (N - 1) as f64)))
}

#[test]
fn each_lane_moves_as_alone() {
    let unequal = [
        assert_independent::<WideF64x4>(&spread::<_, 4>(1, 32.0), 0.01, 2000),
        assert_independent::<AutoF64x8>(&spread::<_, 8>(2, 32.0), 0.01, 2000),
        assert_independent::<WideF32x8>(&spread::<_, 8>(3, 6.0), 0.1, 2000),
    ];
    assert!(unequal.iter().all(|&steps| steps > 100), "{unequal:?}");
}

/// Steps of higher order and with compensated sums, which are compiled for the machine's instructions as well.
#[test]
fn composed_and_compensated_lanes_move_as_alone() {
    let lanes: [Lane<f64>; 8] = spread(12, 16.0);
    let composed = |(stepper, state): TopRun<f64>| {
        let composition = Stepper::composed(*stepper.scene(), 0.01, CompositionScheme::SUZUKI_4).unwrap();
        let state = composition.adopt(&state);
        (composition, state)
    };
    let (wide, all) = together::<AutoF64x8>(&lanes, 0.01);
    let step = wide.step_size();
    let wide_composition = Stepper::composed(*wide.scene(), step, CompositionScheme::SUZUKI_4).unwrap();
    let wide = wide.compensated();
    let (mut all, mut compensated_all) = (wide_composition.adopt(&all), wide.adopt(&all));
    let mut compositions: Vec<_> = alone::<AutoF64x8>(&lanes, 0.01).into_iter().map(composed).collect();
    let mut singles = of_each(&alone::<AutoF64x8>(&lanes, 0.01), |(stepper, state)| {
        let carrying = stepper.clone().compensated();
        let state = carrying.adopt(state);
        (carrying, state)
    });
    for number in 0..1500 {
        wide_composition.step(&mut all).unwrap();
        wide.step(&mut compensated_all).unwrap();
        for (k, ((composition, one), (single, compensated))) in compositions.iter_mut().zip(&mut singles).enumerate() {
            composition.step(one).unwrap();
            single.step(compensated).unwrap();
            assert_eq!(all.lane(k), *one, "step {number}, lane {k}");
            assert_eq!(compensated_all.lane(k), *compensated, "step {number}, lane {k}");
        }
    }
}

/// Upright tops, one in each lane, each tilted `times` as much as the one before.
fn spinning(times: f64) -> [Lane<f64>; 8] {
    let mut random = Random::new(10);
    let mut tilt = 1e-12;
    core::array::from_fn(|_| {
        let mut lane: Lane<f64> = lane(&mut random, 0.0);
        lane.top.J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0)).unwrap();
        lane.top.rho = Vector3::z();
        lane.attitude = UnitQuaternion::from_scaled_axis(random.direction() * tilt).into();
        lane.velocity = Vector3::z() * 10.0;
        tilt *= times;
        lane
    })
}

/// One iteration suffices for tops that nearly sleep: they wait while others take their second, or in another ensemble
/// also their third.
#[test]
fn lanes_that_have_settled_wait_for_others() {
    for (times, h, most) in [(20.0, 0.02, 2), (40.0, 0.06, 3)] {
        let lanes = spinning(times);
        let unequal = assert_independent::<AutoF64x8>(&lanes, h, 500);
        let iterations = of_each(&alone::<AutoF64x8>(&lanes, h), |(stepper, state)| {
            let mut state = *state;
            let reports = (0..500).map(|_| stepper.step(&mut state).unwrap().iterations);
            reports.skip(10).max().unwrap()
        });
        assert!(unequal > 400, "{unequal} {iterations:?}");
        assert_eq!((iterations[0], iterations[7]), (1, most), "{iterations:?}");
    }
}

/// A lane that turns by some 70° a step doesn't extrapolate; the others still do.
#[test]
fn a_lane_near_a_quarter_turn_changes_no_other() {
    let mut lanes: [Lane<f64>; 4] = spread(8, 4.0);
    lanes[1].top.J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0)).unwrap();
    lanes[1].top.weight = 0.01;
    lanes[1].velocity = Vector3::z() * 9.5;
    assert_independent::<WideF64x4>(&lanes, 0.1, 200);
}

/// A guess on another branch restarts only its own lane from the identity.
#[test]
fn a_lane_with_a_bad_guess_changes_no_other() {
    let lanes: [Lane<f64>; 4] = spread(4, 32.0);
    let (stepper, state) = together::<WideF64x4>(&lanes, 0.01);
    let singles = alone::<WideF64x4>(&lanes, 0.01);
    let mut random = Random::new(5);
    let mut anew = 0;
    for _ in 0..100 {
        // Cayley coordinates of turns up to 175°.
        let bad = random.vector() * 50.0;
        let guess = |k: usize| if k == 0 { bad } else { lanes[k].velocity * 0.01 };
        let guesses = Vector3::gathered(&[0, 1, 2, 3].map(guess)).unwrap();
        let wide = stepper.flow().step(&state.momentum(), &state.advected(), &guesses).unwrap();
        for (k, (stepper, state)) in singles.iter().enumerate() {
            let single = stepper.flow().step(&state.momentum(), &state.advected(), &guess(k)).unwrap();
            assert_eq!(wide.coordinates.lane(k), single.coordinates, "lane {k}, guess {bad}");
            assert_eq!(wide.momentum.lane(k), single.momentum, "lane {k}, guess {bad}");
            assert!(k == 0 || single.iterations < 10);
            anew += u32::from(single.iterations > 20);
        }
    }
    assert!(anew >= 10, "{anew}");
}

/// If one lane has no solution, no lane moves.
#[test]
fn an_unsolvable_lane_leaves_all_as_they_were() {
    let mut lanes: [Lane<f64>; 4] = spread(6, 32.0);
    lanes[1].velocity = Vector3::new(20.0, 20.0, 300.0);
    let (stepper, mut state) = together::<WideF64x4>(&lanes, 0.01);
    let before = state;
    let refused = stepper.step(&mut state);
    assert!(
        matches!(refused, Err(StepError::BeyondSolvable { step, largest, .. }) if largest > 0.0 && largest < step),
        "{refused:?}"
    );
    assert_eq!(state, before);
    // The other lanes move if that lane has a solution.
    lanes[1].velocity = Vector3::x();
    assert_independent::<WideF64x4>(&lanes, 0.01, 10);
}

/// Input that is invalid in one lane is refused for all.
#[test]
fn a_lane_that_is_not_finite_is_refused() {
    let lanes: [Lane<f64>; 4] = spread(7, 32.0);
    let (stepper, state) = together::<WideF64x4>(&lanes, 0.01);
    let mut momentum = state.momentum();
    momentum.x.replace(3, f64::NAN);
    assert!(stepper.start_with_momentum(state.attitude(), momentum).is_err());
    let mut attitude = *state.attitude().as_matrix();
    attitude.m11.replace(2, 0.0);
    assert!(stepper.start_with_momentum(SO3::from_matrix_unchecked(attitude), state.momentum()).is_err());
    let top = *stepper.scene();
    for bad in [0.0, f64::NAN] {
        assert!(Stepper::new(top, WideF64x4::from([0.01, 0.01, bad, 0.01])).is_err(), "{bad}");
    }
}

/// Steppers and states that are constructed singly, gathered, and separated again, one of them through a file.
#[test]
fn lanes_are_put_together_and_taken_apart_on_the_way() {
    let lanes: [Lane<f64>; 8] = spread(13, 32.0);
    let mut singles = alone::<AutoF64x8>(&lanes, 0.01);
    let run = |singles: &mut [TopRun<f64>], steps| {
        for (stepper, state) in singles {
            stepper.run(state, steps).unwrap();
        }
    };
    run(&mut singles, 37);
    let stepper: Stepper<Top<AutoF64x8>> = Lanes::gathered(&of_each(&singles, |single| single.0.clone())).unwrap();
    let mut state: liestep::State<SO3<AutoF64x8>, Vector3<AutoF64x8>> =
        Lanes::gathered(&of_each(&singles, |single| single.1)).unwrap();
    stepper.run(&mut state, 50).unwrap();
    let taken = stepper.lane(3);
    let stored = serde_json::to_string(&taken.checkpoint(&state.lane(3))).unwrap();
    let resumed = taken.resume(&serde_json::from_str(&stored).unwrap()).unwrap();
    state = Lanes::splat(&state.lane(0));
    run(&mut singles, 50);
    for (k, (_, single)) in singles.iter().enumerate() {
        assert!(state.set_lane(k, if k == 3 { &resumed } else { single }));
    }
    stepper.run(&mut state, 50).unwrap();
    run(&mut singles, 50);
    for (k, (_, single)) in singles.iter().enumerate() {
        assert_eq!(state.lane(k), *single, "lane {k}");
    }
    // All lanes have the same number of steps.
    run(&mut singles[..1], 1);
    assert!(!state.set_lane(0, &singles[0].1));
}

/// Bodies that stop, each at its own step: all have the same bits as alone.
fn assert_stops<M>(bodies: &[(M, M::State)], pieces: [u64; 3], stopped: &[usize])
where
    M: Batchable<WideF64x4, State: PartialEq + core::fmt::Debug>,
{
    let mut batch = Batch::<WideF64x4, M>::new(bodies).unwrap();
    let mut alone: Vec<(M::State, Option<StepError>)> = of_each(bodies, |body| (body.1.clone(), None));
    for steps in pieces {
        batch.run(steps);
        for ((stepper, _), (state, error)) in bodies.iter().zip(&mut alone) {
            for _ in 0..steps {
                if error.is_none() {
                    *error = Integrator::step(stepper, state).err();
                }
            }
        }
    }
    for (k, (state, error)) in alone.iter().enumerate() {
        assert_eq!(batch.state(k), *state, "body {k}");
        assert_eq!(batch.error(k), error.as_ref(), "body {k}");
        assert_eq!(error.is_some(), stopped.contains(&k), "body {k}: {error:?}");
    }
}

/// Tops, every other of which is so heavy that it soon falls too fast for a step of 0.02 s.
fn failing(seed: u64, count: u32) -> Vec<Lane<f64>> {
    let mut random = Random::new(seed);
    let tops = (0..count).map(|number| {
        let mut lane: Lane<f64> = lane(&mut random, 2.0);
        lane.top.rho = Vector3::z();
        if number % 2 == 1 {
            lane.top.weight = 1.5e4 * f64::from(number);
        }
        lane
    });
    tops.collect()
}

#[test]
fn a_lane_that_fails_stops_and_the_others_go_on() {
    let lanes = failing(14, 4);
    let declared = alone::<WideF64x4>(&lanes, 0.02);
    assert_stops(&declared, [5, 40, 300], &[1, 3]);
    let compensated = of_each(&declared, |(stepper, state)| {
        let compensated = stepper.clone().compensated();
        let state = compensated.adopt(state);
        (compensated, state)
    });
    assert_stops(&compensated, [5, 40, 300], &[1, 3]);
    let composed = of_each(&declared, |(stepper, state)| {
        let composed = Stepper::composed(*stepper.scene(), 0.02, CompositionScheme::SUZUKI_4).unwrap();
        let state = composed.adopt(state);
        (composed, state)
    });
    assert_stops(&composed, [5, 40, 300], &[1, 3]);
    // Batches with fewer bodies than lanes, with one body, and with bodies that all stop.
    assert_stops(&declared[..3], [5, 40, 300], &[1]);
    assert_stops(&declared[2..3], [5, 40, 300], &[]);
    assert_stops(&declared[1..2], [5, 40, 300], &[0]);
}

#[test]
fn bodies_that_are_unlike_are_refused_by_their_lane() {
    let lanes: [Lane<f64>; 4] = spread(15, 4.0);
    let mut bodies = alone::<WideF64x4>(&lanes, 0.01);
    let (stepper, state) = &mut bodies[2];
    stepper.step(state).unwrap();
    let refused = |bodies: &[TopRun<f64>]| Batch::<WideF64x4, _>::new(bodies).map(drop).unwrap_err();
    assert_eq!(refused(&bodies), SetupError::Unlike { lane: 2 });
    assert_eq!(refused(&[]), SetupError::Unlike { lane: 0 });
}

/// The logarithmic kinetic term of Bobenko and Suris, with a spring and an oscillating field.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = -(2.0 * k / h) * ((1.0 + F.trace()) / 4.0).ln()
        - 0.5 * h * ((w - rho).norm() + (F * rho - w).norm() + k * w.dot(&(F * rho)).sin()),
)]
struct LogarithmicTerm<T: Real> {
    k: T,
    rho: Vector3<T>,
    up: Vector3<T>,
}

fn smooth<T: Real>(k: T, rho: Vector3<T>, velocity: Vector3<T>) -> (Matrix3<T>, Vector3<T>) {
    let stepper = Stepper::new(LogarithmicTerm { k, rho, up: Vector3::z() }, nalgebra::convert(0.01)).unwrap();
    let mut state = stepper.start(SO3::identity(), velocity).unwrap();
    for _ in 0..100 {
        stepper.step(&mut state).unwrap();
    }
    (*state.attitude().as_matrix(), state.momentum())
}

/// Lanes have a sine of their own, so here they agree to rounding only.
#[test]
fn smooth_functions_in_lanes() {
    let mut random = Random::new(9);
    let k = [1.0, 1.5, 2.0, 3.0];
    let (rho, velocity) = (k.map(|_| random.vector()), k.map(|k| random.direction() * 4.0 / k));
    let wide = smooth(WideF64x4::from(k), Vector3::gathered(&rho).unwrap(), Vector3::gathered(&velocity).unwrap());
    for lane in 0..4 {
        let (attitude, momentum) = smooth(k[lane], rho[lane], velocity[lane]);
        // The bound is the rounding of a hundred steps.
        assert!((wide.0.lane(lane) - attitude).norm() < 1e-13, "lane {lane}");
        assert!((wide.1.lane(lane) - momentum).norm() < 1e-13 * momentum.norm(), "lane {lane}");
    }
}
