//! The scene of a document: its tables are read first, then checked against each other.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use liestep::with::Scheme;
use liestep_derivation::Role;
use liestep_late::LateError;
use serde::Deserialize as _;
use toml::Spanned;
use toml::de::{DeValue, Deserializer};

use crate::file::bare::bare_angle;
use crate::file::beginning::Beginning;
use crate::file::column::Column;
use crate::file::control::{self, settle};
use crate::file::group::Group;
use crate::file::lagrangian::{DeclaredTerm, take};
use crate::file::mistake::{Lines, Mistake, SpanMessage};
use crate::file::odds::{at_odds, of_ends};
use crate::file::over_time::{self, OverTime};
use crate::file::pointing::Pointing;
use crate::file::scene_file::{Origin, Places, SceneFile};
use crate::file::schedule::{Pace, equal_steps};
use crate::file::several::several;
use crate::file::system::System;
use crate::file::tables::{Document, has, span};
use crate::file::text::{check_name, number_of, or_name};
use crate::file::words::in_files;

/// The scene of a document without a sweep and an ensemble.
pub(crate) fn scene(path: &Path, text: &str, document: &Document<'_>) -> Result<SceneFile, Mistake> {
    let lines = Lines::of(text);
    let located = |(span, message): SpanMessage| Mistake::at(path, lines.place(span.start), message);
    let has_several = document.get_ref().get("body").is_some_and(|body| body.get_ref().is_array());
    let read = if has_several { several } else { one_body };
    let mut file = read(path, document, &lines)?;
    per_orbit(document, &mut file).map_err(located)?;
    let keys = ["accuracy", "steps_per_orbit"];
    let pace = keys.into_iter().find(|key| has(document, "run", key)).unwrap_or("step");
    let at = |keys: &[&str]| lines.place(span(document, keys).start);
    let places = Places {
        body: at(&[moving(&file)]),
        start: at(&["start"]),
        attitude: at(&["start", "attitude"]),
        pace: at(&["run", pace]),
        method: at(&["run", "method"]),
        spring: at(&["spring"]),
        law: file.law_of_no_frame().map_or((1, 1), |span| lines.place(span.start)),
    };
    file.title = or_name(file.title, path);
    file.origin = Origin { path: path.to_owned(), places, note: None };
    observed(document, &mut file).map_err(located)?;
    let note = bare_angle(document, &file.all_columns());
    file.origin.note = note.map(|(span, why)| (lines.place(span.start), why));
    Ok(file)
}

/// The scene of one body, or of a Lagrangian of the file's own.
fn one_body(path: &Path, document: &Document<'_>, lines: &Lines<'_>) -> Result<SceneFile, Mistake> {
    let located = |(span, message): SpanMessage| Mistake::at(path, lines.place(span.start), message);
    let mut rest = document.clone();
    let over_time = over_time::take(&mut rest, path).map_err(located)?;
    let of_value = |value: &Spanned<DeValue<'_>>| over_time::of_value(value, path);
    let (control, wheel) = control::take(&mut rest, &of_value, &[]).map_err(located)?;
    let mut on = None;
    let mut own = |role| take(&mut rest, role, &mut on).map_err(located);
    let (lagrangian, hamiltonian) = (own(Role::Lagrangian)?, own(Role::Hamiltonian)?);
    let (force, nonholonomic) = (own(Role::Force)?, own(Role::Nonholonomic)?);
    if let Some(name) = named_method(&rest) {
        return Err(located((span(document, &["run", "method"]), format!("`{name}` {METHODS}"))));
    }
    let mut file =
        SceneFile::deserialize(Deserializer::from(rest)).map_err(|error| Mistake::of_toml(path, lines.text, &error))?;
    if file.body.is_none() && lagrangian.is_empty() && hamiltonian.is_empty() {
        return Err(located((document.span(), "missing field `body`".to_owned())));
    }
    file.run.count(document, file.orbit.as_ref()).map_err(located)?;
    (file.lagrangian, file.hamiltonian, file.force, file.nonholonomic) = (lagrangian, hamiltonian, force, nonholonomic);
    file.over_time = over_time.into();
    add(document, &mut file).and_then(|()| fixed(&file).map_or(Ok(()), Err)).map_err(located)?;
    if let Some(start) = document.get_ref().get("start") {
        file.start = Beginning::read(start, &file.group, file.orbit.as_ref()).map_err(located)?;
    }
    (file.control, file.wheel) = (control, wheel);
    Ok(file)
}

/// The columns of a table by default, of one body and of several.
const DEFAULT: [&str; 10] = [
    "velocity",
    "spatial-momentum",
    "energy",
    "axis",
    "quaternion",
    "attitude",
    "pointing",
    "roll-pitch-yaw",
    "wheel-speeds",
    "control",
];
const DEFAULT_OF_SEVERAL: [&str; 8] =
    ["position", "quaternion", "energy", "gap", "pointing", "roll-pitch-yaw", "wheel-speeds", "control"];

