//! The linear equations of bodies and multipliers, solved from the ends of the trees to their roots.
//!
//! Each body `b` has six unknowns `y_b`, each joint `j` has `K` multipliers `p_j`:
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

use nalgebra::{SMatrix, SVector, Vector2, Vector6};

use super::graph::Tree;
use super::places::{Ends, Slopes};
use crate::numbers::{Coordinates as _, Pattern};

type Matrix6 = SMatrix<f64, 6, 6>;

/// The equations of a body, and their factors after elimination.
#[derive(Clone, Copy)]
pub(super) struct Body<const K: usize> {
    /// The matrix `A_b`; after elimination, its factors.
    pub(super) matrix: Matrix6,
    /// The determinant relative to the product of the diagonal, once all descendants are eliminated.
    pub(super) determinant: f64,
    /// The maps `E` and `C` of the joint towards the root, for this body and for its parent.
    pub(super) slopes: Slopes<K>,
    /// The number of functions of that joint.
    pub(super) rows: usize,
    /// The least pivot of that joint, relative to the diagonal; one if there is no joint.
    pub(super) pivot: f64,
    /// The determinant of that joint's matrix `S`, relative to the absolute values of its diagonal; one if there is no
    /// joint.
    pub(super) of_joint: f64,
    x: SMatrix<f64, 6, K>,
    inverse: SMatrix<f64, K, K>,
    p: SMatrix<f64, K, 6>,
}

impl<const K: usize> Body<K> {
    #[hot]
    pub(super) fn new() -> Self {
        Self {
            matrix: SMatrix::zeros(),
            determinant: 1.0,
            slopes: Slopes::new(),
            rows: K,
            pivot: 1.0,
            of_joint: 1.0,
            x: SMatrix::zeros(),
            inverse: SMatrix::zeros(),
            p: SMatrix::zeros(),
        }
    }
}

/// The equations of a joint that closes a loop, and their factors after elimination.
#[derive(Clone, Copy)]
pub(super) struct Closing<const K: usize, const N: usize, const L: usize> {
    /// The bodies below and above; `None` is space.
    pub(super) bodies: [Option<usize>; 2],
    pub(super) slopes: Slopes<K>,
    /// The number of functions of the joint.
    rows: usize,
    /// The bodies' part `Y` of the solution for the joint's columns, and its multipliers at the trees' joints.
    columns: [SMatrix<f64, 6, K>; N],
    multipliers: [SMatrix<f64, K, K>; N],
    /// A row of the factors of `S_L`, with the inverse pivots on the diagonal.
    row: [SMatrix<f64, K, K>; L],
    /// The diagonal of `S_L` if both bodies were free.
    free: SVector<f64, K>,
    /// The least pivot, relative to `free`.
    pub(super) pivot: f64,
    /// The determinant of the pivot block, relative to the absolute values of `free`.
    pub(super) of_joint: f64,
}

impl<const K: usize, const N: usize, const L: usize> Closing<K, N, L> {
    pub(super) fn new(bodies: [Option<usize>; 2], rows: usize) -> Self {
        Self {
            bodies,
            slopes: Slopes::new(),
            rows,
            columns: [SMatrix::zeros(); N],
            multipliers: [SMatrix::zeros(); N],
            row: [SMatrix::zeros(); L],
            free: SVector::zeros(),
            pivot: 1.0,
            of_joint: 1.0,
        }
    }

    /// The ends of the joint that are at bodies, not at space.
    pub(super) fn ends(&self) -> impl Iterator<Item = (usize, &Ends<K>)> {
        let both = self.bodies.into_iter().zip(&self.slopes.0);
        both.filter_map(|(body, ends)| Some((body?, ends)))
    }
}

/// The right-hand sides `r` and `g`, which the solution overwrites by `y` and `p`.
#[derive(Clone, Copy)]
pub(super) struct Unknowns<const K: usize, const N: usize, const L: usize> {
    pub(super) bodies: [Vector6<f64>; N],
    /// The multipliers of each body's joint towards the root.
    pub(super) joints: [SVector<f64, K>; N],
    pub(super) loops: [SVector<f64, K>; L],
}

impl<const K: usize, const N: usize, const L: usize> Unknowns<K, N, L> {
    pub(super) fn new() -> Self {
        Self { bodies: [Vector6::zeros(); N], joints: [SVector::zeros(); N], loops: [SVector::zeros(); L] }
    }
}

/// Factorises all matrices.
pub(super) fn factorise<const K: usize, const N: usize, const L: usize>(
    tree: &Tree<N>,
    bodies: &mut [Body<K>; N],
    loops: &mut [Closing<K, N, L>; L],
) {
    for closing in loops.iter_mut().filter(|closing| closing.rows > 0) {
        closing.free = closing.ends().fold(SVector::zeros(), |free, (body, Ends { before, after })| {
            let factors = Vector6::factorise_apart(&bodies[body].matrix, Pattern::WHOLE).0;
            free + (after * solved(&factors, before)).diagonal()
        });
    }
    for &k in tree.order.iter().rev() {
        let member = tree.members[k];
        let body = &mut bodies[k];
        (body.matrix, body.determinant) = Vector6::factorise_apart(&body.matrix, Pattern::WHOLE);
        if member.joint.is_none() {
            continue;
        }
        let [own, of_parent] = &body.slopes.0;
        body.x = solved(&body.matrix, &own.before);
        let s = own.after * body.x;
        (body.inverse, body.pivot, body.of_joint) = inverted(&s, &s.diagonal(), body.rows);
        let Some(parent) = member.parent else { continue };
        body.p = body.inverse * of_parent.after;
        let added = of_parent.before * body.p;
        bodies[parent].matrix += added;
    }
    if L > 0 {
        close(tree, bodies, loops);
    }
}

