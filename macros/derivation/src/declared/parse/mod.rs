//! The attribute's arguments and the struct's fields.

mod arguments;
mod fields;
mod generators;
mod group;
mod names;
mod own_group;
mod pace;
mod size;
mod two_bodies;

use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};
use quote::ToTokens as _;
use syn::ext::IdentExt as _;
use syn::parse::{ParseStream, Parser as _};
use syn::{Expr, Fields, Ident, Item, ItemStruct, Path, braced};

use crate::declared::errors::{Errors, suggestion};
use crate::declared::{
    AdvectedParameter, Continuous, Coordinates, Declaration, Discretisation, Factor, Field, FieldKind, Quadrature, Role,
};
use crate::mathematics::derive::View;
use crate::mathematics::group::Group;
use arguments::{Arguments, Source, arguments_from};
use fields::{points, scalar, vector_type};
use generators::places;
use names::{check_names, displacements, velocities};

pub use fields::{field_kind, scalar_of};
pub use own_group::{OwnGroup, Request, asked, name_of_own_group, own_group};

/// The declaration, with its mistakes reported; `None` if nothing of it can be read.
pub fn declaration(
    role: Role,
    arguments: &TokenStream,
    item: &TokenStream,
    errors: &mut Errors,
) -> Option<Declaration> {
    let item = annotated(role, item, errors)?;
    size::check(role.definite(), arguments, errors)?;
    Some(as_far_as_readable(role, arguments.clone(), item, errors))
}

/// The role, the arguments and the struct of a text with both, `#[lagrangian(…)] struct Top { … }`.
pub fn attribute_and_item(text: &TokenStream, errors: &mut Errors) -> Option<(Role, TokenStream, TokenStream)> {
    size::check("the declaration", text, errors)?;
    let mut item: ItemStruct = syn::parse2(text.clone()).map_err(|error| errors.extend(error)).ok()?;
    let role = |attribute: &syn::Attribute| match attribute.path().segments.last()?.ident.to_string().as_str() {
        "lagrangian" => Some(Role::Lagrangian),
        "force" => Some(Role::Force),
        "nonholonomic" => Some(Role::Nonholonomic),
        "hamiltonian" => Some(Role::Hamiltonian),
        _ => None,
    };
    let found = item.attrs.iter().enumerate().find_map(|(at, attribute)| Some((at, role(attribute)?)));
    let Some((at, role)) = found else {
        errors.push(
            item.ident.span(),
            "a declaration is a struct with `#[lagrangian(…)]`, `#[force(…)]` or `#[nonholonomic(…)]`",
        );
        return None;
    };
    let attribute = item.attrs.remove(at);
    let arguments = attribute.meta.require_list().map_err(|error| errors.extend(error)).ok()?.tokens.clone();
    Some((role, arguments, item.to_token_stream()))
}

/// The limit on parameters: the tuples of the run-time half have no more entries.
const MOST_ADVECTED: usize = 6;

/// The annotated struct.
fn annotated(role: Role, item: &TokenStream, errors: &mut Errors) -> Option<ItemStruct> {
    let item: ItemStruct = match syn::parse2(item.clone()) {
        Ok(item) => item,
        Err(error) => {
            // The compiler has already reported a text that is no item.
            if syn::parse2::<Item>(item.clone()).is_ok() {
                errors.push(error.span(), format!("`{}` belongs on a struct with named fields", role.attribute()));
            }
            return None;
        }
    };
    if let Some(again) = declared_again(&item) {
        errors.push_over(
            again,
            "this struct is declared twice: give each declaration a struct of its own, and add them, `a + b`",
        );
        return None;
    }
    Some(item)
}

/// A second attribute of ours, by the path that it is written with.
pub fn declared_again(item: &ItemStruct) -> Option<&Path> {
    item.attrs.iter().map(syn::Attribute::path).find(|path| {
        let is_ours = path.segments.len() == 1 || path.segments.first().is_some_and(|first| first.ident == "liestep");
        is_ours
            && path.segments.last().is_some_and(|last| {
                ["lagrangian", "force", "constraint", "nonholonomic"].iter().any(|name| last.ident == name)
            })
    })
}

