//! The continuous equations: derived from a declared `l`, or from the limit of a declared `l_d`, and verified exactly.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::choose::Choice;
use super::explain;
use super::verify::{Motion, Sureness};
use crate::declared::errors::Errors;
use crate::declared::lower::Reading;
use crate::declared::{Declaration, Name, Role, Tree, lower};
use crate::mathematics::derive::{self, Continuous, ContinuousSource, Inverse};
use crate::mathematics::symbolic::{Rational, SymbolId};

/// The continuous equations of a declaration.
pub struct Equations {
    pub names: BTreeMap<Name, SymbolId>,
    pub derived: Continuous,
    /// A basis of the directions along which the body momentum is conserved for all values of the parameters.
    pub right_symmetries: Vec<Vec<Rational>>,
    pub sureness: Sureness,
}

impl Equations {
    /// The reading with the continuous equations that it discretises.
    pub fn behind(&self, reading: Reading) -> Reading {
        let symbols = self.names.iter().filter_map(|(name, &from)| Some((from, *reading.names.get(name)?))).collect();
        let discretised = Some(ContinuousSource { continuous: self.derived.clone(), symbols });
        Reading { declared: derive::DeclaredFunction { discretised, ..reading.declared }, ..reading }
    }
}

/// The equations of a declared `l`; `None` after a mistake, which has been reported.
pub fn of_declared(declaration: &Declaration, tree: &Rc<Tree>, errors: &mut Errors) -> Option<Equations> {
    let lowered = lower::continuous(declaration, tree, errors)?;
    let derived = derive::continuous(lowered.declared);
    let derived = derived.map_err(|refusal| explain::refusal(refusal, declaration, tree, errors)).ok()?;
    checked(declaration, (tree, None), lowered.names, derived, errors)
}

/// The equations of a discrete Lagrangian: those of the `l` that it discretises, which must be its limit, or else those
/// of its limit.
pub fn continuous(
    declared: Option<Equations>,
    declaration: &Declaration,
    [tree, discrete]: [&Rc<Tree>; 2],
    chosen: &Choice,
    errors: &mut Errors,
) -> Option<Equations> {
    let Some(mut equations) = declared else { return of_limit(declaration, discrete, chosen, errors) };
    let motion = Motion::new(declaration, Some(tree), &equations.names, &equations.derived);
    let at_rest = limit_holds(&motion, false, (declaration, discrete, chosen), errors)?;
    equations.sureness = equations.sureness.and(at_rest);
    Some(equations)
}

/// Checks that the equations are the limit of the discrete Lagrangian. `may_have_limit` decides if the field can't
/// tell.
fn limit_holds(
    motion: &Motion,
    may_have_limit: bool,
    (declaration, discrete, chosen): (&Declaration, &Rc<Tree>, &Choice),
    errors: &mut Errors,
) -> Option<Sureness> {
    let limit = || chosen.kernel.beginning.limit(&chosen.derived);
    let limit = motion.has_limit(discrete).unwrap_or(may_have_limit).then(limit);
    let at_rest = limit.and_then(|limit| motion.rest_holds(&chosen.lowered.names, limit).ok());
    if at_rest.is_none() {
        explain::unconfirmed_term("continuous limit", declaration, errors);
    }
    at_rest
}

fn of_limit(declaration: &Declaration, discrete: &Rc<Tree>, chosen: &Choice, errors: &mut Errors) -> Option<Equations> {
    let declared = derive::of_limit(&chosen.lowered.declared, &chosen.derived);
    let mut names = chosen.lowered.names.clone();
    let velocities = declared.velocities.iter().enumerate();
    names.extend(velocities.map(|(factor, velocity)| (Name::Velocity(factor), velocity.components)));
    let Ok(derived) = derive::continuous(declared) else {
        explain::unconfirmed_term("continuous limit", declaration, errors);
        return None;
    };
    checked(declaration, (discrete, Some(chosen)), names, derived, errors)
}

/// The verified equations of this tree, or of the limit of the derivation chosen for it.
fn checked(
    declaration: &Declaration,
    (tree, chosen): (&Rc<Tree>, Option<&Choice>),
    names: BTreeMap<Name, SymbolId>,
    derived: Continuous,
    errors: &mut Errors,
) -> Option<Equations> {
    let motion = Motion::new(declaration, Some(tree).filter(|_| chosen.is_none()), &names, &derived);
    // The check that each momentum has a velocity is for Lagrangians: a Hamiltonian has its velocity as a derivative.
    if chosen.is_none() && derived.has_kinetic() && declaration.role != Role::Hamiltonian {
        explain::continuous_kinetic_part(&motion.kinetic_part(), declaration, tree, errors)?;
    }
    let sureness = motion.holds();
    let mut sureness =
        sureness.map_err(|unconfirmed| explain::unconfirmed(unconfirmed, declaration, tree, errors)).ok()?;
    if let Some(chosen) = chosen {
        let is_quadratic = derived.inverse != Inverse::Nonlinear;
        sureness = sureness.and(limit_holds(&motion, is_quadratic, (declaration, tree, chosen), errors)?);
    }
    let right_symmetries = motion.right_symmetries();
    Some(Equations { names, derived, right_symmetries, sureness })
}
