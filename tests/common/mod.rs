//! What the tests share: declared Lagrangians, reference data, random states, order estimates.

// Every test file is a crate of its own and uses a part of this.
#![allow(dead_code, unreachable_pub)]

pub mod continuous;
pub mod measure;
pub mod order;
pub mod random;
pub mod reference;
pub mod solvers;
pub mod structure;
pub mod tops;
