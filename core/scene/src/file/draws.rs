//! Random draws of an ensemble: reading the table `ensemble`.

use std::borrow::Cow;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::file::column::Column;
use crate::file::effects::EFFECTS;
use crate::file::histogram::{self, EndHistogram};
use crate::file::mistake::{Mistake, SpanMessage};
use crate::file::quantity::ratio;
use crate::file::scene_file::SceneFile;
use crate::file::tables::{Keys, dotted, ends, measured};

/// The scenes of an ensemble. Each draws its values with the caller's random numbers.
#[derive(Clone)]
#[non_exhaustive]
pub struct SceneEnsemble {
    /// Number of members.
    pub members: u64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Steps from one row of a member to the next. Without it, only the columns at the end are recorded.
    pub every: Option<u64>,
    /// Number of members that are simulated together and stored in one file, and at most lost when a run is
    /// interrupted.
    pub chunk: Option<u64>,
    /// The histograms of columns at the ends of members.
    pub histograms: Vec<EndHistogram>,
    /// The columns of members: those that the file lists, or those of its runs that a member has.
    pub columns: Vec<Column>,
    /// A remark about a histogram of an angle by numbers alone, with its place.
    pub note: Option<Mistake>,
    /// A text that identifies the ensemble: the file's values but its title and the number of members, and those of its
    /// signals.
    pub identity: String,
    /// The text of the whole file.
    pub(crate) text: String,
    pub(crate) axes: Vec<Axis>,
    pub(crate) path: PathBuf,
    /// The tables with drawn values, to be put into the member `like`. Without such a member, as for several bodies, all tables
    /// of the file.
    pub(crate) tables: DeTable<'static>,
    pub(crate) like: Option<Box<SceneFile>>,
}

/// The distribution of a value, in the file's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// The uniform distribution on a half-open interval.
    Uniform {
        /// Lower bound, included.
        from: f64,
        /// Upper bound, excluded.
        to: f64,
    },
    /// The normal distribution.
    Normal {
        /// Mean of the distribution.
        mean: f64,
        /// Standard deviation of the distribution.
        deviation: f64,
    },
}

/// A key, and the distribution of its value.
#[derive(Clone)]
pub(crate) struct Axis {
    pub(crate) keys: Keys,
    /// Components of a list, or a single one for any other value.
    pub(crate) components: Vec<Component>,
    pub(crate) is_list: bool,
    pub(crate) span: Range<usize>,
}

#[derive(Clone)]
pub(crate) enum Component {
    Draw(Draw),
    /// The place in the text of a value that isn't drawn.
    Fixed(Range<usize>),
}

#[derive(Clone)]
pub(crate) struct Draw {
    name: String,
    spread: Spread,
    pub(crate) unit: String,
    /// Place of the first number.
    span: Range<usize>,
}

/// Most members: the total number of their steps has to be countable.
const MOST_MEMBERS: u64 = 1_000_000_000;

pub(crate) const DRAW: &str = "a value is drawn by `{ from = …, to = … }`, each between as likely, or by \
                    `{ mean = …, deviation = … }`, normally: two numbers, or texts with units of one quantity; a \
                    deviation may be one of the mean, as \"10 %\"";
const PARTS: &str = "`ensemble` has `members`, may have `seed`, `every`, `chunk` and a `histogram`, and says in `draw` \
                     what is drawn";
/// Lists of tables, in which a table is found by its name.
pub(crate) const LISTED: [&str; 3] = ["control", "wheel", "pointing"];

/// The tables whose values can be drawn.
fn drawable() -> impl Iterator<Item = &'static str> {
    let effects = EFFECTS.iter().map(|effect| effect.key);
    let first = ["body", "orbit", "lagrangian", "hamiltonian", "force", "nonholonomic"].into_iter().chain(effects);
    first.chain(["start"]).chain(LISTED).chain(["joint"])
}

impl SceneEnsemble {
    /// Names and distributions of the drawn values.
    pub fn draws(&self) -> impl Iterator<Item = (&str, Spread)> {
        let components = self.axes.iter().flat_map(|axis| &axis.components);
        components.filter_map(|component| match component {
            Component::Draw(draw) => Some((draw.name.as_str(), draw.spread)),
            Component::Fixed(_) => None,
        })
    }
}

impl SceneEnsemble {
    /// Whether a number is drawn by which columns are read from a state, or events are found: of the orbit, of the angle of an
    /// axis, of the axis or the inertia of a wheel, or of the zero of a joint.
    #[must_use]
    pub fn draws_what_columns_read(&self) -> bool {
        self.axes.iter().any(|Axis { keys, .. }| {
            let of = |at: usize| keys.get(at).map_or("", |key| key.get_ref().as_str());
            ["orbit", "pointing"].contains(&of(0))
                || of(0) == "wheel" && ["axis", "inertia"].contains(&of(2))
                || of(0) == "joint" && of(2) == "zero"
        })
    }
}

impl Component {
    /// The component's text in a file. A drawn value takes the next of these numbers.
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

/// The table's entries, read without making a member.
pub(crate) fn parts((path, text): (&Path, &str), table: &Spanned<DeValue<'_>>) -> Result<SceneEnsemble, SpanMessage> {
    let DeValue::Table(inner) = table.get_ref() else { return Err((table.span(), "`ensemble` is a table".to_owned())) };
    let (path, text) = (path.to_owned(), text.to_owned());
    let mut ensemble = SceneEnsemble {
        members: 0,
        seed: 0,
        every: None,
        chunk: None,
        histograms: Vec::new(),
        columns: Vec::new(),
        note: None,
        identity: String::new(),
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
            "histogram" => ensemble.histograms = histogram::read(value)?,
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
    // Tables are sorted by keys: the file's order is restored.
    ensemble.axes.sort_by_key(|axis| axis.span.start);
    Ok(ensemble)
}

/// A key with the distribution of its value.
fn axis((keys, value): (Keys, &Spanned<DeValue<'_>>)) -> Result<Axis, SpanMessage> {
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

/// Whether a table has no distribution of its own, but tables that may have.
fn leads_on(table: &DeTable<'_>) -> bool {
    !table.is_empty() && !DISTRIBUTIONS.as_flattened().iter().any(|end| table.contains_key(*end))
}

/// The two keys of each distribution.
const DISTRIBUTIONS: [[&str; 2]; 2] = [["from", "to"], ["mean", "deviation"]];

fn drawn(table: &DeTable<'_>, span: &Range<usize>, name: String) -> Result<Draw, SpanMessage> {
    let wrong = |span: Range<usize>| (span, DRAW.to_owned());
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    let (first, _) = *entries.first().ok_or_else(|| wrong(span.clone()))?;
    // The first key selects the distribution.
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
    let [(first, one, span), (second, other, behind)] = [number(kind[0])?, number(kind[1])?];
    let is_share = kind[1] == "deviation" && other == "%";
    let (second, unit) = match (&*one, &*other) {
        (_, "%") if is_share => (first.abs() * (second / 100.0), one),
        (one_unit, other_unit) if one_unit == other_unit => (second, one),
        // Zero has any unit.
        (_, "") if second == 0.0 => (second, one),
        ("", _) if first == 0.0 => (second, other),
        _ => match ratio(&other, &one) {
            Some(ratio) => (second * ratio, one),
            None => return Err(wrong(behind)),
        },
    };
    let spread = if *kind == DISTRIBUTIONS[0] {
        // The width of the interval has to be finite, too.
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
