//! Failures as one family of Python's exceptions.

use std::fmt::Display;

use liestep_late::LateError;
use liestep_scene::Mistake;
use pyo3::prelude::*;

/// The reason of a failure, before there is an interpreter to raise it in.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The class of the exception in `liestep.errors`, and its message.
    Of(&'static str, String),
    /// The mistakes of a text, each with its line and column.
    Text(Vec<(String, usize, usize)>),
    /// A mistake of a scene's file.
    File(Mistake),
    /// An exception raised by Python, as for Ctrl-C.
    Raised(PyErr),
}

impl Failure {
    pub(crate) fn setup(cause: &impl Display) -> Self {
        Self::Of("SetupError", cause.to_string())
    }

    pub(crate) fn step(cause: &impl Display) -> Self {
        Self::Of("StepError", cause.to_string())
    }
}

impl From<LateError> for Failure {
    fn from(error: LateError) -> Self {
        match error {
            LateError::Mistakes(mistakes) => {
                Self::Text(mistakes.into_iter().map(|one| (one.message, one.line, one.column)).collect())
            }
            other => Self::Of("DeclarationError", other.to_string()),
        }
    }
}

impl From<Mistake> for Failure {
    fn from(mistake: Mistake) -> Self {
        Self::File(mistake)
    }
}

impl From<PyErr> for Failure {
    fn from(error: PyErr) -> Self {
        Self::Raised(error)
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        Python::attach(|py| {
            let class = |name: &str| py.import("liestep.errors")?.getattr(name);
            let words = |message: String| -> PyResult<String> {
                py.import("liestep._words")?.getattr("in_python")?.call1((message,))?.extract()
            };
            let raised = match failure {
                Failure::Raised(error) => return error,
                Failure::Of(name, message) => class(name).and_then(|class| class.call1((words(message)?,))),
                Failure::Text(mistakes) => {
                    let own = mistakes.into_iter().map(|(message, line, column)| Ok((words(message)?, line, column)));
                    let own = own.collect::<PyResult<Vec<_>>>();
                    class("DeclarationError").and_then(|class| class.call_method1("of", (own?,)))
                }
                Failure::File(mistake) => {
                    let (line, column) = mistake.place().unzip();
                    class("SceneError").and_then(|class| class.call1((mistake.to_string(), line, column)))
                }
            };
            raised.map_or_else(|error| error, PyErr::from_value)
        })
    }
}
