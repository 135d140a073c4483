//! What an ensemble draws: the table `ensemble`, read.

use std::borrow::Cow;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::file::effects::EFFECTS;
use crate::file::mistake::Wrong;
use crate::file::scene::SceneFile;
use crate::file::tables::{Keys, dotted, ends};

/// The scenes of an ensemble: each draws its values, by what the one who runs it draws with.
#[derive(Clone)]
#[non_exhaustive]
pub struct SceneEnsemble {
    /// How many members there are.
    pub members: u64,
    /// What they are drawn with.
    pub seed: u64,
    /// The number of steps from one row of a member to the next; if it isn't given the columns are kept at the end only.
    pub every: Option<u64>,
    /// The number of members that are made at a time and kept in one file, and at most lost where a run is ended.
    pub chunk: Option<u64>,
    /// The whole file, by which one ensemble is told from another.
    pub text: String,
    pub(crate) axes: Vec<Axis>,
    pub(crate) path: PathBuf,
    /// The tables of which something is drawn, and a member that has the others; without such a member, all tables.
    pub(crate) tables: DeTable<'static>,
    pub(crate) like: Option<Box<SceneFile>>,
}

/// What a value is drawn from; in the unit that the file has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// Each value from the first to below the second as likely.
    Uniform {
        /// The least.
        from: f64,
        /// The end.
        to: f64,
    },
    /// The normal distribution.
    Normal {
        /// Its mean.
        mean: f64,
        /// Its standard deviation.
        deviation: f64,
    },
}

/// A key, and what of its value is drawn.
#[derive(Clone)]
pub(crate) struct Axis {
    pub(crate) keys: Keys,
    /// One where the value is none of a list.
    pub(crate) components: Vec<Component>,
    pub(crate) is_list: bool,
    pub(crate) span: Range<usize>,
}

#[derive(Clone)]
pub(crate) enum Component {
    Draw(Draw),
    /// Where in the text its value stands.
    Fixed(Range<usize>),
}

#[derive(Clone)]
pub(crate) struct Draw {
    name: String,
    spread: Spread,
    pub(crate) unit: String,
    /// That of its first number.
    span: Range<usize>,
}

/// More couldn't be counted by the steps they take.
const MOST_MEMBERS: u64 = 1_000_000_000;

pub(crate) const DRAW: &str = "a value is drawn by `{ from = …, to = … }`, each between as likely, or by \
                    `{ mean = …, deviation = … }`, normally: two numbers, or texts with the same unit";
const PARTS: &str = "`ensemble` has `members`, may have `seed`, `every` and `chunk`, and says in `draw` what is drawn";
/// The tables of which something may be drawn.
fn drawable() -> impl Iterator<Item = &'static str> {
    ["body", "lagrangian", "force"].into_iter().chain(EFFECTS.iter().map(|effect| effect.key)).chain(["start"])
}

impl SceneEnsemble {
    /// What is drawn, by its names, and from what.
    pub fn draws(&self) -> impl Iterator<Item = (&str, Spread)> {
        let components = self.axes.iter().flat_map(|axis| &axis.components);
        components.filter_map(|component| match component {
            Component::Draw(draw) => Some((draw.name.as_str(), draw.spread)),
            Component::Fixed(_) => None,
        })
    }
}

impl Component {
    /// As it could have been written, with the next of these numbers where one is drawn.
    pub(crate) fn text(&self, file: &str, numbers: &mut impl Iterator<Item = f64>) -> String {
        match self {
            Self::Draw(Draw { unit, .. }) => {
                let number = numbers.next().unwrap_or(f64::NAN);
                if unit.is_empty() { format!("{number:?}") } else { format!("\"{number:?} {unit}\"") }
            }
            Self::Fixed(span) => file.get(span.clone()).unwrap_or_default().to_owned(),
        }
    }

    pub(crate) fn span(&self) -> Range<usize> {
        match self {
            Self::Draw(draw) => draw.span.clone(),
            Self::Fixed(span) => span.clone(),
        }
    }
}

/// The table of a file, read, without a member.
pub(crate) fn parts((path, text): (&Path, &str), table: &Spanned<DeValue<'_>>) -> Result<SceneEnsemble, Wrong> {
    let DeValue::Table(inner) = table.get_ref() else { return Err((table.span(), "`ensemble` is a table".to_owned())) };
    let (path, text) = (path.to_owned(), text.to_owned());
    let mut ensemble = SceneEnsemble {
        members: 0,
        seed: 0,
        every: None,
        chunk: None,
        text,
        axes: Vec::new(),
        path,
        tables: DeTable::new(),
        like: None,
    };
    for (key, value) in inner {
        let whole = |range: RangeInclusive<u64>| {
            let number = value
                .get_ref()
                .as_integer()
                .and_then(|number| u64::from_str_radix(number.as_str(), number.radix()).ok());
            let (least, most) = (range.start(), range.end());
            let message = || format!("`{}` is a whole number from {least} to {most}", key.get_ref());
            number.filter(|number| range.contains(number)).ok_or_else(|| (value.span(), message()))
        };
        match key.get_ref().as_ref() {
            "members" => ensemble.members = whole(1..=MOST_MEMBERS)?,
            "seed" => ensemble.seed = whole(0..=i64::MAX.unsigned_abs())?,
            "every" => ensemble.every = Some(whole(1..=MOST_MEMBERS)?),
            "chunk" => ensemble.chunk = Some(whole(1..=MOST_MEMBERS)?),
            "draw" => match value.get_ref() {
                DeValue::Table(draws) => {
                    ensemble.axes = ends(draws, &leads_on).into_iter().map(axis).collect::<Result<_, _>>()?;
                }
                _ => return Err((value.span(), "`draw` is a table of keys".to_owned())),
            },
            _ => return Err((key.span(), PARTS.to_owned())),
        }
    }
    if ensemble.members == 0 {
        return Err((table.span(), format!("an ensemble has `members`; {PARTS}")));
    }
    if ensemble.axes.is_empty() {
        return Err((table.span(), format!("`ensemble` draws nothing; {PARTS}")));
    }
    // The order of a table's keys is none of its own.
    ensemble.axes.sort_by_key(|axis| axis.span.start);
    Ok(ensemble)
}

