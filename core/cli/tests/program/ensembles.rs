//! The table `ensemble`: members that are drawn, stored and resumed.

use std::fs;
use std::path::{Path, PathBuf};

use liestep_ensemble::{Shard, Status, Store};

use crate::called::{TOP, called, folder, printed, refuses, rows};

/// The top with an ensemble.
fn drawn(ensemble: &str) -> String {
    format!("{TOP}\n[ensemble]\nmembers = 40\nseed = 7\n{ensemble}")
}

pub(crate) fn shards(folder: &Path) -> Vec<Shard> {
    let files = Store::folder(folder).unwrap().files().unwrap();
    files.iter().map(|(_, path)| Store::read(path).unwrap()).collect()
}

fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let files = Store::folder(folder).unwrap().files().unwrap();
    let within = |path: PathBuf| (path.strip_prefix(folder).unwrap().to_owned(), fs::read(path).unwrap());
    files.into_iter().map(|(_, path)| within(path)).collect()
}

/// A distribution without spread makes each member the file with that value, up to roundings of advected vectors.
#[test]
fn a_member_is_the_file_with_its_values() {
    let folder = folder("a_member_is_the_file_with_its_values");
    let own = TOP.replace("\"60 rpm\"", "\"72 rpm\"").replace("g = 9.81", "g = 5");
    let expected = rows(&folder, &own).pop().unwrap();
    let text = drawn(
        "every = 100\ndraw.start.velocity = [0, 0, { mean = \"72 rpm\", deviation = \"0 rpm\" }]\n\
         draw.gravity.g = { mean = 5, deviation = 0 }\n",
    );
    fs::write(folder.join("top.toml"), text).unwrap();
    let told = printed(&folder, &["ensemble", "top.toml", "--out", "."]);
    assert!(told.contains("40 finished, 0 broke down, 0 can't exist"), "{told}");
    let shards = shards(&folder.join("top.ensemble"));
    assert_eq!(shards.iter().map(|shard| shard.outcome.finished).sum::<u64>(), 40);
    for shard in &shards {
        // Rows at the start, after a hundred steps, and at the end.
        assert_eq!(shard.rows.step[..3], [0, 100, 200]);
        for (row, _) in shard.rows.status.iter().enumerate().filter(|(_, status)| **status == Status::Finished) {
            let (time, columns) = expected.split_first().unwrap();
            let kept: Vec<f64> = shard.rows.columns.iter().map(|column| column[row]).collect();
            let [own @ .., spin, g, own_time] = kept.as_slice() else { panic!("{kept:?}") };
            // Drawn values are stored in the unit of the file.
            assert_eq!((*spin, *g), (72.0, 5.0));
            assert!((own_time - time).abs() < 1e-12);
            let distance = |sign: f64| own.iter().zip(columns).map(move |(a, b)| (a - sign * b).abs());
            // The sign of the quaternion, in the last columns, is arbitrary.
            let quaternion = columns.len() - 4;
            assert!(distance(1.0).take(quaternion).all(|distance| distance < 1e-12));
            assert!([1.0, -1.0].iter().any(|sign| distance(*sign).skip(quaternion).all(|d| d < 1e-12)));
        }
    }
}

