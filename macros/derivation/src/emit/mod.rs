//! Tokens: the implementations of `Effect`, `DiscreteLagrangian`, `Force`, `Nonholonomic` and `Add`, and their stand-in after a mistake.
//!
//! This room alone quotes tokens. Deliberately not here: any mathematical decision. The room knows all below itself.

mod code;
mod constraint;
mod continuous;
mod docs;
mod fallback;
mod gradients;
mod header;
mod inputs;
mod lanes;
mod nonholonomic;
mod own_group;
mod page;
mod stages;
mod verbatim;

use proc_macro2::{Ident, Span, TokenStream};
use quote::{quote, quote_spanned};

use crate::declared::lower::Reading;
use crate::declared::{Declaration, FieldKind, Role};
use crate::judged::{Choice, Equations, Findings};
use crate::mathematics::derive::Derivation;
use crate::program::{Form, Kernel, Outputs};

use code::Code;
pub(crate) use constraint::constraint;
pub(crate) use continuous::alone as continuous;
pub(crate) use fallback::mistakes;
use header::Header;
pub(crate) use own_group::{ask, own_group};

/// A function marked as inlined except in builds with debug assertions; in a block, all functions without such an
/// attribute.
#[must_use]
pub fn hot(item: TokenStream) -> TokenStream {
    let mark: syn::Attribute = syn::parse_quote!(#[cfg_attr(not(debug_assertions), inline(always))]);
    let says_it =
        |attribute: &syn::Attribute| ["inline", "cold", "hot"].iter().any(|word| attribute.path().is_ident(word));
    let marked = |attributes: &mut Vec<syn::Attribute>| {
        if !attributes.iter().any(says_it) {
            attributes.push(mark.clone());
        }
    };
    match syn::parse2(item.clone()) {
        Ok(syn::Item::Impl(mut block)) => {
            for item in &mut block.items {
                if let syn::ImplItem::Fn(function) = item {
                    marked(&mut function.attrs);
                }
            }
            quote!(#block)
        }
        Ok(syn::Item::Trait(mut block)) => {
            for item in &mut block.items {
                if let syn::TraitItem::Fn(function) = item
                    && function.default.is_some()
                {
                    marked(&mut function.attrs);
                }
            }
            quote!(#block)
        }
        _ => {
            let mut marked = quote!(#mark);
            marked.extend(item);
            marked
        }
    }
}

/// The implementation of the derive macro `Lanes` or `InLanes` for a struct of liestep.
#[must_use]
pub fn lanes(item: TokenStream, is_in_lanes: bool) -> TokenStream {
    let item = syn::parse2(item);
    item.map_or_else(|mistake: syn::Error| mistake.to_compile_error(), |item| lanes::derived(&item, is_in_lanes))
}

/// The item with the whole implementation.
pub(crate) fn implementation(
    [arguments, item]: [&TokenStream; 2],
    declaration: &Declaration,
    chosen: &Choice,
    equations: Option<&Equations>,
    findings: &Findings,
) -> TokenStream {
    let (header, Choice { lowered, derived, kernel }) = (Header::new(declaration), chosen);
    let (names, symbols) = (&lowered.names, &derived.symbols);
    let code = Code { declaration, header: &header, names, symbols, directions: Some(&derived.directions) };
    let emitter = Emitter { code, lowered, derived, kernel, equations };
    if declaration.role == Role::Nonholonomic {
        return nonholonomic::implementation(&emitter, [arguments, item], findings);
    }
    let texts = equations_of(declaration, chosen, equations);
    let (mathematics, effect) = emitter.mathematics(&findings.jacobian, &texts);
    let stages = stages::stages(&emitter, &findings.stages, &texts);
    let declared = match declaration.discretisation() {
        Some(discretisation) => continuous::discretised(&emitter, discretisation),
        None => verbatim::declared(declaration, &header),
    };
    let continuous = equations.map(|equations| continuous::implementation(declaration, &header, equations, true));
    let derivation = derivation(&header, &derivation_of(declaration, chosen, &texts, equations, findings));
    let declared_text = declared_text(&header, declaration, arguments);
    let item = page::documented(item, &page::page(declaration, chosen, &texts, equations, findings));
    let describe = emitter.describe();
    let span = Span::mixed_site();
    let types = header.types(kinetic(chosen), &stages.constants_type, &stages.step_terms_type);
    let facts = stages::facts(&emitter, kernel, findings.self_adjointness.is_found());
    let is_force = declaration.role == Role::Force;
    let (name, mathematics) =
        if is_force { ("Force", TokenStream::new()) } else { ("DiscreteLagrangian", mathematics) };
    let (of_role, effect_of) = (header.implementation(name), header.implementation("Effect"));
    let term = emitter.term(&stages::same_generators(&emitter.code));
    let invariance = invariance(declaration, &header);
    let addition = header.addition();
    let lanes = lanes::lanes(&header, Some(&declaration.fields));
    let gradients = gradients::implementation(&emitter, findings.derivatives.as_ref());
    let body = &stages.methods;
    let implementations = quote_spanned! {span=>
        #term

        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic, clippy::nursery, non_snake_case, unused_variables)]
        #of_role {
            #declared
            #mathematics
        }

        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic, clippy::nursery, non_snake_case, unused_variables)]
        #effect_of {
            #types
            #facts

            #derivation
            #declared_text
            #describe
            #effect
            #body
        }

        #continuous
        #invariance
        #gradients
        #addition
        #lanes
    };
    let implementations = header.enclosing(implementations);
    quote_spanned!(span=> #item #implementations)
}

