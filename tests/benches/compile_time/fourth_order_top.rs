//! The heavy top of the fourth order, declared and stepped.

use liestep::{Inertia, LieGroup as _, SO3, Stepper, lagrangian};
use nalgebra::Vector3;

const EDIT: u32 = 0;

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let xi = log(F);
        let x = 2.0 * vee(F) / (1.0 + F.trace()).sqrt();
        let next = F.transpose() * w;
        let f = (J * x).cross(&x) / h.powi(2) + 0.5 * weight * (w + next).cross(&rho);
        xi.dot(&(J * xi)) / (2.0 * h) - 0.5 * h * weight * (w + next).dot(&rho)
            + (h / 12.0) * weight * (next - w).cross(&x).dot(&rho)
            - (h.powi(3) / 24.0) * f.dot(&(inverse(J) * f))
    },
)]
#[allow(non_snake_case)] // the letters of the field
struct FourthOrderTop {
    J: Inertia,
    weight: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let inertia = Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0))?;
    let top = FourthOrderTop { J: inertia, weight: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let stepper = Stepper::new(top, 0.01)?;
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.5, 2.0, 12.0))?;
    stepper.step(&mut state)?;
    println!("{EDIT} {:?}", state.momentum());
    Ok(())
}
