//! Failures of the program, and its exit codes.

use std::fmt;
use std::process::ExitCode;

use liestep_plot::output::CannotWrite;
use liestep_scene::{Kind, Mistake};

/// The reason for a failure. Each has an exit code, as `liestep --help` lists them.
pub(crate) enum Failure {
    /// 1 for a wrong file, 3 for a run that stopped, 4 for a table that can't be written.
    Scene(Mistake),
    /// 2, like any mistake in a command line.
    Command(String),
    /// 3: some of several runs stopped.
    Runs(String),
    /// 4: a result couldn't be written or printed.
    Output(String),
    /// 130: Ctrl-C has stopped it.
    Stopped(String),
}

impl Failure {
    pub(crate) fn code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Scene(mistake) if mistake.kind() == Kind::File => 1,
            Self::Command(_) => 2,
            Self::Scene(mistake) if mistake.kind() == Kind::Table => 4,
            Self::Scene(_) | Self::Runs(_) => 3,
            Self::Output(_) => 4,
            Self::Stopped(_) => 130,
        })
    }
}

impl From<Mistake> for Failure {
    fn from(mistake: Mistake) -> Self {
        Self::Scene(mistake)
    }
}

impl From<CannotWrite> for Failure {
    fn from(cause: CannotWrite) -> Self {
        Self::Output(cause.to_string())
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(mistake) => mistake.fmt(f),
            Self::Command(message) | Self::Runs(message) | Self::Output(message) | Self::Stopped(message) => {
                f.write_str(message)
            }
        }
    }
}
