//! The derivatives of a step, where they are asked for: `SecondDerivatives`.

use proc_macro2::{Literal, Span, TokenStream};
use quote::{ToTokens as _, quote_spanned};

use super::inputs::entry;
use super::{Emitter, stages};
use crate::declared::{FieldKind, Name};
use crate::mathematics::symbolic::SymbolId;
use crate::program::{Form, Linearisation, Node, NodeId, WeightedGradient};

/// One scalar of the parameters, by its number, with the entry that stands for it.
#[derive(Clone, Copy)]
struct Place {
    number: usize,
    row: usize,
    column: usize,
    /// An entry beside the diagonal of a symmetric matrix is there twice.
    is_half: bool,
}

/// The implementation; nothing where it isn't asked for.
pub(super) fn implementation(emitter: &Emitter) -> Option<TokenStream> {
    let ends = emitter.derived.ends.as_ref()?;
    let mut linearisation = Linearisation::new(emitter.derived, ends);
    let (span, private) = (Span::mixed_site(), &emitter.header.private);
    let blocks = step_derivatives(emitter, &mut linearisation);
    let parameters = by_parameters(emitter, &mut linearisation);
    let advected = by_advected(emitter, &mut linearisation);
    let system = adjoint_system(emitter, &mut linearisation);
    let gradient = adjoint_gradient(emitter, &mut linearisation);
    let of_kick = kick_gradient(emitter, &mut linearisation);
    let (usize, count) = (quote_spanned!(span=> #private::core::primitive::usize), parameter_count(emitter));
    let carried = carried_parameters(emitter);
    let (scalar, matrix, vector) = (&emitter.header.scalar, emitter.header.matrix(), emitter.header.vector());
    let implementation = emitter.header.implementation("SecondDerivatives");
    let square = emitter.header.square();
    let visit = quote_spanned!(span=> visit: &mut impl #private::core::ops::FnMut(#usize, #vector, #vector));
    Some(quote_spanned! {span=>
        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic, clippy::nursery, non_snake_case, unused_variables)]
        #implementation {
            const PARAMETERS: #usize = #count;

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn step_derivatives(&self, increment: &#matrix, w: &Self::Advected, h: #scalar) -> #private::StepDerivatives<#square> {
                #blocks
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn by_parameters(&self, increment: &#matrix, w: &Self::Advected, h: #scalar, #visit) {
                #parameters
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn by_advected(&self, increment: &#matrix, w: &Self::Advected, h: #scalar, #visit) {
                #advected
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn carried_parameters(visit: &mut impl #private::core::ops::FnMut(#usize, #usize)) {
                #carried
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn adjoint_system(
                &self, increment: &#matrix, w: &Self::Advected, h: #scalar, at_end: &#vector,
            ) -> (#square, #vector) {
                #system
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn adjoint_gradient(
                &self, increment: &#matrix, w: &Self::Advected, h: #scalar, [at_start, at_end]: [&#vector; 2],
                visit: &mut impl #private::core::ops::FnMut(#usize, #scalar),
            ) -> (#vector, Self::Advected) {
                #gradient
            }

            #of_kick
        }
    })
}

/// `∂μ/∂ε`, and `(∂μ⁺/∂ε)ᵀ p`.
fn adjoint_system(emitter: &Emitter, linearisation: &mut Linearisation) -> TokenStream {
    let [matrix, right_side] = linearisation.adjoint_system();
    let weights = [(linearisation.weights_of_end(), "at_end")];
    let (lets, values) = statements(emitter, linearisation, &[matrix.as_slice(), &right_side].concat(), &weights);
    let (matrix, right_side) = values.split_at(matrix.len());
    let (matrix, right_side) = (emitter.assembled(Form::Square, matrix), emitter.assembled(Form::Vector, right_side));
    quote_spanned!(Span::mixed_site()=> #lets (#matrix, #right_side))
}

/// The gradient of `⟨p, μ⁺⟩ − ⟨u, μ⟩` at a fixed increment.
fn adjoint_gradient(emitter: &Emitter, linearisation: &mut Linearisation) -> TokenStream {
    let gradient = linearisation.adjoint_gradient();
    let weights = [(linearisation.weights_of_start(), "at_start"), (linearisation.weights_of_end(), "at_end")];
    let (lets, found) = gradient_of(emitter, linearisation, &gradient, &weights);
    quote_spanned!(Span::mixed_site()=> #lets #found)
}

/// That of `⟨u, D_v k⟩ + ⟨r, k − J u⟩`, where `k` is the torque: the kick of a step of two seconds.
fn kick_gradient(emitter: &Emitter, linearisation: &mut Linearisation) -> Option<TokenStream> {
    let gradient = linearisation.kick_gradient()?;
    let [u, r] = linearisation.weights_of_kick();
    let (lets, found) = gradient_of(emitter, linearisation, &gradient, &[(u, "acceleration"), (r, "multiplier")]);
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

/// Statements that visit a gradient by the parameters, and that by the place and by what is advected.
fn gradient_of(
    emitter: &Emitter,
    linearisation: &mut Linearisation,
    gradient: &WeightedGradient,
    weights: &[(SymbolId, &str)],
) -> (TokenStream, TokenStream) {
    let by_place = linearisation.by_place(gradient);
    let scalars = advected_scalars(emitter);
    let count = (0..emitter.declaration.advected.len()).map(|index| numbers(emitter.declaration.advected_kind(index)));
    let mut by_advected = vec![linearisation.graph.zero(); count.sum()];
    for (symbol, place) in scalars {
        by_advected[place.number] = linearisation.gradient_by_entry(gradient, symbol, place.row, place.column);
    }
    let (mut by_parameters, mut numbers) = (Vec::new(), Vec::new());
    for (symbol, place) in parameter_scalars(emitter) {
        let mut derivative = linearisation.gradient_by_entry(gradient, symbol, place.row, place.column);
        if place.is_half {
            derivative = linearisation.halved(derivative);
        }
        if !linearisation.graph.is_zero(derivative) {
            by_parameters.push(derivative);
            numbers.push(Literal::usize_unsuffixed(place.number));
        }
    }
    let outputs = [by_place.as_slice(), &by_advected, &by_parameters].concat();
    let (lets, values) = statements(emitter, linearisation, &outputs, weights);
    let (by_place, values) = values.split_at(by_place.len());
    let (by_advected, by_parameters) = values.split_at(by_advected.len());
    let by_place = emitter.assembled(Form::Vector, by_place);
    let (private, scalar, span) = (&emitter.header.private, &emitter.header.scalar, Span::mixed_site());
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

fn step_derivatives(emitter: &Emitter, linearisation: &mut Linearisation) -> TokenStream {
    let [[start_by_turn, end_by_turn], [start_by_place, end_by_place]] = linearisation.blocks();
    let all = [start_by_turn, end_by_turn, start_by_place, end_by_place];
    let (lets, values) = statements(emitter, linearisation, &all.concat(), &[]);
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

/// The `let`s of these outputs, and what they are made of; some symbols stand for weights of these names.
fn statements(
    emitter: &Emitter,
    linearisation: &Linearisation,
    outputs: &[NodeId],
    weights: &[(SymbolId, &str)],
) -> (TokenStream, Vec<TokenStream>) {
    let (span, private, graph) = (Span::mixed_site(), &emitter.header.private, &linearisation.graph);
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

/// Visits of what isn't zero.
fn visits(emitter: &Emitter, linearisation: &Linearisation, found: &[(usize, Vec<NodeId>)]) -> TokenStream {
    let outputs: Vec<NodeId> = found.iter().flat_map(|(_, nodes)| nodes.iter().copied()).collect();
    let (lets, values) = statements(emitter, linearisation, &outputs, &[]);
    let dimension = emitter.declaration.group.dimension();
    let visits = found.iter().zip(values.chunks(2 * dimension)).map(|((number, _), values)| {
        let number = Literal::usize_unsuffixed(*number);
        let (start, end) = values.split_at(dimension);
        let [start, end] = [start, end].map(|momentum| emitter.assembled(Form::Vector, momentum));
        quote_spanned!(Span::mixed_site()=> visit(#number, #start, #end);)
    });
    quote_spanned!(Span::mixed_site()=> #lets #(#visits)*)
}

fn by_parameters(emitter: &Emitter, linearisation: &mut Linearisation) -> TokenStream {
    let mut found = Vec::new();
    for (symbol, place) in parameter_scalars(emitter) {
        let mut derivative = linearisation.by_entry(symbol, place.row, place.column);
        if !linearisation.is_nothing(&derivative) {
            if place.is_half {
                derivative = derivative.into_iter().map(|node| linearisation.halved(node)).collect();
            }
            found.push((place.number, derivative));
        }
    }
    visits(emitter, linearisation, &found)
}

fn by_advected(emitter: &Emitter, linearisation: &mut Linearisation) -> TokenStream {
    let mut found = Vec::new();
    for (symbol, place) in advected_scalars(emitter) {
        let derivative = linearisation.by_entry(symbol, place.row, place.column);
        if !linearisation.is_nothing(&derivative) {
            found.push((place.number, derivative));
        }
    }
    visits(emitter, linearisation, &found)
}

/// The scalars of the parameters that can change.
fn parameter_scalars(emitter: &Emitter) -> Vec<(SymbolId, Place)> {
    let fields = emitter.declaration.fields.iter().enumerate();
    scalars(emitter, fields.map(|(index, field)| (Name::Field(index), field.kind)))
}

/// The same of what is advected.
fn advected_scalars(emitter: &Emitter) -> Vec<(SymbolId, Place)> {
    let indices = 0..emitter.declaration.advected.len();
    scalars(emitter, indices.map(|index| (Name::Advected(index), emitter.declaration.advected_kind(index))))
}

/// The scalars of several things, numbered one after the other.
fn scalars(emitter: &Emitter, each: impl Iterator<Item = (Name, FieldKind)>) -> Vec<(SymbolId, Place)> {
    let (mut found, mut first) = (Vec::new(), 0);
    for (name, kind) in each {
        let of_one = places(kind).map(|place| Place { number: first + place.number, ..place });
        found.extend(
            emitter.names.get(&name).into_iter().flat_map(|&symbol| of_one.clone().map(move |place| (symbol, place))),
        );
        first += numbers(kind);
    }
    found
}

/// The numbers of the scalars of what is advected, with those that they have among the parameters.
fn carried_parameters(emitter: &Emitter) -> TokenStream {
    let declaration = emitter.declaration;
    let visits = declaration.advected.iter().enumerate().filter_map(|(index, w)| {
        let field = declaration.fields.get(w.field?)?;
        let place: usize = (0..index).map(|index| numbers(declaration.advected_kind(index))).sum();
        let parameter: usize = declaration.fields.iter().take(w.field?).map(|field| numbers(field.kind)).sum();
        let pairs = (0..numbers(field.kind)).map(move |k| [place + k, parameter + k].map(Literal::usize_unsuffixed));
        Some(pairs.map(|[place, parameter]| quote_spanned!(Span::mixed_site()=> visit(#place, #parameter);)))
    });
    visits.flatten().collect()
}

fn parameter_count(emitter: &Emitter) -> Literal {
    Literal::usize_unsuffixed(emitter.declaration.fields.iter().map(|field| numbers(field.kind)).sum())
}

/// How many scalars `describe` shows of a field.
fn numbers(kind: FieldKind) -> usize {
    let (rows, columns) = shape(kind);
    rows * columns
}

/// The shape of what is shown, row by row.
fn shape(kind: FieldKind) -> (usize, usize) {
    let (rows, columns) = match kind.shape() {
        crate::declared::Shape::Scalar => (1, 1),
        crate::declared::Shape::Matrix(rows, columns) => (rows, columns),
    };
    match kind {
        // The last homogeneous coordinate is a constant.
        FieldKind::Point(_) => (rows - 1, 1),
        _ => (rows, columns),
    }
}

/// Of the scalars of a field those that can change.
fn places(kind: FieldKind) -> impl Iterator<Item = Place> + Clone {
    let (rows, columns) = shape(kind);
    let all = (0..rows).flat_map(move |row| (0..columns).map(move |column| (row, column)));
    all.filter(move |(row, column)| kind != FieldKind::DiagonalInertia || row == column).map(move |(row, column)| {
        let number = row * columns + column;
        if kind == FieldKind::SymmetricInertia {
            return Place { number, row: row.min(column), column: row.max(column), is_half: row != column };
        }
        Place { number, row, column, is_half: false }
    })
}
