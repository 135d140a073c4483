//! The derivatives of a processed splitting's steps: those of the way in, of the kernel's step and of the way out.
//!
//! A run is `χ Kⁿ χ⁻¹`, and its derivative between two states that are read is that of `χ K χ⁻¹` for each step. The inside
//! is where the run has it, the way to there is made from what is read, and parts from it by a rounding.

use super::super::Length;
use super::super::linearised::{DifferentiableFlow, Table};
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
    type Table = Table<Scalar<S>, K::Slopes>;

    fn table(&self) -> Self::Table {
        self.kernel.table_of(self.lengths(self.kernel.h.simd_abs()))
    }

    /// The processor is that of `|h|` in a step of `−h` too, and so isn't undone by itself.
    fn table_undone(&self) -> Self::Table {
        self.kernel.table_of(self.lengths(-self.kernel.h.simd_abs()))
    }

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
        stages: (&S, &Self::Table),
        index: usize,
        event: &Change<SO3<Scalar<S>>, S::Advected>,
        pass: &mut impl Pass<SO3<Scalar<S>>>,
    ) {
        self.kernel.visit(stages, index, event, pass);
    }
}

impl<S: RigidScene, K: DifferentiableFlow<Scalar<S>>> Processed<S, K> {
    /// The first share of the kernel is joined to the last.
    fn changes_of_kernel(&self) -> usize {
        self.scheme.kernel().shares().count() - 1
    }

    /// The lengths of all changes in a step with a processor of this length.
    fn lengths(&self, processor: Scalar<S>) -> impl Iterator<Item = Length<Scalar<S>>> {
        let (h, kernel, joint) = (self.kernel.h, self.scheme.kernel(), self.changes_of_kernel());
        let part = move |times| move |part: &Part| part.length([h, processor], times);
        let shares = kernel.shares().zip(kernel.gradients()).enumerate().skip(1);
        let inner = shares.map(move |(k, share)| Length::of(h, if k == joint { 2.0 } else { 1.0 }, share));
        self.parts.iter().rev().map(part(-1.0)).chain(inner).chain(self.parts.iter().map(part(1.0)))
    }
}
