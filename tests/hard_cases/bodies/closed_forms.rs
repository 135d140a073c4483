//! Motions that are known in closed form: on the separatrix, of symmetric bodies, and a symmetric top that precesses
//! regularly. Each is met to the order of the scheme, and its invariants are kept to rounding.

use checks::random::Random;
use declarations::{FreeBody, HeavyTop};
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::prelude::*;
use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use workbench::measure::{four_halvings, order, relative, steps_in};

/// Well above what some thousand steps lose to rounding, and what a saddle makes of it.
const PLATEAU: f64 = 1e-11;

/// After the time `t`; `see` is shown every state.
fn end<L>(
    lagrangian: L,
    h: f64,
    t: f64,
    start: (SO3, Vector3<f64>),
    mut see: impl FnMut(&Stepper<L>, &StateOf<L>),
) -> (Stepper<L>, StateOf<L>)
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular,
{
    let stepper = Stepper::new(lagrangian, h).unwrap();
    let mut state = stepper.start(start.0, start.1).unwrap();
    for _ in 0..steps_in(t, h) {
        stepper.step(&mut state).unwrap();
        see(&stepper, &state);
    }
    (stepper, state)
}

fn assert_second_order(errors: &[(f64, f64)]) {
    let order = order(errors, PLATEAU);
    println!("order {order:.4}, {errors:?}");
    assert!((order - 2.0).abs() < 0.05, "order {order}, {errors:?}");
}

/// `R = R_0 exp(t p_0/J_1) exp(−t (1/J_1 − 1/J_3) p_3 E_3)`, from any state and for oblate and prolate bodies.
#[test]
fn b8_symmetric_bodies() {
    let mut random = Random::new(8);
    for j in [[3.0, 3.0, 4.0], [3.0, 3.0, 1.0], [1.0, 1.0, 1e-3]] {
        let (attitude, velocity) = (random.rotation(), random.vector() * 2.0);
        let (t, momentum) = (4.0, Vector3::from(j).component_mul(&velocity));
        let turn = UnitQuaternion::from_scaled_axis(momentum * (t / j[0]))
            * UnitQuaternion::from_scaled_axis(Vector3::z() * (-t * (1.0 / j[0] - 1.0 / j[2]) * momentum.z));
        let expected = attitude.compose(&SO3::from(turn)).matrix();
        let errors = four_halvings(0.01).map(|h| {
            let mut axial = None;
            let (_, state) = end(FreeBody::with_moments(j), h, t, (attitude, velocity), |_, state| {
                let axial: f64 = *axial.get_or_insert(state.momentum().z);
                // Less than a rounding in each of up to 6400 steps: the full tensor doesn't know its symmetry.
                assert!((state.momentum().z - axial).abs() < 1e-13 * momentum.norm(), "p_3 of {j:?}");
            });
            (h, relative(&state.attitude().matrix(), &expected))
        });
        assert_second_order(&errors);
    }
}

/// At a constant tilt, `R = R_z(ωt) R_x(θ) R_z(σt)`: the precession `ω` and the spin balance the weight where
/// `J_1 ω² cos θ − J_3 Ω_3 ω + m g l = 0` with `Ω_3 = σ + ω cos θ`.
#[test]
fn b8_regular_precession() {
    let (top, tilt, precession, t) = (HeavyTop::thesis(), 0.8_f64, 0.9, 4.0);
    let (weight, across, along) = (9.81, 3.0, 4.0);
    let axial = (across * precession * precession * tilt.cos() + weight) / (along * precession);
    let spin = axial - precession * tilt.cos();
    let attitude = |t: f64| {
        let [x, z] = [Vector3::x_axis(), Vector3::z_axis()];
        let about = |axis, angle| Rotation3::from_axis_angle(&axis, angle);
        SO3::from(about(z, precession * t) * about(x, tilt) * about(z, spin * t))
    };
    let velocity = Vector3::new(0.0, precession * tilt.sin(), axial);
    let errors = four_halvings(0.01).map(|h| {
        let start = (attitude(0.0), velocity);
        let vertical = start.0.inverse().matrix() * top.up;
        let momentum = Vector3::new(across, across, along).component_mul(&velocity);
        let (_, state) = end(top.clone(), h, t, start, |_, state| {
            assert!(state.momentum().z.to_bits() == momentum.z.to_bits(), "p_3");
            // Less than a rounding in each of up to 6400 steps, at random.
            assert!((state.advected().norm() - 1.0).abs() < 1e-13);
            let casimir = momentum.dot(&vertical);
            assert!((state.momentum().dot(&state.advected()) / casimir - 1.0).abs() < 1e-13);
        });
        (h, relative(&state.attitude().matrix(), &attitude(t).matrix()))
    });
    assert_second_order(&errors);
}
