//! The declared systems of `examples/declarations`: the order of each, what each conserves, and its structure.
//!
//! One crate, so that the declarations on SE(3) are expanded once.

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
