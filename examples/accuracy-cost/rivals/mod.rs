//! Rival methods: explicit Runge–Kutta methods on the equations of the top, optimised for speed.
//!
//! The fastest is DOP853 for errors down to about 1e-6, and Verner's method of order 9 for smaller ones, both with a
//! fixed step; RK4 and Tsitouras' method are nearly as fast for an error of 1e-2.
//! `cargo run --release -p liestep-accuracy-cost --example accuracy-cost` prints the times of all.

pub mod dop853;
pub mod embedded;
pub mod rates;
pub mod tsitouras;
pub mod verner;
