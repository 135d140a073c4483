//! The heavy top: its declaration, its initial conditions, its rivals and its figures.

pub mod cases;
pub mod continuous;
pub mod declaration;
pub mod drawings;
pub mod euler_angles;
pub mod figures;
pub mod overview;
pub mod precession;
pub mod quantities;
pub mod rk4;
pub mod runs;
