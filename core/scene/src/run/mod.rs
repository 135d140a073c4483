//! Running scenes: the choice of a stepper, its steps, and what is kept of them.

pub(crate) mod bodies;
pub(crate) mod choose;
pub(crate) mod course;
mod ends;
pub(crate) mod make;
mod nearest;
mod scene;
mod second;
pub(crate) mod springs;
mod stiffness;
mod swings;
mod system;
