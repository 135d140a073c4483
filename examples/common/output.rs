//! The folder that results are written to.

use std::fmt;
use std::fs;
use std::io::{self, Write as _};
use std::path::PathBuf;

/// A folder that exists and takes files, and what was written there.
pub struct Output {
    folder: PathBuf,
    written: Vec<(String, usize)>,
}

/// A folder or a file that couldn't be made.
#[derive(Debug)]
pub struct CannotWrite {
    path: PathBuf,
    cause: io::Error,
}

impl fmt::Display for CannotWrite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot write to {}: {}; choose another folder with --out", self.path.display(), self.cause)
    }
}

impl std::error::Error for CannotWrite {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.cause)
    }
}

impl Output {
    /// Makes the folder and tries it, so that a long run doesn't end with nowhere to go.
    pub fn new(folder: PathBuf) -> Result<Self, CannotWrite> {
        let probe = folder.join(".writable");
        fs::create_dir_all(&folder)
            .and_then(|()| fs::write(&probe, ""))
            .and_then(|()| fs::remove_file(&probe))
            .map_err(|cause| CannotWrite { path: folder.clone(), cause })?;
        Ok(Self { folder, written: Vec::new() })
    }

    /// Writes one file.
    pub fn write(&mut self, name: &str, content: &str) -> Result<(), CannotWrite> {
        let path = self.folder.join(name);
        fs::write(&path, content).map_err(|cause| CannotWrite { path, cause })?;
        self.written.push((name.to_owned(), content.len()));
        Ok(())
    }
}

/// Prints the report. A reader that has gone away is an error and not a panic.
pub fn print(report: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(report.as_bytes())?;
    out.flush()
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
