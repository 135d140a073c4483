//! Elimination of a body on a ball joint: its shift and the joint's force are substituted, so that blocks of three are left.
//!
//! With `T`, `T_b` the maps from the turns of the body and of its parent to the shifts of the joint's point after the step,
//! `S`, `S_b` those before it, the shift `ξ = x_b + T_b z_b` of the parent's point and the force `P`, the equations of a body
//! with unknowns `(z, x)` are
//!
//! ```text
//! A₁₁ z + A₁₂ x + Sᵀ P = −r₁        A₂₁ z + A₂₂ x + P = −r₂        T z + x − ξ = −g
//! ```
//!
//! Their solution is affine in `ξ`, and the parent sees a mass `Π` at the joint and a momentum `q`:
//!
//! ```text
//! G = A₁₂ − Sᵀ A₂₂       H = A₂₁ − A₂₂ T        B = A₁₁ − G T − Sᵀ A₂₁       Π = A₂₂ − H B⁻¹ G
//! w = B⁻¹ (r₁ − Sᵀ r₂ − G g)                    q = r₂ − A₂₂ g − H w
//! z = −w − B⁻¹ G ξ       x = ξ − g − T z        P = −q − Π ξ
//! A_b ← A_b + (S_b I)ᵀ Π (T_b I)                r_b ← r_b + (S_b I)ᵀ q
//! ```
//!
//! Functions of attitudes beyond these three, as those of a pin, are a [`Turning`].
//!
//! This is the elimination of [`Chain`](crate::methods::Chain), for bodies with unknowns of their own.

use alloc::boxed::Box;

use nalgebra::{Matrix3, Matrix6, Vector2, Vector3, Vector6};

use super::ends::Ends;
use super::turning::{Square, Turning};
use crate::numbers::{Columns, Register, cross, dot, padded, square, vector};

const ZERO: Square = [[0.0; 4]; 3];

/// The slopes of a ball joint towards the root, and the factors of its body.
#[derive(Clone)]
pub(super) struct Ball {
    /// The sign of the joint's functions: one if the body is below, minus one if it is above.
    sign: f64,
    /// The joint's points, m: in the axes of the body, and of its parent or of space.
    points: [Vector3<f64>; 2],
    /// The blocks `A₁₁`, `A₂₁`, `A₁₂` and `A₂₂` of the body's matrix.
    own: [Square; 4],
    /// The matrices `Sᵀ` and `S_bᵀ`.
    before: [Square; 2],
    /// The matrices `T` and `T_b`.
    after: [Square; 2],
    /// The factors `B⁻¹`, `B⁻¹ G`, `G`, `H` and `Π`.
    inverse: Square,
    z: Square,
    g: Square,
    h: Square,
    beyond: Square,
    /// The joint's further functions.
    pub(super) turning: Option<Box<Turning>>,
}

fn matrix(square: &Square) -> Matrix3<f64> {
    Matrix3::from_fn(|row, column| square[column][row])
}

/// The columns of a matrix; their fourth entries are such that registers load and permute neighbours.
#[hot]
fn stored<R: Register>(zero: R, m: &Matrix3<f64>) -> Columns<R> {
    let [x, y, z] = &m.data.0;
    Columns([zero.of([x[0], x[1], x[2], y[0]]), zero.of([y[0], y[1], y[2], z[0]]), zero.of([z[0], z[1], z[2], y[2]])])
}

#[hot]
fn loaded<R: Register>(zero: R, square: &Square) -> Columns<R> {
    Columns([zero.of(square[0]), zero.of(square[1]), zero.of(square[2])])
}

#[hot]
fn saved<R: Register>(columns: Columns<R>) -> Square {
    columns.entries()
}

/// Adds blocks to the matrix of a body without a ball joint.
#[hot]
pub(super) fn add_blocks<R: Register>(m: &mut Matrix6<f64>, [first, second, third, fourth]: [Columns<R>; 4]) {
    add_block::<R, 0, 0>(m, first);
    add_block::<R, 3, 0>(m, second);
    add_block::<R, 0, 3>(m, third);
    add_block::<R, 3, 3>(m, fourth);
}

