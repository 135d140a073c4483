//! The flow of one expansion.

use proc_macro2::{Span, TokenStream};
use quote::quote;
use syn::ItemStruct;

use crate::derive::{Derived, LimitError};
use crate::errors::Errors;
use crate::{check, derive, emit, fallback, lower, parse, verify};

/// The item with its integrator, or with all mistakes and a stand-in.
pub(crate) fn expand(arguments: &TokenStream, item: &TokenStream) -> TokenStream {
    let parsed = match syn::parse2::<ItemStruct>(item.clone()) {
        Ok(parsed) => parsed,
        Err(error) => {
            let message = "`lagrangian` belongs on a struct with named fields";
            let error = syn::Error::new(error.span(), message).to_compile_error();
            return quote!(#item #error);
        }
    };
    let mut errors = Errors::default();
    parse::check_size(arguments, &mut errors);
    if !errors.is_empty() {
        let mistakes = errors.to_compile_errors();
        return quote!(#item #mistakes);
    }
    let implementation = implementation(arguments.clone(), &parsed, &mut errors);
    match implementation {
        Some(implementation) if errors.is_empty() => quote!(#item #implementation),
        _ => {
            let (mistakes, stand_in) = (errors.to_compile_errors(), fallback::stand_in(arguments, &parsed));
            quote!(#item #mistakes #stand_in)
        }
    }
}

/// Parse, check, lower, derive, verify, emit.
fn implementation(arguments: TokenStream, item: &ItemStruct, errors: &mut Errors) -> Option<TokenStream> {
    let declaration = parse::parse(arguments, item.clone(), errors)?;
    let tree = check::check(&declaration, errors)?;
    if !errors.is_empty() {
        return None;
    }
    let lowered = lower::lower(&declaration, &tree, errors)?;
    let derived = derive::derive(&lowered.declared).map_err(|error| explain(error, tree.span, errors)).ok()?;
    is_sound(&derived, tree.span, errors)?;
    if let Some(term) = verify::disagreement(&declaration, &tree, &lowered, &derived) {
        let message =
            format!("the derived {term} disagrees with the declared Lagrangian: please report this declaration");
        errors.push(tree.span, message);
        return None;
    }
    Some(emit::implementation(&declaration, &lowered, &derived))
}

fn explain(error: LimitError, span: Span, errors: &mut Errors) {
    let message = match error {
        LimitError::StepInsideFunction => {
            "`h` stands under a function or in a sum that is divided by, where its limit h → 0 isn't found: take it out"
                .to_owned()
        }
        LimitError::TooSingular(power) => {
            format!("a term with `F` goes like h^{power}: the kinetic part of a discrete Lagrangian goes like 1/h")
        }
        LimitError::NoKineticTerm => {
            "there is no kinetic part: no term with `F` is divided by `h`, so a momentum doesn't determine a velocity"
                .to_owned()
        }
        LimitError::NotStationary => {
            "the kinetic part isn't stationary at `F = I`: at rest the momentum would grow like 1/h".to_owned()
        }
    };
    errors.push(span, message);
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