/// Drawn numbers lie in their interval and differ between members. The files don't depend on the shares.
#[test]
fn shares_and_a_second_run_make_the_same_files() {
    let folder = folder("shares_and_a_second_run_make_the_same_files");
    let text = drawn("chunk = 8\ndraw.start.velocity = [0, 0, { from = \"60 rpm\", to = \"90 rpm\" }]\n");
    fs::write(folder.join("top.toml"), text.replace("[drag]\nc = 1e-3\n", "")).unwrap();
    let whole = printed(&folder, &["ensemble", "top.toml", "--out", "whole"]);
    assert!(whole.contains("40 finished") && whole.contains("velocity_z"), "{whole}");
    let first = printed(&folder, &["ensemble", "top.toml", "--share", "1/2", "--threads", "1", "--out", "parts"]);
    let part = files(&folder.join("parts/top.ensemble")).len();
    // The last share reports all members.
    let last = printed(&folder, &["ensemble", "top.toml", "--share", "0/2", "--out", "parts"]);
    assert!(first.contains("in this share: 16 finished") && !first.contains("velocity_z"), "{first}");
    assert!(last.contains("seed 7: 40 finished") && last.contains("velocity_z"), "{last}");
    let [one, other] = ["whole", "parts"].map(|out| files(&folder.join(out).join("top.ensemble")));
    assert!(one == other && one.len() > part && part > 0, "{} {part}", one.len());
    let again = printed(&folder, &["ensemble", "top.toml", "--out", "whole"]);
    assert!(again.contains(", 0 of them now"), "{again}");
    assert_eq!(printed(&folder, &["report", "top.toml", "--out", "whole"]), again);
    refuses(&folder, &["report", "top.toml", "--out", "nowhere"], 4, "`liestep ensemble` makes it");
    // A report detects damaged rows only where it verifies them.
    let damaged = folder.join("whole/top.ensemble").join(&one[1].0);
    let rows = &one[1].1;
    fs::write(&damaged, [&rows[..rows.len() / 2], &[77], &rows[rows.len() / 2 + 1..]].concat()).unwrap();
    assert_eq!(printed(&folder, &["report", "top.toml", "--out", "whole"]), again);
    let verified = printed(&folder, &["report", "top.toml", "--verify", "--out", "whole"]);
    assert!(verified.contains("4 chunks, 0 of them now\n1 chunks are left to `liestep ensemble`"), "{verified}");
    let made = printed(&folder, &["ensemble", "top.toml", "--verify", "--out", "whole"]);
    assert!(made.contains("5 chunks, 1 of them now") && fs::read(damaged).unwrap() == *rows, "{made}");

    let spin: Vec<f64> = shards(&folder.join("whole/top.ensemble"))
        .into_iter()
        .flat_map(|shard| {
            let place = shard.names.iter().position(|name| name == "velocity_z").unwrap();
            shard.rows.columns[place].clone()
        })
        .collect();
    // The axial spin of a symmetric top is constant.
    let rpm = std::f64::consts::PI / 30.0;
    assert!(spin.iter().all(|spin| (59.9 * rpm..90.1 * rpm).contains(spin)) && spin.len() == 40);
    assert!(spin.windows(2).all(|pair| (pair[0] - pair[1]).abs() > 1e-9));
}

/// A file with more members goes on in the folder, whatever else of it no member knows of, and has the files of a folder with
/// all of them at once. Fewer members are the first ones.
#[test]
fn more_members_extend_a_folder() {
    let folder = folder("more_members_extend_a_folder");
    let text = drawn("chunk = 8\ndraw.start.velocity = [0, 0, { from = \"60 rpm\", to = \"90 rpm\" }]\n");
    let of = |members: u32, out: &str| {
        let text = text.replace("members = 40", &format!("# So many.\nmembers = {members}"));
        fs::write(folder.join("top.toml"), text.replacen("title = \"", &format!("title = \"{members}: "), 1)).unwrap();
        printed(&folder, &["ensemble", "top.toml", "--out", out])
    };
    of(40, "whole");
    assert!(of(20, "grown").contains("20 members") && of(20, "grown").contains("3 chunks, 0 of them now"));
    let told = of(40, "grown");
    assert!(
        told.starts_with("40: ") && told.contains("40 finished") && told.contains("5 chunks, 3 of them now"),
        "{told}"
    );
    let [whole, grown] = ["whole", "grown"].map(|out| files(&folder.join(out).join("top.ensemble")));
    assert!(whole == grown && whole.len() == 5);
    let few = |out| of(20, out).lines().skip(1).filter(|line| !line.contains("Written")).collect::<Vec<_>>().join("\n");
    assert_eq!(few("grown"), few("few"));
    assert_eq!(files(&folder.join("grown/top.ensemble")), whole);
    // Another step, seed or draw is another plan.
    for [from, to] in [["seed = 7", "seed = 8"], ["\"10 ms\"", "\"5 ms\""], ["90 rpm", "91 rpm"]] {
        assert!(text.contains(from), "{text}");
        fs::write(folder.join("top.toml"), text.replace(from, to)).unwrap();
        refuses(&folder, &["ensemble", "top.toml", "--out", "grown"], 4, "is of another plan");
    }
}

