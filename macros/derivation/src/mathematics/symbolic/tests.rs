//! Every rule of this module against numbers.

pub(crate) mod numeric;
pub(crate) mod random;
mod rewrites;
mod variations;
