//! Any input gets an answer or a typed error: solving, limits of a step, policies, checkpoints, random inputs.

// The letters of the field.
#![allow(non_snake_case)]

#[path = "../common/any_scalar.rs"]
mod any_scalar;
#[path = "../common/mod.rs"]
mod common;
#[path = "../../examples/declarations/mod.rs"]
mod declarations;
#[path = "../common/examples.rs"]
mod examples;

mod checkpoints;
mod command_lines;
mod compensated;
mod policies;
mod random_inputs;
mod secants;
mod secants_long_run;
mod simplified;
mod solvability;
mod solve;
