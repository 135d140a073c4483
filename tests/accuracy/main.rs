//! Methods of higher order: their coefficients, measured orders and invariants; and rounding errors over a million
//! steps.
//!
//! All tests are in one optimised crate, so that the declarations are expanded once.

mod chain;
mod compensated;
mod compensated_collocation;
mod composition;
mod conditions;
mod events;
mod every_method;
mod exact_body;
mod for_accuracy;
mod gauss;
mod higher_order;
mod many_digits;
mod pace;
mod processed;
mod refinement;
mod splitting;
