//! Whole steps: their programs in a finite field, without rounding, against matrices that share no code with them.

mod common;
mod group;
mod solve;
mod step;
mod words;
