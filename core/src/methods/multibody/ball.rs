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
//! A term that couples the body with its parent adds `L y_b` to the equations of the body and `M y` to those of the parent. With
//! `x_b = ξ − T_b z_b` these are parts of `G`, of the mass, and of products with `z_b`:
//!
//! ```text
//! K = L₁₁ − L₁₂ T_b − Sᵀ L₂       L₂ = L₂₁ − L₂₂ T_b       G ← G + L₁₂ − Sᵀ L₂₂       A₂₂ ← A₂₂ + L₂₂ in Π
//! z = −w − B⁻¹ G ξ − U z_b        P = −q − Π ξ + V z_b     U = B⁻¹ K                  V = H U − L₂
//! N = M_z − M_x T                 M y = −N w − M_x g + (M_x − N B⁻¹ G) ξ − N U z_b
//! ```
//!
//! Functions of attitudes beyond these three, as those of a pin, are a [`Turning`].
//!
//! This is the elimination of [`Chain`](crate::methods::Chain), for bodies with unknowns of their own.

use alloc::boxed::Box;

use nalgebra::{Matrix3, Matrix6, Vector2, Vector3, Vector6};

use super::ends::Ends;
use super::point_joint::PointJoint;
use super::square::{Square, ZERO, loaded, matrix, shift_of, stored, turn_of};
use super::turning::Turning;
use crate::numbers::{Columns, Plain, Register, cross, dot, padded, square};

/// The slopes of a ball joint towards the root, and the factors of its body.
#[derive(Clone)]
pub(super) struct Ball {
    joint: PointJoint,
    /// The sign of the functions that hold points: one if the body is below, minus one if it is above.
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
    /// The products `U` and `V`, with a coupling or further functions.
    by_turn: [Square; 2],
    /// The term between the body and its parent.
    coupling: Option<Box<Coupling>>,
    /// The joint's further functions.
    pub(super) turning: Option<Box<Turning>>,
}

/// The factors of a term that couples the body with its parent.
#[derive(Clone)]
struct Coupling {
    /// The matrices `N` and `M_x`, the rows of turns and of shifts.
    n: [Square; 2],
    m: [Square; 2],
    /// The part of the matrix of the parent, as blocks in the order of its own.
    of_parent: [Square; 4],
}

/// The blocks of a matrix of a body.
#[hot]
fn blocks<R: Register>(zero: R, m: &Matrix6<f64>) -> [Columns<R>; 4] {
    let [a, b, c, d, e, f] = &m.data.0;
    [
        Columns([top(zero, a), top(zero, b), top(zero, c)]),
        Columns([bottom(zero, a), bottom(zero, b), bottom(zero, c)]),
        Columns([top(zero, d), top(zero, e), top(zero, f)]),
        Columns([bottom(zero, d), bottom(zero, e), bottom(zero, f)]),
    ]
}

#[hot]
fn top<R: Register>(zero: R, [x, y, z, u, ..]: &[f64; 6]) -> R {
    zero.of([*x, *y, *z, *u])
}

