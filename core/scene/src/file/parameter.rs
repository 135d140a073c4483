//! Parameters of a declaration of the file's own: the type that a value suggests, and its numbers.

use std::ops::Range;

use liestep::mechanics::Inertia;
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error, ValueDeserializer};

use crate::file::body::{InertiaRows, Moments};
use crate::file::mistake::{SpanMessage, advised};
use crate::file::quantity::{Any, Scalar};

/// A parameter: its name, its type in the declaration, and its numbers, those of a matrix row by row.
pub(crate) struct Parameter {
    pub(crate) name: String,
    pub(crate) kind: String,
    pub(crate) numbers: Vec<f64>,
}

/// The keys of tables for what is carried otherwise than a covector.
const CARRIED: [&str; 4] = ["point", "contravariant", "covariant", "mixed"];

const TABLES: &str = "a table is an inertia, `{ moments = [x, y, z] }` or `{ tensor = [[…], […], […]] }`, or what a group \
                      carries otherwise than a covector: `{ point = […] }`, `{ contravariant = […] }` for a vector or a \
                      tensor, `{ covariant = [[…], …] }`, `{ mixed = [[…], …] }`";

/// Numbers with the shape in which they are written.
struct NumberArray {
    /// The number of rows, and whether they are those of a square matrix; no rows for a number alone.
    rows: usize,
    is_matrix: bool,
    numbers: Vec<f64>,
}

impl Parameter {
    /// The parameter of a key.
    pub(crate) fn of(name: &str, value: &Spanned<DeValue<'_>>) -> Result<Self, SpanMessage> {
        let (kind, numbers) = match value.get_ref() {
            DeValue::Table(table) => typed(name, table, value)?,
            _ => match array(value)? {
                NumberArray { rows: 0, numbers, .. } => ("f64".to_owned(), numbers),
                NumberArray { rows, is_matrix: true, numbers } => (format!("SMatrix<f64, {rows}, {rows}>"), numbers),
                NumberArray { rows, numbers, .. } => (format!("SVector<f64, {rows}>"), numbers),
            },
        };
        Ok(Self { name: name.to_owned(), kind, numbers })
    }
}

/// The type and the numbers of a parameter that is a table.
fn typed(name: &str, table: &DeTable<'_>, value: &Spanned<DeValue<'_>>) -> Result<(String, Vec<f64>), SpanMessage> {
    let wrong = |span: Range<usize>| Err((span, TABLES.to_owned()));
    let Some((key, inner)) = CARRIED.iter().find_map(|key| table.get_key_value(*key)) else {
        let is_known = |key: &str| ["moments", "tensor"].contains(&key);
        if let Some((key, _)) = table.iter().find(|(key, _)| !is_known(key.get_ref())) {
            return wrong(key.span());
        }
        let source = ValueDeserializer::from(value.clone());
        let inertia = OfInertia::deserialize(source).map_err(|error| in_value(value, &error))?;
        let Some(inertia) = inertia.inertia() else { return wrong(value.span()) };
        // A name with the suffix `_d`, and a number of a body behind it, has the nonstandard inertia.
        let unnumbered = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
        let is_nonstandard = name.ends_with("_d") || unnumbered.trim_end_matches('_').ends_with("_d");
        let matrix = if is_nonstandard { *inertia.to_nonstandard().as_matrix() } else { *inertia.as_matrix() };
        let kind = if is_nonstandard { "NonstandardInertia" } else { "Inertia" };
        return Ok((kind.to_owned(), matrix.as_slice().to_vec()));
    };
    if let Some((other, _)) = table.iter().find(|(other, _)| other.get_ref() != key.get_ref()) {
        return wrong(other.span());
    }
    let NumberArray { rows, is_matrix, numbers } = array(inner)?;
    let kind = match (key.get_ref().as_ref(), is_matrix) {
        ("point", false) if (1..4).contains(&rows) => format!("Point{rows}<f64>"),
        ("contravariant", false) if rows > 0 => format!("ContravariantVector<f64, {rows}>"),
        ("contravariant", true) => format!("ContravariantTensor<f64, {rows}>"),
        ("covariant", true) => format!("CovariantTensor<f64, {rows}>"),
        ("mixed", true) => format!("MixedTensor<f64, {rows}>"),
        _ => return wrong(inner.span()),
    };
    Ok((kind, numbers))
}

/// A number, a vector or a square matrix.
fn array(value: &Spanned<DeValue<'_>>) -> Result<NumberArray, SpanMessage> {
    let source = || ValueDeserializer::from(value.clone());
    let wrong = |error: Error| in_value(value, &error);
    let numbers = |list: &[Scalar<Any>]| list.iter().map(|number| number.value).collect::<Vec<f64>>();
    match value.get_ref() {
        DeValue::Array(list) if list.is_empty() => Err((value.span(), "a vector has a number at least".to_owned())),
        DeValue::Array(list) if matches!(list.first().map(Spanned::get_ref), Some(DeValue::Array(_))) => {
            let matrix = Vec::<Vec<Scalar<Any>>>::deserialize(source()).map_err(wrong)?;
            let rows = matrix.len();
            if let Some((row, place)) = matrix.iter().zip(list.iter()).find(|(row, _)| row.len() != rows) {
                let message =
                    format!("a matrix is square: {rows} rows have {rows} numbers each, and this {}", row.len());
                return Err((place.span(), message));
            }
            Ok(NumberArray { rows, is_matrix: true, numbers: matrix.iter().flat_map(|row| numbers(row)).collect() })
        }
        DeValue::Array(_) => {
            let vector = Vec::<Scalar<Any>>::deserialize(source()).map_err(wrong)?;
            Ok(NumberArray { rows: vector.len(), is_matrix: false, numbers: numbers(&vector) })
        }
        _ => {
            let number = Scalar::<Any>::deserialize(source()).map_err(wrong)?;
            Ok(NumberArray { rows: 0, is_matrix: false, numbers: vec![number.value] })
        }
    }
}

/// The numbers of a list of this many numbers; a list of one may be a number alone.
pub(crate) fn list(value: &Spanned<DeValue<'_>>, what: &str, length: usize) -> Result<Vec<f64>, SpanMessage> {
    let NumberArray { rows, is_matrix, numbers } = array(value)?;
    if !is_matrix && numbers.len() == length && (rows > 0 || length == 1) {
        return Ok(numbers);
    }
    let found = if is_matrix { "a matrix".to_owned() } else { numbers.len().to_string() };
    Err((value.span(), format!("{what} has {length} numbers here, found {found}")))
}

/// The entries of a square matrix of this many rows, row by row.
pub(crate) fn matrix(value: &Spanned<DeValue<'_>>, what: &str, expected: usize) -> Result<Vec<f64>, SpanMessage> {
    let NumberArray { rows, is_matrix, numbers } = array(value)?;
    if is_matrix && rows == expected {
        return Ok(numbers);
    }
    Err((value.span(), format!("{what} is a matrix of {expected} rows of {expected} numbers here")))
}

/// The mistake of a value, with the place that the reader names.
pub(crate) fn in_value(value: &Spanned<DeValue<'_>>, error: &Error) -> SpanMessage {
    (error.span().unwrap_or_else(|| value.span()), advised(error.message()))
}

/// An inertia by its principal moments, or by its tensor.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OfInertia {
    moments: Option<Moments>,
    tensor: Option<InertiaRows>,
}

impl OfInertia {
    fn inertia(self) -> Option<Inertia> {
        match (self.moments, self.tensor) {
            (Some(moments), None) => Some(moments.J),
            (None, Some(tensor)) => Some(tensor.0),
            _ => None,
        }
    }
}
