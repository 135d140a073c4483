//! Whole expansions.

pub(crate) mod continuous;
mod derivation;
mod determinism;
mod discretised_bodies;
mod fuzz;
pub(crate) mod generated;
mod higher_order;
mod mistakes;
mod not_quadratic;
mod own_group;
pub(crate) mod right;
mod rooms;
mod several_bodies;
mod sizes;
pub(crate) mod time;
mod tour;

use proc_macro2::TokenStream;

use crate::declared::Role;
use crate::declared::errors::Errors;
use crate::declared::{check, lower, parse};
use crate::judged::cheapest;
use crate::mathematics::derive::Derived;
use crate::mathematics::derive::derive;

/// (3.13).
pub(crate) const HEAVY_TOP: &str = "group = SO3, advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * m * g * w.dot(&(rho + F * rho))";

/// The parameters of (3.13) with an inertia of that type.
pub(crate) fn top(inertia: &str) -> String {
    format!("struct Top {{ J_d: {inertia}, m: f64, g: f64, rho: Vector3<f64>, up: Vector3<f64> }}")
}

/// A struct with those of the fields that a declaration names.
pub(crate) fn struct_of(fields: &[&str], arguments: &str) -> String {
    let names: Vec<&str> = arguments.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    let is_used = |field: &&&str| field.split(':').next().is_some_and(|name| names.contains(&name));
    let fields: Vec<&str> = fields.iter().filter(is_used).copied().collect();
    format!("struct Body {{ {} }}", fields.join(", "))
}

pub(crate) fn tokens(text: &str) -> TokenStream {
    text.parse().expect("tokens")
}

fn expand(arguments: TokenStream, item: &TokenStream) -> TokenStream {
    super::expand(Role::Lagrangian, arguments, item)
}

pub(crate) fn expanded(arguments: &str, item: &str) -> TokenStream {
    expand(tokens(arguments), &tokens(item))
}

/// What is derived from a declaration, through all phases.
pub(crate) fn derived(arguments: &str, item: &str) -> Derived {
    let mut errors = Errors::default();
    let declaration = parse::declaration(Role::Lagrangian, &tokens(arguments), &tokens(item), &mut errors);
    let declaration = declaration.expect("a declaration");
    let tree = check::check(&declaration, &mut errors).expect("a Lagrangian");
    let readings = lower::readings(&declaration, &tree, &mut errors).expect("small");
    cheapest(readings, derive, &declaration, &tree, &mut errors).expect("something to derive").derived
}

/// An expansion is an error for the compiler to show, or items; returns whether it is an error.
fn is_refused(expansion: &TokenStream) -> bool {
    let text = expansion.to_string();
    if text.contains("compile_error") {
        return true;
    }
    if let Err(error) = syn::parse2::<syn::File>(expansion.clone()) {
        panic!("neither an error nor items: {error}\n{text}");
    }
    false
}
