//! Scenes from files. The rooms import each other in one direction: `{show → run, import} → file`.
//!
//! A file names a body, the effects on it, the start of the motion, the step or an accuracy, and what to draw and to
//! record. A [`Scene`] is read from a [`SceneFile`], which lists the keys of one body or of a Lagrangian of the
//! file's own; the tables of several bodies are its [`System`]. The folder `examples/scenes` has examples. Numbers are in SI
//! units, or texts with a unit: `"30 deg"`.
//! Mistakes in a file are reported with line and column, as a [`Mistake`].
//!
//! ```
//! let text = r#"
//! title = "A wing nut in free flight"
//! [body]
//! moments = [1.0, 2.0, 2.5]
//! [start]
//! euler = [0, 0, 0]
//! velocity = [0.001, "2 rad/s", 0.001]
//! [run]
//! step = "20 ms"
//! duration = 80
//! "#;
//! let scene = liestep_scene::Scene::parse("wing-nut.toml", text)?;
//! let run = scene.run()?;
//! assert_eq!(run.samples().len(), 4001);
//! std::fs::write(std::env::temp_dir().join("wing-nut.html"), scene.page(&run))?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod file;
mod import;
mod run;
mod show;

pub use file::column::Column;
pub use file::draws::{SceneEnsemble, Spread};
pub use file::histogram::EndHistogram;
pub use file::joint::changing_numbers;
pub use file::kepler::orbit;
pub use file::mistake::{Kind, Mistake, visible};
pub use file::quantity::{OFF_UNIT, ratio};
pub use file::scene::Scene;

pub use file::sample::{BodySample, Sample};
pub use file::scene_file::SceneFile;
pub use file::sweep::Sweep;
pub use file::system::System;
pub use import::{Import, import};
pub use liestep_late::Sums;
pub use run::data::Whole;
pub use run::make::{EventFunction, Happening, Run, Watch};
pub use run::simulate::MemberStart;
pub use show::derivation::{Form, declaration, derivation, derived, written};
pub use show::fmu::{Fmi, Fmu, archive};
pub use show::recording::Recording;
