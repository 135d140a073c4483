//! The progress of a long computation, for a user at a terminal.

use std::io::{self, IsTerminal as _, Write as _};
use std::time::{Duration, Instant};

/// A line that is overwritten, and erased at the end; nothing is written if the output isn't a terminal.
pub struct Progress {
    total: u64,
    done: u64,
    next: Option<Instant>,
}

/// The least time between two updates of the line.
const PAUSE: Duration = Duration::from_millis(200);

impl Progress {
    /// The progress of a computation with this number of parts.
    pub fn new(total: u64) -> Self {
        let next = io::stderr().is_terminal().then(|| Instant::now() + PAUSE);
        Self { total, done: 0, next }
    }

    /// Adds finished parts, and names the next one.
    pub fn add(&mut self, parts: u64, now: &str) {
        self.done += parts;
        if let Some(next) = self.next.filter(|next| Instant::now() >= *next) {
            let percent = 100 * self.done / self.total.max(1);
            // An error of the terminal is ignored.
            let _ = write!(io::stderr(), "\r\x1b[K{percent:>3} %  {now}");
            self.next = Some(next.max(Instant::now()) + PAUSE);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.next.is_some() {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}
