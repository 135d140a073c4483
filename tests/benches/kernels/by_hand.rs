//! The heavy top (3.13) with a diagonal `J_d`, written by hand for speed: the standard for the derived stepper.
//!
//! Straight-line scalar code in Cayley coordinates `y = tan(θ/2) n`, with `t = (h/2)(p + (h/2) τ(w))`,
//!
//! ```text
//! G(y)  = J y + y × J y − (1 + |y|²) t = 0        DG = J + ŷ J − (J y)^ − 2 t yᵀ
//! D     = F − I = 2 (ŷ + ŷ²) / (1 + |y|²)
//! R⁺    = R + R D,    w⁺ = w + Dᵀ w,    p⁺ = p + Dᵀ a + the two half kicks
//! ```
//!
//! The initial guess is the library's, and so is Newton's iteration, with a reused Jacobian in its last update. The
//! convergence test and the refusals are the library's, too, but there is only one body and one force, and no second
//! attempt.

/// A heavy top with the constants of its step.
pub(crate) struct Top {
    /// Principal moments `J_1, J_2, J_3`.
    moments: [f64; 3],
    /// The differences `J_3 − J_2`, `J_1 − J_3`, `J_2 − J_1`.
    differences: [f64; 3],
    /// The lever `(h/2) m g ρ`.
    lever: [f64; 3],
    half_step: f64,
    /// A sixteenth of the Jacobian's determinant at rest.
    safe: f64,
}

/// Attitude by rows, body momentum, vertical in the body frame, the last Cayley vector, its last change and the next
/// guess.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) attitude: [[f64; 3]; 3],
    pub(crate) momentum: [f64; 3],
    pub(crate) vertical: [f64; 3],
    pub(crate) last: [f64; 3],
    pub(crate) change: [f64; 3],
    pub(crate) guess: [f64; 3],
}

/// The limit of the library, which documents it.
const MAX_ITERATIONS: u32 = 20;

impl Top {
    /// The top with these parameters; `weight` is `m g`.
    pub(crate) fn new(moments: [f64; 3], weight: f64, rho: [f64; 3], h: f64) -> Self {
        let [a, b, c] = moments;
        Self {
            moments,
            differences: [c - b, a - c, b - a],
            lever: rho.map(|entry| 0.5 * h * weight * entry),
            half_step: 0.5 * h,
            safe: a * b * c / 16.0,
        }
    }

    /// Makes one step; returns `false`, with the state unchanged, if Newton's iteration fails.
    #[inline]
    pub(crate) fn step(&self, state: &mut State) -> bool {
        let kick = cross(&state.vertical, &self.lever);
        let [p1, p2, p3] = state.momentum;
        let a = [p1 + kick[0], p2 + kick[1], p3 + kick[2]];
        let Some(y) = self.solve(&a, &state.guess) else { return false };

        let [x, y, z] = y;
        let (xx, yy, zz) = (x * x, y * y, z * z);
        let scale = 2.0 / (1.0 + xx + yy + zz);
        let (sx, sy, sz) = (scale * x, scale * y, scale * z);
        let (xx, yy, zz) = (sx * x, sy * y, sz * z);
        let (xy, xz, yz) = (sx * y, sx * z, sy * z);
        let d = [[-(yy + zz), xy - sz, xz + sy], [xy + sz, -(xx + zz), yz - sx], [xz - sy, yz + sx, -(xx + yy)]];

        let turned = transpose_mul(&d, &state.vertical);
        let [w1, w2, w3] = state.vertical;
        let vertical = [w1 + turned[0], w2 + turned[1], w3 + turned[2]];
        let after = cross(&vertical, &self.lever);
        let turned = transpose_mul(&d, &a);
        let momentum = [
            p1 + (turned[0] + kick[0] + after[0]),
            p2 + (turned[1] + kick[1] + after[1]),
            p3 + (turned[2] + kick[2] + after[2]),
        ];
        let total = momentum[0] + momentum[1] + momentum[2] + vertical[0] + vertical[1] + vertical[2];
        if !total.is_finite() {
            return false;
        }
        for row in &mut state.attitude {
            let [r1, r2, r3] = *row;
            *row = [
                r1 + (r1 * d[0][0] + r2 * d[1][0] + r3 * d[2][0]),
                r2 + (r1 * d[0][1] + r2 * d[1][1] + r3 * d[2][1]),
                r3 + (r1 * d[0][2] + r2 * d[1][2] + r3 * d[2][2]),
            ];
        }
        state.momentum = momentum;
        state.vertical = vertical;
        let [x0, y0, z0] = state.last;
        let [cx, cy, cz] = [x - x0, y - y0, z - z0];
        let [bx, by, bz] = state.change;
        state.guess = [x + (cx + (cx - bx)), y + (cy + (cy - by)), z + (cz + (cz - bz))];
        state.change = [cx, cy, cz];
        state.last = [x, y, z];
        true
    }

