//! The equations of bodies and of joints, before and after elimination.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Matrix6, Vector6};

roots!();

use super::graph::{Neighbour, Tree};

/// The two derivative maps at one end of a joint, a column for each of its functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ends {
    /// The matrix `Eᵀ` from multipliers to the body's momentum, torque in its axes first.
    pub(super) before: Matrix6<f64>,
    /// The matrix `Cᵀ`, the transpose of the map from the body's unknowns to the functions.
    pub(super) after: Matrix6<f64>,
}

impl Ends {
    pub(super) const ZERO: Self = Self {
        before: Matrix6::from_array_storage(nalgebra::ArrayStorage([[0.0; 6]; 6])),
        after: Matrix6::from_array_storage(nalgebra::ArrayStorage([[0.0; 6]; 6])),
    };

    /// The squared rates of a function per unit of the body's turn, and of its shift.
    fn rates(&self, row: usize) -> [f64; 2] {
        [0, 3].map(|first| self.before.fixed_view::<3, 1>(first, row).norm_squared())
    }

    /// The square of the longest lever arm of the first `rows` functions, m²; zero if they compare only directions.
    pub(super) fn squared_arm(&self, rows: usize) -> f64 {
        (0..rows).fold(0.0, |longest: f64, row| {
            let [turns, shifts] = self.rates(row);
            if shifts > 0.0 { longest.max(turns / shifts) } else { longest }
        })
    }

    /// The size of each function's terms for a `turn` in rad or rad/s and a `shift` in m or m/s; the shift counts at
    /// least as the lever arm times the turn.
    pub(super) fn sizes(&self, turn: f64, shift: f64) -> Vector6<f64> {
        let shift = shift.max(self.squared_arm(6).sqrt() * turn);
        Vector6::from_fn(|row, _| {
            let [turns, shifts] = self.rates(row).map(f64::sqrt);
            turns * turn + shifts * shift
        })
    }

    /// The momentum `Eᵀ p` of these multipliers.
    pub(super) fn momentum(&self, multipliers: &Vector6<f64>) -> Vector6<f64> {
        self.before * multipliers
    }
}

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
    pub(super) ends: [Ends; 2],
    /// The number of functions of that joint.
    pub(super) rows: usize,
    /// Whether that joint is at another body, the first of the blocks.
    pub(super) has_parent: bool,
    pub(super) blocks: Vec<Block>,
    /// The least pivot of that joint, relative to the diagonal; one if there is no joint.
    pub(super) pivot: f64,
    /// The determinant of that joint's matrix `S`, relative to the absolute values of its diagonal; one if there is no
    /// joint.
    pub(super) of_joint: f64,
    pub(super) x: Matrix6<f64>,
    pub(super) inverse: Matrix6<f64>,
}

impl Node {
    pub(super) fn new(rows: usize, has_parent: bool, neighbours: &[Neighbour]) -> Self {
        let zero = Matrix6::zeros();
        let (ends, x, inverse, matrix) = ([Ends::ZERO; 2], zero, zero, zero);
        let blocks = neighbours.iter().map(|&neighbour| Block::of(neighbour)).collect();
        Self { matrix, determinant: 1.0, ends, rows, has_parent, blocks, pivot: 1.0, of_joint: 1.0, x, inverse }
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
}

/// Adds a block to the equations of a body, in the columns of a body.
pub(super) fn add(nodes: &mut [Node], [row, column]: [usize; 2], matrix: &Matrix6<f64>) {
    if row == column {
        nodes[row].matrix += matrix;
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
