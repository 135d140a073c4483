//! The results of verifying a derivation.

use std::rc::Rc;

use super::choose::Choice;
use super::verify::{self, Findings, Subject};
use super::{explain, hypotheses};
use crate::declared::errors::Errors;
use crate::declared::{Declaration, Role, Tree};
use crate::mathematics::derive::SelfAdjointness;

/// Verifies the whole derivation; `None` if the Lagrangian or the derivation is wrong, which has been reported.
pub fn findings(declaration: &Declaration, tree: &Rc<Tree>, chosen: &Choice, errors: &mut Errors) -> Option<Findings> {
    if let Err(generator) = declaration.group.chart() {
        explain::leaves_group(generator, declaration, errors);
        return None;
    }
    let Choice { lowered, derived, kernel } = chosen;
    let of = Subject { declaration, tree, lowered, derived };
    // A term without a kinetic part is a potential or a force, added to another term.
    if derived.limit.has_kinetic {
        explain::kinetic_part(&verify::kinetic_part(of), declaration, tree, errors)?;
    }
    let is_force = declaration.role == Role::Force;
    match verify::verify(of, kernel) {
        Ok(verified) => {
            let asked = declaration.discretisation().filter(|_| verified.self_adjointness == SelfAdjointness::No);
            if let Some(asked) = asked {
                explain::not_self_adjoint(asked, declaration, errors);
                return None;
            }
            let hypotheses = if is_force { Vec::new() } else { hypotheses::hypotheses(declaration, tree, chosen) };
            Some(Findings { hypotheses, ..verified })
        }
        Err(unconfirmed) => {
            explain::unconfirmed(unconfirmed, declaration, tree, errors);
            None
        }
    }
}
