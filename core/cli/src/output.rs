//! Printing, and the display of a run's progress.

use std::fmt::Display;
use std::io::{self, IsTerminal as _, Write as _};
use std::time::{Duration, Instant};

use liestep_plot::output;
use liestep_scene::visible;

use crate::failure::Failure;

/// The progress of a run, displayed on a terminal and erased at the end.
pub(crate) struct Progress {
    /// The start of the run; none without a terminal.
    start: Option<Instant>,
    is_shown: bool,
}

impl Progress {
    pub(crate) fn new() -> Self {
        Self { start: io::stderr().is_terminal().then(Instant::now), is_shown: false }
    }

    pub(crate) fn show(&mut self, progress: &dyn Display) {
        /// Time before the progress is displayed.
        const PATIENCE: Duration = Duration::from_millis(300);
        if self.start.is_some_and(|start| start.elapsed() > PATIENCE) {
            self.is_shown = true;
            // An unwritable terminal has no reader.
            let _ = write!(io::stderr(), "\r{progress}\x1b[K");
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.is_shown {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}

/// Prints a report with its control characters written out. A reader that closes the pipe early, as `head` does, is no
/// failure.
pub(crate) fn print(report: &str) -> Result<(), Failure> {
    match output::print(&visible(report)) {
        Err(cause) if cause.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::Output(format!("cannot print: {cause}")))
        }
        _ => Ok(()),
    }
}
