//! The flow of one expansion.

use std::rc::Rc;

use proc_macro2::{Span, TokenStream};
use quote::quote;

use crate::ast::{Declaration, Role, Tree};
use crate::derive::Derived;
use crate::errors::Errors;
use crate::lower::Lowered;
use crate::{check, derive, emit, explain, fallback, lower, parse, verify};

/// The item with its integrator, or with all mistakes and a stand-in.
pub(crate) fn expand(role: Role, arguments: TokenStream, item: &TokenStream) -> TokenStream {
    let mut errors = Errors::default();
    match implementation(role, &arguments, item, &mut errors) {
        Some(implementation) if errors.is_empty() => quote!(#item #implementation),
        _ => {
            let (mistakes, stand_in) = (errors.to_compile_errors(), fallback::stand_in(role, arguments, item));
            quote!(#item #mistakes #stand_in)
        }
    }
}

/// Parse, check, lower, derive, verify, emit.
fn implementation(role: Role, arguments: &TokenStream, item: &TokenStream, errors: &mut Errors) -> Option<TokenStream> {
    let item = parse::item(item, errors)?;
    parse::check_size(arguments, errors)?;
    let declaration = parse::parse(role, arguments.clone(), item, errors);
    let tree = check::check(&declaration, errors)?;
    if !errors.is_empty() {
        return None;
    }
    let lowered = lower::lower(&declaration, &tree, errors)?;
    let derived = derived(&declaration, &tree, &lowered, errors)?;
    is_sound(&derived, tree.span, errors)?;
    let disagreement = match declaration.role {
        Role::Lagrangian => verify::disagreement(&declaration, &tree, &lowered, &derived),
        Role::Force => verify::disagreement_of_force(&declaration, &tree, &lowered, &derived),
    };
    if let Some(term) = disagreement {
        let message = format!("the derived {term} disagrees with what is declared: please report this declaration");
        errors.push(tree.span, message);
        return None;
    }
    Some(emit::implementation(&declaration, &lowered, &derived))
}

fn derived(declaration: &Declaration, tree: &Rc<Tree>, lowered: &Lowered, errors: &mut Errors) -> Option<Derived> {
    let Some(displacements) = lowered.displacements else {
        let derived = derive::derive(&lowered.declared);
        return derived.map_err(|error| explain::explain(error, declaration, tree, errors)).ok();
    };
    let derived = derive::force(&lowered.declared, displacements);
    derived.map_err(|error| explain::explain_force(error, declaration, errors)).ok()
}

/// Coefficients stay exact, or the expansion says that they can't.
fn is_sound(derived: &Derived, span: Span, errors: &mut Errors) -> Option<()> {
    let limit = &derived.limit;
    let all = [
        &derived.right_momentum,
        &derived.left_momentum,
        &derived.diamond,
        &derived.momentum,
        &derived.jacobian,
        &derived.energy,
        &limit.inertia,
        &limit.bias,
        &limit.potential,
        &derived.kick_before,
        &derived.unknown,
        &derived.kick_after,
    ];
    let cleared = derived.cleared.iter().flat_map(|cleared| [&cleared.residual, &cleared.jacobian]);
    if all.into_iter().chain(cleared).any(crate::symbolic::Expression::has_overflow) {
        errors.push(span, "the coefficients leave the range of exact arithmetic: make the large numbers fields");
        return None;
    }
    Some(())
}

#[cfg(test)]
pub(crate) mod tests;
