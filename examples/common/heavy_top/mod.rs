//! The heavy top: its declaration, its initial conditions, its rivals and its figures.

pub(crate) mod cases;
pub(crate) mod figures;
pub(crate) mod lagrangian;
pub(crate) mod overview;
pub(crate) mod quantities;
pub(crate) mod rk4;
