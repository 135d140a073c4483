//! Runs of many steps: structure over long times, random inputs, and examples as programs.

mod command_lines;
mod continuous_bodies;
mod damping;
mod random_inputs;
mod reduction;
mod rows;
mod secants_long_run;
mod steady_turns;
