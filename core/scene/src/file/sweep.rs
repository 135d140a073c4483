//! Scenes that differ in some of their values: the table `sweep`.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::file::mistake::{Mistake, SpanMessage};
use crate::file::tables::{Document, Keys, dotted, ends, measured, set};

/// The scenes of a sweep: one for each combination of its values. The last key varies fastest.
#[derive(Clone)]
#[non_exhaustive]
pub struct Sweep<S> {
    /// The varied keys, such as `gravity.m`, in the order of the file.
    pub names: Vec<String>,
    /// Each scene, with the texts of its varied values.
    pub points: Vec<(Vec<String>, S)>,
}

/// Most scenes of a sweep, each of which is a run.
const MOST_POINTS: usize = 10_000;

/// A varied key, and the place of its values.
struct Axis<'a> {
    keys: Keys,
    values: Values<'a>,
    span: Range<usize>,
}

enum Values<'a> {
    Listed(Vec<Spanned<DeValue<'a>>>),
    /// Values of a range, each as a text.
    Spread(Vec<String>),
}

impl Axis<'_> {
    fn len(&self) -> usize {
        match &self.values {
            Values::Listed(values) => values.len(),
            Values::Spread(texts) => texts.len(),
        }
    }

    fn value(&self, number: usize) -> Result<Spanned<DeValue<'_>>, SpanMessage> {
        match &self.values {
            Values::Listed(values) => Ok(values[number].clone()),
            Values::Spread(texts) => {
                let value = DeValue::parse(&texts[number]).map_err(|_| (self.span.clone(), RANGE.to_owned()))?;
                Ok(Spanned::new(self.span.clone(), value.into_inner()))
            }
        }
    }
}

/// The sweep of a document; `located` finds the place of a mistake, and `scene` reads one scene.
pub(crate) fn read<S>(
    document: &Document<'_>,
    table: &Spanned<DeValue<'_>>,
    located: &dyn Fn(SpanMessage) -> Mistake,
    scene: &dyn Fn(&Document<'_>) -> Result<S, Mistake>,
) -> Result<Sweep<S>, Mistake> {
    let DeValue::Table(inner) = table.get_ref() else {
        return Err(located((table.span(), "`sweep` is a table".to_owned())));
    };
    let ends = ends(inner, &|table| !table.contains_key("from"));
    let mut axes = ends.into_iter().map(axis).collect::<Result<Vec<_>, _>>().map_err(located)?;
    axes.sort_by_key(|axis| axis.span.start);
    let count = axes.iter().try_fold(1_usize, |count, axis| count.checked_mul(axis.len()));
    let Some(count) = count.filter(|count| *count <= MOST_POINTS) else {
        return Err(located((table.span(), format!("`sweep` makes more than {MOST_POINTS} scenes"))));
    };
    if axes.is_empty() {
        return Err(located((table.span(), "`sweep` has no key to vary".to_owned())));
    }
    let mut points = Vec::with_capacity(count);
    for number in 0..count {
        let mut varied = document.clone();
        let (mut values, mut rest) = (Vec::new(), number);
        for axis in axes.iter().rev() {
            let value = axis.value(rest % axis.len()).map_err(located)?;
            rest /= axis.len();
            values.push(shown(value.get_ref()));
            set(varied.get_mut(), &axis.keys, value).map_err(located)?;
        }
        values.reverse();
        points.push((values, scene(&varied)?));
    }
    Ok(Sweep { names: axes.iter().map(|axis| dotted(&axis.keys)).collect(), points })
}

/// A varied key with its values.
fn axis<'a>((keys, value): (Keys, &Spanned<DeValue<'a>>)) -> Result<Axis<'a>, SpanMessage> {
    let wrong = |message: &str| Err((value.span(), message.to_owned()));
    let values = match value.get_ref() {
        DeValue::Array(values) if values.is_empty() => return wrong("a sweep has a value at least"),
        DeValue::Array(values) => Values::Listed(values.iter().cloned().collect()),
        DeValue::Table(range) => Values::Spread(spread(range, &value.span())?),
        _ => return wrong("a sweep is a list of values, or `{ from = …, to = …, count = … }`"),
    };
    Ok(Axis { keys, values, span: value.span() })
}

const RANGE: &str =
    "a range is `{ from = …, to = …, count = … }`: two numbers, or texts with the same unit, and how many";

/// Equally spaced values, both ends included.
fn spread(range: &DeTable<'_>, span: &Range<usize>) -> Result<Vec<String>, SpanMessage> {
    let wrong = || (span.clone(), RANGE.to_owned());
    let get = |key| range.get(key).map(Spanned::get_ref).filter(|_| range.len() == 3).ok_or_else(wrong);
    let end = |key| measured(get(key)?).ok_or_else(wrong);
    let ((from, unit), (to, other)) = (end("from")?, end("to")?);
    let count = get("count")?.as_integer().and_then(|count| count.as_str().parse::<u32>().ok()).ok_or_else(wrong)?;
    if unit != other || count < 2 {
        return Err(wrong());
    }
    if count as usize > MOST_POINTS {
        return Err((span.clone(), format!("a range has at most {MOST_POINTS} values")));
    }
    let text = |k: u32| {
        let part = f64::from(k) / f64::from(count - 1);
        let number = from * (1.0 - part) + to * part;
        if unit.is_empty() { format!("{number:?}") } else { format!("\"{number:?} {unit}\"") }
    };
    Ok((0..count).map(text).collect())
}

/// A value as written. Lists are separated by spaces, as commas separate columns.
fn shown(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => {
            text.chars().filter(|letter| !letter.is_control() && !",\"".contains(*letter)).collect()
        }
        DeValue::Integer(number) => number.to_string(),
        DeValue::Float(number) => number.to_string(),
        DeValue::Boolean(truth) => truth.to_string(),
        DeValue::Datetime(time) => time.to_string(),
        DeValue::Array(values) => values.iter().map(|value| shown(value.get_ref())).collect::<Vec<_>>().join(" "),
        DeValue::Table(table) => {
            let entries = table.iter().map(|(key, value)| format!("{} {}", key.get_ref(), shown(value.get_ref())));
            entries.collect::<Vec<_>>().join(" ")
        }
    }
}