/// Adds to a block of three rows and columns.
#[hot]
fn add_block<R: Register, const ROW: usize, const COLUMN: usize>(m: &mut Matrix6<f64>, added: Columns<R>) {
    for (column, entries) in m.data.0[COLUMN..COLUMN + 3].iter_mut().zip(added.entries()) {
        for k in 0..3 {
            column[ROW + k] += entries[k];
        }
    }
}

/// The turn of a body. The fourth entry, which has no meaning, is such that registers load and permute neighbours.
#[hot]
fn turn<R: Register>(zero: R, of: &Vector6<f64>) -> R {
    zero.of([of[0], of[1], of[2], of[3]])
}

/// The shift of a body.
#[hot]
fn shift<R: Register>(zero: R, of: &Vector6<f64>) -> R {
    zero.of([of[3], of[4], of[5], of[2]])
}

#[hot]
pub(super) fn joined<R: Register>(first: R, second: R) -> Vector6<f64> {
    let ([a, b, c, _], [d, e, f, _]) = (first.entries(), second.entries());
    Vector6::new(a, b, c, d, e, f)
}

impl Ball {
    /// A joint with this point of the body above and of the body below.
    pub(super) fn new([above, below]: [Vector3<f64>; 2], is_below: bool, rows: usize) -> Self {
        let (sign, points) = if is_below { (1.0, [below, above]) } else { (-1.0, [above, below]) };
        let (own, before, after) = ([ZERO; 4], [ZERO; 2], [ZERO; 2]);
        let (inverse, z, g, h, beyond) = (ZERO, ZERO, ZERO, ZERO, ZERO);
        let turning = (rows > 3).then(|| Box::new(Turning::new(rows - 3)));
        Self { sign, points, own, before, after, inverse, z, g, h, beyond, turning }
    }

    /// Whether these are the equations of such a joint.
    pub(super) fn is_like(&self, points: [Vector3<f64>; 2], is_below: bool, rows: usize) -> bool {
        let Self { sign, points: of, .. } = Self::new(points, is_below, rows);
        self.sign == sign && self.points == of
    }

    /// Adds to the body's matrix.
    pub(super) fn add_matrix(&mut self, m: &Matrix6<f64>) {
        let before = self.own;
        self.set_matrix(m);
        for (entry, before) in self.own.as_flattened_mut().iter_mut().zip(before.as_flattened()) {
            entry.iter_mut().zip(before).for_each(|(entry, before)| *entry += before);
        }
    }

    /// Sets the body's matrix.
    pub(super) fn set_matrix(&mut self, m: &Matrix6<f64>) {
        for (k, [x, y, z, u, v, w]) in m.data.0.into_iter().enumerate() {
            let [turns, shifts] = if k < 3 { [0, 1] } else { [2, 3] };
            (self.own[turns][k % 3], self.own[shifts][k % 3]) = ([x, y, z, 0.0], [u, v, w, 0.0]);
        }
    }

    /// The maps `E` and `C` of the joint for the body, and for its parent.
    pub(super) fn ends(&self) -> [Ends; 2] {
        let mut both = [0, 1].map(|side| {
            let (sign, mut ends) = (if side == 0 { self.sign } else { -self.sign }, Ends::ZERO);
            let [before, after] = [matrix(&self.before[side]), matrix(&self.after[side]).transpose()];
            for (columns, turns) in [(&mut ends.before, before), (&mut ends.after, after)] {
                columns.fixed_view_mut::<3, 3>(0, 0).copy_from(&(turns * sign));
                columns.fixed_view_mut::<3, 3>(3, 0).copy_from(&Matrix3::from_diagonal_element(sign));
            }
            ends
        });
        if let Some(turning) = &self.turning {
            turning.add_to(&mut both);
        }
        both
    }

    /// The square of the longest lever arm, m².
    pub(super) fn squared_arm(&self) -> f64 {
        self.points.iter().map(Vector3::norm_squared).fold(0.0, f64::max)
    }

