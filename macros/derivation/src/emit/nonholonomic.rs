//! The implementation of `Nonholonomic`.
//!
//! A constraint `c(ξ, w) = A(w)·ξ` is derived as a Lagrangian that is linear in the velocity. The bias of its limit is the
//! covector `A(w)` of the reaction. Its discretisation `l_d(F, w) = h c` is zero in each step, and the slope of that, by
//! which Newton's iteration goes, is the right momentum.

use proc_macro2::{Span, TokenStream};
use quote::quote_spanned;

use super::{Emitter, declared_text, docs, page, stages, verbatim};
use crate::declared::Declaration;
use crate::judged::{Choice, Findings};
use crate::mathematics::symbolic::{covector_text, text};
use crate::program::Form;

/// The quantities that a scene with the constraint doesn't conserve.
const NOT_KEPT: &str = "a step isn't symplectic; the energy is kept nearly, without the proof that a Poisson map has; \
                        momenta are kept along directions that satisfy the constraint";

/// The item with its implementation.
pub(super) fn implementation(
    emitter: &Emitter,
    [arguments, item]: [&TokenStream; 2],
    findings: &Findings,
) -> TokenStream {
    let (span, d, header) = (Span::mixed_site(), emitter.derived, emitter.header);
    let (declaration, private) = (emitter.declaration, &header.private);
    let (matrix, vector, square, scalar) = (header.matrix(), header.vector(), header.square(), &header.scalar);
    let term =
        |name, form, expression| emitter.method(name, form, &emitter.kernel.beginning.term(d, form, expression), &[]);
    let declared = verbatim::declared(declaration, header);
    let at_increment = term("at_increment", Form::Scalar, &emitter.lowered.declared.expression);
    let slope = term("slope", Form::Vector, &d.right_momentum);
    let reaction = reaction(emitter);
    let text = text_of(declaration, emitter.lowered, d, findings);
    let (derivation, declared_text) = (super::derivation(header, &text), declared_text(header, declaration, arguments));
    let item = page::documented(item, &format!("# Derived constraint\n\n```text\n{text}```\n"));
    let core = quote_spanned!(span=> #private::core);
    let nothing = quote_spanned!(span=> ());
    let types = header.types("WithoutKinetic", &nothing, &nothing);
    let [of_constraint, of_effect] = ["Nonholonomic", "Effect"].map(|name| header.implementation(name));
    let (describe, addition) = (emitter.describe(), header.addition());
    let of_term = emitter.term(&stages::same_generators(&emitter.code));
    let lanes = super::lanes::lanes(header, Some(&declaration.fields));
    let found = findings.self_adjointness.is_found();
    let zero = quote_spanned!(span=> <#vector as #private::Coordinates<#scalar>>::zero());
    let zeros = quote_spanned!(span=> <#vector as #private::Coordinates<#scalar>>::square(|_| #zero));
    let implementations = quote_spanned! {span=>
        #of_term

        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic, clippy::nursery, non_snake_case, unused_variables)]
        #of_constraint {
            #declared
            #at_increment
            #slope
            #reaction
        }

        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic, clippy::nursery, non_snake_case, unused_variables)]
        #of_effect {
            #types
            const FACTS: #private::Facts = #private::Facts { is_self_adjoint: #found, ..#private::Facts::OF_A_CONSTRAINT };

            #derivation
            #declared_text
            #describe

            fn momentum_jacobian(&self, _: &#matrix, _: &Self::Advected, _: #scalar) -> #square { #zeros }
            fn limit(&self, _: #core::option::Option<&#vector>, _: &Self::Advected) -> #private::Limit<Self> {
                #private::Limit::quadratic(#core::option::Option::None, #zeros, #zero, #private::real::<#scalar>(0.0))
            }
            fn constants(&self, _: #scalar) -> Self::Constants {}
            fn kick_before(_: &Self::Constants, _: &Self::Advected) -> #vector { #zero }
            fn step_terms(_: &Self::Constants, _: &#vector, _: &Self::Advected) -> Self::StepTerms {}
            fn newton_system(_: &Self::Constants, _: &Self::StepTerms, _: &#vector) -> (#vector, #square) {
                (#zero, #zeros)
            }
            fn kick_after(_: &Self::Constants, _: &#matrix, _: &Self::Advected) -> #vector { #zero }
            fn constrained(
                &self, at: #core::option::Option<(&#matrix, #scalar)>, w: &Self::Advected,
                each: &mut dyn #core::ops::FnMut(#scalar, #vector),
            ) {
                let (value, covector) = match at {
                    #core::option::Option::Some((f, h)) => (
                        #private::Nonholonomic::at_increment(self, f, w, h), #private::Nonholonomic::slope(self, f, w, h),
                    ),
                    #core::option::Option::None => { (#private::real::<#scalar>(0.0), #private::Nonholonomic::reaction(self, w)) }
                };
                each(value, covector);
            }
        }

        #addition
        #lanes
    };
    let implementations = header.enclosing(implementations);
    quote_spanned!(span=> #item #implementations)
}

/// The covector of the reaction.
fn reaction(emitter: &Emitter) -> TokenStream {
    let (graph, [_, bias, _]) = emitter.kernel.beginning.limit(emitter.derived);
    let documentation = docs::of(&[], &[], &graph, &bias);
    let body = emitter.body(Form::Vector, &graph, &bias, &|input| emitter.input_token(input));
    let vector = emitter.header.vector();
    quote_spanned! {Span::mixed_site()=>
        #[doc = #documentation]
        fn reaction(&self, w: &Self::Advected) -> #vector { #body }
    }
}

/// The derivation as text.
pub(super) fn derivation(declaration: &Declaration, chosen: &Choice, findings: &Findings) -> String {
    text_of(declaration, &chosen.lowered, &chosen.derived, findings)
}

fn text_of(
    declaration: &Declaration,
    lowered: &crate::declared::lower::Reading,
    derived: &crate::mathematics::derive::Derivation,
    findings: &Findings,
) -> String {
    let symbols = &derived.symbols;
    let covector = |expression| match derived.directions.factors.as_slice() {
        [one] => covector_text(expression, one.first, symbols),
        _ => text(expression, symbols),
    };
    let w = docs::at(&docs::names(declaration));
    let sections = [
        ("at_increment", format!("h c(F, w) = {}    [zero in each step]", text(&lowered.declared.expression, symbols))),
        ("slope", format!("∂(h c) along exp(tE_k)F = {}", covector(&derived.right_momentum))),
        (
            "reaction",
            format!("A{w} = {}    [U(F) = μ + k₀ + λ A{w}; A{w}·ξ = 0 at each time]", covector(&derived.limit.bias)),
        ),
        ("not conserved", NOT_KEPT.to_owned()),
        ("certainty", docs::certified(docs::OF_A_STEP, findings.sureness)),
    ];
    let sections = sections.map(|(title, text)| format!("{title}\n    {text}\n"));
    [docs::setting(declaration, true), docs::lets(derived)].into_iter().chain(sections).collect()
}
