//! What gives each step its length.

use crate::mechanics::{Effect, SceneVisitor, Vector};
use crate::motion::{Kept, MotionOf};

/// What gives each step its length.
pub trait Lengths<S: Effect>: Clone {
    /// What it keeps from step to step.
    type Memory: Kept<f64>;
    /// Whether the lengths depend on how many steps there were before, and on nothing else.
    const COUNTED: bool;

    /// At the beginning of a motion.
    fn begin(&self) -> Self::Memory;

    /// The length ahead of this motion, or behind it, s, in steps of this unit.
    fn length(
        &self,
        unit: f64,
        motion: &MotionOf<S>,
        velocity: impl FnOnce() -> Vector<S>,
        way: (&Self::Memory, bool),
    ) -> f64;

    /// What is kept after a step of this unit and length, s, that has led to this motion.
    fn after(
        &self,
        lengths: [f64; 2],
        motion: &MotionOf<S>,
        velocity: impl FnOnce() -> Vector<S>,
        before: &Self::Memory,
    ) -> Self::Memory;

    /// The time, s, after this number of steps of this unit.
    fn time(&self, steps: u64, unit: f64, memory: &Self::Memory) -> f64;

    /// As [`Plan::describe`](crate::motion::Plan::describe).
    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>);
}
