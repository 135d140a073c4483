//! The table of a Lagrangian or a force of the file's own: its text is derived, and its parameters have numbers.

use std::collections::BTreeMap;
use std::ops::Range;

use liestep::SO3;
use liestep::groups::Given;
use liestep::mechanics::{Effect as _, Inertia, KineticPart, Term as _, WithKinetic, WithoutKinetic};
use liestep_derivation::Role;
use liestep_late::{Declaration, Late, LateError};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Deserializer};
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error, ValueDeserializer};

use crate::file::body::{Full, Moments};
use crate::file::mistake::{Wrong, advised};
use crate::file::quantity::{Any, Scalar};
use crate::file::tables::Document;

/// The backend of programs: machine code with the feature `machine`, an interpreter without. Results agree to the bit.
#[cfg(feature = "machine")]
pub(crate) type Backend = liestep_machine::Machine;
#[cfg(not(feature = "machine"))]
pub(crate) type Backend = liestep_late::Interpreter;

/// The advected vectors of a Lagrangian, up to four; unused ones are zero.
type Seen = (Vector3<f64>, Vector3<f64>, Vector3<f64>, Vector3<f64>);

/// The energy of a motion with a pace, and up to three advected vectors.
type SeenWithEnergy = (Given<f64>, Vector3<f64>, Vector3<f64>, Vector3<f64>);

/// A Lagrangian or a force on SO(3), with the numbers of its parameters.
#[derive(Clone)]
pub(crate) struct Declared {
    pub(crate) declaration: &'static Declaration,
    pub(crate) numbers: Vec<f64>,
    pub(crate) has_a_pace: bool,
}

impl Declared {
    /// The effect with this kinetic part.
    pub(crate) fn late<K: KineticPart>(&self) -> Result<Late<SO3, Seen, K, Backend>, LateError> {
        Late::of(self.declaration)?.with_all(&self.numbers)
    }

    /// The effect with a pace, which advects its energy, too.
    pub(crate) fn paced(&self) -> Result<Late<SO3, SeenWithEnergy, WithKinetic, Backend>, LateError> {
        Late::of(self.declaration)?.with_all(&self.numbers)
    }

    /// The inertia of the continuous limit at the identity attitude.
    pub(crate) fn inertia(&self) -> Option<Matrix3<f64>> {
        if self.has_a_pace {
            return self.paced().ok().map(|late| late.inertia(&late.advected()));
        }
        self.late::<WithKinetic>().ok().map(|late| late.inertia(&late.advected()))
    }
}

const KEYS: &str = "a Lagrangian has `l_d`, or `l` with `discretise`; it may have a `pace`, `advected`, as in \
                    `advected = { w = \"up\" }`, and has a key for each parameter";
const KEYS_OF_FORCES: &str = "a force has `work`; it may have `advected`, as in `advected = { w = \"up\" }`, and has a \
                              key for each parameter";

/// Field name for the energy of a motion with a pace.
const ENERGY: &str = "E_0_of_the_start";

/// A parameter: its type in the declaration, and its numbers.
struct Parameter {
    name: String,
    kind: &'static str,
    numbers: Vec<f64>,
}

/// Deserialises nothing, as [`take`] removes the table first. Messages that list all keys need the key.
#[allow(clippy::unnecessary_wraps)] // serde requires a `Result`
pub(crate) fn taken<'de, D: Deserializer<'de>>(_: D) -> Result<Option<Declared>, D::Error> {
    Ok(None)
}

/// Removes the table of a Lagrangian or a force from a document, and reads it.
pub(crate) fn take(document: &mut Document<'_>, role: Role) -> Result<Option<Declared>, Wrong> {
    let name = if role == Role::Force { "force" } else { "lagrangian" };
    let Some((key, table)) = document.get_mut().remove_entry(name) else { return Ok(None) };
    let DeValue::Table(table) = table.get_ref() else {
        return Err((key.span(), format!("`{name}` is a table")));
    };
    if let Some((other, _)) = document.get_ref().get_key_value("body").filter(|_| role == Role::Lagrangian) {
        return Err((other.span(), "a `lagrangian` has its kinetic energy itself: leave `body` out".to_owned()));
    }
    read(table, &key.span(), role).map(Some)
}

