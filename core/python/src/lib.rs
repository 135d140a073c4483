//! liestep in Python: the part that is written in Rust, and that the package `liestep` is made of.
//!
//! `lib → {estimate → control, gradient, picture, file → state} → scene → {signal → orbit, ensemble} → {run, method} → start → table → failure`: a text is derived by `liestep-late`; what it
//! declares is stepped by any method, recorded into columns that `NumPy` and Arrow look at where they are, or drawn at random.
//! Whatever takes long leaves the interpreter to others, and asks it now and then whether it is to stop.
#![forbid(unsafe_code)]

mod control;
mod ensemble;
mod estimate;
mod failure;
mod file;
mod gradient;
mod method;
mod orbit;
mod picture;
mod run;
mod scene;
mod signal;
mod start;
mod state;
mod table;

use std::sync::Arc;

use liestep::with::Scheme;
use liestep_ensemble::share_of;
use liestep_late::{Declaration, Sums};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::control::Task;
use crate::ensemble::{Draws, Members};
use crate::failure::Failure;
use crate::gradient::{Covectors, Motion};
use crate::method::{Names, method};
use crate::orbit::{Along, Orbit};
use crate::run::{Course, RunRecord};
use crate::signal::{Change, Signal};
use crate::start::{Start, started};
use crate::state::{Source, State};
use crate::table::{Table, View};

/// The declaration of a text.
#[pyclass(frozen, module = "liestep._native")]
struct Derivation(&'static Declaration);

#[pymethods]
impl Derivation {
    #[new]
    fn new(py: Python<'_>, text: &str) -> PyResult<Self> {
        Ok(Self(py.detach(|| Declaration::parse(text)).map_err(Failure::from)?))
    }

    /// The derived equations, as text.
    #[getter]
    fn derivation(&self) -> &'static str {
        &self.0.derivation
    }

    /// The equations as LaTeX.
    #[getter]
    fn latex(&self) -> String {
        liestep_late::latex(self.0)
    }

    #[getter]
    fn group(&self) -> String {
        self.0.group()
    }

    /// The number of components of a velocity.
    #[getter]
    fn dimension(&self) -> usize {
        self.0.factors.iter().map(|factor| factor.generators.len()).sum()
    }

    /// The kind of the declaration, by its attribute.
    #[getter]
    fn role(&self) -> &'static str {
        self.0.role.attribute()
    }

    #[getter]
    fn has_pace(&self) -> bool {
        self.0.energy.is_some()
    }

    /// The number of the parameter of each advected value, none of a configuration, and how many numbers the value has.
    #[getter]
    fn carried(&self) -> Vec<(Option<usize>, usize)> {
        self.0.carried.iter().map(|one| (one.field, one.shape.0 * one.shape.1)).collect()
    }

    /// The names of the parameters, and how many numbers each has.
    #[getter]
    fn parameters(&self) -> Vec<(&'static str, usize)> {
        self.0.parameters.iter().map(|parameter| (parameter.name.as_str(), parameter.kind.len())).collect()
    }
}

/// A term, and all its numbers.
type Term<'py> = (Bound<'py, Derivation>, Vec<f64>);

/// The declarations of terms, and the numbers of all.
fn apart(terms: Vec<Term<'_>>) -> (Vec<&'static Declaration>, Vec<f64>) {
    let (terms, numbers): (Vec<_>, Vec<_>) = terms.into_iter().map(|(term, numbers)| (term.get().0, numbers)).unzip();
    (terms, numbers.concat())
}

/// The sum of terms with their numbers.
#[pyclass(frozen, module = "liestep._native")]
struct Scene(scene::Scene);

#[pymethods]
impl Scene {
    #[new]
    fn new(py: Python<'_>, terms: Vec<Term<'_>>, changes: Vec<Change>) -> PyResult<Self> {
        let (terms, numbers) = apart(terms);
        Ok(Self(py.detach(|| scene::scene(&terms, &numbers, changes))?))
    }

    #[getter]
    fn is_self_adjoint(&self) -> bool {
        self.0.is_self_adjoint()
    }

    /// A step in C99.
    fn c(&self, compensated: bool) -> PyResult<String> {
        Ok(self.0.c(if compensated { Sums::Compensated } else { Sums::Rounded })?)
    }

