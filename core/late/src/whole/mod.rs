//! The whole step as data: one stepper of any declaration on any group, whose states are numbers.
//!
//! The derivation writes a step as straight-line programs ([`WholeStep`](liestep_derivation::whole::WholeStep)); a back end
//! runs them, and the driver here compares and copies what they return. It makes the decisions of the library's own solve, in
//! their order, so that a step has the bits of the compiled one on the groups that the library has.
//!
//! Two invariants: nothing here knows a group, its rows or its generators; and an error leaves the state as it was.
//!
//! The files depend on each other in one direction: `composed → stepper → {solve, start} → family`.
//!
//! Differences to a compiled step: on five rows or more by rounding; and an increment beyond a right angle, which the
//! library looks at once more, is refused.

mod composed;
mod family;
mod solve;
mod start;
mod stepper;

pub use composed::WholeComposed;
pub use family::WholeFamily;
pub use stepper::Whole;
