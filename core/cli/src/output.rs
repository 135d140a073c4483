//! The folder that results are written to, and what is printed.

use std::fmt;
use std::fs;
use std::io::{self, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::failure::Failure;

/// A folder that exists and takes files, and what was written there.
pub(crate) struct Output {
    folder: PathBuf,
    written: Vec<(String, usize)>,
}

fn cannot(path: &Path, cause: &io::Error) -> Failure {
    Failure::Output(format!("cannot write to {}: {cause}; choose another folder with --out", path.display()))
}

impl Output {
    /// Makes the folder and tries it, so that a long run doesn't end with nowhere to go.
    pub(crate) fn new(folder: PathBuf) -> Result<Self, Failure> {
        let probe = folder.join(".writable");
        fs::create_dir_all(&folder)
            .and_then(|()| fs::write(&probe, ""))
            .and_then(|()| fs::remove_file(&probe))
            .map_err(|cause| cannot(&folder, &cause))?;
        Ok(Self { folder, written: Vec::new() })
    }

    /// Writes one file.
    pub(crate) fn write(&mut self, name: &str, content: &str) -> Result<(), Failure> {
        let path = self.folder.join(name);
        fs::write(&path, content).map_err(|cause| cannot(&path, &cause))?;
        self.written.push((name.to_owned(), content.len()));
        Ok(())
    }
}

/// Somebody who waits at a terminal sees how far a run is, and nothing is left of it at its end.
pub(crate) fn progress() -> impl FnMut(f64) {
    /// What takes less needs no patience.
    const PATIENCE: Duration = Duration::from_millis(300);
    let start = io::stderr().is_terminal().then(Instant::now);
    move |share| {
        let shown = match start {
            Some(start) if start.elapsed() > PATIENCE && share < 1.0 => format!("\r{:>3.0} %", 100.0 * share),
            Some(_) => "\r\x1b[K".to_owned(),
            None => return,
        };
        // Nobody reads it where it can't be written.
        let _ = write!(io::stderr(), "{shown}");
    }
}

/// Prints a report. A reader that has gone away is an error and not a panic.
pub(crate) fn print(report: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    let written = out.write_all(report.as_bytes()).and_then(|()| out.flush());
    written.map_err(|cause| Failure::Output(format!("cannot print: {cause}")))
}

impl fmt::Display for Output {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Written to {}:", self.folder.display())?;
        for (name, bytes) in &self.written {
            writeln!(f, "  {name:<28} {:>6} kB", bytes.div_ceil(1000))?;
        }
        Ok(())
    }
}
