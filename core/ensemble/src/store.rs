//! A folder of shards, each written whole or not at all.

use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{ErrorKind, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::SystemTime;
use thiserror::Error;

use crate::outcome::Outcome;
use crate::shard::Shard;
use liestep::numbers::Digest;

/// A folder that shards are written to and read from, `00000/00000012-0123456789abcdef.arrow`: a thousand to a
/// subfolder, named by the number of the chunk and by a digest of the whole file.
///
/// A file is written under a temporary name, flushed to the disk, and then renamed; the folder is flushed, too. So
/// after any interruption a shard is there whole or not at all, and the next run computes what is missing. Several
/// processes may write to one folder, on a shared file system too. Files of other names are neither read nor removed. A
/// full subfolder has the sum of its outcomes beside it, `00000.toml`, so that a report needn't open its files.
///
/// Every file is Arrow IPC and can be read without this library: `polars.read_ipc("out/*/*.arrow")`. Its columns are
/// `member`, `step`, `status` (a [`Status`](crate::Status)), the [recorded](crate::Ensemble::keep) ones, and lists of
/// values at [sections](crate::Ensemble::section), which polars and pandas `explode` into rows.
#[derive(Clone, Debug)]
pub struct Store {
    folder: PathBuf,
    verifies: bool,
}

/// The fault of a file, with its path.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Fault {
    /// The end of the file is missing.
    #[error("{0} is truncated")]
    Truncated(PathBuf),
    /// The file has changed since it was written.
    #[error("{0} has been altered: its digest is another")]
    Altered(PathBuf),
    /// The file is whole, but of another plan, or of another version of this format.
    #[error("{0} is of another plan")]
    Foreign(PathBuf),
    /// The file can't be read as a shard.
    #[error("{0} isn't a shard: {1}")]
    Unreadable(PathBuf, String),
    /// The file system can't read the file.
    #[error("{0} can't be read: {1}")]
    Io(PathBuf, String),
}

/// An error in reading or writing shards.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StoreError {
    /// The file system refuses: a full disk, a folder without permission to write, …
    #[error("{path}: {error}")]
    Io {
        /// The path.
        path: PathBuf,
        /// The reason.
        error: std::io::Error,
    },
    /// The folder has shards of another plan, or of another version of this format, which are left alone.
    #[error(
        "{path} is of another plan (other members, steps, columns, or a changed program or library); take another folder, or delete that file"
    )]
    Foreign {
        /// One of the foreign shards.
        path: PathBuf,
    },
    /// A chunk has two whole files, which differ: its members aren't reproducible.
    #[error(
        "{path} is a second file of its chunk with other contents: members have to be the same each time and on every machine; delete one of the two"
    )]
    Twice {
        /// The second file.
        path: PathBuf,
    },
    /// A shard can't be put into its format.
    #[error("a shard can't be written: {reason}")]
    Unwritable {
        /// The reason.
        reason: String,
    },
}

/// The last bytes of Arrow IPC files.
const END: &[u8] = b"ARROW1";
const PER_FOLDER: u64 = 1000;

/// The summed outcome of a full subfolder.
#[derive(Serialize, Deserialize)]
struct Sum {
    plan: u64,
    /// A digest of the names of the files, which contain digests of their contents.
    names: u64,
    outcome: Outcome,
}

/// The suffix of the sum's name, after the name of the subfolder beside it.
const SUM: &str = ".toml";

impl Store {
    /// Opens a folder, which is created if there is none.
    ///
    /// # Errors
    ///
    /// [`StoreError::Io`] if it can't be created.
    pub fn folder(path: impl Into<PathBuf>) -> Result<Self, StoreError> {
        let folder = path.into();
        fs::create_dir_all(&folder).map_err(|error| StoreError::Io { path: folder.clone(), error })?;
        Ok(Self { folder, verifies: false })
    }

    /// Lets a run read the chunks of its share that are there first, and recompute damaged ones. Without it a run
    /// trusts the names, which only whole files get, and reads no rows.
    #[must_use]
    pub fn verified(mut self) -> Self {
        self.verifies = true;
        self
    }

