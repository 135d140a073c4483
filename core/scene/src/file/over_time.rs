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
use crate::file::law::{Kind, Law, Value};
use crate::file::mistake::SpanMessage;
use crate::file::orbit::{DipoleField, Nadir, towards_mass};
use crate::file::parameter::in_value;
use crate::file::quantity::{Any, Duration, Scalar, in_si};
use crate::file::tables::Document;

/// A parameter that changes with time.
#[derive(Clone)]
pub(crate) struct OverTime {
    /// The table: an effect, `lagrangian`, `joint` or another, and its number among several.
    pub(crate) table: String,
    pub(crate) number: usize,
    /// The key; that of a table in this table has both names, as `dipole.field` of a `body`.
    pub(crate) key: String,
    change: Change,
    /// The place of the value.
    pub(crate) span: Range<usize>,
}

#[derive(Clone)]
enum Change {
    Signal(Signal),
    Formula(Law),
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
                    a `csv`, the name of its column of the `time` and its `columns`; or a `formula` over the time `t` alone";

/// Replaces parameters over time by their values at the start, and returns them. Files are looked for beside the scene.
pub(crate) fn take(document: &mut Document<'_>, path: &Path) -> Result<Vec<OverTime>, SpanMessage> {
    let mut all = Vec::new();
    let orbit = document.get_ref().get("orbit").cloned();
    let context = (path, orbit.as_ref());
    for (name, tables) in document.get_mut().iter_mut() {
        let name = name.get_ref().to_string();
        let is_of_bodies = name == "body" || tables.get_ref().is_array() && OF_SEVERAL.contains(&name.as_str());
        if !is_of_bodies && !OWN.contains(&name.as_str()) && !EFFECTS.iter().any(|effect| effect.key == name) {
            continue;
        }
        match tables.get_mut() {
            DeValue::Table(table) => of_table((&name, 0, ""), table, context, &mut all)?,
            DeValue::Array(several) => {
                for (number, table) in several.iter_mut().enumerate() {
                    if let DeValue::Table(table) = table.get_mut() {
                        of_table((&name, number, ""), table, context, &mut all)?;
                    }
                }
            }
            _ => {}
        }
    }
    Ok(all)
}

/// Tables of a file's own declarations.
const OWN: [&str; 4] = ["lagrangian", "hamiltonian", "force", "nonholonomic"];
/// Tables between several bodies.
const OF_SEVERAL: [&str; 2] = ["joint", "spring"];

/// Takes the parameters of a table by its name and its number among several; keys begin with the prefix.
fn of_table(
    (name, number, prefix): (&str, usize, &str),
    table: &mut DeTable<'_>,
    (path, orbit): (&Path, Option<&Spanned<DeValue<'_>>>),
    all: &mut Vec<OverTime>,
) -> Result<(), SpanMessage> {
    let is_own = OWN.contains(&name);
    for (key, value) in table.iter_mut() {
        let source = || ValueDeserializer::from(value.clone());
        // The text of a declaration isn't a parameter.
        let is_word = is_own && Nadir::deserialize(source()).is_ok() && !TEXTS.contains(&key.get_ref().as_ref());
        let change = if let Some(signal) = of_value(value, path)? {
            Change::Signal(signal)
        } else if let Some(formula) = value.get_ref().get("formula") {
            Change::Formula(of_formula(formula, value)?)
        } else if is_word {
            Change::Direction(of_scene(orbit, value)?)
        } else if is_own && value.get_ref().get("equator").is_some() {
            let dipole = DipoleField::deserialize(source()).map_err(|error| in_value(value, &error))?;
            Change::Field(of_scene(orbit, value)?, dipole)
        } else {
            if let DeValue::Table(inner) = value.get_mut()
                && !is_own
            {
                of_table((name, number, &format!("{prefix}{}.", key.get_ref())), inner, (path, orbit), all)?;
            }
            continue;
        };
        let (key, span) = (format!("{prefix}{}", key.get_ref()), value.span());
        if name == "body" && (key == "J" || key == "J.effective") {
            return Err((span, "an inertia over time is that of principal `moments`, or of `J_d`".to_owned()));
        }
        let over = OverTime { table: name.to_owned(), number, key, change, span: span.clone() };
        let first = over.stand_in();
        if !first.iter().all(|number| number.is_finite()) {
            return Err((span, format!("this has no value at the start, but {first:?}")));
        }
        let text = if let [one] = first[..] { format!("{one:?}") } else { format!("{first:?}") };
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

/// The formula of a text over the time `t`, alone in its table.
fn of_formula(formula: &Spanned<DeValue<'_>>, value: &Spanned<DeValue<'_>>) -> Result<Law, SpanMessage> {
    let wrong = |message: String| (formula.span(), message);
    let is_alone = value.get_ref().as_table().is_some_and(|table| table.len() == 1);
    let text = formula.get_ref().as_str().filter(|_| is_alone).ok_or_else(|| wrong(FORMULA.to_owned()))?;
    Law::of(text, &[("t".to_owned(), Kind::Number)]).map(|(law, _)| law).map_err(wrong)
}

const FORMULA: &str =
    "a formula is a text over the time `t` in SI units, alone in its table: `{ formula = \"0.2 * sin(3 * t)\" }`";

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

    /// Numbers in the place of the value while the file is read: those of the start, and for zero another value of the signal, as
    /// a term that is off at times has a number above zero in a file.
    pub(crate) fn stand_in(&self) -> Vec<f64> {
        let first = self.numbers([self.begin(), 0.0]);
        let is_on = |value: &&[f64]| value.iter().any(|number| *number != 0.0);
        let values = self.signal().filter(|_| !is_on(&first.as_slice()));
        let other = values.and_then(|signal| signal.values().chunks(signal.width()).find(is_on));
        other.map_or(first, <[f64]>::to_vec)
    }

    /// The subject of the change in words: the table, and of one of several bodies the effect on it.
    pub(crate) fn subject(&self) -> String {
        let effect = self.key.split_once('.').filter(|_| self.table == "body").map(|(effect, _)| effect);
        effect.unwrap_or(&self.table).replace('_', " ")
    }

    /// Whether the parameter follows the orbit.
    pub(crate) const fn is_on_orbit(&self) -> bool {
        matches!(self.change, Change::Direction(_) | Change::Field(..))
    }

    /// The means over a step of this start and length, s; by a formula and along an orbit the values in its middle.
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
            Change::Formula(law) => match law.value(&[Value::Number(middle)]) {
                Value::Number(number) => vec![number],
                Value::Vector(vector) => vector.as_slice().to_vec(),
            },
            Change::Direction(orbit) => towards_mass(orbit, middle).as_slice().to_vec(),
            Change::Field(orbit, dipole) => dipole.at(orbit, middle).as_slice().to_vec(),
        }
    }

    /// The signal by values; none by a formula and along an orbit.
    pub(crate) const fn signal(&self) -> Option<&Signal> {
        if let Change::Signal(signal) = &self.change { Some(signal) } else { None }
    }
}
