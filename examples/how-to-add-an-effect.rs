//! How to add an effect: a potential and a force of your own, in a sum with those of the library.
//!
//! ```text
//! cargo run -p liestep-examples --example how-to-add-an-effect
//! ```

use std::error::Error;

use liestep::effects::{Gravity, RigidBody};
use liestep::mechanics::Effect as _;
use liestep::nalgebra::{UnitQuaternion, Vector3};
use liestep::{NonstandardInertia, Stepper, force, lagrangian};

/// A wire along the vertical that resists being bent: `V = ½ k (1 − axis·w)²`.
///
/// Half of `−h V` belongs to either end of a step. The vertical in the body frame is `w` at its start and `F⁻¹·w` at
/// its end, and `axis·(F⁻¹·w)` is `w·(F axis)`.
#[lagrangian(
    group = liestep::SO3,
    advected(w = up),
    l_d = -0.25 * h * k * ((1.0 - w.dot(&axis)).powi(2) + (1.0 - w.dot(&(F * axis))).powi(2)),
)]
#[derive(Clone, Copy, Debug)]
struct Wire {
    /// Stiffness, N m.
    k: f64,
    /// The direction of the wire at the body, a unit vector in the body frame.
    axis: Vector3<f64>,
    /// The vertical, in space.
    up: Vector3<f64>,
}

/// A motor that drives the body about a body-fixed axis, by its virtual work in a step.
///
/// `eta` and `eta_next` are the virtual rotations of the body at either end; each end receives half of the impulse.
#[force(group = liestep::SO3, work = 0.5 * h * torque * axis.dot(&(eta + eta_next)))]
#[derive(Clone, Copy, Debug)]
struct Motor {
    /// The torque, N m.
    torque: f64,
    /// The axis, a unit vector in the body frame.
    axis: Vector3<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let up = Vector3::z();
    let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))? };
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up };
    let wire = Wire { k: 30.0, axis: Vector3::z(), up };
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
    let velocity = Vector3::new(0.5, 0.0, 1.0);

    // The derived equations, as text. `cargo doc` lists them in the documentation of the struct.
    println!("{}\n\n{}\n", Wire::DERIVATION, Motor::DERIVATION);

    // Two effects that advect `up` have a copy of it each.
    let stepper = Stepper::new(body + gravity + wire, 0.01)?;
    let mut state = stepper.start(attitude, velocity)?;
    let (energy, vertical) = (stepper.energy(&state), state.momentum_along(&up));
    stepper.run(&mut state, 10_000)?;
    let drift = (stepper.energy(&state) - energy).abs();
    let lost = (state.momentum_along(&up) - vertical).abs();
    println!("with a wire: energy within {drift:.1e} J, vertical momentum within {lost:.1e} kg m²/s");
    assert!(drift < 1e-2 * energy.abs());
    assert!(lost < 1e-10);

    // A force does work: 0.5 N m for 2 s, about an axis of symmetry without any other torque.
    let motor = Motor { torque: 0.5, axis: Vector3::z() };
    let driven = Stepper::new(body + gravity + wire + motor, 0.01)?;
    let mut state = driven.start(attitude, velocity)?;
    let before = state.momentum().z;
    driven.run(&mut state, 200)?;
    println!("with a motor: the axial momentum rose by {:.12} kg m²/s", state.momentum().z - before);
    assert!((state.momentum().z - before - 1.0).abs() < 1e-11);
    Ok(())
}

#[test]
fn an_effect_of_ones_own_adds() -> Result<(), Box<dyn Error>> {
    main()
}
