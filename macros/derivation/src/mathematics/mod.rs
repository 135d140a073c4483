//! The mathematics: from a declared `l_d` to all that an integrator needs. Knows no token and no span.
//!
//! `group` has the matrix groups by their generators, `symbolic` sums of products of matrices in a normal form, and
//! `derive` the thesis' equations in its order.
//!
//! Deliberately not here: numbers in place of symbols, scalar code, and what a mistake is called in a message. The room
//! depends on no other.

pub mod derive;
pub mod group;
pub mod symbolic;
