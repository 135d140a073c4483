//! The program `liestep`, and through it the library of scenes.

mod called;
mod ensembles;
mod lagrangian;
mod mutated;
mod orbits;
mod page;
mod readme;
mod runs;
mod several;
mod wrong_files;
