//! Parameters that change with time: signals by values at times, of effects and of a file's own declarations; and for those
//! the directions and fields along an orbit.

use std::ops::Range;
use std::path::Path;

use liestep_late::{Between, Signal};
use serde::Deserialize;
use serde::de::IgnoredAny;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use crate::file::effects::EFFECTS;
use crate::file::kepler::Orbit;
use crate::file::mistake::SpanMessage;
use crate::file::orbit::{DipoleField, Nadir, towards_mass};
use crate::file::parameter::in_value;
use crate::file::quantity::{Any, Duration, Scalar, in_si};
use crate::file::tables::Document;

/// A parameter that changes with time.
#[derive(Clone)]
pub(crate) struct OverTime {
    /// The table: an effect, `lagrangian` or `force`, and its number among several.
    pub(crate) table: String,
    pub(crate) number: usize,
    pub(crate) key: String,
    change: Change,
    /// The place of the value.
    pub(crate) span: Range<usize>,
}

#[derive(Clone)]
enum Change {
    Signal(Signal),
    Direction(Orbit),
    Field(Orbit, DipoleField),
}

/// The message about a parameter that follows an orbit where the scene has none.
pub(crate) const NO_ORBIT: &str = "this follows the orbit, and the file has no table `[orbit]`";

/// A signal in a file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SignalTable {
    times: Option<Vec<Scalar<Duration>>>,
    /// Numbers or vectors, which are read by themselves.
    values: Option<IgnoredAny>,
    between: Way,
    csv: Option<String>,
    time: Option<String>,
    columns: Option<Vec<String>>,
    unit: Option<String>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Way {
    Steps,
    Lines,
}

const KEYS: &str = "a signal has `times`, `values` and `between`, \"steps\" or \"lines\"; or in the place of times and values \
                    a `csv`, the name of its column of the `time` and its `columns`";

/// Replaces parameters over time by their values at the start, and returns them. Files are looked for beside the scene.
pub(crate) fn take(document: &mut Document<'_>, path: &Path) -> Result<Vec<OverTime>, SpanMessage> {
    let mut all = Vec::new();
    let orbit = document.get_ref().get("orbit").cloned();
    let context = (path, orbit.as_ref());
    for (name, tables) in document.get_mut().iter_mut() {
        let name = name.get_ref().to_string();
        let is_own = ["lagrangian", "hamiltonian", "force", "nonholonomic"].contains(&name.as_str());
        if !is_own && !EFFECTS.iter().any(|effect| effect.key == name) {
            continue;
        }
        match tables.get_mut() {
            DeValue::Table(table) => of_table((&name, 0, is_own), table, context, &mut all)?,
            DeValue::Array(several) => {
                for (number, table) in several.iter_mut().enumerate() {
                    if let DeValue::Table(table) = table.get_mut() {
                        of_table((&name, number, is_own), table, context, &mut all)?;
                    }
                }
            }
            _ => {}
        }
    }
    Ok(all)
}

