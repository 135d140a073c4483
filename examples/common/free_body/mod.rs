//! The free rigid body: the updates of physics engines and its figures.

pub mod engines;
pub mod figures;
pub mod overview;
pub mod quantities;
