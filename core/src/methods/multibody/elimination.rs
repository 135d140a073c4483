//! The linear equations of bodies and multipliers, solved from the ends of the trees to their roots.
//!
//! Each body `b` has six unknowns `y_b`, each joint `j` as many multipliers `p_j` as functions:
//!
//! ```text
//! A_b y_b + Σ_j E_jbᵀ p_j = −r_b           Σ_b C_jb y_b = −g_j
//! ```
//!
//! The sums extend over the joints of a body, and over the two bodies of a joint. A body at an end of a tree, child `c`
//! of `b` by the joint `j`, is eliminated, and then its joint; the Schur complement is added to the matrix of its
//! parent:
//!
//! ```text
//! X = A_c⁻¹ E_jcᵀ      S = C_jc X      P = S⁻¹ C_jb      A_b ← A_b + E_jbᵀ P
//! w = A_c⁻¹ r_c        s = S⁻¹ (g_j − C_jc w)            r_b ← r_b + E_jbᵀ s
//! p_j = s + P y_b      y_c = −w − X p_j
//! ```
//!
//! So nothing fills in, and the time is proportional to the number of bodies. At rest `A` is the inertia and `C = E`:
//! then the matrix of the parent is its own with the articulated inertia of all that hangs on it. Joints that close
//! loops are a border: with the solution `Y` for their columns `Eᵀ`, `S_L = −C_L Y` are the equations of their
//! multipliers.
//!
//! Matrices have room for six functions; the loops over those that a joint has are compiled for each number of them.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Matrix6, SMatrix, Vector2, Vector6};