/// The declaration as far as it can be read.
pub fn as_far_as_readable(role: Role, arguments: TokenStream, item: ItemStruct, errors: &mut Errors) -> Declaration {
    let mut arguments = read_arguments(role, arguments, errors);
    // An argument that seems to be missing may be one that couldn't be read.
    let is_readable = errors.is_empty();
    let (group_path, group, factors) = groups(&mut arguments, is_readable, errors);
    let generators = places(&group, &factors, arguments.generators.as_ref());
    if let [Factor { path: Some(_), .. }] = factors.as_slice() {
        let (velocity, l, name) = (&mut arguments.velocity, &mut arguments.continuous, factors[0].group_name());
        names::parts_of_velocity(velocity, &name, arguments.root.as_ref(), l);
    }
    if arguments.expression.is_none() && arguments.continuous.is_none() && is_readable {
        errors.push(Span::call_site(), missing(role));
    }
    let (mut fields, unreadable) = fields::fields((role, group.is_product()), &item, errors);
    if errors.is_empty() {
        points(&mut fields, &group, errors);
    }
    let scalar = scalar(&item, errors);
    let is_of_bodies =
        role != Role::Constraint || !errors.is_empty() || two_bodies::check(&factors, &fields, &scalar, &item, errors);
    let taken = group::TakenNames {
        fields: fields.iter().map(Field::plain_name).chain(unreadable.iter().cloned()).collect(),
        advected: arguments.advected.iter().map(|(name, ..)| name.unraw().to_string()).collect(),
        velocities: arguments
            .velocity
            .iter()
            .chain(&arguments.displacement)
            .flat_map(|(_, names)| names)
            .map(|name| name.unraw().to_string())
            .collect(),
    };
    group::check_increments(role, &factors, &taken, errors);
    let advected = advected(
        role,
        &arguments.advected,
        &fields,
        &unreadable,
        group_path.as_ref().filter(|_| is_of_bodies).map(|_| (&group, factors.as_slice())),
        errors,
    );
    let displacements = match role {
        Role::Force if errors.is_empty() => {
            displacements(arguments.displacement.take(), (&factors, group.is_product()), errors)
        }
        _ => Vec::new(),
    };
    // A repeated name is reported once, and not a second time for the end of the step.
    let is_first = |&(at, name): &(usize, &Ident)| !displacements[..at].contains(name);
    let next = |(_, name): (usize, &Ident)| Ident::new(&format!("{}_next", name.unraw()), name.span());
    let ends = displacements.iter().enumerate().filter(is_first).map(next);
    let both: Vec<Ident> = displacements.iter().cloned().chain(ends).collect();
    check_names((role, group.is_product()), &both, "a displacement", (&fields, &advected), errors);
    let energy = pace::rewritten(&mut arguments, (&group, &factors), (&fields, &advected), errors);
    let (expression, continuous) = kind(role, &mut arguments, (&fields, &advected, &factors), errors);
    let has_names = matches!(item.fields, Fields::Named(_));
    let has_meaning = is_readable && has_names && group_path.is_some() && !errors.hides_the_rest();
    Declaration {
        role,
        root: arguments.root,
        group,
        generators,
        factors,
        advected,
        expression: expression.filter(|_| has_meaning),
        continuous,
        energy,
        displacements,
        gradients: arguments.gradients.map(|key| key.span()),
        fields,
        unreadable,
        scalar,
        is_text: false,
        item,
    }
}

fn read_arguments(role: Role, arguments: TokenStream, errors: &mut Errors) -> Arguments {
    // The braces have the span of the last token, so that an unexpected end is reported there.
    let last = arguments.clone().into_iter().last().map_or(Span::call_site(), |token| token.span());
    let mut braces = proc_macro2::Group::new(Delimiter::Brace, arguments);
    braces.set_span(last);
    let parser = |input: ParseStream| {
        let content;
        braced!(content in input);
        Ok(arguments_from(role, &content, errors))
    };
    parser.parse2(TokenTree::Group(braces).into()).unwrap_or_else(|error| {
        // The tokens behind a mistake aren't another one.
        if errors.is_empty() {
            errors.extend(error);
        }
        Arguments::default()
    })
}

/// The path of the group, if known, the group, and its factors.
fn groups(arguments: &mut Arguments, is_readable: bool, errors: &mut Errors) -> (Option<Path>, Group, Vec<Factor>) {
    let named = std::mem::take(&mut arguments.factors);
    // A translation that is named is a vector, alone as beside others.
    if named.len() > 1 || named.iter().any(|(_, group)| group.is_translation()) {
        let (factors, group) = group::product(named, arguments.generators.as_ref(), errors);
        (factors.first().and_then(|factor| factor.path.clone()), group, factors)
    } else {
        let single = named.into_iter().next();
        let name = single.as_ref().map_or_else(|| "F".to_owned(), |(name, _)| name.unraw().to_string());
        let place = single.as_ref().map_or_else(Span::call_site, |(name, _)| name.span());
        let named = arguments.group.take().or(single.map(|(_, named)| named));
        let (path, group) = group::group(named, arguments.generators.as_ref(), is_readable, errors);
        (path.clone(), group, vec![Factor { name, place, path }])
    }
}

