//! Elimination of a body on a ball joint, by its turn and the shift of the joint's point: blocks of three are left.
//!
//! Let `T` map the body's turn to the shift of the joint's point after the step, and `S` to that before it. The equations
//! of the turn `z` and of the point's shift `ξ`, where `x = ξ − T z`, are those of the body by
//!
//! ```text
//! B = A₁₁ − A₁₂ T − Sᵀ(A₂₁ − A₂₂ T)       G = A₁₂ − Sᵀ A₂₂       H = A₂₁ − A₂₂ T       M = A₂₂       t = r₁ − Sᵀ r₂
//! B z + G ξ = −t                          H z + M ξ + P = −r₂                          ξ = ξ_b + T_b z_b − g
//! ```
//!
//! with the force `P` of the joint. The parent's turn moves the point from the parent's own joint by `T_b`, or from its origin if
//! that isn't a ball joint. So the parent sees a mass `Π` at the joint and a momentum `q`, and lever arms within one body alone:
//!
//! ```text
//! w = B⁻¹ t          Π = M − H B⁻¹ G          q = r₂ − H w          z = −w − B⁻¹ G ξ          P = −q − Π ξ
//! (B G; H M)_b ← (B G; H M)_b + (S_b I)ᵀ Π (T_b I)                 (t r₂)_b ← (t r₂)_b + (S_b I)ᵀ (q − Π g)
//! ```
//!
//! A term that couples the body with its parent adds `L y_b` to the equations of the body and `M y` to those of the parent, by the
//! turn and the shift of its origin. With the map `T_o` from the parent's turn to the point's shift from there, `x_b = ξ − T_o z_b`:
//!
//! ```text
//! L₂ = L₂₁ − L₂₂ T_o      K = L₁₁ − L₁₂ T_o − Sᵀ L₂       G ← G + L₁₂ − Sᵀ L₂₂       M ← M + L₂₂ in Π
//! z = −w − B⁻¹ G ξ − U z_b        P = −q − Π ξ + V z_b    U = B⁻¹ K                  V = H U − L₂
//! N = M_z − M_x T                 M y = −N w + (M_x − N B⁻¹ G) ξ − N U z_b
//! ```
//!
//! Functions of attitudes beyond these three, as those of a pin, are a [`Turning`].
//!
//! This is the elimination of [`Chain`](crate::methods::Chain), in the axes of space, for bodies with unknowns of their own.

use alloc::boxed::Box;

use nalgebra::{Matrix3, Matrix6, Vector2, Vector3, Vector6};

use super::point_joint::PointJoint;
use super::square::{Square, ZERO, loaded, shift_of, stored, turn_of};
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
    /// The point at the parent from the parent's own ball joint, or from its origin without one, in its axes, m.
    arm: Vector3<f64>,
    /// The blocks `B`, `H`, `G` and `M` of the body with all that hangs on it.
    own: [Square; 4],
    /// The matrices `Sᵀ` and `S_bᵀ`.
    before: [Square; 2],
    /// The matrices `T` and `T_b`.
    after: [Square; 2],
    /// The factors `B⁻¹`, `B⁻¹ G`, `H` and `Π`.
    inverse: Square,
    z: Square,
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
    /// The matrix `T_o`.
    from_origin: Square,
    /// The parts `L₁₂ − Sᵀ L₂₂` and `L₂₂` of `G` and `M`.
    l: [Square; 2],
    /// The matrix `N`, the rows of turns and of shifts.
    n: [Square; 2],
    /// The part of the matrix of the parent, as blocks in the order of its own.
    of_parent: [Square; 4],
}

