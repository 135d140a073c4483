//! The choice by accuracy: its error, its refusals, and its determinism.

mod trials;
mod varying_inertia;

use declarations::{DoublePendulum, FourthOrderTop, Motion, SlidingTop, Top as _};
use liestep::accuracy::{self, Accuracy, AccuracyError, AccurateStepper};
use liestep::effects::{CayleyBody, Dipole, Gravity, GravityGradient, PrincipalBody, RigidBody, Rotor, Spring};
use liestep::groups::{Advected, LieGroup, R3, SE3, SO2};
use liestep::mechanics::{
    ContinuousLagrangian, DiagonalNonstandardInertia, DiscreteLagrangian, Inertia, Regular, Scene,
};
use liestep::methods::CompositionScheme;
use liestep::motion::RightHandSide;
use liestep::with::Scheme;
use liestep::{NonstandardInertia, SO3, SetupError, Stepper, lagrangian};
use nalgebra::{Matrix3, UnitQuaternion, Vector1, Vector2, Vector3, Vector6};
use workbench::runge_kutta;

use crate::every_method;

/// The five scenes of the example accuracy-cost.
const MOTIONS: [&str; 5] = ["looping A", "cuspidal A", "third A", "chaotic", "free"];

const TOLERANCES: [f64; 3] = [1e-3, 1e-6, 1e-9];

type End = (Matrix3<f64>, Vector3<f64>);

/// The error as `Accuracy` defines it.
fn error((attitude, velocity): &End, exact: &End, at_start: &Vector3<f64>, horizon: f64) -> f64 {
    let scale = exact.1.norm().max(at_start.norm()).max(1.0 / horizon);
    ((attitude - exact.0).norm() / exact.0.norm()).hypot((velocity - exact.1).norm() / scale)
}

fn end<A: Advected<SO3>>(stepper: &AccurateStepper<SO3, A>) -> End {
    let mut state = stepper.start();
    stepper.run(&mut state).unwrap();
    assert!((stepper.time(&state) - stepper.choice().accuracy.horizon).abs() < 1e-9);
    (*state.attitude().as_matrix(), stepper.velocity(&state))
}

type Answer = Result<AccurateStepper<SO3, Vector3<f64>>, AccuracyError>;

fn ask(motion: &Motion, accuracy: Accuracy) -> Answer {
    Stepper::for_accuracy(motion.top.clone(), accuracy, motion.attitude, motion.velocity)
}

/// A choice for the same body by a Lagrangian that can't be split: it only has its own steps and their compositions.
fn ask_coupled(motion: &Motion, accuracy: Accuracy) -> Answer {
    Stepper::for_accuracy(FourthOrderTop::of(&motion.top), accuracy, motion.attitude, motion.velocity)
}

/// The worst ratio of error to tolerance, over the motions and tolerances that can be reached. A refusal takes at most
/// `most_operations` operations.
fn worst_ratio(ask: impl Fn(&Motion, Accuracy) -> Answer, most_operations: f64) -> f64 {
    let mut worst = 0.0_f64;
    for (name, horizon) in MOTIONS.iter().flat_map(|name| [(name, 10.0), (name, 100.0)]) {
        let motion = Motion::read(name);
        let exact = motion.at(horizon);
        for tolerance in TOLERANCES {
            match ask(&motion, Accuracy { tolerance, horizon }) {
                Ok(stepper) => {
                    let choice = stepper.choice();
                    assert!(choice.trials <= 60.0, "{name} {horizon} {tolerance}\n{choice}");
                    let error = error(&end(&stepper), &exact, &motion.velocity, horizon);
                    assert!(error <= tolerance, "{name} {horizon} {tolerance}: {error}\n{choice}");
                    worst = worst.max(error / tolerance);
                }
                // Errors of the asymmetric motion have grown by 10⁹ at that time.
                Err(AccuracyError::Unreachable { floor, trials, .. }) => {
                    assert!(trials.operations < most_operations, "{name} {tolerance}: {trials:?}");
                    assert!(*name == "chaotic" && horizon > 50.0, "{name} {horizon} {tolerance}");
                    assert!(floor > tolerance && floor < 1e-3, "{tolerance} {floor}");
                }
                Err(other) => panic!("{name}: {other}"),
            }
        }
    }
    worst
}