    #[inline]
    fn solve(&self, a: &[f64; 3], guess: &[f64; 3]) -> Option<[f64; 3]> {
        let [j1, j2, j3] = self.moments;
        let [d1, d2, d3] = self.differences;
        let (t1, t2, t3) = (self.half_step * a[0], self.half_step * a[1], self.half_step * a[2]);
        let (u1, u2, u3) = (2.0 * t1, 2.0 * t2, 2.0 * t3);
        let [mut x, mut y, mut z] = *guess;
        for _ in 0..MAX_ITERATIONS {
            let s = 1.0 + (x * x + y * y + z * z);
            let (d1y, d1z, d2x, d2z, d3x, d3y) = (d1 * y, d1 * z, d2 * x, d2 * z, d3 * x, d3 * y);
            let g1 = j1 * x + d1y * z - s * t1;
            let g2 = j2 * y + d2z * x - s * t2;
            let g3 = j3 * z + d3x * y - s * t3;
            let (m11, m12, m13) = (j1 - u1 * x, d1z - u1 * y, d1y - u1 * z);
            let (m21, m22, m23) = (d2z - u2 * x, j2 - u2 * y, d2x - u2 * z);
            let (m31, m32, m33) = (d3y - u3 * x, d3x - u3 * y, j3 - u3 * z);
            let (c11, c21, c31) = (m22 * m33 - m23 * m32, m23 * m31 - m21 * m33, m21 * m32 - m22 * m31);
            let (c12, c22, c32) = (m13 * m32 - m12 * m33, m11 * m33 - m13 * m31, m12 * m31 - m11 * m32);
            let (c13, c23, c33) = (m12 * m23 - m13 * m22, m13 * m21 - m11 * m23, m11 * m22 - m12 * m21);
            let det = m11 * c11 + m12 * c21 + m13 * c31;
            let inverse = 1.0 / det;
            let dx = (c11 * g1 + c12 * g2 + c13 * g3) * inverse;
            let dy = (c21 * g1 + c22 * g2 + c23 * g3) * inverse;
            let dz = (c31 * g1 + c32 * g2 + c33 * g3) * inverse;
            (x, y, z) = (x - dx, y - dy, z - dz);
            let squared = x * x + y * y + z * z;
            let first = dx * dx + dy * dy + dz * dz;
            if first <= squared * (f64::EPSILON / 64.0) {
                // Beyond a quarter turn the sign of the determinant alone doesn't determine the branch.
                return (det > 0.0 && squared < 1.0).then_some([x, y, z]);
            }
            // One simplified iteration with the same Jacobian, if that suffices.
            if first * first * first > squared * (f64::EPSILON * f64::EPSILON / 4.0) || det <= self.safe {
                continue;
            }
            let s = 1.0 + squared;
            let g1 = j1 * x + d1 * y * z - s * t1;
            let g2 = j2 * y + d2 * z * x - s * t2;
            let g3 = j3 * z + d3 * x * y - s * t3;
            let dx = (c11 * g1 + c12 * g2 + c13 * g3) * inverse;
            let dy = (c21 * g1 + c22 * g2 + c23 * g3) * inverse;
            let dz = (c31 * g1 + c32 * g2 + c33 * g3) * inverse;
            (x, y, z) = (x - dx, y - dy, z - dz);
            let squared = x * x + y * y + z * z;
            let second = dx * dx + dy * dy + dz * dz;
            if second * first.max(second / first) <= squared * (f64::EPSILON * f64::EPSILON / 1024.0) {
                return (squared < 1.0).then_some([x, y, z]);
            }
        }
        None
    }
}

#[inline(always)]
fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
fn transpose_mul(m: &[[f64; 3]; 3], v: &[f64; 3]) -> [f64; 3] {
    [
        m[0][0] * v[0] + m[1][0] * v[1] + m[2][0] * v[2],
        m[0][1] * v[0] + m[1][1] * v[1] + m[2][1] * v[2],
        m[0][2] * v[0] + m[1][2] * v[1] + m[2][2] * v[2],
    ]
}
