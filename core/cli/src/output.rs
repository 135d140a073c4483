//! The folder that results are written to, and what is printed.

use std::fmt;
use std::fs;
use std::fs::File;
use std::io::{self, IsTerminal as _, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::time::{Duration, Instant};

use crate::failure::Failure;

/// A folder that exists and takes files, and what was written there.
pub(crate) struct Output {
    folder: PathBuf,
    /// Names and lengths.
    written: Vec<(String, u64)>,
}

fn cannot(path: &Path, cause: &io::Error) -> Failure {
    Failure::Output(format!("cannot write to {}: {cause}; choose another folder with --out", path.display()))
}

impl Output {
    /// Makes the folder and tries it, so that a long run doesn't end with nowhere to go.
    pub(crate) fn new(folder: PathBuf) -> Result<Self, Failure> {
        // Others may try it at the same time.
        let probe = folder.join(format!(".writable-{}", process::id()));
        fs::create_dir_all(&folder)
            .and_then(|()| fs::write(&probe, ""))
            .and_then(|()| fs::remove_file(&probe))
            .map_err(|cause| cannot(&folder, &cause))?;
        Ok(Self { folder, written: Vec::new() })
    }

    /// Writes one file, as a whole or not at all.
    pub(crate) fn write(&mut self, name: &str, content: &str) -> Result<(), Failure> {
        let (path, beside) = (self.folder.join(name), self.folder.join(format!(".{name}-{}", process::id())));
        let written = fs::write(&beside, content).and_then(|()| fs::rename(&beside, &path));
        written.map_err(|cause| {
            // It may not be there.
            let _ = fs::remove_file(&beside);
            cannot(&path, &cause)
        })?;
        self.written.push((name.to_owned(), content.len() as u64));
        Ok(())
    }

    /// A file for what is written bit by bit, which is made with the first.
    pub(crate) fn grows(&self, name: &str) -> Growing {
        Growing { path: self.folder.join(name), file: None }
    }

    /// A folder within it.
    pub(crate) fn inner(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Lists a file that has grown.
    pub(crate) fn grown(&mut self, name: &str) -> Result<(), Failure> {
        let path = self.folder.join(name);
        let length = fs::metadata(&path).map_err(|cause| cannot(&path, &cause))?.len();
        self.written.push((name.to_owned(), length));
        Ok(())
    }
}

/// A file that is there from the first write on, so that what can't begin leaves the file that was there.
pub(crate) struct Growing {
    path: PathBuf,
    file: Option<File>,
}

impl Growing {
    /// Writes a piece.
    pub(crate) fn add(&mut self, text: &str) -> Result<(), Failure> {
        self.write_all(text.as_bytes()).map_err(|cause| cannot(&self.path, &cause))
    }
}

impl Write for Growing {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let file = match &mut self.file {
            Some(file) => file,
            None => self.file.insert(File::create(&self.path)?),
        };
        file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), File::flush)
    }
}

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

    pub(crate) fn show(&mut self, share: f64) {
        /// What takes less needs no patience.
        const PATIENCE: Duration = Duration::from_millis(300);
        if self.start.is_some_and(|start| start.elapsed() > PATIENCE) {
            self.is_shown = true;
            // Nobody reads it where it can't be written.
            let _ = write!(io::stderr(), "\r{:>3.0} %", 100.0 * share);
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
