//! Scenes: sums of Lagrangians and forces, the effects of the library, what changes during a run.

// The letters of the field.
#![allow(non_snake_case)]

mod changing_scenes;
mod control;
mod driven;
mod forces;
mod forces_by_hand;
mod kinetic_terms;
mod library;
mod sums;
