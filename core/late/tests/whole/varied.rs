//! Parameters that change with time, clocks and densities: the typed steppers to the bit, closed forms, and the orders.

use declarations::FullTop;
use liestep::groups::R3;
use liestep::lagrangian;
use liestep::mechanics::{Effect, Inertia};
use liestep::methods::CompositionScheme;
use liestep::motion::{AnyStepper, Integrator as _, Propagator};
use liestep::with::{Clock, densities};
use liestep::{SO3, StepError, Stepper};
use liestep_late::{Declaration, Varied, Whole};
use nalgebra::{Matrix3, Vector3};

use super::{IDENTITY, top, whole};

/// A vertical that turns and sways.
fn up(time: f64) -> Vector3<f64> {
    Vector3::new((0.7 * time).sin(), 0.3 * (1.1 * time).cos(), 1.0)
}

/// The course of this vertical.
fn upright(whole: &Whole) -> impl Fn(f64, &mut [f64]) + use<> {
    let declaration = whole.declaration();
    move |time, numbers| declaration.set(numbers, "up", up(time).as_slice()).expect("a value")
}

const VELOCITY: [f64; 3] = [0.3, 1.0, 2.0];

/// Compares the motions of two steppers after each step, and half-way to the next.
fn same(found: &impl Propagator, expected: &AnyStepper, steps: u32, tolerance: f64) {
    let mut state = found.start(&IDENTITY, &VELOCITY).expect("a start");
    let mut other = expected.start(&IDENTITY, &VELOCITY).expect("a start");
    let moving = ..found.layout().advected().end;
    let mut worst = 0.0_f64;
    for step in 0..steps {
        assert_eq!(found.step(&mut state), expected.step(&mut other), "step {step}");
        let apart = state[moving].iter().zip(&other.numbers()[moving]).map(|(a, b)| (a - b).abs());
        worst = apart.fold(worst, f64::max);
        let energies = (found.energy(&state) - expected.energy(&other)).abs();
        assert!(energies <= tolerance * 100.0, "step {step}: {energies:e}");
        let times = (found.time(&state) - expected.time(&other)).abs();
        assert!(times <= tolerance * expected.time(&other), "step {step}: {times:e}");
    }
    assert!(worst <= tolerance, "{worst:e}");
}

#[test]
fn turning_values_are_those_of_the_typed_stepper() {
    let whole = whole(0.01, "step");
    let driven = whole.driven(upright(&whole)).expect("a stepper");
    let typed = Stepper::new(top(), 0.01).expect("a stepper").driven(up).into_any();
    same(&driven, &typed, 10_000, 0.0);
    let composed = self::whole(0.05, "composition Suzuki 4");
    let driven = composed.driven(upright(&composed)).expect("a stepper");
    let typed = Stepper::composed(top(), 0.05, CompositionScheme::SUZUKI_4).expect("a stepper").driven(up).into_any();
    same(&driven, &typed, 2_000, 0.0);
    let clock = || Clock::orbit(0.3, 4.0, 400).expect("a clock");
    let by_clock = self::whole(1.0, "step").with_clock(clock());
    let typed = Stepper::new(top(), 1.0).expect("a stepper").with_clock(clock()).into_any();
    same(&by_clock, &typed, 2_000, 0.0);
    let both = by_clock.driven(upright(&whole)).expect("a stepper");
    let typed = Stepper::new(top(), 1.0).expect("a stepper").with_clock(clock()).driven(up).into_any();
    same(&both, &typed, 2_000, 0.0);
    let substeps = self::whole(0.6, "step, substeps 16");
    let by_parts = substeps.driven(upright(&substeps)).expect("a stepper");
    let mut state = by_parts.start(&IDENTITY, &[0.3, 4.0, 2.0]).expect("a start");
    by_parts.run(&mut state, 50).expect("steps in parts");
}

#[test]
fn a_density_is_that_of_the_typed_stepper() {
    let typed = Stepper::new(top(), 0.02).unwrap().with_density(densities::turn(top(), 0.5)).into_any();
    let whole = whole(0.02, "step");
    let varied = whole.turning_evenly(0.5).expect("a stepper");
    same(&varied, &typed, 5_000, 1e-9);
    let lengths = |steps: u32| {
        let mut state = varied.start(&IDENTITY, &VELOCITY).expect("a start");
        (0..steps).map(|_| (varied.length(&state).unwrap(), varied.step(&mut state).unwrap()).0).collect::<Vec<f64>>()
    };
    let all = lengths(1_000);
    let [least, most] = [f64::min as fn(f64, f64) -> f64, f64::max].map(|f| all.iter().copied().reduce(f).unwrap());
    assert!(most > 1.2 * least, "the lengths vary: {least} {most}");
}

