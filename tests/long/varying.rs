//! Steps of different lengths: single ones, those of a clock, and those of a density.

use core::f64::consts::TAU;

use liestep::effects::GravityGradient;
use liestep::groups::{Advected, LieGroup, R3};
use liestep::mechanics::{Each, Effect, LeftInvariant, Pairs, Sum};
use liestep::methods::{Chain, CompositionScheme, ExactBody, Flow, Link, SplittingScheme};
use liestep::motion::{Integrator as _, Motion as At, Variable};
use liestep::numbers::{Bodies, Entries as _};
use liestep::prelude::*;
use liestep::recording::{Event, Frames, Reason};
use liestep::with::{Clock, densities};
use nalgebra::Vector6;

fn disc() -> NonstandardInertia {
    NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap()
}

/// A top whose tip makes loops.
fn top() -> (Top, SO3, Vector3<f64>) {
    let top = RigidBody { J_d: disc() } + Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    (top, SO3::from_euler_angles(0.8, 0.1, 0.0), Vector3::new(0.5, 2.0, 12.0))
}

type Top = Sum<RigidBody, Gravity>;

/// A rigid body with its weight, one of several.
#[lagrangian(
    group(F = SO3, d = R3),
    advected(x = d.seen_from(space)),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
        - 0.5 * h * m * g * (x + x + d).dot(&up),
)]
#[derive(Clone, Copy, Debug)]
struct FallingBody {
    m: f64,
    J_d: NonstandardInertia,
    g: f64,
    up: Vector3<f64>,
}

/// The attraction between points of two bodies, as of unit masses there.
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    l_d = 0.5 * h * (1.0 / (r + R_2 * b - R_1 * a).norm() + 1.0 / (r + d_2 - d_1 + R_2 * F_2 * b - R_1 * F_1 * a).norm()),
)]
#[derive(Clone, Copy, Debug)]
struct Attraction {
    a: Vector3<f64>,
    b: Vector3<f64>,
}

