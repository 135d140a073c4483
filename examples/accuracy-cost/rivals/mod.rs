//! What others would use: explicit Runge–Kutta methods on the equations of the top, written for speed.

pub(crate) mod dop853;
mod equations;
pub(crate) mod library;

pub(crate) use equations::Equations;
