//! The scenes of an ensemble, and conflicts with the file's other tables.

use std::ops::Range;
use std::path::Path;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::file::bare::read_as_rad;
use crate::file::column::Column;
use crate::file::control::{Motor, Wheel};
use crate::file::document;
use crate::file::draws::{Axis, Component, DRAW, LISTED, SceneEnsemble, Spread, parts};
use crate::file::event::{Event, Quantity};
use crate::file::mistake::{Mistake, SpanMessage, place_of};
use crate::file::scene::Scene;
use crate::file::scene_file::SceneFile;
use crate::file::tables::{Document, set, span};

impl SceneEnsemble {
    /// The scene of a member. `draw` returns a number for each name: `gravity.m`, or `start.velocity.1` to
    /// `start.velocity.3` for components.
    ///
    /// # Errors
    ///
    /// A [`Mistake`] where the drawn numbers make no valid scene, such as a negative mass.
    pub fn member(&self, draw: &mut dyn FnMut(&str, Spread) -> f64) -> Result<Scene, Mistake> {
        let numbers: Vec<f64> = self.draws().map(|(name, spread)| draw(name, spread)).collect();
        self.numbered(&numbers).map_or_else(|| self.written(&numbers), Ok).map(Scene::from)
    }

    /// The scene of another member with these numbers in it; none where a value can only be read from a text.
    fn numbered(&self, numbers: &[f64]) -> Option<SceneFile> {
        let (mut numbers, mut scene) = (numbers.iter(), self.like.clone()?);
        for Axis { keys, components, .. } in &self.axes {
            let [table, key] = keys.as_slice() else { return None };
            for (component, part) in components.iter().enumerate() {
                if let Component::Draw(drawn) = part {
                    let keys = [table, key].map(|key| key.get_ref().as_str());
                    scene.put(keys, component, *numbers.next()?, &drawn.unit).then_some(())?;
                }
            }
        }
        Some(*scene)
    }

    /// The scene read from tables in which these numbers are written.
    fn written(&self, numbers: &[f64]) -> Result<SceneFile, Mistake> {
        let located = |(span, message): SpanMessage| Mistake::at(&self.path, place_of(&self.text, &span), message);
        let mut numbers = numbers.iter().copied();
        let mut text = |part: &Component| part.text(&self.text, &mut numbers);
        let texts: Vec<Vec<String>> =
            self.axes.iter().map(|axis| axis.components.iter().map(&mut text).collect()).collect();
        let mut varied: DeTable<'_> = self.tables.clone();
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
        let Some(own) = &self.like else {
            return document::scene(&self.path, &self.text, &Spanned::new(0..self.text.len(), varied));
        };
        let mut own = own.clone();
        for (name, table) in varied {
            own.set(name.get_ref(), &table).map_err(located)?;
        }
        Ok(*own)
    }
}

/// The text that identifies an ensemble: the values of its file, without those by which no member changes, and those of
/// signals, which may be in tables beside the file. Comments and the order of keys are left out, too.
fn identity(text: &str, file: &SceneFile) -> String {
    let mut values = text.parse::<toml::Table>().unwrap_or_default();
    values.remove("title");
    values.get_mut("ensemble").and_then(toml::Value::as_table_mut).and_then(|own| own.remove("members"));
    let of_wheel = |wheel: &Wheel| if let Motor::Signal(signal) = &wheel.motor { Some(signal.clone()) } else { None };
    let over_time = file.over_time.iter().filter_map(|one| one.signal().cloned());
    let signals = over_time.chain(file.wheel.iter().filter_map(of_wheel));
    let lines = signals.map(|signal| format!("\n# {signal:?}"));
    core::iter::once(values.to_string()).chain(lines).collect()
}

/// The parts of a scene by which members have columns and events, or not.
struct Parts<'a> {
    events: &'a [Event],
    /// Whether something changes with time, so that the energy isn't known between two steps.
    changes: bool,
    /// The place of the first number that is read by what a member may draw.
    first: usize,
    /// Whether joints have limits, which are events.
    is_limited: bool,
}

