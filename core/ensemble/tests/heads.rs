//! A report believes no head and no sum that has changed.

use std::fs;
use std::sync::atomic::AtomicBool;

use liestep_ensemble::{Fault, Local, Store};

use super::common::{Folder, contents, tops};
use super::run;

/// The place behind the schema in an Arrow file: the magic bytes, the mark of a message, and its length.
fn end_of_head(file: &[u8]) -> usize {
    let length: [u8; 4] = file[68..72].try_into().unwrap();
    72 + u32::from_le_bytes(length) as usize
}

/// A report, which reads no rows, names a file of which one bit of the head has changed, whichever, and counts the other
/// chunks.
#[test]
fn a_changed_head_is_one_fault() {
    let (ensemble, folder) = (tops(60, 2), Folder::new("heads"));
    run(&ensemble, &Local::threads(2), &folder);
    let (store, stop) = (Store::folder(&folder.0).unwrap(), AtomicBool::new(true));
    let report = || ensemble.run(&Local::threads(1).stopped_by(&stop), &store).unwrap();
    let whole = report();
    assert_eq!((whole.missing, whole.outcome.finished + whole.outcome.failed()), (0, 60));
    let (_, path) = store.files().unwrap().remove(1);
    let bytes = fs::read(&path).unwrap();
    let aside = path.with_file_name(format!("{}.damaged", path.file_name().unwrap().to_str().unwrap()));
    let head = end_of_head(&bytes);
    assert!((1000..4000).contains(&head), "{head}");
    for place in 0..head {
        let mut changed = bytes.clone();
        changed[place] ^= 1 << (place * 5 % 8);
        fs::write(&path, &changed).unwrap();
        let told = report();
        assert_eq!(told.faults, [Fault::Altered(path.clone())], "byte {place}");
        assert_eq!((told.missing, told.outcome.finished + told.outcome.failed()), (1, 40), "byte {place}");
        fs::rename(&aside, &path).unwrap();
    }
    // A head that ends early, and one under another number of members.
    for length in [0, 3, 70, head - 1] {
        fs::write(&path, &bytes[..length]).unwrap();
        assert_eq!(report().faults, [Fault::Altered(path.clone())], "{length} bytes");
        fs::rename(&aside, &path).unwrap();
    }
    fs::write(&path, &bytes).unwrap();
    let name = path.file_name().unwrap().to_str().unwrap().replace("-20-", "-21-");
    let renamed = path.with_file_name(&name);
    fs::rename(&path, &renamed).unwrap();
    assert_eq!(report().faults, [Fault::Altered(renamed.clone())]);
    fs::rename(path.with_file_name(name + ".damaged"), &path).unwrap();
    assert_eq!(report(), whole);
}

/// A sum of a thousand heads that has changed is made anew.
#[test]
fn a_changed_sum_is_not_believed() {
    let (ensemble, folder) = (tops(1000, 2).chunks_of(1), Folder::new("changed-sums"));
    let expected = run(&ensemble, &Local::threads(2), &folder).outcome;
    let (files, sum) = (contents(&folder.0), folder.0.join("00000.toml"));
    let text = fs::read(&sum).unwrap();
    for place in (0..text.len()).step_by(text.len() / 8) {
        let mut changed = text.clone();
        changed[place] ^= 1;
        fs::write(&sum, changed).unwrap();
        assert_eq!(run(&ensemble, &Local::threads(1), &folder).outcome, expected, "byte {place}");
        assert!(contents(&folder.0) == files, "byte {place}");
    }
}
