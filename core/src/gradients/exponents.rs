//! Lyapunov exponents, from `QR` factorisations of the tangent map.

use alloc::vec;
use alloc::vec::Vec;

use crate::error::StepError;
use crate::gradients::{Linearisable, Linearisation};
use crate::groups::LieGroup as _;
use crate::mechanics::{Group, Scalar, SecondDerivatives};
use crate::motion::StateOf;
use crate::numbers::{is_finite, real};
use nalgebra::SimdComplexField as _;

impl<S: SecondDerivatives, P: Linearisable<S>> Linearisation<'_, S, P> {
    /// The Lyapunov exponents over `steps` steps, 1/s, in approximately descending order: one for each dimension of
    /// `(ζ, μ)`. On an error the state is unchanged.
    ///
    /// The columns are orthonormalised every `between` steps; an interval in which none grows a million times is short
    /// enough. The exponents of a Poisson map come in pairs `±λ`. In the components of the declared basis, an exponent
    /// over a finite time depends on the units, but its limit doesn't.
    ///
    /// `steps = 0` gives zeros, and `between = 0` counts as one.
    ///
    /// # Errors
    ///
    /// The errors of [`step`](Self::step), and [`StepError::NonFinite`] if an exponent isn't a number: at `h = 0`,
    /// where no time passes, and if the length of a column is zero or out of range.
    ///
    /// # Source
    ///
    /// \[BGGS80\]; see [`conventions`](crate::conventions).
    #[allow(clippy::cast_precision_loss)] // exact up to 2⁵³
    pub fn lyapunov_exponents(
        &self,
        state: &mut StateOf<S, P>,
        steps: u64,
        between: u64,
    ) -> Result<Vec<Scalar<S>>, StepError> {
        let mut next = *state;
        let (mut tangent, mut columns) = (self.tangent(&[]), Vec::new());
        let mut sums = vec![real::<Scalar<S>>(0.0); 2 * Group::<S>::DIMENSION];
        for n in 1..=steps {
            self.step(&mut next, &mut tangent)?;
            if n.is_multiple_of(between.max(1)) || n == steps {
                tangent.orthonormalise(&mut columns, |k, length| sums[k] += length.simd_ln());
            }
        }
        let time = self.stepper.step_size() * real(steps.max(1) as f64);
        let exponents: Vec<Scalar<S>> = sums.into_iter().map(|sum| sum / time).collect();
        if !exponents.iter().all(|&exponent| is_finite(exponent)) {
            return Err(StepError::NonFinite { what: "Lyapunov exponent" });
        }
        *state = next;
        Ok(exponents)
    }
}