/// The type of an effect's kinetic part.
fn kinetic(chosen: &Choice) -> &'static str {
    if chosen.derived.limit.has_kinetic { "WithKinetic" } else { "WithoutKinetic" }
}

/// The declaration and everything derived from it, as text.
pub(crate) fn text(
    declaration: &Declaration,
    chosen: &Choice,
    equations: Option<&Equations>,
    findings: &Findings,
) -> String {
    if declaration.role == Role::Nonholonomic {
        return nonholonomic::derivation(declaration, chosen, findings);
    }
    let texts = equations_of(declaration, chosen, equations);
    derivation_of(declaration, chosen, &texts, equations, findings)
}

fn derivation_of(
    declaration: &Declaration,
    chosen: &Choice,
    texts: &[docs::Equation],
    equations: Option<&Equations>,
    findings: &Findings,
) -> String {
    let section = equations.map(|equations| continuous::text::section(declaration, equations));
    docs::derivation(declaration, chosen, texts, section, findings)
}

/// The Hamiltonian and its derivatives as text.
pub(crate) fn text_of_hamiltonian(declaration: &Declaration, equations: &Equations) -> String {
    continuous::text::of_hamiltonian(declaration, equations)
}

/// The equations of a step.
fn equations_of(declaration: &Declaration, chosen: &Choice, equations: Option<&Equations>) -> Vec<docs::Equation> {
    let Choice { lowered, derived, .. } = chosen;
    if declaration.role == Role::Force {
        docs::equations_of_force(derived, &lowered.declared)
    } else {
        docs::equations(derived, &lowered.declared, equations)
    }
}

fn derivation(header: &Header, text: &str) -> TokenStream {
    let (span, private) = (Span::mixed_site(), &header.private);
    let documentation = format!("```text\n{text}```");
    quote_spanned! {span=>
        #[doc = #documentation]
        const DERIVATION: &'static #private::core::primitive::str = {
            // A block instead of the value: rustdoc would show it with each letter escaped that isn't ASCII.
            const TEXT: &#private::core::primitive::str = #text;
            TEXT
        };
    }
}