/// The border's columns `Y`, and the factors of `S_L`.
fn close<const K: usize, const N: usize, const L: usize>(
    tree: &Tree<N>,
    bodies: &[Body<K>; N],
    loops: &mut [Closing<K, N, L>; L],
) {
    for closing in loops.iter_mut().filter(|closing| closing.rows > 0) {
        closing.multipliers = [SMatrix::zeros(); N];
        let mut columns = [SMatrix::zeros(); N];
        closing.ends().for_each(|(body, ends)| columns[body] += ends.before);
        closing.columns = columns;
        substitute(tree, bodies, &mut closing.columns, &mut closing.multipliers);
    }
    for i in 0..L {
        for j in 0..L {
            let columns = &loops[j].columns;
            let entry = loops[i].ends().fold(SMatrix::zeros(), |sum, (body, ends)| sum - ends.after * columns[body]);
            loops[i].row[j] = entry;
        }
    }
    for k in 0..L {
        let closing = &mut loops[k];
        (closing.row[k], closing.pivot, closing.of_joint) = inverted(&closing.row[k], &closing.free, closing.rows);
        let pivot_row = loops[k].row;
        for closing in &mut loops[k + 1..] {
            let factor = closing.row[k] * pivot_row[k];
            closing.row[k] = factor;
            for (entry, above) in closing.row.iter_mut().zip(&pivot_row).skip(k + 1) {
                *entry -= factor * above;
            }
        }
    }
}

/// Solves for these right-hand sides by the factors. Returns the summed squares of the `w`, of turns and of shifts: in
/// a stiffly constrained system the solution is a small difference of large `w`, which sets its rounding error.
pub(super) fn solve<const K: usize, const N: usize, const L: usize>(
    tree: &Tree<N>,
    bodies: &[Body<K>; N],
    loops: &[Closing<K, N, L>; L],
    unknowns: &mut Unknowns<K, N, L>,
) -> Vector2<f64> {
    let size = substitute(tree, bodies, &mut unknowns.bodies, &mut unknowns.joints);
    for (k, closing) in loops.iter().enumerate() {
        // The right-hand sides `C_L x + g`, reduced by the rows above.
        let mut right = unknowns.loops[k];
        for (body, ends) in closing.ends() {
            right += ends.after * unknowns.bodies[body];
        }
        for (factor, above) in closing.row.iter().zip(&unknowns.loops).take(k) {
            right -= factor * above;
        }
        unknowns.loops[k] = right;
    }
    for (k, closing) in loops.iter().enumerate().rev() {
        let mut right = unknowns.loops[k];
        for (entry, below) in closing.row.iter().zip(&unknowns.loops).skip(k + 1) {
            right -= entry * below;
        }
        unknowns.loops[k] = closing.row[k] * right;
    }
    for (closing, multiplier) in loops.iter().zip(&unknowns.loops) {
        for k in 0..N {
            unknowns.bodies[k] += closing.columns[k] * multiplier;
            unknowns.joints[k] += closing.multipliers[k] * multiplier;
        }
    }
    size
}

/// Solves the trees alone, without loops, for each column of the right-hand sides.
fn substitute<const K: usize, const N: usize, const C: usize>(
    tree: &Tree<N>,
    bodies: &[Body<K>; N],
    of_bodies: &mut [SMatrix<f64, 6, C>; N],
    of_joints: &mut [SMatrix<f64, K, C>; N],
) -> Vector2<f64> {
    let mut size = Vector2::zeros();
    for &k in tree.order.iter().rev() {
        let (body, member) = (&bodies[k], tree.members[k]);
        let w = solved(&body.matrix, &of_bodies[k]);
        of_bodies[k] = w;
        size += Vector2::new(w.fixed_rows::<3>(0).norm_squared(), w.fixed_rows::<3>(3).norm_squared());
        if member.joint.is_none() {
            continue;
        }
        let [own, of_parent] = &body.slopes.0;
        let s = body.inverse * (of_joints[k] - own.after * w);
        of_joints[k] = s;
        if let Some(parent) = member.parent {
            of_bodies[parent] += of_parent.before * s;
        }
    }
    for &k in &tree.order {
        let (body, member) = (&bodies[k], tree.members[k]);
        of_bodies[k] = -of_bodies[k];
        if member.joint.is_none() {
            continue;
        }
        if let Some(parent) = member.parent {
            of_joints[k] += body.p * of_bodies[parent];
        }
        of_bodies[k] -= body.x * of_joints[k];
    }
    size
}

/// The solution by a body's factors, column by column.
#[hot]
fn solved<const C: usize>(factors: &Matrix6, right: &SMatrix<f64, 6, C>) -> SMatrix<f64, 6, C> {
    let mut solved = *right;
    for mut column in solved.column_iter_mut() {
        let solution = Vector6::solve_apart(factors, Pattern::WHOLE, &column.clone_owned());
        column.copy_from(&solution);
    }
    solved
}

/// The inverse by elimination in the order of the rows, the least pivot relative to `sizes`, and the determinant
/// relative to their absolute values; a size of zero makes both zero. Rows after the first `rows` hold no functions.
#[hot]
fn inverted<const K: usize>(
    matrix: &SMatrix<f64, K, K>,
    sizes: &SVector<f64, K>,
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
