//! The step of a declared Lagrangian, or of a sum: its own momentum equation (2.7), solved.

mod diagnosis;
mod reactions;

use crate::error::{SetupError, StepError};
use crate::groups::{Advected as _, LieGroup};
use crate::mechanics::{
    Effect, Group, Regular, Scalar, SceneVisitor, Vector, check_inertia, estimated_velocity, inertia, pattern,
};
use crate::motion::increment::Increment;
use crate::motion::limits::kicked;
use crate::motion::plan::{Cost, Plan, PlanFacts, Runs, Steerable, Variable};
use crate::motion::report::StepReport;
use crate::motion::summation::{Motion, MotionOf, Summation, is_due};
use crate::numbers::{Coordinates as _, is_finite, real, reported};
use crate::solving::{Problem, Root, WarmStart, newton_system, safe, step_terms};
use nalgebra::{SimdBool as _, SimdPartialOrd as _, SimdRealField as _};

/// The step of the scene itself, by its momentum equation (2.7): the plan of [`Stepper::new`](crate::Stepper::new).
#[derive(Clone, Debug, Lanes, InLanes)]
pub struct OwnStep<S: Effect> {
    h: Scalar<S>,
    constants: S::Constants,
    /// The square of a right-hand side far beyond those of steps that have a solution.
    largest_target: Scalar<S>,
    /// The determinant of the Jacobian above which a solve needs no second Jacobian.
    safe: Scalar<S>,
}

type Memory<S> = WarmStart<Vector<S>>;

impl<S: Effect> OwnStep<S> {
    /// Checks the parameters and folds the constants for the step `h`.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::new`](crate::Stepper::new).
    pub(crate) fn new(scene: &S, h: Scalar<S>) -> Result<Self, SetupError>
    where
        S: Regular,
    {
        Self::folded(scene, h)
    }

    /// The plan, as by [`new`](Self::new), for a scene that is known to have a kinetic part.
    pub(crate) fn folded(scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        scene.validate()?;
        check_number::<S>(scene)?;
        // 1/h and the constants that depend on it must be finite, unless h is zero.
        if !is_finite(h) || !(h == real(0.0) || is_finite(real::<Scalar<S>>(1.0) / h)) {
            return Err(SetupError::InvalidStep { step: reported(h) });
        }
        if scene.facts().has_constant_inertia {
            check_inertia::<Group<S>>(&inertia(scene, &scene.advected()))?;
        }
        let constants = scene.constants(h);
        if h != real(0.0) && !S::are_finite(&constants) && !S::are_finite(&scene.constants(real(1.0))) {
            return Err(SetupError::NonFiniteConstant);
        }
        let (at_rest, trace) = jacobian_at_rest(scene, &constants);
        // A force about a centre, or a pace, may have no value at the identity, where no body starts. Its steps are judged
        // by the solve with care then.
        if !is_finite(trace) && !is_finite(jacobian_at_rest(scene, &scene.constants(real(1.0))).1) {
            return Ok(Self { h, constants, largest_target: real(0.0), safe: real(f64::INFINITY) });
        }
        let safe = safe(at_rest);
        // An extreme `h` takes the momentum equation and its derivatives out of this scalar's range.
        let at_rest = (0..<Group<S> as LieGroup>::DIMENSION).fold(at_rest, |product, _| product / h);
        // An inertia that varies with the configuration may be singular here, but not at the start.
        let is_product = !<Group<S> as LieGroup>::FACTORS.is_whole() || <Group<S> as LieGroup>::BODIES > 1;
        let is_in_range = if scene.facts().has_constant_inertia && !is_product {
            is_finite(at_rest) && !at_rest.simd_eq(real(0.0)).any()
        } else {
            is_finite(trace / h)
        };
        if h != real(0.0) && !is_in_range {
            return Err(SetupError::InvalidStep { step: reported(h) });
        }
        // A step of zero is left to the careful solve, as there is no equation.
        let largest = trace / h * real(2.0 * RATIO) / Scalar::<S>::simd_default_epsilon();
        let largest_target = if h == real(0.0) { h } else { largest * largest };
        Ok(Self { h, constants, largest_target, safe })
    }

    /// The solution `F` of the momentum equation (2.7) from the coordinates `guess`, without another start.
    pub(super) fn invert(
        &self,
        scene: &S,
        momentum: &Vector<S>,
        advected: &S::Advected,
        guess: &Vector<S>,
    ) -> Result<Group<S>, StepError> {
        if self.h == real(0.0) {
            return Ok(Group::<S>::identity());
        }
        let problem = self.problem(scene, momentum, advected);
        problem.attempt(&(*guess * real(0.5))).map(|root| Group::<S>::from_increment(&root.increment))
    }