/// The message for a missing expression.
fn missing(role: Role) -> &'static str {
    match role {
        Role::Lagrangian => {
            "the Lagrangian is missing: write `l_d = …` with an expression in `F` and `h`, or `velocity = Omega, \
             l = …` with one in `Omega`"
        }
        Role::Force => "the virtual work is missing: write `work = …`, linear in `eta` and `eta_next`",
        Role::Constraint => "the constraint is missing: write `zero = …`, a function of where two bodies are",
        Role::Hamiltonian => "the Hamiltonian is missing: write `momentum = mu, h = …` with one in `mu`",
        Role::Nonholonomic => "the constraint is missing: write `velocity = Omega, zero = …`, linear in `Omega`",
    }
}

/// The expression, and the arguments of a continuous one.
fn kind(
    role: Role,
    arguments: &mut Arguments,
    (fields, advected, factors): (&[Field], &[AdvectedParameter], &[Factor]),
    errors: &mut Errors,
) -> (Option<Expr>, Option<Continuous>) {
    let (velocity, discretisation) = (arguments.velocity.take(), arguments.discretisation.take());
    let Some((key, l)) = arguments.continuous.take() else {
        if let Some((key, names)) = velocity.filter(|_| role == Role::Lagrangian) {
            let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
            let message = format!(
                "`velocity` belongs to a continuous Lagrangian `l = …`; in `l_d` the velocity of a step is in `F`: remove \
                 it, or write `l = …` in {}",
                names.join(", ")
            );
            errors.push_decisive(key.span(), message);
        }
        if let Some((key, _)) = discretisation {
            let message = "`discretise` makes `l_d` of a continuous Lagrangian `l = …`, which isn't given: remove it, or \
                           write `l = …` in place of `l_d = …`";
            errors.push_decisive(key.span(), message);
        }
        return (arguments.expression.take().map(|(_, expression)| expression), None);
    };
    if let Some((l_d, _)) = &arguments.expression {
        let message =
            "`l` and `l_d` are two Lagrangians: remove `l_d`, which `discretise = …` makes of `l`, or remove `l`";
        errors.push_decisive(l_d.span(), message);
        errors.push(key.span(), "`l` is given here");
    }
    let velocities = velocities(velocity, factors, errors);
    check_names((role, factors.len() > 1), &velocities, "a velocity", (fields, advected), errors);
    let discretisation = discretisation.map(|(_, discretisation)| discretisation);
    if let Some(Discretisation { quadrature: Quadrature::Midpoint, coordinates, place }) = discretisation
        && coordinates != Coordinates::Exponential
    {
        let message = match coordinates {
            Coordinates::Cayley => {
                "the midpoint of a Cayley curve isn't its own adjoint, as cay(x/2)² isn't cay(x): a step of −h wouldn't \
                 undo a step of h; write `chord(Cayley)`, or `midpoint(exp)`"
            }
            _ => "`(F - I) / h` has no midpoint in the group: write `midpoint(exp)`, or `chord`",
        };
        errors.push_between(place, message);
    }
    (Some(l), Some(Continuous { velocities, discretisation }))
}