/// The distance of two motions.
fn apart<G: LieGroup<Scalar = f64>, A: Advected<G>>(a: &At<G, A>, b: &At<G, A>) -> f64 {
    let [a, b] = [a, b].map(|motion| {
        let mut all = Vec::new();
        motion.attitude().matrix().each(&mut |number| all.push(number));
        motion.momentum().each(&mut |number| all.push(number));
        all
    });
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Checks that `step_of` makes the steps of a stepper of that length, a clock the steps of its lengths, and that a
/// reversed clock returns to the start, as `−h` does.
fn assert_varies<S, P>(name: &str, make: impl Fn(f64) -> Stepper<S, P>, start: liestep::StateOf<S, P>)
where
    S: Effect<Scalar = f64>,
    P: Variable<S> + Clone,
{
    let (h, stepper) = (0.01, make(0.01));
    let (mut one, mut other) = (start, start);
    stepper.run(&mut one, 3).unwrap();
    other = stepper.steps(other).take(3).last().unwrap().unwrap();
    stepper.step(&mut one).unwrap();
    stepper.step_of(&mut other, h).unwrap();
    assert!(apart(&one, &other) < 1e-12, "{name}: {:e}", apart(&one, &other));
    assert_eq!((other.steps(), stepper.time(&other)), (3, 3.0 * h + h));
    let (before, short) = (other, make(0.3 * h));
    let mut expected = short.adopt(&other);
    short.step(&mut expected).unwrap();
    stepper.step_of(&mut other, 0.3 * h).unwrap();
    assert!(apart(&other, &expected) < 1e-12, "{name}: {:e}", apart(&other, &expected));
    stepper.step_of(&mut other, -0.3 * h).unwrap();
    assert!(apart(&other, &before) < 1e-11, "{name}: {:e}", apart(&other, &before));
    let refused = stepper.step_of(&mut other, f64::NAN).unwrap_err();
    assert_eq!(refused, StepError::NonFinite { what: "length of the step" });
    assert!(stepper.step_of(&mut other, 1e300).is_err());

    let clock = Clock::orbit(0.6, 40.0, 40).unwrap();
    let timed = make(h).with_clock(clock.clone());
    let (mut state, mut by_hand) = (timed.adopt(&start), start);
    timed.run(&mut state, 60).unwrap();
    let mut last = 0.0;
    for k in 1..=60 {
        let now = h * clock.time(k);
        stepper.step_of(&mut by_hand, now - last).unwrap();
        last = now;
    }
    assert!((timed.time(&state) - last).abs() < 1e-15 && last > 0.4);
    assert!(apart(&state, &by_hand) < 1e-10, "{name}: {:e}", apart(&state, &by_hand));
    let back = make(-h).with_clock(clock.reversed(60).unwrap());
    let mut returned = back.adopt(&state);
    back.run(&mut returned, 60).unwrap();
    assert!(apart(&returned, &start) < 1e-10, "{name}: {:e}", apart(&returned, &start));
    assert!((back.time(&returned) + last).abs() < 1e-14);
}

#[test]
fn any_method_varies() {
    let (scene, attitude, velocity) = top();
    let flow = ExactBody::new(&disc().to_inertia());
    let own = |h: f64| Stepper::new(scene, h).unwrap();
    let composed = |h: f64| Stepper::composed(scene, h, CompositionScheme::SUZUKI_4).unwrap();
    let split = |h: f64| Stepper::split(scene, h, flow, SplittingScheme::STRANG).unwrap();
    let gauss = |h: f64| Stepper::collocated::<2>(scene, h).unwrap();
    assert_varies("own", own, own(0.01).start(attitude, velocity).unwrap());
    let carried = |h: f64| own(h).or_substeps(4).compensated();
    assert_varies("compensated", carried, carried(0.01).start(attitude, velocity).unwrap());
    assert_varies("composed", composed, composed(0.01).start(attitude, velocity).unwrap());
    assert_varies("split", split, split(0.01).start(attitude, velocity).unwrap());
    assert_varies("Gauss", gauss, gauss(0.01).start(attitude, velocity).unwrap());

    let J_d = NonstandardInertia::from_diagonal(Vector3::new(0.1, 0.2, 0.3)).unwrap();
    let (c, up) = (-Vector3::z() * 0.5, Vector3::z());
    let chain = Chain { links: [Link { J_d, m: 1.0, c, rho: c * 2.0 }; 3], g: 9.81, up };
    let start = chain.stepper(0.01).unwrap().start([SO3::from_euler_angles(0.2, 1.0, 0.0); 3], Bodies([up * 0.2; 3]));
    assert_varies("chain", |h| chain.stepper(h).unwrap(), start.unwrap());
}

/// The time of a motion is the sum of the lengths, for single steps and those of a clock, in records, between steps,
/// and in checkpoints.
#[test]
fn time_is_that_of_the_lengths() {
    let (scene, attitude, velocity) = top();
    let stepper = Stepper::new(scene, 0.01).unwrap();
    let mut state = stepper.start(attitude, velocity).unwrap();
    stepper.step_of(&mut state, 0.0037).unwrap();
    assert_eq!(stepper.resume(&stepper.checkpoint(&state)).unwrap(), state);
    let mut times = Vec::new();
    let ended = stepper.observed(&mut state).every(1, |now| times.push(now.time())).until(0.0537).unwrap();
    assert_eq!(ended.steps, 5);
    assert!(times.iter().zip(0..).all(|(t, k)| (t - 0.0037 - 0.01 * f64::from(k)).abs() < 1e-16), "{times:?}");
    assert!(apart(&stepper.state_at(&state, 0.0537).unwrap(), &state) < 1e-13);
    let any = stepper.clone().into_any();
    let erased = any.start_at(attitude, velocity).unwrap();
    assert!(any.time(&erased).abs() <= 0.0 && any.length(&erased).is_none());

    let timed = Stepper::new(scene, 0.01).unwrap().with_clock(Clock::orbit(0.5, 30.0, 31).unwrap());
    let start = timed.start(attitude, velocity).unwrap();
    let (mut state, mut seen, mut asked) = (start, Vec::new(), Vec::new());
    let ended = timed
        .observed(&mut state)
        .event(Event::crossing(), |now| now.momentum().x, |now| seen.push((now.time(), **now)))
        .at([0.123, 0.456], |now| asked.push((now.time(), **now)))
        .until(2.0)
        .unwrap();
    assert!(ended.reason == Reason::Done && timed.time(&state) >= 2.0 && seen.len() > 1);
    for (time, motion) in seen.iter().chain(&asked) {
        assert!(apart(&timed.state_at(&start, *time).unwrap(), motion) < 1e-12);
    }
    assert!(seen.iter().all(|(_, motion)| motion.momentum().x.abs() < 1e-13));
    assert!(timed.length(&start).unwrap() < 0.01);
    // The end of a step is a part of length one, and the state before it is a step back.
    let next = timed.steps(state).next().unwrap().unwrap();
    assert!(apart(&timed.part(&state, 1.0).unwrap(), &next) < 1e-12);
    assert!(apart(&timed.part(&next, -1.0).unwrap(), &state) < 1e-12);
    assert!(matches!(timed.state_at(&state, 0.1), Err(StepError::Past { .. })));
    assert_eq!(timed.resume(&timed.checkpoint(&state)).unwrap(), state);
    let mut frames = Frames::new(timed, start);
    for _ in 0..70 {
        frames.advance(0.016).unwrap();
    }
    assert!((frames.time() - 1.12).abs() < 1e-13);
}

#[test]
fn a_clock_has_an_end() {
    let (scene, attitude, velocity) = top();
    for wrong in [vec![], vec![1.0, 0.0], vec![1.0, f64::INFINITY]] {
        assert!(Clock::of_lengths(wrong).is_err());
    }
    assert!(
        Clock::orbit(1.0, 1.0, 10).is_err()
            && Clock::orbit(0.5, 0.0, 10).is_err()
            && Clock::orbit(0.5, 1.0, 0).is_err()
    );
    let clock = Clock::of_lengths([1.0, 2.0, 3.0]).unwrap();
    assert_eq!((clock.reversed(2), clock.reversed(4)), (Clock::of_lengths([2.0, 1.0]).ok(), None));
    let timed = Stepper::new(scene, 0.01).unwrap().with_clock(clock);
    let mut state = timed.start(attitude, velocity).unwrap();
    assert!(matches!(timed.part(&state, -0.5), Err(StepError::NoLength { .. })));
    timed.run(&mut state, 3).unwrap();
    assert!((timed.time(&state) - 0.06).abs() < 1e-17);
    let before = state;
    assert!(matches!(timed.step(&mut state), Err(StepError::NoLength { length }) if length.is_nan()));
    assert_eq!(state, before);
    for steps in [1, 2, 3, 400, 401] {
        let clock = Clock::orbit(0.9, 7.0, steps).unwrap();
        assert_eq!(clock.reversed(u64::from(steps)).unwrap(), clock);
    }
    // The clock that begins at apocentre is half a round ahead.
    let [near, far] = [0.0, 0.5 * TAU].map(|mean| {
        let clock = Clock::orbit_from(mean, 0.7, 1.0, 400).unwrap();
        (0..=400).map(|step| clock.time(step)).collect::<Vec<_>>()
    });
    assert!((0..=200).all(|k| (near[200 + k] - near[200] - far[k]).abs() < 1e-11));
    assert!(Clock::orbit_from(f64::NAN, 0.5, 1.0, 10).is_err());
}

/// The errors of the momentum in space after steps of very different lengths, with plain and with compensated sums.
fn momenta(steps: u64) -> [f64; 2] {
    fn kept<S: Effect<Scalar = f64, Group = SO3> + LeftInvariant, P: Variable<S>>(
        (stepper, steps): (Stepper<S, P>, u64),
    ) -> f64 {
        let timed = stepper.with_clock(Clock::orbit(0.9, 10.0, 100).unwrap());
        let mut state = timed.start(SO3::identity(), Vector3::new(0.3, 1.0, 0.2)).unwrap();
        let before = timed.spatial_momentum(&state);
        timed.run(&mut state, steps).unwrap();
        (timed.spatial_momentum(&state) - before).norm()
    }
    let body = RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5)).unwrap() };
    let own = || Stepper::new(body, 0.1).unwrap();
    let found = [kept((own(), steps)), kept((own().compensated(), steps))];
    println!("{steps} steps: momentum {:.1e}, with compensated sums {:.1e}", found[0], found[1]);
    found
}

