//! Every input leads to a result or a typed error: solving, limits of a step, policies, checkpoints, random inputs.

mod any_method;
mod checkpoints;
mod long_drifts;
mod observed;
mod one_top;
mod policies;
mod recorded;
mod setup;
mod simplified;
mod solvability;
mod solve;
