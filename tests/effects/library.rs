//! Each effect of the library compared with its physics.

use checks::random::Random;
use liestep::effects::{Dipole, Drag, GravityGradient, Rotor, Spring, Torque};
use liestep::mechanics::{DiscreteLagrangian, Effect, OneVector, Regular};
use liestep::prelude::*;
use nalgebra::{UnitQuaternion, Vector3};
use workbench::measure::relative;

use super::started;

fn body(moments: [f64; 3]) -> PrincipalBody {
    PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(moments.into()).unwrap() }
}

/// The state after this number of steps of 0.01 s, and the largest change of the axial momentum.
fn moved<L>(scene: L, count: usize) -> (StateOf<L>, f64)
where
    L: Regular + DiscreteLagrangian<Scalar = f64, Group = SO3, Advected: OneVector<Scalar = f64>>,
{
    let (stepper, mut state) = started(scene, 0.01);
    let axial = stepper.momentum_along_advected(&state);
    let mut error = 0.0_f64;
    for _ in 0..count {
        stepper.step(&mut state).unwrap();
        error = error.max((stepper.momentum_along_advected(&state) - axial).abs());
    }
    (state, error)
}

/// A dipole `m` in a field `B` is a weight with `m g ρ = −m` and the vertical `B`; so is a spring of no length with
/// `m g ρ = −k r` and the vertical `a`.
#[test]
fn dipole_and_spring_are_weights() {
    let mut r = Random::new(5);
    for _ in 0..5 {
        let (lever, direction, k) = (r.vector(), r.vector(), 2.0 + r.signed());
        let weight = Gravity { m: k, g: 1.0, rho: -lever, up: direction };
        let (expected, _) = moved(body([2.0, 3.0, 4.5]) + weight, 1000);
        let (dipole, first) = moved(body([2.0, 3.0, 4.5]) + Dipole { moment: lever * k, field: direction }, 1000);
        let spring = Spring { k, length: 0.0, at: lever, anchor: direction };
        let (spring, second) = moved(body([2.0, 3.0, 4.5]) + spring, 1000);
        let errors = [
            relative(&dipole.momentum(), &expected.momentum()),
            relative(&spring.momentum(), &expected.momentum()),
            first,
            second,
        ];
        println!("{errors:?}");
        assert!(errors.iter().all(|&error| error < 1e-11), "{errors:?}");
    }
}

/// The library's potentials are those of a textbook, with the vectors in space.
#[test]
fn potentials_are_those_of_the_continuous_system() {
    let mut r = Random::new(6);
    for _ in 0..20 {
        let (attitude, at, anchor) = (r.rotation(), r.vector(), r.vector());
        let R = *attitude.as_matrix();
        let J = Inertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).unwrap();
        let spring = Spring { k: 3.0, length: 0.7, at, anchor };
        let gradient = GravityGradient { GM: 5.0, r: 2.0, J, direction: anchor };
        let stretch = (R * at - anchor).norm() - 0.7;
        let n = R.transpose() * anchor;
        let checks = [
            (-spring.limit(None, &(R.transpose() * anchor)).l, 1.5 * stretch * stretch),
            (-gradient.limit(None, &n).l, 1.5 * 5.0 / 8.0 * n.dot(&(J.as_matrix() * n))),
        ];
        assert!(
            checks.iter().all(|(found, expected)| (found - expected).abs() < 1e-13 * (1.0 + expected)),
            "{checks:?}"
        );
    }
}

