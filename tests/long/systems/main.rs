//! Orders of the declared systems, and several bodies.
//!
//! One crate, so that the declarations on SE(3) are expanded once.

mod one_sided;
mod order;
mod several_bodies;
