//! Slopes, matrices and reactions of all bodies on ball joints, in registers.

use nalgebra::{Matrix3, Matrix6, Vector6};

use super::constraint::Place;
use super::graph::Tree;
use super::nodes::{Node, Pair};
use super::square::{shift_of, stored, three, turn_of, write};
use crate::numbers::{OnRegisters, Register, cross, dot, padded, vector};

/// The slopes of ball joints at these places: `S`, or `T` for unknowns that turn the bodies by these maps.
pub(super) struct BallSlopes<'a> {
    pub(super) tree: &'a Tree,
    pub(super) nodes: &'a mut [Node],
    pub(super) places: &'a [Place],
    pub(super) turns: Option<&'a [Matrix3<f64>]>,
}

impl OnRegisters for BallSlopes<'_> {
    type Output = ();

    #[hot]
    fn run<R: Register>(self, zero: R) {
        let Self { tree, nodes, places, turns } = self;
        for (k, (node, member)) in nodes.iter_mut().zip(&tree.members).enumerate() {
            let Some(ball) = &mut node.ball else { continue };
            let own = &places[k].attitude;
            match (turns, member.parent) {
                (None, None) => ball.set_before(zero, own, None),
                (None, Some(parent)) => ball.set_before(zero, own, Some(&places[parent].attitude)),
                (Some(turns), None) => ball.set_after(zero, [own, &turns[k]], None),
                (Some(turns), Some(parent)) => {
                    ball.set_after(zero, [own, &turns[k]], Some([&places[parent].attitude, &turns[parent]]));
                }
            }
        }
    }
}

/// The places after half increments, and the turns in the axes of space by the unknowns, `½ R T` with the tangent
/// `T = 2 (I + ŷ)/(1 + |y|²)` of the Cayley map; so `R F = R + R T ŷ`. The shifts of bodies on ball joints follow from the turns: with half the shift `u` of
/// the joint's point, which a turn of the parent moves by `½ R D ρ = ½ R T (y × ρ)`, they leave no gap.
pub(super) struct Increments<'a> {
    pub(super) tree: &'a Tree,
    pub(super) nodes: &'a [Node],
    pub(super) places: &'a [Place],
    pub(super) half: &'a mut [Vector6<f64>],
    pub(super) next: &'a mut [Place],
    pub(super) turns: &'a mut [Matrix3<f64>],
    /// Half the shift of each ball joint's point, and its position after the step; of other bodies their own.
    pub(super) points: &'a mut [Pair],
}

impl OnRegisters for Increments<'_> {
    type Output = ();

    #[hot]
    fn run<R: Register>(self, zero: R) {
        let Self { tree, nodes, places, half, next, turns, points } = self;
        for &k in &tree.order {
            let (place, y) = (&places[k], turn_of(zero, &half[k]));
            let (attitude, one) = (stored(zero, &place.attitude), zero.of([1.0; 4]));
            let turn = (attitude + attitude.cross_rows(y)).scaled(one / (one + dot(y, y)));
            let after = attitude + turn.cross_rows(y).scaled(one + one);
            (next[k].attitude.data.0, turns[k].data.0) = (three(after), three(turn));
            let Some(ball) = &nodes[k].ball else {
                next[k].position = place.position + vector(shift_of(zero, &half[k])) * 2.0;
                points[k] = [shift_of(zero, &half[k]).entries(), padded(&next[k].position)];
                continue;
            };
            let [own, arm] = ball.arms(zero);
            let (mut moved, mut point) = (zero, arm);
            if let Some(parent) = tree.members[k].parent {
                let [of_parent, position] = points[parent];
                moved = zero.of(of_parent) + stored(zero, &turns[parent]).map(cross(turn_of(zero, &half[parent]), arm));
                point = zero.of(position) + stored(zero, &next[parent].attitude).map(arm);
            }
            points[k] = [moved.entries(), point.entries()];
            next[k].position = vector(point - after.map(own));
            write(&mut half[k], [y, moved - turn.map(cross(y, own))]);
        }
    }
}

/// The matrices of bodies on ball joints.
pub(super) struct BallMatrices<'a> {
    pub(super) nodes: &'a mut [Node],
    pub(super) matrices: &'a [Matrix6<f64>],
}

impl OnRegisters for BallMatrices<'_> {
    type Output = ();

    #[hot]
    fn run<R: Register>(self, zero: R) {
        for (node, matrix) in self.nodes.iter_mut().zip(self.matrices) {
            if let Some(ball) = &mut node.ball {
                ball.set_matrix(zero, matrix);
            }
        }
    }
}

/// The momenta that the multipliers of ball joints take from all bodies.
pub(super) struct BallReactions<'a> {
    pub(super) tree: &'a Tree,
    pub(super) nodes: &'a [Node],
    pub(super) multipliers: &'a [Vector6<f64>],
    pub(super) reactions: &'a mut [Vector6<f64>],
}

impl OnRegisters for BallReactions<'_> {
    type Output = ();

    #[hot]
    fn run<R: Register>(self, zero: R) {
        let Self { tree, nodes, multipliers, reactions } = self;
        for &k in tree.order.iter().rev() {
            let Some(ball) = &nodes[k].ball else { continue };
            let of_others = [turn_of(zero, &reactions[k]), shift_of(zero, &reactions[k])];
            let [own, of_parent] = ball.reactions(zero, of_others, &multipliers[k]);
            write(&mut reactions[k], own);
            if let Some(parent) = tree.members[k].parent {
                let to = &mut reactions[parent];
                let sum = [turn_of(zero, to) + of_parent[0], shift_of(zero, to) + of_parent[1]];
                write(to, sum);
            }
        }
    }
}

/// The slopes `T = S` of ball joints.
pub(super) struct BallVelocities<'a> {
    pub(super) nodes: &'a mut [Node],
}

impl OnRegisters for BallVelocities<'_> {
    type Output = ();

    #[hot]
    fn run<R: Register>(self, zero: R) {
        for node in self.nodes {
            if let Some(ball) = &mut node.ball {
                ball.set_velocities(zero);
            }
        }
    }
}
