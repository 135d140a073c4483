//! Every declared name must be used: a forgotten name is a forgotten force.

use syn::Ident;

use crate::declared::errors::Errors;
use crate::declared::{Declaration, Name, Role};
use crate::mathematics::derive::View;

pub(super) fn check(declaration: &Declaration, used: &[Name], errors: &mut Errors) {
    if declaration.role == Role::Force {
        let is_displacement = |name: &Name| matches!(name, Name::DisplacementBefore(_) | Name::DisplacementAfter(_));
        if !used.iter().any(is_displacement) {
            errors.push_over(declaration.expression.as_ref().map(super::value), displacement_is_needed(declaration));
        }
        check_names(declaration, used, errors);
        return;
    }
    if declaration.role == Role::Constraint {
        check_names(declaration, used, errors);
        return;
    }
    if declaration.role == Role::Nonholonomic {
        if !used.iter().any(|name| matches!(name, Name::Velocity(_))) {
            let name = declaration.velocity_or_omega(0);
            let example = declaration.product_with_velocity();
            let message = format!(
                "the constraint depends on no velocity, which `velocity = {name}` names: it is linear in one, as {example} is"
            );
            errors.push_over(declaration.expression.as_ref().map(super::value), message);
        }
        check_names(declaration, used, errors);
        return;
    }
    if declaration.continuous.is_some() {
        let unused = |(factor, _): &(usize, &Ident)| !used.contains(&Name::Velocity(*factor));
        let unused: Vec<&Ident> =
            declaration.velocities().iter().enumerate().filter(unused).map(|(_, name)| name).collect();
        // A potential alone is a term to be added to others, whose velocity may have its name here.
        let is_potential =
            unused.len() == declaration.velocities().len() && used.iter().any(|name| matches!(name, Name::Advected(_)));
        if !unused.is_empty() && !is_potential {
            for velocity in unused {
                let message = if declaration.group.is_product() {
                    forgotten(&velocity.to_string())
                } else {
                    format!("`{velocity}` isn't used in the Lagrangian: remove `velocity = {velocity}`, or use it")
                };
                errors.push(velocity.span(), message);
            }
        } else if !is_potential && !used.iter().any(|name| matches!(name, Name::Velocity(_) | Name::Advected(_))) {
            errors.push_over(
                declaration.expression.as_ref().map(super::value),
                "the Lagrangian depends on no velocity, which `velocity = Omega` names, and on nothing advected: nothing \
                 would move",
            );
        }
        check_names(declaration, used, errors);
        return;
    }
    // A potential at the beginning of a step has no `F`, and is a force all the same.
    if !used.iter().any(|name| matches!(name, Name::Increment(_) | Name::Advected(_))) {
        let name = declaration.factors.first().map_or("F", |factor| &factor.name);
        let message = format!("the Lagrangian doesn't depend on `{name}`, the increment of a step: nothing would move");
        errors.push_over(declaration.expression.as_ref().map(super::value), message);
    }
    if declaration.group.is_product() {
        for (index, factor) in declaration.factors.iter().enumerate() {
            if !used.contains(&Name::Increment(index)) {
                errors.push(factor.place, forgotten(&factor.name));
            }
        }
    }
    check_names(declaration, used, errors);
}

/// The message for virtual work without a displacement.
fn displacement_is_needed(declaration: &Declaration) -> String {
    let pairs: Vec<_> = (0..declaration.factors.len()).filter_map(|factor| declaration.displacement(factor)).collect();
    let [before, after] =
        [0, 1].map(|end| pairs.iter().map(|pair| format!("`{}`", pair[end])).collect::<Vec<_>>().join(" or "));
    format!("virtual work needs a displacement: {before} at the beginning of the step, {after} at its end")
}

/// The message for an unused increment or velocity of several.
fn forgotten(name: &str) -> String {
    format!("the Lagrangian doesn't depend on `{name}`: leave its factor out, or add its kinetic part")
}

fn check_names(declaration: &Declaration, used: &[Name], errors: &mut Errors) {
    let the = declaration.role.definite();
    for (index, w) in declaration.advected.iter().enumerate() {
        if !used.contains(&Name::Advected(index)) {
            let (name, list) = (w.plain_name(), if w.is_given { "given" } else { "advected" });
            let consequence = match w.seen {
                View::Relative { .. } if declaration.role != Role::Constraint => {
                    "; without it these bodies don't feel each other, and each may be a declaration of its own"
                }
                _ => "",
            };
            let message = format!("`{name}` isn't used in {the}: remove it from `{list}(…)`{consequence}");
            errors.push(w.name.span(), message);
        }
    }
    for (index, field) in declaration.fields.iter().enumerate() {
        let carried = declaration.advected.iter().any(|w| w.field == Some(index));
        if field.kind.is_wrapped() && !carried {
            let name = field.plain_name();
            errors.push(
                field.name.span(),
                format!("the type of `{name}` is for what the group carries: declare it with `advected(w = {name})`"),
            );
        } else if !carried && !used.contains(&Name::Field(index)) {
            let name = field.plain_name();
            errors.push(field.name.span(), format!("`{name}` isn't used in {the}: remove the field, or use it"));
        }
    }
}
