//! Symmetric compositions: a step of higher order from several of the declared Lagrangian's.

mod scheme;

pub use scheme::CompositionScheme;

use crate::error::{SetupError, StepError};
use crate::groups::LieGroup as _;
use crate::mechanics::{DiscreteLagrangian, Group, Regular, Scalar, Vector};
use crate::motion::{State, StepReport, Stepped, Stepper};
use crate::numbers::{Coordinates, Mask, Work, at_best_in_lanes, real, reported};
use crate::solving::{largest_fraction, six_digits};
use nalgebra::SimdBool as _;

/// An integrator whose step is `Φ_{γ_s h} ∘ … ∘ Φ_{γ_1 h}`, where `Φ_h` is the step of a self-adjoint Lagrangian.
///
/// With the coefficients of a [`CompositionScheme`] it has that one's order and keeps what `Φ_h` keeps: the Poisson
/// structure, the momentum maps and the Casimirs exactly, the energy nearly. A step of `−h` undoes one of `h`.
///
/// # Contract
///
/// As [`Stepper`]'s, for the step as a whole. Each substep has constants of its own, folded at construction, so that a
/// step costs its stages and nothing else. Substeps are longer than the step where `|γ_i| > 1`, and some are negative;
/// all of them must be solvable, so the limit on `h` is nearly that of [`Stepper`] over
/// [the largest `|γ_i|`](CompositionScheme::largest).
///
/// A Lagrangian that isn't self-adjoint is refused when the user's crate is built:
///
/// ```compile_fail,E0080
/// use liestep::{Composition, CompositionScheme, SO3, lagrangian};
/// use nalgebra::Vector3;
///
/// #[lagrangian(
///     group = SO3,
///     advected(w = up),
///     l_d = ((F - I) * (F - I).transpose()).trace() / (2.0 * h) - h * weight * w.dot(&rho),
/// )]
/// #[derive(Clone)]
/// struct OneSided {
///     weight: f64,
///     rho: Vector3<f64>,
///     up: Vector3<f64>,
/// }
///
/// let top = OneSided { weight: 9.81, rho: Vector3::z(), up: Vector3::z() };
/// let _ = Composition::new(top, 0.01, CompositionScheme::KAHAN_LI_8);
/// ```
///
/// # Examples
///
/// ```
/// use liestep::{Composition, CompositionScheme, DiagonalNonstandardInertia, SO3, lagrangian};
/// use nalgebra::Vector3;
///
/// /// A free rigid body.
/// #[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
/// #[derive(Clone)]
/// struct Body {
///     J_d: DiagonalNonstandardInertia,
/// }
///
/// let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 3.0))?;
/// let composed = Composition::new(Body { J_d }, 0.1, CompositionScheme::KAHAN_LI_8)?;
/// let mut state = composed.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02))?;
/// for _ in 0..100 {
///     composed.step(&mut state)?;
/// }
/// # use liestep::LieGroup;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Source
///
/// \[Su90\], \[KL97\], \[SS05\]; see [`conventions`](crate::conventions).
#[derive(Clone, Debug)]
pub struct Composition<L: DiscreteLagrangian> {
    scheme: CompositionScheme,
    h: Scalar<L>,
    /// One for each of the distinct substeps, that of the first stage first.
    steppers: Vec<Stepper<L>>,
    stages: Vec<Stage<Scalar<L>>>,
}

/// A stage, and how the guess for the next one is made of its coordinates and of those of the stage before.
#[derive(Clone, Copy, Debug)]
struct Stage<T> {
    stepper: usize,
    /// Of the coordinates of this stage, when only these are to be trusted.
    scale: T,
    /// Of the coordinates of this stage.
    last: T,
    /// Of the coordinates of the stage before.
    earlier: T,
}

impl<L: DiscreteLagrangian + Regular + Clone> Composition<L> {
    /// Checks the parameters and folds the constants for all the substeps of the step `h`, in seconds.
    ///
    /// # Errors
    ///
    /// As [`DiscreteLiePoisson::new`](crate::motion::DiscreteLiePoisson::new), for a substep.
    #[allow(clippy::needless_pass_by_value)] // as `Stepper::new`, which keeps it
    pub fn new(lagrangian: L, h: Scalar<L>, scheme: CompositionScheme) -> Result<Self, SetupError> {
        const {
            assert!(L::SELF_ADJOINT, "a composition needs a Lagrangian with l_d(F, w, h) = -l_d(F^-1, F^-1 w, -h)");
        }
        let (distinct, places) = scheme.distinct();
        let substeps = distinct.iter().map(|&gamma| Stepper::new(lagrangian.clone(), h * real(gamma)));
        let steppers = substeps.collect::<Result<_, _>>()?;
        let around = |stage: usize| distinct[places[stage % places.len()]];
        let stages = (0..places.len()).map(|stage| {
            let before = around(stage + places.len() - 1);
            Stage::between(places[stage], before, around(stage), around(stage + 1))
        });
        let stages = stages.collect();
        Ok(Self { scheme, h, steppers, stages })
    }

    /// One step. On an error the state is unchanged. The iterations of the report are those of all stages.
    ///
    /// # Errors
    ///
    /// [`StepError`] where the momentum equation of a stage has no solution on the branch of the identity, or a value
    /// isn't finite. [`StepError::BeyondSolvable`] speaks of the whole step.
    #[inline]
    pub fn step(&self, state: &mut State<Group<L>, L::Advected>) -> Result<StepReport, StepError> {
        self.all_stages(state).map_err(|error| self.explain(error, state))
    }

