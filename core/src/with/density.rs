//! Densities: lengths of steps that depend on the motion, and are reversed with it.

use super::varied::{Lengths, VariedSteps};
use crate::mechanics::{Effect, SceneVisitor, Vector};
use crate::motion::{ElapsedTime, Kept, MotionOf, Plan, Stepper, Variable};

/// The rate of a density of steps.
#[derive(Clone, Copy, Debug)]
pub struct Density<D>(D);

/// The density `ρ` at a motion, which is one at its start, and the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DensityMemory {
    pub(super) density: f64,
    pub(super) time: ElapsedTime<f64>,
}

/// # Wrap: lengths that follow the motion
impl<S: Effect<Scalar = f64>, P: Plan<S>> Stepper<S, P> {
    /// Steps of `h/ρ`, the first about `h`. The argument `rate` is `G = d/dt ln ρ` of the desired density of steps,
    /// 1/s, as a function of motion and body velocity. [`densities`](super::densities) has some rates.
    ///
    /// `ρ_{k+1/2} = ρ_k + ½ h G(state_k)`, a step of `h/ρ_{k+1/2}`, `ρ_{k+1} = ρ_{k+1/2} + ½ h G(state_{k+1})`. The
    /// density isn't a function of the state but a number beside it. So [`inverse`](Self::inverse) retraces all steps,
    /// and the method is reversible if the motion is: its actions don't drift. It isn't symplectic. Momentum maps are
    /// conserved. If `G` depends on the velocity it has to be odd in it, as the rate of a function of the attitude is.
    ///
    /// Recordings, events and checkpoints work with it; a checkpoint doesn't distinguish two rates. Lanes, derivatives,
    /// prescribed values, control forces, and a time before a state's don't: these are refused.
    ///
    /// # Source
    ///
    /// E. Hairer and G. Söderlind, *Explicit, time reversible, adaptive step size control*, SIAM J. Sci. Comput. 26
    /// (2005), (3.5), with the density stored at the states and not between them.
    #[must_use]
    pub fn with_density<D>(self, rate: D) -> Stepper<S, VariedSteps<P, Density<D>>>
    where
        P: Variable<S>,
        D: Fn(&MotionOf<S>, &Vector<S>) -> f64 + Clone,
    {
        self.varied(Density(rate))
    }
}

impl<S: Effect<Scalar = f64>, D> Lengths<S> for Density<D>
where
    D: Fn(&MotionOf<S>, &Vector<S>) -> f64 + Clone,
{
    type Memory = DensityMemory;
    const COUNTED: bool = false;

    fn begin(&self) -> DensityMemory {
        DensityMemory { density: 1.0, time: ElapsedTime::nothing() }
    }

    fn length(
        &self,
        unit: f64,
        motion: &MotionOf<S>,
        velocity: impl FnOnce() -> Vector<S>,
        (memory, is_ahead): (&DensityMemory, bool),
    ) -> f64 {
        let half = 0.5 * unit * (self.0)(motion, &velocity());
        unit / (memory.density + if is_ahead { half } else { -half })
    }

    fn after(
        &self,
        [unit, length]: [f64; 2],
        motion: &MotionOf<S>,
        velocity: impl FnOnce() -> Vector<S>,
        before: &DensityMemory,
    ) -> DensityMemory {
        if length == 0.0 {
            return *before;
        }
        let mut time = before.time;
        time.add(length);
        DensityMemory { density: unit / length + 0.5 * unit * (self.0)(motion, &velocity()), time }
    }

    fn time(&self, _: u64, _: f64, memory: &DensityMemory) -> f64 {
        memory.time.sum
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term("with a density");
    }
}

impl Kept<f64> for DensityMemory {
    fn with_numbers(&self, number: &mut dyn FnMut(f64) -> f64) -> Option<Self> {
        Some(Self { density: number(self.density), time: self.time.with_numbers(number)? })
    }
}