    /// The step as data, with the claims that are to be checked.
    #[getter]
    fn certificate(&self) -> PyResult<String> {
        Ok(self.0.certificate()?)
    }

    /// The kinds of the group's factors, and the rows of their matrices.
    #[getter]
    fn factors(&self) -> PyResult<Vec<(&'static str, usize)>> {
        Ok(self.0.factors()?)
    }

    /// The attitude `g exp ζ̂`.
    fn displaced(&self, attitude: Vec<f64>, turn: Vec<f64>) -> PyResult<Vec<f64>> {
        Ok(self.0.displaced(&attitude, &turn)?)
    }

    /// The derivatives of a displacement after `ζ` by `ζ`, column by column.
    fn turn_slopes(&self, turn: Vec<f64>) -> PyResult<Vec<f64>> {
        Ok(self.0.turn_slopes(&turn)?)
    }

    #[allow(clippy::needless_pass_by_value)]
    fn check(&self, h: f64, how: Names) -> PyResult<()> {
        Ok(self.0.stepper((method(&how)?, h)).map(drop)?)
    }

    #[allow(clippy::needless_pass_by_value)]
    fn run<'py>(
        &self,
        py: Python<'py>,
        h: f64,
        how: Names,
        start: Start,
        course: Course,
    ) -> PyResult<Bound<'py, PyDict>> {
        let method = method(&how)?;
        let recorded = py.detach(|| self.0.run((method, h), &start, &course))?;
        shown(py, recorded)
    }

    /// The gradient of a scalar by whose derivatives a run's columns are given.
    fn gradient<'py>(
        &self,
        py: Python<'py>,
        h: f64,
        how: Names,
        motion: Motion,
        by: Covectors,
    ) -> PyResult<Bound<'py, PyDict>> {
        self.0.gradient(py, (method(&how)?, h), &motion, &by)
    }

    /// The changes of a run's columns along changes of attitude, velocity and parameters.
    fn along<'py>(
        &self,
        py: Python<'py>,
        h: f64,
        how: Names,
        motion: Motion,
        change: (Vec<f64>, Vec<f64>, Vec<f64>),
    ) -> PyResult<Bound<'py, PyDict>> {
        self.0.along(py, (method(&how)?, h), &motion, change)
    }

    /// The state transition matrix, column by column, or the exponents, if `between` counts the steps from one
    /// orthonormalisation to the next.
    fn transition(
        &self,
        py: Python<'_>,
        h: f64,
        how: Names,
        start: Start,
        steps: u64,
        between: Option<u64>,
    ) -> PyResult<Vec<f64>> {
        let method = (method(&how)?, h);
        Ok(py.detach(|| self.0.transition(method, &start, (steps, between)))?)
    }

    /// The state at a start, for a loop.
    #[allow(clippy::needless_pass_by_value)]
    fn start(&self, h: f64, how: Names, start: Start) -> PyResult<State> {
        let method = (method(&how)?, h);
        let stepper = self.0.stepper(method)?;
        let numbers = started(&stepper, &start)?.numbers().to_vec();
        Ok(State::of(Arc::new(Source::Declared(self.0.clone(), method)), numbers)?)
    }

    /// A state that continues another by its numbers.
    #[allow(clippy::needless_pass_by_value)]
    fn resume(&self, h: f64, how: Names, numbers: Vec<f64>) -> PyResult<State> {
        Ok(State::of(Arc::new(Source::Declared(self.0.clone(), (method(&how)?, h))), numbers)?)
    }

    #[allow(clippy::needless_pass_by_value)]
    fn ask<'py>(&self, py: Python<'py>, tolerance: f64, start: Start, course: Course) -> PyResult<Bound<'py, PyDict>> {
        let (recorded, choice) = py.detach(|| self.0.accurate(tolerance, &start, &course))?;
        let dictionary = shown(py, recorded)?;
        dictionary.set_item("choice", choice.to_string())?;
        dictionary.set_item("method", choice.chosen().scheme.parts())?;
        dictionary.set_item("step", choice.chosen().step)?;
        dictionary.set_item("error", choice.error)?;
        Ok(dictionary)
    }

    /// The error of an end by the states of the exact motion, as an accuracy measures it.
    #[allow(clippy::needless_pass_by_value)]
    fn error(&self, end: [Vec<f64>; 2], exact: Vec<[Vec<f64>; 2]>, time: f64) -> PyResult<f64> {
        Ok(self.0.error(&end, &exact, time)?)
    }

    #[allow(clippy::needless_pass_by_value)]
    fn members<'py>(
        &self,
        py: Python<'py>,
        h: f64,
        how: Names,
        start: Start,
        draws: Draws,
        plan: Members,
    ) -> PyResult<Bound<'py, PyDict>> {
        let method = method(&how)?;
        let outcome = py.detach(|| self.0.members((method, h), &start, draws, plan))?;
        let (dictionary, report) = (PyDict::new(py), outcome.report);
        dictionary.set_item("table", Py::new(py, outcome.table.into_table())?)?;
        dictionary.set_item("chunks", report.chunks)?;
        dictionary.set_item("made", report.made)?;
        dictionary.set_item("missing", report.missing)?;
        dictionary.set_item("finished", report.outcome.finished)?;
        dictionary.set_item("failed", report.outcome.failed())?;
        let failures = outcome.failures.iter().map(|one| (one.member, one.steps, one.failure.to_string()));
        dictionary.set_item("failures", failures.collect::<Vec<_>>())?;
        let faults = report.faults.iter().map(ToString::to_string);
        dictionary.set_item("faults", faults.collect::<Vec<_>>())?;
        Ok(dictionary)
    }
}

