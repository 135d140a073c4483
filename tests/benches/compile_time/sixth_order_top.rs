//! The heavy top of the sixth order, declared and stepped.

use liestep::{Inertia, LieGroup as _, SO3, Stepper, lagrangian};
use nalgebra::Vector3;

const EDIT: u32 = 0;

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let xi = log(F);
        let om = xi / h;
        let middle = exp(-0.5 * xi) * w;
        let momentum = J * om;
        let f = momentum.cross(&om) + weight * middle.cross(&rho);
        let a = inverse(J) * f;
        let b = inverse(J) * (f.cross(&om) + momentum.cross(&a) - J * om.cross(&a)
            + weight * middle.cross(&om).cross(&rho));

        // The nodes t = h/2 and h/2 ± σ.
        let sigma = 0.3872983346207417 * h;
        let bend = (-h * h / 20.0) * a;
        let twist = (h * h * sigma / 60.0) * b;
        let stretch = (h * h / 30.0) * b;
        let eta1 = bend + twist;
        let eta2 = (-h * h / 8.0) * a;
        let eta3 = bend - twist;
        let rate1 = stretch - sigma * a;
        let rate2 = (-h * h / 24.0) * b;
        let rate3 = stretch + sigma * a;
        let velocity1 = om + rate1 - eta1.cross(&(om + 0.5 * rate1
            - 0.5 * eta1.cross(&(om + rate1 / 3.0 - eta1.cross(&om) / 3.0))));
        let velocity2 = om + rate2 - eta2.cross(&(om + 0.5 * rate2
            - 0.5 * eta2.cross(&(om + rate2 / 3.0 - eta2.cross(&om) / 3.0))));
        let velocity3 = om + rate3 - eta3.cross(&(om + 0.5 * rate3
            - 0.5 * eta3.cross(&(om + rate3 / 3.0 - eta3.cross(&om) / 3.0))));
        let w1 = exp(-0.1127016653792583 * xi) * w;
        let w3 = exp(-0.8872983346207417 * xi) * w;
        let kinetic = (5.0 * velocity1.dot(&(J * velocity1)) + 8.0 * velocity2.dot(&(J * velocity2))
            + 5.0 * velocity3.dot(&(J * velocity3))) / 2.0;
        let r1 = rho + eta1.cross(&(rho + 0.5 * eta1.cross(&(rho + eta1.cross(&rho) / 3.0))));
        let r2 = rho + eta2.cross(&(rho + 0.5 * eta2.cross(&(rho + eta2.cross(&rho) / 3.0))));
        let r3 = rho + eta3.cross(&(rho + 0.5 * eta3.cross(&(rho + eta3.cross(&rho) / 3.0))));
        let potential = weight * (5.0 * w1.dot(&r1) + 8.0 * middle.dot(&r2)
            + 5.0 * w3.dot(&r3));
        (h / 18.0) * (kinetic - potential)
    },
)]
#[allow(non_snake_case)] // the letters of the field
struct SixthOrderTop {
    J: Inertia,
    weight: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let inertia = Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0))?;
    let top = SixthOrderTop { J: inertia, weight: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let stepper = Stepper::new(top, 0.01)?;
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.5, 2.0, 12.0))?;
    stepper.step(&mut state)?;
    println!("{EDIT} {:?}", state.momentum());
    Ok(())
}