#[test]
fn the_tolerance_is_reached_by_what_a_scene_allows() {
    let worst = worst_ratio(ask, 1e9);
    assert!(worst <= 1.0 && worst > 0.5, "{worst}");
}

#[test]
fn the_tolerance_is_reached_by_compositions_alone() {
    // Each solve takes the Jacobian of a Lagrangian of higher order.
    let worst = worst_ratio(ask_coupled, 3e9);
    assert!(worst <= 1.0 && worst > 0.5, "{worst}");
}

/// In so short a motion runs of one and two steps may agree by chance although both are wrong. Four of these 600
/// choices are of this kind.
#[test]
fn the_tolerance_is_seldom_missed_by_a_few_long_steps() {
    let (mut few, mut missed) = (0, Vec::new());
    for name in MOTIONS {
        let Motion { top, attitude, velocity, .. } = Motion::read(name);
        let fine = Stepper::composed(top.clone(), 0.01, CompositionScheme::SOFRONIOU_SPALETTA_10).unwrap();
        let mut state = fine.start(attitude, velocity).unwrap();
        for _ in 0..40 {
            fine.run(&mut state, 5).unwrap();
            let (horizon, exact) = (fine.time(&state), (*state.attitude().as_matrix(), fine.velocity(&state)));
            for tolerance in [0.05, 0.03, 0.01] {
                let accuracy = Accuracy { tolerance, horizon };
                let stepper = Stepper::for_accuracy(top.clone(), accuracy, attitude, velocity).unwrap();
                let error = error(&end(&stepper), &exact, &velocity, horizon);
                few += u32::from(stepper.choice().steps <= 4);
                if error > tolerance {
                    missed.push(format!("{name} {horizon} {tolerance}: {error} with {}", stepper.choice().steps));
                }
            }
        }
    }
    assert!(few > 250 && missed.len() <= 4, "{few}; missed {missed:#?}");
}

/// A control: steps twice as long miss the tolerance, by the factor of the order.
#[test]
#[allow(clippy::cast_precision_loss)] // few steps
fn a_step_twice_as_long_misses_the_tolerance() {
    let motion = Motion::read("looping A");
    let (tolerance, horizon) = (1e-8, 10.0);
    let accuracy = Accuracy { tolerance, horizon };
    let stepper = ask(&motion, accuracy).unwrap();
    let chosen = stepper.choice().chosen();
    let steps = stepper.choice().steps.div_ceil(2);
    let mut all = every_method::all(&motion.top, horizon / steps as f64).into_iter();
    let (_, longer) = all.find(|(name, _)| *name == chosen.scheme.to_string()).unwrap();
    let mut state = longer.start(motion.attitude, motion.velocity).unwrap();
    longer.run(&mut state, steps).unwrap();
    let end = (*state.attitude().as_matrix(), longer.velocity(&state));
    let missed = error(&end, &motion.at(horizon), &motion.velocity, horizon) / tolerance;
    assert!(missed > f64::from(1 << (chosen.order - 3)), "{} {missed}", chosen.scheme);
}

fn body(moments: [f64; 3]) -> PrincipalBody {
    PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(moments.into()).unwrap() }
}

/// Compares the chosen run with a run by far shorter steps.
fn reaches<L>(scene: &L, turn: [f64; 3], velocity: [f64; 3])
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected: 'static> + Regular + Clone + 'static,
{
    let (attitude, velocity) = (UnitQuaternion::from_scaled_axis(turn.into()), Vector3::from(velocity));
    for (horizon, tolerance) in [10.0, 100.0].into_iter().flat_map(|t| TOLERANCES.map(|tolerance| (t, tolerance))) {
        let fine = Stepper::composed(scene.clone(), 0.01, CompositionScheme::SOFRONIOU_SPALETTA_10).unwrap();
        let mut state = fine.start(attitude, velocity).unwrap();
        while fine.time(&state) < horizon - 1e-3 {
            fine.step(&mut state).unwrap();
        }
        let exact = (*state.attitude().as_matrix(), fine.velocity(&state));
        let accuracy = Accuracy { tolerance, horizon };
        let stepper = Stepper::for_accuracy(scene.clone(), accuracy, attitude, velocity).unwrap();
        let error = error(&end(&stepper), &exact, &velocity, horizon);
        assert!(error <= tolerance, "{horizon} {tolerance} {error}\n{}", stepper.choice());
    }
}

