//! Steps of a transformed time: `pace = s(w)`, with `dt = s dτ`.
//!
//! The declared expression is rewritten by `s̄ = (s(w) + s(F⁻¹·w))/2` and the energy `E_0` of the motion:
//!
//! ```text
//! l_d(F, w, h)    becomes    l_d(F, w, h s̄) + h s̄ E_0
//! l(ξ, w)         becomes    s (l(ξ/s, w) + E_0)
//! ```
//!
//! The second is Poincaré's `s (H − E_0)` as a Lagrangian, which `discretise = trapezoid` turns into steps. On the
//! level zero of its energy the curves are those of `l`. The result is a declaration like any other.

use proc_macro2::{Group, TokenStream, TokenTree};
use quote::{ToTokens as _, quote_spanned};
use syn::Ident;
use syn::spanned::Spanned as _;

use super::arguments::Arguments;
use crate::declared::errors::Errors;
use crate::declared::{AdvectedParameter, Discretisation, Factor, Field, FieldKind, Quadrature};
use crate::mathematics::derive::View;
use crate::mathematics::group;

/// Rewrites the expression by the pace, if there is one, and returns the index of `E_0` among the parameters.
pub(super) fn rewritten(
    arguments: &mut Arguments,
    (group, factors): (&group::Group, &[Factor]),
    (fields, advected): (&[Field], &[AdvectedParameter]),
    errors: &mut Errors,
) -> Option<usize> {
    let (key, pace) = arguments.pace.take()?;
    let mut refused = |place: &Ident, message: &str| {
        errors.push_decisive(place.span(), message);
        None
    };
    let pace = pace.into_token_stream();
    let velocities: Vec<Ident> = arguments.velocity.iter().flat_map(|(_, names)| names.clone()).collect();
    let is_of_step =
        |name: &Ident| name == "h" || velocities.contains(name) || factors.iter().any(|factor| *name == factor.name);
    if let Some(found) = mention(&pace, &is_of_step) {
        return refused(&found, "the pace is a function of where the body is: neither a step nor a velocity is in it");
    }
    let is_scalar = |w: &AdvectedParameter| w.field.is_some_and(|at| fields[at].kind == FieldKind::Scalar);
    let energy = advected.iter().position(|w| w.is_given && w.plain_name() == "E_0" && is_scalar(w));
    let Some(energy) = energy else {
        let message = "with a pace the energy of a motion is a number of its state: write `given(E_0 = energy)`, with a \
                       field `energy: f64`";
        return refused(&key, message);
    };
    let is_trapezoid = |asked: &Discretisation| asked.quadrature == Quadrature::Trapezoid;
    let has_both_ends = arguments.discretisation.as_ref().is_some_and(|(_, asked)| is_trapezoid(asked));
    if arguments.continuous.is_some() && !has_both_ends {
        return refused(&key, "a pace is that of steps, and of both their ends: write `discretise = trapezoid`");
    }
    let mut next = TokenStream::new();
    for w in advected.iter().filter(|w| !w.is_given) {
        let Some(name) = mention(&pace, &|name| *name == w.name) else { continue };
        let Some(moved) = moved(w, &name, (group, factors), fields) else {
            return refused(&name, "the pace depends on vectors, on bodies as another sees them, and on what is given");
        };
        next.extend(quote_spanned!(name.span()=> let #name = #moved;));
    }
    let expressions = [&mut arguments.expression, &mut arguments.continuous].map(Option::as_mut);
    for (_, expression) in expressions.into_iter().flatten() {
        let declared = expression.to_token_stream();
        let is_taken = |name: &Ident| name == "pace" || name == "h_paced";
        if let Some(found) = mention(&pace, &is_taken).or_else(|| mention(&declared, &is_taken)) {
            return refused(&found, "beside a pace `pace` and `h_paced` have a meaning: choose another name");
        }
        let (span, energy) = (pace.span(), &advected[energy].name);
        let [s, step] = ["pace", "h_paced"].map(|name| Ident::new(name, key.span()));
        let in_time = renamed(declared, &|name| {
            let slower = quote_spanned!(name.span()=> (#name / #s));
            if name == "h" { Some(step.to_token_stream()) } else { velocities.contains(name).then_some(slower) }
        });
        let rewritten = if has_both_ends {
            quote_spanned!(span=> { let #s = #pace; #s * ((#in_time) + #energy) })
        } else {
            quote_spanned! {span=> {
                let #s = 0.5 * ((#pace) + { #next #pace });
                let #step = h * #s;
                (#in_time) + #step * #energy
            }}
        };
        match syn::parse2(rewritten) {
            Ok(rewritten) => *expression = rewritten,
            Err(error) => return refused(&key, &error.to_string()),
        }
    }
    Some(energy)
}

/// `F⁻¹·w`, unless `w` is a tensor or a point. Among several bodies only rotations move fields.
fn moved(
    w: &AdvectedParameter,
    name: &Ident,
    (group, factors): (&group::Group, &[Factor]),
    fields: &[Field],
) -> Option<TokenStream> {
    let span = name.span();
    let increment = |factor: usize| Ident::new(&factors[factor].name, span);
    Some(match w.seen {
        View::From(factor) => {
            let (own, field) = (increment(factor), fields.get(w.field?)?);
            matches!(field.kind, FieldKind::Vector(_)).then(|| quote_spanned!(span=> #own.transpose() * #name))?
        }
        View::Configuration(of) if group.factor(of).is_added => {
            let of = increment(of);
            quote_spanned!(span=> #name + #of)
        }
        View::Configuration(of) => {
            let of = increment(of);
            quote_spanned!(span=> #name * #of)
        }
        View::Relative { of, from } => {
            let (is_added, of, from) = (group.factor(of).is_added, increment(of), increment(from));
            let turned = quote_spanned!(span=> #from.transpose() * #name * #of);
            if is_added { quote_spanned!(span=> #name + #of - #from) } else { turned }
        }
    })
}

/// The first name among the tokens that satisfies the condition.
fn mention(tokens: &TokenStream, is_one: &dyn Fn(&Ident) -> bool) -> Option<Ident> {
    tokens.clone().into_iter().find_map(|token| match token {
        TokenTree::Ident(name) => is_one(&name).then_some(name),
        TokenTree::Group(group) => mention(&group.stream(), is_one),
        _ => None,
    })
}

/// The tokens with some names replaced.
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
