//! The derivatives of a step, where they are asked for: `SecondDerivatives`.

use proc_macro2::{Literal, Span, TokenStream};
use quote::quote_spanned;

use super::code::Form;
use super::{Emitter, stages};
use crate::declared::{FieldKind, Name};
use crate::mathematics::symbolic::Rational;
use crate::program::{Linearisation, Node, NodeId};

/// One scalar of the parameters, by its number, with the entry that stands for it.
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

            #[inline(always)]
            fn step_derivatives(&self, increment: &#matrix, w: &Self::Advected, h: #scalar) -> #private::StepDerivatives<#square> {
                #blocks
            }

            #[inline(always)]
            fn by_parameters(&self, increment: &#matrix, w: &Self::Advected, h: #scalar, #visit) {
                #parameters
            }

            #[inline(always)]
            fn by_advected(&self, increment: &#matrix, w: &Self::Advected, h: #scalar, #visit) {
                #advected
            }

            fn carried_parameters(_: &Self::Advected, visit: &mut dyn #private::core::ops::FnMut(#usize, #usize)) {
                #carried
            }
        }
    })
}

fn step_derivatives(emitter: &Emitter, linearisation: &mut Linearisation) -> TokenStream {
    let [[start_by_turn, end_by_turn], [start_by_place, end_by_place]] = linearisation.blocks();
    let all = [start_by_turn, end_by_turn, start_by_place, end_by_place];
    let (lets, values) = statements(emitter, linearisation, &all.concat());
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

/// The `let`s of these outputs, and what they are made of.
fn statements(emitter: &Emitter, linearisation: &Linearisation, outputs: &[NodeId]) -> (TokenStream, Vec<TokenStream>) {
    let (span, private, graph) = (Span::mixed_site(), &emitter.header.private, &linearisation.graph);
    let given = |id: NodeId| match graph.node(id) {
        Node::Input(entry) => Some(emitter.input_token(entry)),
        _ => None,
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
    let (lets, values) = statements(emitter, linearisation, &outputs);
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
    let (mut found, mut first) = (Vec::new(), 0);
    for (index, field) in emitter.declaration.fields.iter().enumerate() {
        let symbol = emitter.names.get(&Name::Field(index)).copied();
        for place in places(field.kind) {
            let Some(symbol) = symbol else { continue };
            let mut derivative = linearisation.by_entry(symbol, place.row, place.column);
            if linearisation.is_nothing(&derivative) {
                continue;
            }
            if place.is_half {
                let half = linearisation.graph.constant(Rational::new(1, 2));
                for node in &mut derivative {
                    *node = linearisation.graph.multiply(half, *node);
                }
            }
            found.push((first + place.number, derivative));
        }
        first += numbers(field.kind);
    }
    visits(emitter, linearisation, &found)
}

fn by_advected(emitter: &Emitter, linearisation: &mut Linearisation) -> TokenStream {
    let (mut found, mut first) = (Vec::new(), 0);
    for index in 0..emitter.declaration.advected.len() {
        let kind = emitter.declaration.advected_kind(index);
        let symbol = emitter.names.get(&Name::Advected(index)).copied();
        for place in places(kind) {
            let Some(symbol) = symbol else { continue };
            let derivative = linearisation.by_entry(symbol, place.row, place.column);
            if !linearisation.is_nothing(&derivative) {
                found.push((first + place.number, derivative));
            }
        }
        first += numbers(kind);
    }
    visits(emitter, linearisation, &found)
}

/// The numbers of the scalars of what is advected, with those that they have among the parameters.
fn carried_parameters(emitter: &Emitter) -> TokenStream {
    let declaration = emitter.declaration;
    let runs = declaration.advected.iter().enumerate().filter_map(|(index, w)| {
        let field = declaration.fields.get(w.field?)?;
        let place: usize = (0..index).map(|index| numbers(declaration.advected_kind(index))).sum();
        let parameter: usize = declaration.fields.iter().take(w.field?).map(|field| numbers(field.kind)).sum();
        let [place, parameter, count] = [place, parameter, numbers(field.kind)].map(Literal::usize_unsuffixed);
        Some(quote_spanned!(Span::mixed_site()=> (0..#count).for_each(|k| visit(#place + k, #parameter + k));))
    });
    let private = &emitter.header.private;
    let runs: Vec<TokenStream> = runs.collect();
    let import =
        (!runs.is_empty()).then(|| quote_spanned!(Span::mixed_site()=> use #private::core::iter::Iterator as _;));
    quote_spanned!(Span::mixed_site()=> #import #(#runs)*)
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
fn places(kind: FieldKind) -> impl Iterator<Item = Place> {
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