#[test]
fn momenta_of_varied_steps_are_kept() {
    let [plain, compensated] = momenta(200_000);
    assert!(plain < 1e-12 && compensated < 1e-13);
}

/// `cargo test -p liestep-long-tests --test varying -- ten_million --ignored --nocapture`.
#[test]
#[ignore = "a minute: `cargo test -p liestep-long-tests --test varying ten_million -- --ignored --nocapture`"]
fn momenta_over_ten_million_steps() {
    let [plain, compensated] = momenta(10_000_000);
    assert!(plain < 3e-12 && compensated < 1e-13);
}

/// The eccentric anomaly at a mean anomaly, by bisection.
fn kepler(mean: f64, e: f64) -> f64 {
    let halved = |(low, high): (f64, f64), _| {
        let middle = 0.5 * (low + high);
        if middle - e * middle.sin() > mean { (low, middle) } else { (middle, high) }
    };
    (0..60).fold((mean - 1.0, mean + 1.0), halved).0
}

/// The distance and the true anomaly at an eccentric anomaly.
fn place(anomaly: f64, e: f64) -> (f64, f64) {
    let half = 0.5 * anomaly;
    let turned = ((1.0 + e).sqrt() * half.sin()).atan2((1.0 - e).sqrt() * half.cos());
    (1.0 - e * anomaly.cos(), 2.0 * turned)
}

