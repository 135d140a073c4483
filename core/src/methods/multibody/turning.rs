//! Functions of attitudes in a joint that holds a point, as those of a pin: their multipliers, eliminated after the body's shift.
//!
//! With their derivatives `D` by turns before the step and `C` after it, for the body and, with `b`, for its parent, and with
//! the factors of a [`Ball`](super::ball::Ball),
//!
//! ```text
//! B z + G ξ + Dᵀ π = −t        C z + C_b z_b = −γ        X = B⁻¹ Dᵀ        S = C X
//! P₁ = S⁻¹ C_b       P₂ = −S⁻¹ C B⁻¹ G        s = S⁻¹ (γ − C w)           π = s + P₁ z_b + P₂ ξ
//! z = −(w + X s) − (B⁻¹ G + X P₂) ξ − X P₁ z_b
//! ```

use nalgebra::{Matrix3, Matrix6, SMatrix, Vector3};

use super::ends::Ends;

/// A matrix of three rows by columns, as registers load them.
pub(super) type Square = [[f64; 4]; 3];

/// The functions of attitudes of a joint, at most three, and their factors; unused rows are zero.
#[derive(Clone)]
pub(super) struct Turning {
    rows: usize,
    /// The matrices `Dᵀ` and `D_bᵀ`.
    pub(super) before: [Matrix3<f64>; 2],
    /// The matrices `Cᵀ` and `C_bᵀ`.
    pub(super) after: [Matrix3<f64>; 2],
    x: Matrix3<f64>,
    inverse: Matrix3<f64>,
    /// The products `P₁` and `P₂`.
    by_turn: Matrix3<f64>,
    by_point: Matrix3<f64>,
    /// The product `X P₁`.
    turned: Matrix3<f64>,
    /// The product `H X P₁`: the part of the ball joint's force by the parent's turn.
    pub(super) force: Square,
    /// The products `D_bᵀ P₁` and `D_bᵀ P₂`.
    pub(super) of_parent: [Matrix3<f64>; 2],
    /// The least pivot of `S` relative to its diagonal, and the determinant.
    pub(super) pivot: f64,
    pub(super) determinant: f64,
}

impl Turning {
    pub(super) fn new(rows: usize) -> Self {
        let zero = Matrix3::zeros();
        let (before, after, of_parent, force) = ([zero; 2], [zero; 2], [zero; 2], [[0.0; 4]; 3]);
        let (x, inverse, by_turn, by_point, turned) = (zero, zero, zero, zero, zero);
        let (pivot, determinant) = (1.0, 1.0);
        Self { rows, before, after, x, inverse, by_turn, by_point, turned, force, of_parent, pivot, determinant }
    }

    /// Takes the functions after the first three from all those of the joint.
    pub(super) fn set(to: &mut [Matrix3<f64>; 2], from: [&Matrix6<f64>; 2]) {
        for (to, from) in to.iter_mut().zip(from) {
            to.copy_from(&from.fixed_view::<3, 3>(0, 3));
        }
    }

    /// Adds the functions to the maps of a joint.
    pub(super) fn add_to(&self, ends: &mut [Ends; 2]) {
        for (side, ends) in ends.iter_mut().enumerate() {
            ends.before.fixed_view_mut::<3, 3>(0, 3).copy_from(&self.before[side]);
            ends.after.fixed_view_mut::<3, 3>(0, 3).copy_from(&self.after[side]);
        }
    }

    /// Factorises the multipliers' matrix from `B⁻¹` and `B⁻¹ G`; returns `X P₁` and `X P₂`.
    pub(super) fn factorise(&mut self, inverse: &Matrix3<f64>, z: &Matrix3<f64>) -> [Matrix3<f64>; 2] {
        let [own, parent] = &self.after;
        self.x = inverse * self.before[0];
        let s = own.tr_mul(&self.x);
        (self.inverse, self.pivot, self.determinant) = inverted(&s, &s.diagonal(), self.rows);
        self.by_turn = self.inverse * parent.transpose();
        self.by_point = -(self.inverse * own.tr_mul(z));
        self.turned = self.x * self.by_turn;
        self.of_parent = [self.by_turn, self.by_point].map(|by| self.before[1] * by);
        [self.turned, self.x * self.by_point]
    }

    /// The multipliers `s` for `w` and the gap `γ`, and the part `X s` of the turn.
    pub(super) fn reduced(&self, w: &Vector3<f64>, gap: &Vector3<f64>) -> [Vector3<f64>; 2] {
        let s = self.inverse * (gap - self.after[0].tr_mul(w));
        [s, self.x * s]
    }

    /// The multipliers by `s`, the turn of the parent and the shift of its point, and the part `X P₁ z_b` of the turn.
    pub(super) fn completed(&self, s: &Vector3<f64>, turn: &Vector3<f64>, point: &Vector3<f64>) -> [Vector3<f64>; 2] {
        [s + self.by_turn * turn + self.by_point * point, self.turned * turn]
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
