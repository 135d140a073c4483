//! The flow of one expansion.

use std::rc::Rc;

use proc_macro2::TokenStream;
use quote::quote;

use crate::declared::errors::Errors;
use crate::declared::{Declaration, Role, Tree};
use crate::declared::{check, lower, parse};
use crate::emit;
use crate::emit::Findings;
use crate::judged::choose::Chosen;
use crate::judged::{choose, explain, hypotheses, verify};
use crate::mathematics::derive::SelfAdjointness;

/// The item with its integrator, or with all mistakes and a stand-in.
pub(crate) fn expand(role: Role, arguments: TokenStream, item: &TokenStream) -> TokenStream {
    let mut errors = Errors::default();
    match implementation(role, &arguments, item, &mut errors) {
        Some(implementation) if errors.is_empty() => quote!(#item #implementation),
        _ => {
            let (mistakes, stand_in) = (errors.to_compile_errors(), emit::stand_in(role, arguments, item));
            quote!(#item #mistakes #stand_in)
        }
    }
}

/// Parse, check, lower, derive, choose, verify, emit.
fn implementation(role: Role, arguments: &TokenStream, item: &TokenStream, errors: &mut Errors) -> Option<TokenStream> {
    let item = parse::item(role, item, errors)?;
    parse::check_size(role, arguments, errors)?;
    let declaration = parse::parse(role, arguments.clone(), item, errors);
    let tree = check::check(&declaration, errors)?;
    if !errors.is_empty() {
        return None;
    }
    let candidates = lower::lower(&declaration, &tree, errors);
    let chosen =
        choose::cheapest(candidates?).map_err(|refusal| explain::explain(refusal, &declaration, &tree, errors)).ok()?;
    let verified = match role {
        Role::Lagrangian => verified(&declaration, &tree, &chosen, errors)?,
        Role::Force => verify::force(&declaration, &tree, &chosen).map(|()| (SelfAdjointness::No, Vec::new())),
    };
    let Chosen { lowered, derived, kernel } = chosen;
    match verified {
        Ok((self_adjointness, hypotheses)) => {
            let findings = Findings { kernel, self_adjointness, hypotheses };
            Some(emit::implementation(&declaration, &lowered, &derived, &findings))
        }
        Err(term) => {
            let message = format!("the derived {term} disagrees with what is declared: please report this declaration");
            errors.push(tree.span, message);
            None
        }
    }
}

type Verified = Result<(SelfAdjointness, Vec<String>), &'static str>;

/// What is found out about a Lagrangian; `None` after a mistake that has been reported.
fn verified(declaration: &Declaration, tree: &Rc<Tree>, chosen: &Chosen, errors: &mut Errors) -> Option<Verified> {
    let Chosen { lowered, derived, kernel } = chosen;
    // What has no kinetic part at all is a term of a scene.
    if derived.limit.has_kinetic {
        explain::kinetic_part(&verify::kinetic_part(declaration, lowered, derived), declaration, errors)?;
    }
    let verified = verify::verify(declaration, tree, lowered, derived, kernel);
    Some(verified.map(|self_adjointness| (self_adjointness, hypotheses::hypotheses(declaration, tree, lowered))))
}

#[cfg(test)]
pub(crate) mod tests;
