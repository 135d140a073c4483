//! The names of shards' files.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// The number of chunks in a subfolder.
pub(crate) const PER_FOLDER: u64 = 1000;

/// The suffix of the name of a subfolder's sum, which is beside the subfolder.
pub(crate) const SUM: &str = ".toml";

/// The parts of a shard's name, `00000/00000012-64-0123456789abcdef0123456789abcdef.arrow`. They are ordered by the number of
/// the chunk, and then by the number of its members.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Name {
    pub(crate) chunk: u64,
    pub(crate) members: u64,
    /// The digests of the head and of the whole file.
    pub(crate) digests: [u64; 2],
}

impl Name {
    /// The parts of a path's name, if it is exactly a name of a shard in its subfolder.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?;
        let (chunk, rest) = name.strip_suffix(".arrow")?.split_once('-')?;
        let (members, digests) = rest.split_once('-')?;
        let (head, file) = digests.split_at_checked(16)?;
        let [head, file] = [head, file].map(|digest| u64::from_str_radix(digest, 16).ok());
        let own = Self { chunk: chunk.parse().ok()?, members: members.parse().ok()?, digests: [head?, file?] };
        (name == own.file() && own.is_in_its_folder(path)).then_some(own)
    }

    /// Whether a path is a shard's of a format before the fourth, which had no number of members in its name.
    pub(crate) fn is_older(path: &Path) -> bool {
        let older = || {
            let (chunk, digest) = path.file_name()?.to_str()?.strip_suffix(".arrow")?.split_once('-')?;
            let (chunk, digest) = (chunk.parse().ok()?, u64::from_str_radix(digest, 16).ok()?);
            let own = Self { chunk, members: 0, digests: [0; 2] };
            Some(path.file_name()?.to_str()? == format!("{chunk:08}-{digest:016x}.arrow") && own.is_in_its_folder(path))
        };
        older().unwrap_or(false)
    }

    fn is_in_its_folder(&self, path: &Path) -> bool {
        path.parent().and_then(Path::file_name).is_some_and(|folder| folder == self.folder().as_str())
    }

    /// The name of the subfolder.
    pub(crate) fn folder(&self) -> String {
        format!("{:05}", self.chunk / PER_FOLDER)
    }

    /// The name of the file.
    pub(crate) fn file(&self) -> String {
        let Self { chunk, members, digests: [head, file] } = self;
        format!("{chunk:08}-{members}-{head:016x}{file:016x}.arrow")
    }
}

/// The name of a file while it is written. The machine, the process and a number make it unique among machines and
/// threads.
pub(crate) fn part_of(name: &str) -> String {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    static HOST: OnceLock<String> = OnceLock::new();
    let host = HOST.get_or_init(|| {
        let name = std::fs::read_to_string("/proc/sys/kernel/hostname").or_else(|_| std::env::var("COMPUTERNAME"));
        let name = name.unwrap_or_default().trim().replace(|letter: char| !letter.is_ascii_alphanumeric(), "-");
        if name.is_empty() { "host".to_owned() } else { name }
    });
    format!("{name}.{host}-{}-{}.part", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed))
}

/// Whether a file is a shard or a sum under its temporary name.
pub(crate) fn is_part(path: &Path) -> bool {
    let own = || path.to_str()?.strip_suffix(".part")?.rsplit_once('.').map(|(own, _)| PathBuf::from(own));
    own().is_some_and(|own| own.ends_with(SUM) || Name::of(&own).is_some())
}
