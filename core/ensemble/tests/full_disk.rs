//! Finished shards survive a full disk, which is an error, and other processes that write to the folder.

use std::io::ErrorKind;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::Duration;

use liestep_ensemble::{Local, Store, StoreError};

use crate::common::{Folder, contents, tops};

const MEMBERS: u64 = 400;
const STEPS: u64 = 50;

/// The bytes of one file go to the device that is always full.
#[test]
fn a_full_disk_is_an_error_that_loses_no_finished_shard() {
    let (ensemble, expected, folder) = (tops(MEMBERS, STEPS), Folder::new("roomy"), Folder::new("devfull"));
    ensemble.run(&Local::threads(1), &Store::folder(&expected.0).unwrap()).unwrap();
    let store = Store::folder(&folder.0).unwrap();
    let files = Store::folder(&expected.0).unwrap().files().unwrap();
    let name = files[7].1.file_name().unwrap().to_str().unwrap();
    std::fs::create_dir(folder.0.join("00000")).unwrap();
    // A temporary name contains the host, the process, and one of the next numbers.
    let host = std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap();
    let host = host.trim().replace(|letter: char| !letter.is_ascii_alphanumeric(), "-");
    let part = |count| folder.0.join("00000").join(format!("{name}.{host}-{}-{count}.part", std::process::id()));
    (0..20_000).for_each(|count| std::os::unix::fs::symlink("/dev/full", part(count)).unwrap());
    let error = ensemble.run(&Local::threads(1), &store).unwrap_err();
    let is_full = matches!(&error, StoreError::Io { error, .. } if error.kind() == ErrorKind::StorageFull);
    assert!(is_full && error.to_string().contains(name), "{error}");
    // The shards before are whole, and no part of the last is left.
    let removed = (0..20_000).filter(|count| std::fs::remove_file(part(*count)).is_ok()).count();
    assert_eq!(removed, 19_999);
    assert_eq!(contents(&folder.0).len(), 7);
    assert!(ensemble.shards(&store).unwrap().all(|shard| shard.is_ok()));
    let report = ensemble.run(&Local::threads(2), &store).unwrap();
    assert_eq!((report.made, report.missing), (13, 0));
    assert!(contents(&folder.0) == contents(&expected.0));
}

/// Two processes share a folder: the first to end leaves the other's temporary file, and removes older ones.
#[test]
fn what_another_is_writing_stays() {
    let (ensemble, folder) = (tops(MEMBERS, STEPS), Folder::new("beside"));
    let part = |number: u32| {
        std::fs::create_dir_all(folder.0.join("00000")).unwrap();
        let path =
            folder.0.join(format!("00000/00000001-20-cbf29ce484222325cbf29ce484222325.arrow.host-{number}-0.part"));
        std::fs::write(&path, "half").unwrap();
        path
    };
    let before = part(1);
    std::thread::sleep(Duration::from_millis(50));
    let store = Store::folder(&folder.0).unwrap();
    let report = ensemble.run_telling(&Local::threads(1), &store, &|_| drop(part(2))).unwrap();
    assert_eq!(report.missing, 0);
    assert!(
        !before.exists()
            && folder.0.join("00000/00000001-20-cbf29ce484222325cbf29ce484222325.arrow.host-2-0.part").exists()
    );
}

/// A temporary file that another process removes is written again.
#[test]
fn what_another_has_taken_is_written_again() {
    let (ensemble, folder, taken) = (tops(MEMBERS, 1), Folder::new("taken"), AtomicU32::new(0));
    let take = |path: &Path| {
        let is_part = path.extension().is_some_and(|ending| ending == "part");
        if is_part && taken.load(Ordering::Relaxed) < 5 && std::fs::remove_file(path).is_ok() {
            taken.fetch_add(1, Ordering::Relaxed);
        }
    };
    let is_done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !is_done.load(Ordering::Relaxed) {
                let entries = std::fs::read_dir(folder.0.join("00000")).into_iter().flatten();
                entries.flatten().for_each(|entry| take(&entry.path()));
            }
        });
        for _ in 0..200 {
            let _ = std::fs::remove_dir_all(&folder.0);
            let report = Store::folder(&folder.0).and_then(|store| ensemble.run(&Local::threads(1), &store));
            is_done.store(report.is_err() || taken.load(Ordering::Relaxed) == 5, Ordering::Relaxed);
            assert_eq!(report.unwrap().missing, 0);
            if is_done.load(Ordering::Relaxed) {
                break;
            }
        }
        is_done.store(true, Ordering::Relaxed);
    });
    assert!(taken.into_inner() > 0);
}
