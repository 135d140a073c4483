//! Output about scenes and their runs: pictures, pages, and derived equations.

pub(crate) mod derivation;
mod page;
mod picture;
pub(crate) mod recording;
