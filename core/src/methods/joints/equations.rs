//! The equations of jointed bodies, at one configuration.

use nalgebra::{Matrix3, SMatrix, SVector, Vector2, Vector6};

roots!();

use super::elimination::{Body, Closing, Unknowns, factorise, solve};
use super::graph::{Joints, PlacedJoint, Tree};
use super::places::{Ends, Places, Slopes, after, before, parts};
use super::{Constraint, Slope};

/// The least pivot of a joint that closes a loop and isn't redundant, relative to that between free bodies. The
/// rounding error of a zero is some `1e-14`. Near a singular configuration a pivot is quadratic in the distance to it,
/// so this limit is some 3 µrad away. It is also proportional to the ratio of the bodies' masses: ratios of 1e11 are
/// refused.
const REDUNDANT: f64 = 1e-11;

/// The joint with the widest gap, or with the fastest opening one.
pub(super) struct Widest {
    pub(super) joint: usize,
    /// The norm of its gap, in the units of its functions.
    pub(super) by: f64,
    /// The largest value of a function, relative to the size of its terms.
    pub(super) relative: f64,
}

/// The least pivot of a joint with independent functions: the rounding error of a zero in a tree, whose pivots are
/// relative to the joint's own matrix. A point mass on an arm of ten million radii is at the limit.
const DEPENDENT: f64 = 1e-14;

/// Matrices, slopes and right-hand sides; after a solution the unknowns.
pub(super) struct Equations<'a, C, const K: usize, const N: usize, const T: usize, const L: usize> {
    joints: &'a Joints<C, T, L>,
    tree: &'a Tree<N>,
    bodies: [Body<K>; N],
    loops: [Closing<K, N, L>; L],
    pub(super) unknowns: Unknowns<K, N, L>,
}