fn advected(
    role: Role,
    pairs: &[(Ident, Source, bool)],
    fields: &[Field],
    unreadable: &[String],
    group: Option<(&Group, &[Factor])>,
    errors: &mut Errors,
) -> Vec<AdvectedParameter> {
    let mut parameters: Vec<AdvectedParameter> = Vec::new();
    for &(ref name, ref source, is_given) in pairs {
        let unraw = name.unraw().to_string();
        let field_names: Vec<String> = fields.iter().map(Field::plain_name).collect();
        let names: Vec<String> = field_names.iter().chain(unreadable).cloned().collect();
        let Some(moved) = seen((name, source), is_given, (&names, group), errors) else {
            // The name is known even after a mistake, so that it isn't reported again.
            parameters.push(AdvectedParameter { name: name.clone(), field: None, is_given, seen: View::From(0) });
            continue;
        };
        if field_names.contains(&unraw) {
            errors.push_decisive(name.span(), format!("`{unraw}` is a field already: choose another name"));
            continue;
        }
        check_free((role, group.is_some_and(|(group, _)| group.is_product())), name, errors);
        if parameters.len() == MOST_ADVECTED {
            let message = format!(
                "at most {MOST_ADVECTED} are advected or given: declare the rest in a term of its own, and add it"
            );
            errors.push_decisive(name.span(), message);
            break;
        }
        if parameters.iter().any(|other| other.name == *name) {
            errors.push(name.span(), format!("`{unraw}` is declared twice: remove one"));
            continue;
        }
        let (field, seen) = match moved {
            MovedParameter::Field(field, seen) => (field, seen),
            MovedParameter::Body(seen) => {
                parameters.push(AdvectedParameter { name: name.clone(), field: None, is_given, seen });
                continue;
            }
        };
        let wanted = field.unraw().to_string();
        let index = field_names.iter().position(|known| *known == wanted);
        if index.is_none() && !unreadable.contains(&wanted) {
            let message = no_field(name, source, &field_names, group);
            match source {
                Source::Field(_) => errors.push(field.span(), message),
                // The source may have been meant as a body instead of a vector.
                Source::View { .. } => errors.push_decisive(field.span(), message),
            }
        }
        if let Some(found) = index.and_then(|index| fields.get(index)).filter(|_| is_given) {
            if !found.kind.can_be_given() {
                let message =
                    format!("a step is given numbers: make `{wanted}` an f64, a Vector3<f64> or a Matrix3<f64>");
                errors.push_decisive(found.at, message);
            }
        } else if let (Some(found), Some((group, _))) = (index.and_then(|index| fields.get(index)), group)
            && let View::From(factor) = seen
            && let size = group.factor(factor).size
            && !found.kind.is_carried_by(size)
            && !matches!(found.kind, FieldKind::Point(_))
        {
            let message = not_carried(&wanted, found.kind, group.factor(factor), size);
            errors.push_decisive(found.at, message);
        }
        parameters.push(AdvectedParameter { name: name.clone(), field: index, is_given, seen });
    }
    parameters
}

/// The message for a field of this kind, which a group with matrices of that size doesn't move.
fn not_carried(wanted: &str, kind: FieldKind, group: &Group, size: usize) -> String {
    let shape = kind.shape().describe();
    if kind.is_wrapped() {
        return format!("`{wanted}` is {shape}, but the group's matrices have {size} rows: write {size} for its size");
    }
    let point = match kind {
        FieldKind::Vector(rows @ 1..=3) if group.is_affine() && rows + 1 == size => {
            format!(", or Point{rows}<f64> for a point")
        }
        _ => String::new(),
    };
    let vector = vector_type(size);
    format!("`{wanted}` is {shape}, but the group carries a vector of {size}: use {vector}{point}")
}

/// The message for the source of an advected parameter that is no field.
fn no_field(name: &Ident, source: &Source, fields: &[String], group: Option<(&Group, &[Factor])>) -> String {
    let (Source::Field(wanted) | Source::View { what: wanted, .. }) = source;
    let wanted = wanted.unraw().to_string();
    let bodies: Vec<&str> = match (source, group) {
        (Source::View { .. }, Some((group, factors))) if group.is_product() => {
            factors.iter().map(|factor| factor.name.as_str()).collect()
        }
        _ => Vec::new(),
    };
    let near = suggestion(&wanted, fields.iter().map(String::as_str).chain(bodies.iter().copied()));
    match (source, bodies.as_slice()) {
        (Source::View { from, .. }, _) if wanted == "space" => format!(
            "`space` is no body, and is seen the other way round: `{name} = {from}.seen_from(space)`, and \
             `{name}.transpose()` for its inverse"
        ),
        (_, []) => format!("the struct has no field `{wanted}`{near}"),
        (_, bodies) if near.is_empty() => {
            let names: Vec<String> = bodies.iter().map(|name| format!("`{name}`")).collect();
            format!(
                "`{wanted}` is neither a field of the struct nor the increment of a body: those are {}",
                names.join(", ")
            )
        }
        _ => format!("`{wanted}` is neither a field of the struct nor the increment of a body{near}"),
    }
}

