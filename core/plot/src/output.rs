//! The folder for results, and the printed report.

use std::fmt;
use std::fs;
use std::fs::File;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process;

/// A folder that exists and can be written to, and the list of files written there.
pub struct Output {
    folder: PathBuf,
    /// The names and lengths of the files.
    written: Vec<(String, u64)>,
}

/// A folder or a file that couldn't be created.
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
    /// Creates the folder and tries to write there, so that a long run doesn't fail at its end.
    pub fn new(folder: PathBuf) -> Result<Self, CannotWrite> {
        // Other processes may try the same folder, so that the file's name has the process' number.
        let probe = folder.join(format!(".writable-{}", process::id()));
        fs::create_dir_all(&folder)
            .and_then(|()| fs::write(&probe, ""))
            .and_then(|()| fs::remove_file(&probe))
            .map_err(|cause| CannotWrite { path: folder.clone(), cause })?;
        Ok(Self { folder, written: Vec::new() })
    }

    /// Writes one file, whole or not at all.
    pub fn write(&mut self, name: &str, content: &(impl AsRef<[u8]> + ?Sized)) -> Result<(), CannotWrite> {
        let content = content.as_ref();
        let (path, beside) = (self.folder.join(name), self.folder.join(format!(".{name}-{}", process::id())));
        let written = fs::write(&beside, content).and_then(|()| fs::rename(&beside, &path));
        written.map_err(|cause| {
            // The temporary file may not exist.
            let _ = fs::remove_file(&beside);
            CannotWrite { path, cause }
        })?;
        self.written.push((name.to_owned(), content.len() as u64));
        Ok(())
    }

    /// A file that is written in pieces, created with the first, and called `NAME.part` until it is complete, so that a
    /// killed run's file is known by its name.
    #[must_use]
    pub fn grows(&self, name: &str) -> GrowingFile {
        let part = self.folder.join(format!("{name}.part"));
        GrowingFile { path: self.folder.join(name), part, file: None, is_cut: false }
    }

    /// The path of an inner folder.
    #[must_use]
    pub fn inner(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Adds a file that has grown to the list.
    pub fn grown(&mut self, name: &str) -> Result<(), CannotWrite> {
        let path = self.folder.join(name);
        let length = fs::metadata(&path).map_err(|cause| CannotWrite { path, cause })?.len();
        self.written.push((name.to_owned(), length));
        Ok(())
    }
}

/// A file that is created by the first write, so that a run that can't begin leaves the previous file.
///
/// The file gets its final name when dropped, unless a piece couldn't be written.
pub struct GrowingFile {
    path: PathBuf,
    part: PathBuf,
    file: Option<File>,
    is_cut: bool,
}

impl Drop for GrowingFile {
    fn drop(&mut self) {
        if self.file.take().is_some() && !self.is_cut {
            // Listing the file finds the error.
            let _ = fs::rename(&self.part, &self.path);
        }
    }
}

impl GrowingFile {
    /// Writes a piece.
    pub fn add(&mut self, text: &str) -> Result<(), CannotWrite> {
        self.write_all(text.as_bytes()).map_err(|cause| CannotWrite { path: self.path.clone(), cause })
    }
}

impl Write for GrowingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let file = match &mut self.file {
            Some(file) => file,
            None => self.file.insert(File::create(&self.part)?),
        };
        file.write(bytes).inspect_err(|_| self.is_cut = true)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), File::flush)
    }
}

/// Prints a report to the standard output. A closed pipe is an error and not a panic.
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