    /// The largest step from this state up to the composition's own, s, to six digits: that fraction of it whose stages
    /// all have solutions.
    #[must_use]
    pub fn max_step(&self, state: &State<Group<L>, L::Advected>) -> Scalar<L> {
        let solvable = |fraction: f64| {
            let part = Self::new(self.lagrangian().clone(), self.h * real(fraction), self.scheme);
            // The guess is that of another step.
            let mut copy = State { half_guess: state.half_guess * real(fraction), ..*state };
            part.is_ok_and(|part| part.all_stages(&mut copy).is_ok())
        };
        largest_fraction(solvable).map_or(real(0.0), |fraction| self.h * real(fraction))
    }

    #[cold]
    fn explain(&self, error: StepError, state: &State<Group<L>, L::Advected>) -> StepError {
        let StepError::BeyondSolvable { .. } = error else { return error };
        let largest = six_digits(reported(self.max_step(state)));
        StepError::BeyondSolvable { step: reported(self.h), largest }
    }
}

impl<L: DiscreteLagrangian> Composition<L> {
    /// A step whose error speaks of a stage.
    #[inline]
    pub(crate) fn all_stages(&self, state: &mut State<Group<L>, L::Advected>) -> Result<StepReport, StepError> {
        at_best_in_lanes::<Scalar<L>, _>(Step(self, state))
    }

    #[inline(always)]
    fn step_as_compiled(&self, state: &mut State<Group<L>, L::Advected>) -> Result<StepReport, StepError> {
        let mut next = *state;
        let mut iterations = 0;
        for stage in &self.stages {
            let flow = self.steppers[stage.stepper].flow();
            let Stepped { step, half, far } = flow.step_from(&next.momentum, &next.advected, &next.half_guess)?;
            next.attitude = next.attitude.advance(&step.increment);
            next.momentum = step.momentum;
            next.advected = step.advected;
            next.half_guess = stage.half_guess(half, far, next.half);
            next.half = half;
            iterations += step.iterations;
        }
        next.steps += 1;
        if next.is_due() {
            next.restore(&self.lagrangian().advected());
        }
        *state = next;
        Ok(StepReport { iterations, remedy: None })
    }

    fn first(&self) -> &Stepper<L> {
        &self.steppers[0]
    }

    /// A motion from an attitude (body to space) and a body velocity, on SO(3) in rad/s; see [`Stepper::start`].
    ///
    /// # Errors
    ///
    /// [`SetupError`] where the attitude isn't in the group or something isn't finite.
    pub fn start(
        &self,
        attitude: impl Into<Group<L>>,
        velocity: Vector<L>,
    ) -> Result<State<Group<L>, L::Advected>, SetupError> {
        self.first().start(attitude, velocity)
    }

    /// A motion from an attitude (body to space) and a body momentum, on SO(3) in kg m²/s.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where the attitude isn't in the group or something isn't finite.
    pub fn start_with_momentum(
        &self,
        attitude: impl Into<Group<L>>,
        momentum: Vector<L>,
    ) -> Result<State<Group<L>, L::Advected>, SetupError> {
        self.first().start_with_momentum(attitude, momentum)
    }

    /// The declared Lagrangian.
    #[must_use]
    pub fn lagrangian(&self) -> &L {
        self.first().lagrangian()
    }

    /// The coefficients.
    #[must_use]
    pub fn scheme(&self) -> &CompositionScheme {
        &self.scheme
    }

    /// The step `h`, s.
    #[must_use]
    pub fn step_size(&self) -> Scalar<L> {
        self.h
    }

    /// The time since the start, `n h`, s; never accumulated.
    #[must_use]
    #[allow(clippy::cast_precision_loss)] // 2⁵³ steps take longer than a career
    pub fn time(&self, state: &State<Group<L>, L::Advected>) -> Scalar<L> {
        self.h * real(state.steps as f64)
    }

    /// The body velocity, on SO(3) in rad/s.
    #[must_use]
    pub fn velocity(&self, state: &State<Group<L>, L::Advected>) -> Vector<L> {
        self.first().velocity(state)
    }

    /// The energy `½ Ω·JΩ + V(w)` of the continuous system, J; see [`Stepper::energy`].
    #[must_use]
    pub fn energy(&self, state: &State<Group<L>, L::Advected>) -> Scalar<L> {
        self.first().energy(state)
    }
}

/// A step of this state.
struct Step<'a, L: DiscreteLagrangian>(&'a Composition<L>, &'a mut State<Group<L>, L::Advected>);

impl<L: DiscreteLagrangian> Work for Step<'_, L> {
    type Output = Result<StepReport, StepError>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        self.0.step_as_compiled(self.1)
    }
}

/// Beyond this the extrapolation would magnify what it is to foresee.
const FARTHEST_EXTRAPOLATION: f64 = 3.0;

impl<T: crate::numbers::Real> Stage<T> {
    /// The stage of `γ = this` between those of `before` and `next`.
    ///
    /// The coordinates of a stage over its `γ` are the mean velocity over it, to second order that in its middle. Two
    /// of them give that of the next stage by a straight line, whose middle lies `(this + next)/2` away from this
    /// one's, where that of the stage before lies `(before + this)/2` back.
    fn between(stepper: usize, before: f64, this: f64, next: f64) -> Self {
        let ratio = (this + next) / (before + this);
        let ratio = if ratio.abs() <= FARTHEST_EXTRAPOLATION { ratio } else { 0.0 };
        let scale = next / this;
        Self { stepper, scale: real(scale), last: real(scale * (1.0 + ratio)), earlier: real(-ratio * next / before) }
    }

    #[inline(always)]
    fn half_guess<V: Coordinates<T>>(&self, last: V, far: Mask<T>, earlier: V) -> V {
        let guess = last * self.last + earlier * self.earlier;
        // Near the fold coordinates change too fast for a straight line.
        if far.any() { (last * self.scale).select(far, guess) } else { guess }
    }
}