/// Finds what is seen of a scene: pointings, events, columns; and its conflicts.
fn observed(document: &Document<'_>, file: &mut SceneFile) -> Result<(), SpanMessage> {
    if let Pace::Step { step, .. } = file.run.pace {
        let has_orbit = file.orbit.is_some();
        settle(&mut file.control, &mut file.wheel, (step, has_orbit))?;
    }
    let bodies = file.system.clone();
    let bodies: Vec<&str> = bodies.iter().flat_map(|system| system.names()).collect();
    for pointing in &mut file.pointing {
        pointing.number = number_of(pointing.body.as_ref(), &bodies, &span(document, &["pointing"]))?;
    }
    of_pointing(document, file)?;
    let columns = file.all_columns();
    let events = document.get_ref().get("event").and_then(|events| events.get_ref().as_array());
    let of_body = if file.group.is_rotation() { Ok(()) } else { Err(NO_BODY) };
    for (number, event) in file.event.iter_mut().enumerate() {
        let at = || events.and_then(|events| events.get(number)).map_or(0..0, Spanned::span);
        event.placed((&columns, &file.group.quaternions), (&bodies, of_body), &at)?;
    }
    at_odds(document, file).map_or(Ok(()), Err)?;
    file.over_time.iter().find_map(|one| of_signal(one, file)).map_or(Ok(()), Err)?;
    file.set_over([0.0, 0.0]);
    let default: &[&str] = if file.system.is_some() { &DEFAULT_OF_SEVERAL } else { &DEFAULT };
    file.columns = file.output.columns(&columns, default)?;
    if let Some(system) = file.system.as_mut().map(Arc::make_mut) {
        system.check_columns(document, &file.columns)?;
        system.has_reactions = System::asks_for_reactions(&columns, &file.columns, &file.event);
    }
    Ok(())
}

/// The steps of a file that says how many there are per orbit.
fn per_orbit(document: &Document<'_>, file: &mut SceneFile) -> Result<(), SpanMessage> {
    let Some(steps) = file.run.steps_per_orbit else { return Ok(()) };
    let wrong = |message: &str| (span(document, &["run", "steps_per_orbit"]), message.to_owned());
    if has(document, "run", "step") || has(document, "run", "accuracy") {
        return Err(wrong("`steps_per_orbit` stands in the place of a `step` or an `accuracy`"));
    }
    let orbit = file.orbit.ok_or_else(|| wrong("the file has no table `[orbit]`"))?;
    if file.turning().next().is_none() {
        return Err(wrong("no parameter follows the orbit: give a `step`"));
    }
    let step = orbit.period() / f64::from(steps.get());
    let steps = equal_steps(step, file.run.duration).map_err(|message| wrong(&message))?;
    file.run.pace = Pace::Step { step, steps };
    Ok(())
}

/// The table of what moves.
fn moving(file: &SceneFile) -> &'static str {
    match file.body {
        Some(_) => "body",
        None if file.hamiltonian.is_empty() => "lagrangian",
        None => "hamiltonian",
    }
}

/// Conflicts with a Hamiltonian, which has all terms in its text, and steps of its own.
fn beside(document: &Document<'_>, file: &SceneFile) -> Option<SpanMessage> {
    file.hamiltonian.first()?;
    let wrong = |keys: &[&str], message: &str| Some((span(document, keys), message.to_owned()));
    let whole = "a Hamiltonian has all its terms in its text: write this into its `h`, or leave it out";
    let is_there = |table: &&str| document.get_ref().contains_key(*table);
    let tables = ["body", "lagrangian", "force", "nonholonomic", "control", "wheel"].into_iter().find(is_there);
    if let Some(table) = tables.or_else(|| file.effects().next().map(|(effect, _)| effect.key)) {
        return wrong(&[table], whole);
    }
    if let Some(one) = file.hamiltonian.get(1) {
        return Some((one.span.clone(), whole.to_owned()));
    }
    if let Some(one) = file.over_time.first() {
        return Some((
            one.span.clone(),
            "the parameters of a Hamiltonian don't change with time: give a value".to_owned(),
        ));
    }
    if has(document, "run", "density") {
        return wrong(&["run", "density"], "a Hamiltonian has equal steps: leave the density out");
    }
    match file.run.pace {
        Pace::Accuracy(_) => wrong(&["run"], "a Hamiltonian has steps that you choose: give the run a `step`"),
        Pace::Step { .. } => None,
    }
}

