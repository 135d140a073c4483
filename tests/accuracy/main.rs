//! Methods of higher order: their coefficients, the order of each measured, and what each conserves; and what a million
//! steps lose by rounding.
//!
//! One crate, so that the declarations are expanded once, and a fast one.

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