    /// One step from a motion, with a guess of half the coordinates of `F`.
    #[hot]
    pub(crate) fn increment_from<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &M,
        half_guess: &Vector<S>,
    ) -> Result<Increment<S>, StepError> {
        match self.increment_directly(scene, motion, half_guess) {
            Some(made) => Ok(made),
            None => self.increment_carefully(scene, motion, half_guess),
        }
    }

    /// The step by the fast path; `None` if anything about it is doubtful.
    #[hot]
    fn increment_directly<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &M,
        half_guess: &Vector<S>,
    ) -> Option<Increment<S>> {
        // The solve with care has the constraints.
        if const { S::FACTS.constraints > 0 } {
            return None;
        }
        let now = motion.now();
        let problem = self.problem(scene, &now.momentum, &now.advected);
        let root = problem.solve_directly::<true>(half_guess, self.largest_target)?;
        let made = self.moved(motion, &problem.a, &root);
        // A finite sum has finite terms. A sum that isn't finite may have overflowed.
        is_finite(made.total()).then_some(made)
    }

    /// The step by the careful path, or its error.
    #[cold]
    #[inline(never)]
    fn increment_carefully<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &M,
        half_guess: &Vector<S>,
    ) -> Result<Increment<S>, StepError> {
        let Motion { momentum, advected, .. } = motion.now();
        if self.h == real(0.0) {
            return Ok(Self::stand_still(momentum, advected));
        }
        let root = self.solve_carefully(scene, momentum, advected, half_guess)?;
        let made = if const { S::FACTS.constraints > 0 } {
            self.moved_with_reactions(scene, motion, &root)
        } else {
            self.moved(motion, &kicked::<S>(&self.constants, momentum, advected), &root)
        };
        if made.momentum.is_finite() && made.advected.is_finite() {
            Ok(made)
        } else {
            Err(StepError::NonFinite { what: "momentum after the step" })
        }
    }

    /// The increment for the solution `F`, with `a = μ + kick_before(w)`.
    #[hot]
    fn moved<M: Summation<Group<S>, S::Advected>>(
        &self,
        motion: &M,
        a: &Vector<S>,
        root: &Root<Group<S>>,
    ) -> Increment<S> {
        let Root { half, increment, iterations, far } = *root;
        let Motion { momentum, advected, .. } = motion.now();
        // The order of these operations matters: another one changes the times of some scenes by two hundredths, up or
        // down.
        let next = motion.turned(&increment);
        let mut change = Group::<S>::adjoint_transpose_increment(&increment, a);
        if const { M::CARRIES } {
            // In `a` the kick is rounded to the digits of the momentum; the carry should compensate that, so the kick
            // is computed anew.
            let mut kicks = None;
            if const { S::FACTS.parts.kick_before } {
                kicks = Some(S::kick_before(&self.constants, advected));
            }
            if const { S::FACTS.parts.kick_after } {
                let after = S::kick_after(&self.constants, &increment, &next);
                kicks = Some(kicks.map_or(after, |before| before + after));
            }
            change = kicks.map_or(change, |kicks| change + kicks);
        } else {
            if const { S::FACTS.parts.kick_before } {
                change = change + (*a - *momentum);
            }
            if const { S::FACTS.parts.kick_after } {
                change = change + S::kick_after(&self.constants, &increment, &next);
            }
        }
        let momentum = *momentum + change;
        Increment { coordinates: half + half, increment, momentum, advected: next, iterations, change, half, far }
    }

    #[hot]
    fn problem<'a>(&'a self, scene: &'a S, momentum: &Vector<S>, w: &'a S::Advected) -> Problem<'a, S> {
        Problem {
            scene,
            constants: &self.constants,
            a: kicked::<S>(&self.constants, momentum, w),
            w,
            h: self.h,
            // The determinants of an inertia bound no Jacobian with constraints.
            safe: if const { S::FACTS.constraints > 0 } {
                real(f64::INFINITY)
            } else if scene.facts().has_constant_inertia {
                self.safe
            } else {
                safe(Vector::<S>::factorise_with(&inertia(scene, w), pattern::<S>()).1)
            },
        }
    }

    #[cold]
    fn stand_still(momentum: &Vector<S>, advected: &S::Advected) -> Increment<S> {
        let Root { half, increment, iterations, far } = Root::at::<S::Retraction>(&Vector::<S>::zero(), 0);
        let (momentum, advected, change) = (*momentum, *advected, Vector::<S>::zero());
        Increment { coordinates: half, increment, momentum, advected, iterations, change, half, far }
    }
}

