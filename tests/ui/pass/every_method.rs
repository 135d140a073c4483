//! All methods and functions of the attribute's documentation, in a block whose `let`s hide each other and the fields.

use liestep::mechanics::{DiscreteLagrangian as _, Inertia};
use liestep::numbers::Real;
use liestep::{SO3, Stepper, lagrangian};
use nalgebra::{Matrix3, Vector3};

macro_rules! declare {
    ($name:ident $(<$parameter:ident: $bound:ident>)?, $scalar:ty) => {
        #[lagrangian(
            group = SO3,
            advected(w = up),
            l_d = {
                let d = F - I;
                let d = (d * inertia.trace() * d.transpose()).trace() / 2.0 - (d * inertia * d.transpose()).trace();
                let kinetic = d / (2.0 * h);
                let rho = F * rho;
                let rho = rho.component_mul(&axes) + axes.cross(&rho) + axes.cross_matrix() * rho;
                let skew = { let rho = vee(F * matrix); rho.dot(&rho) };
                let norms = (w - rho).norm() + rho.norm_squared() + (F - matrix).norm_squared();
                let angle = k * w.dot(&rho) / (3.0 + k.powi(2));
                let waves = angle.sin() + angle.cos() + (angle - 1.0).exp();
                let roots = (2.0 + angle.powi(2)).sqrt() + (2.0 + angle.powi(2)).ln();
                let entries = rho[0] * w.x + rho.y * w[1] + F[(2, 1)] * matrix[(0, 2)] + -w.z;
                kinetic - h * (skew + norms + waves + roots + entries)
            },
        )]
        struct $name $(<$parameter: $bound>)? {
            inertia: Inertia<$scalar>,
            matrix: Matrix3<$scalar>,
            axes: Vector3<$scalar>,
            k: $scalar,
            rho: Vector3<$scalar>,
            up: Vector3<$scalar>,
        }
    };
}

declare!(Plain, f64);
declare!(Generic<T: Real>, T);

macro_rules! top {
    ($name:ident) => {
        $name {
            inertia: Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0)).unwrap(),
            matrix: Matrix3::new(0.1, 0.2, 0.3, -0.4, 0.5, 0.6, -0.7, 0.8, -0.9),
            axes: Vector3::new(0.3, 0.1, -0.2),
            k: 0.7,
            rho: Vector3::new(0.2, -0.1, 0.4),
            up: Vector3::new(1.0, 2.0, -0.5),
        }
    };
}

pub fn main() {
    let (plain, generic) = (top!(Plain), top!(Generic));
    let (f, w, h) = (Matrix3::identity(), Vector3::new(1.0, -2.0, 0.5), 0.01);
    assert_eq!(plain.l_d(&f, &w, h), generic.l_d(&f, &w, h));
    let stepper = Stepper::new(plain, h).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 1.0)).unwrap();
    stepper.step(&mut state).unwrap();
    assert_eq!(state.steps(), 1);
}
