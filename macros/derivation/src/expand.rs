//! The sequence of phases in one expansion.

use proc_macro2::TokenStream;

use crate::declared::errors::Errors;
use crate::declared::{Declaration, Role, check, lower, parse};
use crate::emit;
use crate::judged::{self, Choice, ConstraintSlopes, Equations, Findings};
use crate::mathematics::derive;

/// The item with its integrator, or with all its mistakes and a stand-in for the integrator.
#[must_use]
pub fn expand(role: Role, arguments: TokenStream, item: &TokenStream) -> TokenStream {
    if let Some(asked) = parse::asked(&arguments) {
        return emit::ask(role, &asked, item);
    }
    let mut errors = Errors::default();
    match implementation(role, &arguments, item, &mut errors) {
        Some(implementation) if errors.is_empty() => implementation,
        _ => emit::mistakes(role, arguments, item, &errors),
    }
}

/// The items of a user's group, or its mistakes.
#[must_use]
pub fn matrix_group(tokens: TokenStream) -> TokenStream {
    let mut errors = Errors::default();
    let name = parse::name_of_own_group(&tokens);
    let group = parse::own_group(tokens, &mut errors);
    emit::own_group(group.as_ref(), name.as_ref(), &errors)
}

/// The results of checking and deriving a declaration.
pub(crate) enum Judgement {
    Constraint(ConstraintSlopes),
    /// A continuous Lagrangian without a discretisation.
    Continuous(Equations),
    Steps(Box<Steps>),
}

/// The results for a declaration with steps: a discrete Lagrangian, a force, or a constraint on velocities.
pub(crate) struct Steps {
    pub(crate) chosen: Choice,
    /// The continuous equations of a Lagrangian.
    pub(crate) equations: Option<Equations>,
    pub(crate) findings: Findings,
}

fn implementation(role: Role, arguments: &TokenStream, item: &TokenStream, errors: &mut Errors) -> Option<TokenStream> {
    let declaration = parse::declaration(role, arguments, item, errors)?;
    Some(match judged(&declaration, errors)? {
        Judgement::Constraint(held) => emit::constraint(item, &declaration, &held),
        Judgement::Continuous(equations) => emit::continuous(item, &declaration, &equations),
        Judgement::Steps(steps) => {
            let Steps { chosen, equations, findings } = *steps;
            emit::implementation([arguments, item], &declaration, &chosen, equations.as_ref(), &findings)
        }
    })
}

/// Runs the phases up to the derivation. Each adds its mistakes to `errors`, and returns `None` if the next can't run.
pub(crate) fn judged(declaration: &Declaration, errors: &mut Errors) -> Option<Judgement> {
    if declaration.role == Role::Constraint {
        let functions = check::functions(declaration, errors)?;
        return Some(Judgement::Constraint(judged::held(declaration, functions, errors)?));
    }
    let tree = check::check(declaration, errors)?;
    let declared = match declaration.continuous {
        Some(_) if judged::terms(declaration, &tree, errors).is_none() => return None,
        Some(_) if declaration.role == Role::Nonholonomic => {
            judged::linear(declaration, &tree, errors)?;
            Some(judged::of_declared(declaration, &tree, errors)?)
        }
        Some(_) => Some(judged::of_declared(declaration, &tree, errors)?),
        None => None,
    };
    let (declared, discrete) = match (declared, declaration.discretisation()) {
        (Some(equations), None) => {
            if let Some(key) = declaration.gradients {
                errors.push(
                    key,
                    "`gradients` are those of a step: write `discretise = …`, which makes one, or remove it",
                );
                return None;
            }
            return Some(Judgement::Continuous(equations));
        }
        (declared @ Some(_), Some(asked)) => (declared, judged::discretised(declaration, &tree, asked, errors)?),
        (None, _) => (None, tree.clone()),
    };
    judged::terms(declaration, &discrete, errors)?;
    let mut readings = lower::readings(declaration, &discrete, errors)?;
    if let Some(equations) = &declared {
        readings = readings.into_iter().map(|reading| equations.behind(reading)).collect();
    }
    // The function `derive` is passed on, as a long reading is derived only if no short one can be.
    let chosen = judged::cheapest(readings, derive::derive, declaration, &discrete, errors)?;
    let findings = judged::findings(declaration, &discrete, &chosen, errors)?;
    let equations = match declaration.role {
        Role::Force => None,
        _ => Some(judged::continuous(declared, declaration, [&tree, &discrete], &chosen, errors)?),
    };
    Some(Judgement::Steps(Box::new(Steps { chosen, equations, findings })))
}
