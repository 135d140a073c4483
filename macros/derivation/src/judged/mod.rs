//! The choice between derivations, and their verification.
//!
//! `discretise` derives `l_d` from a continuous `l`, `continuous` has the continuous equations, `choose` counts
//! operations, `verify` evaluates the declared tree on exact numbers and compares, `hypotheses` finds the relations
//! that the equations rest on, `momenta` the quantities that several bodies conserve, `places` has the numbers that a
//! step is differentiated by, `constraint` the constraint between two bodies, `findings` the results of both, and
//! `explain` reports the reason why nothing could be derived, at the tokens of the declaration.
//!
//! Deliberately not here: derivations from `l_d`, which are mathematics, and any text of the generated documentation, which is
//! emitted. The room knows `declared`, `program` and `mathematics`.

mod choose;
mod constraint;
mod continuous;
mod discretise;
mod explain;
mod findings;
mod hypotheses;
mod momenta;
mod places;
pub mod verify;

pub use choose::{Choice, cheapest};
pub use constraint::held;
pub use continuous::{Equations, continuous, of_declared};
pub use discretise::discretised;
pub use explain::{linear, terms};
pub use findings::findings;
pub use momenta::conserved;
pub use places::{count, variables};
pub use verify::{ConstraintSlopes, Findings, Sureness};
