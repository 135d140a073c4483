//! Models of other programs, written as scenes.
//!
//! A reader makes a [`Robot`](model::Robot) of a file: links, and joints between them. Links that are fixed to each other become
//! one body, and the scene has its bodies placed by joints. Elements without a counterpart are listed, none is left out in
//! silence.
//!
//! The files depend on each other in one direction: `{mjcf, sdf, urdf} → {parts → xml → robot} → model → rigid`; `parts` has the
//! files that a model includes.

mod mjcf;
mod model;
mod parts;
mod rigid;
mod robot;
mod sdf;
mod urdf;
mod xml;

use std::path::Path;

use crate::file::mistake::Mistake;
use parts::Parts;

pub use robot::Import;

/// Makes a scene of a model: a file of URDF, SDF or MJCF, which the root element tells.
///
/// The root link of URDF is space, unless the model `floats` or has no joint that moves: then the root is a body that starts at
/// rest at the origin. Models of SDF and MJCF say themselves which bodies are free.
///
/// # Errors
///
/// A [`Mistake`] with the place in the file: text that isn't XML, elements without what they need, links that joints don't
/// connect to one root, joints without a counterpart that bodies would fall apart without.
pub fn import(path: impl AsRef<Path>, floats: bool) -> Result<Import, Mistake> {
    let parts = Parts::read(path.as_ref())?;
    let made = || {
        let document = xml::parsed(parts.text())?;
        let root = document.root_element();
        let robot = match root.tag_name().name() {
            "robot" => urdf::read(&root),
            "sdf" => sdf::read(&root),
            "mujoco" => mjcf::read(&root),
            other => {
                let message =
                    format!("a model is an element `robot` of URDF, `sdf` or `mujoco`, and this is `{other}`");
                Err((xml::place(&root), message))
            }
        };
        robot?.scene(floats)
    };
    made().map_err(|(place, message)| parts.mistake(place, message))
}
