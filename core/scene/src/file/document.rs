//! The scene of a document: its tables are read first, then checked against each other.

use std::path::Path;

use liestep::with::Scheme;
use liestep_derivation::Role;
use serde::Deserialize as _;
use toml::de::Deserializer;

use crate::file::body::Kinetic;
use crate::file::column::Column;
use crate::file::effects::Table as _;
use crate::file::lagrangian::take;
use crate::file::method::kind;
use crate::file::mistake::{Mistake, Wrong, place_of};
use crate::file::scene::{Origin, Places, SceneFile};
use crate::file::schedule::{Pace, equal_steps, fraction};
use crate::file::tables::{Document, span};

/// The scene of a document without a sweep and an ensemble.
pub(crate) fn scene(path: &Path, text: &str, document: &Document<'_>) -> Result<SceneFile, Mistake> {
    let located = |(span, message): Wrong| Mistake::at(path, place_of(text, &span), message);
    let mut rest = document.clone();
    let lagrangian = take(&mut rest, Role::Lagrangian).map_err(located)?;
    let force = take(&mut rest, Role::Force).map_err(located)?;
    if let Some(name) = named_method(&rest) {
        return Err(located((span(document, &["run", "method"]), format!("`{name}` {METHODS}"))));
    }
    let mut file =
        SceneFile::deserialize(Deserializer::from(rest)).map_err(|error| Mistake::of_toml(path, text, &error))?;
    if file.body.is_none() && lagrangian.is_none() {
        return Err(located((document.span(), "missing field `body`".to_owned())));
    }
    (file.lagrangian, file.force) = (lagrangian, force);
    if let Some(steps) = file.run.steps_per_orbit {
        let wrong = |message: String| located((span(document, &["run", "steps_per_orbit"]), message));
        if has(document, "run", "step") || has(document, "run", "accuracy") {
            return Err(wrong("`steps_per_orbit` stands in the place of a `step` or an `accuracy`".to_owned()));
        }
        let (_, orbit) = file.turning().next().ok_or_else(|| wrong("no effect follows an `orbit`".to_owned()))?;
        let (_, step) = orbit.clock(steps).map_err(|error| wrong(error.to_string()))?;
        file.run.pace = Pace::Step { step, steps: equal_steps(step, file.run.duration).map_err(wrong)? };
    }
    at_odds(document, &file).map_or(Ok(()), Err).map_err(located)?;
    let default = ["velocity", "spatial-momentum", "energy", "axis", "quaternion"];
    file.columns = file.output.columns(&Column::OF_ONE_BODY, &default).map_err(located)?;
    let at = |keys: &[&str]| place_of(text, &span(document, keys));
    let keys = ["accuracy", "steps_per_orbit"];
    let pace = keys.into_iter().find(|key| has(document, "run", key)).unwrap_or("step");
    let body = if file.lagrangian.is_some() { "lagrangian" } else { "body" };
    let places = Places {
        body: at(&[body]),
        start: at(&["start"]),
        pace: at(&["run", pace]),
        method: at(&["run", "method"]),
        spring: at(&["spring"]),
    };
    file.origin = Origin { path: path.to_owned(), places };
    Ok(file)
}

const METHODS: &str = "is no method of a scene: `method` is \"step\", or a table as `{ composition = \"Suzuki 4\" }`, \
                       `{ splitting = \"Nyström 6-4\" }`, `{ processed = \"processed 3-6 a\" }` or `{ collocation = 8 }`; \
                       a Runge–Kutta method wouldn't keep what the motion conserves";

/// The name of a method without a table, other than `step`.
fn named_method(document: &Document<'_>) -> Option<String> {
    let name = document.get_ref().get("run")?.get_ref().get("method")?.get_ref().as_str()?;
    name.parse::<Scheme>().is_err().then(|| name.to_owned())
}

fn has(document: &Document<'_>, table: &str, key: &str) -> bool {
    document.get_ref().get(table).and_then(|table| table.get_ref().get(key)).is_some()
}

/// Conflicts between keys that are valid by themselves.
fn at_odds(document: &Document<'_>, file: &SceneFile) -> Option<Wrong> {
    let of = [of_pace, of_orbit, of_density, of_method];
    of.iter().find_map(|odds| odds(document, file))
}

/// Conflicts with a step or an accuracy.
fn of_pace(document: &Document<'_>, file: &SceneFile) -> Option<Wrong> {
    let wrong = |keys: &[&str], message: String| Some((span(document, keys), message));
    if has(document, "run", "step") && has(document, "run", "accuracy") {
        return wrong(&["run", "accuracy"], "a run has either a `step` or an `accuracy`".to_owned());
    }
    if let Pace::Step { step, .. } = file.run.pace
        && !file.has_steps_of_its_own()
        && let Some(message) = fraction(step, file.run.duration)
    {
        return wrong(&["run", "duration"], message);
    }
    if let Pace::Accuracy(_) = file.run.pace {
        if let Some(force) = file.first_force() {
            let message =
                format!("an accuracy can be asked for in conservative scenes; {force} does work, so give a `step`");
            return wrong(&["run", "accuracy"], message);
        }
        if has(document, "run", "method") {
            let message =
                "an `accuracy`, which a run without a `step` has, chooses the method; give a `step` to choose it";
            return wrong(&["run", "method"], message.to_owned());
        }
        if file.kinetic() != Kinetic::Rigid {
            let message = "an `accuracy`, which a run without a `step` has, chooses the method for the kinetic term \
                           `rigid`; leave `kinetic` out, or give a `step`";
            return wrong(&["body", "kinetic"], message.to_owned());
        }
    }
    None
}

