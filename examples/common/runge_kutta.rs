//! The classical Runge–Kutta method of order 4.

use std::ops::{Add, Mul};

use nalgebra::DVector;

/// The increment of a step of `h` from `y`.
#[inline]
pub fn change<V: Clone + Add<Output = V> + Mul<f64, Output = V>>(y: V, h: f64, f: impl Fn(V) -> V) -> V {
    let k1 = f(y.clone());
    let k2 = f(y.clone() + k1.clone() * (0.5 * h));
    let k3 = f(y.clone() + k2.clone() * (0.5 * h));
    let k4 = f(y + k3.clone() * h);
    (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0)
}

/// A step on a slice of numbers, whose rates are written to the second argument.
pub fn step(rate: impl Fn(&[f64], &mut [f64]), state: &mut [f64], h: f64) {
    let y = DVector::from_column_slice(state);
    let change = change(y, h, |y| {
        let mut rates = DVector::zeros(y.len());
        rate(y.as_slice(), rates.as_mut_slice());
        rates
    });
    state.iter_mut().zip(&change).for_each(|(y, change)| *y += change);
}

/// A run of as many equal steps over a total time.
pub fn run(rate: impl Fn(&[f64], &mut [f64]), state: &mut [f64], time: f64, steps: u32) {
    for _ in 0..steps {
        step(&rate, state, time / f64::from(steps));
    }
}