impl<'a> Parts<'a> {
    fn of(scene: &'a Scene) -> Self {
        let file = &scene.file;
        let (events, changes) = (&file.event, file.changing().is_some());
        Self { events, changes, first: file.behind_motion(), is_limited: file.event_names().len() > events.len() }
    }
}

/// Whether a column is read by what a member may draw: an orbit, an axis, a wheel, a joint.
fn is_read_by_draws(column: &Column) -> bool {
    ["pointing", "roll-pitch-yaw", "wheel-speeds", "angle", "shift", "torque"].contains(&column.key())
}

/// The columns of a run that members have, too.
fn default_columns(ensemble: &SceneEnsemble, scene: &Scene) -> Vec<Column> {
    let Parts { events, changes, .. } = Parts::of(scene);
    let (has_events, draws) = (scene.events().next().is_some(), ensemble.draws_what_columns_read());
    let is_known = |column: &&Column| {
        let is_unknown_between = changes && column.key() == "energy" && !events.is_empty();
        !(column.is_since_the_start() || is_unknown_between || draws && has_events && is_read_by_draws(column))
    };
    scene.columns().iter().filter(is_known).cloned().collect()
}

/// Conflicts with columns: those that a member has none of, and those that its events can't know; `at` finds the place of keys.
fn of_columns(ensemble: &SceneEnsemble, scene: &Scene, at: &dyn Fn(&[&str]) -> Range<usize>) -> Option<SpanMessage> {
    let wrong = |keys: &[&str], message: String| Some((at(keys), message));
    let columns = &ensemble.columns;
    if let Some(column) = columns.iter().find(|column| column.is_since_the_start()) {
        let names = column.names().collect::<Vec<_>>().join(", ");
        let why = "is measured from the start of a run; leave it out";
        return wrong(&["output", "columns"], format!("an ensemble keeps states, and `{names}` {why}"));
    }
    let names: Vec<&str> = columns.iter().flat_map(Column::names).collect();
    if let Some(one) = ensemble.histograms.iter().find(|one| !names.contains(&one.column.as_str())) {
        let message = format!("the `columns` of the file have no `{}`, but {}", one.column, names.join(", "));
        return Some((one.span.clone(), message));
    }
    let Parts { events, changes, first, is_limited } = Parts::of(scene);
    let why = "where something changes with time the energy of a member isn't known between its steps, where events are: leave";
    if changes && !events.is_empty() && columns.iter().any(|column| column.key() == "energy") {
        return wrong(&["output", "columns"], format!("{why} `energy` out of `columns`, or the event out of the file"));
    }
    if changes && events.iter().any(|event| matches!(event.quantity, Quantity::Energy(_))) {
        return wrong(&["event"], format!("{why} the event out of the file, or `ensemble`"));
    }
    let is_seen = |event: &Event| matches!(event.quantity, Quantity::Column(place, _) | Quantity::Angle(place, _) if place >= first);
    let has_events = scene.events().next().is_some();
    if ensemble.draws_what_columns_read()
        && (is_limited || events.iter().any(is_seen) || has_events && columns.iter().any(is_read_by_draws))
    {
        let message = "an event knows the orbit, the angles, the wheels and the joints of the file, not those that a member draws: \
                       leave the columns of angles, wheels and joints out, or the event, or draw something else";
        return wrong(&["event"], message.to_owned());
    }
    None
}

/// The table that the file lacks, so that nothing in it can be drawn.
fn missing(axis: &Axis, document: &Document<'_>) -> Option<SpanMessage> {
    let [tables @ .., _] = axis.keys.as_slice() else { return None };
    let mut here = document.get_ref();
    for key in tables {
        let name = key.get_ref();
        let Some(inner) = here.get(name.as_str()) else {
            let message =
                format!("the file has no `{name}`, of which something could be drawn; write the table `[{name}]`");
            return Some((key.span(), message));
        };
        // A table of a list is found by its name when a value is set.
        here = inner.get_ref().as_table()?;
    }
    None
}

