//! A run that is killed ten times without warning ends with the files of an undisturbed one. So do two runs at once.
//!
//! This program is the run to be killed if it is called with a folder, otherwise the test.

mod common;

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use common::{Folder, contents, tops};
use liestep_ensemble::{Local, Store};

const MEMBERS: u64 = 1_200;
const STEPS: u64 = 100;

fn run(folder: &Path) -> u64 {
    let report = tops(MEMBERS, STEPS).run(&Local::threads(2), &Store::folder(folder).unwrap()).unwrap();
    assert_eq!((report.missing, report.faults.len()), (0, 0));
    report.made
}

fn start(folder: &Path) -> Child {
    Command::new(std::env::current_exe().unwrap()).arg(folder).stdout(Stdio::null()).spawn().unwrap()
}

fn whole(folder: &Path) -> usize {
    Store::folder(folder).unwrap().files().unwrap().len()
}

fn main() {
    if let Some(folder) = std::env::args().nth(1).filter(|argument| Path::new(argument).is_absolute()) {
        run(Path::new(&folder));
        return;
    }
    let (undisturbed, killed) = (Folder::new("undisturbed"), Folder::new("killed"));
    run(&undisturbed.0);
    let mut kills = 0;
    let mut moments = 0_u64;
    while kills < 10 {
        let before = whole(&killed.0);
        let mut child = start(&killed.0);
        // The kill comes after one to five more files, and some part of the time for the next one.
        moments = moments.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        while whole(&killed.0) <= before + (moments >> 61) as usize % 5 && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_micros(200));
        }
        std::thread::sleep(Duration::from_micros((moments >> 40) % 3_000));
        assert!(child.try_wait().unwrap().is_none(), "it had come to its end before it was killed");
        child.kill().unwrap();
        assert!(!child.wait().unwrap().success());
        kills += 1;
        // A file under its final name is whole.
        for (_, path) in Store::folder(&killed.0).unwrap().files().unwrap() {
            Store::read(&path).unwrap();
        }
    }
    let made = run(&killed.0);
    assert!((1..60).contains(&made), "{made} of 60 were left");
    assert!(contents(&killed.0) == contents(&undisturbed.0));
    let shared = Folder::new("shared");
    for mut run in [start(&shared.0), start(&shared.0)] {
        assert!(run.wait().unwrap().success(), "one of two runs took away what the other was writing");
    }
    assert!(contents(&shared.0) == contents(&undisturbed.0));
    println!("killed {kills} times; {made} of 60 chunks were left to the last run; all files are the same");
}
