//! The declared systems of `examples/declarations`: the order of each, what each conserves, and its structure.
//!
//! One crate, so that the declarations on SE(3) are expanded once.

mod composition;
mod continuous;
mod energy;
mod flows;
mod limit;
mod momenta;
mod one_sided;
mod order;
mod poisson;
mod reversal;
mod samples;
mod several_bodies;
mod symmetry;
mod unreduced;
