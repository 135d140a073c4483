//! Units of other simulations: a small host calls their binaries, whose rows have the bits of the program's table.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::called::{TOP, called, folder, printed, refuses, table};

const HOSTS: [&str; 2] = [include_str!("hosts/fmi2.c"), include_str!("hosts/fmi3.c")];

/// Whether there is a compiler; if there isn't, a reason is printed.
fn has_compiler() -> bool {
    let found = Command::new("cc").arg("--version").output().is_ok();
    if !found {
        println!("skipped: there is no `cc`");
    }
    found
}

/// The files of an archive, which stores them as they are.
fn files(archive: &[u8]) -> BTreeMap<String, Vec<u8>> {
    let word = |at: usize| usize::from(u16::from_le_bytes([archive[at], archive[at + 1]]));
    let (mut at, mut files) = (0, BTreeMap::new());
    while archive[at..].starts_with(b"PK\x03\x04") {
        let (size, path) = (word(at + 18) + (word(at + 20) << 16), at + 30);
        let (bytes, none) = (path + word(at + 26), word(at + 28));
        assert_eq!(none, 0);
        let name = String::from_utf8(archive[path..bytes].to_vec()).unwrap();
        files.insert(name, archive[bytes..bytes + size].to_vec());
        at = bytes + size;
    }
    assert!(archive[at..].starts_with(b"PK\x01\x02") && archive[archive.len() - 22..].starts_with(b"PK\x05\x06"));
    files
}

/// A unit in a folder, with its host and its description.
struct Unit<'f> {
    folder: &'f Path,
    description: String,
}

impl Unit<'_> {
    fn of<'f>(folder: &'f Path, text: &str, fmi: usize) -> Unit<'f> {
        fs::write(folder.join("scene.toml"), text).unwrap();
        let options: &[&str] = if fmi == 2 { &["--fmi2"] } else { &[] };
        printed(folder, &[&["fmu", "scene.toml", "--out", "."], options].concat());
        let files = files(&fs::read(folder.join("scene.fmu")).unwrap());
        let binary = if fmi == 2 { "binaries/linux64/scene.so" } else { "binaries/x86_64-linux/scene.so" };
        fs::write(folder.join("scene.so"), &files[binary]).unwrap();
        // The source is the binary's.
        fs::write(folder.join("source.c"), &files["sources/scene.c"]).unwrap();
        let strict = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off", "-c", "source.c"];
        let compiled = Command::new("cc").args(strict).current_dir(folder).output().unwrap();
        assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
        fs::write(folder.join("host.c"), HOSTS[fmi - 2]).unwrap();
        let flags = ["-std=gnu99", "-Wall", "-Wextra", "-Werror", "-O1", "host.c", "-o", "host", "-ldl"];
        let compiled = Command::new("cc").args(flags).current_dir(folder).output().unwrap();
        assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
        Unit { folder, description: String::from_utf8(files["modelDescription.xml"].clone()).unwrap() }
    }

    fn attribute(&self, before: &str) -> &str {
        let (_, behind) = self.description.split_once(before).unwrap_or_else(|| panic!("{before}"));
        behind.split_once('"').unwrap().0
    }

    /// Momentum and energy at the start and after each step.
    fn rows(&self, step: f64, count: usize, mode: &str) -> Vec<Vec<f64>> {
        let token = if self.description.contains("fmiVersion=\"2.0\"") { "guid=\"" } else { "instantiationToken=\"" };
        let of = |name: &str| {
            let first = [format!("name=\"{name}\" valueReference=\""), format!("name=\"{name}[1]\" valueReference=\"")];
            let found = first.iter().find(|first| self.description.contains(*first));
            found.map_or("0", |first| self.attribute(first)).to_owned()
        };
        let mut host = Command::new(self.folder.join("host"));
        host.current_dir(self.folder).args([
            "./scene.so",
            self.attribute(token),
            &format!("{step:?}"),
            &count.to_string(),
        ]);
        let run = host.args([mode, &of("momentum"), &of("energy"), &of("torque.torque")]).output().unwrap();
        assert!(run.status.success(), "{mode}: {:?} {}", run.status, String::from_utf8_lossy(&run.stderr));
        let text = String::from_utf8(run.stdout).unwrap();
        if mode == "resumed" { table(&format!("names\n{text}")) } else { table(&text) }
    }
}

fn bits(rows: &[Vec<f64>]) -> Vec<u64> {
    rows.iter().flatten().map(|number| number.to_bits()).collect()
}

const COLUMNS: &str = "[output]\ncolumns = [\"momentum\", \"energy\"]\n";

/// Momentum and energy of the program's table.
fn of_program(folder: &Path, text: &str) -> Vec<Vec<f64>> {
    fs::write(folder.join("scene.toml"), text).unwrap();
    printed(folder, &["run", "scene.toml", "--csv", "--out", "."]);
    let rows = table(&fs::read_to_string(folder.join("scene.csv")).unwrap());
    rows.into_iter().map(|row| row[1..].to_vec()).collect()
}

