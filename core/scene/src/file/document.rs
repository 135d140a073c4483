//! The scene of a document: what its tables say, then what doesn't go together.

use std::path::Path;

use serde::Deserialize as _;
use toml::de::Deserializer;

use crate::file::body::Kinetic;
use crate::file::column::Column;
use crate::file::method::{Method, Scheme as _};
use crate::file::mistake::{Mistake, Wrong, place_of};
use crate::file::scene::{Origin, Places, SceneFile};
use crate::file::schedule::{Pace, fraction};
use crate::file::tables::{Document, span};

/// The scene of a document without a sweep and an ensemble.
pub(crate) fn scene(path: &Path, text: &str, document: &Document<'_>) -> Result<SceneFile, Mistake> {
    let mut file = SceneFile::deserialize(Deserializer::from(document.clone()))
        .map_err(|error| Mistake::of_toml(path, text, &error))?;
    let located = |(span, message): Wrong| Mistake::at(path, place_of(text, &span), message);
    at_odds(document, &file).map_or(Ok(()), Err).map_err(located)?;
    let default = ["velocity", "spatial-momentum", "energy", "axis", "quaternion"];
    file.columns = file.output.columns(&Column::OF_ONE_BODY, &default).map_err(located)?;
    let at = |keys: &[&str]| place_of(text, &span(document, keys));
    let pace = if matches!(file.run.pace, Pace::Accuracy(_)) { "accuracy" } else { "step" };
    let places =
        Places { body: at(&["body"]), start: at(&["start"]), pace: at(&["run", pace]), method: at(&["run", "method"]) };
    file.origin = Origin { path: path.to_owned(), places };
    Ok(file)
}

fn has(document: &Document<'_>, table: &str, key: &str) -> bool {
    document.get_ref().get(table).and_then(|table| table.get_ref().get(key)).is_some()
}

/// Keys that don't go together, though each could stand there.
fn at_odds(document: &Document<'_>, file: &SceneFile) -> Option<Wrong> {
    let wrong = |keys: &[&str], message: String| Some((span(document, keys), message));
    if has(document, "run", "step") && has(document, "run", "accuracy") {
        return wrong(&["run", "accuracy"], "a run has either a `step` or an `accuracy`".to_owned());
    }
    if let Pace::Step { step, .. } = file.run.pace
        && let Some(message) = fraction(step, file.run.duration)
    {
        return wrong(&["run", "duration"], message);
    }
    if let Pace::Accuracy(_) = file.run.pace {
        if let Some(force) = file.force() {
            let message =
                format!("an accuracy can be asked for in conservative scenes; {force} does work, so give a `step`");
            return wrong(&["run", "accuracy"], message);
        }
        if has(document, "run", "method") {
            return wrong(
                &["run", "method"],
                "an `accuracy` chooses the method; give a `step` to choose it".to_owned(),
            );
        }
        if file.body.kinetic != Kinetic::Rigid {
            return wrong(
                &["body", "kinetic"],
                "an `accuracy` chooses the method for the kinetic term `rigid`".to_owned(),
            );
        }
    }
    let method = &file.run.method;
    if !matches!(method, Method::Step)
        && let Some(force) = file.force()
    {
        let name = method.name();
        return wrong(&["run", "method"], format!("{name} needs a conservative scene; {force} does work"));
    }
    if let Method::Composition(scheme) = method
        && scheme.0.base() != file.order()
    {
        let (name, base, order) = (scheme.0.called(), scheme.0.base(), file.order());
        return wrong(
            &["run", "method"],
            format!("{name} composes a step of order {base}, and that of this scene is of order {order}"),
        );
    }
    if let Method::Splitting(_) | Method::Processed(_) | Method::Collocation(_) = method
        && file.body.kinetic != Kinetic::Rigid
    {
        let message = format!("{} moves the body exactly; leave `kinetic` out", method.name());
        return wrong(&["body", "kinetic"], message);
    }
    None
}
