//! Runs of scenes: the choice of a stepper, its steps, and the recording of its results.

pub(crate) mod bodies;
pub(crate) mod choose;
pub(crate) mod data;
pub(crate) mod devices;
mod ends;
mod events;
pub(crate) mod make;
mod mechanism;
mod memory;
pub(crate) mod model;
mod motors;
mod nearest;
mod parameters;
pub(crate) mod sample;
pub(crate) mod scene;
mod second;
pub(crate) mod simulate;
mod stepper;
mod stiffness;
mod swings;
mod system;
