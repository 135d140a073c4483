//! The program `liestep`, and through it the library of scenes.

mod called;
mod computed;
mod conventions;
mod devices;
mod ensembles;
mod firmware;
mod groups;
mod import;
mod joints;
mod judged;
mod lagrangian;
mod mutated;
mod orbits;
mod page;
mod papers;
mod pointing;
mod readme;
mod reference;
mod runs;
mod sessions;
mod several;
mod signals;
mod sums;
mod systems;
mod units;
mod wrong_files;