/// Ctrl-C ends a run at its next steps, with a message of what is kept; the command in it goes on.
#[cfg(unix)]
#[test]
fn control_c_says_what_is_kept() {
    use std::process::{Command, Stdio};
    let folder = folder("control_c_says_what_is_kept");
    let text = drawn("chunk = 8\ndraw.start.velocity = [0, 0, { from = \"60 rpm\", to = \"90 rpm\" }]\n");
    fs::write(folder.join("a top.toml"), text.replace("members = 40", "members = 1000000")).unwrap();
    let mut run = Command::new(crate::called::PROGRAM);
    let run = run.current_dir(&folder).args(["ensemble", "a top.toml", "--threads", "2"]).stderr(Stdio::piped());
    let run = run.stdout(Stdio::null()).spawn().unwrap();
    let inside = folder.join("out/a top.ensemble");
    while !inside.is_dir() || files(&inside).len() < 3 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &run.id().to_string()]).status().unwrap().success());
    let output = run.wait_with_output().unwrap();
    let (told, there) = (String::from_utf8(output.stderr).unwrap(), files(&inside).len());
    assert_eq!(output.status.code(), Some(130), "{told}");
    let kept = format!(
        "stopped by Ctrl-C: {there} of 125000 chunks, with {} members, are kept in out/a top.ensemble",
        8 * there
    );
    assert!(
        told.contains(&kept) && told.trim_end().ends_with(" ensemble 'a top.toml' --threads 2` goes on there"),
        "{told}"
    );
    // The shell reads the command; with fewer members there is an end of it.
    let members = 8 * (there + 2);
    fs::write(folder.join("a top.toml"), text.replace("members = 40", &format!("members = {members}"))).unwrap();
    let command = told.split('`').nth(1).unwrap();
    let again = Command::new("sh").args(["-c", command]).current_dir(&folder).output().unwrap();
    let again = String::from_utf8(again.stdout).unwrap();
    assert!(again.contains(&format!("{} chunks, 2 of them now", there + 2)), "{again}");
}

/// The example file has no chunk size; its default has work for all cores and for both of two shares.
#[test]
fn what_is_shipped_has_many_chunks() {
    let folder = folder("what_is_shipped_has_many_chunks");
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes/detumbling.toml");
    let text = fs::read_to_string(shipped).unwrap().replace("falling", "either");
    // A twentieth of the time, with quaternions, which have no means.
    let text = text.replace("\"40 min\"", "\"2 min\"") + "\n[output]\ncolumns = [\"quaternion\", \"velocity\"]\n";
    fs::write(folder.join("detumbling.toml"), text).unwrap();
    let part = printed(&folder, &["ensemble", "detumbling.toml", "--share", "1/2", "--out", "."]);
    let made = files(&folder.join("detumbling.ensemble")).len();
    assert!(made > 8 && part.contains(&format!("{made} chunks, {made} of them now")), "{made}: {part}");
    let whole = printed(&folder, &["ensemble", "detumbling.toml", "--out", "."]);
    let all = files(&folder.join("detumbling.ensemble")).len();
    assert!(whole.contains(&format!("{all} chunks, {} of them now", all - made)) && all >= 2 * made, "{whole}");
    assert!(whole.contains("velocity_z") && !whole.contains("q_w") && whole.contains("slow: 21 times in"));
    assert!(shards(&folder.join("detumbling.ensemble")).iter().all(|shard| shard.names.contains(&"q_w".to_owned())));
}