/// The leapfrog has its kick in the middle of the step, where the direction to the planet is known.
const LEAPFROG: SplittingScheme = SplittingScheme::new("leapfrog", 2, Flow::Drift, &[0.5, 1.0]);

/// Pitch and its rate after some orbits by this many steps of a splitting in each: by those of a clock, and by equal
/// ones. The satellite begins with 0.3 rad and 1 rad/s at an eccentric anomaly.
fn satellite([e, K, begin]: [f64; 3], orbits: u32, steps: u32) -> [[f64; 2]; 2] {
    let J = Inertia::from_principal_moments(Vector3::new(0.8 - 0.5 * K, 0.8 + 0.5 * K, 1.0)).unwrap();
    let mean = begin - e * begin.sin();
    // The direction to the planet times r^{-3/2}, which is the strength of the gradient.
    let planet = move |t: f64| {
        let (r, nu) = place(kepler((t + mean) % TAU, e), e);
        Vector3::new(nu.cos(), nu.sin(), 0.0) * r.powf(-1.5)
    };
    let scene = RigidBody { J_d: J.to_nonstandard() } + GravityGradient { GM: 1.0, r: 1.0, J, direction: planet(0.0) };
    let equal = Clock::of_lengths([TAU / f64::from(steps)]).unwrap().repeated();
    [Clock::orbit_from(mean, e, TAU, steps).unwrap(), equal].map(|clock| {
        let stepper = Stepper::split(scene, 1.0, ExactBody::new(&J), LEAPFROG).unwrap();
        let stepper = stepper.with_clock(clock).driven(move |t| ((), planet(t)));
        let mut state = stepper.start(SO3::exp(Vector3::z() * 0.3), Vector3::z()).unwrap();
        stepper.run(&mut state, u64::from(orbits * steps)).unwrap();
        let turned = state.attitude().as_matrix().column(0).into_owned();
        [turned.y.atan2(turned.x), state.momentum().z]
    })
}

/// Beletsky's equation in the eccentric anomaly by a Runge–Kutta method: pitch and its rate.
fn beletsky([e, K, begin]: [f64; 3], orbits: u32) -> [f64; 2] {
    let rate = |y: [f64; 2], anomaly: f64| {
        let (r, nu) = place(anomaly, e);
        [y[1] * r, -1.5 * K * (2.0 * (y[0] - nu)).sin() / (r * r)]
    };
    let plus = |y: [f64; 2], rate: [f64; 2], h: f64| [y[0] + h * rate[0], y[1] + h * rate[1]];
    let (steps, h) = (orbits * 20_000, TAU / 20_000.0);
    (0..steps).fold([0.3, 1.0], |y, k| {
        let now = begin + f64::from(k) * h;
        let first = rate(y, now);
        let second = rate(plus(y, first, 0.5 * h), now + 0.5 * h);
        let third = rate(plus(y, second, 0.5 * h), now + 0.5 * h);
        let fourth = rate(plus(y, third, h), now + h);
        let sides = plus(plus(y, first, h / 6.0), fourth, h / 6.0);
        plus(plus(sides, second, h / 3.0), third, h / 3.0)
    })
}

