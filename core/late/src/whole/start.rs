//! Checks of a stepper and of a start: the inertia, the attitude, the velocity of a momentum.

use liestep::SetupError;
use liestep_derivation::Array;
use nalgebra::{DMatrix, DVector};

use super::family::{NOTHING, Name, WholeFamily};
use crate::code::Backend;

/// The largest distance from the group: a unit quaternion or a matrix with twelve printed digits passes.
const DEFECT: f64 = f64::EPSILON * 1e4;
/// The most iterations for the velocity of a momentum, and the most halvings of one.
const MOST: usize = 60;

impl<B: Backend<f64>> WholeFamily<B> {
    /// The identity, as the entries of an attitude.
    pub(super) fn identity(&self) -> Vec<f64> {
        let of = |rows: usize| (0..rows * rows).map(move |at| f64::from(u8::from(at / rows == at % rows)));
        self.factors.iter().flat_map(|factor| of(factor.size())).collect()
    }

    /// An attitude displaced by small coordinates of the algebra: `g (I + ξ̂)`, for the growth of rounding errors.
    #[must_use]
    pub fn displaced(&self, attitude: &[f64], coordinates: &[f64]) -> Vec<f64> {
        let mut displaced = attitude.to_vec();
        for (own, factor) in self.declaration.factors.iter().zip(&self.factors) {
            let rows = factor.size();
            let g = |row: usize, k: usize| attitude[factor.entry + row * rows + k];
            for (generator, xi) in own.generators.iter().zip(&coordinates[factor.component..]) {
                for at in 0..rows * rows {
                    let moved: f64 = (0..rows).map(|k| g(at / rows, k) * generator[k * rows + at % rows]).sum();
                    displaced[factor.entry + at] += moved * xi;
                }
            }
        }
        displaced
    }

    /// The advected parameters at an attitude.
    pub(super) fn seen(&self, numbers: &[f64], attitude: &[f64]) -> Vec<f64> {
        self.outputs(Name::Seen, &[], [(Array::Attitude, attitude), (Array::Parameters, numbers)])
    }

    pub(super) fn inertia(&self, numbers: &[f64], advected: &[f64]) -> DMatrix<f64> {
        let n = self.sizes.n;
        let given = [(Array::Parameters, numbers), (Array::Advected, advected), NOTHING];
        DMatrix::from_row_slice(n, n, &self.outputs(Name::Inertia, &[], given))
    }

    /// Checks that a momentum determines a velocity, and that the kinetic energy is positive along every direction.
    pub(super) fn check_inertia(&self, inertia: &DMatrix<f64>) -> Result<(), SetupError> {
        let n = self.sizes.n;
        let (mut left, mut determinant, mut least) = (inertia.clone(), 1.0, (f64::INFINITY, 0));
        for k in 0..n {
            let pivot = left[(k, k)];
            determinant *= pivot;
            let relative = pivot / inertia[(k, k)].abs();
            // NaN, the quotient of two zeros, is less than any number.
            let is_less = !(relative >= least.0);
            if is_less && (least.0 > 0.0) {
                least = (relative, k);
            }
            for row in k + 1..n {
                let factor = left[(row, k)] / pivot;
                for column in k..n {
                    left[(row, column)] -= factor * left[(k, column)];
                }
            }
        }
        let body = || (self.factors.len() > 1).then(|| self.factor_of(least.1));
        if least.0 < -1e6 * f64::EPSILON {
            return Err(SetupError::NegativeKinetic { pivot: least.0, body: body() });
        }
        let is_positive = least.0 > 0.0;
        if !(determinant > 0.0 && determinant.is_finite() && is_positive) {
            return Err(SetupError::SingularKinetic { determinant, body: if is_positive { None } else { body() } });
        }
        Ok(())
    }

    /// The factor of a component, from zero.
    fn factor_of(&self, component: usize) -> usize {
        self.factors.iter().rposition(|factor| factor.component <= component).unwrap_or(0)
    }

    /// Checks that an attitude is in the group.
    pub(super) fn check_attitude(&self, attitude: &[f64]) -> Result<(), SetupError> {
        let defect = self.defect(attitude);
        if defect <= DEFECT { Ok(()) } else { Err(SetupError::NotInGroup { defect }) }
    }

