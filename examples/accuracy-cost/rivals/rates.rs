//! The right-hand sides that the rivals integrate, in unit quaternion and body momentum.

use declarations::motions::End;
use workbench::top_equations::{Equations, State};

/// Equations of motion of a body.
pub trait Rates: Copy + 'static {
    fn rate(&self, state: &State) -> State;

    /// The attitude and the body velocity.
    fn end(&self, state: &State) -> End;
}

impl Rates for Equations {
    #[inline(always)]
    fn rate(&self, state: &State) -> State {
        Equations::rate(self, state)
    }

    fn end(&self, state: &State) -> End {
        Equations::end(self, state)
    }
}

/// A top with a spring: `p' = p × Ω + w × m g ρ + k (1 − l/|d|) a × b`, where `b = Rᵀs` is the anchor in the body frame
/// and `d = a − b`.
#[derive(Clone, Copy)]
pub struct SpringRates {
    pub top: Equations,
    pub k: f64,
    /// The length at rest, m.
    pub length: f64,
    /// The end on the body, body frame, and the anchor, in space.
    pub at: [f64; 3],
    pub anchor: [f64; 3],
}

impl Rates for SpringRates {
    #[inline(always)]
    fn rate(&self, state: &State) -> State {
        let [a, b, c, d, ..] = *state;
        let ([x, y, z], [u, v, w]) = (self.anchor, self.at);
        let (aa, bb, cc, dd) = (a * a, b * b, c * c, d * d);
        let (ab, ac, ad, bc, bd, cd) = (a * b, a * c, a * d, b * c, b * d, c * d);
        // Rᵀs, by the columns of R.
        let e1 = (aa + bb - cc - dd) * x + 2.0 * ((bc + ad) * y + (bd - ac) * z);
        let e2 = (aa - bb + cc - dd) * y + 2.0 * ((bc - ad) * x + (cd + ab) * z);
        let e3 = (aa - bb - cc + dd) * z + 2.0 * ((bd + ac) * x + (cd - ab) * y);
        let (d1, d2, d3) = (u - e1, v - e2, w - e3);
        let pull = self.k * (1.0 - self.length / (d1 * d1 + d2 * d2 + d3 * d3).sqrt());
        let [r1, r2, r3, r4, p1, p2, p3] = self.top.rate(state);
        let torque = [pull * (v * e3 - w * e2), pull * (w * e1 - u * e3), pull * (u * e2 - v * e1)];
        [r1, r2, r3, r4, p1 + torque[0], p2 + torque[1], p3 + torque[2]]
    }

    fn end(&self, state: &State) -> End {
        self.top.end(state)
    }
}

/// A satellite in the gradient of gravity of a far mass: `p' = p × Ω + (3 GM/r³) n × Jn`.
#[derive(Clone, Copy)]
pub struct SatelliteRates {
    pub moments: [f64; 3],
    pub inverse_moments: [f64; 3],
    /// `3 GM/r³`, s⁻².
    pub gradient: f64,
}

impl Rates for SatelliteRates {
    #[inline(always)]
    fn rate(&self, &[a, b, c, d, p1, p2, p3]: &State) -> State {
        let [j1, j2, j3] = self.moments;
        let [i1, i2, i3] = self.inverse_moments;
        let (o1, o2, o3) = (i1 * p1, i2 * p2, i3 * p3);
        let (n1, n2, n3) = (2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a + d * d - b * b - c * c);
        let g = self.gradient;
        [
            -0.5 * (b * o1 + c * o2 + d * o3),
            0.5 * (a * o1 + c * o3 - d * o2),
            0.5 * (a * o2 + d * o1 - b * o3),
            0.5 * (a * o3 + b * o2 - c * o1),
            p2 * o3 - p3 * o2 + g * (j3 - j2) * (n2 * n3),
            p3 * o1 - p1 * o3 + g * (j1 - j3) * (n3 * n1),
            p1 * o2 - p2 * o1 + g * (j2 - j1) * (n1 * n2),
        ]
    }

    fn end(&self, state: &State) -> End {
        Equations::new(self.moments, [0.0; 3]).end(state)
    }
}
