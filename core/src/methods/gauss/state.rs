//! The state of a collocation: quaternion and momentum, which determine attitude and body momentum.

use nalgebra::Vector3;

use super::lift::{PhasePoint, length_squared, lifted, rotation, times, twice_momentum};
use super::stages::Stages;
use crate::groups::SO3;
use crate::motion::Kept;
use crate::numbers::flag;

roots!();

/// The motion as [`Gauss`](super::Gauss) integrates it: the unit quaternion and its momentum, the rounding errors of
/// their sums, and the stages of the last step, which give the next initial guess.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollocationMemory<const PAIRS: usize> {
    pub(super) lifted: PhasePoint,
    pub(super) carry: PhasePoint,
    pub(super) stages: Option<Stages<PAIRS>>,
}

impl<const PAIRS: usize> CollocationMemory<PAIRS> {
    pub(super) fn of(attitude: SO3, momentum: &Vector3<f64>) -> Self {
        let q = attitude.to_quaternion();
        Self { lifted: lifted(&[q.w, q.i, q.j, q.k], momentum), carry: [0.0; 8], stages: None }
    }

    /// The rotation of `q/|q|`.
    #[inline(always)]
    pub(super) fn attitude(&self) -> SO3 {
        let [a, b, c, d, ..] = self.lifted;
        SO3::from_matrix_unchecked(rotation(&[a, b, c, d], 2.0 / length_squared(&self.lifted)))
    }

    /// The angular momentum `Π` in the body frame.
    #[inline(always)]
    pub(super) fn momentum(&self) -> Vector3<f64> {
        twice_momentum(&self.lifted) * 0.5
    }

    /// Adds an impulse to `Π`.
    pub(super) fn push(&mut self, impulse: &Vector3<f64>) {
        let [q @ .., _, _, _, _] = self.lifted;
        let change = times(&q, &(impulse * 2.0));
        self.lifted[4..].iter_mut().zip(change).for_each(|(component, change)| *component += change);
    }
}

impl<const PAIRS: usize> Kept<f64> for CollocationMemory<PAIRS> {
    fn with_numbers(&self, number: &mut dyn FnMut(f64) -> f64) -> Option<Self> {
        let (lifted, carry) = (self.lifted.map(&mut *number), self.carry.map(&mut *number));
        let has_stages = flag(self.stages.is_some(), number)?;
        let mut stages = self.stages.map_or([[[0.0; PAIRS]; 2]; 8], |stages| stages.0);
        stages.as_flattened_mut().as_flattened_mut().iter_mut().for_each(|entry| *entry = number(*entry));
        // A damaged state is refused: the quaternion must be a unit one, to some roundings.
        let is_unit = (length_squared(&lifted) - 1.0).abs() < f64::EPSILON.sqrt();
        is_unit.then_some(Self { lifted, carry, stages: has_stages.then_some(Stages(stages)) })
    }

    fn scaled(&self, ratio: f64) -> Self {
        let scaled = |Stages(mut stages): Stages<PAIRS>| {
            stages.as_flattened_mut().as_flattened_mut().iter_mut().for_each(|number| *number *= ratio);
            Stages(stages)
        };
        Self { stages: self.stages.map(scaled), ..*self }
    }
}