#[test]
fn the_tolerance_is_reached_in_the_gravity_gradient() {
    let satellite = body([1.0, 2.5, 3.0]);
    let J = NonstandardInertia::from(satellite.J_d).to_inertia();
    let gradient = GravityGradient { GM: 1.0, r: 1.0, J, direction: Vector3::z() };
    reaches(&(satellite + gradient), [0.3, 0.9, 1.2], [-0.2, 0.5, 0.4]);
}

#[test]
fn the_tolerance_is_reached_on_a_spring() {
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.0, 0.0, 0.6), up: Vector3::z() };
    let spring = Spring { k: 30.0, length: 0.4, at: Vector3::z(), anchor: Vector3::new(0.8, 0.0, 1.0) };
    reaches(&(body([0.4, 0.4, 0.02]) + gravity + spring), [0.3, 1.2, 0.0], [0.5, 1.0, 2.0]);
}

/// The body starts at rest, so the initial velocity gives no scale.
#[test]
fn the_tolerance_is_reached_in_a_magnetic_field_from_rest() {
    let dipole = Dipole { moment: Vector3::new(0.3, 0.0, 2.0), field: Vector3::new(1.0, 0.0, 1.0) };
    reaches(&(body([1.0, 1.2, 0.4]) + dipole), [0.7, 0.2, 0.0], [0.0, 0.0, 0.0]);
}

#[test]
fn the_tolerance_is_reached_with_a_rotor() {
    reaches(&(body([1.0, 2.0, 2.5]) + Rotor { spin: Vector3::new(0.2, 0.5, 0.0) }), [0.0, 0.0, 0.1], [0.1, 0.3, -0.6]);
}

/// A planar pendulum.
#[lagrangian(
    group = SO2,
    advected(w = up),
    l_d = inertia * (2.0 - F.trace()) / h - 0.5 * h * weight * w.dot(&(rho + F * rho)),
)]
#[derive(Clone)]
struct Pendulum {
    inertia: f64,
    weight: f64,
    rho: Vector2<f64>,
    up: Vector2<f64>,
}

#[test]
fn the_tolerance_is_reached_on_another_group() {
    let pendulum = Pendulum { inertia: 1.5, weight: 9.81, rho: Vector2::x(), up: -Vector2::x() };
    let (horizon, tolerance, velocity) = (10.0, 1e-7, Vector1::new(2.0));
    let fine = Stepper::composed(pendulum.clone(), 0.01, CompositionScheme::SOFRONIOU_SPALETTA_10).unwrap();
    let mut exact = fine.start(SO2::identity(), velocity).unwrap();
    for _ in 0..1000 {
        fine.step(&mut exact).unwrap();
    }
    let stepper = Stepper::for_accuracy(pendulum, Accuracy { tolerance, horizon }, SO2::identity(), velocity).unwrap();
    let mut state = stepper.start();
    stepper.run(&mut state).unwrap();
    let attitudes = (state.attitude().matrix() - exact.attitude().matrix()).norm() / f64::sqrt(2.0);
    let error = attitudes.hypot((stepper.velocity(&state) - fine.velocity(&exact)).norm() / 2.0);
    assert!(error <= tolerance && error > 0.0, "{error}");
}

#[test]
fn the_same_question_has_the_same_answer() {
    let motion = Motion::read("chaotic");
    let ask = || {
        let accuracy = Accuracy { tolerance: 1e-7, horizon: 10.0 };
        ask(&motion, accuracy).unwrap()
    };
    let [one, other] = [ask(), ask()];
    assert_eq!(one.choice(), other.choice());
    assert_eq!(end(&one), end(&other));
    // Single steps of the chosen stepper give the same motion, to rounding.
    let mut state = one.start();
    while state.steps() < one.choice().steps {
        one.step(&mut state).unwrap();
    }
    assert!((state.attitude().as_matrix() - end(&one).0).norm() < 1e-12);
}

