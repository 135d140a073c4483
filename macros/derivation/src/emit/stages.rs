//! The stages of a step: operations at construction, in each step, and in each Newton iteration.

use proc_macro2::{Literal, Span, TokenStream};
use quote::quote_spanned;

use super::{Code, Emitter};
use crate::mathematics::derive::Inverse;
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Stage, SymbolId};
use crate::program::{self, Form, Graph, Handover, Kernel, Node, NodeId, needed};

/// The methods of the stages, and the arrays that pass values between them.
pub(super) struct Stages {
    pub(super) methods: TokenStream,
    pub(super) constants_type: TokenStream,
    pub(super) step_terms_type: TokenStream,
}

pub(super) fn stages(emitter: &Emitter, stages: &program::Stages, equations: &[super::docs::Equation]) -> Stages {
    let program::Stages { system, constants, terms: step_terms } = stages;
    let (kernel, graph) = (emitter.kernel, &emitter.kernel.graph);
    let (span, private) = (Span::mixed_site(), &emitter.header.private);
    let (vector, scalar) = (emitter.header.vector(), &emitter.header.scalar);
    let matrix = emitter.header.matrix();
    let from_parameters = |id: NodeId| input(emitter, graph, id);
    let from_constants = |id: NodeId| slot(constants, id, "constants").or_else(|| input(emitter, graph, id));
    let from_terms = |id: NodeId| slot(step_terms, id, "terms").or_else(|| from_constants(id));
    let numbers = |nodes: &Handover, given: super::code::KnownTokens| {
        let nodes: Vec<NodeId> = nodes.keys().copied().collect();
        let (lets, values) = emitter.statements(graph, &nodes, given);
        quote_spanned!(span=> #lets #private::Numbers([#(#values),*]))
    };
    let constants_body = numbers(constants, &from_parameters);
    let step_terms_body = numbers(step_terms, &from_constants);
    let value = |outputs: &[NodeId], given: super::code::KnownTokens| {
        let (lets, values) = emitter.statements(graph, outputs, given);
        let value = emitter.assembled(Form::Vector, &values);
        quote_spanned!(span=> #lets #value)
    };
    let kick_before = value(&kernel.kick_before, &from_constants);
    let kick_after = value(&kernel.kick_after, &from_constants);
    let kick_derivative = kernel.kick_derivative.as_ref().map(|outputs| {
        let documentation = super::docs::of(equations, &["kick_derivative"], graph, outputs);
        kick_derivative(emitter, &documentation, &value(outputs, &from_constants))
    });
    let newton_system = newton_system(emitter, kernel, system, &from_terms);
    let inverse = inverse(emitter, kernel);
    let length = |nodes: &Handover| {
        let length = Literal::usize_unsuffixed(nodes.len());
        quote_spanned!(span=> #private::Numbers<#scalar, #length>)
    };
    let [before, after] = [("kick_before", &kernel.kick_before), ("kick_after", &kernel.kick_after)]
        .map(|(method, outputs)| super::docs::of(equations, &[method], graph, outputs));
    let step = super::docs::stage(
        graph,
        &[kernel.kick_before.clone(), step_terms.keys().copied().collect()].concat(),
        Stage::Step,
        "a step before the solve",
    );
    let construction =
        super::docs::stage(graph, &constants.keys().copied().collect::<Vec<_>>(), Stage::Construction, "construction");
    let methods = quote_spanned! {span=>
        #[doc = #construction]
        fn constants(&self, h: #scalar) -> Self::Constants {
            #constants_body
        }

        fn are_finite(constants: &Self::Constants) -> #private::core::primitive::bool {
            #private::are_finite(constants)
        }

        #[doc = #before]
        #[cfg_attr(not(debug_assertions), inline(always))]
        fn kick_before(constants: &Self::Constants, w: &Self::Advected) -> #vector { #kick_before }

        #kick_derivative

        #[doc = #step]
        #[cfg_attr(not(debug_assertions), inline(always))]
        fn step_terms(constants: &Self::Constants, a: &#vector, w: &Self::Advected) -> Self::StepTerms {
            #step_terms_body
        }

        #newton_system

        #[doc = #after]
        #[cfg_attr(not(debug_assertions), inline(always))]
        fn kick_after(constants: &Self::Constants, increment: &#matrix, next: &Self::Advected) -> #vector {
            #inverse
            #kick_after
        }
    };
    Stages { methods, constants_type: length(constants), step_terms_type: length(step_terms) }
}

/// The Newton system; `given` has the values of the stages before.
fn newton_system(
    emitter: &Emitter,
    kernel: &Kernel,
    system: &[NodeId],
    given: super::code::KnownTokens,
) -> TokenStream {
    let (span, graph) = (Span::mixed_site(), &kernel.graph);
    let (vector, square) = (emitter.header.vector(), emitter.header.square());
    let (lets, values) = emitter.statements(graph, system, given);
    let (residual, jacobian) = values.split_at(kernel.residual.len());
    let (residual, jacobian) = (emitter.assembled(Form::Vector, residual), emitter.assembled(Form::Square, jacobian));
    let (increment, jacobian) = in_coordinates(emitter, kernel, system, jacobian);
    let iteration = super::docs::stage(graph, system, Stage::Iteration, "a Newton iteration, residual and Jacobian");
    let iteration = format!("```text\n{}\n```\n\n{iteration}", super::docs::candidates(kernel));
    quote_spanned! {span=>
        #[doc = #iteration]
        #[cfg_attr(not(debug_assertions), inline(always))]
        fn newton_system(
            constants: &Self::Constants,
            terms: &Self::StepTerms,
            half: &#vector,
        ) -> (#vector, #square) {
            #increment
            #lets
            (#residual, #jacobian)
        }
    }
}

/// `F⁻¹`, if the kick after a step needs it.
fn inverse(emitter: &Emitter, kernel: &Kernel) -> Option<TokenStream> {
    let (span, private, graph) = (Span::mixed_site(), &emitter.header.private, &kernel.graph);
    emitter.derived.directions.factors.iter().any(|one| uses(graph, &kernel.kick_after, one.inverse)).then(|| {
        let group = quote_spanned!(span=> <Self::Group as #private::LieGroup>);
        quote_spanned! {span=>
            let inverse = #group::matrix(&#group::inverse(&#group::from_increment(increment)));
        }
    })
}

/// The statements for the increment, and the Jacobian of the Newton system in the coordinates.
///
/// If the system is written in `F`, the retraction's tangent transforms its Jacobian to the coordinates.
fn in_coordinates(
    emitter: &Emitter,
    kernel: &Kernel,
    system: &[NodeId],
    jacobian: TokenStream,
) -> (TokenStream, TokenStream) {
    if !kernel.in_increment {
        return (TokenStream::new(), jacobian);
    }
    let (span, private) = (Span::mixed_site(), &emitter.header.private);
    let retraction = quote_spanned!(span=> <Self::Retraction as #private::Retraction<Self::Group>>);
    let factors = &emitter.derived.directions.factors;
    let inverse = factors.iter().any(|one| uses(&kernel.graph, system, one.small_inverse)).then(
        || quote_spanned!(span=> let inverse_increment = <Self::Group as #private::LieGroup>::inverse_increment(&increment);),
    );
    (
        quote_spanned!(span=> let increment = #retraction::increment_of_half(half); #inverse),
        quote_spanned!(span=> #retraction::in_coordinates(&(#jacobian), half)),
    )
}

/// The facts about the effect, and the exchange of its energy.
pub(super) fn facts(emitter: &Emitter, kernel: &Kernel, is_self_adjoint: bool) -> TokenStream {
    let (span, private, derived) = (Span::mixed_site(), &emitter.header.private, emitter.derived);
    let [unknown, before, after] =
        [&derived.unknown, &derived.kick_before, &derived.kick_after].map(|part| !part.is_zero());
    let denominators = Literal::u32_unsuffixed(kernel.denominators);
    let is_constant = !derived.inertia_varies();
    let ends = kernel.ends(&derived.group);
    let apart = (!ends.is_empty()).then(|| {
        let whole = quote_spanned!(span=> #private::Blocks::WHOLE);
        // Each end is a number of components counted from the first.
        let blocks = ends.iter().fold(whole.clone(), |blocks, &factor| {
            let size = Literal::usize_unsuffixed(derived.group.component_of(factor));
            quote_spanned!(span=> #blocks.then(#size, #whole))
        });
        quote_spanned!(span=> apart: #blocks,)
    });
    let is_quadratic = !emitter.equations.is_some_and(|equations| equations.derived.inverse == Inverse::Nonlinear);
    let [step, iteration] = kernel.operations().map(Literal::u32_unsuffixed);
    let energy = with_energy(emitter);
    quote_spanned! {span=>
        const FACTS: #private::Facts = #private::Facts {
            parts: #private::Parts { unknown: #unknown, kick_before: #before, kick_after: #after },
            denominators: #denominators,
            has_constant_inertia: #is_constant,
            is_quadratic: #is_quadratic,
            is_self_adjoint: #is_self_adjoint,
            #apart
            operations: #private::Operations { step: #step, iteration: #iteration },
            ..#private::Facts::ANY
        };
        #energy
    }
}

/// Replaces `E_0` by an energy, if there is a pace.
fn with_energy(emitter: &Emitter) -> Option<TokenStream> {
    let (span, header) = (Span::mixed_site(), emitter.header);
    let at = Literal::usize_unsuffixed(emitter.declaration.energy?);
    let is_alone = emitter.declaration.advected.len() == 1;
    let place = if is_alone { quote_spanned!(span=> w) } else { quote_spanned!(span=> w.#at) };
    let (private, scalar) = (&header.private, &header.scalar);
    Some(quote_spanned! {span=>
        fn with_energy(
            &self,
            w: &<Self as #private::Term>::Advected,
            energy: #scalar,
        ) -> #private::core::option::Option<(<Self as #private::Term>::Advected, #scalar)> {
            let mut w = *w;
            let before = #private::core::mem::replace(&mut #place, #private::Given::scalar(energy));
            #private::core::option::Option::Some((w, before.0.x))
        }
    })
}

/// The derivative of a kick along a velocity.
fn kick_derivative(emitter: &Emitter, documentation: &str, value: &TokenStream) -> TokenStream {
    let (span, private, vector) = (Span::mixed_site(), &emitter.header.private, emitter.header.vector());
    let option = quote_spanned!(span=> #private::core::option::Option);
    quote_spanned! {span=>
        #[doc = #documentation]
        #[cfg_attr(not(debug_assertions), inline(always))]
        fn kick_derivative(
            constants: &Self::Constants,
            w: &Self::Advected,
            velocity: &#vector,
        ) -> #option<#vector> {
            #option::Some({ #value })
        }
    }
}

/// The compiler's check that the generators of the derivation are those of the group at run time.
pub(super) fn same_generators(code: &Code) -> TokenStream {
    let groups = code.declaration.group.factors().iter().zip(code.header.groups());
    groups.filter(|(group, _)| !group.is_so3).map(|(group, own)| has_generators(code, group, &own)).collect()
}

fn has_generators(code: &Code, group: &Group, own: &TokenStream) -> TokenStream {
    let (span, private) = (Span::mixed_site(), &code.header.private);
    let matrices = group.generators.iter().map(|entries| {
        let rows = entries.chunks(group.size).map(|row| {
            let entries = row.iter().map(|entry| {
                let mut size = Literal::f64_unsuffixed(entry.to_f64().abs());
                size.set_span(span);
                if entry.is_negative() { quote_spanned!(span=> -#size) } else { quote_spanned!(span=> #size) }
            });
            quote_spanned!(span=> [#(#entries),*])
        });
        quote_spanned!(span=> [#(#rows),*])
    });
    quote_spanned! {span=>
        const {
            #private::core::assert!(
                <#own>::has_generators(&[#(#matrices),*]),
                "the generators of the declaration aren't those of the group"
            )
        };
    }
}

fn input(emitter: &Emitter, graph: &Graph, id: NodeId) -> Option<TokenStream> {
    match graph.node(id) {
        Node::Input(entry) => Some(emitter.input_token(entry)),
        _ => None,
    }
}

fn slot(slots: &Handover, id: NodeId, numbers: &str) -> Option<TokenStream> {
    let (numbers, index) = (syn::Ident::new(numbers, Span::mixed_site()), Literal::usize_unsuffixed(*slots.get(&id)?));
    Some(quote_spanned!(Span::mixed_site()=> #numbers.0[#index]))
}

/// Whether the outputs need an entry of a symbol.
pub(super) fn uses(graph: &Graph, outputs: &[NodeId], symbol: SymbolId) -> bool {
    let mut nodes = needed(graph, outputs, &|_| false).into_iter();
    nodes.any(|id| matches!(graph.node(id), Node::Input(entry) if entry.symbol == symbol))
}
