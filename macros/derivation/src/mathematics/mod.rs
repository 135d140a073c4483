//! The mathematics: from a declared `l_d` to the terms of an integrator. Knows no token and no span.
//!
//! `group` has the matrix groups by their generators, `chart` coordinates that stay in them, `symbolic` sums of products of matrices in a normal form, and
//! `derive` the thesis' equations in its order.
//!
//! Deliberately not here: numbers in place of symbols (but those of generators), scalar code, and the texts of messages. The room depends on no
//! other.

pub mod chart;
pub mod derive;
pub mod group;
pub mod linear;
pub mod symbolic;
