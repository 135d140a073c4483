//! The bounds on a step's solvability agree with the solver.

use checks::random::Random;
use declarations::{CayleyTop, FreeBody, FullTop, HeavyTop, Motion, Top as _};
use liestep::mechanics::{Effect as _, Regular, inertia};
use liestep::motion::{DiscreteLiePoisson, Solvability};
use liestep::prelude::*;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Steps and directions around the two bounds: the sure ones have a solution under 90°, the impossible ones none.
fn assert_bounds_hold<L>(lagrangian: &L, seed: u64)
where
    L: Regular<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Clone + core::fmt::Debug,
{
    let mut random = Random::new(seed);
    let inertia = inertia(lagrangian, &lagrangian.advected()).symmetric_eigenvalues();
    let mut found = [0; 3];
    for _ in 0..2000 {
        let h = 10.0_f64.powf(random.signed() * 3.0);
        let flow = DiscreteLiePoisson::new(lagrangian.clone(), h).unwrap();
        let w = random.direction();
        // The size `h|a|` ranges from a third of the smallest moment to twice the largest.
        let size = inertia.min() / 3.0 * (6.0 * inertia.max() / inertia.min()).powf(0.5 + 0.5 * random.signed());
        let momentum = random.direction() * (size / h) - L::kick_before(&lagrangian.constants(h), &w);
        let step = flow.step(&momentum, &w, &Vector3::zeros());
        match flow.solvability(&momentum, &w) {
            Solvability::Certain => {
                found[0] += 1;
                let angle = step.unwrap().element().log().norm();
                assert!(size < inertia.min() && angle < core::f64::consts::FRAC_PI_2, "{angle} at {size}");
            }
            Solvability::Impossible => {
                found[1] += 1;
                let error = step.unwrap_err();
                assert!(size > inertia.max() && matches!(error, StepError::BeyondSolvable { .. }), "{error:?}");
            }
            Solvability::Open => {
                found[2] += 1;
                let margin = 1.0 + 1e-9;
                assert!(size * margin > inertia.min() && size < inertia.max() * margin, "{size} within {inertia}");
            }
        }
    }
    println!("certain, impossible, open: {found:?}");
    assert!(found.iter().all(|&count| count > 100), "{found:?}");
}

#[test]
fn s1_bounds_of_tops() {
    for (seed, top) in [HeavyTop::thesis(), HeavyTop::asymmetric()].into_iter().enumerate() {
        assert_bounds_hold(&top, seed as u64);
        let axes = Random::new(9).rotation();
        assert_bounds_hold(&FullTop::in_axes(&top, axes.as_matrix()), 10 + seed as u64);
    }
}

/// The guaranteed and the impossible step of the thesis' first case.
#[test]
fn s1_bounds_of_the_looping_top() {
    let Motion { top, attitude, velocity, .. } = Motion::looping();
    let at = |h: f64| {
        let stepper = Stepper::new(top.clone(), h).unwrap();
        stepper.solvability(&stepper.start(attitude, velocity).unwrap())
    };
    assert_eq!(
        (at(0.061), at(0.062), at(0.081), at(0.083)),
        (Solvability::Certain, Solvability::Open, Solvability::Open, Solvability::Impossible)
    );
    assert_eq!((at(-0.061), at(-0.083)), (Solvability::Certain, Solvability::Impossible));
}

/// Bodies without an advected parameter; for a sphere no case is open.
#[test]
fn s1_bounds_of_free_bodies() {
    for (inertia, open) in [([1.0, 2.0, 2.5], true), ([2.0, 2.0, 2.0], false)] {
        let flow = DiscreteLiePoisson::new(FreeBody::with_moments(inertia), 0.5).unwrap();
        let at = |size: f64| flow.solvability(&(Vector3::new(0.6, 0.0, 0.8) * (size / 0.5)), &());
        assert_eq!(at(0.999 * inertia[0]), Solvability::Certain);
        assert_eq!(at(1.001 * inertia[2]), Solvability::Impossible);
        assert_eq!(at(1.001 * inertia[0]) == Solvability::Open, open);
    }
}

/// The bounds are those of (3.13); another kinetic part has none.
#[test]
fn s6_nothing_is_said_of_other_lagrangians() {
    let top = HeavyTop::asymmetric();
    let flow = DiscreteLiePoisson::new(CayleyTop::of(&top), 0.01).unwrap();
    assert_eq!(flow.solvability(&Vector3::new(0.1, 0.2, 0.3), &Vector3::z()), Solvability::Open);
    assert_eq!(flow.solvability(&Vector3::new(1e6, 0.0, 0.0), &Vector3::z()), Solvability::Open);
}

