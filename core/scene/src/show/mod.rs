//! Output about scenes and their runs: pictures, pages, and derived equations.

mod computed;
pub(crate) mod derivation;
pub(crate) mod fmu;
mod page;
mod picture;
pub(crate) mod recording;
mod text;
