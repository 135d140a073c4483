//! The declarations of [`super::tops`] written by hand, in Cayley form.

use liestep::__private::Parameter as _;
use liestep::{CayleyRetraction, DiscreteLagrangian, SO3, SetupError};
use nalgebra::{Matrix3, Vector3};

use super::tops::{FreeBody, FullTop, HeavyTop};

/// `(M − Mᵀ)^∨`.
fn skew(m: Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12)
}

fn ordinary(nonstandard: Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::from_diagonal_element(nonstandard.trace()) - nonstandard
}

fn newton(j: &Matrix3<f64>, a: &Vector3<f64>, xi: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let y = xi * 0.5;
    let jy = j * y;
    let residual = (jy + y.cross(&jy)) * 2.0 - a * (1.0 + y.norm_squared());
    (residual, j + y.cross_matrix() * j - jy.cross_matrix() - a * y.transpose())
}

macro_rules! by_hand {
    ($top:ty, $advected:ty, |$self:ident, $w:ident| weight $weight:expr, rho $rho:expr, up $up:expr, seen $seen:expr,
     fields $($field:ident)*) => {
        impl DiscreteLagrangian for $top {
            type Scalar = f64;
            type Group = SO3;
            type Retraction = CayleyRetraction;
            type Advected = $advected;
            type Constants = (Matrix3<f64>, Vector3<f64>);
            type StepTerms = Vector3<f64>;

            const DERIVATION: &'static str = "by hand";

            fn validate(&self) -> Result<(), SetupError> {
                self.J_d.validate("J_d")?;
                $(self.$field.validate(stringify!($field))?;)*
                Ok(())
            }

            fn advected(&$self) -> $advected {
                $up
            }

            fn l_d(&$self, f: &Matrix3<f64>, $w: &$advected, h: f64) -> f64 {
                let d = f - Matrix3::identity();
                let (weight, rho, w) = ($weight, $rho, $seen);
                (d * $self.J_d.value() * d.transpose()).trace() / (2.0 * h)
                    - 0.5 * h * weight * w.dot(&(rho + f * rho))
            }

            fn right_momentum(&$self, f: &Matrix3<f64>, $w: &$advected, h: f64) -> Vector3<f64> {
                let (weight, rho, w): (f64, Vector3<f64>, Vector3<f64>) = ($weight, $rho, $seen);
                skew(f * $self.J_d.value()) / h - (f * rho).cross(&w) * (0.5 * h * weight)
            }

            fn left_momentum(&$self, f: &Matrix3<f64>, $w: &$advected, h: f64) -> Vector3<f64> {
                let (weight, rho, w): (f64, Vector3<f64>, Vector3<f64>) = ($weight, $rho, $seen);
                skew($self.J_d.value() * f) / h + (f.transpose() * w).cross(&rho) * (0.5 * h * weight)
            }

            fn diamond(&$self, f: &Matrix3<f64>, $w: &$advected, h: f64) -> Vector3<f64> {
                let (weight, rho, w): (f64, Vector3<f64>, Vector3<f64>) = ($weight, $rho, $seen);
                w.cross(&(rho + f * rho)) * (0.5 * h * weight)
            }

            fn momentum_jacobian(&self, f: &Matrix3<f64>, _: &$advected, h: f64) -> Matrix3<f64> {
                ordinary(f * self.J_d.value()) / h
            }

            fn discrete_energy(&$self, f: &Matrix3<f64>, $w: &$advected, h: f64) -> f64 {
                let d = f - Matrix3::identity();
                let (weight, rho, w) = ($weight, $rho, $seen);
                (d * $self.J_d.value() * d.transpose()).trace() / (2.0 * h * h)
                    + 0.5 * weight * w.dot(&(rho + f * rho))
            }

            fn inertia(&self) -> Matrix3<f64> {
                ordinary(self.J_d.value())
            }

            fn momentum_bias(&self, _: &$advected) -> Vector3<f64> {
                Vector3::zeros()
            }

            fn potential(&$self, $w: &$advected) -> f64 {
                $weight * $rho.dot(&$seen)
            }

            fn constants(&$self, h: f64) -> Self::Constants {
                (ordinary($self.J_d.value()) / h, $rho * (0.5 * h * $weight))
            }

            fn kick_before((_, lever): &Self::Constants, $w: &$advected) -> Vector3<f64> {
                $seen.cross(lever)
            }

            fn step_terms(_: &Self::Constants, a: &Vector3<f64>, _: &$advected) -> Vector3<f64> {
                *a
            }

            fn newton_system(
                (j, _): &Self::Constants,
                a: &Vector3<f64>,
                xi: &Vector3<f64>,
            ) -> (Vector3<f64>, Matrix3<f64>) {
                newton(j, a, xi)
            }

            fn kick_after((_, lever): &Self::Constants, _: &Matrix3<f64>, $w: &$advected) -> Vector3<f64> {
                $seen.cross(lever)
            }
        }
    };
}

by_hand!(HeavyTop, Vector3<f64>, |self, w| weight self.m * self.g, rho self.rho, up self.up, seen (*w),
    fields m g rho up);
by_hand!(FullTop, Vector3<f64>, |self, w| weight self.m * self.g, rho self.rho, up self.up, seen (*w),
    fields m g rho up);
by_hand!(FreeBody, (), |self, _w| weight 0.0, rho Vector3::<f64>::zeros(), up (), seen Vector3::<f64>::zeros(),
    fields);
