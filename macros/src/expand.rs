//! The flow of one expansion.

use proc_macro2::TokenStream;
use quote::quote;

use crate::choose::Chosen;
use crate::emit::Findings;
use crate::errors::Errors;
use crate::{check, choose, emit, explain, fallback, hypotheses, lower, parse, verify};

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

/// Parse, check, lower, derive, choose, verify, emit.
fn implementation(arguments: &TokenStream, item: &TokenStream, errors: &mut Errors) -> Option<TokenStream> {
    let item = parse::item(item, errors)?;
    parse::check_size(arguments, errors)?;
    let declaration = parse::parse(arguments.clone(), item, errors);
    let tree = check::check(&declaration, errors)?;
    if !errors.is_empty() {
        return None;
    }
    let candidates = lower::lower(&declaration, &tree, errors);
    let Chosen { lowered, derived, kernel } =
        choose::cheapest(candidates?).map_err(|refusal| explain::explain(refusal, &declaration, &tree, errors)).ok()?;
    let kinetic = verify::kinetic_part(&declaration, &lowered, &derived);
    explain::kinetic_part(&kinetic, &declaration, errors)?;
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

#[cfg(test)]
pub(crate) mod tests;