    /// The momenta that these multipliers take from the body and from its parent.
    pub(super) fn reactions(&self, multipliers: &Vector6<f64>) -> [Vector6<f64>; 2] {
        let force = multipliers.fixed_rows::<3>(0) * self.sign;
        let torque = |side: usize| {
            let of = |turning: &Turning| turning.before[side] * multipliers.fixed_rows::<3>(3);
            self.turning.as_deref().map_or_else(Vector3::zeros, of)
        };
        [0, 1].map(|side| {
            let (force, mut reaction) = (if side == 0 { force } else { -force }, Vector6::zeros());
            let [x, y, z] = self.before[side].map(|[x, y, z, _]| Vector3::new(x, y, z));
            let moment = x * force.x + y * force.y + z * force.z;
            reaction.fixed_rows_mut::<3>(0).copy_from(&(moment + torque(side)));
            reaction.fixed_rows_mut::<3>(3).copy_from(&force);
            reaction
        })
    }
}

#[hot]
impl Ball {
    /// Sets `S` at these attitudes of the body, and of its parent if there is one.
    pub(super) fn set_before<R: Register>(&mut self, zero: R, attitudes: [Option<&Matrix3<f64>>; 2]) {
        for side in 0..2 {
            if let Some(attitude) = attitudes[side] {
                let (point, rows) = (zero.of(padded(&self.points[side])), stored(zero, attitude).transposed());
                let [x, y, z] = rows.0;
                self.before[side] = Columns([cross(point, x), cross(point, y), cross(point, z)]).entries();
            }
        }
    }

    /// Sets `T` at these attitudes, for unknowns that turn the bodies by these maps.
    pub(super) fn set_after<R: Register>(&mut self, zero: R, places: [Option<(&Matrix3<f64>, &Matrix3<f64>)>; 2]) {
        for side in 0..2 {
            if let Some((attitude, turn)) = places[side] {
                let arm = stored(zero, attitude).map(zero.of(padded(&self.points[side])));
                let [x, y, z] = stored(zero, turn).0;
                self.after[side] = Columns([cross(x, arm), cross(y, arm), cross(z, arm)]).entries();
            }
        }
    }

    /// Sets `T = S`.
    pub(super) fn set_velocities<R: Register>(&mut self, zero: R) {
        for side in 0..2 {
            self.after[side] = loaded(zero, &self.before[side]).transposed().entries();
        }
        if let Some(turning) = &mut self.turning {
            turning.after = turning.before;
        }
    }

    /// Eliminates the body. Returns the determinant of `B` relative to its diagonal.
    pub(super) fn factorise<R: Register>(&mut self, zero: R) -> f64 {
        let [a11, a21, a12, a22] = &self.own;
        let (a11, a21, a12, a22) = (loaded(zero, a11), loaded(zero, a21), loaded(zero, a12), loaded(zero, a22));
        let (s, t) = (loaded(zero, &self.before[0]), loaded(zero, &self.after[0]));
        let (g, h) = (a12 - s * a22, a21 - a22 * t);
        let b = a11 - g * t - s * a21;
        // Cramer's rule; a determinant of zero leads to numbers that aren't finite.
        let [x, y, z] = b.0;
        let rows = [cross(y, z), cross(z, x), cross(x, y)];
        let determinant = dot(x, rows[0]);
        let inverse = Columns(rows).transposed().scaled(zero.of([1.0; 4]) / determinant);
        let mut z = inverse * g;
        if let Some(turning) = &mut self.turning {
            let [by_turn, by_point] = turning.factorise(&matrix(&saved(inverse)), &matrix(&saved(z)));
            z = z + Columns::of(zero, &by_point);
            turning.force = saved(h * Columns::of(zero, &by_turn));
        }
        self.beyond = saved(a22 - h * z);
        (self.inverse, self.z, self.g, self.h) = (saved(inverse), saved(z), saved(g), saved(h));
        let [[b11, ..], [_, b22, ..], [_, _, b33, _]] = b.entries();
        determinant.entries()[0] / (b11 * b22 * b33).abs()
    }

