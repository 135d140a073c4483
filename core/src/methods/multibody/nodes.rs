//! The equations of bodies and of joints, before and after elimination.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Matrix6, Vector6};

use super::ball::Ball;
use super::ends::Ends;
use super::graph::{Neighbour, Tree};

/// The blocks of a body and one that is eliminated after it.
#[derive(Clone, Copy)]
pub(super) struct Block {
    pub(super) neighbour: Neighbour,
    /// The block `L` in the equations of the body.
    pub(super) own: Matrix6<f64>,
    /// The block `M` in the equations of the neighbour.
    pub(super) other: Matrix6<f64>,
    /// The product `A⁻¹ L`.
    pub(super) z: Matrix6<f64>,
    pub(super) p: Matrix6<f64>,
}

impl Block {
    fn of(neighbour: Neighbour) -> Self {
        let zero = Matrix6::zeros();
        Self { neighbour, own: zero, other: zero, z: zero, p: zero }
    }
}

/// The equations of a body, and their factors after elimination.
#[derive(Clone)]
pub(super) struct Node {
    /// The matrix `A_b`; after elimination, its factors.
    pub(super) matrix: Matrix6<f64>,
    /// The determinant relative to the product of the diagonal, once all descendants are eliminated.
    pub(super) determinant: f64,
    /// The maps `E` and `C` of the joint towards the root, for this body and for its parent.
    pub(super) ends: Box<[Ends; 2]>,
    /// The number of functions of that joint.
    pub(super) rows: usize,
    /// Whether that joint is at another body, the first of the blocks.
    pub(super) has_parent: bool,
    pub(super) blocks: Vec<Block>,
    /// That joint if it holds a point, and no term couples the body with a later one but the parent; its maps aren't in `ends`.
    pub(super) ball: Option<Ball>,
    /// The least pivot of that joint, relative to the diagonal; one if there is no joint.
    pub(super) pivot: f64,
    /// The determinant of that joint's matrix `S`, relative to the absolute values of its diagonal; one if there is no
    /// joint.
    pub(super) of_joint: f64,
    pub(super) x: Box<Matrix6<f64>>,
    pub(super) inverse: Box<Matrix6<f64>>,
}

impl Node {
    pub(super) fn new(rows: usize, has_parent: bool, neighbours: &[Neighbour]) -> Self {
        let zero = Matrix6::zeros();
        let (ends, x, inverse, matrix) = (Box::new([Ends::ZERO; 2]), Box::new(zero), Box::new(zero), zero);
        let blocks = neighbours.iter().map(|&neighbour| Block::of(neighbour)).collect();
        let ball = None;
        Self { matrix, determinant: 1.0, ends, rows, has_parent, blocks, ball, pivot: 1.0, of_joint: 1.0, x, inverse }
    }

    /// Whether these are the equations of a body with such a joint and such neighbours: what isn't overwritten is the
    /// same.
    pub(super) fn is_like(&self, rows: usize, has_parent: bool, neighbours: &[Neighbour]) -> bool {
        self.rows == rows
            && self.has_parent == has_parent
            && self.blocks.len() == neighbours.len()
            && self.blocks.iter().zip(neighbours).all(|(block, neighbour)| block.neighbour == *neighbour)
    }
}

/// The equations of a joint that closes a loop, and their factors after elimination.
#[derive(Clone)]
pub(super) struct Loop {
    /// The bodies below and above; `None` is space.
    pub(super) bodies: [Option<usize>; 2],
    pub(super) ends: [Ends; 2],
    /// The number of functions of the joint.
    pub(super) rows: usize,
    /// The bodies' part `Y` of the solution for the joint's columns, one column after the other, and its multipliers at
    /// the trees' joints.
    pub(super) columns: Vec<Vector6<f64>>,
    pub(super) multipliers: Vec<Vector6<f64>>,
    /// The pivot block of `S_L` before its inversion: its Schur complement by the loops before.
    pub(super) block: Matrix6<f64>,
    /// A row of the factors of `S_L`, with the inverse pivots on the diagonal.
    pub(super) row: Vec<Matrix6<f64>>,
    /// The diagonal of `S_L` if both bodies were free.
    pub(super) free: Vector6<f64>,
    /// The least pivot, relative to `free`.
    pub(super) pivot: f64,
    /// The determinant of the pivot block, relative to the absolute values of `free`.
    pub(super) of_joint: f64,
}

impl Loop {
    /// A joint with this number of functions among `all` bodies and loops.
    pub(super) fn new(bodies: [Option<usize>; 2], rows: usize, all: [usize; 2]) -> Self {
        let zeros = vec![Vector6::zeros(); rows * all[0]];
        Self {
            bodies,
            ends: [Ends::ZERO; 2],
            rows,
            columns: zeros.clone(),
            multipliers: zeros,
            block: Matrix6::zeros(),
            row: vec![Matrix6::zeros(); all[1]],
            free: Vector6::zeros(),
            pivot: 1.0,
            of_joint: 1.0,
        }
    }

    /// Whether these are the equations of such a joint.
    pub(super) fn is_like(&self, bodies: [Option<usize>; 2], rows: usize, all: [usize; 2]) -> bool {
        self.bodies == bodies && self.rows == rows && self.columns.len() == rows * all[0] && self.row.len() == all[1]
    }

    /// The ends of the joint that are at bodies, not at space.
    pub(super) fn ends(&self) -> impl Iterator<Item = (usize, &Ends)> {
        let both = self.bodies.into_iter().zip(&self.ends);
        both.filter_map(|(body, ends)| Some((body?, ends)))
    }
}

/// The right-hand sides `r` and `g`, which the solution overwrites by `y` and `p`.
#[derive(Clone, Default)]
pub(super) struct Unknowns {
    pub(super) bodies: Vec<Vector6<f64>>,
    /// The multipliers of each body's joint towards the root.
    pub(super) joints: Vec<Vector6<f64>>,
    pub(super) loops: Vec<Vector6<f64>>,
    /// The turns and shifts of bodies on ball joints during the solution.
    pub(super) pairs: Vec<Pair>,
}

/// A turn and a shift as registers load them.
pub(super) type Pair = [[f64; 4]; 2];

/// Adds a block to the equations of a body, in the columns of a body.
pub(super) fn add(nodes: &mut [Node], [row, column]: [usize; 2], matrix: &Matrix6<f64>) {
    if row == column {
        match &mut nodes[row].ball {
            Some(ball) => ball.add_matrix(matrix),
            None => nodes[row].matrix += matrix,
        }
    } else if let Some(block) = nodes[row].blocks.iter_mut().find(|block| block.neighbour.body == column) {
        block.own += matrix;
    } else if let Some(block) = nodes[column].blocks.iter_mut().find(|block| block.neighbour.body == row) {
        block.other += matrix;
    }
}

/// Sets the blocks between bodies to those of the coupled pairs of bodies.
pub(super) fn set_blocks(tree: &Tree, nodes: &mut [Node], couplings: &[[Matrix6<f64>; 2]]) {
    if couplings.is_empty() {
        return;
    }
    for block in nodes.iter_mut().flat_map(|node| &mut node.blocks) {
        (block.own, block.other) = (Matrix6::zeros(), Matrix6::zeros());
    }
    for (&[one, other], [upper, lower]) in tree.couplings.iter().zip(couplings) {
        add(nodes, [one, other], upper);
        add(nodes, [other, one], lower);
    }
}
