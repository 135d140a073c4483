//! Numbers of operations of a step.

/// The numbers of operations of the parts of a step: additions, multiplications, divisions; a library call counts as
/// twenty.
///
/// They rank methods by cost, the same on every machine and in every run. Operations that all steps on a group share
/// (advancing the attitude, solving a small linear system) aren't included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operations {
    /// The operations of a step without the solve: both kicks, and the terms computed once before a solve.
    pub step: u32,
    /// The operations of one iteration, in the count of [`StepReport`](crate::motion::StepReport).
    pub iteration: u32,
}

impl Operations {
    /// An estimate for uncounted effects: about the operations of the heavy top (3.13).
    pub const UNCOUNTED: Self = Self { step: 30, iteration: 50 };
}
