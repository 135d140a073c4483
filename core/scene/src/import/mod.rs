//! Models of other programs, written as scenes.
//!
//! A reader makes a [`Robot`](robot::Robot) of a file: links, and joints between them. Links that are fixed to each other become
//! one body, and the scene has its bodies placed by joints. Elements without a counterpart are listed, none is left out in
//! silence.
//!
//! The files depend on each other in one direction: `urdf → robot → rigid`.

mod rigid;
mod robot;
mod urdf;

use std::path::Path;

use crate::file::mistake::Mistake;
use crate::file::text::text;

/// A scene that was made of a model, and the remarks about what it doesn't have.
#[derive(Clone, Debug)]
pub struct Import {
    /// The text of the scene, for [`Scene::parse`](crate::Scene::parse).
    pub text: String,
    /// Elements of the model without a counterpart, and choices that were made.
    pub remarks: Vec<String>,
}

/// Makes a scene of a model: a file of URDF.
///
/// Its root link is space, unless the model `floats` or has no joint that moves: then the root is a body that starts at rest at
/// the origin.
///
/// # Errors
///
/// A [`Mistake`] with the place in the file: text that isn't XML, elements without what they need, links that joints don't
/// connect to one root.
pub fn import(path: impl AsRef<Path>, floats: bool) -> Result<Import, Mistake> {
    let path = path.as_ref();
    let text = text(path)?;
    urdf::read(&text)
        .and_then(|robot| robot.scene(floats))
        .map_err(|(place, message)| Mistake::at(path, place, message))
}
