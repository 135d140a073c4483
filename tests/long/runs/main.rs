//! Runs of many steps: structure over long times, random inputs, and examples as programs.

mod all_orders;
mod command_lines;
mod continuous_bodies;
mod damping;
mod higher_order_tops;
mod random_inputs;
mod reduction;
mod rows;
mod steady_turns;
