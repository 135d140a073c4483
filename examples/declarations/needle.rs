//! A body with a pace, and the same body without.

use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

/// A body whose axis is attracted by a direction.
macro_rules! needle {
    ($name:ident { $($energy:ident)? } $($pace:tt)*) => {
        #[lagrangian(
            group = SO3,
            advected(w = a),
            $($pace)*
            l_d = {
                let U = |w: Vector3<f64>| ((w - rho).norm_squared() + delta * delta).sqrt();
                ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
                    + 0.5 * h * (1.0 / U(w) + 1.0 / U(F.transpose() * w))
            },
        )]
        #[derive(Clone, Copy, Debug)]
        pub struct $name {
            pub J_d: NonstandardInertia,
            pub a: Vector3<f64>,
            pub rho: Vector3<f64>,
            pub delta: f64,
            $(pub $energy: f64,)?
        }
    };
}

needle! { EqualNeedle {} }
needle! { Needle { energy }
    given(E_0 = energy),
    pace = {
        let u = ((w - rho).norm_squared() + delta * delta).sqrt();
        2.0 * u * u.sqrt()
    },
}

impl Needle {
    pub fn new(delta: f64) -> Self {
        let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 1.4, 2.0)).unwrap();
        Self { J_d, a: Vector3::new(0.0, 0.6, 0.8), rho: Vector3::z(), delta, energy: 0.0 }
    }

    /// The gap and the pace in plain Rust.
    pub fn gap(&self, w: &Vector3<f64>) -> f64 {
        ((w - self.rho).norm_squared() + self.delta * self.delta).sqrt()
    }

    pub fn pace(&self, w: &Vector3<f64>) -> f64 {
        2.0 * self.gap(w).powf(1.5)
    }
}
