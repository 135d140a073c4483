//! The places of a symbol's entries in arrays of numbers.

use std::collections::BTreeMap;

use super::{Action, Array, Carried, ParameterKind, Source};
use crate::declared::{Declaration, FieldKind, Name};
use crate::mathematics::derive::{Directions, View};
use crate::mathematics::symbolic::{SymbolId, Variance};
use crate::program::Input;

/// A symbol and the array of its entries.
type InArray = (SymbolId, Array);

/// The symbols of a declaration and of its derivation.
pub(super) struct Sources<'a> {
    pub(super) declaration: &'a Declaration,
    pub(super) names: &'a BTreeMap<Name, SymbolId>,
    /// The symbols that the derivation of a step adds.
    pub(super) directions: Option<&'a Directions>,
}

impl Sources<'_> {
    /// The place of an entry; `None` for a direction, which has been replaced by its entries.
    pub(super) fn of(&self, input: Input) -> Option<Source> {
        let group = &self.declaration.group;
        let found = self.names.iter().find(|(_, id)| **id == input.symbol).map(|(name, _)| *name);
        Some(match found {
            Some(Name::Step) => Source::new(Array::Step, 0),
            Some(Name::Velocity(factor)) => Source::new(Array::Velocity, group.component_of(factor) + input.row),
            Some(Name::Increment(factor)) => Source::new(Array::Element, self.entry_of_factor(factor, input)),
            Some(Name::Advected(index)) => Source::new(Array::Advected, self.entry_of_carried(index, input)),
            Some(Name::Field(index)) => Source::new(Array::Parameters, self.entry_of_field(index, input)),
            Some(Name::DisplacementBefore(_) | Name::DisplacementAfter(_)) | None => return self.derived(input),
        })
    }

    fn derived(&self, input: Input) -> Option<Source> {
        let directions = self.directions?;
        if let Some(index) = directions.next.iter().position(|&next| next == input.symbol) {
            return Some(Source::new(Array::Next, self.entry_of_carried(index, input)));
        }
        for (factor, one) in directions.factors.iter().enumerate() {
            let kinds: [InArray; 3] = [
                (one.small, Array::Increment),
                (one.small_inverse, Array::InverseIncrement),
                (one.inverse, Array::Inverse),
            ];
            if let Some((_, array)) = kinds.iter().find(|(symbol, _)| *symbol == input.symbol) {
                return Some(Source::new(*array, self.entry_of_factor(factor, input)));
            }
        }
        let columns: [InArray; 3] = [
            (directions.coordinates, Array::Half),
            (directions.along, Array::Velocity),
            (directions.target, Array::Target),
        ];
        let column = columns.iter().find(|(symbol, _)| *symbol == input.symbol);
        column.map(|(_, array)| Source::new(*array, input.row))
    }

    /// The index of an entry among the matrices of all factors; translations are in the last column.
    fn entry_of_factor(&self, factor: usize, input: Input) -> usize {
        let factors = self.declaration.group.factors();
        let before: usize = factors.iter().take(factor).map(|factor| factor.size * factor.size).sum();
        let own = self.declaration.group.factor(factor);
        before + input.row * own.size + if own.is_added { own.dimension() } else { input.column }
    }

    fn entry_of_carried(&self, index: usize, input: Input) -> usize {
        let shape = |index| carried(self.declaration, index).shape;
        let before: usize = (0..index).map(shape).map(|(rows, columns)| rows * columns).sum();
        let column = match self.declaration.advected_kind(index) {
            FieldKind::Place(coordinates) => coordinates,
            _ => input.column,
        };
        before + input.row * shape(index).1 + column
    }

    fn entry_of_field(&self, index: usize, input: Input) -> usize {
        let kinds = self.declaration.fields.iter().map(|field| parameter_kind(field.kind));
        let before: usize = kinds.clone().take(index).map(ParameterKind::len).sum();
        let kind = kinds.clone().nth(index).unwrap_or(ParameterKind::Scalar);
        before
            + if kind == ParameterKind::DiagonalInertia { input.row } else { input.row * kind.shape().1 + input.column }
    }
}

/// The stored type of a field.
pub(super) fn parameter_kind(kind: FieldKind) -> ParameterKind {
    match kind {
        FieldKind::Scalar => ParameterKind::Scalar,
        FieldKind::SymmetricInertia | FieldKind::StandardInertia => ParameterKind::Inertia,
        FieldKind::DiagonalInertia => ParameterKind::DiagonalInertia,
        FieldKind::Point(rows) => ParameterKind::Vector(rows - 1),
        FieldKind::Matrix(rows) | FieldKind::Configuration(rows) => ParameterKind::Matrix(rows),
        FieldKind::Advected(variance, rows) if variance.is_tensor() => ParameterKind::Matrix(rows),
        FieldKind::Vector(rows) | FieldKind::Place(rows) | FieldKind::Advected(_, rows) => ParameterKind::Vector(rows),
        FieldKind::Given(shape) => ParameterKind::Vector(shape.rows()),
    }
}

/// The action on a parameter, and its stored shape.
pub(super) fn carried(declaration: &Declaration, index: usize) -> Carried {
    let (parameter, kind) = (declaration.advected.get(index), declaration.advected_kind(index));
    let factor = match parameter.map(|w| w.seen) {
        Some(View::Relative { of, from }) => return configuration(declaration, of, Action::Relative { of, from }),
        Some(View::Configuration(of)) => return configuration(declaration, of, Action::Configuration(of)),
        Some(View::From(factor)) => factor,
        None => 0,
    };
    let field = parameter.and_then(|w| w.field);
    let (action, shape) = match kind {
        FieldKind::Given(shape) => (Action::Given, columns_of(shape)),
        FieldKind::Point(rows) => (Action::Point(factor), (rows - 1, 1)),
        FieldKind::Advected(variance, rows) => {
            (Action::Moved(variance, factor), (rows, if variance.is_tensor() { rows } else { 1 }))
        }
        kind => (Action::Moved(Variance::Covector, factor), (kind.shape().rows(), 1)),
    };
    Carried { field, action, shape }
}

fn configuration(declaration: &Declaration, of: usize, action: Action) -> Carried {
    let size = declaration.group.factor(of).size;
    Carried { field: None, action, shape: (size, size) }
}

fn columns_of(shape: crate::declared::Shape) -> (usize, usize) {
    match shape {
        crate::declared::Shape::Scalar => (1, 1),
        crate::declared::Shape::Matrix(rows, columns) => (rows, columns),
    }
}
