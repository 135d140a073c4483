//! The flow on increments, (2.5), and the reconstruction, (2.10).

use super::DiscreteLiePoisson;
use crate::error::{SetupError, StepError};
use crate::groups::{Advected as _, LieGroup, Retraction as _};
use crate::mechanics::{DiscreteLagrangian, Group, Regular, Scalar, Vector};
use crate::numbers::Coordinates as _;

/// The discrete advected Euler–Poincaré flow `(f_i, w_i) ↦ (f_{i+1}, w_{i+1})`, \[RDAE, (2.5)\].
#[derive(Clone, Debug)]
pub struct DiscreteEulerPoincare<L: DiscreteLagrangian> {
    flow: DiscreteLiePoisson<L>,
}

impl<L: DiscreteLagrangian> DiscreteEulerPoincare<L> {
    /// Checks the parameters and folds the constants for the step `h`, in seconds.
    ///
    /// # Errors
    ///
    /// The errors of [`DiscreteLiePoisson::new`].
    pub fn new(lagrangian: L, h: Scalar<L>) -> Result<Self, SetupError>
    where
        L: Regular,
    {
        DiscreteLiePoisson::new(lagrangian, h).map(|flow| Self { flow })
    }

    /// One step: `w⁺ = f⁻¹·w`, and `f⁺` with `𝔽l_d⁻(f⁺, w⁺) = 𝔽l_d⁺(f, w)`.
    ///
    /// # Errors
    ///
    /// [`StepError`] if that equation has no solution on the branch of the identity.
    pub fn step(&self, f: &Group<L>, w: &L::Advected) -> Result<(Group<L>, L::Advected), StepError> {
        let momentum = self.flow.scene().legendre_plus(&f.matrix(), w, self.flow.step_size());
        let next = w.advect(&f.increment());
        let guess = L::Retraction::local_coordinates(f).unwrap_or_else(Vector::<L>::zero);
        let step = self.flow.step(&momentum, &next, &guess)?;
        Ok((step.element(), next))
    }
}

/// The reconstruction `g_{i+1} = g_i f_i`, \[RDAE, (2.10)\].
#[must_use]
pub fn reconstruct<G: LieGroup>(g: &G, f: &G) -> G {
    g.advance(&f.increment())
}
