//! Motions of a free body that are known in closed form.

pub(crate) mod flip;
pub(crate) mod separatrix;
pub(crate) mod symmetric;
