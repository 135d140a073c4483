//! What has been found out about a derivation, after it has been checked.

use std::rc::Rc;

use super::choose::Chosen;
use super::verify::{self, Subject, Sureness, Verified};
use super::{explain, hypotheses};
use crate::declared::errors::Errors;
use crate::declared::{Declaration, Role, Tree};
use crate::mathematics::derive::SelfAdjointness;
use crate::program::{Derivatives, Outputs, Stages};

/// What its documentation says beside the equations.
pub(crate) struct Findings {
    pub(crate) self_adjointness: SelfAdjointness,
    pub(crate) sureness: Sureness,
    /// What the stages of a step hand on, and the Jacobian of its momentum.
    pub(crate) stages: Stages,
    pub(crate) jacobian: Outputs,
    /// Of a step, where they are asked for.
    pub(crate) derivatives: Option<Derivatives>,
    pub(crate) hypotheses: Vec<String>,
}

/// Checks all that was derived; `None` where something is wrong with the Lagrangian, or with the derivation, which has
/// been reported.
pub(crate) fn findings(
    declaration: &Declaration,
    tree: &Rc<Tree>,
    chosen: &Chosen,
    errors: &mut Errors,
) -> Option<Findings> {
    let Chosen { lowered, derived, kernel } = chosen;
    let of = Subject { declaration, tree, lowered, derived };
    // What has no kinetic part at all is a term of a scene.
    if derived.limit.has_kinetic {
        explain::kinetic_part(&verify::kinetic_part(of), declaration, errors)?;
    }
    let is_force = declaration.role == Role::Force;
    match verify::verify(of, kernel) {
        Ok(Verified { self_adjointness, sureness, stages, jacobian, derivatives }) => {
            let asked = declaration.discretisation().filter(|_| self_adjointness == SelfAdjointness::No);
            if let Some(asked) = asked {
                explain::not_self_adjoint(asked, errors);
                return None;
            }
            let of = || hypotheses::hypotheses(declaration, tree, lowered, derived);
            let hypotheses = if is_force { Vec::new() } else { of() };
            Some(Findings { self_adjointness, sureness, stages, jacobian, derivatives, hypotheses })
        }
        Err(unconfirmed) => {
            explain::unconfirmed(unconfirmed, declaration, tree, errors);
            None
        }
    }
}
