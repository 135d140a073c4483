//! Methods of higher order: their coefficients, the order of each measured, and what each conserves.
//!
//! One crate, so that the declarations are expanded once.

// The letters of the field.
#![allow(non_snake_case)]

mod composition;
mod conditions;
mod convergence;
mod events;
mod exact_body;
mod for_accuracy;
mod gauss;
mod higher_order;
mod many_digits;
mod poisson;
mod preprocessed;
mod processed;
mod refinement;
mod split_body;
mod splitting;
