//! Why nothing could be derived, at the tokens of the declaration.

use std::collections::BTreeSet;
use std::rc::Rc;

use proc_macro2::Span;

use crate::ast::{Declaration, Kind, Name, Tree};
use crate::check;
use crate::derive::{ForceError, LimitError};
use crate::errors::Errors;

/// Reports a Lagrangian that discretises no continuous one.
pub(crate) fn explain(error: LimitError, declaration: &Declaration, tree: &Rc<Tree>, errors: &mut Errors) {
    let message = match error {
        LimitError::StepInsideFunction => {
            let span = Search::default().enclosed_step(tree, false).unwrap_or(tree.span);
            errors.push(
                span,
                "`h` stands under a function or in a sum that is divided by, where its limit h → 0 isn't found: take it out",
            );
            return;
        }
        LimitError::TooSingular(power) => {
            format!("a term with `F` goes like h^{power}: the kinetic part of a discrete Lagrangian goes like 1/h")
        }
        LimitError::NotStationary => {
            "the kinetic part isn't stationary at `F = I`, so at rest the momentum would grow \
                                      like 1/h: write it as a square of `F - I`"
                .to_owned()
        }
    };
    errors.push_over(declaration.l_d.as_ref().map(check::value), message);
}

/// Reports virtual work that isn't the work of a force.
pub(crate) fn explain_force(error: ForceError, declaration: &Declaration, errors: &mut Errors) {
    let message = match error {
        ForceError::NotLinear => {
            "virtual work is linear in the displacements: a force times `eta`, and a force times `eta_next`"
        }
    };
    errors.push_over(declaration.l_d.as_ref().map(check::value), message);
}

/// Looks for an `h` that the limit can't follow.
#[derive(Default)]
struct Search {
    /// What a `let` has bound is searched once, however often it is used.
    known: BTreeSet<(*const Tree, bool)>,
}

impl Search {
    fn enclosed_step(&mut self, tree: &Rc<Tree>, is_enclosed: bool) -> Option<Span> {
        if !self.known.insert((Rc::as_ptr(tree), is_enclosed)) {
            return None;
        }
        match &tree.kind {
            Kind::Name(Name::Step) => is_enclosed.then_some(tree.span),
            Kind::Apply(_, a) => self.enclosed_step(a, true),
            Kind::Divide(a, b) => {
                self.enclosed_step(a, is_enclosed).or_else(|| self.enclosed_step(b, is_enclosed || is_sum(b)))
            }
            Kind::Power(a, exponent) => self.enclosed_step(a, is_enclosed || (*exponent < 0 && is_sum(a))),
            kind => kind.operands().into_iter().flatten().find_map(|operand| self.enclosed_step(operand, is_enclosed)),
        }
    }
}

/// Whether a sum is left, once factors are taken apart.
fn is_sum(tree: &Tree) -> bool {
    match &tree.kind {
        Kind::Add(..) | Kind::Subtract(..) => true,
        Kind::Multiply(a, b) | Kind::Divide(a, b) => is_sum(a) || is_sum(b),
        Kind::Negate(a) | Kind::Power(a, _) => is_sum(a),
        _ => false,
    }
}
