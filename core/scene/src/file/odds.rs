//! Conflicts between the keys of a scene.

use liestep::methods::CompositionScheme;
use liestep::with::Scheme;
use liestep_late::Signal;

use crate::file::body::Kinetic;
use crate::file::control::Motor;
use crate::file::effects::Table as _;
use crate::file::lagrangian::DeclaredTerm;
use crate::file::method::kind;
use crate::file::mistake::SpanMessage;
use crate::file::over_time::NO_ORBIT;
use crate::file::picture::Curve;
use crate::file::scene_file::SceneFile;
use crate::file::schedule::Pace;
use crate::file::tables::{Document, has, span};

/// Conflicts between keys that are valid by themselves.
pub(crate) fn at_odds(document: &Document<'_>, file: &SceneFile) -> Option<SpanMessage> {
    let of = [of_several, of_pace, of_orbit, of_devices, of_density, of_method, of_picture];
    of.iter().find_map(|odds| odds(document, file))
}

/// Keys of a run that several bodies don't have.
fn of_several(document: &Document<'_>, file: &SceneFile) -> Option<SpanMessage> {
    file.system.as_ref()?;
    let is_there = has(document, "run", "density");
    is_there.then(|| (span(document, &["run", "density"]), "a `density` is that of one body: leave it out".to_owned()))
}

/// Conflicts with a step or an accuracy.
fn of_pace(document: &Document<'_>, file: &SceneFile) -> Option<SpanMessage> {
    let wrong = |keys: &[&str], message: String| Some((span(document, keys), message));
    if file.run.nearest && file.system.is_none() {
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

/// Conflicts of a picture with a group that has no sphere, or with several bodies, whose ways are in a plane.
fn of_picture(document: &Document<'_>, file: &SceneFile) -> Option<SpanMessage> {
    let wrong = |key: &str, message: &str| Some((span(document, &["picture", key]), message.to_owned()));
    let given = |key: &&str| has(document, "picture", key);
    let has_curve = |of: fn(&Curve) -> bool| file.picture.panels.iter().flatten().any(of);
    if file.system.is_some() {
        if given(&"path") {
            return wrong("path", "a path on a sphere is that of one body: several have a `plane`");
        }
        has_curve(|curve| matches!(curve, Curve::Attitude)).then_some(())?;
        return wrong("panels", "the `attitude` of several bodies has no panel: `turns` has how far each is turned");
    }
    if given(&"plane") {
        return wrong("plane", "a `plane` is that of the ways of several bodies: leave it out");
    }
    if file.group.is_rotation() {
        return None;
    }
    if let Some(key) = ["path", "axis"].into_iter().find(given) {
        return wrong(key, "only a body on `SO3` has a path on a sphere: on this group a picture has `panels` alone");
    }
    has_curve(|curve| matches!(curve, Curve::Tilt | Curve::VerticalMomentumError | Curve::Turns)).then_some(())?;
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
    let name = file.changing().filter(|_| !matches!(file.run.method, Scheme::Step | Scheme::Composition(_)))?;
    let message =
        format!("{name} changes with time, which a step or a composition can follow; take one, or leave `method` out");
    wrong(&["run", "method"], message)
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
    if let Some(system) = &file.system {
        return wrong(&["run", "method"], system.of_method(method)?);
    }
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

/// The mistake of a signal that has no value at an end of a run of this duration, s.
pub(crate) fn of_ends(signal: &Signal, duration: f64) -> Option<String> {
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
