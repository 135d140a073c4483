//! The continuous equations: derived of a declared `l`, or of the limit of a declared `l_d`, and checked exactly.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::choose::Chosen;
use super::explain;
use super::verify::{Motion, Sureness};
use crate::declared::errors::Errors;
use crate::declared::lower::Lowered;
use crate::declared::{Declaration, Name, Tree, lower};
use crate::mathematics::derive::{self, Continuous, Discretised, Inverse};
use crate::mathematics::symbolic::{Rational, SymbolId};

/// The continuous equations of a declaration.
pub(crate) struct Equations {
    pub(crate) names: BTreeMap<Name, SymbolId>,
    pub(crate) derived: Continuous,
    /// A basis of the directions along which the body momentum is conserved for all values of the parameters.
    pub(crate) right_symmetries: Vec<Vec<Rational>>,
    pub(crate) sureness: Sureness,
}

impl Equations {
    /// With what was discretised.
    pub(crate) fn behind(&self, reading: Lowered) -> Lowered {
        let symbols = self.names.iter().filter_map(|(name, &from)| Some((from, *reading.names.get(name)?))).collect();
        let discretised = Some(Discretised { continuous: self.derived.clone(), symbols });
        Lowered { declared: derive::Declared { discretised, ..reading.declared }, ..reading }
    }
}

/// Those of a declared `l`; `None` where something is wrong with it, which has been reported.
pub(crate) fn of_declared(declaration: &Declaration, tree: &Rc<Tree>, errors: &mut Errors) -> Option<Equations> {
    let lowered = lower::continuous(declaration, tree, errors)?;
    let derived = derive::continuous(lowered.declared);
    let derived = derived.map_err(|refusal| explain::refusal(refusal, declaration, tree, errors)).ok()?;
    checked(declaration, (Some(tree), tree), lowered.names, derived, errors)
}

/// Those of a discrete Lagrangian: of the `l` that it was made of, which its limit has to be, or of the limit.
pub(crate) fn continuous(
    declared: Option<Equations>,
    declaration: &Declaration,
    [tree, discrete]: [&Rc<Tree>; 2],
    chosen: &Chosen,
    errors: &mut Errors,
) -> Option<Equations> {
    let is_declared = declared.is_some();
    let mut equations = match declared {
        Some(equations) => equations,
        None => of_limit(declaration, discrete, chosen, errors)?,
    };
    let motion = Motion::new(declaration, is_declared.then_some(tree), &equations.names, &equations.derived);
    // What isn't declared and quadratic may have a limit that the field doesn't tell.
    let has_limit = motion.has_limit(discrete);
    let has_limit = has_limit.unwrap_or(!is_declared && equations.derived.inverse != Inverse::Nonlinear);
    let Some(Ok(at_rest)) = has_limit.then(|| motion.rest_holds((&chosen.lowered.names, &chosen.derived))) else {
        explain::unconfirmed_term("continuous limit", declaration, errors);
        return None;
    };
    equations.sureness = equations.sureness.and(at_rest);
    Some(equations)
}

fn of_limit(declaration: &Declaration, discrete: &Rc<Tree>, chosen: &Chosen, errors: &mut Errors) -> Option<Equations> {
    let declared = derive::of_limit(&chosen.lowered.declared, &chosen.derived);
    let mut names = chosen.lowered.names.clone();
    let velocities = declared.velocities.iter().enumerate();
    names.extend(velocities.map(|(factor, velocity)| (Name::Velocity(factor), velocity.components)));
    let Ok(derived) = derive::continuous(declared) else {
        explain::unconfirmed_term("continuous limit", declaration, errors);
        return None;
    };
    checked(declaration, (None, discrete), names, derived, errors)
}

fn checked(
    declaration: &Declaration,
    (tree, place): (Option<&Rc<Tree>>, &Rc<Tree>),
    names: BTreeMap<Name, SymbolId>,
    derived: Continuous,
    errors: &mut Errors,
) -> Option<Equations> {
    let motion = Motion::new(declaration, tree, &names, &derived);
    if tree.is_some() && derived.has_kinetic() {
        explain::continuous_kinetic_part(&motion.kinetic_part(), declaration, errors)?;
    }
    let sureness = motion.holds();
    let sureness =
        sureness.map_err(|unconfirmed| explain::unconfirmed(unconfirmed, declaration, place, errors)).ok()?;
    let right_symmetries = motion.right_symmetries();
    Some(Equations { names, derived, right_symmetries, sureness })
}