/// Small librations about a principal axis have `ω² = 3 GM/r³ (J_2 − J_1)/J_3`, and in the discrete flow, which is then
/// that of Störmer and Verlet, `sin(ω_h h/2) = ω h/2`.
#[test]
fn librations_in_the_gravity_gradient() {
    let moments = [1.0, 2.0, 2.5];
    let (GM, r, h, amplitude) = (7.0, 1.5_f64, 0.05, 1e-4);
    for axis in 0..3 {
        // The libration is about one axis, between the two others; the axis of the lesser moment points to the mass.
        let (low, high) = if axis == 0 { (1, 2) } else { (0, 3 - axis) };
        let J = Inertia::from_principal_moments(moments.into()).unwrap();
        let direction = Vector3::ith(low, 1.0);
        let stepper = Stepper::new(body(moments) + GravityGradient { GM, r, J, direction }, h).unwrap();
        let tilt = Vector3::ith(axis, amplitude);
        let mut state = stepper.start(UnitQuaternion::from_scaled_axis(tilt), Vector3::zeros()).unwrap();
        let omega = (3.0 * GM / r.powi(3) * (moments[high] - moments[low]) / moments[axis]).sqrt();
        let discrete = 2.0 / h * (omega * h / 2.0).asin();
        for step in 1..=1000 {
            stepper.step(&mut state).unwrap();
            let expected = amplitude * (discrete * h * f64::from(step)).cos();
            let angle = SO3::vee(&state.attitude().matrix())[axis];
            assert!((angle - expected).abs() < 1e-5 * amplitude, "{axis} {step}: {angle:e} {expected:e}");
        }
        // The continuous frequency differs enough for the test to distinguish both.
        assert!((discrete - omega) * h * 1000.0 > 0.01);
    }
}

/// A body with drag turns at `τ/c` under a constant torque, and the velocity computed from its momentum is
/// `(τ/c)(1 + ½ x y³/(1 + y²)^{3/2})`, as the page of `Drag` has it.
#[test]
fn what_drag_shows_of_a_velocity() {
    let (h, tau) = (0.1, 0.01);
    for (x, times) in [(0.01, 1.000_000_017), (1.0, 1.288), (10.0, 5.967), (100.0, 50.997)] {
        let J = Inertia::from_principal_moments(Vector3::repeat(2.0)).unwrap();
        let (c, y) = (x * 2.0 / h, 1.5 * x);
        let scene = body([2.0; 3]) + Drag { c, J } + Torque { torque: Vector3::z() * (tau * c) };
        let stepper = Stepper::new(scene, h).unwrap();
        let mut state = stepper.start(SO3::identity(), Vector3::z() * tau).unwrap();
        stepper.run(&mut state, 20_000).unwrap();
        let before = state.attitude();
        stepper.step(&mut state).unwrap();
        let turned = (before.inverse().compose(&state.attitude())).log().z.sin() / h;
        let read = stepper.velocity(&state).z;
        println!("{x}: turns at {turned}, read {read}");
        assert!((turned / tau - 1.0).abs() < 1e-10, "{x}: {turned}");
        assert!((read / tau / (1.0 + 0.5 * x * (y / (1.0 + y * y).sqrt()).powi(3)) - 1.0).abs() < 1e-10, "{x}: {read}");
        assert!((read / tau / times - 1.0).abs() < 1e-3, "{x}: {read}");
    }
}

/// A spin about the intermediate axis is unstable by itself, and stable with a rotor on that axis of more than the
/// difference to the major moment: `(J_2 Ω + s − J_1 Ω)(J_2 Ω + s − J_3 Ω) > 0`.
#[test]
fn a_rotor_stabilises_the_intermediate_axis() {
    let wobble = |spin: f64| {
        let scene = body([1.0, 2.0, 2.5]) + Rotor { spin: Vector3::new(0.0, spin, 0.0) };
        let stepper = Stepper::new(scene, 0.02).unwrap();
        let mut state = stepper.start(SO3::identity(), Vector3::new(1e-3, 1.0, 1e-3)).unwrap();
        let (momentum, energy) = (stepper.spatial_momentum(&state), stepper.energy(&state));
        let mut most = 0.0_f64;
        for _ in 0..5000 {
            stepper.step(&mut state).unwrap();
            let velocity = stepper.velocity(&state);
            most = most.max(velocity.x.hypot(velocity.z));
            assert!(relative(&stepper.spatial_momentum(&state), &momentum) < 1e-12);
            assert!((stepper.energy(&state) - energy).abs() < 1e-3 * energy);
        }
        most
    };
    let [alone, too_slow, fast] = [0.0, 0.4, 0.6].map(wobble);
    println!("{alone} {too_slow} {fast}");
    assert!(alone > 0.5 && too_slow > 0.1 && fast < 0.01, "{alone} {too_slow} {fast}");
}
