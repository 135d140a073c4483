//! A folder of shards, each written whole or not at all.

use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{ErrorKind, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use thiserror::Error;

use crate::name::{Name, PER_FOLDER, SUM, is_part, part_of};
use crate::outcome::Outcome;
use crate::shard::{Shard, head_of, read_head};
use liestep::numbers::Digest;

/// A folder that shards are written to and read from, a thousand to a subfolder:
/// `00000/00000012-64-0123456789abcdef0123456789abcdef.arrow` is named by the number of the chunk, the number of its
/// members, a digest of the file's head, and one of the whole file.
///
/// A file is written under a temporary name, flushed to the disk, and then renamed; the folder is flushed, too. So
/// after any interruption a shard is there whole or not at all, and the next run computes what is missing. Several
/// processes may write to one folder, on a shared file system too. Files of other names are neither read nor removed. A
/// full subfolder has the sum of its outcomes beside it, `00000.toml`, so that a report needn't open its files.
///
/// An ensemble of more members goes on in the folder: its files are then those of one that had all members at once, as
/// only the last chunk, which had some of its members, is computed anew. One of fewer members reads the first ones.
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
        "{path} is of another plan (another start, step, seed or column, or a changed program or library); take another folder, or delete that file"
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

/// The plan with whose chunks a folder is compared.
pub(crate) trait Plan {
    /// The fingerprint.
    fn print(&self) -> u64;
    /// The number of members of a chunk; zero for a number beyond the last.
    fn members(&self, chunk: u64) -> u64;
    /// The sample of a chunk's first member.
    fn sample(&self, chunk: u64) -> u64;
    /// The outcome of a chunk's members, who move for it.
    fn outcome(&self, chunk: u64) -> Outcome;
    /// The outcome of no members.
    fn nothing(&self) -> Outcome;
}

/// The files of one chunk that have the most members.
pub(crate) fn longest(files: &[(Name, PathBuf)]) -> &[(Name, PathBuf)] {
    let most = files.last().map(|(name, _)| name.members);
    &files[files.partition_point(|(name, _)| Some(name.members) < most)..]
}

/// The summed outcome of a full subfolder.
#[derive(Serialize, Deserialize)]
struct Sum {
    plan: u64,
    /// A digest of the names of the files, which contain digests of their contents.
    names: u64,
    outcome: Outcome,
}

impl Sum {
    /// The sum of a file, whose first line is a comment with the digest of the others.
    fn read(path: &Path) -> Option<Self> {
        let text = fs::read_to_string(path).ok()?;
        let (digest, text) = text.strip_prefix("# ")?.split_once('\n')?;
        let is_same = u64::from_str_radix(digest, 16) == Ok(Digest::of(text.as_bytes()));
        if is_same { toml::from_str(text).ok() } else { None }
    }

    /// Writes the sum; without it the next survey sums again.
    fn write(&self, folder: &Path, path: &Path) {
        let text = toml::to_string(self).unwrap_or_default();
        let part = folder.join(part_of(SUM));
        let _ = fs::write(&part, format!("# {:016x}\n{text}", Digest::of(text.as_bytes())))
            .and_then(|()| fs::rename(&part, path))
            .or_else(|_| fs::remove_file(&part));
    }
}

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
    /// reads no rows: it trusts the names, which only whole files get, and the heads, each of which has a digest.
    #[must_use]
    pub fn verified(mut self) -> Self {
        self.verifies = true;
        self
    }

    /// The files of shards by the numbers of their chunks, in the order of the numbers. Their contents aren't checked.
    ///
    /// # Errors
    ///
    /// [`StoreError::Io`] if a folder can't be read, and [`StoreError::Foreign`] if there are files of an older format.
    pub fn files(&self) -> Result<Vec<(u64, PathBuf)>, StoreError> {
        Ok(self.named()?.into_iter().map(|(name, path)| (name.chunk, path)).collect())
    }

    /// The files of shards in the order of their chunks and of the numbers of their members.
    pub(crate) fn named(&self) -> Result<Vec<(Name, PathBuf)>, StoreError> {
        let mut files = Vec::new();
        for folder in entries(&self.folder)?.into_iter().filter(|path| path.is_dir()) {
            let within = entries(&folder)?;
            if let Some(path) = within.iter().find(|path| Name::is_older(path)) {
                return Err(StoreError::Foreign { path: path.clone() });
            }
            files.extend(
                within.into_iter().filter(|path| !path.is_dir()).filter_map(|path| Some((Name::of(&path)?, path))),
            );
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
        Self::shard_of(path, &bytes, true)
    }

    /// The shard of a file's bytes, or of those of its head.
    fn shard_of(path: &Path, bytes: &[u8], is_whole: bool) -> Result<Shard, Fault> {
        let unreadable = |reason: &str| Fault::Unreadable(path.to_owned(), reason.to_owned());
        let name = Name::of(path).ok_or_else(|| unreadable("its name, or that of its folder, isn't a shard's"))?;
        let [of_head, of_file] = name.digests;
        let digest = if is_whole { of_file } else { of_head };
        if Digest::of_file(bytes) != digest {
            let has_its_end = !is_whole || bytes.ends_with(END);
            return Err(if has_its_end { Fault::Altered(path.to_owned()) } else { Fault::Truncated(path.to_owned()) });
        }
        let shard = if is_whole { Shard::of_bytes(bytes) } else { Shard::of_head(bytes) };
        let shard = shard.map_err(|reason| unreadable(&reason))?.ok_or_else(|| Fault::Foreign(path.to_owned()))?;
        let is_named = (shard.chunk, shard.members) == (name.chunk, name.members);
        if is_named { Ok(shard) } else { Err(Fault::Altered(path.to_owned())) }
    }

    /// Writes a shard: whole, or not at all.
    ///
    /// # Errors
    ///
    /// [`StoreError`] if that fails. Other shards stay as they were.
    pub fn write(&self, shard: &Shard) -> Result<(), StoreError> {
        let bytes = shard.to_bytes().map_err(|error| StoreError::Unwritable { reason: error.to_string() })?;
        let digests = [head_of(&bytes), &bytes].map(Digest::of_file);
        let name = Name { chunk: shard.chunk, members: shard.members, digests };
        let (folder, name) = (self.folder.join(name.folder()), name.file());
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

    /// Whether a file of this chunk with so many members exists, by its name.
    pub(crate) fn has(&self, chunk: u64, members: u64) -> bool {
        let folder = Name { chunk, members, digests: [0; 2] }.folder();
        let is_it = |path: &PathBuf| Name::of(path).is_some_and(|own| own.chunk == chunk && own.members >= members);
        entries(&self.folder.join(folder)).is_ok_and(|paths| paths.iter().any(is_it))
    }

    /// The chunks whose members exist, by the names of their files, and the faults of other files. All files of a chunk with
    /// two of the same members are read. The heads of the share's first, middle and last own chunks are read, to
    /// check the plan, or all of its files if [verified](Self::verified).
    pub(crate) fn look(
        &self,
        plan: &dyn Plan,
        is_own: &dyn Fn(u64) -> bool,
    ) -> Result<(BTreeSet<u64>, Vec<Fault>), StoreError> {
        let (mut found, mut faults) = (BTreeSet::new(), Vec::new());
        let files = self.named()?;
        let own: Vec<u64> = files.iter().map(|(name, _)| name.chunk).filter(|chunk| is_own(*chunk)).collect();
        let looked_at = [own.first(), own.get(own.len() / 2), own.last()].map(Option::<&u64>::copied);
        for files in files.chunk_by(|(first, _), (second, _)| first.chunk == second.chunk) {
            let files = longest(files);
            for (Name { chunk, members, .. }, path) in files {
                let is_whole = files.len() > 1 || self.verifies && is_own(*chunk);
                let is_looked_at = looked_at.contains(&Some(*chunk));
                let shard = if is_whole || is_looked_at { Self::shard(path, plan, is_whole)? } else { None };
                match shard {
                    Some(Ok(_)) if found.contains(chunk) => return Err(StoreError::Twice { path: path.clone() }),
                    Some(Ok(shard))
                        if is_looked_at && plan.members(*chunk) > 0 && plan.sample(*chunk) != shard.sample =>
                    {
                        return Err(StoreError::Foreign { path: path.clone() });
                    }
                    Some(Err(fault)) => {
                        faults.push(fault);
                        continue;
                    }
                    // Another process has renamed the file.
                    None if is_whole || is_looked_at => continue,
                    _ => {}
                }
                if *members >= plan.members(*chunk) {
                    found.insert(*chunk);
                }
            }
        }
        Ok((found, faults))
    }

    /// Adds the outcomes of the plan's chunks that exist and that `is_own` selects, in the order of their numbers; returns
    /// the number of all of its chunks that exist, and the faults of other files. No rows are read. A full subfolder is
    /// read by the sum beside it alone, which its first reader writes. Files of fewer members than one beside them are
    /// removed.
    pub(crate) fn survey(
        &self,
        plan: &dyn Plan,
        is_own: &dyn Fn(u64) -> bool,
        all: &mut Outcome,
    ) -> Result<(u64, Vec<Fault>), StoreError> {
        let (mut count, mut faults) = (0, Vec::new());
        let mut files = self.named()?;
        files.retain(|(name, _)| plan.members(name.chunk) > 0);
        for files in files.chunk_by(|(first, _), (second, _)| first.folder() == second.folder()) {
            let mut names = Digest::default();
            files.iter().filter_map(|(_, path)| path.file_name()).for_each(|name| names.text(&name.to_string_lossy()));
            let sum = self.folder.join(files[0].0.folder() + SUM);
            let is_whole = files.len() as u64 == PER_FOLDER
                && files.iter().all(|(name, _)| is_own(name.chunk) && name.members == plan.members(name.chunk));
            let is_same = |sum: &Sum| is_whole && (sum.plan, sum.names) == (plan.print(), names.value());
            if let Some(sum) = Sum::read(&sum).filter(is_same) {
                count += PER_FOLDER;
                all.merge(&sum.outcome);
                continue;
            }
            let mut made = Sum { plan: plan.print(), names: names.value(), outcome: plan.nothing() };
            let (found, damaged) = Self::summed(files, plan, is_own, &mut made.outcome)?;
            count += found;
            all.merge(&made.outcome);
            if is_whole && (found, damaged.len()) == (PER_FOLDER, 0) {
                made.write(&self.folder, &sum);
            }
            faults.extend(damaged);
        }
        Ok((count, faults))
    }

    /// Adds the outcomes of these files, as [`survey`](Self::survey).
    fn summed(
        files: &[(Name, PathBuf)],
        plan: &dyn Plan,
        is_own: &dyn Fn(u64) -> bool,
        all: &mut Outcome,
    ) -> Result<(u64, Vec<Fault>), StoreError> {
        let (mut count, mut faults) = (0, Vec::new());
        for files in files.chunk_by(|(first, _), (second, _)| first.chunk == second.chunk) {
            let (longest, mut is_there) = (longest(files), false);
            for (Name { chunk, members, .. }, path) in longest {
                match if is_own(*chunk) { Self::shard(path, plan, false)? } else { None } {
                    Some(Err(fault)) => {
                        faults.push(fault);
                        continue;
                    }
                    Some(Ok(_)) if is_there => return Err(StoreError::Twice { path: path.clone() }),
                    // The reductions of some of a file's members aren't in it.
                    Some(Ok(_)) if *members > plan.members(*chunk) => all.merge(&plan.outcome(*chunk)),
                    Some(Ok(shard)) => all.merge(&shard.outcome),
                    None => {}
                }
                count += u64::from(!is_there && *members >= plan.members(*chunk));
                is_there = true;
            }
            // Files of a plan of fewer members have given way to a whole one.
            for (_, path) in &files[..files.len() - longest.len()] {
                if is_there {
                    let _ = fs::remove_file(path);
                }
            }
        }
        Ok((count, faults))
    }

    /// The shard of a file, whole or its head; `None` if another process has just renamed the file.
    pub(crate) fn shard(
        path: &Path,
        plan: &dyn Plan,
        is_whole: bool,
    ) -> Result<Option<Result<Shard, Fault>>, StoreError> {
        let opened = File::open(path).and_then(|mut file| {
            let mut bytes = Vec::new();
            if is_whole {
                file.read_to_end(&mut bytes)?
            } else {
                read_head(&mut file, &mut bytes)?
            };
            Ok(Self::shard_of(path, &bytes, is_whole))
        });
        match opened {
            Ok(Ok(shard)) if shard.plan != plan.print() => Err(StoreError::Foreign { path: path.to_owned() }),
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

/// The most attempts to write a file that another process removes.
const MOST_TRIES: u32 = 8;

fn entries(folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
    let io = |error| StoreError::Io { path: folder.to_owned(), error };
    fs::read_dir(folder).map_err(io)?.map(|entry| entry.map(|entry| entry.path()).map_err(io)).collect()
}

/// Flushes a folder and the new names in it to the disk. Only Unix can open folders.
fn bring_to_disk(folder: &Path) -> std::io::Result<()> {
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}
