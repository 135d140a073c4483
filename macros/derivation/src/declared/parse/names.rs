//! The names of velocities and of displacements, one for each factor of the group.

use proc_macro2::Literal;
use quote::quote_spanned;
use syn::ext::IdentExt as _;
use syn::{Expr, Ident, Path};

use super::check_free;
use crate::declared::errors::Errors;
use crate::declared::{AdvectedParameter, Factor, Field, Role, named_displacements, named_velocities};

/// Reports names of this kind that mean something else.
pub(super) fn check_names(
    role: (Role, bool),
    names: &[Ident],
    kind: &str,
    (fields, advected): (&[Field], &[AdvectedParameter]),
    errors: &mut Errors,
) {
    for (at, name) in names.iter().enumerate() {
        let plain = name.unraw().to_string();
        check_free(role, name, errors);
        if names[..at].contains(name) {
            errors.push_decisive(name.span(), format!("`{plain}` is {kind} already: choose another name"));
        } else if fields.iter().any(|field| field.plain_name() == plain) {
            errors.push_decisive(name.span(), format!("`{plain}` is a field already: choose another name"));
        } else if advected.iter().any(|w| w.plain_name() == plain) {
            errors.push_decisive(name.span(), format!("`{plain}` is advected already: choose another name"));
        }
    }
}

/// The names of a force's displacements on several bodies; empty for one body, where they are `eta` and `eta_next`.
pub(super) fn displacements(
    named: Option<(Ident, Vec<Ident>)>,
    (factors, is_product): (&[Factor], bool),
    errors: &mut Errors,
) -> Vec<Ident> {
    let Some((key, names)) = named else {
        if let Some(factor) = factors.first().filter(|_| is_product) {
            let message = format!(
                "the displacements of several bodies have names: write `{}`; those at the end of the step are called the \
                 same with `_next`",
                named_displacements(factors)
            );
            errors.push_decisive(factor.place, message);
        }
        return Vec::new();
    };
    if !is_product {
        errors.push_decisive(key.span(), "the displacements of one body are called `eta` and `eta_next`: remove this");
        return Vec::new();
    }
    if names.len() != factors.len() {
        let increments: Vec<String> = factors.iter().map(|factor| format!("`{}`", factor.name)).collect();
        let message = format!(
            "write `{}`: each of {} has a displacement, in this order",
            named_displacements(factors),
            increments.join(", ")
        );
        errors.push_decisive(key.span(), message);
    }
    names
}

/// The names of the velocities, one for each factor, or none.
pub(super) fn velocities(named: Option<(Ident, Vec<Ident>)>, factors: &[Factor], errors: &mut Errors) -> Vec<Ident> {
    let Some((key, names)) = named else { return Vec::new() };
    if names.len() != factors.len() {
        let increments: Vec<String> = factors.iter().map(|factor| format!("`{}`", factor.name)).collect();
        let message = match increments.as_slice() {
            [_] => "one group has one velocity: write `velocity = Omega`".to_owned(),
            several => format!(
                "write `{}`: each of {} has a velocity, in this order",
                named_velocities(factors),
                several.join(", ")
            ),
        };
        errors.push_decisive(key.span(), message);
    }
    names
}

/// Names the parts of a rigid motion's velocity, `velocity(Omega, v)`: the two become one velocity, and the Lagrangian
/// begins with a `let` for each part.
pub(super) fn parts_of_velocity(
    velocity: &mut Option<(Ident, Vec<Ident>)>,
    group: &str,
    root: Option<&Path>,
    lagrangian: &mut Option<(Ident, Expr)>,
) {
    let (Some((_, names)), Some((_, expression)), "SE3") = (velocity.as_mut(), lagrangian.as_mut(), group) else {
        return;
    };
    let [turn, shift] = names.as_slice() else { return };
    let span = turn.span();
    let whole = Ident::new(&format!("{}_{}", turn.unraw(), shift.unraw()), span);
    let root = root.map_or_else(|| quote_spanned!(span=> ::liestep), |root| quote_spanned!(span=> #root));
    let vector = quote_spanned!(span=> #root::__private::nalgebra::Vector3::new);
    let entries = |first: usize| (first..first + 3).map(Literal::usize_unsuffixed);
    let (of_turn, of_shift) = (entries(0), entries(3));
    let parts = syn::parse2(quote_spanned! {span=> {
        let #turn = #vector(#(#whole[#of_turn]),*);
        let #shift = #vector(#(#whole[#of_shift]),*);
        #expression
    }});
    if let Ok(parts) = parts {
        (*expression, *names) = (parts, vec![whole]);
    }
}
