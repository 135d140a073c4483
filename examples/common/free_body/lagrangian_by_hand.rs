//! What the attribute on `FreeBody` derives, written out.

use liestep::{CayleyRetraction, DiscreteLagrangian, SO3, SetupError};
use nalgebra::{Matrix3, Vector3};

use super::lagrangian::FreeBody;

/// `(M − Mᵀ)^∨`.
fn skew(m: Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12)
}

impl DiscreteLagrangian for FreeBody {
    type Scalar = f64;
    type Group = SO3;
    type Retraction = CayleyRetraction;
    type Advected = ();
    /// The diagonal of `J/h`.
    type Constants = Vector3<f64>;
    type StepTerms = Vector3<f64>;

    const DERIVATION: &'static str = "the free rigid body, by hand";

    fn validate(&self) -> Result<(), SetupError> {
        Ok(())
    }

    fn advected(&self) {}

    fn l_d(&self, f: &Matrix3<f64>, (): &(), h: f64) -> f64 {
        let d = f - Matrix3::identity();
        (d * self.J_d.to_matrix() * d.transpose()).trace() / (2.0 * h)
    }

    fn right_momentum(&self, f: &Matrix3<f64>, (): &(), h: f64) -> Vector3<f64> {
        skew(f * self.J_d.to_matrix()) / h
    }

    fn left_momentum(&self, f: &Matrix3<f64>, (): &(), h: f64) -> Vector3<f64> {
        skew(self.J_d.to_matrix() * f) / h
    }

    fn diamond(&self, _: &Matrix3<f64>, (): &(), _: f64) -> Vector3<f64> {
        Vector3::zeros()
    }

    fn momentum_jacobian(&self, f: &Matrix3<f64>, (): &(), h: f64) -> Matrix3<f64> {
        let p = f * self.J_d.to_matrix() / h;
        Matrix3::from_diagonal_element(p.trace()) - p
    }

    fn discrete_energy(&self, f: &Matrix3<f64>, (): &(), h: f64) -> f64 {
        self.l_d(f, &(), h) / h
    }

    fn inertia(&self) -> Matrix3<f64> {
        let j_d = self.J_d.to_matrix();
        Matrix3::from_diagonal_element(j_d.trace()) - j_d
    }

    fn momentum_bias(&self, (): &()) -> Vector3<f64> {
        Vector3::zeros()
    }

    fn potential(&self, (): &()) -> f64 {
        0.0
    }

    fn constants(&self, h: f64) -> Vector3<f64> {
        self.inertia().diagonal() / h
    }

    #[inline]
    fn kick_before(_: &Vector3<f64>, (): &()) -> Vector3<f64> {
        Vector3::zeros()
    }

    #[inline]
    fn step_terms(_: &Vector3<f64>, a: &Vector3<f64>, (): &()) -> Vector3<f64> {
        *a
    }

    #[inline]
    fn newton_system(j: &Vector3<f64>, a: &Vector3<f64>, xi: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let y = xi * 0.5;
        let jy = j.component_mul(&y);
        let residual = (jy + y.cross(&jy)) * 2.0 - a * (1.0 + y.norm_squared());
        let hat_j = Matrix3::new(
            j.x,
            -y.z * j.y,
            y.y * j.z, //
            y.z * j.x,
            j.y,
            -y.x * j.z, //
            -y.y * j.x,
            y.x * j.y,
            j.z,
        );
        (residual, hat_j - jy.cross_matrix() - a * y.transpose())
    }

    #[inline]
    fn kick_after(_: &Vector3<f64>, _: &Matrix3<f64>, (): &()) -> Vector3<f64> {
        Vector3::zeros()
    }
}
