//! The constants of a step of one length, and the bounds that a usual solve stays within.

use liestep::__private::{RATIO, safe};
use liestep::SetupError;
use liestep::numbers::Real;
use liestep_derivation::Array;

use super::codes::{Codes, rare};
use super::limit::Limit;
use super::linear::are_finite;
use crate::code::Backend;

/// The constants of a step.
#[derive(Clone, Debug)]
pub(super) struct StepConstants {
    pub(super) h: f64,
    pub(super) numbers: Vec<f64>,
    /// The determinant of a Jacobian above which it may be used again, where the inertia is constant.
    pub(super) safe: f64,
    /// The square of a right side far beyond those of steps that have a solution.
    pub(super) largest_target: f64,
}

impl StepConstants {
    /// Checks the numbers and the step, and folds the constants.
    pub(super) fn of<B: Backend<f64>>(codes: &Codes<B>, numbers: &[f64], h: f64) -> Result<Self, SetupError> {
        codes.declaration.check(numbers)?;
        let wrong = SetupError::InvalidStep { step: h };
        if !h.is_finite() || !(h == 0.0 || (1.0 / h).is_finite()) {
            return Err(wrong);
        }
        let advected = codes.seen(numbers, &codes.identity());
        let is_constant = codes.declaration.has_constant_inertia;
        if is_constant {
            Limit { codes, numbers, advected: &advected }.check_inertia()?;
        }
        let constants = folded(codes, numbers, h);
        if h != 0.0 && !are_finite(&constants) && !are_finite(&folded(codes, numbers, 1.0)) {
            return Err(SetupError::NonFiniteConstant);
        }
        let at_rest = |constants: &[f64]| {
            rare::<B>(&codes.code.rest, constants, [(Array::Advected, &advected), (Array::Parameters, numbers)])
        };
        let rest = at_rest(&constants);
        let (trace, determinant) = (rest[0], codes.determinant(&rest[1..]));
        // A force about a centre, or a pace, may have no value at the identity, where no body starts. Its steps are judged
        // by the solve with care then.
        if !trace.is_finite() && !at_rest(&folded(codes, numbers, 1.0))[0].is_finite() {
            return Ok(Self { h, numbers: constants, safe: f64::INFINITY, largest_target: 0.0 });
        }
        // An extreme `h` takes the momentum equation and its derivatives out of the range of numbers.
        let product = (0..codes.sizes.n).fold(determinant, |product, _| product / h);
        // An inertia that varies with the configuration may be singular here, but not at the start.
        let is_in_range = if is_constant && !codes.is_product() {
            product.is_finite() && product != 0.0
        } else {
            (trace / h).is_finite()
        };
        if h != 0.0 && !is_in_range {
            return Err(wrong);
        }
        // A step of zero is left to the solve with care, as there is no equation.
        let largest = trace / h * (2.0 * RATIO) / f64::EPSILON;
        let largest_target = if h == 0.0 { 0.0 } else { largest * largest };
        // The determinants of an inertia bound no Jacobian with constraints.
        let safe = if codes.code.reactions.is_some() { f64::INFINITY } else { safe(determinant) };
        Ok(Self { h, numbers: constants, safe, largest_target })
    }

    /// The determinant above which a Jacobian may be used again, at these advected parameters.
    #[inline]
    pub(super) fn safe_at<B: Backend<f64>>(
        &self,
        codes: &Codes<B>,
        numbers: &[f64],
        advected: &[f64],
        room: &mut [f64],
    ) -> f64 {
        safe_at::<f64, B>(codes, numbers, advected, room).unwrap_or(self.safe)
    }
}

/// The determinant above which a Jacobian may be used again, where the inertia varies.
#[inline]
pub(super) fn safe_at<T, B>(codes: &Codes<B>, numbers: &[T], advected: &[T], room: &mut [T]) -> Option<T>
where
    T: Real,
    B: Backend<f64> + Backend<T, Code = <B as Backend<f64>>::Code>,
{
    let program = codes.code.safe.as_ref()?;
    let given = [(Array::Parameters, numbers), (Array::Advected, advected)];
    let determinants = &mut room[..program.outputs];
    <B as Backend<T>>::run(&program.code, &[], given, determinants);
    Some(safe(codes.determinant(determinants)))
}

/// The constants of a step `h`, without any check.
pub(super) fn folded<B: Backend<f64>>(codes: &Codes<B>, numbers: &[f64], h: f64) -> Vec<f64> {
    rare::<B>(&codes.code.constants, &[], [(Array::Step, &[h]), (Array::Parameters, numbers)])
}
