//! Scenes from files.

use std::path::PathBuf;
use std::sync::Arc;

use liestep::recording::{Column, Sink, SinkError};
use liestep_scene::{Run, Scene, declaration};
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::run::Signals;
use crate::state::{Source, State};
use crate::table::{Columns, Table};

/// A scene, read from a file.
#[pyclass(frozen, module = "liestep._native")]
pub(crate) struct File(Scene);

/// A finished run of a file's scene.
#[pyclass(frozen, module = "liestep._native")]
pub(crate) struct FileRun {
    scene: Scene,
    run: Run,
    #[pyo3(get)]
    table: Py<Table>,
}

/// The size of a unit in another one of the same quantity, as files have them.
#[pyfunction]
pub(crate) fn ratio(unit: &str, other: &str) -> Option<f64> {
    liestep_scene::ratio(unit, other)
}

/// The text of a body or an effect of the library: what `liestep._library` reads.
#[pyfunction]
pub(crate) fn library(name: &str) -> Option<&'static str> {
    declaration(&name.replace('_', "-"))
}

/// A sink that stops at Ctrl-C.
struct InterruptibleColumns<'a>(&'a mut Columns, &'a Signals);

impl Sink for InterruptibleColumns<'_> {
    fn begin(&mut self, columns: &[Column]) -> Result<(), SinkError> {
        self.0.begin(columns)
    }

    fn write(&mut self, rows: &[f64]) -> Result<(), SinkError> {
        self.0.write(rows)?;
        Ok(self.1.look()?)
    }

    fn end(&mut self) -> Result<(), SinkError> {
        self.0.end()
    }
}

#[pymethods]
impl File {
    /// Reads a file, or takes its text if that is passed.
    #[new]
    #[pyo3(signature = (path, text = None))]
    #[allow(clippy::needless_pass_by_value)] // as Python gives it
    fn new(path: PathBuf, text: Option<&str>) -> PyResult<Self> {
        let scene = text.map_or_else(|| Scene::read(&path), |text| Scene::parse(&path, text));
        Ok(Self(scene.map_err(Failure::from)?))
    }

    /// A description of the terms and of the steps.
    #[getter]
    fn about(&self) -> String {
        self.0.about()
    }

    #[getter]
    fn title(&self) -> &str {
        self.0.title()
    }

    /// The state at the start, for a loop.
    fn start(&self) -> PyResult<State> {
        let (_, state) = self.0.stepper().map_err(Failure::from)?;
        self.resume(state.numbers().to_vec())
    }

    /// A state that continues another by its numbers.
    fn resume(&self, numbers: Vec<f64>) -> PyResult<State> {
        Ok(State::of(Arc::new(Source::File(self.0.clone())), numbers)?)
    }

    fn run(&self, py: Python<'_>) -> PyResult<FileRun> {
        let mut columns = Columns::new(0);
        let made = py.detach(|| {
            let signals = Signals::new();
            let mut table = InterruptibleColumns(&mut columns, &signals);
            let made = self.0.run_with(&mut |_| (), Some(&mut table));
            made.map_err(|mistake| signals.into_failure().unwrap_or_else(|| mistake.into()))
        });
        let run = made?;
        Ok(FileRun { scene: self.0.clone(), run, table: Py::new(py, columns.into_table())? })
    }
}

#[pymethods]
impl FileRun {
    /// Lines about the start and the end of the run.
    #[getter]
    fn summary(&self) -> String {
        self.scene.summary(&self.run)
    }

    #[getter]
    fn steps(&self) -> u64 {
        self.run.steps()
    }

    /// The events that occurred: a name, a time, and whether the quantity rose.
    #[getter]
    fn events(&self) -> Vec<(String, f64, bool)> {
        let names: Vec<&str> = self.scene.events().collect();
        let happened = self.run.happenings().iter();
        happened
            .map(|one| (names.get(one.event).map_or("", |name| name).to_owned(), one.sample.time, one.rising))
            .collect()
    }

    fn picture(&self) -> PyResult<String> {
        Ok(self.scene.picture(&self.run).map_err(|error| Failure::Of("Error", error.to_string()))?)
    }

    /// The page that plays the run.
    fn page(&self) -> String {
        self.scene.page(&self.run)
    }
}