/// Adds the terms of a file with a Lagrangian that has the kinetic energy, and finds the group.
fn add(document: &Document<'_>, file: &mut SceneFile) -> Result<(), SpanMessage> {
    if let Some(mistake) = beside(document, file) {
        return Err(mistake);
    }
    let own = || file.own();
    let of_term = |place: &Range<usize>, error: LateError| (place.clone(), in_files(&error.to_string()));
    let is_of_body = |one: &DeclaredTerm| one.declaration.group() == "SO3";
    if file.body.is_some() {
        if let Some(one) = file.lagrangian.iter().find(|one| one.declaration.has_kinetic) {
            let message = "this `lagrangian` has a kinetic energy, and the `body` another: leave one of both out";
            let at = if file.lagrangian.len() > 1 { one.span.clone() } else { span(document, &["body"]) };
            return Err((at, message.to_owned()));
        }
        return match own().find(|one| !is_of_body(one)) {
            Some(one) => {
                Err((one.span.clone(), "a `body` is on `SO3`, and so are its own Lagrangians and forces".to_owned()))
            }
            None => Ok(()),
        };
    }
    if let (Some((effect, _)), Some(one)) = (file.effects().next(), own().find(|one| !is_of_body(one))) {
        let message = format!(
            "{} acts on a body on `SO3`, and the scene is on `{}`: write it into the text of the `lagrangian`",
            effect.name(" "),
            one.declaration.group()
        );
        return Err((span(document, &[effect.key]), message));
    }
    let Some(DeclaredTerm { declaration, span: first, increments, .. }) = own().next().cloned() else { return Ok(()) };
    let is_other = |one: &&DeclaredTerm| one.declaration.factors != declaration.factors;
    if let Some(one) = own().find(is_other) {
        return Err((one.span.clone(), "the terms of a scene are on one group, and this one is on another".to_owned()));
    }
    let sum = file.declared(None).map_err(|error| of_term(&first, error))?;
    let Some(sum) = sum.filter(|sum| sum.has_kinetic) else {
        let message = "nothing moves by a potential alone: a `lagrangian` has a kinetic energy, or the file a `body`";
        return Err((first, message.to_owned()));
    };
    file.group = Group::of(sum, increments).map_err(|error| of_term(&first, error))?;
    file.sum = Some(sum);
    Ok(())
}

const NO_BODY: &str = "only a body on `SO3` has this quantity: on another group an event has a `column` with a \
                       `value`, or an `energy`";

const METHODS: &str = "is no method of a scene: `method` is \"step\", or a table as `{ composition = \"Suzuki 4\" }`, \
                       `{ splitting = \"Nyström 6-4\" }`, `{ processed = \"processed 3-6 a\" }` or `{ collocation = 8 }`; \
                       a Runge–Kutta method wouldn't keep what the motion conserves";

/// The name of a method without a table, other than `step`.
fn named_method(document: &Document<'_>) -> Option<String> {
    let name = document.get_ref().get("run")?.get_ref().get("method")?.get_ref().as_str()?;
    name.parse::<Scheme>().is_err().then(|| name.to_owned())
}

/// The mistake of a parameter that can't have the values of its signal, or has none during the run.
fn of_signal(one: &OverTime, file: &SceneFile) -> Option<SpanMessage> {
    let mut scratch = file.clone();
    let OverTime { table, key, span, .. } = one;
    let wrong = |message: String| Some((span.clone(), message));
    if !scratch.set_one(one, &one.stand_in()) {
        return wrong(format!("`{key}` of `{table}` can't change with time"));
    }
    let signal = one.signal()?;
    let mut values = signal.values().chunks(signal.width());
    if let Some(value) = values.find(|value| !scratch.set_one(one, value)) {
        return wrong(format!("`{key}` of `{table}` can't be {value:?}"));
    }
    wrong(of_ends(signal, file.run.duration)?)
}

/// Mistakes of the tables `[[pointing]]`.
fn of_pointing(document: &Document<'_>, file: &SceneFile) -> Result<(), SpanMessage> {
    let wrong = |message: &str| Err((span(document, &["pointing"]), message.to_owned()));
    if file.pointing.is_empty() {
        return Ok(());
    }
    if !file.group.is_rotation() {
        return wrong("a `pointing` is that of a body on `SO3`: leave it out on this group");
    }
    if file.orbit.is_none() && file.pointing.iter().any(Pointing::is_on_orbit) {
        return wrong("the nadir is that of an orbit, and the file has no table `[orbit]`");
    }
    let columns = file.all_columns();
    let names: Vec<&str> = columns.iter().flat_map(Column::names).collect();
    for Pointing { name, .. } in &file.pointing {
        check_name("a pointing", name).or_else(|message| wrong(&message))?;
        if names.iter().filter(|other| *other == name).count() > 1 {
            return wrong(&format!("`{name}` is the name of another column"));
        }
    }
    Ok(())
}

/// The first of the constraints on velocities that leave no motion.
fn fixed(file: &SceneFile) -> Option<SpanMessage> {
    let group = &file.nonholonomic.first()?.declaration.factors;
    let dimension: usize = group.iter().map(|factor| factor.generators.len()).sum();
    let last = file.nonholonomic.get(dimension.checked_sub(1)?)?;
    let message = format!(
        "{dimension} constraints on velocities leave no motion on a group of dimension {dimension}: leave some out"
    );
    Some((last.span.clone(), message))
}
