//! How much arithmetic a step is.

/// How many operations the parts of a step make: additions, multiplications, divisions; a library call counts as
/// twenty.
///
/// They rank methods by cost, the same on every machine and in every run. What all steps of a group have in common
/// (advancing the attitude, solving a small linear system) isn't in them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operations {
    /// Those of a step without the solve: both kicks, and what is computed once before a solve.
    pub step: u32,
    /// Those of one iteration, as [`StepReport`](crate::motion::StepReport) counts them.
    pub iteration: u32,
}

impl Operations {
    /// Where nobody has counted: about those of the heavy top (3.13).
    pub const UNCOUNTED: Self = Self { step: 30, iteration: 50 };
}
