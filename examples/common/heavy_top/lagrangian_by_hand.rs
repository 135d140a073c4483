//! What the attribute on `HeavyTop` derives, written out.

use liestep::{CayleyRetraction, DiscreteLagrangian, SO3, SetupError};
use nalgebra::{Matrix3, Vector3};

use super::lagrangian::HeavyTop;

/// `(M − Mᵀ)^∨`.
fn skew(m: Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12)
}

impl HeavyTop {
    fn kinetic(&self, f: &Matrix3<f64>) -> f64 {
        let d = f - Matrix3::identity();
        0.5 * (d * self.J_d.to_matrix() * d.transpose()).trace()
    }

    fn heights(&self, f: &Matrix3<f64>, w: &Vector3<f64>) -> f64 {
        0.5 * self.m * self.g * w.dot(&(self.rho + f * self.rho))
    }
}

impl DiscreteLagrangian for HeavyTop {
    type Scalar = f64;
    type Group = SO3;
    type Retraction = CayleyRetraction;
    type Advected = Vector3<f64>;
    /// The diagonal of `J/h`, and `(h/2) m g ρ`.
    type Constants = (Vector3<f64>, Vector3<f64>);
    type StepTerms = Vector3<f64>;

    const DERIVATION: &'static str = "the heavy top (3.13), by hand";

    fn validate(&self) -> Result<(), SetupError> {
        Ok(())
    }

    fn advected(&self) -> Vector3<f64> {
        self.up
    }

    fn l_d(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> f64 {
        self.kinetic(f) / h - h * self.heights(f, w)
    }

    fn right_momentum(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> Vector3<f64> {
        skew(f * self.J_d.to_matrix()) / h - (f * self.rho).cross(w) * (0.5 * h * self.m * self.g)
    }

    fn left_momentum(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> Vector3<f64> {
        skew(self.J_d.to_matrix() * f) / h + (f.transpose() * w).cross(&self.rho) * (0.5 * h * self.m * self.g)
    }

    fn diamond(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> Vector3<f64> {
        w.cross(&(self.rho + f * self.rho)) * (0.5 * h * self.m * self.g)
    }

    fn momentum_jacobian(&self, f: &Matrix3<f64>, _: &Vector3<f64>, h: f64) -> Matrix3<f64> {
        let p = f * self.J_d.to_matrix() / h;
        Matrix3::from_diagonal_element(p.trace()) - p
    }

    fn discrete_energy(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> f64 {
        self.kinetic(f) / (h * h) + self.heights(f, w)
    }

    fn inertia(&self) -> Matrix3<f64> {
        let j_d = self.J_d.to_matrix();
        Matrix3::from_diagonal_element(j_d.trace()) - j_d
    }

    fn momentum_bias(&self, _: &Vector3<f64>) -> Vector3<f64> {
        Vector3::zeros()
    }

    fn potential(&self, w: &Vector3<f64>) -> f64 {
        self.m * self.g * w.dot(&self.rho)
    }

    fn constants(&self, h: f64) -> Self::Constants {
        (self.inertia().diagonal() / h, self.rho * (0.5 * h * self.m * self.g))
    }

    #[inline]
    fn kick_before((_, lever): &Self::Constants, w: &Vector3<f64>) -> Vector3<f64> {
        w.cross(lever)
    }

    #[inline]
    fn step_terms(_: &Self::Constants, a: &Vector3<f64>, _: &Vector3<f64>) -> Vector3<f64> {
        *a
    }

    #[inline]
    fn newton_system((j, _): &Self::Constants, a: &Vector3<f64>, xi: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
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
    fn kick_after((_, lever): &Self::Constants, _: &Matrix3<f64>, next: &Vector3<f64>) -> Vector3<f64> {
        next.cross(lever)
    }
}