/// An oscillator whose mass and stiffness grow as `e^{γt}`, `ẍ + γẋ + ω²x = 0`.
fn oscillator(h: f64, method: &str) -> Varied {
    let text = "#[lagrangian(group = R1, velocity = v, advected(p = fixed), discretise = trapezoid(Cayley),
                l = m * v[0].powi(2) / 2.0 - k * p[0].powi(2) / 2.0)]
                struct Oscillator { m: f64, k: f64, fixed: Point1<f64> }";
    let declaration = Declaration::parse(text).expect("a declaration");
    let numbers = declaration.numbers(&[("m", &[1.0]), ("k", &[4.0]), ("fixed", &[0.0])]).expect("numbers");
    let whole: Whole = Whole::of(declaration, &numbers, h, method.parse().unwrap()).expect("a stepper");
    let course = |time: f64, numbers: &mut [f64]| {
        let growth = (0.4 * time).exp();
        (numbers[0], numbers[1]) = (growth, 4.0 * growth);
    };
    whole.driven(course).expect("a stepper")
}

/// The closed form of the place and of the momentum `e^{γt} ẋ` at a time, from the place 1 at rest.
fn closed(time: f64) -> (f64, f64) {
    let (half, rate) = (0.2, (4.0_f64 - 0.04).sqrt());
    let (sin, cos) = (rate * time).sin_cos();
    let place = (-half * time).exp() * (cos + half / rate * sin);
    (place, -(half * time).exp() * 4.0 / rate * sin)
}

#[test]
fn damping_by_growth_has_its_closed_form() {
    let error = |method: &str, steps: u32| {
        let stepper = oscillator(5.0 / f64::from(steps), method);
        let mut state = stepper.start(&[1.0, 1.0, 0.0, 1.0], &[0.0]).expect("a start");
        stepper.run(&mut state, steps.into()).expect("steps");
        let (place, momentum) = closed(5.0);
        ((state[1] - place).powi(2) + (state[stepper.layout().momentum()][0] - momentum).powi(2)).sqrt()
    };
    for (method, order, tolerance, steps) in
        [("step", 2.0, 0.001, [400, 800]), ("composition Suzuki 4", 4.0, 0.01, [100, 200])]
    {
        let measured = (error(method, steps[0]) / error(method, steps[1])).log2();
        assert!((measured - order).abs() < tolerance, "{method}: {measured}");
    }
    // Energy and velocity are those of the state's time, also within a step.
    let stepper = oscillator(0.05, "composition Kahan-Li 8");
    let mut state = stepper.start(&[1.0, 1.0, 0.0, 1.0], &[0.0]).expect("a start");
    stepper.run(&mut state, 60).expect("steps");
    for fraction in [0.0, 0.3, 1.0, -0.5] {
        let part = stepper.part(&state, fraction).expect("a part");
        let time = 3.0 + 0.05 * fraction;
        let (place, momentum) = closed(time);
        let growth = (0.4 * time).exp();
        let energy = growth * 2.0 * place * place + momentum * momentum / growth / 2.0;
        assert!((stepper.time(&part) - time).abs() < 1e-14, "{fraction}");
        assert!((part[1] - place).abs() < 1e-9, "{fraction}: {} {place}", part[1]);
        assert!((stepper.energy(&part) - energy).abs() < 1e-8, "{fraction}: {} {energy}", stepper.energy(&part));
        let mut velocity = [0.0];
        stepper.velocity(&part, &mut velocity);
        assert!((velocity[0] - momentum / growth).abs() < 1e-9, "{fraction}");
    }
}

/// The end of a step is the part of length one, and a run in stretches has the bits of its steps.
#[test]
fn parts_and_stretches_join_the_steps() {
    for method in ["step", "composition Suzuki 4"] {
        let whole = whole(0.02, method);
        let driven = whole.driven(upright(&whole)).expect("a stepper");
        let mut state = driven.start(&IDENTITY, &VELOCITY).expect("a start");
        driven.run(&mut state, 30).expect("steps");
        let (mut next, mut stretched) = (state.clone(), state.clone());
        let part = driven.part(&state, 1.0).expect("a part");
        driven.step(&mut next).expect("a step");
        let moving = ..driven.layout().advected().end;
        let apart = |one: &[f64], other: &[f64]| {
            one[moving].iter().zip(&other[moving]).fold(0.0_f64, |apart, (a, b)| apart.max((a - b).abs()))
        };
        assert!(apart(&part, &next) < 1e-13, "{method}");
        let back = driven.part(&next, -1.0).expect("a part");
        assert!(apart(&back, &state) < 1e-13, "{method}");
        let mut single = next.clone();
        (0..70).for_each(|_| assert!(driven.step(&mut single).is_ok()));
        let mut stretches = [40, 0].into_iter();
        driven.run_stretches(&mut stretched, 31, &mut |_, _| stretches.next().unwrap_or(0)).expect("steps");
        assert_eq!(stretched, single, "{method}");
    }
}

