//! The scene of a file, whatever its parts: one body, a Lagrangian of its own, or several bodies.

use std::path::Path;

use toml::de::{DeTable, DeValue};

use crate::file::column::Column;
use crate::file::common::Parts as _;
use crate::file::document::scene;
use crate::file::draws::SceneEnsemble;
use crate::file::mistake::Mistake;
use crate::file::scene::SceneFile;
use crate::file::schedule::{Pace, Schedule};
use crate::file::sweep::Sweep;
use crate::file::system::System;
use crate::file::tables::Document;

/// The scene of a file: [one body](SceneFile) or a Lagrangian of its own, or [several bodies](System), with everything that
/// is made of either: a run, its table, picture and page, a sweep, an ensemble.
///
/// # Examples
///
/// ```
/// let text = r#"
/// title = "A pendulum"
/// gravity = { g = 9.81, up = [0, 0, 1] }
/// [[body]]
/// name = "rod"
/// m = 1
/// cylinder = { radius = "1 cm", length = 1 }
/// [[joint]]
/// kind = "pin"
/// bodies = ["space", "rod"]
/// at = [[0, 0, 0], [0, 0, 0.5]]
/// axes = [[0, 1, 0], [0, 1, 0]]
/// angle = "30 deg"
/// [run]
/// duration = 0.1
/// accuracy = 1e-6
/// "#;
/// let scene = liestep_scene::Scene::parse("pendulum.toml", text)?;
/// let run = scene.run()?;
/// assert!(run.choice().is_some_and(|choice| choice.error < 1e-6));
/// # Ok::<(), liestep_scene::Mistake>(())
/// ```
#[derive(Clone)]
pub struct Scene {
    pub(crate) content: Content,
    pub(crate) sweep: Option<Box<Sweep<Self>>>,
    pub(crate) ensemble: Option<Box<SceneEnsemble>>,
}

/// The parts of a scene.
#[derive(Clone)]
pub(crate) enum Content {
    /// From a table `[body]` or `[lagrangian]`.
    Body(Box<SceneFile>),
    /// From tables `[[body]]`.
    System(Box<System>),
}

/// A value of the parts of a scene, by what both kinds have in common.
macro_rules! of_parts {
    ($scene:expr, $parts:ident => $value:expr) => {
        match &$scene.content {
            $crate::file::kinds::Content::Body($parts) => {
                let $parts = &**$parts;
                $value
            }
            $crate::file::kinds::Content::System($parts) => {
                let $parts = &**$parts;
                $value
            }
        }
    };
}

pub(crate) use of_parts;

impl Content {
    /// The parts of a document without a sweep and an ensemble.
    pub(crate) fn read(path: &Path, text: &str, document: &Document<'_>) -> Result<Self, Mistake> {
        if has_several(document.get_ref()) {
            System::of_document(path, text, document).map(|system| Self::System(Box::new(system)))
        } else {
            scene(path, text, document).map(|file| Self::Body(Box::new(file)))
        }
    }
}

/// Whether the document lists several bodies.
fn has_several(document: &DeTable<'_>) -> bool {
    document.get("body").is_some_and(|body| matches!(body.get_ref(), DeValue::Array(_)))
}

impl From<Content> for Scene {
    fn from(content: Content) -> Self {
        Self { content, sweep: None, ensemble: None }
    }
}

impl Scene {
    /// The title of the scene.
    #[must_use]
    pub fn title(&self) -> &str {
        of_parts!(self, parts => parts.title())
    }

    /// The names of the events to be detected, those of joints with limits after those of the file.
    pub fn events(&self) -> impl Iterator<Item = &str> {
        of_parts!(self, parts => parts.event_names()).into_iter()
    }

    /// The columns that follow the time in a table of the run.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        of_parts!(self, parts => parts.columns())
    }

    /// The sweep over scenes, if the file has a table `sweep`.
    #[must_use]
    pub fn sweep(&self) -> Option<&Sweep<Self>> {
        self.sweep.as_deref()
    }

    /// The ensemble of scenes, if the file has a table `ensemble`.
    #[must_use]
    pub fn ensemble(&self) -> Option<&SceneEnsemble> {
        self.ensemble.as_deref()
    }

    /// The several bodies with their joints, if the scene has some.
    #[must_use]
    pub fn system(&self) -> Option<&System> {
        if let Content::System(system) = &self.content { Some(system) } else { None }
    }

    pub(crate) fn schedule(&self) -> &Schedule {
        of_parts!(self, parts => parts.schedule())
    }

    /// Whether the step is chosen by trial runs, for an accuracy.
    #[must_use]
    pub fn asks_for_accuracy(&self) -> bool {
        matches!(self.schedule().pace, Pace::Accuracy(_))
    }

    /// The number of steps; none where they are chosen for an accuracy.
    #[must_use]
    pub fn steps(&self) -> Option<u64> {
        match self.schedule().pace {
            Pace::Step { steps, .. } => Some(steps.into()),
            Pace::Accuracy(_) => None,
        }
    }

    /// A description of the terms and the steps, in words.
    #[must_use]
    pub fn about(&self) -> String {
        let about = of_parts!(self, parts => parts.about());
        let sweep = self.sweep().map(|sweep| format!(", a sweep of {}", sweep.points.len()));
        let ensemble = self.ensemble().map(|ensemble| format!(", an ensemble of {}", ensemble.members));
        format!("{about}{}{}", sweep.unwrap_or_default(), ensemble.unwrap_or_default())
    }
}
