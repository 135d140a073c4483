//! Rules for constraints alone: functions are scalars and vectors, stacked into one column.

use std::rc::Rc;

use quote::ToTokens;
use syn::{Expr, ExprTuple};

use super::Checker;
use crate::declared::errors::Errors;
use crate::declared::{Role, Shape, Tree};

/// The number of coordinates of one body relative to another.
const MOST_FUNCTIONS: usize = 6;

/// Checks that the functions are scalars or vectors, and not more than the limit.
pub(super) fn few(functions: &[Rc<Tree>], result: &Expr, errors: &mut Errors) -> Option<()> {
    let parts: Vec<&Expr> = match result {
        Expr::Tuple(tuple) => tuple.elems.iter().collect(),
        other => vec![other],
    };
    let is_function = |tree: &Tree| tree.shape == Shape::Scalar || tree.shape.is_vector();
    if let Some((tree, part)) = functions.iter().zip(parts).find(|(tree, _)| !is_function(tree)) {
        let message = format!(
            "a constraint is a scalar or a vector, or several of them, `(a, b)`, but this is {}: of an attitude take what \
             has to be zero, as in `(R_1 * e).dot(&(R_2 * n))`",
            tree.shape.describe()
        );
        errors.push_over(part, message);
        return None;
    }
    let rows: usize = functions.iter().map(|tree| tree.shape.rows()).sum();
    if rows > MOST_FUNCTIONS {
        let message = format!(
            "these are {rows} functions: two bodies have {MOST_FUNCTIONS} coordinates against each other, and more \
             functions than that repeat what others say"
        );
        errors.push_over(result, message);
        return None;
    }
    Some(())
}

impl Checker<'_> {
    pub(super) fn is_constraint(&self) -> bool {
        self.declaration.role == Role::Constraint
    }

    /// Reports a constraint that is written as an equation.
    pub(super) fn has_to_be_zero(&mut self, token: impl ToTokens) -> Option<Rc<Tree>> {
        self.errors.push_over(token, "write what has to be zero: `a - b` in the place of an equation");
        None
    }

    /// `(a, b)`: scalars and vectors stacked into one column. Stores all of them and returns the last.
    pub(super) fn stacked(&mut self, tuple: &ExprTuple) -> Option<Rc<Tree>> {
        let parts: Vec<Option<Rc<Tree>>> = tuple.elems.iter().map(|part| self.expression(part)).collect();
        if parts.is_empty() {
            self.errors.push_over(tuple, "these are no functions: write what has to be zero");
        }
        self.parts = parts.into_iter().collect::<Option<Vec<_>>>()?;
        self.parts.last().cloned()
    }
}
