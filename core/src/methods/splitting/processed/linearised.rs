//! The derivatives of a processed splitting's steps: those of the inverse processor, of the kernel and of the
//! processor.
//!
//! A run is `χ Kⁿ χ⁻¹`. The tangent map is output after each step, so it is that of `χ K χ⁻¹` for each: the kernel's
//! motion continues from step to step, while `χ⁻¹` is recomputed from the output, which differs by a rounding. The
//! adjoint goes back through all `K`, and through `χ` only from states that a cost depends on.

use super::super::Length;
use super::super::linearised::{DifferentiableFlow, Table};
use super::{Part, ProcessedSplitting};
use crate::error::{SetupError, StepError};
use crate::gradients::{ChangeOf, Linearisable, Pass};
use crate::groups::SO3;
use crate::mechanics::{Group, RigidScene, Scalar, SceneVisitor, SecondDerivatives};
use crate::motion::{MotionOf, Plan as _, StepReport, Summation};
use nalgebra::SimdComplexField as _;

impl<S, K> Linearisable<S> for ProcessedSplitting<S, K>
where
    S: RigidScene + SecondDerivatives,
    K: DifferentiableFlow<Scalar<S>>,
{
    type Table = Table<Scalar<S>, K::Slopes>;

    fn table(&self) -> Self::Table {
        self.kernel.table_of(self.lengths(self.kernel.h.simd_abs()))
    }

    /// The processor depends on `|h|`, also for a step of `−h`, so a step of `−h` doesn't undo the processor.
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
            return super::Splitting::<S, K>::check_gradients(scene);
        }
        self.kernel.check_stages(scene)
    }

    fn stages(&self) -> usize {
        2 * self.parts.len() + self.changes_of_kernel()
    }

    fn ends(&self) -> usize {
        self.parts.len()
    }

    /// Between two steps, `χ` and its inverse are computed for their derivatives alone.
    #[hot]
    fn record<M: Summation<SO3<Scalar<S>>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        [begins, ends]: [bool; 2],
    ) -> Result<StepReport, StepError> {
        if begins && self.inside(kept).is_some() {
            self.kernel.make_all::<true, M>(&self.enter, &mut { *motion }, &mut 0)?;
        }
        let report = self.step(scene, motion, kept)?;
        if ends {
            let mut out = *motion;
            out.show(self.before_end(motion.now(), kept));
            self.make_end(&mut out)?;
        }
        Ok(report)
    }

    fn before_end(&self, read: &MotionOf<S>, kept: &Self::Kept) -> MotionOf<S> {
        kept.0.map_or(*read, |inside| inside.after(read.steps))
    }

    #[hot]
    fn make_end<M: Summation<SO3<Scalar<S>>, S::Advected>>(&self, motion: &mut M) -> Result<(), StepError> {
        self.kernel.make_all::<true, M>(&self.leave, motion, &mut 0)
    }

    #[hot]
    fn visit(&self, stages: (&S, &Self::Table), event: (usize, &ChangeOf<S>), pass: &mut impl Pass<Group<S>>) {
        self.kernel.visit(stages, event, pass);
    }
}

impl<S: RigidScene, K: DifferentiableFlow<Scalar<S>>> ProcessedSplitting<S, K> {
    /// The number of shares per step: the kernel's first share is merged with the last.
    fn changes_of_kernel(&self) -> usize {
        self.scheme.kernel().shares().count() - 1
    }

    /// The lengths of all shares in a step with a processor of this length.
    fn lengths(&self, processor: Scalar<S>) -> impl Iterator<Item = Length<Scalar<S>>> {
        let (h, kernel, joint) = (self.kernel.h, self.scheme.kernel(), self.changes_of_kernel());
        let part = move |times| move |part: &Part| part.length([h, processor], times);
        let shares = kernel.shares().zip(kernel.gradients()).enumerate().skip(1);
        let inner = shares.map(move |(k, share)| Length::of(h, if k == joint { 2.0 } else { 1.0 }, share));
        self.parts.iter().rev().map(part(-1.0)).chain(inner).chain(self.parts.iter().map(part(1.0)))
    }
}
