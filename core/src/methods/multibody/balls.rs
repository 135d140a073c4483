//! Slopes, matrices and reactions of all bodies on ball joints, in registers.

use nalgebra::{Matrix3, Matrix6, Vector6};

use super::constraint::Place;
use super::graph::Tree;
use super::nodes::Node;
use super::square::{shift_of, turn_of, write};
use crate::numbers::{OnRegisters, Register};

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

/// The momenta that the multipliers of ball joints take.
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
        for (k, node) in nodes.iter().enumerate() {
            let Some(ball) = &node.ball else { continue };
            let [own, of_parent] = ball.reactions(zero, &multipliers[k]);
            add_pair(zero, &mut reactions[k], own);
            if let Some(parent) = tree.members[k].parent {
                add_pair(zero, &mut reactions[parent], of_parent);
            }
        }
    }
}

/// Adds a turn and a shift.
#[hot]
fn add_pair<R: Register>(zero: R, to: &mut Vector6<f64>, [turn, shift]: [R; 2]) {
    let sum = [turn_of(zero, to) + turn, shift_of(zero, to) + shift];
    write(to, sum);
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