/// The bounds depend on the scene's body: potentials of the positions only change the right-hand side.
#[test]
fn s1_bounds_of_a_scene() {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5)).unwrap();
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.0, 0.5, 1.0), up: Vector3::z() };
    let stepper = Stepper::new(RigidBody { J_d } + gravity, 0.01).unwrap();
    let at = |spin: f64| stepper.solvability(&stepper.start(SO3::identity(), Vector3::z() * spin).unwrap());
    assert_eq!((at(1.0), at(1e3)), (Solvability::Certain, Solvability::Impossible));
}

/// For momenta far beyond any solvable step the bounds decide at once, and the error names a solvable step.
#[test]
fn s1_the_largest_step_of_extreme_momenta() {
    let top = HeavyTop::thesis();
    for exponent in [3, 30, 60, 100] {
        let momentum = Vector3::new(0.3, -0.4, 0.5) * 10.0_f64.powi(exponent);
        let flow = DiscreteLiePoisson::new(top.clone(), 1.0).unwrap();
        let error = flow.step(&momentum, &Vector3::z(), &Vector3::zeros()).unwrap_err();
        let StepError::BeyondSolvable { largest, .. } = error else { panic!("{error:?}") };
        let size = largest * momentum.norm();
        let j = top.moments();
        assert!(size >= j.min() * (1.0 - 1e-5) && size <= j.max(), "10^{exponent}: h|p| = {size}");
        let flow = DiscreteLiePoisson::new(top.clone(), largest).unwrap();
        assert!(flow.step(&momentum, &Vector3::z(), &Vector3::zeros()).is_ok(), "10^{exponent}: {largest:e}");
    }
}

/// A weight so large that the Jacobian is lost in its rounding, with numbers whose products cancel to the last digit:
/// an update then vanishes far from any solution, and the determinant looks normal.
#[test]
fn s1_a_lost_jacobian_is_no_solution() {
    let size = 7.477_080_264_543_605e20;
    let J_d = DiagonalNonstandardInertia::from_diagonal(Vector3::new(2.0, size, size)).unwrap();
    let (weight, rho) = (3.033_333_333_333_333, Vector3::repeat(size));
    let top = HeavyTop { J_d, m: weight, g: 3.689_588_068_472_114e19, rho, up: rho };
    let stepper = Stepper::new(top, 1.0).unwrap();
    // The attitude is half a turn about the first axis, up to rounding.
    let attitude = UnitQuaternion::from_quaternion(Quaternion::new(
        2.0,
        -5.467_417_454_560_923e120,
        7.477_078_768_755_388e20,
        4.180_769_147_311_568e-178,
    ));
    let momentum = Vector3::new(4.180_672_277_983_657_4e-178, 7.477_079_692_797_558e20, 4.476_409_895_220_184_4e20);
    let mut state = stepper.start_with_momentum(attitude, momentum).unwrap();
    assert_eq!(stepper.solvability(&state), Solvability::Impossible);
    assert!(matches!(stepper.step(&mut state), Err(StepError::BeyondSolvable { .. })));
}

/// A body repelled from the plane across `n`, by the reciprocal of a direction's distance from it.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * k * (1.0 / w.dot(&n) + 1.0 / w.dot(&(F * n))),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct RepelledBody {
    J_d: NonstandardInertia,
    k: f64,
    n: Vector3<f64>,
    up: Vector3<f64>,
}

/// If the torque is infinite, no smaller step is solvable, and the bounds aren't evaluated.
#[test]
fn an_infinite_torque_is_said() {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5)).unwrap();
    // The vectors are at right angles to the last digit, and no component of their product is zero.
    let scene = RepelledBody { J_d, k: 1.0, n: Vector3::new(1.0, -1.0, 1.0), up: Vector3::new(1.0, 1.0, 0.0) };
    let kick = RepelledBody::kick_before(&scene.constants(0.01), &scene.up);
    assert!(kick.iter().all(|torque| torque.is_infinite()), "{kick}");
    let stepper = Stepper::new(scene, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::z()).unwrap();
    let before = state;
    let error = stepper.step(&mut state).unwrap_err();
    assert_eq!(error, StepError::NonFinite { what: "momentum equation" });
    assert_eq!(state, before);
}