impl<S: Effect> Steerable<S> for OwnStep<S> {}
impl<S: Effect> Variable<S> for OwnStep<S> {}

impl<S: Effect> Plan<S> for OwnStep<S> {
    type Kept = Memory<S>;

    const FACTS: PlanFacts = PlanFacts { runs: Runs::BySteps, ..PlanFacts::of::<S>() };

    fn step_size(&self) -> Scalar<S> {
        self.h
    }

    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        Self::folded(scene, h)
    }

    fn keep(&self, scene: &S, motion: &MotionOf<S>) -> Self::Kept {
        WarmStart::of(half_coordinates(scene, motion, self.h))
    }

    #[hot]
    fn step<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        let guess = kept.guess(<Group<S> as LieGroup>::DIMENSION);
        match self.increment_directly(scene, motion, &guess) {
            Some(made) => Ok(taken(scene, motion, kept, &made)),
            None => self.step_rare(scene, motion, kept),
        }
    }

    fn max_step(&self, scene: &S, motion: &MotionOf<S>, _: &Self::Kept) -> Scalar<S> {
        self.largest_solvable(scene, &motion.momentum, &motion.advected)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        visitor.term("its own step");
    }

    fn cost(&self) -> Cost {
        Cost::of_stages(S::FACTS.operations, 1)
    }
}

impl<S: Effect> OwnStep<S> {
    /// A rare step, complete: if it returned to the fast path, that would have to store its registers in memory.
    #[cold]
    #[inline(never)]
    fn step_rare<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Memory<S>,
    ) -> Result<StepReport, StepError> {
        let guess = kept.guess(<Group<S> as LieGroup>::DIMENSION);
        let made = self.increment_carefully(scene, motion, &guess)?;
        Ok(taken(scene, motion, kept, &made))
    }
}

#[hot]
fn taken<S: Effect, M: Summation<Group<S>, S::Advected>>(
    scene: &S,
    motion: &mut M,
    kept: &mut Memory<S>,
    made: &Increment<S>,
) -> StepReport {
    motion.proceed(&made.increment, &made.change, (made.momentum, made.advected));
    kept.follow(made.half, made.far);
    if is_due::<Group<S>>(motion.now().steps) {
        look(scene, motion, kept);
    }
    motion.count();
    StepReport::of(made.iterations)
}

/// The rare work of a run: the first step, and the check of the attitude after a fixed number of further ones.
#[cold]
#[inline(never)]
fn look<S: Effect, M: Summation<Group<S>, S::Advected>>(scene: &S, motion: &mut M, kept: &mut Memory<S>) {
    if motion.now().steps == 0 {
        kept.forget_the_estimate();
    }
    motion.restore(&scene.advected());
}

/// Approximately half the coordinates of the first increment: every retraction has the identity as its derivative at
/// zero.
pub(crate) fn half_coordinates<S: Effect>(scene: &S, motion: &MotionOf<S>, h: Scalar<S>) -> Vector<S> {
    estimated_velocity(scene, &motion.momentum, &motion.advected) * (h * real(0.5))
}

/// Checks that constraints on velocities leave a motion, whose velocity a momentum determines in one solve.
fn check_number<S: Effect>(scene: &S) -> Result<(), SetupError> {
    let (constraints, dimension) = (S::FACTS.constraints, <Group<S> as LieGroup>::DIMENSION);
    if constraints == 0 {
        return Ok(());
    }
    if constraints >= dimension {
        return Err(SetupError::NoMotion { constraints, dimension });
    }
    if scene.facts().is_quadratic {
        return Ok(());
    }
    let cause = "is known for constraints on velocities where the Lagrangian is quadratic in the velocity; leave them out, \
                 or write the kinetic energy as a square";
    Err(SetupError::Method { cause })
}

/// The Newton Jacobian is that at rest plus a matrix of rank one that is proportional to the right-hand side. If the
/// latter is less than `1/ε` times this fraction of the former, `10¹²` times in `f64`, its rounding doesn't affect the
/// former.
pub const RATIO: f64 = 1.0 / 4096.0;

/// The determinant and the trace of the Newton Jacobian for a body at rest.
fn jacobian_at_rest<S: Effect>(scene: &S, constants: &S::Constants) -> (Scalar<S>, Scalar<S>) {
    let zero = Vector::<S>::zero();
    let terms = step_terms::<S>(constants, &zero, &scene.advected());
    let (_, jacobian) = newton_system::<S>(constants, &terms, &zero);
    (Vector::<S>::factorise_with(&jacobian, pattern::<S>()).1, Vector::<S>::trace(&jacobian))
}
