//! Steps of a transformed time: `pace = s(w)`, with `dt = s dτ`.
//!
//! It is a rewriting of the declared expression, by `s̄ = (s(w) + s(F⁻¹·w))/2` and the energy `E_0` of the motion:
//!
//! ```text
//! l_d(F, w, h)    becomes    l_d(F, w, h s̄) + h s̄ E_0
//! l(ξ, w)         becomes    s (l(ξ/s, w) + E_0)
//! ```
//!
//! The second is Poincaré's `s (H − E_0)` as a Lagrangian, of which `discretise = trapezoid` makes steps. On the level zero of
//! its energy the curves are those of `l`. What comes out is a declaration like any other.

use proc_macro2::{Group, Span, TokenStream, TokenTree};
use quote::{ToTokens as _, quote_spanned};
use syn::Ident;
use syn::spanned::Spanned as _;

use super::arguments::Arguments;
use crate::declared::errors::Errors;
use crate::declared::{AdvectedParameter, Factor, Field, FieldKind, Quadrature};
use crate::mathematics::derive::Seen;
use crate::mathematics::group;

/// Rewrites the expression by the pace, if there is one, and returns the place of `E_0` in what is advected or given.
pub(super) fn rewritten(
    arguments: &mut Arguments,
    (group, factors): (&group::Group, &[Factor]),
    (fields, advected): (&[Field], &[AdvectedParameter]),
    errors: &mut Errors,
) -> Option<usize> {
    let (key, pace) = arguments.pace.take()?;
    let mut refused = |place: Span, message: &str| {
        errors.push_decisive(place, message);
        None
    };
    let pace = pace.into_token_stream();
    let of_step = factors.iter().map(|factor| factor.name.as_str()).chain(["h"]);
    let velocities = || arguments.velocity.iter().flat_map(|(_, names)| names);
    let of_step: Vec<String> = of_step.map(str::to_owned).chain(velocities().map(ToString::to_string)).collect();
    if let Some(found) = mention(&pace, &|name| of_step.iter().any(|known| name == known)) {
        return refused(
            found.span(),
            "the pace is a function of where the body is: neither a step nor a velocity is in it",
        );
    }
    let is_scalar = |w: &AdvectedParameter| w.field.is_some_and(|at| fields[at].kind == FieldKind::Scalar);
    let energy = advected.iter().position(|w| w.is_given && w.plain_name() == "E_0" && is_scalar(w));
    let Some(energy) = energy else {
        return refused(
            key.span(),
            "with a pace the energy of a motion is a number of its state: write `given(E_0 = energy)`, with a field `energy: f64`",
        );
    };
    let mut next = TokenStream::new();
    for w in advected.iter().filter(|w| !w.is_given) {
        let Some(name) = mention(&pace, &|name| *name == w.name) else { continue };
        let Some(moved) = moved(w, &name, (group, factors), fields) else {
            return refused(
                name.span(),
                "the pace depends on vectors, on bodies as another sees them, and on what is given",
            );
        };
        next.extend(quote_spanned!(name.span()=> let #name = #moved;));
    }
    // Names that nothing else has.
    let all = [arguments.expression.as_ref(), arguments.continuous.as_ref()].into_iter().flatten();
    let all: String = all.map(|(_, of)| of.to_token_stream().to_string()).collect::<String>() + &pace.to_string();
    let free =
        |name: &str| (0..).map(|more| name.to_owned() + &"_".repeat(more)).find(|name| !all.contains(name.as_str()));
    let [s, step] = ["pace", "h_paced"].map(|name| Ident::new(&free(name).unwrap_or_default(), key.span()));
    let span = pace.span();
    let energy_name = &advected[energy].name;
    if let Some((_, l_d)) = &mut arguments.expression {
        let in_time = renamed(l_d.to_token_stream(), &|name| (name == "h").then(|| step.to_token_stream()));
        *l_d = syn::parse2(quote_spanned! {span=> {
            let #s = 0.5 * ((#pace) + { #next #pace });
            let #step = h * #s;
            (#in_time) + #step * #energy_name
        }})
        .ok()?;
    }
    if let Some((_, l)) = &mut arguments.continuous {
        if arguments.discretisation.as_ref().is_none_or(|(_, asked)| asked.quadrature != Quadrature::Trapezoid) {
            return refused(
                key.span(),
                "a pace is that of steps, and of both their ends: write `discretise = trapezoid`",
            );
        }
        let names: Vec<&Ident> = velocities().collect();
        let in_time = renamed(l.to_token_stream(), &|name| {
            names.contains(&name).then(|| quote_spanned!(name.span()=> (#name / #s)))
        });
        *l = syn::parse2(quote_spanned! {span=> {
            let #s = #pace;
            #s * ((#in_time) + #energy_name)
        }})
        .ok()?;
    }
    Some(energy)
}

/// `F⁻¹·w`, where that is written shortly.
fn moved(
    w: &AdvectedParameter,
    name: &Ident,
    (group, factors): (&group::Group, &[Factor]),
    fields: &[Field],
) -> Option<TokenStream> {
    let span = name.span();
    let increment = |factor: usize| Ident::new(&factors[factor].name, span);
    let turned = |factor: usize| {
        let (own, increment) = (group.factor(factor), increment(factor));
        (!own.is_added).then(|| {
            if own.is_so3 {
                quote_spanned!(span=> #increment.transpose())
            } else {
                quote_spanned!(span=> inverse(#increment))
            }
        })
    };
    Some(match w.seen {
        Seen::From(factor) if matches!(fields.get(w.field?)?.kind, FieldKind::Vector(_)) => {
            let (_, increment) = (turned(factor)?, increment(factor));
            quote_spanned!(span=> #increment.transpose() * #name)
        }
        Seen::From(_) => return None,
        Seen::Configuration(of) | Seen::Relative { of, .. } => {
            let (is_added, of) = (group.factor(of).is_added, increment(of));
            let from = if let Seen::Relative { from, .. } = w.seen { Some(from) } else { None };
            match from {
                None if is_added => quote_spanned!(span=> #name + #of),
                None => quote_spanned!(span=> #name * #of),
                Some(from) if is_added => {
                    let from = increment(from);
                    quote_spanned!(span=> #name + #of - #from)
                }
                Some(from) => {
                    let from = turned(from)?;
                    quote_spanned!(span=> #from * #name * #of)
                }
            }
        }
    })
}

/// The first name among the tokens that is one of these.
fn mention(tokens: &TokenStream, is_one: &dyn Fn(&Ident) -> bool) -> Option<Ident> {
    tokens.clone().into_iter().find_map(|token| match token {
        TokenTree::Ident(name) => is_one(&name).then_some(name),
        TokenTree::Group(group) => mention(&group.stream(), is_one),
        _ => None,
    })
}

/// The tokens with others in the place of some names.
fn renamed(tokens: TokenStream, other: &dyn Fn(&Ident) -> Option<TokenStream>) -> TokenStream {
    let one = |token| match token {
        TokenTree::Ident(name) => other(&name).unwrap_or_else(|| name.into_token_stream()),
        TokenTree::Group(group) => {
            let mut inside = Group::new(group.delimiter(), renamed(group.stream(), other));
            inside.set_span(group.span());
            TokenTree::Group(inside).into()
        }
        token => token.into(),
    };
    tokens.into_iter().flat_map(one).collect()
}