    /// The files of shards by the numbers of their chunks, in the order of the numbers. Their contents aren't checked.
    ///
    /// # Errors
    ///
    /// [`StoreError::Io`] if a folder can't be read.
    pub fn files(&self) -> Result<Vec<(u64, PathBuf)>, StoreError> {
        let mut files = Vec::new();
        for folder in entries(&self.folder)?.into_iter().filter(|path| path.is_dir()) {
            let named = entries(&folder)?.into_iter().filter_map(|path| Some((name_of(&path)?.0, path)));
            files.extend(named.filter(|(_, path)| !path.is_dir()));
        }
        files.sort();
        Ok(files)
    }

    /// Reads a file.
    ///
    /// # Errors
    ///
    /// A [`Fault`] if it is truncated, altered or no shard, or if the file system fails.
    pub fn read(path: &Path) -> Result<Shard, Fault> {
        let bytes = fs::read(path).map_err(|error| Fault::Io(path.to_owned(), error.to_string()))?;
        Self::shard_of(path, &bytes)
    }

    fn shard_of(path: &Path, bytes: &[u8]) -> Result<Shard, Fault> {
        let unreadable = |reason: &str| Fault::Unreadable(path.to_owned(), reason.to_owned());
        let (chunk, digest) =
            name_of(path).ok_or_else(|| unreadable("its name, or that of its folder, isn't a shard's"))?;
        if Digest::of_file(bytes) != digest {
            // Files of format 1 have this digest.
            if Digest::of(bytes) == digest {
                return Err(Fault::Foreign(path.to_owned()));
            }
            let is_whole = bytes.ends_with(END);
            return Err(if is_whole { Fault::Altered(path.to_owned()) } else { Fault::Truncated(path.to_owned()) });
        }
        let shard = Shard::of_bytes(bytes).map_err(|reason| unreadable(&reason))?;
        let shard = shard.ok_or_else(|| Fault::Foreign(path.to_owned()))?;
        if shard.chunk == chunk { Ok(shard) } else { Err(Fault::Altered(path.to_owned())) }
    }

    /// The shards of a plan, one after another in the order of their chunks, and the faults of other files.
    ///
    /// # Errors
    ///
    /// [`StoreError::Io`] if a folder can't be read.
    pub fn shards(&self, plan: u64) -> Result<impl Iterator<Item = Result<Shard, Fault>>, StoreError> {
        let read = move |(_, path): (u64, PathBuf)| {
            let shard = Self::read(&path)?;
            if shard.plan == plan { Ok(shard) } else { Err(Fault::Foreign(path)) }
        };
        Ok(self.files()?.into_iter().map(read))
    }

    /// Writes a shard: whole, or not at all.
    ///
    /// # Errors
    ///
    /// [`StoreError`] if that fails. Other shards stay as they were.
    pub fn write(&self, shard: &Shard) -> Result<(), StoreError> {
        let bytes = shard.to_bytes().map_err(|error| StoreError::Unwritable { reason: error.to_string() })?;
        let folder = self.folder.join(folder_of(shard.chunk));
        let name = file_of(shard.chunk, Digest::of_file(&bytes));
        let io = |path: &Path| {
            let path = path.to_owned();
            move |error| StoreError::Io { path, error }
        };
        if !folder.is_dir() {
            fs::create_dir_all(&folder).map_err(io(&folder))?;
            bring_to_disk(&self.folder).map_err(io(&self.folder))?;
        }
        let mut tries = 0;
        loop {
            let beside = folder.join(part_of(&name));
            let write = || -> std::io::Result<()> {
                let mut file = File::create(&beside)?;
                file.write_all(&bytes)?;
                file.sync_all()?;
                fs::rename(&beside, folder.join(&name))
            };
            tries += 1;
            match write() {
                Ok(()) => break,
                // A process whose clock is ahead has swept the file as one of a killed run.
                Err(error) if error.kind() == ErrorKind::NotFound && tries < MOST_TRIES => {}
                Err(error) => {
                    // A partial file would go on filling a full disk.
                    let _ = fs::remove_file(&beside);
                    return Err(StoreError::Io { path: beside, error });
                }
            }
        }
        bring_to_disk(&folder).map_err(io(&folder))
    }