impl<'a, C: Constraint<K>, const K: usize, const N: usize, const T: usize, const L: usize>
    Equations<'a, C, K, N, T, L>
{
    /// Equations whose slopes and matrices aren't set yet.
    // Inlined, so that the result is written in place and not copied.
    #[hot]
    pub(super) fn new(joints: &'a Joints<C, T, L>, tree: &'a Tree<N>) -> Self {
        let loops =
            joints.loops.each_ref().map(|joined| Closing::new([Some(joined.below), joined.above], joined.joint.rows()));
        let mut equations = Self { joints, tree, bodies: [Body::new(); N], loops, unknowns: Unknowns::new() };
        for (body, member) in equations.bodies.iter_mut().zip(&tree.members) {
            let joined = member.joint.and_then(|joint| joints.tree.get(joint));
            body.rows = joined.map_or(0, |joined| joined.joint.rows());
        }
        equations
    }

    /// Applies `of` to the slopes of all joints at these places.
    #[hot]
    fn each(&mut self, places: &Places<N>, of: impl Fn(&mut Ends<K>, usize, &Slope<K>)) {
        for (k, (body, member)) in self.bodies.iter_mut().zip(&self.tree.members).enumerate() {
            let Some(joined) = member.joint.and_then(|joint| self.joints.tree.get(joint)) else { continue };
            let [below, above] = places.slope(joined);
            // The body's own end comes first.
            let [own, other] = if member.is_below { [below, above] } else { [above, below] };
            let [of_own, of_other] = &mut body.slopes.0;
            of(of_own, k, &own);
            if let Some(parent) = member.parent {
                of(of_other, parent, &other);
            }
        }
        for (closing, joined) in self.loops.iter_mut().zip(&self.joints.loops) {
            let slopes = places.slope(joined);
            for ((body, ends), slope) in closing.bodies.into_iter().zip(&mut closing.slopes.0).zip(&slopes) {
                if let Some(body) = body {
                    of(ends, body, slope);
                }
            }
        }
    }

    /// Sets `E` at these places.
    pub(super) fn set_before(&mut self, places: &Places<N>) {
        self.each(places, |ends, body, slope| ends.before = before(slope, &places.0[body].attitude));
    }

    /// Sets `C` at these places, for unknowns that turn the bodies by these maps.
    pub(super) fn set_after(&mut self, places: &Places<N>, turns: &[Matrix3<f64>; N]) {
        self.each(places, |ends, body, slope| ends.after = after(slope, &turns[body]));
    }

    /// Sets the equations of velocities at these places, with `C = E`, by the inertias of the bodies.
    pub(super) fn set_velocities(&mut self, places: &Places<N>, inertias: &[SMatrix<f64, 6, 6>; N]) {
        self.each(places, |ends, body, slope| {
            ends.before = before(slope, &places.0[body].attitude);
            ends.after = ends.before.transpose();
        });
        self.factorise(inertias);
    }

    /// Factorises these matrices of the bodies.
    pub(super) fn factorise(&mut self, matrices: &[SMatrix<f64, 6, 6>; N]) {
        for (body, matrix) in self.bodies.iter_mut().zip(matrices) {
            body.matrix = *matrix;
        }
        factorise(self.tree, &mut self.bodies, &mut self.loops);
    }

    /// Solves for these residuals of the bodies and gaps of the joints; returns the result of [`solve`].
    pub(super) fn solve(
        &mut self,
        residuals: &[Vector6<f64>; N],
        gap: impl Fn(&PlacedJoint<C>) -> SVector<f64, K>,
    ) -> Vector2<f64> {
        self.unknowns.bodies = *residuals;
        for (unknown, member) in self.unknowns.joints.iter_mut().zip(&self.tree.members) {
            let joined = member.joint.and_then(|joint| self.joints.tree.get(joint));
            *unknown = joined.map_or_else(SVector::zeros, &gap);
        }
        for (unknown, joined) in self.unknowns.loops.iter_mut().zip(&self.joints.loops) {
            *unknown = gap(joined);
        }
        solve(self.tree, &self.bodies, &self.loops, &mut self.unknowns)
    }

    /// The reactions `Σ Eᵀ p` of each body: the momentum that the multipliers take.
    pub(super) fn reactions(&self) -> [Vector6<f64>; N] {
        let mut reactions = [Vector6::zeros(); N];
        for (k, (body, member)) in self.bodies.iter().zip(&self.tree.members).enumerate() {
            if member.joint.is_none() {
                continue;
            }
            let [own, of_parent] = &body.slopes.0;
            reactions[k] += own.before * self.unknowns.joints[k];
            if let Some(parent) = member.parent {
                reactions[parent] += of_parent.before * self.unknowns.joints[k];
            }
        }
        for (closing, multiplier) in self.loops.iter().zip(&self.unknowns.loops) {
            closing.ends().for_each(|(body, ends)| reactions[body] += ends.before * multiplier);
        }
        reactions
    }

    /// The joint with the widest gap; `lengths` are the bodies' radii of gyration, m.
    pub(super) fn widest_gap(&self, places: &Places<N>, lengths: &[f64; N]) -> Widest {
        let shift = |body: usize| lengths[body].max(places.0[body].position.norm());
        self.widest(1.0, shift, |joint, _| {
            let mut all = self.joints.tree.iter().chain(&self.joints.loops);
            all.nth(joint).map_or_else(SVector::zeros, |joined| places.gap(joined))
        })
    }

    /// The joint that these velocities open fastest, by `E y`; turns slower than `least`, rad/s, count as zero.
    pub(super) fn widest_parting(&self, velocities: &[Vector6<f64>; N], lengths: &[f64; N], least: f64) -> Widest {
        let largest = |of: fn(&Vector6<f64>) -> f64| velocities.iter().map(of).fold(0.0, f64::max);
        let turn = largest(|velocity| parts(velocity).0.norm()).max(least);
        let speed = largest(|velocity| parts(velocity).1.norm());
        self.widest(
            turn,
            |body| speed.max(lengths[body] * turn),
            |_, ends| {
                ends.iter().fold(SVector::zeros(), |sum, &(body, ends)| sum + ends.before.tr_mul(&velocities[body]))
            },
        )
    }

    /// The widest gap among these values of the functions, each relative to the size of its own terms.
    fn widest(
        &self,
        turn: f64,
        shift: impl Fn(usize) -> f64,
        values: impl Fn(usize, &[(usize, &Ends<K>)]) -> SVector<f64, K>,
    ) -> Widest {
        let mut widest = Widest { joint: 0, by: 0.0, relative: 0.0 };
        let mut compare = |joint: usize, bodies: [Option<usize>; 2], slopes: &Slopes<K>| {
            let [own, other] = [0, 1].map(|side| bodies[side].map(|body| (body, &slopes.0[side])));
            let both = [own.or(other), own.and(other)];
            let of = |ends: &[(usize, &Ends<K>)]| {
                let sizes = ends
                    .iter()
                    .fold(SVector::<f64, K>::zeros(), |sum, &(body, ends)| sum + ends.sizes(turn, shift(body)));
                (values(joint, ends), sizes)
            };
            let (values, sizes) = match both {
                [Some(one), Some(other)] => of(&[one, other]),
                [Some(one), None] => of(&[one]),
                _ => return,
            };
            for (value, size) in values.iter().zip(&sizes) {
                let relative = if *value == 0.0 { 0.0 } else { value.abs() / size };
                // A NaN counts as the widest gap.
                if !(relative <= widest.relative || widest.relative.is_nan()) {
                    widest = Widest { joint, by: values.norm(), relative };
                }
            }
        };
        for (k, (body, member)) in self.bodies.iter().zip(&self.tree.members).enumerate() {
            if let Some(joint) = member.joint {
                compare(joint, [Some(k), member.parent], &body.slopes);
            }
        }
        for (k, closing) in self.loops.iter().enumerate() {
            compare(T + k, closing.bodies, &closing.slopes);
        }
        widest
    }

    /// The largest distance of a body from the origin, or of a joint's points from their body, m. The rounding errors
    /// of positions are relative to this length.
    pub(super) fn extent(&self, places: &Places<N>) -> f64 {
        let of_bodies = self.bodies.iter().map(|body| &body.slopes);
        let slopes = of_bodies.chain(self.loops.iter().map(|closing| &closing.slopes));
        let arms = slopes.flat_map(|slopes| &slopes.0).map(Ends::squared_arm);
        places.0.iter().map(|place| place.position.norm_squared()).chain(arms).fold(0.0, f64::max).sqrt()
    }

    /// The first body whose pivot block has a determinant of the wrong sign, and that determinant.
    pub(super) fn wrong_body(&self) -> Option<(usize, f64)> {
        // A NaN counts as the wrong sign.
        let is_right = |body: &Body<K>| body.determinant > 0.0;
        let wrong = self.bodies.iter().position(|body| !is_right(body))?;
        Some((wrong, self.bodies[wrong].determinant))
    }

    pub(super) fn determinant(&self, body: usize) -> f64 {
        self.bodies[body].determinant
    }

    /// The determinant of the whole system, relative to its diagonal, if its sign is wrong while those of the bodies
    /// are positive. Along the branch that continues rest it never vanishes, so a solution with a changed sign is on
    /// another branch; a strut, for example, has a solution on either side. The signs of single joints may change, and
    /// which ones do depends on the choice of the joints that close loops; the sign of the whole doesn't.
    pub(super) fn reversed(&self) -> Option<f64> {
        let of_trees = self.bodies.iter().map(|body| body.of_joint);
        let of_joints = of_trees.chain(self.loops.iter().map(|closing| closing.of_joint));
        // The product of signs can't underflow as the product of the determinants could.
        let sign = |determinant: f64| if determinant == 0.0 { 0.0 } else { determinant.signum() };
        // A NaN counts as the wrong sign.
        let is_right = of_joints.clone().map(sign).product::<f64>() > 0.0;
        let of_bodies = self.bodies.iter().map(|body| body.determinant);
        if is_right { None } else { Some(of_bodies.chain(of_joints).product()) }
    }

    /// The first joint with dependent functions, or that is redundant beside the others: its number, and its pivot
    /// relative to that between free bodies.
    pub(super) fn redundant(&self) -> Option<(usize, f64)> {
        // Far from rest a pivot of the tree may be negative, as the matrix isn't symmetric. A NaN counts as zero.
        let has_rank = |body: &Body<K>| body.pivot.abs() > DEPENDENT;
        for (body, member) in self.bodies.iter().zip(&self.tree.members) {
            if let (Some(joint), false) = (member.joint, has_rank(body)) {
                return Some((joint, body.pivot));
            }
        }
        let has_something = |closing: &Closing<K, N, L>| closing.pivot > REDUNDANT;
        let joint = self.loops.iter().position(|closing| !has_something(closing))?;
        Some((T + joint, self.loops[joint].pivot))
    }
}
