//! Symmetric compositions: a step of higher order from several steps of the declared Lagrangian.

mod scheme;

pub use scheme::CompositionScheme;

use alloc::vec::Vec;

use crate::error::{SetupError, StepError};
use crate::gradients::{ChangeOf, Linearisable, Pass, Stage as Linear};
use crate::groups::Advected as _;
use crate::mechanics::{Effect, Group, Regular, Scalar, SceneVisitor, SecondDerivatives, Vector};
use crate::motion::{
    Cost, MotionOf, OwnStep, Plan, PlanFacts, Runs, Steerable, StepReport, Stepper, Summation, Variable, explained,
    half_coordinates,
};
use crate::numbers::{Coordinates, Mask, Real, real};
use crate::solving::Guess;
use nalgebra::{SimdBool as _, SimdComplexField as _, SimdPartialOrd as _, SimdRealField as _};

/// The plan of [`Stepper::composed`](crate::Stepper::composed): a step is `Φ_{γ_s h} ∘ … ∘ Φ_{γ_1 h}`, where `Φ_h` is the step of a self-adjoint Lagrangian.
///
/// The order is that of the [`CompositionScheme`]. A composition preserves the invariants of `Φ_h`: the Poisson
/// structure, the momentum maps and the Casimirs exactly, the energy nearly. A step of `−h` undoes one of `h`. Forces may be
/// beside it that are [self-adjoint](crate::mechanics::Facts::is_self_adjoint), as those of the library are.
///
/// # Contract
///
/// The contract is that of [`Stepper`](crate::Stepper), for the step as a whole. Each substep has constants of its own,
/// folded at construction, so that a step costs its stages and nothing else. A substep with `|γ_i| > 1` is longer than
/// the step, and some substeps are negative. All of them must be solvable, so the limit on `h` is nearly that of the
/// own step divided by [the largest `|γ_i|`](CompositionScheme::largest).
///
/// A Lagrangian that isn't self-adjoint is refused at compile time:
///
/// ```compile_fail,E0080
/// use liestep::methods::CompositionScheme;
/// use liestep::{SO3, Stepper, lagrangian};
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
/// let _ = Stepper::composed(top, 0.01, CompositionScheme::KAHAN_LI_8);
/// ```
///
/// # Examples
///
/// ```
/// use liestep::effects::PrincipalBody;
/// use liestep::groups::LieGroup as _;
/// use liestep::methods::CompositionScheme;
/// use liestep::{SO3, Stepper};
/// use liestep::mechanics::DiagonalNonstandardInertia;
/// use nalgebra::Vector3;
///
/// let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 3.0))?;
/// let composed = Stepper::composed(PrincipalBody { J_d }, 0.1, CompositionScheme::KAHAN_LI_8)?;
/// let mut state = composed.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02))?;
/// for _ in 0..100 {
///     composed.step(&mut state)?;
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Source
///
/// \[Su90\], \[KL97\], \[SS05\]; see [`conventions`](crate::conventions).
#[derive(Clone, Debug, Lanes, InLanes)]
pub struct Composition<S: Effect> {
    #[shared]
    scheme: CompositionScheme,
    h: Scalar<S>,
    /// One plan per distinct substep; that of the first stage comes first.
    substeps: Vec<OwnStep<S>>,
    stages: Vec<Stage<Scalar<S>>>,
}

/// A stage, and the linear extrapolation of its coordinates and of the previous stage's to the next stage's guess.
#[derive(Clone, Copy, Debug, Lanes)]
struct Stage<T> {
    #[shared]
    substep: usize,
    /// The length as a share of the step.
    share: T,
    /// The factor of this stage's coordinates in a guess without the previous stage.
    scale: T,
    /// The factor of this stage's coordinates in the linear extrapolation.
    last: T,
    /// The factor of the previous stage's coordinates in the linear extrapolation.
    earlier: T,
}

