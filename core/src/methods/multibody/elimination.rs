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
//! Terms that couple two bodies `c` and `n` within a step add a block `L_cn` to the equations of the one and `M_nc` to
//! those of the other. If `c` is eliminated first, and `b` is its parent,
//!
//! ```text
//! Z_n = A_c⁻¹ L_cn      P_n = S⁻¹ (δ_nb C_jb − C_jc Z_n)      p_j = s + Σ_n P_n y_n      y_c = −w − Σ_n Z_n y_n − X p_j
//! A_mn ← A_mn + δ_mb E_jbᵀ P_n − M_mc (Z_n + X P_n)          r_m ← r_m + δ_mb E_jbᵀ s − M_mc (w + X s)
//! ```
//!
//! for all neighbours `m` and `n` of `c`. Between neighbours in a tree only their own blocks are filled.
//!
//! A body on a joint that holds a point, and that no term couples with a later body but its parent, has a `Ball`: blocks of three do
//! all this.
//!
//! Matrices have room for six functions; the loops over those that a joint has are compiled for each number of them.

use alloc::vec::Vec;

use nalgebra::{Matrix6, SMatrix, Vector2, Vector6};

use super::ball::add_blocks;
use super::ends::Ends;
use super::graph::Tree;
use super::nodes::{Block, Loop, Node, Pair, Unknowns, add};
use super::square::{shift_of, turn_of, write};
use super::turning::inverted;
use crate::numbers::{Coordinates as _, OnRegisters, Pattern, Register, on_registers};

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
pub(super) fn factorise(tree: &Tree, nodes: &mut [Node], loops: &mut [Loop], pairs: &mut Vec<Pair>) {
    for closing in &mut *loops {
        closing.free = free(closing, nodes);
    }
    on_registers(Factorisation { tree, nodes });
    if !loops.is_empty() {
        close(tree, nodes, loops, pairs);
    }
}

/// The elimination of all bodies from the ends of the trees.
struct Factorisation<'a> {
    tree: &'a Tree,
    nodes: &'a mut [Node],
}

#[hot]
impl OnRegisters for Factorisation<'_> {
    type Output = ();

    fn run<R: Register>(self, zero: R) {
        let Self { tree, nodes } = self;
        for &k in tree.order.iter().rev() {
            let node = &mut nodes[k];
            let Some(ball) = &mut node.ball else {
                eliminate(nodes, k);
                continue;
            };
            let mut coupled = None;
            if let Some(block) = node.blocks.first()
                && block.neighbour.is_coupled
            {
                coupled = Some([&block.own, &block.other]);
            }
            node.determinant = ball.factorise(zero, coupled);
            if let Some(turning) = &ball.turning {
                (node.pivot, node.of_joint) = (turning.pivot, turning.determinant);
            }
            if let Some(parent) = tree.members[k].parent
                && let Ok([node, parent]) = nodes.get_disjoint_mut([k, parent])
                && let Some(ball) = &node.ball
            {
                let (added, coupled) = (ball.of_parent(zero), ball.of_coupled_parent(zero));
                match &mut parent.ball {
                    Some(ball) => ball.add(zero, added),
                    None => add_blocks(&mut parent.matrix, added),
                }
                match (&mut parent.ball, coupled) {
                    (_, None) => {}
                    (Some(ball), Some(coupled)) => ball.add_from_origin(zero, coupled),
                    (None, Some(coupled)) => add_blocks(&mut parent.matrix, coupled),
                }
            }
        }
    }
}

/// Eliminates a body, and then its joint, of any functions and with any neighbours.
fn eliminate(nodes: &mut [Node], k: usize) {
    let node = &mut nodes[k];
    (node.matrix, node.determinant) = Vector6::factorise_apart(&node.matrix, Pattern::WHOLE);
    for block in node.blocks.iter_mut().filter(|block| block.neighbour.is_coupled) {
        block.z = solved(&node.matrix, &block.own);
    }
    if node.rows > 0 {
        by_rows!(node.rows, eliminate_joint(node));
    }
    // Additions to other nodes; the blocks of this one are complete.
    let blocks = core::mem::take(&mut node.blocks);
    for (m, row) in blocks.iter().enumerate() {
        for column in &blocks {
            let (node, is_parent) = (&nodes[k], m == 0);
            let added = match node.rows {
                0 => -(row.other * column.z),
                rows => by_rows!(rows, complement(node, is_parent, row, column)),
            };
            add(nodes, [row.neighbour.body, column.neighbour.body], &added);
        }
    }
    nodes[k].blocks = blocks;
}