/// If no flow of the free body is exact and the accuracy is high, collocation is the cheapest method.
#[test]
fn gauss_collocation_is_chosen_for_the_chaotic_top() {
    let motion = Motion::read("chaotic");
    // Eight stages reach 1e-11 with the longest solvable step, so a larger tolerance would be no test.
    let accuracy = Accuracy { tolerance: 1e-11, horizon: 10.0 };
    let stepper = ask(&motion, accuracy).unwrap();
    let choice = stepper.choice();
    assert!(matches!(choice.chosen().scheme, Scheme::Collocation(_)), "{choice}");
    let reached = error(&end(&stepper), &motion.at(10.0), &motion.velocity, 10.0);
    assert!(reached <= 1e-11 && reached > 1e-13, "{reached:e}\n{choice}");
    // The state can be stepped singly, and its properties are those of the scene.
    let mut state = stepper.start();
    let (energy, vertical) = (stepper.energy(&state), state.momentum_along(&motion.top.up));
    while state.steps() < choice.steps {
        stepper.step(&mut state).unwrap();
    }
    assert!((state.attitude().as_matrix() - end(&stepper).0).norm() < 1e-10);
    assert!((stepper.energy(&state) - energy).abs() < 1e-8 * energy.abs());
    assert!((state.momentum_along(&motion.top.up) - vertical).abs() < 1e-13 * state.momentum().norm());
    let parameters = state.attitude().as_matrix().transpose() * motion.top.up;
    assert!((state.advected() - parameters).norm() < 1e-15);
}

#[test]
fn the_report_names_the_choice_and_its_neighbours() {
    let motion = Motion::read("cuspidal A");
    let accuracy = Accuracy { tolerance: 1e-6, horizon: 10.0 };
    let stepper = ask(&motion, accuracy).unwrap();
    let (choice, text) = (stepper.choice(), stepper.choice().to_string());
    assert!((choice.chosen().cost - 1.0).abs() < 1e-12 && choice.error <= 1e-6);
    assert!(choice.nearby[0] < 1.0 && choice.nearby[1] > 1.0, "{:?}", choice.nearby);
    assert!(choice.offers().iter().all(|offer| offer.cost > 0.5 && text.contains(&offer.scheme.to_string())), "{text}");
    assert!(text.starts_with(&format!("1e-6 at t = 10 s: {}, ", choice.chosen().scheme)), "{text}");
}

#[test]
fn questions_without_an_answer() {
    let motion = Motion::read("looping A");
    let ask = |tolerance, horizon| {
        let accuracy = Accuracy { tolerance, horizon };
        Stepper::for_accuracy(motion.top.clone(), accuracy, motion.attitude, motion.velocity).unwrap_err()
    };
    for tolerance in [0.0, -1e-6, 0.06, f64::NAN, f64::INFINITY] {
        assert!(matches!(ask(tolerance, 1.0), AccuracyError::Tolerance { .. }), "{tolerance}");
    }
    for horizon in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(ask(1e-6, horizon), AccuracyError::Horizon { .. }), "{horizon}");
    }
    let accuracy = Accuracy { tolerance: 1e-6, horizon: 1.0 };
    let fast = Vector3::new(f64::NAN, 0.0, 0.0);
    let refusal = Stepper::for_accuracy(motion.top.clone(), accuracy, motion.attitude, fast).unwrap_err();
    assert_eq!(refusal, AccuracyError::Setup(SetupError::NonFinite { what: "velocity" }));
}

/// The error names the smallest reachable tolerance, which is reachable.
#[test]
fn a_tolerance_below_rounding_is_refused_with_the_floor() {
    let motion = Motion::read("looping A");
    let ask = |tolerance| {
        let accuracy = Accuracy { tolerance, horizon: 10.0 };
        ask(&motion, accuracy)
    };
    let refusal = ask(1e-17).unwrap_err();
    let AccuracyError::Unreachable { floor, .. } = refusal else { panic!("{refusal}") };
    assert!(floor > 1e-15 && floor < 1e-11, "{floor}");
    let stepper = ask(4.0 * floor).unwrap();
    assert!(error(&end(&stepper), &motion.at(10.0), &motion.velocity, 10.0) <= 4.0 * floor);
}