/// A member with a negative mass is counted as impossible, not as failed. A member whose run stops is a failure.
#[test]
fn members_fail_by_themselves() {
    let folder = folder("members_fail_by_themselves");
    let text = drawn("draw.gravity.m = { mean = \"1 kg\", deviation = \"1 kg\" }\n");
    fs::write(folder.join("top.toml"), text).unwrap();
    let output = called(&folder, &["ensemble", "top.toml", "--out", "."]);
    let notes = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{notes}");
    let (finished, failed) = shards(&folder.join("top.ensemble")).iter().fold((0, 0), |(finished, failed), shard| {
        (finished + shard.outcome.finished, failed + shard.outcome.failures.len())
    });
    assert!(finished > 20 && failed > 0 && finished + failed as u64 == 40, "{finished} {failed}");
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(told.contains(&format!("{finished} finished, 0 broke down, {failed} can't exist")), "{told}");
    let note = format!("note: {failed} can't exist; the first of them is member ");
    assert!(notes.starts_with(&note) && notes.contains("must be above zero") && notes.lines().count() == 1, "{notes}");
    let fast = drawn("draw.start.velocity = [0, { from = \"0 rpm\", to = \"6000 rpm\" }, 0]\n");
    fs::write(folder.join("fast.toml"), fast).unwrap();
    let output = called(&folder, &["ensemble", "fast.toml", "--out", "."]);
    assert!(output.status.code() == Some(3) && output.stderr.ends_with(b" members broke down\n"));
}

/// A top is released at a tilt between 10° and 90°, and falls: the probability that it passes 60°, and the first time.
/// The interval is Wilson's in its textbook form, `(p − k/n)² = z² p (1 − p)/n`, solved by bisection.
#[test]
fn an_event_has_a_probability() {
    let folder = folder("an_event_has_a_probability");
    let text = drawn("draw.start.euler = [0, { from = \"10 deg\", to = \"90 deg\" }, 0]\n").replace("60 rpm", "0 rpm")
        + "[[event]]\nname = \"fallen\"\ntilt = \"60 deg\"\ndirection = \"rising\"\n";
    let text = text.replace("members = 40", "members = 40\nchunk = 7").replace("duration = 2", "duration = 1");
    fs::write(folder.join("top.toml"), text).unwrap();
    let told = printed(&folder, &["ensemble", "top.toml", "--out", "."]);
    let (mut some, mut all, mut sum) = (0_u32, 0_u32, 0.0);
    for shard in shards(&folder.join("top.ensemble")) {
        let crossings = &shard.rows.crossings[0];
        assert_eq!(crossings.names[..2], ["fallen_t", "fallen_velocity_x"]);
        let tilt = shard.names.iter().position(|name| name == "start.euler.2").unwrap();
        for row in 0..shard.rows.member.len() {
            let first = crossings.row.iter().position(|other| *other == row);
            let start = shard.rows.columns[tilt][row];
            assert!(first.is_none() || start < 60.0, "{start}");
            all += 1;
            if let Some(first) = first {
                some += 1;
                sum += crossings.columns[0][first];
            }
        }
    }
    let (n, k) = (f64::from(all), f64::from(some));
    let end = |sign: f64| {
        let (mut inner, mut outer) = (k / n, if sign < 0.0 { 0.0 } else { 1.0 });
        for _ in 0..100 {
            let p = 0.5 * (inner + outer);
            let is_outside = (p - k / n).powi(2) > 1.959_964_f64.powi(2) * p * (1.0 - p) / n;
            if is_outside { outer = p } else { inner = p }
        }
        inner
    };
    assert!(some > 5 && some < all);
    let line = format!(
        "fallen: in {some} of {all} members; probability {:.4}, with 95 % from {:.4} to {:.4}; first at {:.7} s in the mean",
        k / n,
        end(-1.0),
        end(1.0),
        sum / k
    );
    assert!(told.contains(&line), "{line}: {told}");
}
