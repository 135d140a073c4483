//! The report of a step.

/// The report of a step: its iterations, and its remedy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepReport {
    /// A measure of the work: Newton iterations, those of the slowest lane, summed over all stages.
    /// A solve whose first guess failed counts more than 20.
    pub iterations: u32,
    /// The remedy that replaced this step; only with [`or_substeps`](crate::Stepper::or_substeps).
    pub remedy: Option<Remedy>,
}

#[hot]
impl StepReport {
    /// The report of a step without a remedy.
    #[must_use]
    pub const fn of(iterations: u32) -> Self {
        Self { iterations, remedy: None }
    }

    /// The report of a run of one step.
    pub(crate) fn of_run(iterations: u64) -> Self {
        Self::of(u32::try_from(iterations).unwrap_or(u32::MAX))
    }
}

/// The replacement of a step that has no solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Remedy {
    /// This number of steps, each of an equal part of `h`.
    Substeps(u32),
}
