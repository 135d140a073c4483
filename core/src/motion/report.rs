//! What a step tells of itself.

/// What a step did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepReport {
    /// A measure of the work: Newton iterations, of several lanes those of the slowest, and of several stages those of
    /// all of them.
    ///
    /// Where the [Jacobian is expensive](crate::mechanics::Effect::JACOBIAN_IS_EXPENSIVE) residuals count, too: up to
    /// eight, and the iterations with the Jacobian where these weren't enough. A solve whose first guess had to be
    /// given up counts more than 20.
    pub iterations: u32,
    /// What was done in the place of this step; only with [`or_substeps`](crate::Stepper::or_substeps).
    pub remedy: Option<Remedy>,
}

#[hot]
impl StepReport {
    /// The report of a step without a remedy.
    #[must_use]
    pub const fn of(iterations: u32) -> Self {
        Self { iterations, remedy: None }
    }

    /// The report of a step that was made as a run of one.
    pub(crate) fn of_run(iterations: u64) -> Self {
        Self::of(u32::try_from(iterations).unwrap_or(u32::MAX))
    }
}

/// What was done in the place of a step that has no solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Remedy {
    /// This number of steps, each of an equal part of `h`.
    Substeps(u32),
}
