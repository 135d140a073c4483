//! The program `liestep`, and through it the library of scenes.

// The letters of the field.
#![allow(non_snake_case)]

mod mutated;
mod page;
mod readme;
mod scene_files;