/// The tilt from upright that a pendulum reaches whose pivot is shaken so that `(aω)²/2gl` has this value, rad.
fn farthest(ratio: f64) -> f64 {
    let declaration = Declaration::parse(FullTop::DECLARATION).expect("a declaration");
    // The moments of inertia about the pivot are 1, 1 and 1/2: the pendulum's length is 1.
    let values: [(&str, &[f64]); 5] = [
        ("J_d", &[0.25, 0.25, 0.75]),
        ("m", &[1.0]),
        ("g", &[1.0]),
        ("rho", &[0.0, 0.0, 1.0]),
        ("up", &[0.0, 0.0, 1.0]),
    ];
    let numbers = declaration.numbers(&values).expect("numbers");
    let (stroke, rate) = (0.1, (2.0 * ratio).sqrt() / 0.1);
    let h = std::f64::consts::TAU / rate / 60.0;
    let whole: Whole = Whole::of(declaration, &numbers, h, "step".parse().unwrap()).expect("a stepper");
    let shaken = whole.driven(move |time: f64, numbers: &mut [f64]| {
        let gravity = 1.0 - stroke * rate * rate * (rate * time).cos();
        declaration.set(numbers, "g", &[gravity]).expect("a value");
    });
    let shaken = shaken.expect("a stepper");
    let (sin, cos) = 0.02_f64.sin_cos();
    let tilted = Matrix3::new(cos, 0.0, sin, 0.0, 1.0, 0.0, -sin, 0.0, cos);
    let mut state = shaken.start(tilted.transpose().as_slice(), &[0.0; 3]).expect("a start");
    let mut farthest = 0.0_f64;
    for _ in 0..15_000 {
        shaken.step(&mut state).expect("a step");
        farthest = farthest.max(state[8].acos());
    }
    farthest
}

/// P. L. Kapitza's pendulum; by Mathieu's equation it stands from `1/(1 − 7 (a/l)²/16)` = 1.0044 on.
#[test]
fn a_shaken_pendulum_stands_upright() {
    let [stands, falls] = [1.032, 0.987].map(farthest);
    assert!(stands < 0.2, "{stands}");
    assert!(falls > 2.0, "{falls}");
}

#[test]
fn values_that_are_none_are_errors() {
    let whole = whole(0.01, "step");
    let set = upright(&whole);
    let driven = whole.driven(move |time: f64, numbers: &mut [f64]| {
        set(time, numbers);
        if time > 0.1 {
            numbers.fill(f64::NAN);
        }
    });
    let driven = driven.expect("a stepper");
    let mut state = driven.start(&IDENTITY, &VELOCITY).expect("a start");
    let error = StepError::NonFinite { what: "value given to the step" };
    assert_eq!(driven.run(&mut state, 20), Err(error.clone()));
    driven.run(&mut state, 9).expect("steps");
    // The memory of the step ahead has no values there.
    let (part, before) = (driven.part(&state, 0.6).expect("a part"), state.clone());
    assert!((driven.time(&part) - 0.096).abs() < 1e-15 && state == before);
    driven.step(&mut state).expect("the last step");
    let before = state.clone();
    assert_eq!((driven.step(&mut state), state), (Err(error), before));
    let layout = StepError::NonFinite { what: "state of this layout" };
    assert_eq!((driven.step(&mut []), driven.run(&mut [1.0], 2)), (Err(layout.clone()), Err(layout)));
    assert!(
        driven.energy(&[]).is_nan()
            && driven.time(&[]).is_nan()
            && driven.adopt(&[]).iter().all(|x| !x.is_finite() || *x <= 1.0)
    );
    let ended = whole.with_clock(Clock::of_lengths([1.0, 2.0]).unwrap());
    let mut state = ended.start(&IDENTITY, &VELOCITY).expect("a start");
    ended.run(&mut state, 2).expect("steps");
    assert!(matches!(ended.step(&mut state), Err(StepError::NoLength { .. })));
    assert!((ended.time(&state) - 0.03).abs() < 1e-15);
    assert!(whole.driven(|_: f64, numbers: &mut [f64]| numbers.fill(f64::NAN)).is_err());
}

