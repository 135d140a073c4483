//! What others would use: explicit Runge–Kutta methods on the equations of the top, written for speed.

pub mod dop853;
pub mod embedded;
pub mod library;
pub mod rates;
pub mod tsitouras;
pub mod verner;