    /// Removes partial files of killed runs that are older than this time; another process may still be writing newer
    /// ones.
    pub(crate) fn sweep(&self, before: SystemTime) -> Result<(), StoreError> {
        let is_older = |path: &Path| path.metadata().and_then(|file| file.modified()).is_ok_and(|time| time < before);
        let folders = entries(&self.folder)?.into_iter().filter(|path| path.is_dir());
        for folder in folders.chain([self.folder.clone()]) {
            for path in entries(&folder)? {
                if is_part(&path) && is_older(&path) {
                    let _ = fs::remove_file(path);
                }
            }
        }
        Ok(())
    }

    /// Whether a file of this chunk exists, by its name.
    pub(crate) fn has(&self, chunk: u64) -> bool {
        let folder = entries(&self.folder.join(folder_of(chunk)));
        folder.is_ok_and(|paths| paths.iter().any(|path| name_of(path).is_some_and(|(own, _)| own == chunk)))
    }

    /// The chunks that exist, by the names of their files, and the faults of other files. All files of a chunk with two
    /// are read. The share's own chunks have one file's head read, to check the plan, or all files if
    /// [verified](Self::verified).
    pub(crate) fn look(
        &self,
        plan: u64,
        is_own: &dyn Fn(u64) -> bool,
    ) -> Result<(BTreeSet<u64>, Vec<Fault>), StoreError> {
        let (mut found, mut faults, mut has_read) = (BTreeSet::new(), Vec::new(), false);
        for files in self.files()?.chunk_by(|(first, _), (second, _)| first == second) {
            for (chunk, path) in files {
                let is_whole = files.len() > 1 || self.verifies && is_own(*chunk);
                if !is_whole && (has_read || !is_own(*chunk)) {
                    found.insert(*chunk);
                    continue;
                }
                has_read = true;
                match Self::shard(path, plan, is_whole)? {
                    Some(Ok(_)) if found.contains(chunk) => return Err(StoreError::Twice { path: path.clone() }),
                    Some(Ok(_)) => drop(found.insert(*chunk)),
                    Some(Err(fault)) => faults.push(fault),
                    None => {}
                }
            }
        }
        Ok((found, faults))
    }

    /// Adds the outcomes of the chunks that exist and that `is_own` selects, in the order of their numbers; returns the
    /// number of all chunks that exist, and the faults of other files. No rows are read. A full subfolder is read by
    /// the sum beside it alone, which its first reader writes.
    pub(crate) fn survey(
        &self,
        plan: u64,
        is_own: &dyn Fn(u64) -> bool,
        nothing: &Outcome,
        all: &mut Outcome,
    ) -> Result<(u64, Vec<Fault>), StoreError> {
        let (mut count, mut faults) = (0, Vec::new());
        for files in self.files()?.chunk_by(|(first, _), (second, _)| first / PER_FOLDER == second / PER_FOLDER) {
            let mut names = Digest::default();
            files.iter().filter_map(|(_, path)| path.file_name()).for_each(|name| names.text(&name.to_string_lossy()));
            let sum = self.folder.join(folder_of(files[0].0) + SUM);
            let is_whole = files.len() as u64 == PER_FOLDER && files.iter().all(|(chunk, _)| is_own(*chunk));
            let is_same = |sum: &Sum| is_whole && (sum.plan, sum.names) == (plan, names.value());
            if let Some(sum) = fs::read_to_string(&sum).ok().and_then(|text| toml::from_str(&text).ok()).filter(is_same)
            {
                count += PER_FOLDER;
                all.merge(&sum.outcome);
                continue;
            }
            let mut made = Sum { plan, names: names.value(), outcome: nothing.clone() };
            let (before, mut last) = ((count, faults.len()), None);
            for (chunk, path) in files {
                let shard = if is_own(*chunk) { Self::shard(path, plan, false)? } else { None };
                match shard {
                    Some(Err(fault)) => {
                        faults.push(fault);
                        continue;
                    }
                    Some(Ok(_)) if last == Some(*chunk) => return Err(StoreError::Twice { path: path.clone() }),
                    Some(Ok(shard)) => made.outcome.merge(&shard.outcome),
                    None => {}
                }
                count += u64::from(last.replace(*chunk) != Some(*chunk));
            }
            all.merge(&made.outcome);
            if is_whole && (count, faults.len()) == (before.0 + PER_FOLDER, before.1) {
                // Without a written sum the next survey sums again.
                let (part, text) = (self.folder.join(part_of(SUM)), toml::to_string(&made).unwrap_or_default());
                let _ =
                    fs::write(&part, text).and_then(|()| fs::rename(&part, &sum)).or_else(|_| fs::remove_file(&part));
            }
        }
        Ok((count, faults))
    }

