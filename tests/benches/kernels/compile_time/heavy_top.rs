//! (3.13) in principal axes, declared and stepped.

use liestep::prelude::*;
use nalgebra::Vector3;

const EDIT: u32 = 0;

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
#[allow(non_snake_case)] // the letters of the field
struct HeavyTop {
    J_d: DiagonalNonstandardInertia,
    m: f64,
    g: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let inertia = DiagonalNonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
    let top = HeavyTop { J_d: inertia, m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let stepper = Stepper::new(top, 0.01)?;
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.5, 2.0, 12.0))?;
    stepper.step(&mut state)?;
    println!("{EDIT} {:?}", state.momentum());
    Ok(())
}