/// The solutions for all columns of the right-hand side.
fn solved<const K: usize>(factors: &Matrix6<f64>, right: &SMatrix<f64, 6, K>) -> SMatrix<f64, 6, K> {
    let mut all = *right;
    for mut column in all.column_iter_mut() {
        let solution = Vector6::solve_apart(factors, Pattern::WHOLE, &column.clone_owned());
        column.copy_from(&solution);
    }
    all
}

/// Eliminates a body's joint.
fn eliminate_joint<const K: usize>(node: &mut Node) {
    let [own, of_parent] = &*node.ends;
    let x = solved(&node.matrix, &own.before.fixed_columns::<K>(0).into_owned());
    let after = own.after.fixed_columns::<K>(0);
    let s: SMatrix<f64, K, K> = after.tr_mul(&x);
    let (inverse, pivot, of_joint) = inverted(&s, &s.diagonal(), K);
    node.x.fixed_columns_mut::<K>(0).copy_from(&x);
    node.inverse.fixed_view_mut::<K, K>(0, 0).copy_from(&inverse);
    (node.pivot, node.of_joint) = (pivot, of_joint);
    for (k, block) in node.blocks.iter_mut().enumerate() {
        let is_parent = k == 0 && node.has_parent;
        let mut right = if is_parent { of_parent.after.fixed_columns::<K>(0).transpose() } else { SMatrix::zeros() };
        if block.neighbour.is_coupled {
            right -= after.tr_mul(&block.z);
        }
        block.p.fixed_rows_mut::<K>(0).copy_from(&(inverse * right));
    }
}

/// The part that elimination adds to the equations of one neighbour in the columns of another.
fn complement<const K: usize>(node: &Node, is_parent: bool, row: &Block, column: &Block) -> Matrix6<f64> {
    let p = column.p.fixed_rows::<K>(0);
    let joint = (is_parent && node.has_parent).then(|| node.ends[1].before.fixed_columns::<K>(0) * p);
    if !row.neighbour.is_coupled {
        return joint.unwrap_or_else(Matrix6::zeros);
    }
    let mut change = node.x.fixed_columns::<K>(0) * p;
    if column.neighbour.is_coupled {
        change += column.z;
    }
    let coupled = row.other * change;
    joint.map_or(-coupled, |joint| joint - coupled)
}