#[test]
fn a_unit_has_the_bits_of_the_program() {
    if !has_compiler() {
        return;
    }
    let longer = TOP.replace("duration = 2", "duration = 10") + COLUMNS;
    let by_momentum = longer.replace("velocity = [0, 0, \"60 rpm\"]", "momentum = [1, 2, 30]");
    let composed = longer
        .replace("c = 1e-3", "c = 1e-3\n")
        .replace("[drag]\nc = 1e-3\n", "")
        .replace("[run]", "[run]\nmethod = { composition = \"Suzuki 4\" }");
    let own = include_str!("../../../../examples/scenes/own-lagrangian.toml").replace("duration = 20", "duration = 10")
        + COLUMNS;
    for (name, text) in [("top", &longer), ("momentum", &by_momentum), ("composed", &composed), ("own", &own)] {
        let folder = folder(&format!("unit-{name}"));
        let expected = of_program(&folder, text);
        assert_eq!(expected.len(), 1001, "{name}");
        for fmi in [3, 2] {
            let unit = Unit::of(&folder, text, fmi);
            assert_eq!(bits(&unit.rows(0.01, 1000, "plain")), bits(&expected), "{name} {fmi}");
        }
    }
}

/// A hundred times back to a state, a state in another process, two steps at once: the same motion. A length that is no whole
/// number of steps is refused, and no byte moves.
#[test]
fn a_unit_goes_back_and_on() {
    if !has_compiler() {
        return;
    }
    let folder = folder("unit-states");
    let text = TOP.replace("duration = 2", "duration = 10") + COLUMNS;
    let expected = of_program(&folder, &text);
    let unit = Unit::of(&folder, &text, 3);
    for mode in ["rolled-back", "stored", "refused"] {
        assert_eq!(bits(&unit.rows(0.01, 1000, mode)), bits(&expected), "{mode}");
    }
    assert_eq!(bits(&unit.rows(0.01, 1000, "resumed")), bits(&expected[501..]));
    let pairs: Vec<Vec<f64>> = expected.iter().step_by(2).cloned().collect();
    assert_eq!(bits(&unit.rows(0.01, 1000, "pairs")), bits(&pairs));
}

/// A torque about a principal axis gives the momentum its time integral.
#[test]
fn a_torque_is_an_input() {
    if !has_compiler() {
        return;
    }
    let folder = folder("unit-torque");
    let text = "title = \"turned\"\n[body]\nmoments = [1, 2, 2.5]\n[torque]\ntorque = [0, 0, 0]\n[start]\neuler = [0, 0, 0]\n\
                velocity = [0, 0, 1]\n[run]\nstep = 0.01\nduration = 10\n";
    let unit = Unit::of(&folder, text, 3);
    assert!(
        unit.description.contains("causality=\"input\" variability=\"discrete\" unit=\"N m\" start=\"0.0 0.0 0.0\"")
    );
    let rows = unit.rows(0.01, 1000, "torque");
    for (n, row) in (0_u32..).zip(&rows) {
        let [up, down] = [n.min(500), n.saturating_sub(500)].map(f64::from);
        let expected = 2.5 + 0.25 * 0.01 * up - 0.125 * 0.01 * down;
        // A torque acts at both ends of a step, half of it at either: the ends of a stretch are off by half a step.
        assert!((row[2] - expected).abs() < 0.25 * 0.01 + 1e-12, "{n} {row:?} {expected}");
    }
    let per_step: Vec<f64> = rows.windows(2).map(|pair| pair[1][2] - pair[0][2]).collect();
    assert!(per_step[1..499].iter().all(|one| (one - 0.0025).abs() < 1e-12), "{:?}", &per_step[..3]);
    assert!(per_step[501..].iter().all(|one| (one + 0.00125).abs() < 1e-12), "{:?}", &per_step[499..503]);
}

#[test]
fn scenes_without_a_unit_are_told() {
    let folder = folder("unit-refused");
    let refused = |text: &str, message: &str| {
        fs::write(folder.join("scene.toml"), text).unwrap();
        refuses(&folder, &["fmu", "scene.toml", "--out", "."], 3, message);
    };
    refused(
        &TOP.replace("step = \"10 ms\"", "accuracy = 1e-6").replace("[drag]\nc = 1e-3\n", ""),
        "the scene is no unit: the step is chosen by trial runs: give the run a `step`",
    );
    let free = "title = \"free\"\n[body]\nmoments = [1, 2, 2.5]\n[start]\neuler = [0, 0, 0]\nvelocity = [0, 0, 1]\n[run]\nmethod = \"exact\"\nstep = 0.01\nduration = 1\n";
    refused(free, "take `method = \"step\"` or a composition");
    assert!(!folder.join("scene.fmu").exists());
    // A scene has one text.
    fs::write(folder.join("scene.toml"), TOP).unwrap();
    let made = || {
        called(&folder, &["fmu", "scene.toml", "--out", "."]);
        files(&fs::read(folder.join("scene.fmu")).unwrap())
    };
    let (one, other) = (made(), made());
    assert_eq!(one["sources/scene.c"], other["sources/scene.c"]);
    assert!(
        one.contains_key("sources/buildDescription.xml")
            && one["modelDescription.xml"] == other["modelDescription.xml"]
    );
}
