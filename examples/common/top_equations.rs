//! The heavy top in unit quaternion and body momentum, `q' = ½ q Ω`, `p' = p × Ω + m g w × ρ`, and the classical
//! Runge–Kutta method of order 4 for it.
//!
//! These variables suit an explicit method best: seven numbers, products only, and no equation to solve.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// The quaternion `(q_0, q)`, then the body momentum.
pub type State = [f64; 7];

/// The constants of the body and the force in the right-hand side.
#[derive(Clone, Copy)]
pub struct Equations {
    inverse_moments: [f64; 3],
    /// The lever `m g ρ`.
    lever: [f64; 3],
}

impl Equations {
    /// The equations of a body with these principal moments, kg m², and `m g ρ`, N m.
    pub fn new(moments: [f64; 3], lever: [f64; 3]) -> Self {
        Self::of(moments.map(f64::recip), lever)
    }

    /// The equations with these inverse moments.
    pub fn of(inverse_moments: [f64; 3], lever: [f64; 3]) -> Self {
        Self { inverse_moments, lever }
    }

    /// The body velocity, rad/s.
    #[inline(always)]
    pub fn velocity(&self, &[.., p1, p2, p3]: &State) -> [f64; 3] {
        let [i1, i2, i3] = self.inverse_moments;
        [i1 * p1, i2 * p2, i3 * p3]
    }

    /// The attitude and the body velocity.
    pub fn end(&self, state: &State) -> (Matrix3<f64>, Vector3<f64>) {
        let [a, b, c, d, ..] = *state;
        // The quaternion isn't normalised, so that a rival's loss of its length is visible.
        let attitude = UnitQuaternion::new_unchecked(Quaternion::new(a, b, c, d)).to_rotation_matrix().into_inner();
        (attitude, self.velocity(state).into())
    }

    #[inline(always)]
    pub fn rate(&self, state: &State) -> State {
        let [a, b, c, d, p1, p2, p3] = *state;
        let [l1, l2, l3] = self.lever;
        let [o1, o2, o3] = self.velocity(state);
        let (w1, w2, w3) = (2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a + d * d - b * b - c * c);
        [
            -0.5 * (b * o1 + c * o2 + d * o3),
            0.5 * (a * o1 + c * o3 - d * o2),
            0.5 * (a * o2 + d * o1 - b * o3),
            0.5 * (a * o3 + b * o2 - c * o1),
            p2 * o3 - p3 * o2 + (w2 * l3 - w3 * l2),
            p3 * o1 - p1 * o3 + (w3 * l1 - w1 * l3),
            p1 * o2 - p2 * o1 + (w1 * l2 - w2 * l1),
        ]
    }

    /// A step of the classical method, by [`rk4_step`].
    #[inline]
    pub fn rk4_step(&self, h: f64, y: &State) -> State {
        rk4_step(|y| self.rate(y), h, y)
    }
}

/// A step of the classical Runge–Kutta method, with the quaternion normalised.
#[inline(always)]
pub fn rk4_step(rate: impl Fn(&State) -> State, h: f64, y: &State) -> State {
    let plus = |h: f64, k: &State| -> State { core::array::from_fn(|i| y[i] + h * k[i]) };
    let k1 = rate(y);
    let k2 = rate(&plus(0.5 * h, &k1));
    let k3 = rate(&plus(0.5 * h, &k2));
    let k4 = rate(&plus(h, &k3));
    normalised(core::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])))
}

/// The state with the quaternion normalised.
#[inline(always)]
fn normalised([a, b, c, d, p1, p2, p3]: State) -> State {
    let scale = 1.0 / (a * a + b * b + c * c + d * d).sqrt();
    [a * scale, b * scale, c * scale, d * scale, p1, p2, p3]
}
