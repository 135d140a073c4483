//! The continuous equations: derived of a declared `l`, or of the limit of a declared `l_d`, and checked exactly.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::choose::Chosen;
use super::{explain, verify};
use crate::declared::errors::Errors;
use crate::declared::{Declaration, Name, Tree, lower};
use crate::mathematics::derive::{self, Continuous, Inverse};
use crate::mathematics::symbolic::{Rational, SymbolId};

/// The continuous equations of a declaration.
pub(crate) struct Equations {
    pub(crate) names: BTreeMap<Name, SymbolId>,
    pub(crate) derived: Continuous,
    /// A basis of the directions along which the body momentum is conserved for all values of the parameters.
    pub(crate) right_symmetries: Vec<Vec<Rational>>,
}

/// Those of a declared `l`; `None` where something is wrong with it, which has been reported.
pub(crate) fn of_declared(declaration: &Declaration, tree: &Rc<Tree>, errors: &mut Errors) -> Option<Equations> {
    let lowered = lower::continuous(declaration, tree, errors)?;
    let derived = derive::continuous(lowered.declared);
    let derived = derived.map_err(|refusal| explain::refusal(refusal, declaration, tree, errors)).ok()?;
    if derived.has_kinetic() {
        let found = verify::kinetic_hessian(declaration, &lowered.names, &derived);
        explain::continuous_kinetic_part(&found, declaration, errors)?;
    }
    if let Some(discretisation) = declaration.discretisation().filter(|_| derived.inverse == Inverse::Nonlinear) {
        explain::not_discretised(discretisation, errors);
        return None;
    }
    checked(declaration, Some(tree), lowered.names, derived, errors)
}

/// Those of a discrete Lagrangian: of the `l` that it was made of, which its limit has to be, or of the limit.
pub(crate) fn continuous(
    declared: Option<Equations>,
    declaration: &Declaration,
    tree: &Rc<Tree>,
    chosen: &Chosen,
    errors: &mut Errors,
) -> Option<Equations> {
    let Some(equations) = declared else { return of_limit(declaration, chosen, errors) };
    if verify::limit_disagrees(declaration, tree, &chosen.lowered.names, &chosen.derived) {
        explain::unconfirmed_term("limit of the discretisation", declaration, errors);
        return None;
    }
    Some(equations)
}

fn of_limit(declaration: &Declaration, chosen: &Chosen, errors: &mut Errors) -> Option<Equations> {
    let declared = derive::of_limit(&chosen.lowered.declared, &chosen.derived);
    let mut names = chosen.lowered.names.clone();
    names.insert(Name::Velocity, declared.velocity);
    let Ok(derived) = derive::continuous(declared) else {
        explain::unconfirmed_term("continuous limit", declaration, errors);
        return None;
    };
    checked(declaration, None, names, derived, errors)
}

fn checked(
    declaration: &Declaration,
    tree: Option<&Rc<Tree>>,
    names: BTreeMap<Name, SymbolId>,
    derived: Continuous,
    errors: &mut Errors,
) -> Option<Equations> {
    if let Some(term) = verify::disagreement(declaration, tree, &names, &derived) {
        explain::unconfirmed_term(term, declaration, errors);
        return None;
    }
    let right_symmetries = verify::right_symmetries(declaration, &names, &derived);
    Some(Equations { names, derived, right_symmetries })
}