/// The free body has a flow without error: any motion is one step.
#[test]
fn the_exact_motion_of_a_free_body_is_one_step() {
    let scene = body([1.0, 2.0, 2.5]);
    let velocity = Vector3::new(0.3, 2.0, 0.1);
    for (horizon, tolerance) in [(10.0, 1e-3), (10.0, 1e-10), (1000.0, 1e-9)] {
        let accuracy = Accuracy { tolerance, horizon };
        let stepper = Stepper::for_accuracy(scene, accuracy, SO3::identity(), velocity).unwrap();
        let choice = stepper.choice();
        assert_eq!((choice.chosen().scheme, choice.steps), (Scheme::Exact, 1), "{choice}");
        assert!(choice.trials <= 60.0 && choice.error <= tolerance, "{choice}");
        assert_eq!(choice.nearby.map(f64::to_bits), [1.0_f64.to_bits(); 2], "{choice}");
    }
    // Rounding over so long a motion isn't an error of the method.
    for tolerance in [1e-17, f64::from_bits(1)] {
        let accuracy = Accuracy { tolerance, horizon: 10.0 };
        let refusal = Stepper::for_accuracy(scene, accuracy, SO3::identity(), velocity).unwrap_err();
        let AccuracyError::Unreachable { floor, .. } = refusal else { panic!("{refusal}") };
        assert!(floor > 1e-16 && floor < 1e-12, "{floor}");
    }
}

/// If the potential or the bias excludes other methods, the scene's own steps remain.
#[test]
fn a_scene_that_cannot_be_split_has_its_own_steps() {
    let motion = Motion::read("looping A");
    let accuracy = Accuracy { tolerance: 1e-5, horizon: 1.0 };
    let spun = motion.top.clone() + Rotor { spin: Vector3::x() };
    let stepper = Stepper::for_accuracy(spun, accuracy, motion.attitude, motion.velocity).unwrap();
    assert!(
        stepper.choice().offers().iter().all(|offer| matches!(offer.scheme, Scheme::Step | Scheme::Composition(_)))
    );
    let stepper = ask_coupled(&motion, accuracy).unwrap();
    assert!(stepper.choice().error <= 1e-5);
}

/// A rotation wrong by 1e-3 rad at a place 1000 km away, and places wrong relative to each other in a fast flight.
#[test]
fn errors_are_those_of_the_worst_part() {
    let turn = SO3::exp(Vector3::x() * 1e-3);
    let (far, velocity) = (Vector3::new(1e6, 0.0, 0.0), Vector6::new(0.0, 0.0, 1.0, 7e3, 0.0, 0.0));
    let rigid = |turn: &SO3| SE3::from_rotation_and_translation(UnitQuaternion::from_matrix(turn.as_matrix()), far);
    let exact = accuracy::End { attitude: rigid(&SO3::identity()), velocity };
    let end = accuracy::End { attitude: rigid(&turn), velocity };
    assert!((end.error(&exact, &exact, 10.0) - 0.816e-3).abs() < 1e-6);

    let velocity = Vector6::new(7e3, 0.0, 0.0, 7e3, 0.0, 0.0);
    let attitude = |apart: f64| (R3::from(far), R3::from(far + Vector3::y() * apart));
    let flying = |apart| accuracy::End { attitude: attitude(apart), velocity };
    // They have come 1 m apart, by which the second one has moved beside the first.
    let error = flying(1.001).error(&flying(1.0), &flying(0.0), 10.0);
    assert!((error - 1e-3).abs() < 1e-6, "{error}");
}

/// A mass on a spring of 10 rad/s.
#[lagrangian(
    group(d = R3),
    advected(x = d.seen_from(space)),
    l_d = m * d.norm_squared() / (2.0 * h) - 25.0 * h * m * (x.norm_squared() + (x + d).norm_squared()),
)]
#[derive(Clone, Debug)]
struct Oscillator {
    m: f64,
}

/// An error of a place is a share of its motion, in any unit, also where the run ends at its start.
#[test]
fn errors_of_places_have_no_unit() {
    let period = core::f64::consts::TAU / 10.0;
    for horizon in [period, 16.0 * period, 10.0] {
        let accuracy = Accuracy { tolerance: 1e-7, horizon };
        let chosen = |size: f64| {
            let start = R3::from(Vector3::new(0.6, 0.0, 0.8) * size);
            let stepper = Stepper::for_accuracy(Oscillator { m: 1.3 }, accuracy, start, Vector3::zeros()).unwrap();
            let mut state = stepper.start();
            stepper.run(&mut state).unwrap();
            let exact = start.translation() * (10.0 * horizon).cos();
            let away = (state.attitude().translation() - exact).norm() / size;
            assert!(away < 2e-7, "{size}: {away:e}");
            stepper.choice().steps
        };
        let steps = chosen(1.0);
        assert!([1e-6, 1e6].iter().all(|size| chosen(*size).abs_diff(steps) * 20 <= steps));
    }
}
