//! Lyapunov exponents, of the tangent map by `QR`.

use crate::error::StepError;
use crate::groups::LieGroup as _;
use crate::mechanics::{Group, Scalar, SecondDerivatives};
use crate::motion::linearised::{Linearisable, Linearised};
use crate::motion::stepper::StateOf;
use crate::numbers::real;
use nalgebra::SimdComplexField as _;

impl<S: SecondDerivatives, P: Linearisable<S>> Linearised<'_, S, P> {
    /// The Lyapunov exponents over so many steps, 1/s, from the largest about to the least: one for each dimension of
    /// `(ζ, μ)`. On an error the state is unchanged.
    ///
    /// The columns are made orthonormal every `between` steps; an interval in which none grows a million times is short
    /// enough. Those of a Poisson map come in pairs `±λ`. In the components of the declared basis, an exponent of a finite
    /// time depends on the units, but not its limit.
    ///
    /// # Errors
    ///
    /// As [`step`](Self::step).
    ///
    /// # Source
    ///
    /// \[BGGS80\]; see [`conventions`](crate::conventions).
    #[allow(clippy::cast_precision_loss)] // 2⁵³ steps take longer than a career
    pub fn lyapunov_exponents(
        &self,
        state: &mut StateOf<S, P>,
        steps: u64,
        between: u64,
    ) -> Result<Vec<Scalar<S>>, StepError> {
        let mut next = *state;
        let mut tangent = self.tangent(&[]);
        let mut sums = vec![real::<Scalar<S>>(0.0); 2 * Group::<S>::DIMENSION];
        for n in 1..=steps {
            self.step(&mut next, &mut tangent)?;
            if n.is_multiple_of(between.max(1)) || n == steps {
                for (sum, length) in sums.iter_mut().zip(tangent.orthonormalise()) {
                    *sum += length.simd_ln();
                }
            }
        }
        *state = next;
        let time = self.stepper.step_size() * real(steps.max(1) as f64);
        Ok(sums.into_iter().map(|sum| sum / time).collect())
    }
}
