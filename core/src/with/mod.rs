//! What is put around a method: compensated sums, values given to each step, remedies for steps
//! without a solution, checkpoints.
//!
//! Each goes with every method for which it makes sense, and with each other.

/// What a plan does as the one within it, `self.plan`.
macro_rules! as_its_plan {
    () => {
        type Kept = P::Kept;

        const VECTORS: Vectors = P::VECTORS;
        const HAS_OWN_INERTIA: bool = P::HAS_OWN_INERTIA;

        fn step_size(&self) -> Scalar<S> {
            self.plan.step_size()
        }

        fn keep(&self, scene: &S, motion: &Motion<Group<S>, S::Advected>) -> Self::Kept {
            self.plan.keep(scene, motion)
        }

        fn admits(&self, scene: &S, motion: &Motion<Group<S>, S::Advected>) -> Result<(), SetupError> {
            self.plan.admits(scene, motion)
        }

        fn momentum(&self, scene: &S, attitude: &Group<S>, velocity: &Vector<S>, w: &S::Advected) -> Vector<S> {
            self.plan.momentum(scene, attitude, velocity, w)
        }

        fn velocity(&self, scene: &S, motion: &Motion<Group<S>, S::Advected>) -> Vector<S> {
            self.plan.velocity(scene, motion)
        }

        fn is_in_step(&self, kept: &Self::Kept) -> bool {
            self.plan.is_in_step(kept)
        }

        fn push<M: Summation<Group<S>, S::Advected>>(
            &self,
            scene: &S,
            motion: &mut M,
            kept: &mut Self::Kept,
            impulse: &Vector<S>,
        ) -> Result<(), StepError> {
            self.plan.push(scene, motion, kept, impulse)
        }

        fn cost(&self) -> Cost {
            self.plan.cost()
        }
    };
}

#[cfg(feature = "serde")]
mod checkpoint;
mod compensated;
mod driven;
mod remedies;

#[cfg(feature = "serde")]
pub use checkpoint::{Checkpoint, CheckpointError, Stored};
pub use compensated::{Carried, Compensable, Compensated};
pub use driven::Driven;
pub use remedies::Substepped;
