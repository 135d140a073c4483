//! An ensemble of more members goes on in the folder of one of fewer, and one of fewer reads the first ones of a folder.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use liestep_ensemble::{Ensemble, Local, Report, Shard, Store, StoreError};
use nalgebra::Vector3;

use super::common::{Folder, Top, contents, top, tops, with_columns};
use super::{STEPS, run, shards};

/// The plan for a number of members.
type Plan<'a> = &'a dyn Fn(u64) -> Ensemble<Top>;

/// The files and the report of a folder in which ensembles of these numbers of members run, one after another.
fn after(name: &str, plan: Plan<'_>, members: &[u64]) -> (BTreeMap<PathBuf, Vec<u8>>, Report) {
    let folder = Folder::new(name);
    let mut reports: Vec<Report> = members.iter().map(|many| run(&plan(*many), &Local::threads(2), &folder)).collect();
    (contents(&folder.0), reports.pop().unwrap())
}

/// The files of a folder that has grown are those of a folder with all members at once. Chunks of the smaller plans stay, but
/// for a last one that had some of its members.
#[test]
fn more_members_go_on_in_a_folder() {
    let in_twenties = |members| tops(members, STEPS);
    let growing =
        |members| Ensemble::new("tops", members, 1 << 14, top).keep(["e"], |run| [run.stepper.energy(run.state)]);
    let one_each = |members| tops(members, 2).chunks_of(1);
    for (plan, members, made) in [
        (&in_twenties as Plan<'_>, &[60, 130][..], 4),
        (&in_twenties, &[55, 130], 5),
        (&in_twenties, &[7, 8, 9, 61], 4),
        (&in_twenties, &[130, 131], 1),
        (&growing, &[12, 50], 6),
        // A full subfolder has a sum.
        (&one_each, &[999, 1000, 1001, 1003], 2),
    ] {
        let (whole, expected) = after("at-once", plan, &members[members.len() - 1..]);
        let (files, report) = after("grown", plan, members);
        assert!(files == whole, "{members:?}: {:?}, {:?}", files.keys(), whole.keys());
        assert_eq!((report.made, &report.outcome), (made, &expected.outcome), "{members:?}");
    }
}

/// Shares of more members leave a chunk's old file until its new one is there, and a report counts the members of old files.
#[test]
fn shares_go_on_in_a_folder() {
    let folder = Folder::new("grown-shares");
    let fewer = run(&tops(55, STEPS), &Local::threads(1), &folder);
    let more = tops(130, STEPS);
    let stop = AtomicBool::new(true);
    let told = run(&more, &Local::threads(1).stopped_by(&stop), &folder);
    assert_eq!((told.made, told.missing, &told.outcome), (0, 5, &fewer.outcome));
    // Chunk 2, of which there are fifteen members, is the third share's.
    for (share, missing, files) in [(0, 3, 5), (1, 2, 6), (2, 0, 7)] {
        let told = run(&more, &Local::threads(2).share(share, 3), &folder);
        assert_eq!((told.missing, contents(&folder.0).len()), (missing, files));
    }
    assert!(contents(&folder.0) == after("whole-shares", &|members| tops(members, STEPS), &[130]).0);
}

/// Fewer members have the outcome and the rows that they have in a folder of their own. The folder stays as it is.
#[test]
fn fewer_members_read_the_first_ones() {
    let folder = Folder::new("of-all");
    run(&tops(130, STEPS), &Local::threads(2), &folder);
    let all = contents(&folder.0);
    for members in [1, 20, 40, 55, 129] {
        let (plan, own) = (tops(members, STEPS), Folder::new("of-few"));
        let (expected, found) = (run(&plan, &Local::threads(2), &own), run(&plan, &Local::threads(2), &folder));
        assert_eq!((found.chunks, found.made, found.missing), (expected.chunks, 0, 0), "{members}");
        assert_eq!(found.outcome, expected.outcome, "{members}");
        let texts = |folder| shards(&plan, folder).iter().map(|shard: &Shard| format!("{shard:?}")).collect::<Vec<_>>();
        assert_eq!(texts(&folder), texts(&own), "{members}");
        assert!(contents(&folder.0) == all);
    }
}

/// A member that changes is found in the first, the middle or the last chunk; a folder of an older format is foreign.
#[test]
fn a_changed_member_is_another_plan() {
    let folder = Folder::new("changed");
    run(&tops(130, STEPS), &Local::threads(2), &folder);
    let changed = |number: u64| {
        with_columns(Ensemble::new("tops", 130, STEPS, move |member| {
            let (stepper, state) = top(member)?;
            let other = stepper.start(state.attitude(), Vector3::x())?;
            Ok((stepper, if member.number() == number { other } else { state }))
        }))
    };
    let store = Store::folder(&folder.0).unwrap();
    for number in [0, 60, 120] {
        let refused = changed(number).run(&Local::threads(1), &store);
        assert!(matches!(refused, Err(StoreError::Foreign { .. })), "{number}: {refused:?}");
    }
    let older = folder.0.join("00000/00000003-cbf29ce484222325.arrow");
    std::fs::write(&older, "ARROW1").unwrap();
    let refused = tops(130, STEPS).run(&Local::threads(1), &store);
    assert!(matches!(&refused, Err(StoreError::Foreign { path }) if *path == older), "{refused:?}");
}
