//! Steps of a transformed time with a declared pace.

use super::compensated::CompensatedSums;
use super::density::DensityMemory;
use crate::error::{SetupError, StepError};
use crate::groups::{Advected as _, Retraction as _};
use crate::mechanics::{Effect, Group, SceneVisitor, Vector, energy};
use crate::motion::{
    ElapsedTime, Guess, Motion, MotionOf, OwnStep, Plan, PlanFacts, Runs, StepReport, Stepper, Summation,
};
use crate::numbers::{History as _, Polynomial};

/// A plan whose steps are equal in `τ`, `dt = s dτ`, by [`Stepper::paced`].
#[derive(Clone, Debug)]
#[doc(hidden)]
pub struct PacedStep<P>(P);

/// A plan whose step is one of `l_d`, which includes the pace.
#[diagnostic::on_unimplemented(
    message = "the steps of `{Self}` have no pace",
    note = "a pace is in the declaration's own step: `Stepper::new(…)?.paced()`, with sums compensated before"
)]
pub trait Pacable<S: Effect>: Plan<S> {
    /// The guess of the next solve.
    fn guess(kept: &mut Self::Kept) -> &mut Guess<Vector<S>>;
}

impl<S: Effect> Pacable<S> for OwnStep<S> {
    fn guess(kept: &mut Self::Kept) -> &mut Guess<Vector<S>> {
        &mut kept.guess
    }
}

impl<S: Effect, P: Pacable<S>> Pacable<S> for CompensatedSums<P> {
    fn guess(kept: &mut Self::Kept) -> &mut Guess<Vector<S>> {
        P::guess(&mut kept.0)
    }
}

/// An energy, J, in whose rounding all others vanish. It is a power of two, so that dividing by it is exact.
const VAST: f64 = f64::from_bits((1023 + 500) << 52);

/// # Wrap: steps of a transformed time
impl<S: Effect<Scalar = f64>, P: Pacable<S>> Stepper<S, P> {
    /// Steps of `dt = s dτ` with the declared `pace = s(w)`. The times of all arguments and results are times `t`.
    ///
    /// The stepper's `h` is one of `τ`. The energy of a start becomes the number `E_0` of its state. A step takes
    /// `h (s(w) + s(w⁺))/2`, s, which is known when it has been made; the [time](Self::time) is their compensated sum.
    /// The map of attitude, momentum, `t` and `−E_0` is symplectic, and momentum maps are conserved. [The
    /// chapter](crate::guide::varying) measures the gain, and lists what can be combined with it.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] if the scene has no pace: none was declared, or it is a sum, whose terms have one
    /// time.
    ///
    /// # Source
    ///
    /// E. Hairer, *Variable time step integration with symplectic methods*, Appl. Numer. Math. 25 (1997), and S. Reich,
    /// *Backward error analysis for numerical integrators*, SIAM J. Numer. Anal. 36 (1999).
    pub fn paced(self) -> Result<Stepper<S, PacedStep<P>>, SetupError> {
        if self.scene.with_energy(&self.scene.advected(), 0.0).is_none() {
            return Err(SetupError::Parameter { field: "pace", cause: "isn't declared, or not of the whole scene" });
        }
        Ok(Stepper { scene: self.scene, plan: PacedStep(self.plan) })
    }
}

/// The pace `s(w)`, from the potential `s (V − E_0)` with a vast `E_0`.
#[hot]
fn pace<S: Effect<Scalar = f64>>(scene: &S, w: &S::Advected) -> f64 {
    scene.with_energy(w, VAST).map_or(f64::NAN, |(w, _)| scene.limit(None, &w).l / VAST)
}

impl<S: Effect<Scalar = f64>, P: Pacable<S>> Plan<S> for PacedStep<P> {
    /// The pace takes the place of a density. In a rescaled time motions are smooth, and the polynomial predicts an
    /// increment so well that one iteration converges to rounding.
    type Kept = (P::Kept, (DensityMemory, Polynomial<Vector<S>>));

    const FACTS: PlanFacts =
        PlanFacts { has_own_inertia: true, runs: Runs::BySteps, varies: true, counts_time: false, ..P::FACTS };

