//! The declared systems of `examples/declarations`: their orders, invariants, and structure.
//!
//! All tests are in one crate, so that the declarations on SE(3) are expanded once.

mod continuous;
mod energy;
mod limit;
mod one_sided;
mod order;
mod samples;
mod several_bodies;
mod structure;
mod symmetry;
mod unreduced;
