//! What the macro derives, against what shares no code with it: duals, finite differences, formulas by hand, data.

// The letters of the field.
#![allow(non_snake_case)]

#[path = "../common/any_scalar.rs"]
mod any_scalar;
#[path = "../common/mod.rs"]
mod common;
#[path = "../../examples/declarations/mod.rs"]
mod declarations;

mod by_hand;
mod golden_steps;
mod kinetic_terms;
mod lanes;
mod other_groups;
mod self_adjoint;
mod sensitivities;
mod terms;