/// # Make: a composition
impl<S: Effect> Stepper<S> {
    /// A symmetric composition of the scene's own step; see [`Composition`].
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::new`], for a substep.
    pub fn composed(scene: S, h: Scalar<S>, scheme: CompositionScheme) -> Result<Stepper<S, Composition<S>>, SetupError>
    where
        S: Regular,
    {
        const {
            assert!(
                S::FACTS.is_self_adjoint,
                "a composition needs a Lagrangian with l_d(F, w, h) = -l_d(F^-1, F^-1 w, -h), and such forces"
            );
        }
        Self::composed_if_symmetric(scene, h, scheme)
    }

    /// [`composed`](Self::composed) of a scene whose type doesn't say that it is self-adjoint.
    pub(crate) fn composed_if_symmetric(
        scene: S,
        h: Scalar<S>,
        scheme: CompositionScheme,
    ) -> Result<Stepper<S, Composition<S>>, SetupError>
    where
        S: Regular,
    {
        if !S::FACTS.is_self_adjoint {
            return Err(SetupError::NotSelfAdjoint);
        }
        let plan = Composition::new(&scene, h, scheme)?;
        Ok(Stepper { scene, plan })
    }
}

impl<S: Effect> Composition<S> {
    fn new(scene: &S, h: Scalar<S>, scheme: CompositionScheme) -> Result<Self, SetupError> {
        let (distinct, places) = scheme.distinct();
        let substeps = distinct.iter().map(|&gamma| OwnStep::folded(scene, h * real(gamma)));
        let substeps = substeps.collect::<Result<_, _>>()?;
        let around = |stage: usize| distinct[places[stage % places.len()]];
        let stages = (0..places.len()).map(|stage| {
            let before = around(stage + places.len() - 1);
            Stage::between(places[stage], before, around(stage), around(stage + 1))
        });
        let stages = stages.collect();
        Ok(Self { scheme, h, substeps, stages })
    }

    /// Makes a step. Before each stage `see` is shown the motion, and the begin and the length of the stage as shares of the step.
    #[hot]
    fn each<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Guess<Vector<S>>,
        see: &mut impl FnMut(&mut M, [Scalar<S>; 2]) -> Result<(), StepError>,
    ) -> Result<StepReport, StepError> {
        let (mut next, mut guess) = (*motion, *kept);
        let (mut iterations, mut end) = (0, real::<Scalar<S>>(0.0));
        for stage in &self.stages {
            end += stage.share;
            see(&mut next, [end - stage.share, stage.share])?;
            let stepped = self.substeps[stage.substep].increment_from(scene, &next, &guess.next)?;
            next.proceed(&stepped.increment, &stepped.change, (stepped.momentum, stepped.advected));
            let half = stepped.half;
            guess = Guess { half, next: stage.half_guess(half, stepped.far, guess.half) };
            iterations += stepped.iterations;
        }
        next.finish(|| scene.advected());
        (*motion, *kept) = (next, guess);
        Ok(StepReport::of(iterations))
    }

    /// The coefficients.
    #[must_use]
    pub fn scheme(&self) -> &CompositionScheme {
        &self.scheme
    }
}

impl<S: Effect> Steerable<S> for Composition<S> {
    /// Each stage takes the values of its own middle.
    #[hot]
    fn step_seeing(
        &self,
        scene: &S,
        motion: &mut MotionOf<S>,
        kept: &mut Self::Kept,
        values: &mut impl FnMut([Scalar<S>; 2]) -> Result<S::Advected, StepError>,
    ) -> Result<StepReport, StepError> {
        self.each(scene, motion, kept, &mut |motion: &mut MotionOf<S>, part| {
            motion.advected = values(part)?.seen_from(&motion.attitude);
            Ok(())
        })
    }

    /// A part of a step is a step of its length.
    fn part_seeing(
        &self,
        scene: &S,
        motion: &MotionOf<S>,
        _kept: &Self::Kept,
        fraction: Scalar<S>,
        values: &mut impl FnMut([Scalar<S>; 2]) -> Result<S::Advected, StepError>,
    ) -> Result<MotionOf<S>, StepError> {
        let (mut next, size) = (*motion, fraction.simd_abs());
        // So small a change would be lost in rounding.
        let least = Scalar::<S>::simd_default_epsilon() * Scalar::<S>::simd_default_epsilon();
        if size.simd_lt(least).all() {
            return Ok(next);
        }
        let part = self.refolded(scene, self.h * fraction);
        let part = part.map_err(|_| StepError::NonFinite { what: "part of the step" })?;
        let mut kept = part.keep(scene, &next);
        let made =
            part.step_seeing(scene, &mut next, &mut kept, &mut |shares| values(shares.map(|share| share * size)));
        made.map_err(|error| explained(&part, error, (scene, motion, &kept)))?;
        next.steps = motion.steps;
        Ok(next)
    }
}

impl<S: Effect> Variable<S> for Composition<S> {}

impl<S: Effect> Plan<S> for Composition<S> {
    type Kept = Guess<Vector<S>>;

    fn step_size(&self) -> Scalar<S> {
        self.h
    }

    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        Self::new(scene, h, self.scheme)
    }

    fn keep(&self, scene: &S, motion: &MotionOf<S>) -> Self::Kept {
        Guess::of(half_coordinates(scene, motion, self.substeps[0].step_size()))
    }

    /// The report's iterations are the sum over all stages.
    #[hot]
    fn step<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        self.each(scene, motion, kept, &mut |_, _| Ok(()))
    }

    /// [`StepError::BeyondSolvable`] reports the limit of the whole step, not of a substep.
    const FACTS: PlanFacts = PlanFacts { explains: true, runs: Runs::BySteps, ..PlanFacts::of::<S>() };

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        visitor.term(self.scheme.name());
        self.scheme.stages().for_each(|gamma| visitor.parameter("gamma", real(gamma)));
    }

    fn cost(&self) -> Cost {
        Cost::of_stages(S::FACTS.operations, u32::try_from(self.stages.len()).unwrap_or(u32::MAX))
    }
}

impl<S: SecondDerivatives> Linearisable<S> for Composition<S> {
    type Table = ();

    fn table(&self) {}

    fn stages(&self) -> usize {
        self.stages.len()
    }

    #[hot]
    fn visit(&self, (scene, ()): (&S, &()), (index, event): (usize, &ChangeOf<S>), pass: &mut impl Pass<Group<S>>) {
        if let Some(substep) = self.stages.get(index).and_then(|stage| self.substeps.get(stage.substep)) {
            pass.stage(&Linear::step(scene, substep.step_size(), event, event.before.advected));
        }
    }
}

/// Larger extrapolation ratios would amplify the error of the guess.
const FARTHEST_EXTRAPOLATION: f64 = 3.0;

impl<T: Real> Stage<T> {
    /// The stage with coefficient `γ = this` between stages with `before` and `next`.
    ///
    /// The coordinates of a stage over its `γ` are its mean velocity, which to second order is the velocity at the
    /// middle of the stage. A straight line through two of these velocities gives the next stage's. The next middle
    /// lies `(this + next)/2` ahead of this stage's middle, the previous one `(before + this)/2` behind it.
    fn between(substep: usize, before: f64, this: f64, next: f64) -> Self {
        let ratio = (this + next) / (before + this);
        let ratio = if ratio.abs() <= FARTHEST_EXTRAPOLATION { ratio } else { 0.0 };
        let scale = next / this;
        Self {
            substep,
            share: real(this),
            scale: real(scale),
            last: real(scale * (1.0 + ratio)),
            earlier: real(-ratio * next / before),
        }
    }

    #[hot]
    fn half_guess<V: Coordinates<T>>(&self, last: V, far: Mask<T>, earlier: V) -> V {
        let guess = last * self.last + earlier * self.earlier;
        // Near the fold the coordinates change too fast for linear extrapolation.
        if far.any() { (last * self.scale).select(far, guess) } else { guess }
    }
}
