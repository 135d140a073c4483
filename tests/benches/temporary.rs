//! The diagonal heavy top (3.13) as an implementation of the library's trait.

use liestep::{CayleyRetraction, DiagonalNonstandardInertia, DiscreteLagrangian, NonstandardInertia, SO3, SetupError};
use nalgebra::{Matrix3, Vector3};

#[derive(Clone, Debug)]
pub(crate) struct HeavyTop {
    pub(crate) inertia: DiagonalNonstandardInertia,
    /// `m g`, N.
    pub(crate) weight: f64,
    pub(crate) rho: Vector3<f64>,
}

/// `(M − Mᵀ)^∨`.
fn skew(m: Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12)
}

impl HeavyTop {
    fn matrix(&self) -> Matrix3<f64> {
        self.inertia.to_matrix()
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Constants {
    /// `J/h`.
    moments: Vector3<f64>,
    /// `(J_3 − J_2, J_1 − J_3, J_2 − J_1)/2h`.
    differences: Vector3<f64>,
    /// `(h/2) m g ρ`.
    lever: Vector3<f64>,
}

impl DiscreteLagrangian for HeavyTop {
    type Scalar = f64;
    type Group = SO3;
    type Retraction = CayleyRetraction;
    type Advected = Vector3<f64>;
    type Constants = Constants;
    /// `a/2`.
    type StepTerms = Vector3<f64>;

    const DERIVATION: &'static str = "the heavy top (3.13), by hand";

    fn validate(&self) -> Result<(), SetupError> {
        Ok(())
    }

    fn advected(&self) -> Vector3<f64> {
        Vector3::z()
    }

    fn l_d(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> f64 {
        let d = f - Matrix3::identity();
        (d * self.matrix() * d.transpose()).trace() / (2.0 * h)
            - 0.5 * h * self.weight * w.dot(&(self.rho + f * self.rho))
    }

    fn right_momentum(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> Vector3<f64> {
        skew(f * self.matrix()) / h - (f * self.rho).cross(w) * (0.5 * h * self.weight)
    }

    fn left_momentum(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> Vector3<f64> {
        skew(self.matrix() * f) / h + (f.transpose() * w).cross(&self.rho) * (0.5 * h * self.weight)
    }

    fn diamond(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> Vector3<f64> {
        w.cross(&(self.rho + f * self.rho)) * (0.5 * h * self.weight)
    }

    fn momentum_jacobian(&self, f: &Matrix3<f64>, _: &Vector3<f64>, h: f64) -> Matrix3<f64> {
        let p = f * self.matrix() / h;
        Matrix3::from_diagonal_element(p.trace()) - p
    }

    fn discrete_energy(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> f64 {
        let d = f - Matrix3::identity();
        (d * self.matrix() * d.transpose()).trace() / (2.0 * h * h)
            + 0.5 * self.weight * w.dot(&(self.rho + f * self.rho))
    }

    fn inertia(&self) -> Matrix3<f64> {
        *NonstandardInertia::from(self.inertia).to_inertia().as_matrix()
    }

    fn momentum_bias(&self, _: &Vector3<f64>) -> Vector3<f64> {
        Vector3::zeros()
    }

    fn potential(&self, w: &Vector3<f64>) -> f64 {
        self.weight * w.dot(&self.rho)
    }

    fn constants(&self, h: f64) -> Constants {
        let d = self.inertia.diagonal();
        Constants {
            moments: Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y) / h,
            differences: Vector3::new(d.y - d.z, d.z - d.x, d.x - d.y) / (2.0 * h),
            lever: self.rho * (0.5 * h * self.weight),
        }
    }

    #[inline(always)]
    fn kick_before(constants: &Constants, w: &Vector3<f64>) -> Vector3<f64> {
        w.cross(&constants.lever)
    }

    #[inline(always)]
    fn step_terms(_: &Constants, a: &Vector3<f64>, _: &Vector3<f64>) -> Vector3<f64> {
        a * 0.5
    }

    /// `J ξ + ξ × J ξ/2 − (1 + |ξ|²/4) a`, all over `h` where it is kinetic.
    #[inline(always)]
    fn newton_system(constants: &Constants, half: &Vector3<f64>, xi: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let (j, d) = (&constants.moments, &constants.differences);
        let s = 2.0 + 0.5 * (xi.x * xi.x + xi.y * xi.y + xi.z * xi.z);
        let (d1y, d1z) = (d.x * xi.y, d.x * xi.z);
        let (d2x, d2z) = (d.y * xi.x, d.y * xi.z);
        let (d3x, d3y) = (d.z * xi.x, d.z * xi.y);
        let residual = Vector3::new(
            j.x * xi.x + d1y * xi.z - s * half.x,
            j.y * xi.y + d2z * xi.x - s * half.y,
            j.z * xi.z + d3x * xi.y - s * half.z,
        );
        let jacobian = Matrix3::new(
            j.x - half.x * xi.x,
            d1z - half.x * xi.y,
            d1y - half.x * xi.z,
            d2z - half.y * xi.x,
            j.y - half.y * xi.y,
            d2x - half.y * xi.z,
            d3y - half.z * xi.x,
            d3x - half.z * xi.y,
            j.z - half.z * xi.z,
        );
        (residual, jacobian)
    }

    #[inline(always)]
    fn kick_after(constants: &Constants, _: &Matrix3<f64>, next: &Vector3<f64>) -> Vector3<f64> {
        next.cross(&constants.lever)
    }
}
