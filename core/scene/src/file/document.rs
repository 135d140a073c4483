//! The scene of a document: its tables are read first, then checked against each other.

use std::ops::Range;
use std::path::Path;

use liestep::methods::CompositionScheme;
use liestep::with::Scheme;
use liestep_derivation::Role;
use liestep_late::{Declaration, LateError, Signal};
use serde::Deserialize as _;
use toml::Spanned;
use toml::de::{DeValue, Deserializer};

use crate::file::beginning::Beginning;
use crate::file::body::Kinetic;
use crate::file::column::Column;
use crate::file::common::Parts as _;
use crate::file::control::{self, Motor, settle};
use crate::file::effects::Table as _;
use crate::file::group::Group;
use crate::file::lagrangian::{DeclaredTerm, take};
use crate::file::method::kind;
use crate::file::mistake::{Mistake, SpanMessage, place_of};
use crate::file::over_time::{self, NO_ORBIT, OverTime};
use crate::file::picture::{Curve, SpherePicture};
use crate::file::pointing::{Pointing, View};
use crate::file::scene::{Origin, Places, SceneFile};
use crate::file::schedule::{Pace, equal_steps};
use crate::file::tables::{Document, has, span};
use crate::file::text::{check_name, or_name};
use crate::file::words::in_files;