/// A top whose steps become shorter where it is low.
#[lagrangian(
    group = SO3,
    advected(w = up),
    given(E_0 = energy),
    pace = 1.0 / (1.0 + w.dot(&rho).powi(2)),
    velocity = Omega,
    l = 0.5 * Omega.dot(&(J * Omega)) - weight * w.dot(&rho),
    discretise = trapezoid(Cayley),
)]
#[derive(Clone, Copy, Debug)]
struct PacedTop {
    J: Inertia,
    weight: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
    energy: f64,
}

/// A point about an attracting centre, whose steps become longer as r³ᐟ².
#[lagrangian(
    group(d = R3),
    velocity = v,
    advected(x = d.seen_from(space)),
    given(E_0 = energy),
    pace = x.norm() * x.norm().sqrt(),
    l = 0.5 * v.norm_squared() + GM / x.norm(),
    discretise = trapezoid,
)]
#[derive(Clone, Copy, Debug)]
struct Orbit {
    GM: f64,
    energy: f64,
}

/// A stepper of a compiled declaration's text.
fn of_text<E: Effect<Scalar = f64>>(effect: &E, h: f64) -> Whole {
    let (declaration, numbers) = Declaration::like(effect).expect("a declaration");
    Whole::of(declaration, &numbers, h, "step".parse().unwrap()).expect("a stepper")
}

#[test]
fn a_pace_is_that_of_the_typed_stepper() {
    let J = Inertia::from_principal_moments(Vector3::new(1.0, 1.5, 2.0)).expect("an inertia");
    let top = PacedTop { J, weight: 3.0, rho: Vector3::new(0.5, 0.2, 1.0), up: Vector3::z(), energy: 0.0 };
    let orbit = Orbit { GM: 1.0, energy: 0.0 };
    // The pericentre of an orbit with the eccentricity 0.8, in the homogeneous coordinates of R3.
    let mut near = [1.0, 0.0, 0.0, 0.2, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let typed_orbit = Stepper::new(orbit, 0.02).and_then(Stepper::paced).expect("a stepper").into_any();
    let typed_top = Stepper::new(top, 0.02).and_then(Stepper::paced).expect("a stepper").into_any();
    for (typed, whole, attitude, velocity) in [
        (typed_top, of_text(&top, 0.02), &IDENTITY[..], VELOCITY),
        (typed_orbit, of_text(&orbit, 0.02), &near[..], [0.0, 3.0, 0.0]),
    ] {
        let paced = whole.paced().expect("a pace");
        let mut state = paced.start(attitude, &velocity).expect("a start");
        let mut other = typed.start(attitude, &velocity).expect("a start");
        let moving = ..paced.layout().advected().end;
        let near = |found: &[f64], expected: &[f64], what: &str| {
            let apart = found.iter().zip(expected).fold(0.0_f64, |apart, (a, b)| apart.max((a - b).abs()));
            assert!(apart < 1e-10, "{what}: {apart:e}");
        };
        for _ in 0..600 {
            paced.step(&mut state).expect("a step");
            typed.step(&mut other).expect("a step");
            near(&state[moving], &other.numbers()[moving], "motion");
            near(&[paced.time(&state)], &[typed.time(&other)], "time");
        }
        near(
            &[paced.energy(&state), paced.length(&state).unwrap()],
            &[typed.energy(&other), typed.length(&other).unwrap()],
            "energy",
        );
        let mut found = [0.0; 3];
        paced.velocity(&state, &mut found);
        near(&found, &typed.velocity(&other), "velocity");
        for fraction in [0.0, 0.4, 1.0] {
            let part = paced.part(&state, fraction).expect("a part");
            near(&part[moving], &typed.part(&other, fraction).expect("a part").numbers()[moving], "part");
        }
    }
    // The end of a round of Kepler's orbit, by its period.
    let period = std::f64::consts::TAU;
    let error = |h: f64| {
        let paced = of_text(&orbit, h).paced().expect("a pace");
        let mut state = paced.start(&near, &[0.0, 3.0, 0.0]).expect("a start");
        while paced.time(&state) + paced.length(&state).unwrap() < period {
            paced.step(&mut state).expect("a step");
        }
        let fraction = (period - paced.time(&state)) / paced.length(&state).unwrap();
        let end = paced.part(&state, fraction).expect("a part");
        assert!((paced.time(&end) - period).abs() < 1e-12);
        ((end[3] - 0.2).powi(2) + end[7].powi(2)).sqrt()
    };
    let order = (error(0.02) / error(0.01)).log2();
    assert!((order - 2.0).abs() < 0.05, "{order}");
    near[3] = f64::NAN;
    let paced = of_text(&orbit, 0.02).paced().expect("a pace");
    assert!(paced.start(&near, &[0.0; 3]).is_err() && paced.step(&mut []).is_err() && paced.energy(&[]).is_nan());
    assert!(whole(0.01, "step").paced().is_err());
}
