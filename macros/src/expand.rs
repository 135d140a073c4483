//! The flow of one expansion.

use proc_macro2::{Span, TokenStream};
use quote::quote;

use crate::derive::Derived;
use crate::emit::Findings;
use crate::errors::Errors;
use crate::{check, derive, emit, explain, fallback, hypotheses, lower, parse, scalar, verify};

/// The item with its integrator, or with all mistakes and a stand-in.
pub(crate) fn expand(arguments: TokenStream, item: &TokenStream) -> TokenStream {
    let mut errors = Errors::default();
    match implementation(&arguments, item, &mut errors) {
        Some(implementation) if errors.is_empty() => quote!(#item #implementation),
        _ => {
            let (mistakes, stand_in) = (errors.to_compile_errors(), fallback::stand_in(arguments, item));
            quote!(#item #mistakes #stand_in)
        }
    }
}

/// Parse, check, lower, derive, verify, emit.
fn implementation(arguments: &TokenStream, item: &TokenStream, errors: &mut Errors) -> Option<TokenStream> {
    let item = parse::item(item, errors)?;
    parse::check_size(arguments, errors)?;
    let declaration = parse::parse(arguments.clone(), item, errors);
    let tree = check::check(&declaration, errors)?;
    if !errors.is_empty() {
        return None;
    }
    let lowered = lower::lower(&declaration, &tree, errors)?;
    let derived =
        derive::derive(&lowered.declared).map_err(|error| explain::explain(error, &declaration, &tree, errors)).ok()?;
    is_sound(&derived, tree.span, errors)?;
    let kinetic = verify::kinetic_part(&declaration, &lowered, &derived);
    explain::kinetic_part(&kinetic, &declaration, errors)?;
    let kernel = scalar::kernel(&derived);
    match verify::verify(&declaration, &tree, &lowered, &derived, &kernel) {
        Ok(self_adjointness) => {
            let hypotheses = hypotheses::hypotheses(&declaration, &tree, &lowered);
            let findings = Findings { kernel, self_adjointness, hypotheses };
            Some(emit::implementation(&declaration, &lowered, &derived, &findings))
        }
        Err(term) => {
            let message =
                format!("the derived {term} disagrees with the declared Lagrangian: please report this declaration");
            errors.push(tree.span, message);
            None
        }
    }
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
        &derived.adjoint_defect,
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