/// The diagonal of `S_L` of a joint between bodies that were free.
fn free(closing: &Loop, nodes: &[Node]) -> Vector6<f64> {
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
fn close(tree: &Tree, nodes: &[Node], loops: &mut [Loop], pairs: &mut Vec<Pair>) {
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
            substitute(tree, nodes, &mut closing.columns[all.clone()], &mut closing.multipliers[all], pairs);
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
        closing.block = closing.row[k];
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
pub(super) fn solve(tree: &Tree, nodes: &[Node], loops: &[Loop], unknowns: &mut Unknowns) -> Vector2<f64> {
    let Unknowns { bodies, joints, loops: of_loops, pairs } = unknowns;
    let size = substitute(tree, nodes, bodies, joints, pairs);
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
    pairs: &mut Vec<Pair>,
) -> Vector2<f64> {
    pairs.clear();
    pairs.resize(nodes.len(), [[0.0; 4]; 2]);
    on_registers(Substitution { tree, nodes, of_bodies, of_joints, pairs })
}

/// The substitution of right-hand sides in the factors of the trees.
struct Substitution<'a> {
    tree: &'a Tree,
    nodes: &'a [Node],
    of_bodies: &'a mut [Vector6<f64>],
    of_joints: &'a mut [Vector6<f64>],
    /// The sums that bodies on ball joints add to their parents, then `w` and `q`, then the turn and the point's shift, or the
    /// shift of a body without a ball joint.
    pairs: &'a mut [Pair],
}

#[hot]
fn pair<R: Register>(zero: R, of: &Pair) -> [R; 2] {
    [zero.of(of[0]), zero.of(of[1])]
}

#[hot]
fn stored_pair<R: Register>([turn, shift]: [R; 2]) -> Pair {
    [turn.entries(), shift.entries()]
}

#[hot]
fn sum<R: Register>(a: [R; 2], b: [R; 2]) -> [R; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

impl OnRegisters for Substitution<'_> {
    type Output = Vector2<f64>;

    #[hot]
    fn run<R: Register>(self, zero: R) -> Vector2<f64> {
        let Self { tree, nodes, of_bodies, of_joints, pairs } = self;
        let mut size = Vector2::zeros();
        for &k in tree.order.iter().rev() {
            let (own, hanging) = ([turn_of(zero, &of_bodies[k]), shift_of(zero, &of_bodies[k])], pair(zero, &pairs[k]));
            let Some(ball) = &nodes[k].ball else {
                write(&mut of_bodies[k], sum(own, hanging));
                size += reduce(&nodes[k], k, of_bodies, of_joints);
                continue;
            };
            let (own, added, opposed) = ball.inwards(zero, own, hanging, &mut of_joints[k]);
            pairs[k] = stored_pair(own);
            size += opposed;
            if let Some(parent) = tree.members[k].parent {
                pairs[parent] = stored_pair(sum(pair(zero, &pairs[parent]), added));
                if let Some(coupled) = ball.coupled(zero, own[0], &of_joints[k]) {
                    let to = &mut of_bodies[parent];
                    let added = sum([turn_of(zero, to), shift_of(zero, to)], coupled);
                    write(to, added);
                }
            }
        }
        for &k in &tree.order {
            let Some(ball) = &nodes[k].ball else {
                complete(&nodes[k], k, of_bodies, of_joints);
                pairs[k] = stored_pair([turn_of(zero, &of_bodies[k]), shift_of(zero, &of_bodies[k])]);
                continue;
            };
            let mut parent = None;
            if let Some(of) = tree.members[k].parent {
                parent = Some(pair(zero, &pairs[of]));
            }
            let unknowns = ball.outwards(zero, pair(zero, &pairs[k]), parent, &mut of_joints[k]);
            pairs[k] = stored_pair(unknowns);
            write(&mut of_bodies[k], [unknowns[0], ball.shift(zero, unknowns)]);
        }
        size
    }
}

/// Replaces the right-hand sides of a body and its joint by `w` and `s`; returns the squares of the turn and the shift of `w`.
fn reduce(node: &Node, k: usize, of_bodies: &mut [Vector6<f64>], of_joints: &mut [Vector6<f64>]) -> Vector2<f64> {
    let w = Vector6::solve_apart(&node.matrix, Pattern::WHOLE, &of_bodies[k]);
    of_bodies[k] = w;
    if node.rows > 0 {
        by_rows!(node.rows, outwards(node, &w, &mut of_joints[k], of_bodies));
    } else {
        add_changes(node, &w, of_bodies);
    }
    Vector2::new(w.fixed_rows::<3>(0).norm_squared(), w.fixed_rows::<3>(3).norm_squared())
}

/// Replaces `w` and `s` by the unknowns of a body and of its joint, by those of its neighbours.
fn complete(node: &Node, k: usize, of_bodies: &mut [Vector6<f64>], of_joints: &mut [Vector6<f64>]) {
    let mut unknowns = -of_bodies[k];
    for block in node.blocks.iter().filter(|block| block.neighbour.is_coupled) {
        unknowns -= block.z * of_bodies[block.neighbour.body];
    }
    if node.rows > 0 {
        by_rows!(node.rows, inwards(node, of_bodies, &mut of_joints[k], &mut unknowns));
    }
    of_bodies[k] = unknowns;
}

/// Adds the part of a body with `y = −change` to the right-hand sides of its neighbours.
fn add_changes(node: &Node, change: &Vector6<f64>, of_bodies: &mut [Vector6<f64>]) {
    for block in node.blocks.iter().filter(|block| block.neighbour.is_coupled) {
        of_bodies[block.neighbour.body] -= block.other * change;
    }
}

/// Sets the multipliers `s`, and adds to the right-hand sides of the neighbours.
fn outwards<const K: usize>(
    node: &Node,
    w: &Vector6<f64>,
    of_joint: &mut Vector6<f64>,
    of_bodies: &mut [Vector6<f64>],
) {
    let [own, of_parent] = &*node.ends;
    let right = of_joint.fixed_rows::<K>(0) - own.after.fixed_columns::<K>(0).tr_mul(w);
    let s = node.inverse.fixed_view::<K, K>(0, 0) * right;
    of_joint.fixed_rows_mut::<K>(0).copy_from(&s);
    let Some(first) = node.blocks.first() else { return };
    if node.has_parent {
        of_bodies[first.neighbour.body] += of_parent.before.fixed_columns::<K>(0) * s;
    }
    if node.blocks.iter().any(|block| block.neighbour.is_coupled) {
        add_changes(node, &(w + node.x.fixed_columns::<K>(0) * s), of_bodies);
    }
}

/// Adds the neighbours' part to the multipliers, and the joint's to the body's unknowns.
fn inwards<const K: usize>(
    node: &Node,
    of_bodies: &[Vector6<f64>],
    of_joint: &mut Vector6<f64>,
    unknowns: &mut Vector6<f64>,
) {
    let mut p = of_joint.fixed_rows::<K>(0).into_owned();
    for block in &node.blocks {
        p += block.p.fixed_rows::<K>(0) * of_bodies[block.neighbour.body];
    }
    of_joint.fixed_rows_mut::<K>(0).copy_from(&p);
    *unknowns -= node.x.fixed_columns::<K>(0) * p;
}
