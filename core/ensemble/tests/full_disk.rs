//! A full disk is an error, and whatever had been written is there.

use std::io::ErrorKind;

use liestep_ensemble::{Local, Store, StoreError};

use crate::common::{Folder, contents, tops};

const MEMBERS: u64 = 400;
const STEPS: u64 = 50;

/// One file's bytes go to the device that is always full.
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
    let is_full = matches!(&error, StoreError::Io { error, .. } if error.kind() == ErrorKind::StorageFull);
    assert!(is_full && error.to_string().contains(name), "{error}");
    // Those before it, whole; of itself nothing is left in the way.
    let removed = (0..2000).filter(|count| std::fs::remove_file(part(*count)).is_ok()).count();
    assert_eq!(removed, 1999);
    assert_eq!(contents(&folder.0).len(), 7);
    assert!(store.shards(ensemble.fingerprint()).unwrap().all(|shard| shard.is_ok()));
    let report = ensemble.run(&Local::threads(2), &store).unwrap();
    assert_eq!((report.made, report.missing), (13, 0));
    assert!(contents(&folder.0) == contents(&expected.0));
}