/// The blocks of a matrix of a body.
#[hot]
pub(super) fn blocks<R: Register>(zero: R, m: &Matrix6<f64>) -> [Columns<R>; 4] {
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

/// The mass of a body whose shifts have only that, and no part in the equations of its turns.
#[hot]
fn mass_alone(m: &Matrix6<f64>) -> Option<f64> {
    let [a, b, c, d, e, f] = &m.data.0;
    let all = [
        a[3], a[4], a[5], b[3], b[4], b[5], c[3], c[4], c[5], d[0], d[1], d[2], e[0], e[1], e[2], f[0], f[1], f[2],
        d[4], d[5], e[3], e[5], f[3], f[4],
    ];
    let mut bits = 0;
    for entry in all {
        bits |= entry.to_bits();
    }
    // The sign of a zero is the highest bit.
    let masses = [d[3], e[4], f[5]].map(f64::to_bits);
    (bits << 1 == 0 && masses == [masses[0]; 3]).then_some(d[3])
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

#[hot]
fn is_zero([x, y, z, ..]: [f64; 4]) -> bool {
    x == 0.0 && y == 0.0 && z == 0.0
}

impl Ball {
    /// A joint towards the root, of which the body is the one below or the one above. `from` is the point of the parent's own ball
    /// joint, or its origin.
    pub(super) fn new(joint: PointJoint, is_below: bool, is_coupled: bool, from: &Vector3<f64>) -> Self {
        let sides = |[above, below]: [Vector3<f64>; 2]| if is_below { [below, above] } else { [above, below] };
        let (own, before, after) = ([ZERO; 4], [ZERO; 2], [ZERO; 2]);
        let (inverse, z, h, beyond) = (ZERO, ZERO, ZERO, ZERO);
        let (sign, points) = (if is_below { 1.0 } else { -1.0 }, sides(joint.points));
        let turning = (joint.count > 0).then(|| Box::new(Turning::new(joint.cosines.map(sides), joint.count)));
        let coupling = Coupling { from_origin: ZERO, l: [ZERO; 2], n: [ZERO; 2], of_parent: [ZERO; 4] };
        let coupling = is_coupled.then(|| Box::new(coupling));
        let (arm, by_turn) = (points[1] - from, [ZERO; 2]);
        Self { joint, sign, points, arm, own, before, after, inverse, z, h, beyond, by_turn, coupling, turning }
    }

    /// Whether these are the equations of such a joint.
    pub(super) fn is_like(&self, joint: &PointJoint, is_below: bool, from: &Vector3<f64>) -> bool {
        self.joint == *joint && (self.sign > 0.0) == is_below && self.arm == self.points[1] - from
    }

    /// Adds to the body's matrix.
    pub(super) fn add_matrix(&mut self, m: &Matrix6<f64>) {
        self.add_from_origin(Plain::ZERO, blocks(Plain::ZERO, m));
    }

    /// The square of the longest lever arm, m².
    pub(super) fn squared_arm(&self) -> f64 {
        self.points.iter().map(Vector3::norm_squared).fold(0.0, f64::max)
    }
}

#[hot]
impl Coupling {
    /// Sets the part of the parent by `M`, `T`, `B⁻¹ G` and `U`.
    fn set<R: Register>(
        &mut self,
        zero: R,
        [m11, m21, m12, m22]: [Columns<R>; 4],
        t: Columns<R>,
        [z, u]: [Columns<R>; 2],
    ) {
        let from_origin = loaded(zero, &self.from_origin);
        let (first, second) = (m11 - m12 * t, m21 - m22 * t);
        let (by_point, of_shift) = (m12 - first * z, m22 - second * z);
        let (by_turn, of_turn) = (by_point * from_origin - first * u, of_shift * from_origin - second * u);
        self.n = [first.entries(), second.entries()];
        self.of_parent = [by_turn.entries(), of_turn.entries(), by_point.entries(), of_shift.entries()];
    }
}

#[hot]
impl Ball {
    /// Sets the body's matrix.
    pub(super) fn set_matrix<R: Register>(&mut self, zero: R, m: &Matrix6<f64>) {
        let all @ [a11, ..] = blocks(zero, m);
        let own = match mass_alone(m) {
            Some(mass) => {
                let (s, t) = (loaded(zero, &self.before[0]), loaded(zero, &self.after[0]));
                let (none, mass) = (Columns([zero; 3]), zero.of([mass; 4]));
                let g = none - s.scaled(mass);
                [a11 - g * t, none - t.scaled(mass), g, all[3]]
            }
            None => self.by_point(zero, all),
        };
        self.own = [own[0].entries(), own[1].entries(), own[2].entries(), own[3].entries()];
    }

    /// Blocks of a matrix in the equations of the body's turn and of its point.
    fn by_point<R: Register>(&self, zero: R, [a11, a21, a12, a22]: [Columns<R>; 4]) -> [Columns<R>; 4] {
        let (s, t) = (loaded(zero, &self.before[0]), loaded(zero, &self.after[0]));
        let (g, h) = (a12 - s * a22, a21 - a22 * t);
        [a11 - g * t - s * a21, h, g, a22]
    }

    /// Adds blocks of a matrix of the body to its own.
    pub(super) fn add_from_origin<R: Register>(&mut self, zero: R, blocks: [Columns<R>; 4]) {
        self.add(zero, self.by_point(zero, blocks));
    }

    /// The joint's point in the body, and that in space or at the parent from the parent's own ball joint.
    pub(super) fn arms<R: Register>(&self, zero: R) -> [R; 2] {
        [zero.of(padded(&self.points[0])), zero.of(padded(&self.arm))]
    }

    /// Sets `S` at these attitudes of the body, and of its parent if there is one; and `T_o` at these, for velocities.
    pub(super) fn set_before<R: Register>(&mut self, zero: R, own: &Matrix3<f64>, parent: Option<&Matrix3<f64>>) {
        let own = stored(zero, own);
        self.before[0] = transposed_slope(own, zero.of(padded(&self.points[0])));
        let mut other = Columns::multiple(zero, 1.0);
        if let Some(parent) = parent {
            other = stored(zero, parent);
            self.before[1] = transposed_slope(other, zero.of(padded(&self.arm)));
            if let Some(coupling) = &mut self.coupling {
                let slope = transposed_slope(other, zero.of(padded(&self.points[1])));
                coupling.from_origin = loaded(zero, &slope).transposed().entries();
            }
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
            self.after[1] = slope(other[1], other[0].map(zero.of(padded(&self.arm))));
            if let Some(coupling) = &mut self.coupling {
                coupling.from_origin = slope(other[1], other[0].map(zero.of(padded(&self.points[1]))));
            }
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

    /// Factorises the body's matrix, with these blocks `L` and `M` if it is coupled with its parent. Returns the determinant of `B`
    /// relative to its diagonal.
    pub(super) fn factorise<R: Register>(&mut self, zero: R, coupled: Option<[&Matrix6<f64>; 2]>) -> f64 {
        let [b, h, g, m] = &self.own;
        let (b, h, g, m) = (loaded(zero, b), loaded(zero, h), loaded(zero, g), loaded(zero, m));
        // Cramer's rule; a determinant of zero leads to numbers that aren't finite.
        let [x, y, z] = b.0;
        let rows = [cross(y, z), cross(z, x), cross(x, y)];
        let determinant = dot(x, rows[0]);
        let inverse = Columns(rows).transposed().scaled(zero.of([1.0; 4]) / determinant);
        let (mut u, mut v, mut of_point, mut mass) = (Columns([zero; 3]), Columns([zero; 3]), g, m);
        if let (Some([own, _]), Some(coupling)) = (coupled, &mut self.coupling) {
            let (s, from_origin) = (loaded(zero, &self.before[0]), loaded(zero, &coupling.from_origin));
            let [l11, l21, l12, l22] = blocks(zero, own);
            let of_turns = l12 - s * l22;
            v = l21 - l22 * from_origin;
            u = inverse * (l11 - l12 * from_origin - s * v);
            (of_point, mass) = (g + of_turns, m + l22);
            coupling.l = [of_turns.entries(), l22.entries()];
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
            coupling.set(zero, blocks(zero, other), loaded(zero, &self.after[0]), [z, u]);
        }
        self.beyond = (mass - h * z).entries();
        (self.inverse, self.z, self.h) = (inverse.entries(), z.entries(), h.entries());
        let [[b11, ..], [_, b22, ..], [_, _, b33, _]] = b.entries();
        determinant.entries()[0] / (b11 * b22 * b33).abs()
    }

    /// The mass at the joint, as blocks of the matrix of the parent by its turn and its own ball joint, or by its origin.
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
        all
    }

    /// The part of a coupling in the matrix of the parent, by its origin.
    pub(super) fn of_coupled_parent<R: Register>(&self, zero: R) -> Option<[Columns<R>; 4]> {
        let Some(coupling) = &self.coupling else { return None };
        let [a, b, c, d] = &coupling.of_parent;
        Some([loaded(zero, a), loaded(zero, b), loaded(zero, c), loaded(zero, d)])
    }

    /// Adds to the blocks of the body with all that hangs on it.
    pub(super) fn add<R: Register>(&mut self, zero: R, [first, second, third, fourth]: [Columns<R>; 4]) {
        let [b, h, g, m] = &mut self.own;
        *b = (loaded(zero, b) + first).entries();
        *h = (loaded(zero, h) + second).entries();
        *g = (loaded(zero, g) + third).entries();
        *m = (loaded(zero, m) + fourth).entries();
    }

    /// The momenta that these multipliers take from the body, with those that the joints beyond take about its own, and from its
    /// parent.
    pub(super) fn reactions<R: Register>(
        &self,
        zero: R,
        [turn, shift]: [R; 2],
        multipliers: &Vector6<f64>,
    ) -> [[R; 2]; 2] {
        let force = turn_of(zero, multipliers) * zero.of([self.sign; 4]);
        let shift = shift + force;
        let mut turns =
            [turn + loaded(zero, &self.before[0]).map(shift), zero - loaded(zero, &self.before[1]).map(force)];
        if let Some(turning) = &self.turning {
            let multipliers = shift_of(zero, multipliers);
            turns[0] = turns[0] + loaded(zero, &turning.before[0]).map(multipliers);
            turns[1] = turns[1] + loaded(zero, &turning.before[1]).map(multipliers);
        }
        [[turns[0], shift], [turns[1], zero - force]]
    }

    /// The gap of the held points, and whether there is none.
    fn gap<R: Register>(&self, zero: R, gap: &Vector6<f64>) -> (R, bool) {
        let gamma = turn_of(zero, gap) * zero.of([self.sign; 4]);
        (gamma, is_zero(gamma.entries()))
    }

    /// The pair `w` and `q` for the right-hand side `r`, that of all that hangs on the body, and this gap; the addition to the
    /// right-hand side of the parent; and the squares of the opposed parts of `w` and of the shift.
    pub(super) fn inwards<R: Register>(
        &self,
        zero: R,
        [r1, r2]: [R; 2],
        [mut t, mut q]: [R; 2],
        gap: &mut Vector6<f64>,
    ) -> ([R; 2], [R; 2], Vector2<f64>) {
        let (gamma, is_closed) = self.gap(zero, gap);
        (t, q) = (t - loaded(zero, &self.before[0]).map(r2), q + r2);
        if let (Some(coupling), false) = (&self.coupling, is_closed) {
            t = t + loaded(zero, &coupling.l[0]).map(gamma);
            q = q + loaded(zero, &coupling.l[1]).map(gamma);
        }
        let inverse = loaded(zero, &self.inverse);
        let taken = inverse.map(t);
        let (mut w, mut torque) = (inverse.map(r1) + taken, zero);
        if let Some(turning) = &self.turning {
            let [s, turned, of_parent] = turning.reduced(zero, w, shift_of(zero, gap));
            (w, torque) = (w + turned, of_parent);
            gap.as_mut_slice()[3..].copy_from_slice(&s.entries()[..3]);
        }
        q = q - loaded(zero, &self.h).map(w);
        let mut beyond = q;
        if !is_closed {
            beyond = q - loaded(zero, &self.beyond).map(gamma);
            if let Some(turning) = &self.turning {
                torque = torque - loaded(zero, &turning.of_parent[1]).map(gamma);
            }
        }
        let opposed = square(taken);
        let size = Vector2::new(2.0 * opposed, self.points[0].norm_squared() * opposed);
        ([w, q], [loaded(zero, &self.before[1]).map(beyond) + torque, beyond], size)
    }

    /// The addition of a coupling to the right-hand side of the parent, by its origin.
    pub(super) fn coupled<R: Register>(&self, zero: R, w: R, gap: &Vector6<f64>) -> Option<[R; 2]> {
        let Some(coupling) = &self.coupling else { return None };
        let [_, _, by_point, of_shift] = &coupling.of_parent;
        let (gamma, _) = self.gap(zero, gap);
        Some([
            zero - loaded(zero, &coupling.n[0]).map(w) - loaded(zero, by_point).map(gamma),
            zero - loaded(zero, &coupling.n[1]).map(w) - loaded(zero, of_shift).map(gamma),
        ])
    }

    /// The turn and the point's shift of the body by those of its parent; replaces the gap by the multipliers.
    pub(super) fn outwards<R: Register>(
        &self,
        zero: R,
        [w, q]: [R; 2],
        parent: Option<[R; 2]>,
        gap: &mut Vector6<f64>,
    ) -> [R; 2] {
        let mut point = zero - turn_of(zero, gap) * zero.of([self.sign; 4]);
        let mut turn = zero;
        if let Some(of) = parent {
            turn = of[0];
            point = point + (of[1] + loaded(zero, &self.after[1]).map(turn));
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
        let [a, b, c, _] = (force * zero.of([-self.sign; 4])).entries();
        gap.as_mut_slice()[..3].copy_from_slice(&[a, b, c]);
        [z, point]
    }

    /// The shift of the body by its turn and the shift of its point.
    pub(super) fn shift<R: Register>(&self, zero: R, [turn, point]: [R; 2]) -> R {
        point - loaded(zero, &self.after[0]).map(turn)
    }
}
