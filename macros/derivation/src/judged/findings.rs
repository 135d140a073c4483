//! What has been found out about a derivation, after it has been checked.

use std::rc::Rc;

use super::choose::Choice;
use super::verify::{self, Findings, Subject};
use super::{explain, hypotheses};
use crate::declared::errors::Errors;
use crate::declared::{Declaration, Role, Tree};
use crate::mathematics::derive::SelfAdjointness;

/// Checks all that was derived; `None` where something is wrong with the Lagrangian, or with the derivation, which has
/// been reported.
pub fn findings(declaration: &Declaration, tree: &Rc<Tree>, chosen: &Choice, errors: &mut Errors) -> Option<Findings> {
    let Choice { lowered, derived, kernel } = chosen;
    let of = Subject { declaration, tree, lowered, derived };
    // What has no kinetic part at all is a term of a scene.
    if derived.limit.has_kinetic {
        explain::kinetic_part(&verify::kinetic_part(of), declaration, errors)?;
    }
    let is_force = declaration.role == Role::Force;
    match verify::verify(of, kernel) {
        Ok(verified) => {
            let asked = declaration.discretisation().filter(|_| verified.self_adjointness == SelfAdjointness::No);
            if let Some(asked) = asked {
                explain::not_self_adjoint(asked, errors);
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
