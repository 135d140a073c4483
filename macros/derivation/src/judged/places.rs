//! The parameters by which a step can be differentiated, in the order of `describe`.

use std::collections::BTreeMap;

use crate::declared::{Declaration, FieldKind, Name, Shape};
use crate::mathematics::symbolic::SymbolId;
use crate::program::Place;

/// The names of the fields and of the advected parameters, with their kinds.
pub fn variables(declaration: &Declaration) -> [Vec<(Name, FieldKind)>; 2] {
    let fields = declaration.fields.iter().enumerate().map(|(index, field)| (Name::Field(index), field.kind));
    let advected =
        (0..declaration.advected.len()).map(|index| (Name::Advected(index), declaration.advected_kind(index)));
    [fields.collect(), advected.collect()]
}

/// The entries of the fields and of the advected parameters that can change; each of the two lists has its own numbers.
pub(super) fn places(declaration: &Declaration, names: &BTreeMap<Name, SymbolId>) -> [Vec<Place>; 2] {
    variables(declaration).map(|each| {
        let (mut found, mut first) = (Vec::new(), 0);
        for (name, kind) in each {
            found.extend(names.get(&name).into_iter().flat_map(|&symbol| of_kind(kind, symbol, first)));
            first += count(kind);
        }
        found
    })
}

/// The number of entries of a field in `describe`.
pub fn count(kind: FieldKind) -> usize {
    let (rows, columns) = shape(kind);
    rows * columns
}

/// The shape of a field in `describe`, by rows.
pub(super) fn shape(kind: FieldKind) -> (usize, usize) {
    match (kind.shape(), kind) {
        (Shape::Scalar, _) => (1, 1),
        // The last homogeneous coordinate is a constant.
        (Shape::Matrix(rows, _), FieldKind::Point(_)) => (rows - 1, 1),
        (Shape::Matrix(rows, columns), _) => (rows, columns),
    }
}

/// The entries of a field that can change.
fn of_kind(kind: FieldKind, symbol: SymbolId, first: usize) -> impl Iterator<Item = Place> {
    let (rows, columns) = shape(kind);
    let all = (0..rows).flat_map(move |row| (0..columns).map(move |column| (row, column)));
    all.filter(move |(row, column)| kind != FieldKind::DiagonalInertia || row == column).map(move |(row, column)| {
        let place = Place { number: first + row * columns + column, symbol, row, column, is_half: false };
        if kind.is_inertia() && kind != FieldKind::DiagonalInertia {
            return Place { row: row.min(column), column: row.max(column), is_half: row != column, ..place };
        }
        place
    })
}