    delegate_plan!(0, |kept| kept.0; step_size cost);

    fn refolded(&self, scene: &S, h: f64) -> Result<Self, SetupError> {
        self.0.refolded(scene, h).map(Self)
    }

    fn begun(&self, scene: &S, attitude: &Group<S>, momentum: &Vector<S>) -> S::Advected {
        let advected = scene.advected().seen_from(attitude);
        let energy = self.energy(scene, &Motion { attitude: *attitude, momentum: *momentum, advected, steps: 0 });
        scene.with_energy(&advected, energy).map_or(advected, |(w, _)| w)
    }

    fn keep(&self, scene: &S, motion: &MotionOf<S>) -> Self::Kept {
        let memory = DensityMemory { density: pace(scene, &motion.advected), time: ElapsedTime::nothing() };
        (self.0.keep(scene, motion), (memory, Polynomial::none()))
    }

    fn momentum(&self, scene: &S, attitude: &Group<S>, velocity: &Vector<S>, w: &S::Advected) -> Vector<S> {
        self.0.momentum(scene, attitude, &(*velocity * pace(scene, w)), w)
    }

    fn velocity(&self, scene: &S, motion: &MotionOf<S>) -> Vector<S> {
        self.0.velocity(scene, motion) * pace(scene, &motion.advected).recip()
    }

    /// The energy `H`: that of `s (H − E_0)` for `E_0 = 0`, divided by `s`.
    fn energy(&self, scene: &S, motion: &MotionOf<S>) -> f64 {
        let w = scene.with_energy(&motion.advected, 0.0).map_or(motion.advected, |(w, _)| w);
        energy(scene, &motion.momentum, &w) / pace(scene, &w)
    }

    fn time(&self, _: &MotionOf<S>, kept: &Self::Kept) -> f64 {
        kept.1.0.time.sum
    }

    /// The length of a step is known by making the step.
    fn length(&self, scene: &S, motion: &MotionOf<S>, kept: &Self::Kept, is_ahead: bool) -> f64 {
        let part = self.0.part(scene, motion, &kept.0, if is_ahead { 1.0 } else { -1.0 });
        part.map_or(f64::NAN, |part| self.step_size() * 0.5 * (kept.1.0.density + pace(scene, &part.advected)))
    }

    #[hot]
    fn step<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        let energy = scene.with_energy(&motion.now().advected, 0.0);
        let (inner, (memory, history)) = kept;
        let last = P::guess(inner).half;
        let report = self.0.step(scene, motion, inner)?;
        let guess = P::guess(inner);
        let next = history.next(last, guess.half);
        if S::Retraction::is_half_well_near_identity(&guess.half) {
            guess.next = next;
        }
        // A step may recompute the advected parameters from the scene, without the energy of the start.
        let own = energy.and_then(|(_, energy)| scene.with_energy(&motion.now().advected, energy));
        if let Some((advected, _)) = own {
            motion.show(Motion { advected, ..*motion.now() });
        }
        let before = core::mem::replace(&mut memory.density, pace(scene, &motion.now().advected));
        memory.time.add(self.step_size() * 0.5 * (before + memory.density));
        Ok(report)
    }

    /// The part of `τ` that takes the time `t`, by Newton's iterations with `dt/dτ = s`.
    fn part(
        &self,
        scene: &S,
        motion: &MotionOf<S>,
        kept: &Self::Kept,
        fraction: f64,
    ) -> Result<MotionOf<S>, StepError> {
        let h = self.step_size();
        let time = fraction * self.length(scene, motion, kept, fraction > 0.0);
        let mut share = fraction;
        for _ in 0..MOST_ITERATIONS {
            let part = self.0.part(scene, motion, &kept.0, share)?;
            let pace = pace(scene, &part.advected);
            let missing = time - share * h * 0.5 * (kept.1.0.density + pace);
            if missing.abs() <= 4.0 * f64::EPSILON * time.abs() {
                return Ok(part);
            }
            share += missing / (h * pace);
        }
        self.0.part(scene, motion, &kept.0, share)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term("paced");
        self.0.describe(visitor);
    }
}

/// Limit of the iterations for a part of a step.
const MOST_ITERATIONS: u32 = 30;