/// The table of the guide's chapter: `cargo test -p liestep-long-tests --test varying -- clock_is_worth --nocapture`.
#[test]
fn what_a_clock_is_worth() {
    let errors = |orbit: [f64; 3], orbits: u32, steps: u32| {
        let expected = beletsky(orbit, orbits);
        satellite(orbit, orbits, steps).map(|found| {
            let turn = (found[0] - expected[0]).rem_euclid(TAU);
            turn.min(TAU - turn).max((found[1] - expected[1]).abs())
        })
    };
    let worth = |orbit: [f64; 3], orbits: u32| {
        let ratios =
            [200, 400, 800, 1600].map(|steps| errors(orbit, orbits, steps)).map(|[clock, equal]| equal / clock);
        println!("e, K and begin {orbit:?}, {orbits} orbits: {ratios:.3?}");
        ratios
    };
    worth([0.97, 0.05, 0.0], 2);
    worth([0.9, 0.6, 0.0], 5);
    assert!(worth([0.7, 0.05, 0.0], 2)[1..].iter().all(|&ratio| ratio > 150.0));
    assert!(worth([0.9, 0.05, 0.0], 2)[1..].iter().all(|&ratio| ratio > 300.0));
    // The errors of equal steps cancel over a whole pass of pericentre, if the motion begins elsewhere.
    for begin in [0.25 * TAU, 0.5 * TAU] {
        assert!(worth([0.7, 0.05, begin], 2).iter().all(|&ratio| ratio < 1.0));
    }
    // A clock gains little or nothing if the orbit is nearly round, or the motion chaotic.
    assert!(worth([0.3, 0.05, 0.0], 2).iter().all(|&ratio| ratio < 3.0));
    assert!(worth([0.3, 0.6, 0.0], 5).iter().all(|&ratio| ratio < 1.0));
    assert!(worth([0.7, 0.6, 0.0], 5).iter().all(|&ratio| ratio < 10.0));
    let order = [400, 800, 1600].map(|steps| errors([0.7, 0.05, 0.0], 2, steps)[0]);
    for pair in order.windows(2) {
        assert!(((pair[0] / pair[1]).log2() - 2.0).abs() < 0.005, "{order:?}");
    }
}

/// The mean relative error of the energy in each tenth of a motion in which the axis of a symmetric top passes the
/// vertical so often, by steps in which it turns by about the same angle.
fn over_the_pole(h: f64, passes: u32) -> [f64; 10] {
    let (top, ..) = top();
    let stepper = Stepper::new(top, h).unwrap().with_density(densities::turn(top, 1.0));
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.5, 0.0, 1.0)).unwrap();
    let before = stepper.energy(&state);
    let tenths = core::array::from_fn(|_| {
        let (mut made, mut steps, mut sum, mut was_up) = (0, 0.0, 0.0, true);
        while made < passes / 10 {
            stepper.step(&mut state).unwrap();
            let is_up = state.attitude().as_matrix().m33 > 0.99;
            made += u32::from(is_up && !was_up);
            was_up = is_up;
            steps += 1.0;
            sum += stepper.energy(&state) / before - 1.0;
        }
        sum / steps
    });
    println!("{passes} passes, {} s, {} steps: mean energies {tenths:?}", stepper.time(&state), state.steps());
    tenths
}

#[test]
fn a_density_over_the_pole() {
    let tenths = over_the_pole(0.05, 1_000);
    let mean = tenths.iter().sum::<f64>() / 10.0;
    assert!(tenths.iter().all(|tenth| (tenth - mean).abs() < 1e-4), "{tenths:?}");
}

/// `cargo test -p liestep-long-tests --test varying -- a_million --ignored --nocapture`.
#[test]
#[ignore = "minutes: `cargo test -p liestep-long-tests --test varying a_million -- --ignored --nocapture`"]
fn a_density_over_the_pole_a_million_times() {
    let tenths = over_the_pole(0.2, 1_000_000);
    let mean = tenths.iter().sum::<f64>() / 10.0;
    assert!(tenths.iter().all(|tenth| (tenth - mean).abs() < 1e-5), "{tenths:?}");
}

