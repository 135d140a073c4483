//! A full disk is an error, and whatever had been written is there.

use std::io::ErrorKind;
use std::path::Path;
use std::process::Command;

use liestep_ensemble::{Local, Store, StoreError};

use crate::common::{Folder, contents, tops};

const MEMBERS: u64 = 400;
const STEPS: u64 = 50;

fn is_full(error: &StoreError) -> bool {
    matches!(error, StoreError::Io { error, .. } if error.kind() == ErrorKind::StorageFull)
}

/// One file's bytes go to the device that is always full.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_that_loses_no_finished_shard() {
    let (ensemble, expected, folder) = (tops(MEMBERS, STEPS), Folder::new("roomy"), Folder::new("devfull"));
    ensemble.run(&Local::threads(1), &Store::folder(&expected.0).unwrap()).unwrap();
    let store = Store::folder(&folder.0).unwrap();
    let files = Store::folder(&expected.0).unwrap().files().unwrap();
    let name = files[7].1.file_name().unwrap().to_str().unwrap();
    std::fs::create_dir(folder.0.join("00000")).unwrap();
    // Of the machine, the process, and one of the numbers that are next.
    let host = std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap();
    let host = host.trim().replace(|letter: char| !letter.is_ascii_alphanumeric(), "-");
    let part = |count| folder.0.join("00000").join(format!("{name}.{host}-{}-{count}.part", std::process::id()));
    (0..2000).for_each(|count| std::os::unix::fs::symlink("/dev/full", part(count)).unwrap());
    let error = ensemble.run(&Local::threads(1), &store).unwrap_err();
    assert!(is_full(&error) && error.to_string().contains(name), "{error}");
    // Those before it, whole; of itself nothing is left in the way.
    let removed = (0..2000).filter(|count| std::fs::remove_file(part(*count)).is_ok()).count();
    assert_eq!(removed, 1999);
    assert_eq!(contents(&folder.0).len(), 7);
    assert!(store.shards(ensemble.fingerprint()).unwrap().all(|shard| shard.is_ok()));
    let report = ensemble.run(&Local::threads(2), &store).unwrap();
    assert_eq!((report.made, report.missing), (13, 0));
    assert!(contents(&folder.0) == contents(&expected.0));
}

/// A small file system, as long as this lives.
struct Mounted<'a>(&'a Path);

impl<'a> Mounted<'a> {
    fn new(path: &'a Path, options: &str) -> Result<Self, String> {
        let run = Command::new("mount").args(["-t", "tmpfs", "-o", options, "tmpfs"]).arg(path).output();
        let run = run.map_err(|error| error.to_string())?;
        let said = String::from_utf8_lossy(&run.stderr).trim().to_owned();
        run.status.success().then_some(Self(path)).ok_or(said)
    }
}

impl Drop for Mounted<'_> {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0).status();
    }
}

/// Where one may be mounted; the test above is for everywhere else.
#[test]
fn a_small_disk_fills_up_and_the_run_goes_on_on_a_larger_one() {
    let (ensemble, expected, folder) = (tops(MEMBERS, STEPS), Folder::new("large"), Folder::new("small"));
    std::fs::create_dir(&folder.0).unwrap();
    let mounted = match Mounted::new(&folder.0, "size=48k") {
        Ok(mounted) => mounted,
        Err(reason) => {
            println!("skipped: no file system of 48 kB can be mounted here: {reason}");
            return;
        }
    };
    ensemble.run(&Local::threads(1), &Store::folder(&expected.0).unwrap()).unwrap();
    let store = Store::folder(&folder.0).unwrap();
    let error = ensemble.run(&Local::threads(2), &store).unwrap_err();
    assert!(is_full(&error), "{error}");
    let written = contents(&folder.0);
    let expected = contents(&expected.0);
    assert!((1..expected.len()).contains(&written.len()), "{} of {}", written.len(), expected.len());
    assert!(written.iter().all(|(name, bytes)| expected.get(name) == Some(bytes)), "what is there is whole");
    let larger = Command::new("mount").args(["-o", "remount,size=4m"]).arg(&folder.0).status().unwrap();
    assert!(larger.success());
    let report = ensemble.run(&Local::threads(2), &store).unwrap();
    assert_eq!((report.made, report.missing), ((expected.len() - written.len()) as u64, 0));
    assert!(contents(&folder.0) == expected);
    drop(mounted);
}
