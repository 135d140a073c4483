//! Functions of attitudes in a joint that holds a point, as those of a pin: their multipliers, eliminated after the body's shift.
//!
//! With their derivatives `D` by turns before the step and `C` after it, for the body and, with `b`, for its parent, and with
//! the factors of a [`Ball`](super::ball::Ball),
//!
//! ```text
//! B z + G ξ + K z_b + Dᵀ π = −t        C z + C_b z_b = −γ        X = B⁻¹ Dᵀ        S = C X
//! P₁ = S⁻¹ (C_b − C B⁻¹ K)       P₂ = −S⁻¹ C B⁻¹ G        s = S⁻¹ (γ − C w)           π = s + P₁ z_b + P₂ ξ
//! z = −(w + X s) − (B⁻¹ G + X P₂) ξ − (B⁻¹ K + X P₁) z_b
//! ```

use nalgebra::{SMatrix, Vector3};

use super::square::{Square, ZERO, loaded, matrix, stored};
use crate::numbers::{Columns, Register, cross, padded};

/// The functions of attitudes of a joint, at most three, and their factors; unused rows are zero.
#[derive(Clone)]
pub(super) struct Turning {
    rows: usize,
    /// The directions in the axes of the body, and of its parent or of space, of which each function is the cosine.
    directions: [[Vector3<f64>; 2]; 3],
    /// The matrices `Dᵀ` and `D_bᵀ`.
    pub(super) before: [Square; 2],
    /// The matrices `Cᵀ` and `C_bᵀ`.
    pub(super) after: [Square; 2],
    /// The matrix `C`.
    across: Square,
    x: Square,
    inverse: Square,
    /// The products `P₁` and `P₂`.
    by_turn: Square,
    by_point: Square,
    /// The products `D_bᵀ P₁` and `D_bᵀ P₂`.
    pub(super) of_parent: [Square; 2],
    /// The least pivot of `S` relative to its diagonal, and the determinant.
    pub(super) pivot: f64,
    pub(super) determinant: f64,
}

impl Turning {
    pub(super) fn new(directions: [[Vector3<f64>; 2]; 3], rows: usize) -> Self {
        let (before, after, of_parent) = ([ZERO; 2], [ZERO; 2], [ZERO; 2]);
        let (across, x, inverse, by_turn, by_point) = (ZERO, ZERO, ZERO, ZERO, ZERO);
        let (pivot, determinant) = (1.0, 1.0);
        Self { rows, directions, before, after, across, x, inverse, by_turn, by_point, of_parent, pivot, determinant }
    }
}

#[hot]
impl Turning {
    /// The derivatives of the functions, one a column, at attitudes of the body and of its parent, the identity for space, and
    /// for unknowns that turn them by these maps. For unit vectors `u` and `v` that turn with the bodies,
    /// `δ(u · v) = (u × v)·(η − η_b)`.
    pub(super) fn slopes<R: Register>(
        &self,
        zero: R,
        [own, other]: [Columns<R>; 2],
        [turn, turn_of_other]: [Columns<R>; 2],
    ) -> [Square; 2] {
        let (turn, turn_of_other) = (turn.transposed(), turn_of_other.transposed());
        let (mut of_own, mut of_other) = (ZERO, ZERO);
        let both = of_own.iter_mut().zip(&mut of_other);
        for ((of_own, of_other), [u, v]) in both.zip(&self.directions).take(self.rows) {
            let axis = cross(own.map(zero.of(padded(u))), other.map(zero.of(padded(v))));
            *of_own = turn.map(axis).entries();
            *of_other = (zero - turn_of_other.map(axis)).entries();
        }
        [of_own, of_other]
    }

    /// Factorises the multipliers' matrix from `B⁻¹`, `B⁻¹ K` and `B⁻¹ G`; returns `X P₁` and `X P₂`.
    pub(super) fn factorise<R: Register>(
        &mut self,
        zero: R,
        inverse: Columns<R>,
        [u, z]: [Columns<R>; 2],
    ) -> [Columns<R>; 2] {
        let c = loaded(zero, &self.after[0]).transposed();
        let x = inverse * loaded(zero, &self.before[0]);
        let s = matrix(&(c * x).entries());
        let inverse;
        (inverse, self.pivot, self.determinant) = inverted(&s, &s.diagonal(), self.rows);
        let inverse = stored(zero, &inverse);
        let by_turn = inverse * (loaded(zero, &self.after[1]).transposed() - c * u);
        let by_point = Columns([zero; 3]) - inverse * (c * z);
        let parent = loaded(zero, &self.before[1]);
        (self.across, self.x, self.inverse) = (c.entries(), x.entries(), inverse.entries());
        (self.by_turn, self.by_point) = (by_turn.entries(), by_point.entries());
        self.of_parent = [(parent * by_turn).entries(), (parent * by_point).entries()];
        [x * by_turn, x * by_point]
    }

    /// The multipliers `s` for `w` and the gap `γ`, the part `X s` of the turn, and the part `D_bᵀ s` of the parent's momentum.
    pub(super) fn reduced<R: Register>(&self, zero: R, w: R, gap: R) -> [R; 3] {
        let s = loaded(zero, &self.inverse).map(gap - loaded(zero, &self.across).map(w));
        [s, loaded(zero, &self.x).map(s), loaded(zero, &self.before[1]).map(s)]
    }

    /// The multipliers by `s`, the turn of the parent and the shift of its point.
    pub(super) fn completed<R: Register>(&self, zero: R, s: R, turn: R, point: R) -> R {
        s + loaded(zero, &self.by_turn).map(turn) + loaded(zero, &self.by_point).map(point)
    }
}

/// The inverse by elimination in the order of the rows, the least pivot relative to `sizes`, and the determinant
/// relative to their absolute values; a size of zero makes both zero. Rows after the first `rows` hold no functions.
#[hot]
pub(super) fn inverted<const K: usize>(
    matrix: &SMatrix<f64, K, K>,
    sizes: &nalgebra::SVector<f64, K>,
    rows: usize,
) -> (SMatrix<f64, K, K>, f64, f64) {
    let (mut a, mut least, mut determinant) = (*matrix, f64::INFINITY, 1.0);
    for k in 0..rows.min(K) {
        let pivot = a[(k, k)];
        // After a pivot that isn't positive, later pivots carry no information.
        let relative = if sizes[k] == 0.0 { 0.0 } else { pivot / sizes[k] };
        least = if least > 0.0 && (relative < least || relative.is_nan()) { relative } else { least };
        determinant *= relative * sizes[k].signum();
        let inverse = 1.0 / pivot;
        a[(k, k)] = 1.0;
        for j in 0..K {
            a[(k, j)] *= inverse;
        }
        for i in 0..K {
            if i == k {
                continue;
            }
            let factor = a[(i, k)];
            a[(i, k)] = 0.0;
            for j in 0..K {
                let change = factor * a[(k, j)];
                a[(i, j)] -= change;
            }
        }
    }
    (a, least, determinant)
}