#[hot]
fn bottom<R: Register>(zero: R, [.., z, u, v, w]: &[f64; 6]) -> R {
    zero.of([*u, *v, *w, *z])
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

/// The matrix `Sᵀ` of a point in the axes of a body with this attitude.
#[hot]
fn transposed_slope<R: Register>(attitude: Columns<R>, point: R) -> Square {
    let [x, y, z] = attitude.transposed().0;
    Columns([cross(point, x), cross(point, y), cross(point, z)]).entries()
}

/// The matrix `T` of a point at the end of this arm, for turns by the columns.
#[hot]
fn slope<R: Register>(turn: Columns<R>, arm: R) -> Square {
    let [x, y, z] = turn.0;
    Columns([cross(x, arm), cross(y, arm), cross(z, arm)]).entries()
}

impl Ball {
    /// A joint towards the root, of which the body is the one below or the one above.
    pub(super) fn new(joint: PointJoint, is_below: bool, is_coupled: bool) -> Self {
        let sides = |[above, below]: [Vector3<f64>; 2]| if is_below { [below, above] } else { [above, below] };
        let (own, before, after) = ([ZERO; 4], [ZERO; 2], [ZERO; 2]);
        let (inverse, z, g, h, beyond) = (ZERO, ZERO, ZERO, ZERO, ZERO);
        let (sign, points) = (if is_below { 1.0 } else { -1.0 }, sides(joint.points));
        let turning = (joint.count > 0).then(|| Box::new(Turning::new(joint.cosines.map(sides), joint.count)));
        let coupling = Coupling { n: [ZERO; 2], m: [ZERO; 2], of_parent: [ZERO; 4] };
        let coupling = is_coupled.then(|| Box::new(coupling));
        let by_turn = [ZERO; 2];
        Self { joint, sign, points, own, before, after, inverse, z, g, h, beyond, by_turn, coupling, turning }
    }

    /// Whether these are the equations of such a joint.
    pub(super) fn is_like(&self, joint: &PointJoint, is_below: bool) -> bool {
        self.joint == *joint && (self.sign > 0.0) == is_below
    }

    /// Adds to the body's matrix.
    pub(super) fn add_matrix(&mut self, m: &Matrix6<f64>) {
        let before = self.own;
        self.set_matrix(Plain::ZERO, m);
        for (entry, before) in self.own.as_flattened_mut().iter_mut().zip(before.as_flattened()) {
            entry.iter_mut().zip(before).for_each(|(entry, before)| *entry += before);
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
}

#[hot]
impl Coupling {
    /// Sets the factors by `M`, `T` and `T_b`, `B⁻¹ G` and `U`.
    fn set<R: Register>(
        &mut self,
        [m11, m21, m12, m22]: [Columns<R>; 4],
        [t, t_parent]: [Columns<R>; 2],
        [z, u]: [Columns<R>; 2],
    ) {
        let (first, second) = (m11 - m12 * t, m21 - m22 * t);
        let (by_point, of_shift) = (m12 - first * z, m22 - second * z);
        let (by_turn, of_turn) = (by_point * t_parent - first * u, of_shift * t_parent - second * u);
        self.n = [first.entries(), second.entries()];
        self.m = [m12.entries(), m22.entries()];
        self.of_parent = [by_turn.entries(), of_turn.entries(), by_point.entries(), of_shift.entries()];
    }
}

#[hot]
impl Ball {
    /// Sets the body's matrix.
    pub(super) fn set_matrix<R: Register>(&mut self, zero: R, m: &Matrix6<f64>) {
        let [a11, a21, a12, a22] = blocks(zero, m);
        self.own = [a11.entries(), a21.entries(), a12.entries(), a22.entries()];
    }

    /// Sets `S` at these attitudes of the body, and of its parent if there is one.
    pub(super) fn set_before<R: Register>(&mut self, zero: R, own: &Matrix3<f64>, parent: Option<&Matrix3<f64>>) {
        let own = stored(zero, own);
        self.before[0] = transposed_slope(own, zero.of(padded(&self.points[0])));
        let mut other = Columns::multiple(zero, 1.0);
        if let Some(parent) = parent {
            other = stored(zero, parent);
            self.before[1] = transposed_slope(other, zero.of(padded(&self.points[1])));
        }
        if let Some(turning) = &mut self.turning {
            turning.before = turning.slopes(zero, [own, other], [own, other]);
        }
    }

    /// Sets `T` at these attitudes, for unknowns that turn the bodies by these maps.
    pub(super) fn set_after<R: Register>(
        &mut self,
        zero: R,
        [own, turn]: [&Matrix3<f64>; 2],
        parent: Option<[&Matrix3<f64>; 2]>,
    ) {
        let (own, turn) = (stored(zero, own), stored(zero, turn));
        self.after[0] = slope(turn, own.map(zero.of(padded(&self.points[0]))));
        let mut other = [Columns::multiple(zero, 1.0); 2];
        if let Some(parent) = parent {
            other = [stored(zero, parent[0]), stored(zero, parent[1])];
            self.after[1] = slope(other[1], other[0].map(zero.of(padded(&self.points[1]))));
        }
        if let Some(turning) = &mut self.turning {
            turning.after = turning.slopes(zero, [own, other[0]], [turn, other[1]]);
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

    /// Eliminates the body, with these blocks `L` and `M` if it is coupled with its parent. Returns the determinant of `B` relative
    /// to its diagonal.
    pub(super) fn factorise<R: Register>(&mut self, zero: R, coupled: Option<[&Matrix6<f64>; 2]>) -> f64 {
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
        let (mut u, mut v, mut of_point, mut mass) = (Columns([zero; 3]), Columns([zero; 3]), g, a22);
        if let Some([own, _]) = coupled {
            let ([l11, l21, l12, l22], parent) = (blocks(zero, own), loaded(zero, &self.after[1]));
            v = l21 - l22 * parent;
            u = inverse * (l11 - l12 * parent - s * v);
            (of_point, mass) = (g + l12 - s * l22, a22 + l22);
        }
        let mut z = inverse * of_point;
        if let Some(turning) = &mut self.turning {
            let [by_turn, by_point] = turning.factorise(zero, inverse, [u, z]);
            (u, z) = (u + by_turn, z + by_point);
        }
        if coupled.is_some() || self.turning.is_some() {
            self.by_turn = [u.entries(), (h * u - v).entries()];
        }
        if let (Some([_, other]), Some(coupling)) = (coupled, &mut self.coupling) {
            coupling.set(blocks(zero, other), [t, loaded(zero, &self.after[1])], [z, u]);
        }
        self.beyond = (mass - h * z).entries();
        (self.inverse, self.z, self.g, self.h) = (inverse.entries(), z.entries(), g.entries(), h.entries());
        let [[b11, ..], [_, b22, ..], [_, _, b33, _]] = b.entries();
        determinant.entries()[0] / (b11 * b22 * b33).abs()
    }

    /// The mass at the joint, as blocks of the matrix of the parent in the order of its own.
    pub(super) fn of_parent<R: Register>(&self, zero: R) -> [Columns<R>; 4] {
        let beyond = loaded(zero, &self.beyond);
        let (s, t) = (loaded(zero, &self.before[1]), loaded(zero, &self.after[1]));
        let mut turned = beyond * t;
        if self.turning.is_some() || self.coupling.is_some() {
            turned = turned - loaded(zero, &self.by_turn[1]);
        }
        let mut all = [s * turned, turned, s * beyond, beyond];
        if let Some(turning) = &self.turning {
            let [by_turn, by_point] = &turning.of_parent;
            let (by_turn, by_point) = (loaded(zero, by_turn), loaded(zero, by_point));
            all[0] = all[0] + (by_turn + by_point * t);
            all[2] = all[2] + by_point;
        }
        if let Some(coupling) = &self.coupling {
            for (sum, part) in all.iter_mut().zip(&coupling.of_parent) {
                *sum = *sum + loaded(zero, part);
            }
        }
        all
    }

    /// Adds to the blocks of the body's matrix.
    pub(super) fn add<R: Register>(&mut self, zero: R, [first, second, third, fourth]: [Columns<R>; 4]) {
        let [a11, a21, a12, a22] = &mut self.own;
        *a11 = (loaded(zero, a11) + first).entries();
        *a21 = (loaded(zero, a21) + second).entries();
        *a12 = (loaded(zero, a12) + third).entries();
        *a22 = (loaded(zero, a22) + fourth).entries();
    }

    /// The momenta that these multipliers take from the body and from its parent.
    pub(super) fn reactions<R: Register>(&self, zero: R, multipliers: &Vector6<f64>) -> [[R; 2]; 2] {
        let force = turn_of(zero, multipliers) * zero.of([self.sign; 4]);
        let mut turns = [loaded(zero, &self.before[0]).map(force), zero - loaded(zero, &self.before[1]).map(force)];
        if let Some(turning) = &self.turning {
            let multipliers = shift_of(zero, multipliers);
            for (turn, before) in turns.iter_mut().zip(&turning.before) {
                *turn = *turn + loaded(zero, before).map(multipliers);
            }
        }
        [[turns[0], force], [turns[1], zero - force]]
    }

    /// The pair `w` and `q` for the right-hand side `r` and this gap, the addition to the right-hand side of the parent, and the
    /// squares of the opposed parts of `w` and of the shift.
    pub(super) fn inwards<R: Register>(
        &self,
        zero: R,
        [r1, r2]: [R; 2],
        gap: &mut Vector6<f64>,
    ) -> ([R; 2], [R; 2], Vector2<f64>) {
        let gamma = turn_of(zero, gap) * zero.of([self.sign; 4]);
        let inverse = loaded(zero, &self.inverse);
        let taken = inverse.map(loaded(zero, &self.before[0]).map(r2));
        let mut w = inverse.map(r1 - loaded(zero, &self.g).map(gamma)) - taken;
        let mut torque = zero;
        if let Some(turning) = &self.turning {
            let [s, turned, of_parent] = turning.reduced(zero, w, shift_of(zero, gap));
            (w, torque) = (w + turned, of_parent);
            gap.as_mut_slice()[3..].copy_from_slice(&s.entries()[..3]);
        }
        let q = r2 - loaded(zero, &self.own[3]).map(gamma) - loaded(zero, &self.h).map(w);
        let mut added = [loaded(zero, &self.before[1]).map(q) + torque, q];
        if let Some(Coupling { n, m, .. }) = self.coupling.as_deref() {
            for side in 0..2 {
                added[side] = added[side] - loaded(zero, &n[side]).map(w) - loaded(zero, &m[side]).map(gamma);
            }
        }
        let opposed = square(taken);
        let size = Vector2::new(2.0 * opposed, self.points[0].norm_squared() * opposed);
        ([w, q], added, size)
    }

    /// The unknowns of the body by those of its parent; replaces the gap by the multipliers.
    pub(super) fn outwards<R: Register>(
        &self,
        zero: R,
        [w, q]: [R; 2],
        parent: Option<[R; 2]>,
        gap: &mut Vector6<f64>,
    ) -> [R; 2] {
        let gamma = turn_of(zero, gap) * zero.of([self.sign; 4]);
        let (mut turn, mut point) = (zero, zero);
        if let Some(of) = parent {
            turn = of[0];
            point = of[1] + loaded(zero, &self.after[1]).map(turn);
        }
        let mut z = zero - w - loaded(zero, &self.z).map(point);
        let mut force = q + loaded(zero, &self.beyond).map(point);
        if self.turning.is_some() || self.coupling.is_some() {
            let [u, v] = &self.by_turn;
            z = z - loaded(zero, u).map(turn);
            force = force - loaded(zero, v).map(turn);
        }
        if let Some(turning) = &self.turning {
            let multipliers = turning.completed(zero, shift_of(zero, gap), turn, point);
            gap.as_mut_slice()[3..].copy_from_slice(&multipliers.entries()[..3]);
        }
        let x = point - gamma - loaded(zero, &self.after[0]).map(z);
        let [a, b, c, _] = (force * zero.of([-self.sign; 4])).entries();
        gap.as_mut_slice()[..3].copy_from_slice(&[a, b, c]);
        [z, x]
    }
}
