//! The folder that results are written to, and what is printed.

use std::fmt;
use std::fs;
use std::fs::File;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process;

/// A folder that exists and takes files, and what was written there.
pub struct Output {
    folder: PathBuf,
    /// Names and lengths.
    written: Vec<(String, u64)>,
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
        // Others may try it at the same time.
        let probe = folder.join(format!(".writable-{}", process::id()));
        fs::create_dir_all(&folder)
            .and_then(|()| fs::write(&probe, ""))
            .and_then(|()| fs::remove_file(&probe))
            .map_err(|cause| CannotWrite { path: folder.clone(), cause })?;
        Ok(Self { folder, written: Vec::new() })
    }

    /// Writes one file, as a whole or not at all.
    pub fn write(&mut self, name: &str, content: &str) -> Result<(), CannotWrite> {
        let (path, beside) = (self.folder.join(name), self.folder.join(format!(".{name}-{}", process::id())));
        let written = fs::write(&beside, content).and_then(|()| fs::rename(&beside, &path));
        written.map_err(|cause| {
            // It may not be there.
            let _ = fs::remove_file(&beside);
            CannotWrite { path, cause }
        })?;
        self.written.push((name.to_owned(), content.len() as u64));
        Ok(())
    }

    /// A file for what is written bit by bit, which is made with the first. It is called `NAME.part` until that ends, so
    /// that what was killed on its way can be told from what is whole.
    #[must_use]
    pub fn grows(&self, name: &str) -> GrowingFile {
        let part = self.folder.join(format!("{name}.part"));
        GrowingFile { path: self.folder.join(name), part, file: None, is_cut: false }
    }

    /// A folder within it.
    #[must_use]
    pub fn inner(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Lists a file that has grown.
    pub fn grown(&mut self, name: &str) -> Result<(), CannotWrite> {
        let path = self.folder.join(name);
        let length = fs::metadata(&path).map_err(|cause| CannotWrite { path, cause })?.len();
        self.written.push((name.to_owned(), length));
        Ok(())
    }
}

/// A file that is there from the first write on, so that what can't begin leaves the file that was there.
///
/// It gets its name when this is gone, with its last piece; not if a piece couldn't be written.
pub struct GrowingFile {
    path: PathBuf,
    part: PathBuf,
    file: Option<File>,
    is_cut: bool,
}

impl Drop for GrowingFile {
    fn drop(&mut self) {
        if self.file.take().is_some() && !self.is_cut {
            // Who lists the file finds out.
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
