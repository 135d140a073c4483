//! Scenes: sums of Lagrangians and forces, the effects of the library, what changes during a run.

mod changing_scenes;
mod control;
mod driven;
mod forces;
mod kinetic_terms;
mod library;
mod sums;
