//! How far a long computation is, for somebody who waits at a terminal.

use std::io::{self, IsTerminal as _, Write as _};
use std::time::{Duration, Instant};

/// A line that is written over and over, and gone at the end; nothing where nobody waits.
pub struct Progress {
    total: u64,
    done: u64,
    next: Option<Instant>,
}

/// More often nobody reads it.
const PAUSE: Duration = Duration::from_millis(200);

impl Progress {
    /// The number of parts.
    pub fn new(total: u64) -> Self {
        let next = io::stderr().is_terminal().then(|| Instant::now() + PAUSE);
        Self { total, done: 0, next }
    }

    /// Names what is done now, after this number of further parts.
    pub fn add(&mut self, parts: u64, now: &str) {
        self.done += parts;
        if let Some(next) = self.next.filter(|next| Instant::now() >= *next) {
            let percent = 100 * self.done / self.total.max(1);
            // Nobody reads it where it can't be written.
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