fn of_table(
    (name, number, is_own): (&str, usize, bool),
    table: &mut DeTable<'_>,
    (path, orbit): (&Path, Option<&Spanned<DeValue<'_>>>),
    all: &mut Vec<OverTime>,
) -> Result<(), SpanMessage> {
    for (key, value) in table.iter_mut() {
        let source = || ValueDeserializer::from(value.clone());
        // The text of a declaration isn't a parameter.
        let is_word = Nadir::deserialize(source()).is_ok() && !TEXTS.contains(&key.get_ref().as_ref());
        let change = if let Some(signal) = of_value(value, path)? {
            Change::Signal(signal)
        } else if is_own && is_word {
            Change::Direction(of_scene(orbit, value)?)
        } else if is_own && value.get_ref().get("equator").is_some() {
            let dipole = DipoleField::deserialize(source()).map_err(|error| in_value(value, &error))?;
            Change::Field(of_scene(orbit, value)?, dipole)
        } else {
            continue;
        };
        let (key, span) = (key.get_ref().to_string(), value.span());
        let over = OverTime { table: name.to_owned(), number, key, change, span: span.clone() };
        let mut first = over.numbers([over.begin(), 0.0]);
        let text = if let [one] = first[..] { format!("{one:?}") } else { format!("{:?}", std::mem::take(&mut first)) };
        // Tables borrow their text.
        let text: &'static str = Box::leak(format!("value = {text}").into());
        let read = DeTable::parse(text).ok().and_then(|mut table| table.get_mut().remove("value"));
        let Some(read) = read else { return Err((span, KEYS.to_owned())) };
        *value = Spanned::new(span, read.into_inner());
        all.push(over);
    }
    Ok(())
}

/// Keys of a declaration whose values are texts.
const TEXTS: [&str; 9] = ["l", "l_d", "h", "work", "group", "discretise", "velocity", "momentum", "displacement"];

/// The orbit of the scene, for a parameter that follows it.
fn of_scene(orbit: Option<&Spanned<DeValue<'_>>>, value: &Spanned<DeValue<'_>>) -> Result<Orbit, SpanMessage> {
    let orbit = orbit.ok_or_else(|| (value.span(), NO_ORBIT.to_owned()))?;
    Orbit::deserialize(ValueDeserializer::from(orbit.clone())).map_err(|error| in_value(orbit, &error))
}

/// The signal of a value, if it is one.
pub(crate) fn of_value(value: &Spanned<DeValue<'_>>, path: &Path) -> Result<Option<Signal>, SpanMessage> {
    let has = |key: &str| value.get_ref().get(key).is_some();
    if has("times") || has("csv") { signal(value, path).map(Some) } else { Ok(None) }
}

fn signal(value: &Spanned<DeValue<'_>>, path: &Path) -> Result<Signal, SpanMessage> {
    let wrong = |message: String| (value.span(), message);
    let source = ValueDeserializer::from(value.clone());
    let table = SignalTable::deserialize(source).map_err(|error| in_value(value, &error))?;
    let between = match table.between {
        Way::Steps => Between::Steps,
        Way::Lines => Between::Lines,
    };
    let (times, values) = match (table.times, table.values, table.csv) {
        (Some(times), Some(_), None) if table.time.is_none() && table.columns.is_none() => {
            let vectors = listed(value)?;
            if vectors.len() != times.len() {
                return Err(wrong(format!("{} times have as many `values`, found {}", times.len(), vectors.len())));
            }
            let width = vectors.first().map_or(0, Vec::len);
            if width == 0 || vectors.iter().any(|value| value.len() != width) {
                return Err(wrong("the `values` are numbers, or vectors of one length".to_owned()));
            }
            (times.iter().map(|time| time.value).collect(), vectors.concat())
        }
        (None, None, Some(csv)) => {
            let (time, columns) = (table.time.as_deref().unwrap_or("t"), table.columns.unwrap_or_default());
            let from = path.parent().unwrap_or(Path::new("")).join(&csv);
            let text = std::fs::read_to_string(&from);
            let text = text.map_err(|error| wrong(format!("`{csv}` beside the scene can't be read: {error}")))?;
            of_csv(&text, time, &columns).map_err(|message| wrong(format!("`{csv}`: {message}")))?
        }
        _ => return Err(wrong(KEYS.to_owned())),
    };
    let unit = table.unit.unwrap_or_default();
    let size = in_si::<Any>(1.0, &unit).ok_or_else(|| wrong(format!("`{unit}` isn't a unit that is known here")))?;
    let values = values.into_iter().map(|value| value * size).collect();
    Signal::new(times, values, between).map_err(|error| wrong(error.to_string()))
}

/// The numbers of each value.
fn listed(signal: &Spanned<DeValue<'_>>) -> Result<Vec<Vec<f64>>, SpanMessage> {
    let Some(values) = signal.get_ref().get("values") else { return Ok(Vec::new()) };
    let (source, wrong) = (ValueDeserializer::from(values.clone()), |error| in_value(values, &error));
    let are_vectors =
        values.get_ref().as_array().and_then(|list| list.first()).is_some_and(|one| one.get_ref().is_array());
    if !are_vectors {
        let numbers = Vec::<Scalar<Any>>::deserialize(source).map_err(wrong)?;
        return Ok(numbers.iter().map(|number| vec![number.value]).collect());
    }
    let vectors = Vec::<Vec<Scalar<Any>>>::deserialize(source).map_err(wrong)?;
    Ok(vectors.iter().map(|vector| vector.iter().map(|number| number.value).collect()).collect())
}

/// The times and the numbers of columns of a table with commas, whose first line has the names.
fn of_csv(text: &str, time: &str, columns: &[String]) -> Result<(Vec<f64>, Vec<f64>), String> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let (_, head) = lines.next().ok_or("the file is empty")?;
    let names: Vec<&str> = head.split(',').map(|name| name.trim().trim_matches('"')).collect();
    let place = |name: &str| {
        let found = names.iter().position(|own| *own == name);
        let advice = if name == "t" && columns.iter().all(|column| column != name) {
            "; name the one of the times, as `time = \"seconds\"`"
        } else {
            ""
        };
        found.ok_or_else(|| format!("there is no column `{name}`, but {}{advice}", names.join(", ")))
    };
    if columns.is_empty() {
        return Err("name its `columns`, as `columns = [\"x\", \"y\", \"z\"]`".to_owned());
    }
    let at = place(time)?;
    let places = columns.iter().map(|column| place(column)).collect::<Result<Vec<_>, _>>()?;
    let (mut times, mut values) = (Vec::new(), Vec::new());
    for (number, line) in lines {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let cell = |place: usize| {
            let cell = cells.get(place).copied().unwrap_or_default();
            cell.parse::<f64>().map_err(|_| format!("line {} has no number `{}`: `{cell}`", number + 1, names[place]))
        };
        times.push(cell(at)?);
        for &place in &places {
            values.push(cell(place)?);
        }
    }
    Ok((times, values))
}

impl OverTime {
    fn begin(&self) -> f64 {
        if let Change::Signal(signal) = &self.change { signal.ends()[0].max(0.0) } else { 0.0 }
    }

    /// Whether the parameter follows the orbit.
    pub(crate) const fn is_on_orbit(&self) -> bool {
        !matches!(self.change, Change::Signal(_))
    }

    /// The means over a step of this start and length, s; along an orbit the values in its middle.
    pub(crate) fn numbers(&self, [start, length]: [f64; 2]) -> Vec<f64> {
        let middle = start + length * 0.5;
        match &self.change {
            Change::Signal(signal) => {
                let mut numbers = vec![0.0; signal.width()];
                if length == 0.0 {
                    signal.at(start, &mut numbers);
                } else {
                    signal.mean([start, length], &mut numbers);
                }
                numbers
            }
            Change::Direction(orbit) => towards_mass(orbit, middle).as_slice().to_vec(),
            Change::Field(orbit, dipole) => dipole.at(orbit, middle).as_slice().to_vec(),
        }
    }

    /// The signal; none along an orbit.
    pub(crate) const fn signal(&self) -> Option<&Signal> {
        if let Change::Signal(signal) = &self.change { Some(signal) } else { None }
    }
}
