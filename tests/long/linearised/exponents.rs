//! Lyapunov exponents, compared with two trajectories whose distance is rescaled repeatedly.

use declarations::Motion;
use liestep::effects::{Gravity, PrincipalBody};
use liestep::groups::LieGroup as _;
use liestep::{SO3, StepError, Stepper};
use nalgebra::{Rotation3, Vector3};

const STEP: f64 = 0.02;
const STEPS: u32 = 20_000;
const BETWEEN: u32 = 50;

#[test]
fn of_a_chaotic_top() {
    let Motion { top, attitude, velocity, .. } = Motion::chaotic();
    let scene = PrincipalBody { J_d: top.J_d } + Gravity { m: top.m, g: top.g, rho: top.rho, up: top.up };
    let stepper = Stepper::new(scene, STEP).expect("a stepper");
    let linear = stepper.linearised().expect("derivatives");
    let start = stepper.start(attitude, velocity).expect("a start");
    let exponents = linear.lyapunov_exponents(&mut { start }, STEPS.into(), BETWEEN.into()).expect("exponents");

    // The second trajectory is turned about the first axis of the body: the initial direction of the first exponent.
    let distance = 1e-8;
    let turned = |attitude: &SO3, by: &Vector3<f64>| {
        SO3::from_matrix_unchecked(attitude.matrix() * Rotation3::new(*by).matrix())
    };
    let mut first = start;
    let beside = turned(&start.attitude(), &(Vector3::x() * distance));
    let mut second = stepper.start_with_momentum(beside, start.momentum()).expect("a start");
    let mut growth = 0.0;
    for _ in 0..STEPS / BETWEEN {
        stepper.run(&mut first, BETWEEN.into()).expect("steps");
        stepper.run(&mut second, BETWEEN.into()).expect("steps");
        let turn = SO3::<f64>::vee(&(first.attitude().matrix().transpose() * second.attitude().matrix()));
        let push = second.momentum() - first.momentum();
        let length = (turn.norm_squared() + push.norm_squared()).sqrt();
        growth += (length / distance).ln();
        let scale = distance / length;
        let beside = turned(&first.attitude(), &(turn * scale));
        second = stepper.start_with_momentum(beside, first.momentum() + push * scale).expect("a start");
    }
    let expected = growth / (f64::from(STEPS) * STEP);
    println!("{exponents:?}, by two trajectories {expected}");
    assert!((exponents[0] - expected).abs() < 2e-3, "{} and {expected}", exponents[0]);
    assert!(exponents[0] > 0.1, "chaotic: {}", exponents[0]);
    // The exponents of a Poisson map are in pairs of opposite sign, and their sum is exactly zero.
    assert!(exponents.iter().sum::<f64>().abs() < 1e-10);
    assert!((exponents[0] + exponents[5]).abs() < 0.02, "{exponents:?}");
}

#[test]
fn without_time_there_are_none() {
    let Motion { top, attitude, velocity, .. } = Motion::chaotic();
    let scene = PrincipalBody { J_d: top.J_d } + Gravity { m: top.m, g: top.g, rho: top.rho, up: top.up };
    let stepper = Stepper::new(scene, 0.0).expect("a stepper");
    let linear = stepper.linearised().expect("derivatives");
    let start = stepper.start(attitude, velocity).expect("a start");
    let mut state = start;
    let none = Err(StepError::NonFinite { what: "Lyapunov exponent" });
    assert_eq!(linear.lyapunov_exponents(&mut state, 3, 1), none);
    assert_eq!(state, start);
    let stepper = Stepper::new(scene, STEP).expect("a stepper");
    let linear = stepper.linearised().expect("derivatives");
    assert_eq!(linear.lyapunov_exponents(&mut state, 0, 1), Ok(vec![0.0; 6]));
    let each = linear.lyapunov_exponents(&mut { start }, 3, 1);
    assert_eq!(linear.lyapunov_exponents(&mut { start }, 3, 0), each);
}