/// The rate of the density `turn` is that of `½ ln(|Ω|² + ω²)` along the motion: by short steps ahead and back.
#[test]
fn the_rate_of_a_density_is_that_of_the_motion() {
    let (Sum { second: gravity, .. }, attitude, velocity) = top();
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5)).unwrap();
    let scene = RigidBody { J_d } + gravity;
    let stepper = Stepper::new(scene, 1e-4).unwrap();
    let start = stepper.start(attitude, velocity).unwrap();
    let after = |h: f64| {
        let mut state = start;
        stepper.step_of(&mut state, h).unwrap();
        0.5 * (stepper.velocity(&state).norm_squared() + 4.0).ln()
    };
    let (found, expected) = (densities::turn(scene, 2.0)(&start, &velocity), (after(1e-4) - after(-1e-4)) / 2e-4);
    assert!((found - expected).abs() < 1e-6 && found.abs() > 1e-3, "{found}, not {expected}");
}

#[test]
fn a_density_comes_back() {
    let (top, ..) = top();
    let stepper = Stepper::new(top, 0.02).unwrap().with_density(densities::turn(top, 1.0));
    let start = stepper.start(SO3::identity(), Vector3::new(0.5, 0.0, 1.0)).unwrap();
    let mut state = start;
    stepper.run(&mut state, 10_000).unwrap();
    assert_eq!(stepper.resume(&stepper.checkpoint(&state)).unwrap(), state);
    stepper.inverse().unwrap().run(&mut state, 10_000).unwrap();
    println!("back to {:.1e}, at {:.1e} s", apart(&state, &start), stepper.time(&state));
    assert!(apart(&state, &start) < 1e-10 && stepper.time(&state).abs() < 1e-10);
    // A density that falls below zero has no step length, which is an error.
    let falling = Stepper::new(top, 0.02).unwrap().with_density(|_, _| -1e3);
    let mut state = falling.start(SO3::identity(), Vector3::x()).unwrap();
    assert!(matches!(falling.step(&mut state), Err(StepError::NoLength { .. })) && state.steps() == 0);
}

/// Two bodies pass each other at a thousandth of their distance, a hundred times.
#[test]
fn a_close_pass_with_a_density() {
    let body = FallingBody { m: 1.0, J_d: disc(), g: 0.0, up: Vector3::z() };
    let scene = Each::<2>::of([body; 2]) + Pairs::<2>::of([Attraction { a: Vector3::zeros(), b: Vector3::zeros() }]);
    // The bodies start at the far end of an orbit with pericentre 0.001.
    let far = |x: f64| (SO3::identity(), R3::from(Vector3::x() * x));
    let mut velocity = [Vector6::zeros(); 2];
    velocity[1][4] = 0.5 * (2.0 * 0.001 / 1.999_f64).sqrt();
    velocity[0][4] = -velocity[1][4];
    let start = ([far(-0.9995), far(0.9995)], Bodies(velocity));
    let varied = Stepper::new(scene, 0.05).unwrap().with_density(densities::distance([0, 1], 1.5));
    let distance = |[one, other]: [(SO3, R3); 2]| (other.1.translation() - one.1.translation()).norm();
    let mut state = varied.start(start.0, start.1).unwrap();
    let before = varied.energy(&state);
    let (mut passes, mut most, mut steps, mut nearest, mut was_near) = (0, [0.0_f64; 2], 0, f64::INFINITY, false);
    while passes < 100 {
        varied.step(&mut state).unwrap();
        let r = distance(state.attitude());
        (steps, nearest) = (steps + 1, nearest.min(r));
        passes += u32::from(was_near && r > 1.0);
        was_near = r < 1.0;
        if r > 1.0 {
            let half = usize::from(passes >= 50);
            most[half] = most[half].max((varied.energy(&state) - before).abs());
        }
    }
    println!(
        "{steps} steps, nearest {nearest:.1e}, energy off by {most:?} in either half of {} s",
        varied.time(&state)
    );
    let fixed = Stepper::new(scene, varied.time(&state) / f64::from(10 * steps)).unwrap();
    let mut other = fixed.start(start.0, start.1).unwrap();
    let mut off = 0.0_f64;
    fixed
        .observed(&mut other)
        .every(1, |now| {
            if distance(now.attitude()) > 1.0 {
                off = off.max((now.energy() - before).abs());
            }
        })
        .until(50.0)
        .unwrap();
    println!("ten times as many equal steps: {off}");
    assert!(nearest < 1.2e-3 && most[1] < 2.0 * most[0] && most[0] < 1e-2 && off > most[0]);
}