/// The declaration's arguments before the expression and before the advected vectors; the expression, and its place.
type Expression = ([String; 2], (String, Range<usize>));

fn expression(table: &DeTable<'_>, place: &Range<usize>, role: Role) -> Result<Expression, Wrong> {
    let text = |key: &str| match table.get(key) {
        Some(value) => match value.get_ref() {
            DeValue::String(text) => Ok(Some((text.to_string(), value.span()))),
            _ => Err((value.span(), format!("`{key}` is a text"))),
        },
        None => Ok(None),
    };
    if let Some((group, span)) = text("group")?
        && group != "SO3"
    {
        return Err((span, "a file's Lagrangian is on `SO3`; on other groups it is declared in a program".to_owned()));
    }
    if role == Role::Force {
        let work = text("work")?.ok_or_else(|| (place.clone(), KEYS_OF_FORCES.to_owned()))?;
        return Ok((["work".to_owned(), String::new()], work));
    }
    let [l_d, l, velocity, discretise, pace] = ["l_d", "l", "velocity", "discretise", "pace"].map(text);
    // The energy comes first, so that any number of advected vectors can follow.
    let pace = pace?.map(|(pace, _)| format!("given(E_0 = {ENERGY}), pace = {{ {pace} }}, ")).unwrap_or_default();
    match (l_d?, l?, discretise?) {
        (Some(l_d), None, None) => Ok((["l_d".to_owned(), pace], l_d)),
        (None, Some(l), Some((discretise, _))) => {
            let velocity = velocity?.map_or_else(|| "Omega".to_owned(), |(name, _)| name);
            Ok(([format!("velocity = {velocity}, discretise = {discretise}, l"), pace], l))
        }
        _ => Err((place.clone(), KEYS.to_owned())),
    }
}

fn read(table: &DeTable<'_>, place: &Range<usize>, role: Role) -> Result<Declared, Wrong> {
    let ([head, pace], (expression, at)) = expression(table, place, role)?;
    let advected = advected(table)?;
    let known: &[&str] = match role {
        Role::Force => &["group", "work", "advected"],
        _ => &["group", "l_d", "l", "velocity", "discretise", "pace", "advected"],
    };
    let mut parameters: Vec<_> = table.iter().filter(|(key, _)| !known.contains(&key.get_ref().as_ref())).collect();
    // The reader sorts keys by the alphabet; the file's order determines the roundings.
    parameters.sort_by_key(|(key, _)| key.span().start);
    let mut parameters =
        parameters.into_iter().map(|(key, value)| parameter(key.get_ref(), value)).collect::<Result<Vec<_>, _>>()?;
    let has_a_pace = !pace.is_empty();
    if has_a_pace {
        parameters.push(Parameter { name: ENERGY.to_owned(), kind: "f64", numbers: vec![0.0] });
    }
    let fields: Vec<String> = parameters.iter().map(|one| format!("{}: {}", one.name, one.kind)).collect();
    let (attribute, name) = if role == Role::Force { ("force", "Force") } else { ("lagrangian", "Lagrangian") };
    let declared = format!(
        "#[{attribute}(group = SO3, {pace}{advected}{head} =\n{expression}\n)]\nstruct {name} {{ {} }}",
        fields.join(", ")
    );
    let wrong = |error: LateError| {
        let LateError::Mistakes(mistakes) = error else { return (place.clone(), error.to_string()) };
        let Some(first) = mistakes.into_iter().next() else { return (place.clone(), KEYS.to_owned()) };
        let of_key = || first.message.split('`').nth(1).and_then(|name| Some(table.get_key_value(name)?.0.span()));
        let span = placed(&expression, &at, (first.line, first.column)).or_else(of_key);
        // A mistake in the first line, before the expression, concerns the table.
        let elsewhere = if first.line < 2 { place } else { &at };
        (span.unwrap_or_else(|| elsewhere.clone()), first.message)
    };
    let declaration = Declaration::parse(&declared).map_err(wrong)?;
    let numbers = parameters.into_iter().flat_map(|one| one.numbers).collect();
    let declared = Declared { declaration, numbers, has_a_pace };
    let fits = match role {
        Role::Force => declared.late::<WithoutKinetic>().map(|_| ()),
        _ if has_a_pace => declared.paced().map(|_| ()),
        _ => declared.late::<WithKinetic>().map(|_| ()),
    };
    fits.map_err(wrong).map(|()| declared)
}