/// The ensemble of a table; `scene` is that without draws.
pub(crate) fn read(
    (path, text): (&Path, &str),
    document: &Document<'_>,
    table: &Spanned<DeValue<'_>>,
    scene: &Scene,
) -> Result<SceneEnsemble, Mistake> {
    let located = |(span, message): SpanMessage| Mistake::at(path, place_of(text, &span), message);
    let mut ensemble = parts((path, text), table).map_err(located)?;
    let file = &*scene.file;
    ensemble.identity = identity(text, file);
    let output = document.get_ref().get("output").and_then(|output| output.get_ref().as_table());
    let lists = output.is_some_and(|output| output.contains_key("columns"));
    ensemble.columns = if lists { scene.columns().to_vec() } else { default_columns(&ensemble, scene) };
    let wrong = |keys: &[&str], message: String| Err(located((span(document, keys), message)));
    if scene.asks_for_accuracy() {
        return wrong(&["run", "accuracy"], "the members of an ensemble make the same steps: give a `step`".to_owned());
    }
    let has_a_pace = file.paced().is_some();
    if has_a_pace || scene.schedule().density.is_some() {
        let keys = if has_a_pace { ["lagrangian", "pace"] } else { ["run", "density"] };
        let why = "members make the same number of steps, and those of a";
        return wrong(&keys, format!("{why} `{}` end at different times: leave it out", keys[1]));
    }
    of_columns(&ensemble, scene, &|keys| span(document, keys)).map_or(Ok(()), Err).map_err(located)?;
    for one in &mut ensemble.histograms {
        let unit = scene.columns().iter().find_map(|column| column.unit(&one.column)).unwrap_or_default();
        let is_bare = one.unit.is_empty();
        one.in_unit(unit).map_or(Ok(()), |message| Err(located((one.span.clone(), message))))?;
        if is_bare && unit == "rad" && ensemble.note.is_none() {
            let note = located((one.span.clone(), read_as_rad(one.written[1])));
            ensemble.note = Some(note);
        }
    }
    let written = table.get_ref().as_table().and_then(|table| table.get("every"));
    if let (Some(every), Some(steps), Some(value)) = (ensemble.every, scene.steps(), written)
        && every > steps
    {
        let message =
            format!("a run has {steps} steps, so none is kept on its way; leave `every` out to keep the ends only");
        return Err(located((value.span(), message)));
    }
    ensemble.axes.iter().find_map(|axis| missing(axis, document)).map_or(Ok(()), Err).map_err(located)?;
    // The tables borrow the text, so it is parsed once and leaked.
    let tables = DeTable::parse(Box::leak(text.into())).map_err(|error| Mistake::of_toml(path, text, &error))?;
    let axes = &ensemble.axes;
    let is_drawn = |name: &str| axes.iter().any(|axis| axis.keys.first().is_some_and(|key| key.get_ref() == name));
    // A drawn Lagrangian, force, constraint or orbit affects other tables, too: all of them are read anew.
    let all = ["lagrangian", "hamiltonian", "force", "nonholonomic", "orbit"]
        .iter()
        .chain(&LISTED)
        .any(|name| is_drawn(name))
        || file.over_time.iter().any(|one| is_drawn(&one.table))
        || file.run.steps_per_orbit.is_some()
        || file.system.is_some();
    let is_read = |name: &str| is_drawn(name) || all && !["sweep", "ensemble"].contains(&name);
    ensemble.tables = tables.into_inner().into_iter().filter(|(name, _)| is_read(name.get_ref())).collect();
    ensemble.like = (!all).then(|| Box::new(file.clone()));
    // Wrong units and keys are found by reading two members.
    for end in [true, false] {
        let value = |(_, spread)| match spread {
            Spread::Uniform { from: value, .. } if end => value,
            Spread::Uniform { to: value, .. } | Spread::Normal { mean: value, .. } => value,
        };
        let one = ensemble.written(&ensemble.draws().map(value).collect::<Vec<_>>())?;
        if let Some(like) = &mut ensemble.like {
            **like = one;
        }
    }
    Ok(ensemble)
}
