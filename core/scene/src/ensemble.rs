//! Scenes whose values are drawn: the table `ensemble`.

use std::borrow::Cow;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

use liestep::SO3;
use liestep::motion::{AnyState, AnyStepper, Moment};
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::choose;
use crate::columns::{Column, Row};
use crate::document::{Document, Wrong, scene, set, span};
use crate::file::{Pace, SceneFile};
use crate::mistake::{Mistake, place_of};
use crate::run::Sample;
use crate::sweep::measured;

/// The scenes of an ensemble: each draws its values, by what the one who runs it draws with.
#[derive(Clone)]
pub struct Drawn {
    members: u64,
    seed: u64,
    every: Option<u64>,
    chunk: Option<u64>,
    axes: Vec<Axis>,
    path: PathBuf,
    text: String,
}

/// What steps a scene, and the state that it starts from.
pub type Started = (AnyStepper<SO3, ()>, AnyState<SO3, ()>);

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
struct Axis {
    keys: Vec<Spanned<String>>,
    /// One where the value is none of a list.
    components: Vec<Component>,
    is_list: bool,
    span: Range<usize>,
}

#[derive(Clone)]
enum Component {
    Draw(Draw),
    /// Where in the text its value stands.
    Fixed(Range<usize>),
}

#[derive(Clone)]
struct Draw {
    name: String,
    spread: Spread,
    unit: String,
    /// That of its first number.
    span: Range<usize>,
}

/// More couldn't be counted by the steps they take.
const MOST_MEMBERS: u64 = 1_000_000_000;

const DRAW: &str = "a value is drawn by `{ from = …, to = … }`, each between as likely, or by \
                    `{ mean = …, deviation = … }`, normally: two numbers, or texts with the same unit";
const PARTS: &str = "`ensemble` has `members`, may have `seed`, `every` and `chunk`, and says in `draw` what is drawn";
const DRAWN: [&str; 11] = [
    "body",
    "gravity",
    "gravity_gradient",
    "dipole",
    "spring",
    "rotor",
    "drag",
    "magnetic_damping",
    "torque",
    "thrust",
    "start",
];

impl Drawn {
    /// How many members there are.
    #[must_use]
    pub fn members(&self) -> u64 {
        self.members
    }

    /// What they are drawn with.
    #[must_use]
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// After each so many steps the columns are kept, too, and not at the end only.
    #[must_use]
    pub fn every(&self) -> Option<u64> {
        self.every
    }

    /// So many members are made at a time and kept in one file, and at most lost where a run is ended.
    #[must_use]
    pub fn chunk(&self) -> Option<u64> {
        self.chunk
    }

    /// The whole file, by which one ensemble is told from another.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The scene of a member, with numbers that are drawn by their names: `gravity.m`, and of components
    /// `start.velocity.1` to `start.velocity.3`.
    ///
    /// # Errors
    ///
    /// A [`Mistake`] where there is no such scene, as of a mass below zero.
    pub fn member(&self, draw: &mut dyn FnMut(&str, Spread) -> f64) -> Result<SceneFile, Mistake> {
        let mut document =
            DeTable::parse(&self.text).map_err(|error| Mistake::of_toml(&self.path, &self.text, &error))?;
        for table in ["sweep", "ensemble"] {
            document.get_mut().remove(table);
        }
        self.with_values(document, draw)
    }

    fn with_values(
        &self,
        document: Document<'_>,
        draw: &mut dyn FnMut(&str, Spread) -> f64,
    ) -> Result<SceneFile, Mistake> {
        let located = |(span, message): Wrong| Mistake::at(&self.path, place_of(&self.text, &span), message);
        // As they could have been written.
        let texts: Vec<Vec<String>> = self
            .axes
            .iter()
            .map(|axis| axis.components.iter().map(|part| part.text(&self.text, draw)).collect())
            .collect();
        let span = document.span();
        let mut varied = document.into_inner();
        for (Axis { keys, components, is_list, span }, texts) in self.axes.iter().zip(&texts) {
            let mut values = DeArray::new();
            for (component, text) in components.iter().zip(texts) {
                let value = DeValue::parse(text).map_err(|_| located((component.span(), DRAW.to_owned())))?;
                values.push(Spanned::new(component.span(), value.into_inner()));
            }
            let value = match values.iter().next() {
                Some(value) if !is_list => value.clone(),
                _ => Spanned::new(span.clone(), DeValue::Array(values)),
            };
            set(&mut varied, keys, value).map_err(located)?;
        }
        scene(&self.path, &self.text, &Spanned::new(span, varied))
    }
}

impl Component {
    fn text(&self, file: &str, draw: &mut dyn FnMut(&str, Spread) -> f64) -> String {
        match self {
            Self::Draw(Draw { name, spread, unit, .. }) => {
                let number = draw(name, *spread);
                if unit.is_empty() { format!("{number:?}") } else { format!("\"{number:?} {unit}\"") }
            }
            Self::Fixed(span) => file.get(span.clone()).unwrap_or_default().to_owned(),
        }
    }

    fn span(&self) -> Range<usize> {
        match self {
            Self::Draw(draw) => draw.span.clone(),
            Self::Fixed(span) => span.clone(),
        }
    }
}

