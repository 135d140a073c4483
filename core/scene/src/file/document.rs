//! The scene in a text: TOML with the place of each key and value, then what the tables say, then what doesn't go
//! together.

use std::ops::Range;
use std::path::Path;

use serde::Deserialize as _;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use crate::file::body::Kinetic;
use crate::file::method::{Method, Scheme as _};
use crate::file::mistake::{Mistake, Wrong, place_of};
use crate::file::scene::{Origin, Places, SceneFile};
use crate::file::schedule::{Pace, fraction};

/// A text as tables.
pub(crate) type Document<'a> = Spanned<DeTable<'a>>;

/// The scene of a document without a sweep and an ensemble.
pub(crate) fn scene(path: &Path, text: &str, document: &Document<'_>) -> Result<SceneFile, Mistake> {
    let mut file = SceneFile::deserialize(Deserializer::from(document.clone()))
        .map_err(|error| Mistake::of_toml(path, text, &error))?;
    if let Some((span, message)) = at_odds(document, &file) {
        return Err(Mistake::at(path, place_of(text, &span), message));
    }
    let at = |keys: &[&str]| place_of(text, &span(document, keys));
    let pace = if matches!(file.run.pace, Pace::Accuracy(_)) { "accuracy" } else { "step" };
    let places =
        Places { body: at(&["body"]), start: at(&["start"]), pace: at(&["run", pace]), method: at(&["run", "method"]) };
    file.origin = Origin { path: path.to_owned(), places };
    Ok(file)
}

/// Where a value is, or the innermost table that there is around it.
pub(crate) fn span(document: &Document<'_>, keys: &[&str]) -> Range<usize> {
    let mut span = document.span();
    let mut table = Some(document.get_ref());
    for key in keys {
        let Some(value) = table.and_then(|table| table.get(*key)) else { break };
        span = value.span();
        table = value.get_ref().as_table();
    }
    span
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

/// Puts a value where the keys lead, into new tables where there are none.
pub(crate) fn set<'a>(
    table: &mut DeTable<'a>,
    keys: &[Spanned<String>],
    value: Spanned<DeValue<'a>>,
) -> Result<(), Wrong> {
    let [key, rest @ ..] = keys else { return Ok(()) };
    let name = || Spanned::new(key.span(), key.get_ref().clone().into());
    if rest.is_empty() {
        table.insert(name(), value);
        return Ok(());
    }
    let inner = table.entry(name()).or_insert_with(|| Spanned::new(key.span(), DeValue::Table(DeTable::new())));
    match inner.get_mut() {
        DeValue::Table(inner) => set(inner, rest, value),
        _ => Err((key.span(), format!("`{}` isn't a table", key.get_ref()))),
    }
}
