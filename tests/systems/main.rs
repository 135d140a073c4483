//! The declared systems of `examples/declarations`: conserved quantities, structure and limit.
//!
//! All tests are in one crate, so that the declarations on SE(3) are expanded once.

mod couplings;
mod energy;
mod forces;
mod friction;
mod joints;
mod limit;
mod structure;
mod symmetry;
mod unreduced;