/// A key with what of its value is drawn.
fn axis((keys, value): (Keys, &Spanned<DeValue<'_>>)) -> Result<Axis, Wrong> {
    if let Some(key) = keys.first().filter(|key| !drawable().any(|name| name == key.get_ref())) {
        let drawn: Vec<_> = drawable().map(|name| format!("`{name}`")).collect();
        return Err((key.span(), format!("an ensemble draws what is in {}", drawn.join(", "))));
    }
    let name = dotted(&keys);
    let (components, is_list) = match value.get_ref() {
        DeValue::Table(inner) => (vec![Component::Draw(drawn(inner, &value.span(), name)?)], false),
        DeValue::Array(values) => {
            let component = |(place, part): (usize, &Spanned<DeValue<'_>>)| match part.get_ref() {
                DeValue::Table(inner) => {
                    drawn(inner, &part.span(), format!("{name}.{}", place + 1)).map(Component::Draw)
                }
                _ => Ok(Component::Fixed(part.span())),
            };
            let components = values.iter().enumerate().map(component).collect::<Result<Vec<_>, _>>()?;
            if !components.iter().any(|component| matches!(component, Component::Draw(_))) {
                return Err((value.span(), DRAW.to_owned()));
            }
            (components, true)
        }
        _ => return Err((value.span(), DRAW.to_owned())),
    };
    Ok(Axis { keys, components, is_list, span: value.span() })
}

/// Whether a table says no distribution, but has tables that do.
fn leads_on(table: &DeTable<'_>) -> bool {
    !table.is_empty() && !DISTRIBUTIONS.as_flattened().iter().any(|end| table.contains_key(*end))
}

/// The two numbers of each distribution.
const DISTRIBUTIONS: [[&str; 2]; 2] = [["from", "to"], ["mean", "deviation"]];

fn drawn(table: &DeTable<'_>, span: &Range<usize>, name: String) -> Result<Draw, Wrong> {
    let wrong = |span: Range<usize>| (span, DRAW.to_owned());
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    let (first, _) = *entries.first().ok_or_else(|| wrong(span.clone()))?;
    // The first key says which it is.
    let is_of = |kind: &[&str; 2], key: &Spanned<Cow<'_, str>>| kind.contains(&key.get_ref().as_ref());
    let kind = DISTRIBUTIONS.iter().find(|kind| is_of(kind, first)).ok_or_else(|| wrong(first.span()))?;
    if let Some((key, _)) = entries.iter().find(|(key, _)| !is_of(kind, key)) {
        return Err(wrong(key.span()));
    }
    let number = |key: &str| {
        let value = table.get(key).ok_or_else(|| wrong(span.clone()))?;
        let (number, unit) = measured(value.get_ref()).ok_or_else(|| wrong(value.span()))?;
        Ok((number, unit, value.span()))
    };
    let [(first, unit, span), (second, other, behind)] = [number(kind[0])?, number(kind[1])?];
    if unit != other {
        return Err(wrong(behind));
    }
    let spread = if *kind == DISTRIBUTIONS[0] {
        // Their difference is to be a number, too.
        if !(second > first && (second - first).is_finite()) {
            return Err((behind, "a range goes from a number to a larger one".to_owned()));
        }
        Spread::Uniform { from: first, to: second }
    } else {
        if second < 0.0 {
            return Err((behind, "a standard deviation isn't below zero".to_owned()));
        }
        Spread::Normal { mean: first, deviation: second }
    };
    Ok(Draw { name, spread, unit, span })
}

/// A number and its unit.
pub(crate) fn measured(value: &DeValue<'_>) -> Option<(f64, String)> {
    let (number, unit) = match value {
        DeValue::Integer(number) if number.radix() == 10 => (number.as_str().to_owned(), String::new()),
        DeValue::Float(number) => (number.as_str().to_owned(), String::new()),
        DeValue::String(text) => {
            let (number, unit) = text.trim().split_once(' ')?;
            (number.to_owned(), unit.trim().to_owned())
        }
        _ => return None,
    };
    let number: f64 = number.parse().ok()?;
    (number.is_finite() && !unit.contains(['"', '\\']) && !unit.chars().any(char::is_control)).then_some((number, unit))
}