impl SceneFile {
    /// What steps the scene, with the state that it starts from.
    ///
    /// # Errors
    ///
    /// A [`Mistake`] of the kind [`Run`](crate::Kind::Run) where it can't be started.
    pub fn stepper(&self) -> Result<Started, Mistake> {
        choose::stepper(self).map_err(|stopped| self.stopped(stopped))
    }

    /// How many steps the scene asks for; none where they are chosen for an accuracy.
    #[must_use]
    pub fn steps(&self) -> Option<u64> {
        match self.run.pace {
            Pace::Step { steps, .. } => Some(steps.into()),
            Pace::Accuracy(_) => None,
        }
    }

    /// The numbers of its columns in a moment of such a stepper, one after the other. Of the two quaternions it is either.
    #[must_use]
    pub fn numbers(columns: &[Column], now: &Moment<'_, AnyStepper<SO3, ()>>) -> Vec<f64> {
        Row::new(Sample::of(now)).numbers(columns)
    }
}

/// The ensemble that a table says; `scene` has what isn't drawn.
pub(crate) fn read(
    (path, text): (&Path, &str),
    document: &Document<'_>,
    table: &Spanned<DeValue<'_>>,
    file: &SceneFile,
) -> Result<Drawn, Mistake> {
    let located = |(span, message): Wrong| Mistake::at(path, place_of(text, &span), message);
    let mut ensemble = parts(table).map_err(located)?;
    let wrong = |keys: &[&str], message: String| Err(located((span(document, keys), message)));
    if file.asks_for_accuracy() {
        return wrong(&["run", "accuracy"], "the members of an ensemble make the same steps: give a `step`".to_owned());
    }
    if let Some(column) = file.columns().iter().find(|column| column.is_since_the_start()) {
        let names = column.names().join(", ");
        return wrong(
            &["output", "columns"],
            format!("an ensemble keeps states, and `{names}` is measured from the start of a run; leave it out"),
        );
    }
    let written = table.get_ref().as_table().and_then(|table| table.get("every"));
    if let (Some(every), Some(steps), Some(value)) = (ensemble.every, file.steps(), written)
        && every > steps
    {
        let message =
            format!("a run has {steps} steps, so none is kept on its way; leave `every` out to keep the ends only");
        return Err(located((value.span(), message)));
    }
    for Axis { keys, .. } in &ensemble.axes {
        // What a file doesn't have isn't there because of a number that is drawn.
        let [tables @ .., _] = keys.as_slice() else { continue };
        let mut here = Some(document.get_ref());
        for key in tables {
            let name = key.get_ref();
            let inner = here.and_then(|table| table.get(name.as_str()));
            if inner.is_none() {
                let message =
                    format!("the file has no `{name}`, of which something could be drawn; write the table `[{name}]`");
                return Err(located((key.span(), message)));
            }
            here = inner.and_then(|value| value.get_ref().as_table());
        }
    }
    (ensemble.path, ensemble.text) = (path.to_owned(), text.to_owned());
    // What is wrong with a unit or a key is wrong with every member.
    for end in [true, false] {
        ensemble.with_values(document.clone(), &mut |_, spread| match spread {
            Spread::Uniform { from, to } => {
                if end {
                    from
                } else {
                    to
                }
            }
            Spread::Normal { mean, .. } => mean,
        })?;
    }
    Ok(ensemble)
}

/// The table, read.
fn parts(table: &Spanned<DeValue<'_>>) -> Result<Drawn, Wrong> {
    let DeValue::Table(inner) = table.get_ref() else { return Err((table.span(), "`ensemble` is a table".to_owned())) };
    let mut ensemble = Drawn {
        members: 0,
        seed: 0,
        every: None,
        chunk: None,
        axes: Vec::new(),
        path: PathBuf::new(),
        text: String::new(),
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
                DeValue::Table(draws) => collect(draws, &[], &mut ensemble.axes)?,
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

/// Tables are ways, distributions and lists of them their ends.
fn collect(table: &DeTable<'_>, way: &[Spanned<String>], axes: &mut Vec<Axis>) -> Result<(), Wrong> {
    for (key, value) in table {
        if way.is_empty() && !DRAWN.contains(&key.get_ref().as_ref()) {
            return Err((
                key.span(),
                format!("an ensemble draws what is in {}", DRAWN.map(|name| format!("`{name}`")).join(", ")),
            ));
        }
        let key = Spanned::new(key.span(), key.get_ref().to_string());
        let keys: Vec<_> = way.iter().cloned().chain([key]).collect();
        let name = keys.iter().map(|key| key.get_ref().as_str()).collect::<Vec<_>>().join(".");
        let (components, is_list) = match value.get_ref() {
            DeValue::Table(inner) if DISTRIBUTIONS.as_flattened().iter().any(|end| inner.contains_key(*end)) => {
                (vec![Component::Draw(drawn(inner, &value.span(), name)?)], false)
            }
            DeValue::Table(inner) if inner.is_empty() => return Err((value.span(), DRAW.to_owned())),
            DeValue::Table(inner) => {
                collect(inner, &keys, axes)?;
                continue;
            }
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
        axes.push(Axis { keys, components, is_list, span: value.span() });
    }
    Ok(())
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