    /// The mass at the joint, as blocks of the matrix of the parent in the order of its own.
    pub(super) fn of_parent<R: Register>(&self, zero: R) -> [Columns<R>; 4] {
        let beyond = loaded(zero, &self.beyond);
        let (s, t) = (loaded(zero, &self.before[1]), loaded(zero, &self.after[1]));
        let mut turned = beyond * t;
        let mut of_turn = s * beyond;
        let Some(turning) = &self.turning else {
            return [s * turned, turned, of_turn, beyond];
        };
        turned = turned - loaded(zero, &turning.force);
        let [by_turn, by_point] = &turning.of_parent;
        let (by_turn, by_point) = (Columns::of(zero, by_turn), Columns::of(zero, by_point));
        of_turn = of_turn + by_point;
        [s * turned + (by_turn + by_point * t), turned, of_turn, beyond]
    }

    /// Adds to the blocks of the body's matrix.
    pub(super) fn add<R: Register>(&mut self, zero: R, [first, second, third, fourth]: [Columns<R>; 4]) {
        let [a11, a21, a12, a22] = &mut self.own;
        *a11 = saved(loaded(zero, a11) + first);
        *a21 = saved(loaded(zero, a21) + second);
        *a12 = saved(loaded(zero, a12) + third);
        *a22 = saved(loaded(zero, a22) + fourth);
    }

    /// Replaces the right-hand side `r` by `w` and `q`, and the gap by `g`. Returns the addition to the parent's, and the
    /// squares of opposed parts of `w`, and of their shifts.
    pub(super) fn inwards<R: Register>(
        &self,
        zero: R,
        right: &mut Vector6<f64>,
        gap: &mut Vector6<f64>,
    ) -> ([R; 2], Vector2<f64>) {
        let (r1, r2) = (turn(zero, right), shift(zero, right));
        let gamma = turn(zero, gap) * zero.of([self.sign; 4]);
        let inverse = loaded(zero, &self.inverse);
        let own = inverse.map(r1 - loaded(zero, &self.g).map(gamma));
        let taken = inverse.map(loaded(zero, &self.before[0]).map(r2));
        let (mut w, mut multipliers, mut torque) = (own - taken, zero, zero);
        if let Some(turning) = &self.turning {
            let [s, turned] = turning.reduced(&vector(w), &vector(shift(zero, gap)));
            w = w + zero.of(padded(&turned));
            (multipliers, torque) = (zero.of(padded(&s)), zero.of(padded(&(turning.before[1] * s))));
        }
        let q = r2 - loaded(zero, &self.own[3]).map(gamma) - loaded(zero, &self.h).map(w);
        let size = Vector2::new(square(own) + square(taken), square(loaded(zero, &self.after[0]).map(taken)));
        *right = joined(w, q);
        *gap = joined(gamma, multipliers);
        ([loaded(zero, &self.before[1]).map(q) + torque, q], size)
    }

    /// Replaces `w` and `q` by the body's unknowns, and `g` by the multipliers.
    pub(super) fn outwards<R: Register>(
        &self,
        zero: R,
        parent: Option<&Vector6<f64>>,
        unknowns: &mut Vector6<f64>,
        gap: &mut Vector6<f64>,
    ) {
        let (w, q, gamma) = (turn(zero, unknowns), shift(zero, unknowns), turn(zero, gap));
        let (mut of_parent, mut point) = (zero, zero);
        if let Some(of) = parent {
            of_parent = turn(zero, of);
            point = shift(zero, of) + loaded(zero, &self.after[1]).map(of_parent);
        }
        let mut z = zero - w - loaded(zero, &self.z).map(point);
        let (mut force, mut multipliers) = (q + loaded(zero, &self.beyond).map(point), zero);
        if let Some(turning) = &self.turning {
            let s = vector(shift(zero, gap));
            let [all, turned] = turning.completed(&s, &vector(of_parent), &vector(point));
            z = z - zero.of(padded(&turned));
            force = force - loaded(zero, &turning.force).map(of_parent);
            multipliers = zero.of(padded(&all));
        }
        let x = point - gamma - loaded(zero, &self.after[0]).map(z);
        *unknowns = joined(z, x);
        *gap = joined(force * zero.of([-self.sign; 4]), multipliers);
    }
}
