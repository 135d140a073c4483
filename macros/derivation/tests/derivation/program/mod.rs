//! Scalar operations against the values of the expressions that they came from, and their number.

mod counts;
mod values;
