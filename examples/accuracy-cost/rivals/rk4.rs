//! The classical Runge–Kutta method of order 4, with the quaternion brought back to unit length after each step.

use super::equations::{Equations, State, normalised};

/// One step.
#[inline]
pub(crate) fn step(equations: &Equations, h: f64, y: &State) -> State {
    let plus = |h: f64, k: &State| -> State { core::array::from_fn(|i| y[i] + h * k[i]) };
    let k1 = equations.rate(y);
    let k2 = equations.rate(&plus(0.5 * h, &k1));
    let k3 = equations.rate(&plus(0.5 * h, &k2));
    let k4 = equations.rate(&plus(h, &k3));
    normalised(core::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])))
}
