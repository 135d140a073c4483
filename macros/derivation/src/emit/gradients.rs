//! The derivatives of a step, if they are requested: `SecondDerivatives`.

use proc_macro2::{Literal, Span, TokenStream};
use quote::{ToTokens as _, quote_spanned};

use super::inputs::entry;
use super::{Emitter, stages};
use crate::declared::{FieldKind, Name};
use crate::judged::{count, variables};
use crate::mathematics::symbolic::SymbolId;
use crate::program::{Derivatives, Form, Node, NodeId, WeightedGradient};

/// The implementation of the derivatives; `None` if it isn't requested.
pub(super) fn implementation(emitter: &Emitter, derivatives: Option<&Derivatives>) -> Option<TokenStream> {
    let derivatives = derivatives?;
    let (span, private) = (Span::mixed_site(), &emitter.header.private);
    let blocks = step_derivatives(emitter, derivatives);
    let [parameters, advected] = derivatives.by_numbers.each_ref().map(|by| visits(emitter, derivatives, by));
    let system = adjoint_system(emitter, derivatives);
    let gradient = adjoint_gradient(emitter, derivatives);
    let of_kick = kick_gradient(emitter, derivatives);
    let (usize, count) = (quote_spanned!(span=> #private::core::primitive::usize), parameter_count(emitter));
    let carried = carried_parameters(emitter);
    let (scalar, vector) = (&emitter.header.scalar, emitter.header.vector());
    let implementation = emitter.header.implementation("SecondDerivatives");
    let square = emitter.header.square();
    let point = quote_spanned! {span=>
        #private::StepPoint { increment, w, h }: #private::StepPoint<'_, Self::Group, Self::Advected>
    };
    let visit = quote_spanned!(span=> visit: &mut impl #private::core::ops::FnMut(#usize, #vector, #vector));
    Some(quote_spanned! {span=>
        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic, clippy::nursery, non_snake_case, unused_variables)]
        #implementation {
            const PARAMETERS: #usize = #count;

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn step_derivatives(&self, #point) -> #private::StepDerivatives<#square> {
                #blocks
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn by_parameters(&self, #point, #visit) {
                #parameters
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn by_advected(&self, #point, #visit) {
                #advected
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn carried_parameters(visit: &mut impl #private::core::ops::FnMut(#usize, #usize)) {
                #carried
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn adjoint_system(
                &self, #point, at_end: &#vector,
            ) -> (#square, #vector) {
                #system
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn adjoint_gradient(
                &self, #point, [at_start, at_end]: [&#vector; 2],
                visit: &mut impl #private::core::ops::FnMut(#usize, #scalar),
            ) -> (#vector, Self::Advected) {
                #gradient
            }

            #of_kick
        }
    })
}

/// `∂μ/∂ε`, and `(∂μ⁺/∂ε)ᵀ p`.
fn adjoint_system(emitter: &Emitter, derivatives: &Derivatives) -> TokenStream {
    let Derivatives { blocks: [[matrix, _], _], by_turn, .. } = derivatives;
    let weights = [(emitter.derived.directions.along, "at_end")];
    let (lets, values) = statements(emitter, derivatives, &[matrix.as_slice(), by_turn].concat(), &weights);
    let (matrix, right_side) = values.split_at(matrix.len());
    let (matrix, right_side) = (emitter.assembled(Form::Square, matrix), emitter.assembled(Form::Vector, right_side));
    quote_spanned!(Span::mixed_site()=> #lets (#matrix, #right_side))
}

/// The gradient of `⟨p, μ⁺⟩ − ⟨u, μ⟩` at a fixed increment.
fn adjoint_gradient(emitter: &Emitter, derivatives: &Derivatives) -> TokenStream {
    let directions = &emitter.derived.directions;
    let weights = [(directions.target, "at_start"), (directions.along, "at_end")];
    let (lets, found) = gradient_of(emitter, derivatives, &derivatives.gradient, &weights);
    quote_spanned!(Span::mixed_site()=> #lets #found)
}

/// The gradient of `⟨u, D_v k⟩ + ⟨r, k − J u⟩`, where `k` is the torque: the kick of a step of two seconds.
fn kick_gradient(emitter: &Emitter, derivatives: &Derivatives) -> Option<TokenStream> {
    let directions = &emitter.derived.directions;
    let weights = [(directions.target, "acceleration"), (directions.coordinates, "multiplier")];
    let (lets, found) = gradient_of(emitter, derivatives, derivatives.of_kick.as_ref()?, &weights);
    let (span, private, scalar) = (Span::mixed_site(), &emitter.header.private, &emitter.header.scalar);
    let (core, vector) = (quote_spanned!(span=> #private::core), emitter.header.vector());
    Some(quote_spanned! {span=>
        #[cfg_attr(not(debug_assertions), inline(always))]
        fn kick_gradient(
            &self, w: &Self::Advected, velocity: &#vector, [acceleration, multiplier]: [&#vector; 2],
            visit: &mut impl #core::ops::FnMut(#core::primitive::usize, #scalar),
        ) -> #core::option::Option<(#vector, Self::Advected)> {
            let h: #scalar = #private::real(2.0);
            #lets
            #core::option::Option::Some(#found)
        }
    })
}

/// Statements that visit a gradient by the parameters, and return that by the position and by the advected parameters.
fn gradient_of(
    emitter: &Emitter,
    derivatives: &Derivatives,
    WeightedGradient { by_place, by_numbers }: &WeightedGradient,
    weights: &[(SymbolId, &str)],
) -> (TokenStream, TokenStream) {
    let (private, scalar, span) = (&emitter.header.private, &emitter.header.scalar, Span::mixed_site());
    let [parameters, advected] = by_numbers;
    let nodes = |by: &[(usize, Vec<NodeId>)]| by.iter().flat_map(|(_, nodes)| nodes.clone()).collect::<Vec<_>>();
    let outputs = [by_place.as_slice(), &nodes(advected), &nodes(parameters)].concat();
    let (lets, values) = statements(emitter, derivatives, &outputs, weights);
    let (by_place, values) = values.split_at(by_place.len());
    let (of_advected, by_parameters) = values.split_at(advected.len());
    let [_, all] = variables(emitter.declaration);
    let all = all.into_iter().map(|(_, kind)| count(kind)).sum();
    let mut by_advected = vec![quote_spanned!(span=> #private::real(0.0)); all];
    for ((number, _), value) in advected.iter().zip(of_advected) {
        by_advected[*number] = value.clone();
    }
    let numbers = parameters.iter().map(|(number, _)| Literal::usize_unsuffixed(*number));
    let by_place = emitter.assembled(Form::Vector, by_place);
    let count = Literal::usize_unsuffixed(by_advected.len());
    let lets = quote_spanned! {span=>
        #lets
        #(visit(#numbers, #by_parameters);)*
        let by_advected: [#scalar; #count] = [#(#by_advected),*];
        let mut entries = #private::core::iter::IntoIterator::into_iter(by_advected);
        let by_advected = <Self::Advected as #private::Entries<#scalar>>::from_entries(&mut || {
            #private::core::iter::Iterator::next(&mut entries).unwrap_or(#private::real(0.0))
        });
    };
    (lets, quote_spanned!(span=> (#by_place, by_advected)))
}

fn step_derivatives(emitter: &Emitter, derivatives: &Derivatives) -> TokenStream {
    let all = derivatives.blocks.as_flattened();
    let (lets, values) = statements(emitter, derivatives, &all.concat(), &[]);
    let (span, private) = (Span::mixed_site(), &emitter.header.private);
    let size = all.first().map_or(1, Vec::len).max(1);
    let blocks = values.chunks(size).map(|entries| emitter.assembled(Form::Square, entries));
    let names = ["start_by_turn", "end_by_turn", "start_by_place", "end_by_place"];
    let fields = names.iter().zip(blocks).map(|(name, block)| {
        let name = syn::Ident::new(name, span);
        quote_spanned!(span=> #name: #block)
    });
    quote_spanned!(span=> #lets #private::StepDerivatives { #(#fields),* })
}

/// The `let`s and values of these outputs; some symbols are weights with these names.
fn statements(
    emitter: &Emitter,
    Derivatives { graph, .. }: &Derivatives,
    outputs: &[NodeId],
    weights: &[(SymbolId, &str)],
) -> (TokenStream, Vec<TokenStream>) {
    let (span, private) = (Span::mixed_site(), &emitter.header.private);
    let given = |id: NodeId| {
        let Node::Input(input) = graph.node(id) else { return None };
        let weight = weights.iter().find(|(symbol, _)| *symbol == input.symbol);
        let weight = weight.map(|(_, name)| entry(&syn::Ident::new(name, span).to_token_stream(), input));
        Some(weight.unwrap_or_else(|| emitter.input_token(input)))
    };
    let (lets, values) = emitter.statements(graph, outputs, &given);
    let factors = &emitter.derived.directions.factors;
    let inverse = factors.iter().any(|one| stages::uses(graph, outputs, one.small_inverse)).then(
        || quote_spanned!(span=> let inverse_increment = <Self::Group as #private::LieGroup>::inverse_increment(increment);),
    );
    (quote_spanned!(span=> #inverse #lets), values)
}

/// Calls of `visit` for the derivatives that aren't zero.
fn visits(emitter: &Emitter, derivatives: &Derivatives, found: &[(usize, Vec<NodeId>)]) -> TokenStream {
    let outputs: Vec<NodeId> = found.iter().flat_map(|(_, nodes)| nodes.iter().copied()).collect();
    let (lets, values) = statements(emitter, derivatives, &outputs, &[]);
    let dimension = emitter.declaration.group.dimension();
    let visits = found.iter().zip(values.chunks(2 * dimension)).map(|((number, _), values)| {
        let number = Literal::usize_unsuffixed(*number);
        let (start, end) = values.split_at(dimension);
        let [start, end] = [start, end].map(|momentum| emitter.assembled(Form::Vector, momentum));
        quote_spanned!(Span::mixed_site()=> visit(#number, #start, #end);)
    });
    quote_spanned!(Span::mixed_site()=> #lets #(#visits)*)
}

/// Calls of `visit` for each scalar of the advected parameters: its number, and its number among the parameters.
fn carried_parameters(emitter: &Emitter) -> TokenStream {
    let [fields, advected] = variables(emitter.declaration);
    let before =
        |all: &[(Name, FieldKind)], index: usize| all[..index].iter().map(|(_, kind)| count(*kind)).sum::<usize>();
    let visits = emitter.declaration.advected.iter().enumerate().filter_map(|(index, w)| {
        let (_, kind) = *fields.get(w.field?)?;
        let (place, parameter) = (before(&advected, index), before(&fields, w.field?));
        let pairs = (0..count(kind)).map(move |k| [place + k, parameter + k].map(Literal::usize_unsuffixed));
        Some(pairs.map(|[place, parameter]| quote_spanned!(Span::mixed_site()=> visit(#place, #parameter);)))
    });
    visits.flatten().collect()
}

fn parameter_count(emitter: &Emitter) -> Literal {
    let [fields, _] = variables(emitter.declaration);
    Literal::usize_unsuffixed(fields.into_iter().map(|(_, kind)| count(kind)).sum())
}