    pub(super) fn defect(&self, attitude: &[f64]) -> f64 {
        self.outputs(Name::Defect, &[], [(Array::Attitude, attitude)]).first().copied().unwrap_or(f64::NAN)
    }

    pub(super) fn momentum(&self, numbers: &[f64], velocity: &[f64], advected: &[f64]) -> Vec<f64> {
        let given = [(Array::Velocity, velocity), (Array::Parameters, numbers), (Array::Advected, advected)];
        self.outputs(Name::Momentum, &[], given)
    }

    /// The velocity by the inertia at rest: exact if the limit is quadratic, otherwise an estimate.
    pub(super) fn near_rest(&self, numbers: &[f64], momentum: &[f64], advected: &[f64]) -> Vec<f64> {
        let given = [(Array::Momentum, momentum), (Array::Parameters, numbers), (Array::Advected, advected)];
        self.outputs(Name::Velocity, &[], given)
    }

    /// The velocity of a momentum; none if there is none.
    pub(super) fn velocity(&self, numbers: &[f64], momentum: &[f64], advected: &[f64]) -> Option<Vec<f64>> {
        let mut velocity = self.near_rest(numbers, momentum, advected);
        if !self.has(Name::Hessian) {
            return Some(velocity);
        }
        let (n, wanted) = (self.sizes.n, DVector::from_column_slice(momentum));
        let missing = |velocity: &[f64]| DVector::from_vec(self.momentum(numbers, velocity, advected)) - &wanted;
        // An estimate outside of the domain, such as above the velocity of light, is shortened.
        for _ in 0..MOST {
            if missing(&velocity).iter().all(|number| number.is_finite()) {
                break;
            }
            velocity.iter_mut().for_each(|component| *component *= 0.5);
        }
        let mut residual = missing(&velocity);
        for _ in 0..MOST {
            let given = [(Array::Velocity, &velocity[..]), (Array::Parameters, numbers), (Array::Advected, advected)];
            let hessian = DMatrix::from_row_slice(n, n, &self.outputs(Name::Hessian, &[], given));
            let update = hessian.clone().lu().solve(&residual)?;
            let mut factor = 1.0;
            let next = loop {
                let next: Vec<f64> = velocity.iter().zip(&update).map(|(xi, update)| xi - factor * update).collect();
                let left = missing(&next);
                if left.norm() < residual.norm()
                    || factor * update.norm() <= f64::EPSILON * DVector::from_vec(next.clone()).norm()
                {
                    residual = left;
                    break next;
                }
                factor *= 0.5;
                if factor < 1e-18 {
                    return None;
                }
            };
            velocity = next;
            let size = velocity.iter().map(|xi| xi * xi).sum::<f64>().sqrt();
            if factor * update.norm() <= 4.0 * f64::EPSILON * size.max(f64::MIN_POSITIVE) || residual.norm() == 0.0 {
                return hessian.cholesky().map(|_| velocity);
            }
        }
        None
    }

    /// Checks that the velocity of a momentum is the one of the start, up to rounding.
    pub(super) fn check_velocity(
        &self,
        velocity: &[f64],
        momentum: &[f64],
        (numbers, advected): (&[f64], &[f64]),
    ) -> Result<(), SetupError> {
        let inertia = self.inertia(numbers, advected);
        let given = DVector::from_column_slice(velocity);
        let found = self.velocity(numbers, momentum, advected).unwrap_or_else(|| vec![f64::NAN; velocity.len()]);
        let (image, difference) = (&inertia * &given, &inertia * (DVector::from_vec(found) - &given));
        let of_fold = image.norm_squared() * f64::EPSILON * 256.0;
        let squares: f64 = momentum.iter().map(|number| number * number).sum();
        let of_sum = squares * f64::EPSILON * f64::EPSILON * 1e8;
        let missed = difference.norm_squared();
        if missed <= of_fold + of_sum {
            return Ok(());
        }
        Err(SetupError::AmbiguousVelocity { difference: (missed / image.norm_squared()).sqrt() })
    }
}
