//! The table of a Lagrangian of one's own: its text, derived, with the numbers of its parameters.

use std::collections::BTreeMap;
use std::ops::Range;

use liestep::SO3;
use liestep::groups::Given;
use liestep::mechanics::{Effect as _, Inertia, Term as _, WithEitherKinetic, WithExpensiveKinetic, WithKinetic};
use liestep_late::{Declaration, Late, LateError};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Deserializer};
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error, ValueDeserializer};

use crate::file::body::{Full, Moments};
use crate::file::mistake::{Wrong, advised};
use crate::file::quantity::{Any, Scalar};
use crate::file::tables::Document;

/// What is advected; where it is less, the others are zero.
type Seen = (Vector3<f64>, Vector3<f64>, Vector3<f64>, Vector3<f64>);

/// The energy of a motion with a pace, and three of them.
type SeenWithEnergy = (Given<f64>, Vector3<f64>, Vector3<f64>, Vector3<f64>);

/// A Lagrangian on SO(3), by the kind of its kinetic part.
#[derive(Clone)]
pub(crate) enum Lagrangian {
    Usual(Late<SO3, Seen, WithKinetic>),
    Expensive(Late<SO3, Seen, WithExpensiveKinetic>),
    /// With the energy of its motion.
    Paced(Late<SO3, SeenWithEnergy, WithEitherKinetic>),
}

impl Lagrangian {
    pub(crate) fn declaration(&self) -> &'static Declaration {
        match self {
            Self::Usual(late) => late.declaration(),
            Self::Expensive(late) => late.declaration(),
            Self::Paced(late) => late.declaration(),
        }
    }

    pub(crate) fn has_a_pace(&self) -> bool {
        matches!(self, Self::Paced(_))
    }

    /// The inertia of the limit where the body is not turned.
    pub(crate) fn inertia(&self) -> Matrix3<f64> {
        match self {
            Self::Usual(late) => late.inertia(&late.advected()),
            Self::Expensive(late) => late.inertia(&late.advected()),
            Self::Paced(late) => late.inertia(&late.advected()),
        }
    }
}

const KEYS: &str = "a Lagrangian has `l_d`, or `l` with `discretise`; it may have a `pace`, `advected`, as in \
                    `advected = { w = \"up\" }`, and has a key for each parameter";

/// A parameter: its type in the declaration, and its numbers.
struct Parameter {
    name: String,
    kind: &'static str,
    numbers: Vec<f64>,
}

/// By then the table has been taken: the key is there for the message that lists all keys.
#[allow(clippy::unnecessary_wraps)] // serde asks for it
pub(crate) fn taken<'de, D: Deserializer<'de>>(_: D) -> Result<Option<Lagrangian>, D::Error> {
    Ok(None)
}

/// Takes the table out of a document, if there is one.
pub(crate) fn take(document: &mut Document<'_>) -> Result<Option<Lagrangian>, Wrong> {
    let Some((key, table)) = document.get_mut().remove_entry("lagrangian") else { return Ok(None) };
    let DeValue::Table(table) = table.get_ref() else {
        return Err((key.span(), "`lagrangian` is a table".to_owned()));
    };
    if let Some((other, _)) = document.get_ref().get_key_value("body") {
        return Err((other.span(), "a `lagrangian` has its kinetic energy itself: leave `body` out".to_owned()));
    }
    read(table, &key.span()).map(Some)
}

