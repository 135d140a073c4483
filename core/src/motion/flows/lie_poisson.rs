//! The flow on momenta, (2.8).

use crate::error::{SetupError, StepError};
use crate::groups::LieGroup as _;
use crate::mechanics::{Effect, Group, Regular, Scalar, Vector};
use crate::motion::increment::Increment;
use crate::motion::own_step::OwnStep;
use crate::motion::plan::Plan as _;
use crate::motion::summation::Motion;
use crate::numbers::real;
use crate::solving::Solvability;

/// The discrete advected Lie–Poisson flow `(μ_i, w_i) ↦ (μ_{i+1}, w_{i+1})`, \[RDAE, (2.8), (2.9)\].
///
/// It is `𝔽l_d⁺ ∘ (𝔽l_d⁻)⁻¹`: Newton's iteration inverts the momentum equation (2.7). A [`Stepper`](crate::Stepper)
/// adds the attitude, and initial guesses.
#[derive(Clone, Debug, Lanes)]
pub struct DiscreteLiePoisson<L: Effect> {
    scene: L,
    declared: OwnStep<L>,
}

impl<L: Effect> DiscreteLiePoisson<L> {
    /// Checks the parameters and folds the constants for the step `h`, in seconds.
    ///
    /// A negative `h` is the inverse map of `−h` if `l_d` is self-adjoint; `h = 0` is the identity. An inertia that
    /// depends on advected or prescribed parameters isn't checked, here or in a step.
    ///
    /// # Errors
    ///
    /// [`SetupError`] for an invalid parameter or step, and for a degenerate kinetic part.
    pub fn new(scene: L, h: Scalar<L>) -> Result<Self, SetupError>
    where
        L: Regular,
    {
        let declared = OwnStep::new(&scene, h)?;
        Ok(Self { scene, declared })
    }

    pub(in crate::motion) fn of(scene: L, declared: OwnStep<L>) -> Self {
        Self { scene, declared }
    }

    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &L {
        &self.scene
    }

    /// The step `h`, s.
    #[must_use]
    pub fn step_size(&self) -> Scalar<L> {
        self.declared.step_size()
    }

    /// Solves the momentum equation (2.7) for `F`, starting at the coordinates `guess`, without another start as a
    /// fallback: convergence to another branch is an error.
    ///
    /// # Errors
    ///
    /// [`StepError`] if there is no solution from this guess on the branch of the identity.
    pub fn invert_legendre_minus(
        &self,
        momentum: &Vector<L>,
        advected: &L::Advected,
        guess: &Vector<L>,
    ) -> Result<Group<L>, StepError> {
        self.declared.invert(&self.scene, momentum, advected, guess)
    }

    /// One step from `(μ, w)`; `guess` are coordinates near those of `F`, zero if nothing is known.
    ///
    /// # Errors
    ///
    /// [`StepError`] if the momentum equation has no solution on the branch of the identity, or a value isn't finite.
    #[hot]
    pub fn step(
        &self,
        momentum: &Vector<L>,
        advected: &L::Advected,
        guess: &Vector<L>,
    ) -> Result<Increment<L>, StepError> {
        self.increment_from(momentum, advected, &(*guess * real(0.5)))
    }

    /// One [`step`](Self::step) from half the guess.
    #[hot]
    pub(crate) fn increment_from(
        &self,
        momentum: &Vector<L>,
        advected: &L::Advected,
        half_guess: &Vector<L>,
    ) -> Result<Increment<L>, StepError> {
        // A step doesn't depend on the attitude.
        let motion = Motion { attitude: Group::<L>::identity(), momentum: *momentum, advected: *advected, steps: 0 };
        self.declared.increment_from(&self.scene, &motion, half_guess)
    }

    /// Whether the step from `(μ, w)` surely has a solution or surely has none, if bounds are known: for the kinetic
    /// part of (3.13) and potentials of the positions, with `a = μ + (h/2) τ`, these are `h|a| < J_min` and
    /// `h|a| > J_max`.
    ///
    /// A step evaluates the bounds only if its solve doesn't succeed at once, so successful steps cost nothing more.
    #[must_use]
    pub fn solvability(&self, momentum: &Vector<L>, advected: &L::Advected) -> Solvability {
        self.declared.solvability(&self.scene, momentum, advected)
    }

    /// The largest fraction of this step, in seconds, whose momentum equation has a solution, to six digits.
    ///
    /// Bisection between zero and `h` costs up to some dozens of solves, fewer if the bounds of
    /// [`solvability`](Self::solvability) decide.
    #[must_use]
    pub fn max_step(&self, momentum: &Vector<L>, advected: &L::Advected) -> Scalar<L> {
        self.declared.largest_solvable(&self.scene, momentum, advected)
    }
}
