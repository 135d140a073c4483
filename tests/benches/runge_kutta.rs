//! The heavy top by the classical Runge–Kutta method of order 4, in unit quaternion and body momentum.
//!
//! `q' = ½ q Ω`, `p' = p × Ω + m g w × ρ`, with the quaternion normalised after each step.

/// A heavy top and a step.
pub(crate) struct Top {
    inverse_moments: [f64; 3],
    /// `m g ρ`.
    lever: [f64; 3],
    h: f64,
}

/// Quaternion `(q_0, q)`, then body momentum.
pub(crate) type State = [f64; 7];

impl Top {
    /// `weight` is `m g`.
    pub(crate) fn new(moments: [f64; 3], weight: f64, rho: [f64; 3], h: f64) -> Self {
        Self { inverse_moments: moments.map(f64::recip), lever: rho.map(|entry| weight * entry), h }
    }

    /// One step.
    #[inline]
    pub(crate) fn step(&self, state: &mut State) {
        let h = self.h;
        let k1 = self.rate(state);
        let k2 = self.rate(&plus(state, 0.5 * h, &k1));
        let k3 = self.rate(&plus(state, 0.5 * h, &k2));
        let k4 = self.rate(&plus(state, h, &k3));
        let mut next = [0.0; 7];
        for (k, entry) in next.iter_mut().enumerate() {
            *entry = state[k] + h / 6.0 * (k1[k] + 2.0 * (k2[k] + k3[k]) + k4[k]);
        }
        let [a, b, c, d, ..] = next;
        let scale = 1.0 / (a * a + b * b + c * c + d * d).sqrt();
        next[..4].iter_mut().for_each(|entry| *entry *= scale);
        *state = next;
    }

    #[inline(always)]
    fn rate(&self, &[a, b, c, d, p1, p2, p3]: &State) -> State {
        let [i1, i2, i3] = self.inverse_moments;
        let [l1, l2, l3] = self.lever;
        let (o1, o2, o3) = (i1 * p1, i2 * p2, i3 * p3);
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
}

#[inline(always)]
fn plus(state: &State, h: f64, rate: &State) -> State {
    core::array::from_fn(|k| state[k] + h * rate[k])
}