fn read(table: &DeTable<'_>, place: &Range<usize>) -> Result<Lagrangian, Wrong> {
    let text = |key: &str| match table.get(key) {
        Some(value) => match value.get_ref() {
            DeValue::String(text) => Ok(Some((text.to_string(), value.span()))),
            _ => Err((value.span(), format!("`{key}` is a text"))),
        },
        None => Ok(None),
    };
    let [group, l_d, l] = ["group", "l_d", "l"].map(text);
    let [velocity, discretise, pace] = ["velocity", "discretise", "pace"].map(text);
    if let Some((group, span)) = group?
        && group != "SO3"
    {
        return Err((span, "a file's Lagrangian is on `SO3`; on other groups it is declared in a program".to_owned()));
    }
    let (head, (expression, at)) = match (l_d?, l?, discretise?) {
        (Some(l_d), None, None) => ("l_d".to_owned(), l_d),
        (None, Some(l), Some((discretise, _))) => {
            let velocity = velocity?.map_or_else(|| "Omega".to_owned(), |(name, _)| name);
            (format!("velocity = {velocity}, discretise = {discretise}, l"), l)
        }
        _ => return Err((place.clone(), KEYS.to_owned())),
    };
    let advected = advected(table)?;
    // First, so that the vectors behind it may be as many as there are.
    let (paced, energy) = pace?.map_or_else(Default::default, |(pace, _)| {
        (format!("given(E_0 = E_0_of_the_start), pace = {{ {pace} }}, "), Some("E_0_of_the_start: f64".to_owned()))
    });
    let known = ["group", "l_d", "l", "velocity", "discretise", "pace", "advected"];
    let parameters = table.iter().filter(|(key, _)| !known.contains(&key.get_ref().as_ref()));
    let parameters = parameters.map(|(key, value)| parameter(key.get_ref(), value)).collect::<Result<Vec<_>, _>>()?;
    let fields = parameters.iter().map(|one| format!("{}: {}", one.name, one.kind));
    let fields: Vec<String> = fields.chain(energy.clone()).collect();
    let declared = format!(
        "#[lagrangian(group = SO3, {paced}{advected}{head} =\n{expression}\n)]\nstruct Lagrangian {{ {} }}",
        fields.join(", ")
    );
    let wrong = |error: LateError| {
        let LateError::Mistakes(mistakes) = error else { return (place.clone(), error.to_string()) };
        let Some(first) = mistakes.into_iter().next() else { return (place.clone(), KEYS.to_owned()) };
        let of_key = || first.message.split('`').nth(1).and_then(|name| Some(table.get_key_value(name)?.0.span()));
        let span = placed(&expression, &at, (first.line, first.column)).or_else(of_key);
        // What stands before the expression is of the table.
        let elsewhere = if first.line < 2 { place } else { &at };
        (span.unwrap_or_else(|| elsewhere.clone()), first.message)
    };
    let declaration = Declaration::parse(&declared).map_err(wrong)?;
    let with = |name: &str, error: LateError| {
        (table.get(name).map_or_else(|| place.clone(), Spanned::span), error.to_string())
    };
    macro_rules! numbered {
        ($late:expr) => {
            parameters.iter().try_fold($late.map_err(wrong)?, |late, one| {
                late.with(&one.name, &one.numbers).map_err(|error| with(&one.name, error))
            })?
        };
    }
    Ok(if energy.is_some() {
        let late = numbered!(Late::of(declaration));
        Lagrangian::Paced(late.with("E_0_of_the_start", &[0.0]).map_err(wrong)?)
    } else if declaration.is_expensive {
        Lagrangian::Expensive(numbered!(Late::of(declaration)))
    } else {
        Lagrangian::Usual(numbered!(Late::of(declaration)))
    })
}

/// `advected(w = up), `, if something is.
fn advected(table: &DeTable<'_>) -> Result<String, Wrong> {
    let Some(value) = table.get("advected") else { return Ok(String::new()) };
    let all = BTreeMap::<String, String>::deserialize(ValueDeserializer::from(value.clone()))
        .map_err(|error| in_value(value, &error))?;
    let pairs: Vec<String> = all.into_iter().map(|(name, field)| format!("{name} = {field}")).collect();
    Ok(format!("advected({}), ", pairs.join(", ")))
}

/// The place in the file of a line and a column of the declared text, the second line of which is the first of the
/// expression.
fn placed(expression: &str, at: &Range<usize>, (line, column): (usize, usize)) -> Option<Range<usize>> {
    let lines = || expression.split_inclusive('\n');
    let own = line.checked_sub(2)?;
    let (before, within): (usize, &str) = (lines().take(own).map(str::len).sum(), lines().nth(own)?);
    let within: usize = within.chars().take(column.checked_sub(1)?).map(char::len_utf8).sum();
    // Behind the quotation marks, of which there are as many at the end.
    let marks = at.len().checked_sub(expression.len())?.div_ceil(2);
    let start = at.start + marks + before + within;
    (start < at.end).then_some(start..at.end)
}

/// A parameter by what its value looks like.
fn parameter(name: &str, value: &Spanned<DeValue<'_>>) -> Result<Parameter, Wrong> {
    let source = || ValueDeserializer::from(value.clone());
    let wrong = |error: Error| in_value(value, &error);
    let numbers = |list: Vec<Scalar<Any>>| list.iter().map(|number| number.value).collect::<Vec<f64>>();
    let (kind, numbers) = match value.get_ref() {
        DeValue::Table(_) => {
            let inertia =
                OfInertia::deserialize(source()).map_err(wrong)?.inertia().map_err(|why| (value.span(), why))?;
            // As the letters of the field have it.
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
            (Some(moments), None) => Ok(liestep::NonstandardInertia::from(moments.0).to_inertia()),
            (None, Some(tensor)) => Ok(tensor.0.to_inertia()),
            _ => Err("an inertia is `{ moments = [x, y, z] }`, or `{ tensor = [[…], […], […]] }`".to_owned()),
        }
    }
}
