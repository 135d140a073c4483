//! What is printed, and how far a run is.

use std::fmt::Display;
use std::io::{self, IsTerminal as _, Write as _};
use std::time::{Duration, Instant};

use liestep_plot::output;
use liestep_scene::visible;

use crate::failure::Failure;

/// Somebody who waits at a terminal sees how far a run is, and nothing is left of it when this is gone.
pub(crate) struct Progress {
    /// Where there is a terminal.
    start: Option<Instant>,
    is_shown: bool,
}

impl Progress {
    pub(crate) fn new() -> Self {
        Self { start: io::stderr().is_terminal().then(Instant::now), is_shown: false }
    }

    pub(crate) fn show(&mut self, progress: &dyn Display) {
        /// What takes less needs no patience.
        const PATIENCE: Duration = Duration::from_millis(300);
        if self.start.is_some_and(|start| start.elapsed() > PATIENCE) {
            self.is_shown = true;
            // Nobody reads it where it can't be written.
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

/// Prints a report with its control characters written out. A reader that has gone away, as `head` does, has read enough.
pub(crate) fn print(report: &str) -> Result<(), Failure> {
    match output::print(&visible(report)) {
        Err(cause) if cause.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::Output(format!("cannot print: {cause}")))
        }
        _ => Ok(()),
    }
}