/// The argument `advected(w = up), `, empty without advected vectors.
fn advected(table: &DeTable<'_>) -> Result<String, Wrong> {
    let Some(value) = table.get("advected") else { return Ok(String::new()) };
    let all = BTreeMap::<String, Spanned<String>>::deserialize(ValueDeserializer::from(value.clone()))
        .map_err(|error| in_value(value, &error))?;
    let mut all: Vec<_> = all.into_iter().collect();
    all.sort_by_key(|(_, field)| field.span().start);
    let pairs: Vec<String> = all.into_iter().map(|(name, field)| format!("{name} = {}", field.get_ref())).collect();
    Ok(format!("advected({}), ", pairs.join(", ")))
}

/// The place in the file of a line and a column of the declared text, whose second line is the expression's first.
fn placed(expression: &str, at: &Range<usize>, (line, column): (usize, usize)) -> Option<Range<usize>> {
    let lines = || expression.split_inclusive('\n');
    let own = line.checked_sub(2)?;
    let (before, within): (usize, &str) = (lines().take(own).map(str::len).sum(), lines().nth(own)?);
    let within: usize = within.chars().take(column.checked_sub(1)?).map(char::len_utf8).sum();
    // The opening quotation marks are as long as the closing ones.
    let marks = at.len().checked_sub(expression.len())?.div_ceil(2);
    let start = at.start + marks + before + within;
    (start < at.end).then_some(start..at.end)
}

/// A parameter, with the type that its value suggests.
fn parameter(name: &str, value: &Spanned<DeValue<'_>>) -> Result<Parameter, Wrong> {
    let source = || ValueDeserializer::from(value.clone());
    let wrong = |error: Error| in_value(value, &error);
    let numbers = |list: Vec<Scalar<Any>>| list.iter().map(|number| number.value).collect::<Vec<f64>>();
    let (kind, numbers) = match value.get_ref() {
        DeValue::Table(_) => {
            let inertia =
                OfInertia::deserialize(source()).map_err(wrong)?.inertia().map_err(|why| (value.span(), why))?;
            // A name with the suffix `_d` has the nonstandard inertia.
            let is_nonstandard = name.ends_with("_d");
            let matrix = if is_nonstandard { *inertia.to_nonstandard().as_matrix() } else { *inertia.as_matrix() };
            (if is_nonstandard { "NonstandardInertia" } else { "Inertia" }, matrix.as_slice().to_vec())
        }
        DeValue::Array(rows) if matches!(rows.first().map(Spanned::get_ref), Some(DeValue::Array(_))) => {
            let rows = Vec::<Vec<Scalar<Any>>>::deserialize(source()).map_err(wrong)?;
            if rows.len() != 3 || rows.iter().any(|row| row.len() != 3) {
                return Err((value.span(), "a matrix has three rows of three numbers".to_owned()));
            }
            ("Matrix3<f64>", rows.into_iter().flat_map(numbers).collect())
        }
        DeValue::Array(_) => {
            let vector = numbers(Vec::<Scalar<Any>>::deserialize(source()).map_err(wrong)?);
            if vector.len() != 3 {
                return Err((value.span(), format!("a vector has three numbers, found {}", vector.len())));
            }
            ("Vector3<f64>", vector)
        }
        _ => ("f64", vec![Scalar::<Any>::deserialize(source()).map_err(wrong)?.value]),
    };
    Ok(Parameter { name: name.to_owned(), kind, numbers })
}

fn in_value(value: &Spanned<DeValue<'_>>, error: &Error) -> Wrong {
    (error.span().unwrap_or_else(|| value.span()), advised(error.message()))
}

/// An inertia by its principal moments, or by its tensor.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OfInertia {
    moments: Option<Moments>,
    tensor: Option<Full>,
}

impl OfInertia {
    fn inertia(self) -> Result<Inertia, String> {
        match (self.moments, self.tensor) {
            (Some(moments), None) => Ok(moments.J),
            (None, Some(tensor)) => Ok(tensor.0),
            _ => Err("an inertia is `{ moments = [x, y, z] }`, or `{ tensor = [[…], […], […]] }`".to_owned()),
        }
    }
}