/// The scene of a document without a sweep and an ensemble.
pub(crate) fn scene(path: &Path, text: &str, document: &Document<'_>) -> Result<SceneFile, Mistake> {
    let located = |(span, message): SpanMessage| Mistake::at(path, place_of(text, &span), message);
    let mut rest = document.clone();
    let over_time = over_time::take(&mut rest, path).map_err(located)?;
    let of_value = |value: &Spanned<DeValue<'_>>| over_time::of_value(value, path);
    let (mut control, mut wheel) = control::take(&mut rest, &of_value).map_err(located)?;
    let mut on = None;
    let mut own = |role| take(&mut rest, role, &mut on).map_err(located);
    let (lagrangian, hamiltonian) = (own(Role::Lagrangian)?, own(Role::Hamiltonian)?);
    let (force, nonholonomic) = (own(Role::Force)?, own(Role::Nonholonomic)?);
    if let Some(name) = named_method(&rest) {
        return Err(located((span(document, &["run", "method"]), format!("`{name}` {METHODS}"))));
    }
    let mut file =
        SceneFile::deserialize(Deserializer::from(rest)).map_err(|error| Mistake::of_toml(path, text, &error))?;
    file.title = or_name(file.title, path);
    if file.body.is_none() && lagrangian.is_empty() && hamiltonian.is_empty() {
        return Err(located((document.span(), "missing field `body`".to_owned())));
    }
    file.run.count(document).map_err(located)?;
    (file.lagrangian, file.hamiltonian, file.force, file.nonholonomic) = (lagrangian, hamiltonian, force, nonholonomic);
    file.over_time = over_time.into();
    add(document, &mut file).and_then(|()| fixed(&file).map_or(Ok(()), Err)).map_err(located)?;
    if let Some(start) = document.get_ref().get("start") {
        file.start = Beginning::read(start, &file.group, file.orbit.as_ref()).map_err(located)?;
    }
    per_orbit(document, &mut file).map_err(located)?;
    if let Pace::Step { step, .. } = file.run.pace {
        settle(&mut control, &mut wheel, (step, file.orbit.is_some())).map_err(located)?;
    }
    (file.control, file.wheel) = (control, wheel);
    let view = file.view();
    of_pointing(document, &view).map_err(located)?;
    let events = document.get_ref().get("event").and_then(|events| events.get_ref().as_array());
    for (number, event) in file.event.iter_mut().enumerate() {
        let at = || events.and_then(|events| events.get(number)).map_or(0..0, Spanned::span);
        let one_body = if view.group.is_rotation() { Ok(()) } else { Err(NO_BODY) };
        event.placed((&view.columns(), &view.group.quaternions), one_body, &at).map_err(located)?;
    }
    at_odds(document, &file).map_or(Ok(()), Err).map_err(located)?;
    file.over_time.iter().find_map(|one| of_signal(one, &file)).map_or(Ok(()), Err).map_err(located)?;
    if !file.group.is_rotation() && !has(document, "picture", "panels") {
        file.picture = SpherePicture::on_group();
    }
    let default = [
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
    file.columns = file.output.columns(&view.columns(), &default).map_err(located)?;
    let at = |keys: &[&str]| place_of(text, &span(document, keys));
    let keys = ["accuracy", "steps_per_orbit"];
    let pace = keys.into_iter().find(|key| has(document, "run", key)).unwrap_or("step");
    let places = Places {
        body: at(&[moving(&file)]),
        start: at(&["start"]),
        attitude: at(&["start", "attitude"]),
        pace: at(&["run", pace]),
        method: at(&["run", "method"]),
        spring: at(&["spring"]),
        law: file.law_of_no_frame().map_or((1, 1), |span| place_of(text, span)),
    };
    file.origin = Origin { path: path.to_owned(), places };
    Ok(file)
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
    let library = file.effects().map(|(effect, _)| Declaration::parse(effect.derived.1));
    let lagrangians = file.lagrangian.iter().chain(&file.hamiltonian).map(|own| Ok(own.declaration));
    let forces = file.force.iter().chain(&file.nonholonomic).map(|own| Ok(own.declaration));
    let terms = lagrangians.chain(library).chain(forces).collect::<Result<Vec<_>, _>>();
    let terms = terms.map_err(|error| of_term(&first, error))?;
    let is_other = |one: &&DeclaredTerm| one.declaration.factors != declaration.factors;
    if let Some(one) = own().find(is_other) {
        return Err((one.span.clone(), "the terms of a scene are on one group, and this one is on another".to_owned()));
    }
    let sum = Declaration::sum(&terms).map_err(|error| of_term(&first, error))?;
    if !sum.has_kinetic {
        let message = "nothing moves by a potential alone: a `lagrangian` has a kinetic energy, or the file a `body`";
        return Err((first, message.to_owned()));
    }
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

/// Conflicts between keys that are valid by themselves.
fn at_odds(document: &Document<'_>, file: &SceneFile) -> Option<SpanMessage> {
    let of = [of_pace, of_orbit, of_devices, of_density, of_method, of_picture];
    of.iter().find_map(|odds| odds(document, file))
}

/// Conflicts with a step or an accuracy.
fn of_pace(document: &Document<'_>, file: &SceneFile) -> Option<SpanMessage> {
    let wrong = |keys: &[&str], message: String| Some((span(document, keys), message));
    if file.run.nearest {
        return wrong(&["run", "nearest"], "`nearest` closes joints, and one body has none: leave it out".to_owned());
    }
    if let Some(odds) = file.run.at_odds(document, file.has_steps_of_its_own()) {
        return Some(odds);
    }
    if matches!(file.run.pace, Pace::Accuracy(_)) && file.kinetic() != Kinetic::Rigid {
        let message = "an `accuracy`, which a run without a `step` has, chooses the method for the kinetic term `rigid`; leave \
                       `kinetic` out, or give a `step`";
        return wrong(&["body", "kinetic"], message.to_owned());
    }
    None
}

/// Conflicts of a picture with a group that has no sphere.
fn of_picture(document: &Document<'_>, file: &SceneFile) -> Option<SpanMessage> {
    if file.group.is_rotation() {
        return None;
    }
    let wrong = |key: &str, message: &str| Some((span(document, &["picture", key]), message.to_owned()));
    if let Some(key) = ["path", "axis"].into_iter().find(|key| has(document, "picture", key)) {
        return wrong(key, "only a body on `SO3` has a path on a sphere: on this group a picture has `panels` alone");
    }
    let of_body = |curve: &Curve| matches!(curve, Curve::Tilt | Curve::VerticalMomentumError);
    file.picture.panels.iter().any(of_body).then_some(())?;
    wrong("panels", "`tilt` and `vertical-momentum-error` are those of a body on `SO3`: leave them out on this group")
}

/// Conflicts with effects that vary along an orbit.
fn of_orbit(document: &Document<'_>, file: &SceneFile) -> Option<SpanMessage> {
    let wrong = |keys: &[&str], message: String| Some((span(document, keys), message));
    if let Some(gradient) = &file.gravity_gradient {
        let is_given = [gradient.GM.is_some(), gradient.r.is_some()];
        if gradient.on_orbit().is_none() && is_given != [true; 2] {
            return wrong(&["gravity_gradient"], "beside a direction that is fixed stand `GM` and `r`".to_owned());
        }
        if gradient.on_orbit().is_some() && is_given != [false; 2] {
            let key = if is_given[0] { "GM" } else { "r" };
            let message =
                "the orbit's period says how strong the gradient is, by Kepler's third law: leave `GM` and `r` out";
            return wrong(&["gravity_gradient", key], message.to_owned());
        }
    }
    if let (None, Some(keys)) = (file.orbit, file.turning().next()) {
        return wrong(&keys, NO_ORBIT.to_owned());
    }
    if let Some(name) = file.changing() {
        if let Pace::Accuracy(_) = file.run.pace {
            let message = format!(
                "an accuracy chooses a method for what doesn't change with time; {name} does, so give a `step`"
            );
            return wrong(&["run", "accuracy"], message);
        }
        if !matches!(file.run.method, Scheme::Step | Scheme::Composition(_)) {
            let message = format!(
                "{name} changes with time, which a step or a composition can follow; take one, or leave `method` out"
            );
            return wrong(&["run", "method"], message);
        }
    }
    None
}

/// The mistake of a parameter that can't have the values of its signal, or has none during the run.
fn of_signal(one: &OverTime, file: &SceneFile) -> Option<SpanMessage> {
    let mut scratch = file.clone();
    let (OverTime { table, key, span, .. }, signal) = (one, one.signal()?);
    let mut values = signal.values().chunks(signal.width());
    let wrong = |message: String| Some((span.clone(), message));
    if !values.next().is_some_and(|first| scratch.set_one(one, first)) {
        return wrong(format!("`{key}` of `{table}` can't change with time"));
    }
    if let Some(value) = values.find(|value| !scratch.set_one(one, value)) {
        return wrong(format!("`{key}` of `{table}` can't be {value:?}"));
    }
    wrong(of_ends(signal, file.run.duration)?)
}

/// The mistake of a signal that has no value at an end of a run of this duration, s.
fn of_ends(signal: &Signal, duration: f64) -> Option<String> {
    let [first, last] = signal.ends();
    if first > 0.0 {
        return Some(format!(
            "a run starts at the time 0, and the first of `times` is {first} s: give a value from 0 on"
        ));
    }
    // The rounding of a duration.
    let is_short = last < duration * (1.0 - 1e-9);
    is_short.then(|| {
        format!("the run ends at {duration} s, and by lines there is no value after the last of `times`, {last} s")
    })
}

/// Mistakes of the tables `[[pointing]]`.
fn of_pointing(document: &Document<'_>, view: &View) -> Result<(), SpanMessage> {
    let wrong = |message: &str| Err((span(document, &["pointing"]), message.to_owned()));
    if view.pointing.is_empty() {
        return Ok(());
    }
    if !view.group.is_rotation() {
        return wrong("a `pointing` is that of a body on `SO3`: leave it out on this group");
    }
    if view.orbit.is_none() && view.pointing.iter().any(Pointing::is_on_orbit) {
        return wrong("the nadir is that of an orbit, and the file has no table `[orbit]`");
    }
    let columns = view.columns();
    let names: Vec<&str> = columns.iter().flat_map(Column::names).collect();
    for Pointing { name, .. } in view.pointing.iter() {
        check_name("a pointing", name).or_else(|message| wrong(&message))?;
        if names.iter().filter(|other| *other == name).count() > 1 {
            return wrong(&format!("`{name}` is the name of another column"));
        }
    }
    Ok(())
}

/// Conflicts with laws and wheels.
fn of_devices(document: &Document<'_>, file: &SceneFile) -> Option<SpanMessage> {
    let span_of_law = file.control.first().map(|control| control.span.clone());
    let at = span_of_law.or_else(|| file.wheel.first().map(|wheel| wheel.span.clone()))?;
    let is_of_steps = matches!(file.run.pace, Pace::Step { .. }) && !file.has_steps_of_its_own();
    let beside = [
        (!file.group.is_rotation(), at, "a body that turns, a `[body]` or a `[lagrangian]` on `SO3`"),
        (!is_of_steps, span(document, &["run"]), "a `step`, and neither an accuracy, a density nor steps per orbit"),
        (
            !matches!(file.run.method, Scheme::Step | Scheme::Composition(_)),
            span(document, &["run", "method"]),
            "the scene's own step or a composition of it: take one, or leave `method` out",
        ),
    ];
    if let Some((_, at, what)) = beside.into_iter().find(|(is_odd, ..)| *is_odd) {
        return Some((at, format!("laws and wheels are beside {what}")));
    }
    file.wheel.iter().find_map(|wheel| {
        let Motor::Signal(signal) = &wheel.motor else { return None };
        let several = (signal.width() != 1).then(|| "the torque of a wheel is one number at each time".to_owned());
        several.or_else(|| of_ends(signal, file.run.duration)).map(|message| (wheel.span.clone(), message))
    })
}

/// Conflicts with a density of steps.
fn of_density(document: &Document<'_>, file: &SceneFile) -> Option<SpanMessage> {
    let (has_a_pace, turns) = (file.paced().is_some(), file.changing().is_some());
    let beside = [
        (!has(document, "run", "step"), "the first `step`: give one in the place of `accuracy` and `steps_per_orbit`"),
        (has(document, "run", "method"), "the scene's own step: leave `method` out"),
        (turns, "what doesn't change with time: what turns with an orbit has `steps_per_orbit`"),
        (has_a_pace, "what has no `pace`: leave one of both out"),
        (!file.group.is_rotation(), "a motion on `SO3`: leave it out"),
    ];
    let (_, what) = file.run.density.and_then(|_| beside.into_iter().find(|(is_odd, _)| *is_odd))?;
    Some((span(document, &["run", "density"]), format!("a `density` is around {what}")))
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

/// The reason why the step of a scene can't be composed by a scheme.
fn of_composition(scheme: &CompositionScheme, file: &SceneFile) -> Option<String> {
    let is_one_sided = |own: &[DeclaredTerm]| own.iter().any(|own| !own.declaration.is_self_adjoint);
    if is_one_sided(&file.force) {
        let message = "only steps that undo those of −h can be composed, and those with this `force` don't: give half of its \
                       impulse to either end, as `h * tau.dot(eta + eta_next) / 2`";
        return Some(message.to_owned());
    }
    if is_one_sided(&file.lagrangian) || is_one_sided(&file.nonholonomic) {
        let message = "only steps that undo those of −h can be composed, and those of this Lagrangian don't";
        return Some(message.to_owned());
    }
    let (name, base, order) = (scheme.name(), scheme.base(), file.own_order());
    (base != order)
        .then(|| format!("{name} composes a step of order {base}, and that of this scene is of order {order}"))
}

/// Conflicts with a method; those of a Lagrangian come first.
fn of_method(document: &Document<'_>, file: &SceneFile) -> Option<SpanMessage> {
    let wrong = |keys: &[&str], message: String| Some((span(document, keys), message));
    let method = &file.run.method;
    if file.paced().is_some() {
        if let Some(one) = file.over_time.first() {
            let message = "a pace is that of a Lagrangian that doesn't change with time: leave one of both out";
            return Some((one.span.clone(), message.to_owned()));
        }
        let beside = file.effects().next().map(|(effect, _)| effect.key);
        let several = (file.lagrangian.len() > 1).then_some("lagrangian");
        let force = (!file.force.is_empty()).then_some("force");
        let constraint = (!file.nonholonomic.is_empty()).then_some("nonholonomic");
        if let Some(key) = beside.or(several).or(force).or(constraint) {
            let message = "a pace is that of the whole motion: its Lagrangian has all terms in its text, no force and no \
                           constraint";
            return wrong(&[key], message.to_owned());
        }
        if let Pace::Accuracy(_) = file.run.pace {
            let message = "an accuracy chooses a method for equal steps, and those of a `pace` vary: give a `step`";
            return wrong(&["run", "accuracy"], message.to_owned());
        }
        if !matches!(method, Scheme::Step) {
            let message = "a pace is that of the Lagrangian's own step: leave `method` out";
            return wrong(&["run", "method"], message.to_owned());
        }
    }
    if file.sum.is_some() && !matches!(method, Scheme::Step | Scheme::Composition(_)) {
        let message = format!("{} moves a body of the library; leave it out", kind(method));
        return wrong(&["run", "method"], message);
    }
    if !matches!(method, Scheme::Step | Scheme::Composition(_))
        && let Some(force) = file.first_force()
    {
        let name = kind(method);
        return wrong(&["run", "method"], format!("{name} needs a conservative scene; {force} does work"));
    }
    if !file.nonholonomic.is_empty() && !matches!(method, Scheme::Step | Scheme::Composition(_)) {
        let message =
            format!("{} needs a Lagrangian, and constraints on velocities leave none; leave it out", kind(method));
        return wrong(&["run", "method"], message);
    }
    if let Scheme::Composition(scheme) = method
        && let Some(message) = of_composition(scheme, file)
    {
        return wrong(&["run", "method"], message);
    }
    if let Scheme::Splitting(_) | Scheme::Processed(_) | Scheme::Collocation(_) | Scheme::Exact = method
        && file.kinetic() != Kinetic::Rigid
    {
        let message = format!("{} moves the body exactly; leave `kinetic` out", kind(method));
        return wrong(&["body", "kinetic"], message);
    }
    None
}
