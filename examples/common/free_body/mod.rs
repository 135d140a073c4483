//! The free rigid body: its declaration, the updates of physics engines and its figures.

pub(crate) mod engines;
pub(crate) mod figures;
pub(crate) mod lagrangian;
pub(crate) mod overview;
pub(crate) mod quantities;
