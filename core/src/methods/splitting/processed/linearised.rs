//! The derivatives of a processed splitting's steps: those of the way in, of the kernel's step and of the way out.
//!
//! A run is `χ Kⁿ χ⁻¹`, and its derivative between two states that are read is that of `χ K χ⁻¹` for each step. The inside
//! is where the run has it, the way to there is made from what is read, and parts from it by a rounding.

use super::super::Length;
use super::super::linearised::DifferentiableFlow;
use super::{Part, Processed};
use crate::error::{SetupError, StepError};
use crate::gradients::{Change, Linearisable, Pass};
use crate::groups::SO3;
use crate::mechanics::{RigidScene, Scalar, SceneVisitor, SecondDerivatives};
use crate::motion::{StepReport, Summation};
use nalgebra::SimdComplexField as _;

impl<S, K> Linearisable<S> for Processed<S, K>
where
    S: RigidScene + SecondDerivatives,
    K: DifferentiableFlow<Scalar<S>>,
{
    fn parameters(&self) -> usize {
        Linearisable::<S>::parameters(&self.kernel)
    }

    fn describe_parameters(&self, scene: &S, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        self.kernel.describe_parameters(scene, visitor);
    }

    fn check_stages(&self, scene: &S) -> Result<(), SetupError> {
        if self.parts.iter().any(Part::has_gradient) {
            return super::Split::<S, K>::check_gradients(scene);
        }
        self.kernel.check_stages(scene)
    }

    fn stages(&self) -> usize {
        2 * self.parts.len() + self.changes_of_kernel()
    }

    /// The way in is made anew in each step, for its derivatives alone.
    #[hot]
    fn record<M: Summation<SO3<Scalar<S>>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        let mut whole = *motion;
        self.kernel.make_all::<true, M>(&self.enter, &mut whole, &mut 0)?;
        if let Some(inside) = self.inside(kept) {
            whole.replace(inside.after(motion.now().steps));
        }
        self.kernel.record_beside((self, kept), scene, motion, (whole, [&self.kernel.step, &self.leave]))
    }

    #[hot]
    fn visit(
        &self,
        scene: &S,
        index: usize,
        event: &Change<SO3<Scalar<S>>, S::Advected>,
        pass: &mut impl Pass<SO3<Scalar<S>>>,
    ) {
        if let Some(length) = self.length(index, self.kernel.h.simd_abs()) {
            self.kernel.show(scene, length, event, pass);
        }
    }

    /// The processor is that of `|h|` in a step of `−h` too, and so isn't undone by itself.
    #[hot]
    fn visit_undone(
        &self,
        scene: &S,
        index: usize,
        event: &Change<SO3<Scalar<S>>, S::Advected>,
        pass: &mut impl Pass<SO3<Scalar<S>>>,
    ) {
        if let Some(length) = self.length(index, -self.kernel.h.simd_abs()) {
            self.kernel.show(scene, length, event, pass);
        }
    }
}

impl<S: RigidScene, K: DifferentiableFlow<Scalar<S>>> Processed<S, K> {
    /// The first share of the kernel is joined to the last.
    fn changes_of_kernel(&self) -> usize {
        self.scheme.kernel().shares().count() - 1
    }

    /// The length of a change in a step with a processor of this length.
    fn length(&self, index: usize, processor: Scalar<S>) -> Option<Length<Scalar<S>>> {
        let (parts, h, kernel) = (&self.parts, self.kernel.h, self.scheme.kernel());
        if let Some(part) = parts.iter().rev().nth(index) {
            return Some(part.length([h, processor], -1.0));
        }
        let (index, joint) = (index - parts.len(), self.changes_of_kernel() - 1);
        if let Some(part) = index.checked_sub(joint + 1) {
            return parts.get(part).map(|part| part.length([h, processor], 1.0));
        }
        let share = kernel.shares().zip(kernel.gradients()).nth(index + 1)?;
        Some(Length::of(h, if index == joint { 2.0 } else { 1.0 }, share))
    }
}