/// The message with the bodies that may see a field, and with the position of a translated body, which may be meant.
fn seers((name, field): (&Ident, &Ident), group: Option<&Group>, factors: &[Factor]) -> String {
    let is_added = |at: &usize| group.is_some_and(|group| group.factor(*at).is_added);
    let turning = (0..factors.len()).filter(|at| !is_added(at));
    let seers: Vec<_> = turning.map(|at| format!("`{field}.seen_from({})`", factors[at].name)).collect();
    if seers.is_empty() {
        return format!("a translation doesn't move a vector: use the field `{field}` itself");
    }
    let place = |factor: &str| format!("; where `{factor}` has come to is `{name} = {factor}.seen_from(space)`");
    let place = (0..factors.len()).find(is_added).map(|at| place(&factors[at].name)).unwrap_or_default();
    format!("who sees `{field}`? write {}{place}", seers.join(" or "))
}

/// The source of an advected parameter, and the bodies that move it.
enum MovedParameter<'a> {
    Field(&'a Ident, View),
    Body(View),
}

/// The checked source of an advected parameter; `None` after a mistake.
fn seen<'a>(
    (name, source): (&Ident, &'a Source),
    is_given: bool,
    (fields, group): (&[String], Option<(&Group, &[Factor])>),
    errors: &mut Errors,
) -> Option<MovedParameter<'a>> {
    let factors = group.map_or(&[][..], |(_, factors)| factors);
    let place = |name: &Ident| factors.iter().position(|factor| name.unraw() == factor.name);
    match source {
        Source::Field(field) if group.is_some_and(|(group, _)| group.is_product()) && !is_given => {
            errors.push_decisive(field.span(), seers((name, field), group.map(|(group, _)| group), factors));
            None
        }
        Source::Field(field) => Some(MovedParameter::Field(field, View::From(0))),
        Source::View { what, .. } if is_given => {
            errors.push_decisive(what.span(), format!("what is given is seen as it is: write `{what}`"));
            None
        }
        // The increments couldn't be read.
        Source::View { .. } if group.is_none() => None,
        Source::View { what, from } => {
            let seer = if *from == "space" { None } else { Some(place(from)) };
            if seer == Some(None) {
                let known: Vec<String> = factors.iter().map(|factor| format!("`{}`", factor.name)).collect();
                let message =
                    format!("`{from}` isn't the increment of a body: write one of {}, or `space`", known.join(", "));
                errors.push_decisive(from.span(), message);
                return None;
            }
            match (place(what), seer.flatten()) {
                (Some(of), Some(own)) if of == own => {
                    let message = format!("`{what}` sees itself where it is: name two bodies, or write `space`");
                    errors.push_decisive(what.span(), message);
                    None
                }
                (Some(of), Some(own)) if !are_alike(group, of, own) => {
                    let moves_by = |factor: usize| group.map(|(_, factors)| factors[factor].group_name());
                    let [of_name, from_name] = [of, own].map(|factor| moves_by(factor).unwrap_or_default());
                    let message = format!(
                        "`{what}` moves by {of_name} and `{from}` by {from_name}: only factors of one group have a \
                         relative configuration; for that of `{what}` itself write `{what}.seen_from(space)`"
                    );
                    errors.push_decisive(from.span(), message);
                    None
                }
                (Some(of), Some(from)) => Some(MovedParameter::Body(View::Relative { of, from })),
                (Some(of), None) => Some(MovedParameter::Body(View::Configuration(of))),
                (None, Some(factor)) if group.is_some_and(|(group, _)| group.factor(factor).is_added) => {
                    let message = format!(
                        "a translation doesn't move a vector: use the field `{what}` itself; how far a point is from \
                         the body is `{what} - x` with `x = {from}.seen_from(space)`"
                    );
                    errors.push_decisive(from.span(), message);
                    None
                }
                (None, Some(factor)) => Some(MovedParameter::Field(what, View::From(factor))),
                (None, None) if !fields.contains(&what.unraw().to_string()) => {
                    errors.push_decisive(what.span(), no_field(name, source, fields, group));
                    None
                }
                (None, None) => {
                    let message = format!("seen from space `{what}` doesn't change: use the field itself, `{what}`");
                    errors.push_decisive(what.span(), message);
                    None
                }
            }
        }
    }
}

/// Whether two factors have one group.
fn are_alike(group: Option<(&Group, &[Factor])>, a: usize, b: usize) -> bool {
    group.is_none_or(|(group, _)| group.factor(a).generators == group.factor(b).generators)
}

/// Reports a parameter whose name means something else.
fn check_free((role, is_product): (Role, bool), name: &Ident, errors: &mut Errors) {
    let (unraw, the) = (name.unraw().to_string(), role.definite());
    if role.reserved(is_product).contains(&unraw.as_str()) {
        errors.push_decisive(name.span(), format!("`{unraw}` already has a meaning in {the}: choose another name"));
    }
}
