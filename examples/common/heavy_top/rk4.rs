//! The classical Runge–Kutta method of order 4 on the equations of the top, in two sets of variables.
//!
//! Both integrate `Π' = Π × Ω + m g w × ρ` with `w = Rᵀ e₃`; they differ in how the attitude is kept.

use std::ops::{Add, Mul};

use liestep::mechanics::Effect as _;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use super::declaration::HeavyTop;
use crate::run::{Method, Sample, Stopped};

/// The body, in the form that the right-hand sides use.
#[derive(Clone, Copy)]
pub struct Body {
    /// The inverses of the principal moments, 1/(kg m²).
    pub inverse_moments: Vector3<f64>,
    /// `m g ρ`, J.
    pub lever: Vector3<f64>,
}

impl Body {
    /// The same body and the same weight as the declared top's.
    pub fn of(top: &HeavyTop) -> Self {
        let inverse_moments = top.inertia().diagonal().map(f64::recip);
        Self { inverse_moments, lever: top.rho * (top.m * top.g) }
    }

    fn rates(&self, momentum: &Vector3<f64>) -> Vector3<f64> {
        self.inverse_moments.component_mul(momentum)
    }

    fn momentum_rate(&self, momentum: &Vector3<f64>, rates: &Vector3<f64>, w: &Vector3<f64>) -> Vector3<f64> {
        momentum.cross(rates) + w.cross(&self.lever)
    }
}

/// An attitude in some variables, with a body momentum; a vector, as the method wants it.
#[derive(Clone, Copy)]
struct Pair<A> {
    attitude: A,
    momentum: Vector3<f64>,
}

impl<A: Add<Output = A>> Add for Pair<A> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { attitude: self.attitude + other.attitude, momentum: self.momentum + other.momentum }
    }
}

impl<A: Mul<f64, Output = A>> Mul<f64> for Pair<A> {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self { attitude: self.attitude * factor, momentum: self.momentum * factor }
    }
}

/// What a step of `h` from `y` adds to it.
pub(crate) fn change<V: Copy + Add<Output = V> + Mul<f64, Output = V>>(y: V, h: f64, f: impl Fn(V) -> V) -> V {
    let k1 = f(y);
    let k2 = f(y + k1 * (0.5 * h));
    let k3 = f(y + k2 * (0.5 * h));
    let k4 = f(y + k3 * h);
    (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0)
}

/// In a unit quaternion, brought back to unit length after every step: how a careful user would do it.
#[derive(Clone)]
pub struct OnQuaternion {
    body: Body,
    h: f64,
    state: Pair<Quaternion<f64>>,
}

/// In the nine entries of `R`, which nothing keeps orthogonal: how the thesis did it.
#[derive(Clone)]
pub struct OnMatrix {
    body: Body,
    h: f64,
    state: Pair<Matrix3<f64>>,
}

impl OnQuaternion {
    pub fn new(body: Body, h: f64, attitude: &UnitQuaternion<f64>, momentum: Vector3<f64>) -> Self {
        Self { body, h, state: Pair { attitude: *attitude.quaternion(), momentum } }
    }
}

impl OnMatrix {
    pub fn new(body: Body, h: f64, attitude: &UnitQuaternion<f64>, momentum: Vector3<f64>) -> Self {
        Self { body, h, state: Pair { attitude: attitude.to_rotation_matrix().into_inner(), momentum } }
    }
}

/// `Rᵀ e₃` for the quaternion `q`, whose length in the middle of a step isn't one.
fn vertical(q: &Quaternion<f64>) -> Vector3<f64> {
    Vector3::new(
        2.0 * (q.i * q.k - q.w * q.j),
        2.0 * (q.j * q.k + q.w * q.i),
        q.w * q.w - q.i * q.i - q.j * q.j + q.k * q.k,
    ) / q.norm_squared()
}

impl Method for OnQuaternion {
    fn advance(&mut self, steps: u64) -> Result<u64, Stopped> {
        let body = self.body;
        for _ in 0..steps {
            let next = self.state
                + change(self.state, self.h, |y| {
                    let rates = body.rates(&y.momentum);
                    Pair {
                        attitude: y.attitude * Quaternion::from_imag(rates * 0.5),
                        momentum: body.momentum_rate(&y.momentum, &rates, &vertical(&y.attitude)),
                    }
                });
            self.state = Pair { attitude: next.attitude / next.attitude.norm(), momentum: next.momentum };
        }
        Ok(0)
    }

    fn sample(&self) -> Sample {
        let attitude = UnitQuaternion::new_unchecked(self.state.attitude);
        Sample { attitude: attitude.to_rotation_matrix().into_inner(), momentum: self.state.momentum }
    }
}

impl Method for OnMatrix {
    fn advance(&mut self, steps: u64) -> Result<u64, Stopped> {
        let body = self.body;
        for _ in 0..steps {
            self.state = self.state
                + change(self.state, self.h, |y| {
                    let rates = body.rates(&y.momentum);
                    let w = y.attitude.row(2).transpose();
                    Pair {
                        attitude: y.attitude * rates.cross_matrix(),
                        momentum: body.momentum_rate(&y.momentum, &rates, &w),
                    }
                });
        }
        Ok(0)
    }

    fn sample(&self) -> Sample {
        Sample { attitude: self.state.attitude, momentum: self.state.momentum }
    }
}
