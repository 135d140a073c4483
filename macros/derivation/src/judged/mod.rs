//! Which of the derivations is taken, and whether it is right.
//!
//! `discretise` makes `l_d` of a continuous `l`, `continuous` has the continuous equations, `choose` counts operations,
//! `verify` evaluates the declared tree on exact numbers and compares, `hypotheses` finds what the equations rest on,
//! `momenta` finds what several bodies conserve, `places` has the numbers that a step is differentiated by, `constraint`
//! has what holds two of them, `findings` has what comes of both, and `explain` says at the tokens of the declaration why
//! nothing could be derived.
//!
//! Deliberately not here: any derivation, which is mathematics, and any text of the generated documentation, which is
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
pub use explain::terms;
pub use findings::findings;
pub use momenta::conserved;
pub use places::{count, variables};
pub use verify::{ConstraintSlopes, Findings, Sureness};
