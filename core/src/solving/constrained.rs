//! The momentum equation with constraints on velocities: the discrete Lagrange–d'Alembert equations.
//!
//! ```text
//! U(F, w) = a + Σ λ_k A_k(w)      c_k(F, w) = 0
//! ```
//!
//! The multipliers `λ` need no unknowns of their own. With vectors `p_k` at right angles to each other that span the `A_k`,
//! and any scale `s`, both equations hold where
//!
//! ```text
//! r − Σ p_k (p_k·r)/(p_k·p_k) + Σ p_k s h c'_k/(p_k·p_k) = 0,      r = U − a
//! ```
//!
//! because its part along the `p_k` is the second sum, and the part across them the equation of motion. `c'_k` combines the
//! constraints as `p_k` does the `A_k`. With the trace of the inertia for `s` the symmetric part of the Jacobian at rest is
//! positive definite, so that eliminations need no pivots.

use alloc::vec::Vec;

use super::problem::Problem;
use crate::groups::{LieGroup as _, Retraction as _};
use crate::mechanics::{Effect, Matrix, Scalar, Square, Vector, inertia, normals};
use crate::numbers::Coordinates as _;

/// A value and a slope of each constraint, or what is made of them.
type Rows<L> = Vec<(Scalar<L>, Vector<L>)>;

/// The trace of the inertia at the identity, by which the rows of a Jacobian are commensurable.
fn scale<L: Effect>(problem: &Problem<'_, L>) -> Scalar<L> {
    Vector::<L>::trace(&inertia(problem.scene, &problem.scene.advected()))
}

fn rows<L: Effect>(problem: &Problem<'_, L>, f: &Matrix<L>) -> Rows<L> {
    let mut rows = Vec::new();
    problem.scene.constrained(Some((f, problem.h)), problem.w, &mut |value, slope| rows.push((value, slope)));
    rows
}

/// Residual and Jacobian in half the coordinates with the constraints, if there are any.
pub(super) fn with_constraints<L: Effect>(
    problem: &Problem<'_, L>,
    half: &Vector<L>,
    (residual, jacobian): (Vector<L>, Square<L>),
) -> (Vector<L>, Square<L>) {
    if const { L::FACTS.constraints == 0 } {
        return (residual, jacobian);
    }
    let f = L::Retraction::retract(&(*half + *half)).matrix();
    let mut of_all = rows(problem, &f);
    for (_, slope) in &mut of_all {
        let row = L::Retraction::in_coordinates(&Vector::<L>::axis(0).outer(slope), half);
        *slope = Vector::<L>::column(&Vector::<L>::transpose(&row), 0);
    }
    let (scale, transposed) = (scale(problem), Vector::<L>::transpose(&jacobian));
    let (mut sum, mut whole, mut before) = (residual, jacobian, Rows::<L>::new());
    for (normal, own) in normals(problem.scene, problem.w).iter().zip(of_all) {
        let (value, slope) = normal.combined(own, &before);
        let across = normal.across;
        sum = sum + across * ((scale * value - across.dot(&residual)) / normal.square);
        let row = slope * scale - transposed * across;
        whole = whole + across.outer(&(row * (one::<L>() / normal.square)));
        before.push((value, slope));
    }
    (sum, whole)
}

/// A right-trivialised Jacobian with the constraints, by which the branch of a solution is judged.
pub(super) fn bordered<L: Effect>(problem: &Problem<'_, L>, f: &Matrix<L>, jacobian: Square<L>) -> Square<L> {
    if const { L::FACTS.constraints == 0 } {
        return jacobian;
    }
    let (scale, transposed) = (scale(problem), Vector::<L>::transpose(&jacobian));
    let (mut whole, mut before) = (jacobian, Rows::<L>::new());
    for (normal, own) in normals(problem.scene, problem.w).iter().zip(rows(problem, f)) {
        let (value, slope) = normal.combined(own, &before);
        let row = slope * scale - transposed * normal.across;
        whole = whole + normal.across.outer(&(row * (one::<L>() / normal.square)));
        before.push((value, slope));
    }
    whole
}

fn one<L: Effect>() -> Scalar<L> {
    crate::numbers::real(1.0)
}