use super::graph::{Member, Tree};
use crate::numbers::{Coordinates as _, Pattern};

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

    /// The square of the longest lever arm of the functions, m²; zero if they compare only directions.
    pub(super) fn squared_arm(&self) -> f64 {
        (0..6).fold(0.0, |longest: f64, row| {
            let [turns, shifts] = self.rates(row);
            if shifts > 0.0 { longest.max(turns / shifts) } else { longest }
        })
    }

    /// The size of each function's terms for a `turn` in rad or rad/s and a `shift` in m or m/s; the shift counts at
    /// least as the lever arm times the turn.
    pub(super) fn sizes(&self, turn: f64, shift: f64) -> Vector6<f64> {
        let shift = shift.max(self.squared_arm().sqrt() * turn);
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

/// The equations of a body, and their factors after elimination.
#[derive(Clone, Copy)]
pub(super) struct Node {
    /// The matrix `A_b`; after elimination, its factors.
    pub(super) matrix: Matrix6<f64>,
    /// The determinant relative to the product of the diagonal, once all descendants are eliminated.
    pub(super) determinant: f64,
    /// The maps `E` and `C` of the joint towards the root, for this body and for its parent.
    pub(super) ends: [Ends; 2],
    /// The number of functions of that joint.
    pub(super) rows: usize,
    has_parent: bool,
    /// The least pivot of that joint, relative to the diagonal; one if there is no joint.
    pub(super) pivot: f64,
    /// The determinant of that joint's matrix `S`, relative to the absolute values of its diagonal; one if there is no
    /// joint.
    pub(super) of_joint: f64,
    x: Matrix6<f64>,
    inverse: Matrix6<f64>,
    p: Matrix6<f64>,
}

impl Node {
    pub(super) fn new(rows: usize, has_parent: bool) -> Self {
        let zero = Matrix6::zeros();
        let (ends, x, inverse, p) = ([Ends::ZERO; 2], zero, zero, zero);
        Self { matrix: zero, determinant: 1.0, ends, rows, has_parent, pivot: 1.0, of_joint: 1.0, x, inverse, p }
    }

    /// Whether these are the equations of a body with such a joint: what isn't overwritten is the same.
    pub(super) fn is_like(&self, rows: usize, parent: Option<usize>) -> bool {
        self.rows == rows && self.has_parent == parent.is_some()
    }
}

/// The equations of a joint that closes a loop, and their factors after elimination.
#[derive(Clone)]
pub(super) struct Closing {
    /// The bodies below and above; `None` is space.
    pub(super) bodies: [Option<usize>; 2],
    pub(super) ends: [Ends; 2],
    /// The number of functions of the joint.
    rows: usize,
    /// The bodies' part `Y` of the solution for the joint's columns, one column after the other, and its multipliers at
    /// the trees' joints.
    columns: Vec<Vector6<f64>>,
    multipliers: Vec<Vector6<f64>>,
    /// A row of the factors of `S_L`, with the inverse pivots on the diagonal.
    row: Vec<Matrix6<f64>>,
    /// The diagonal of `S_L` if both bodies were free.
    free: Vector6<f64>,
    /// The least pivot, relative to `free`.
    pub(super) pivot: f64,
    /// The determinant of the pivot block, relative to the absolute values of `free`.
    pub(super) of_joint: f64,
}

impl Closing {
    /// A joint with this number of functions among `all` bodies and loops.
    pub(super) fn new(bodies: [Option<usize>; 2], rows: usize, all: [usize; 2]) -> Self {
        let zeros = vec![Vector6::zeros(); rows * all[0]];
        Self {
            bodies,
            ends: [Ends::ZERO; 2],
            rows,
            columns: zeros.clone(),
            multipliers: zeros,
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

/// Calls a function that is compiled for each number of functions of a joint.
macro_rules! by_rows {
    ($rows:expr, $function:ident($($argument:expr),*)) => {
        match $rows {
            1 => $function::<1>($($argument),*),
            2 => $function::<2>($($argument),*),
            3 => $function::<3>($($argument),*),
            4 => $function::<4>($($argument),*),
            5 => $function::<5>($($argument),*),
            _ => $function::<6>($($argument),*),
        }
    };
}

/// Factorises all matrices.
pub(super) fn factorise(tree: &Tree, nodes: &mut [Node], loops: &mut [Closing]) {
    for closing in &mut *loops {
        closing.free = free(closing, nodes);
    }
    for &k in tree.order.iter().rev() {
        let Member { joint, parent, .. } = tree.members[k];
        let node = &mut nodes[k];
        (node.matrix, node.determinant) = Vector6::factorise_apart(&node.matrix, Pattern::WHOLE);
        if joint.is_none() {
            continue;
        }
        let added = by_rows!(node.rows, eliminated(node, parent.is_some()));
        if let Some(parent) = parent {
            nodes[parent].matrix += added;
        }
    }
    if !loops.is_empty() {
        close(tree, nodes, loops);
    }
}

/// Eliminates a body's joint; returns the part of the parent's matrix, if there is a parent.
fn eliminated<const K: usize>(node: &mut Node, has_parent: bool) -> Matrix6<f64> {
    let [own, of_parent] = &node.ends;
    let mut x = own.before.fixed_columns::<K>(0).into_owned();
    for mut column in x.column_iter_mut() {
        let solution = Vector6::solve_apart(&node.matrix, Pattern::WHOLE, &column.clone_owned());
        column.copy_from(&solution);
    }
    let s: SMatrix<f64, K, K> = own.after.fixed_columns::<K>(0).tr_mul(&x);
    let (inverse, pivot, of_joint) = inverted(&s, &s.diagonal(), K);
    node.x.fixed_columns_mut::<K>(0).copy_from(&x);
    node.inverse.fixed_view_mut::<K, K>(0, 0).copy_from(&inverse);
    (node.pivot, node.of_joint) = (pivot, of_joint);
    if !has_parent {
        return Matrix6::zeros();
    }
    let p = inverse * of_parent.after.fixed_columns::<K>(0).transpose();
    node.p.fixed_rows_mut::<K>(0).copy_from(&p);
    of_parent.before.fixed_columns::<K>(0) * p
}

/// The diagonal of `S_L` of a joint between bodies that were free.
fn free(closing: &Closing, nodes: &[Node]) -> Vector6<f64> {
    closing.ends().fold(Vector6::zeros(), |free, (body, Ends { before, after })| {
        let factors = Vector6::factorise_apart(&nodes[body].matrix, Pattern::WHOLE).0;
        let entry = |row: usize| {
            let solved = Vector6::solve_apart(&factors, Pattern::WHOLE, &before.column(row).clone_owned());
            after.column(row).dot(&solved)
        };
        free + Vector6::from_fn(|row, _| if row < closing.rows { entry(row) } else { 0.0 })
    })
}

/// The border's columns `Y`, and the factors of `S_L`.
fn close(tree: &Tree, nodes: &[Node], loops: &mut [Closing]) {
    let bodies = nodes.len();
    for closing in &mut *loops {
        closing.columns.fill(Vector6::zeros());
        closing.multipliers.fill(Vector6::zeros());
        for row in 0..closing.rows {
            for side in 0..2 {
                let Some(body) = closing.bodies[side] else { continue };
                closing.columns[row * bodies + body] += closing.ends[side].before.column(row);
            }
            let all = row * bodies..(row + 1) * bodies;
            substitute(tree, nodes, &mut closing.columns[all.clone()], &mut closing.multipliers[all]);
        }
    }
    for i in 0..loops.len() {
        for j in 0..loops.len() {
            let (other, this) = (&loops[j], &loops[i]);
            let mut entry = Matrix6::zeros();
            for (body, ends) in this.ends() {
                for column in 0..other.rows {
                    let solved = &other.columns[column * bodies + body];
                    for row in 0..this.rows {
                        entry[(row, column)] -= ends.after.column(row).dot(solved);
                    }
                }
            }
            loops[i].row[j] = entry;
        }
    }
    for k in 0..loops.len() {
        let (done, rest) = loops.split_at_mut(k + 1);
        let closing = &mut done[k];
        (closing.row[k], closing.pivot, closing.of_joint) = inverted(&closing.row[k], &closing.free, closing.rows);
        let pivot_row = &closing.row;
        for closing in rest {
            let factor = closing.row[k] * pivot_row[k];
            closing.row[k] = factor;
            for (entry, above) in closing.row.iter_mut().zip(pivot_row).skip(k + 1) {
                *entry -= factor * above;
            }
        }
    }
}

/// Solves for these right-hand sides by the factors. Returns the summed squares of the `w`, of turns and of shifts: in
/// a stiffly constrained system the solution is a small difference of large `w`, which sets its rounding error.
pub(super) fn solve(tree: &Tree, nodes: &[Node], loops: &[Closing], unknowns: &mut Unknowns) -> Vector2<f64> {
    let Unknowns { bodies, joints, loops: of_loops } = unknowns;
    let size = substitute(tree, nodes, bodies, joints);
    for (k, closing) in loops.iter().enumerate() {
        // The right-hand sides `C_L x + g`, reduced by the rows above.
        let mut right = of_loops[k];
        for (body, ends) in closing.ends() {
            right += ends.after.tr_mul(&bodies[body]);
        }
        for (factor, above) in closing.row.iter().zip(&*of_loops).take(k) {
            right -= factor * above;
        }
        of_loops[k] = right;
    }
    for (k, closing) in loops.iter().enumerate().rev() {
        let mut right = of_loops[k];
        for (entry, below) in closing.row.iter().zip(&*of_loops).skip(k + 1) {
            right -= entry * below;
        }
        of_loops[k] = closing.row[k] * right;
    }
    for (closing, multiplier) in loops.iter().zip(&*of_loops) {
        let all = nodes.len();
        let part = |columns: &[Vector6<f64>], k: usize| {
            (1..closing.rows)
                .fold(columns[k] * multiplier[0], |sum, row| sum + columns[row * all + k] * multiplier[row])
        };
        for k in 0..all {
            bodies[k] += part(&closing.columns, k);
            joints[k] += part(&closing.multipliers, k);
        }
    }
    size
}

/// Solves the trees alone, without loops.
fn substitute(
    tree: &Tree,
    nodes: &[Node],
    of_bodies: &mut [Vector6<f64>],
    of_joints: &mut [Vector6<f64>],
) -> Vector2<f64> {
    let mut size = Vector2::zeros();
    for &k in tree.order.iter().rev() {
        let (node, member) = (&nodes[k], tree.members[k]);
        let w = Vector6::solve_apart(&node.matrix, Pattern::WHOLE, &of_bodies[k]);
        of_bodies[k] = w;
        size += Vector2::new(w.fixed_rows::<3>(0).norm_squared(), w.fixed_rows::<3>(3).norm_squared());
        if member.joint.is_none() {
            continue;
        }
        let added = by_rows!(node.rows, outwards(node, &w, &mut of_joints[k]));
        if let Some(parent) = member.parent {
            of_bodies[parent] += added;
        }
    }
    for &k in &tree.order {
        let (node, member) = (&nodes[k], tree.members[k]);
        of_bodies[k] = -of_bodies[k];
        if member.joint.is_none() {
            continue;
        }
        let parent = member.parent.map(|parent| of_bodies[parent]);
        by_rows!(node.rows, inwards(node, parent.as_ref(), &mut of_joints[k], &mut of_bodies[k]));
    }
    size
}

/// The multipliers `s`; returns the part `Eᵀ s` of the parent's right-hand side.
fn outwards<const K: usize>(node: &Node, w: &Vector6<f64>, of_joint: &mut Vector6<f64>) -> Vector6<f64> {
    let [own, of_parent] = &node.ends;
    let right = of_joint.fixed_rows::<K>(0) - own.after.fixed_columns::<K>(0).tr_mul(w);
    let s = node.inverse.fixed_view::<K, K>(0, 0) * right;
    of_joint.fixed_rows_mut::<K>(0).copy_from(&s);
    of_parent.before.fixed_columns::<K>(0) * s
}

/// The multipliers `p`, and the body's unknowns.
fn inwards<const K: usize>(
    node: &Node,
    of_parent: Option<&Vector6<f64>>,
    of_joint: &mut Vector6<f64>,
    of_body: &mut Vector6<f64>,
) {
    let mut p = of_joint.fixed_rows::<K>(0).into_owned();
    if let Some(parent) = of_parent {
        p += node.p.fixed_rows::<K>(0) * parent;
        of_joint.fixed_rows_mut::<K>(0).copy_from(&p);
    }
    *of_body -= node.x.fixed_columns::<K>(0) * p;
}

/// The inverse by elimination in the order of the rows, the least pivot relative to `sizes`, and the determinant
/// relative to their absolute values; a size of zero makes both zero. Rows after the first `rows` hold no functions.
#[hot]
fn inverted<const K: usize>(
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