    /// The shard of a file, whole or its head; `None` if another process has just renamed the file.
    fn shard(path: &Path, plan: u64, is_whole: bool) -> Result<Option<Result<Shard, Fault>>, StoreError> {
        let opened = File::open(path).and_then(|mut file| {
            if !is_whole {
                let shard = Shard::head(file).map_err(|reason| Fault::Unreadable(path.to_owned(), reason));
                return Ok(shard.and_then(|shard| shard.ok_or_else(|| Fault::Foreign(path.to_owned()))));
            }
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes)?;
            Ok(Self::shard_of(path, &bytes))
        });
        match opened {
            Ok(Ok(shard)) if shard.plan != plan => Err(StoreError::Foreign { path: path.to_owned() }),
            Ok(Err(Fault::Foreign(path))) => Err(StoreError::Foreign { path }),
            Ok(shard) => Ok(Some(shard)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(StoreError::Io { path: path.to_owned(), error }),
        }
    }

    /// Renames the damaged files to `….arrow.damaged`, so that their chunks are recomputed.
    pub(crate) fn set_aside(faults: &[Fault]) -> Result<(), StoreError> {
        for fault in faults {
            let (Fault::Truncated(path) | Fault::Altered(path) | Fault::Unreadable(path, _)) = fault else { continue };
            let mut aside = path.clone().into_os_string();
            aside.push(".damaged");
            match fs::rename(path, aside) {
                // Another process has renamed the file before.
                Err(error) if error.kind() == ErrorKind::NotFound => {}
                renamed => renamed.map_err(|error| StoreError::Io { path: path.clone(), error })?,
            }
        }
        Ok(())
    }
}

fn folder_of(chunk: u64) -> String {
    format!("{:05}", chunk / PER_FOLDER)
}

fn file_of(chunk: u64, digest: u64) -> String {
    format!("{chunk:08}-{digest:016x}.arrow")
}

/// The number and the digest in a shard's name, if it is exactly a name by [`Store::write`].
fn name_of(path: &Path) -> Option<(u64, u64)> {
    let name = path.file_name()?.to_str()?;
    let (chunk, digest) = name.strip_suffix(".arrow")?.split_once('-')?;
    let (chunk, digest) = (chunk.parse().ok()?, u64::from_str_radix(digest, 16).ok()?);
    let folder = path.parent()?.file_name()?.to_str()?;
    (name == file_of(chunk, digest) && folder == folder_of(chunk)).then_some((chunk, digest))
}

/// The most attempts to write a file that another process removes.
const MOST_TRIES: u32 = 8;

/// The name of a file while it is written. The machine, the process and a number make it unique among machines and
/// threads.
fn part_of(name: &str) -> String {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    static HOST: OnceLock<String> = OnceLock::new();
    let host = HOST.get_or_init(|| {
        let name = fs::read_to_string("/proc/sys/kernel/hostname").or_else(|_| std::env::var("COMPUTERNAME"));
        let name = name.unwrap_or_default().trim().replace(|letter: char| !letter.is_ascii_alphanumeric(), "-");
        if name.is_empty() { "host".to_owned() } else { name }
    });
    format!("{name}.{host}-{}-{}.part", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed))
}

/// Whether a file is a shard or a sum under its temporary name.
fn is_part(path: &Path) -> bool {
    let shard = || path.to_str()?.strip_suffix(".part")?.rsplit_once('.');
    shard().map(|(shard, _)| Path::new(shard)).is_some_and(|own| own.ends_with(SUM) || name_of(own).is_some())
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
    let io = |error| StoreError::Io { path: folder.to_owned(), error };
    fs::read_dir(folder).map_err(io)?.map(|entry| entry.map(|entry| entry.path()).map_err(io)).collect()
}

/// Flushes a folder and the new names in it to the disk. Only Unix can open folders.
fn bring_to_disk(folder: &Path) -> std::io::Result<()> {
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}
