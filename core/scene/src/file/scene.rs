//! The scene of a file, whatever its parts: one body, a Lagrangian of its own, or several bodies.

use crate::file::column::Column;
use crate::file::draws::SceneEnsemble;
use crate::file::scene_file::SceneFile;
use crate::file::schedule::{Pace, Schedule};
use crate::file::sweep::Sweep;
use crate::file::system::System;

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
    pub(crate) file: Box<SceneFile>,
    pub(crate) sweep: Option<Box<Sweep<Self>>>,
    pub(crate) ensemble: Option<Box<SceneEnsemble>>,
}

impl From<SceneFile> for Scene {
    fn from(file: SceneFile) -> Self {
        Self { file: Box::new(file), sweep: None, ensemble: None }
    }
}

impl Scene {
    /// The title of the scene.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.file.title
    }

    /// The names of the events to be detected, those of joints with limits after those of the file.
    pub fn events(&self) -> impl Iterator<Item = &str> {
        self.file.event_names().into_iter()
    }

    /// The columns that follow the time in a table of the run.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.file.columns
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
        self.file.system.as_deref()
    }

    pub(crate) fn schedule(&self) -> &Schedule {
        &self.file.run
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
        let about = self.file.about();
        let sweep = self.sweep().map(|sweep| format!(", a sweep of {}", sweep.points.len()));
        let ensemble = self.ensemble().map(|ensemble| format!(", an ensemble of {}", ensemble.members));
        format!("{about}{}{}", sweep.unwrap_or_default(), ensemble.unwrap_or_default())
    }
}