/// Conflicts with effects that vary along an orbit.
fn of_orbit(document: &Document<'_>, file: &SceneFile) -> Option<Wrong> {
    let wrong = |keys: &[&str], message: String| Some((span(document, keys), message));
    if let Some(gradient) = &file.gravity_gradient {
        let is_given = [gradient.GM.is_some(), gradient.r.is_some()];
        if gradient.orbit().is_none() && is_given != [true; 2] {
            return wrong(&["gravity_gradient"], "beside a direction that is fixed stand `GM` and `r`".to_owned());
        }
        if gradient.orbit().is_some() && is_given != [false; 2] {
            let key = if is_given[0] { "GM" } else { "r" };
            let message =
                "the orbit's period says how strong the gradient is, by Kepler's third law: leave `GM` and `r` out";
            return wrong(&["gravity_gradient", key], message.to_owned());
        }
    }
    let mut all: Vec<_> = file.turning().collect();
    all.sort_by_key(|(keys, _)| span(document, keys).start);
    for ((first, one), (keys, other)) in all.iter().zip(all.iter().skip(1)) {
        let mut pairs = one.said().into_iter().zip(other.said());
        if let Some(((key, value), _)) = pairs.find(|(one, other)| one != other) {
            let message = format!("a body goes round one orbit, and `{}` has the {key} {value}", first.join("."));
            return wrong(&[keys.as_slice(), &[key]].concat(), message);
        }
    }
    if let Some(([effect, ..], _)) = file.turning().next() {
        let name = effect.replace('_', " ");
        if let Pace::Accuracy(_) = file.run.pace {
            let message = format!(
                "an accuracy chooses a method for what doesn't change with time; {name} does, so give a `step`"
            );
            return wrong(&["run", "accuracy"], message);
        }
        if !matches!(file.run.method, Scheme::Step) {
            let message = format!("{name} turns, with which every method is of second order; leave `method` out");
            return wrong(&["run", "method"], message);
        }
    }
    None
}

/// Conflicts with a density of steps.
fn of_density(document: &Document<'_>, file: &SceneFile) -> Option<Wrong> {
    let has_a_pace = file.lagrangian.as_ref().is_some_and(|own| own.has_a_pace);
    let turns = file.turning().next().is_some();
    let beside = [
        (!has(document, "run", "step"), "the first `step`: give one in the place of `accuracy` and `steps_per_orbit`"),
        (has(document, "run", "method"), "the scene's own step: leave `method` out"),
        (turns, "what doesn't change with time: what turns with an orbit has `steps_per_orbit`"),
        (has_a_pace, "what has no `pace`: leave one of both out"),
    ];
    let (_, what) = file.run.density.and_then(|_| beside.into_iter().find(|(is_odd, _)| *is_odd))?;
    Some((span(document, &["run", "density"]), format!("a `density` is around {what}")))
}

/// Conflicts with a method; a Lagrangian's come first.
fn of_method(document: &Document<'_>, file: &SceneFile) -> Option<Wrong> {
    let wrong = |keys: &[&str], message: String| Some((span(document, keys), message));
    let method = &file.run.method;
    if let Some(lagrangian) = &file.lagrangian {
        if let Some((effect, _)) = file.effects().next() {
            let message = format!("a `lagrangian` has all its terms in its text: write {} there", effect.name(" "));
            return wrong(&[effect.key], message);
        }
        if let Pace::Accuracy(_) = file.run.pace {
            let message = "an accuracy chooses a method for the library's bodies; give a `step` to a `lagrangian`";
            return wrong(&["run", "accuracy"], message.to_owned());
        }
        if lagrangian.has_a_pace && file.force.is_some() {
            let message = "a pace is that of the whole motion, and a force has another time: leave one of both out";
            return wrong(&["force"], message.to_owned());
        }
        if lagrangian.has_a_pace && !matches!(method, Scheme::Step) {
            let message = "a pace is that of the Lagrangian's own step: leave `method` out";
            return wrong(&["run", "method"], message.to_owned());
        }
        if !matches!(method, Scheme::Step | Scheme::Composition(_)) {
            let message = format!("{} moves a body of the library; leave it out", kind(method));
            return wrong(&["run", "method"], message);
        }
        if matches!(method, Scheme::Composition(_)) && !lagrangian.declaration.is_self_adjoint {
            let message = "only steps that undo those of −h can be composed, and those of this Lagrangian don't";
            return wrong(&["run", "method"], message.to_owned());
        }
    }
    if !matches!(method, Scheme::Step)
        && let Some(force) = file.first_force()
    {
        let name = kind(method);
        return wrong(&["run", "method"], format!("{name} needs a conservative scene; {force} does work"));
    }
    if let Scheme::Composition(scheme) = method
        && scheme.base() != file.order()
    {
        let (name, base, order) = (scheme.name(), scheme.base(), file.order());
        let message = format!("{name} composes a step of order {base}, and that of this scene is of order {order}");
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
