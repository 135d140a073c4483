//! The bodies of a constraint: two, with rotations and translations, over `f64`.

use syn::ItemStruct;

use crate::declared::errors::Errors;
use crate::declared::{Factor, Field, Scalar};

/// The groups of the body above, and of the body below.
const GROUPS: [&str; 4] = ["SO3", "R3", "SO3", "R3"];

/// Whether the bodies of a constraint are right; reports their mistakes.
pub(super) fn check(
    factors: &[Factor],
    fields: &[Field],
    scalar: &Scalar,
    item: &ItemStruct,
    errors: &mut Errors,
) -> bool {
    let names: Vec<String> = factors.iter().map(Factor::group_name).collect();
    if names != GROUPS {
        let wrong = names.iter().zip(GROUPS).position(|(found, wanted)| found != wanted);
        let factor = wrong.or(names.len().checked_sub(1)).and_then(|at| factors.get(at));
        let place = factor.and_then(|factor| factor.path.as_ref()).map(syn::spanned::Spanned::span);
        let message = "a constraint is on two bodies, that above, which may be space, and that below: write \
                       `group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3)`";
        errors.push_decisive(place.unwrap_or_else(proc_macro2::Span::call_site), message);
    }
    for field in fields.iter().filter(|field| field.kind.is_wrapped()) {
        let message = format!("in a constraint `{}` is a Vector3<f64> or a Matrix3<f64>", field.plain_name());
        errors.push_decisive(field.at, message);
    }
    if !matches!(scalar, Scalar::Primitive(name) if name == "f64") {
        let place = fields.first().map_or(item.ident.span(), |field| field.at);
        errors.push_decisive(place, "joints are over `f64`: make that the scalar of the fields");
    }
    names == GROUPS
}