/// The text of the declaration, from which a program can derive it again.
fn declared_text(header: &Header, declaration: &Declaration, arguments: &TokenStream) -> TokenStream {
    let private = &header.private;
    let attribute = Ident::new(declaration.role.attribute(), Span::call_site());
    let syn::ItemStruct { ident, generics, fields, .. } = &declaration.item;
    let fields = fields.iter().map(|syn::Field { ident, ty, .. }| quote!(#ident: #ty));
    let text = quote!(#[#attribute(#arguments)] struct #ident #generics { #(#fields),* }).to_string();
    quote_spanned!(Span::mixed_site()=> const DECLARATION: &'static #private::core::primitive::str = #text;)
}

/// The invariance of a Lagrangian without advected parameters under the whole group.
fn invariance(declaration: &Declaration, header: &Header) -> Option<TokenStream> {
    let implementation = header.implementation("LeftInvariant");
    let is_invariant = declaration.role == Role::Lagrangian && declaration.advected.iter().all(|w| w.is_given);
    is_invariant.then(|| {
        quote_spanned! {Span::mixed_site()=>
            #[automatically_derived]
            #[allow(clippy::all, clippy::pedantic, clippy::nursery)]
            #implementation {}
        }
    })
}

/// The data that all parts of a step share.
struct Emitter<'a> {
    code: Code<'a>,
    lowered: &'a Reading,
    derived: &'a Derivation,
    kernel: &'a Kernel,
    /// The continuous equations of a Lagrangian.
    equations: Option<&'a Equations>,
}

impl<'a> std::ops::Deref for Emitter<'a> {
    type Target = Code<'a>;

    fn deref(&self) -> &Code<'a> {
        &self.code
    }
}

impl Emitter<'_> {
    /// The derived terms without stages: those of a Lagrangian, and those of any effect.
    fn mathematics(&self, jacobian: &Outputs, equations: &[docs::Equation]) -> (TokenStream, TokenStream) {
        let d = self.derived;
        let method = |(name, form, expression)| {
            self.method(name, form, &self.kernel.beginning.term(d, form, expression), equations)
        };
        let of_lagrangian = [
            ("right_momentum", Form::Vector, &d.right_momentum),
            ("left_momentum", Form::Vector, &d.left_momentum),
            ("diamond", Form::Vector, &d.diamond),
            ("legendre_minus", Form::Vector, &d.momentum),
            ("discrete_energy", Form::Scalar, &d.energy),
        ];
        let jacobian = self.method("momentum_jacobian", Form::Square, jacobian, equations);
        let limit = self.limit(equations);
        (of_lagrangian.map(method).into_iter().collect(), quote!(#jacobian #limit))
    }

    /// The continuous limit, which has the inertia, the momentum at rest and the potential.
    fn limit(&self, equations: &[docs::Equation]) -> TokenStream {
        let (span, d, private) = (Span::mixed_site(), self.derived, &self.header.private);
        let (graph, [inertia, bias, potential]) = self.kernel.beginning.limit(d);
        let (bias_from, potential_from) = (inertia.len(), inertia.len() + bias.len());
        let outputs = [inertia, bias, potential].concat();
        let documentation = docs::of(equations, &["inertia", "momentum_bias", "potential"], &graph, &outputs);
        let (lets, values) = self.values(&graph, &outputs, &|input| self.input_token(input));
        let (at_rest, potential) = values.split_at(potential_from);
        let (inertia, bias) = at_rest.split_at(bias_from);
        let (inertia, bias) = (self.assembled(Form::Square, inertia), self.assembled(Form::Vector, bias));
        let at_velocity = self.equations.and_then(|equations| continuous::at_velocity(private, equations));
        let vector = self.header.vector();
        quote_spanned! {span=>
            #[doc = #documentation]
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn limit(
                &self,
                velocity: #private::core::option::Option<&#vector>,
                w: &<Self as #private::Term>::Advected,
            ) -> #private::Limit<Self> {
                #at_velocity
                #lets
                #private::Limit::quadratic(velocity, #inertia, #bias, #(#potential)*)
            }
        }
    }

    /// One derived term as a method, with its equation as documentation.
    fn method(&self, name: &str, form: Form, (graph, outputs): &Outputs, equations: &[docs::Equation]) -> TokenStream {
        let (span, d, private) = (Span::mixed_site(), self.derived, &self.header.private);
        let result = self.header.of(form);
        let documentation = docs::of(equations, &[name], graph, outputs);
        let inverse =
            d.directions.factors.iter().any(|one| stages::uses(graph, outputs, one.inverse)).then(
                || quote_spanned!(span=> let inverse = #private::inverse_of::<<Self as #private::Term>::Group>(*f);),
            );
        let body = self.body(form, graph, outputs, &|input| self.input_token(input));
        let name = syn::Ident::new(name, span);
        let (matrix, scalar) = (self.header.matrix(), &self.header.scalar);
        quote_spanned! {span=>
            #[doc = #documentation]
            fn #name(&self, f: &#matrix, w: &<Self as #private::Term>::Advected, h: #scalar) -> #result {
                #inverse
                #body
            }
        }
    }
}

impl Code<'_> {
    /// The checks of all parameters.
    fn checks(&self) -> TokenStream {
        let span = Span::mixed_site();
        let checks = self.declaration.fields.iter().map(|field| {
            let name = &field.name;
            let text = syn::ext::IdentExt::unraw(name).to_string();
            let span = field.at.resolved_at(span);
            let private = self.header.private_at(span);
            if field.kind == crate::declared::FieldKind::Scalar {
                quote_spanned!(span=> #private::validate_scalar(self.#name, #text)?;)
            } else {
                quote_spanned!(span=> #private::Parameter::validate(&self.#name, #text)?;)
            }
        });
        checks.collect()
    }

    /// The implementation of `Term`, with the statements `before` in front of the checks.
    fn term(&self, before: &TokenStream) -> TokenStream {
        let (private, checks, values) = (&self.header.private, self.checks(), self.advected_value());
        self.header.term(&quote_spanned! {Span::mixed_site()=>
            fn validate(&self) -> #private::core::result::Result<(), #private::SetupError> {
                #before
                #checks
                #private::core::result::Result::Ok(())
            }

            fn advected(&self) -> Self::Advected { #values }
        })
    }

    fn describe(&self) -> TokenStream {
        let span = Span::mixed_site();
        let private = &self.header.private;
        let scalar = &self.header.scalar;
        let fields = self.declaration.fields.iter().map(|field| {
            let name = &field.name;
            let text = syn::ext::IdentExt::unraw(name).to_string();
            let span = field.at.resolved_at(span);
            let private = self.header.private_at(span);
            if field.kind == crate::declared::FieldKind::Scalar {
                quote_spanned!(span=> #private::SceneVisitor::parameter(visitor, #text, self.#name);)
            } else {
                quote_spanned!(span=> #private::Parameter::describe(&self.#name, #text, visitor);)
            }
        });
        quote_spanned! {span=>
            fn describe(&self, visitor: &mut dyn #private::SceneVisitor<#scalar>) {
                #private::SceneVisitor::term(visitor, Self::DERIVATION);
                #(#fields)*
            }
        }
    }

    /// The spatial values of the advected parameters.
    fn advected_value(&self) -> TokenStream {
        let span = Span::mixed_site();
        let private = &self.header.private;
        let values = self.declaration.advected.iter().filter_map(|w| {
            if w.seen.is_configuration() {
                return Some(quote_spanned!(span=> #private::core::default::Default::default()));
            }
            let field = self.declaration.fields.get(w.field?)?;
            let name = &field.name;
            Some(match field.kind {
                FieldKind::Scalar => quote_spanned!(span=> #private::Given::scalar(self.#name)),
                _ if w.is_given => quote_spanned!(span=> #private::Given(self.#name)),
                _ if self.declaration.group.is_product() => quote_spanned!(span=> #private::SeenFrom(self.#name)),
                _ => quote_spanned!(span=> self.#name),
            })
        });
        let values: Vec<TokenStream> = values.collect();
        match values.as_slice() {
            [single] => single.clone(),
            values => quote_spanned!(span=> (#(#values),*)),
        }
    }
}