/// A run as Python's dictionary. What stopped it is raised there, with what was recorded.
fn shown(py: Python<'_>, recorded: RunRecord) -> PyResult<Bound<'_, PyDict>> {
    let dictionary = PyDict::new(py);
    dictionary.set_item("table", Py::new(py, recorded.columns.into_table())?)?;
    let events = recorded.events.into_iter();
    let events = events.map(|(columns, rising)| Ok((Py::new(py, columns.into_table())?, rising)));
    dictionary.set_item("events", events.collect::<PyResult<Vec<_>>>()?)?;
    dictionary.set_item("steps", recorded.steps)?;
    dictionary.set_item("iterations", recorded.iterations)?;
    dictionary.set_item("ending", recorded.ending)?;
    dictionary.set_item("failure", recorded.failure.map(PyErr::from))?;
    Ok(dictionary)
}

/// A plan of the sum of these terms.
#[pyfunction]
fn plan<'py>(py: Python<'py>, terms: Vec<Term<'py>>, task: Task) -> PyResult<Bound<'py, PyDict>> {
    let (terms, numbers) = apart(terms);
    control::plan(py, &terms, &numbers, &task)
}

/// An estimate of the sum of these terms.
#[pyfunction]
#[pyo3(name = "estimate")]
fn fitted<'py>(py: Python<'py>, terms: Vec<Term<'py>>, task: estimate::Task) -> PyResult<Bound<'py, PyDict>> {
    let (terms, numbers) = apart(terms);
    estimate::estimate(py, &terms, &numbers, &task)
}

/// Reads a part of a text as tokens.
#[pyfunction]
fn lex(part: &str) -> PyResult<()> {
    Ok(Declaration::lex(part).map_err(Failure::from)?)
}

/// The names of all schemes, by the kind of the method.
#[pyfunction]
fn schemes() -> Vec<(&'static str, Vec<&'static str>)> {
    Scheme::names().into()
}

/// The order of a method, which that of a declared step may exceed.
#[pyfunction]
fn order(how: Names) -> PyResult<u32> {
    Ok(method(&how)?.scheme.order())
}

/// `1/4` as the share 1 of 4.
#[pyfunction]
fn share(text: &str) -> PyResult<(u64, u64)> {
    Ok(share_of(text).map_err(|message| Failure::Of("SetupError", message))?)
}

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::{
        Along, Derivation, Orbit, Scene, Signal, State, Table, View, fitted, lex, order, plan, schemes, share,
    };
    #[pymodule_export]
    use crate::file::{File, FileRun, library, ratio};
    #[pymodule_export]
    use crate::picture::{page, picture};
    #[pymodule_export]
    const OFF_UNIT: f64 = liestep_scene::OFF_UNIT;
}
