//! Graphs of scalar operations: their values, and their number.

mod counts;
mod values;
