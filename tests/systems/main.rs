//! The declared systems of `examples/declarations`: the order of each, what each conserves, and its structure.
//!
//! One crate, so that the declarations on SE(3) are expanded once.

#[path = "../common/mod.rs"]
mod common;
#[path = "../../examples/declarations/mod.rs"]
mod declarations;

mod composition;
mod continuous;
mod energy;
mod momenta;
mod one_sided;
mod order;
mod poisson;
mod reversal;
mod samples;
mod symmetry;
