//! Scene files by the program that runs them: each mistake with its place, and every file of `examples/scenes`.

use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use expect_test::expect;
use liestep::accuracy::Accuracy;
use liestep::effects::CayleyBody;
use liestep::effects::{Dipole, Drag, GravityGradient, MagneticDamping, Rotor, Spring, Thrust, Torque};
use liestep::methods::{CompositionScheme, ExactBody, ProcessedScheme, SplittingScheme};
use liestep::motion::Moment;
use liestep::prelude::*;
use liestep::with::{Csv, Recorder};
use nalgebra::{UnitQuaternion, Vector3};

pub(crate) const TOP: &str = r#"title = "A heavy top with drag"

[body]
moments = [3, 3, 4]

[gravity]
m = "1 kg"
g = 9.81
rho = [0, 0, 1.0]
up = [0, 0, 1]

[drag]
c = 1e-3

[start]
euler = [0, "45 deg", 0]
velocity = [0, 0, "60 rpm"]

[run]
step = "10 ms"
duration = 2
"#;

/// The program: a scene's types are compiled into its library once, and not a second time into this test.
pub(crate) const PROGRAM: &str = env!("CARGO_BIN_EXE_liestep");

/// A folder of a test's own.
pub(crate) fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn simulate(folder: &Path, files: &[&str]) -> Output {
    Command::new(PROGRAM).current_dir(folder).args(["run", "--csv", "--out", "."]).args(files).output().unwrap()
}

/// The message for the top with one line replaced.
fn mistake(folder: &Path, line: &str, by: &str) -> String {
    assert_eq!(TOP.matches(line).count(), 1, "{line}");
    fs::write(folder.join("top.toml"), TOP.replace(line, by)).unwrap();
    let output = simulate(folder, &["top.toml"]);
    assert!(!output.status.success() && output.stdout.is_empty(), "{by}");
    String::from_utf8(output.stderr).unwrap()
}

/// The rows of a scene's table, after a run of a text.
fn rows(folder: &Path, text: &str) -> Vec<Vec<f64>> {
    fs::write(folder.join("scene.toml"), text).unwrap();
    let output = simulate(folder, &["scene.toml"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    table(&fs::read_to_string(folder.join("scene.csv")).unwrap())
}

fn table(csv: &str) -> Vec<Vec<f64>> {
    csv.lines().skip(1).map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

/// A terminal isn't told to do anything, and the picture stays XML.
#[test]
fn control_characters_are_written_out() {
    let folder = folder("control-characters");
    let text = TOP.replace("A heavy top", r"A \u0000 \u001b[31mred\r\n top");
    fs::write(folder.join("top.toml"), text).unwrap();
    let output = simulate(&folder, &["top.toml"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let printed = String::from_utf8(output.stdout).unwrap();
    let drawn = fs::read_to_string(folder.join("top.svg")).unwrap();
    for text in [&printed, &drawn] {
        assert!(text.contains(r"\u{0} \u{1b}[31mred\r\n top"), "{text}");
        assert!(!text.chars().any(|character| character.is_control() && character != '\n'));
    }
}

#[test]
fn mistakes_have_places() {
    let folder = folder("mistakes");
    let messages = [
        ("c = 1e-3", "c = 1e-3\nviscosity = 2"),
        ("[drag]", "[darg]"),
        ("g = 9.81\n", ""),
        ("[run]\nstep = \"10 ms\"\nduration = 2\n", ""),
        ("c = 1e-3", "c = 1e-3\nrho = [0, 0, 1]"),
        ("m = \"1 kg\"", "m = \"1 m\""),
        ("m = \"1 kg\"", "m = \"heavy\""),
        ("m = \"1 kg\"", "m = -1"),
        ("m = \"1 kg\"", "m = true"),
        ("c = 1e-3", "c = inf"),
        ("rho = [0, 0, 1.0]", "rho = [0, 1.0]"),
        ("rho = [0, 0, 1.0]", "rho = [0, \"1 m\", \"1 kg\"]"),
        ("rho = [0, 0, 1.0]", "rho = 1.0"),
        ("up = [0, 0, 1]", "up = [0, 0, 0]"),
        ("moments = [3, 3, 4]", "moments = [1, 1, 4]"),
        ("moments = [3, 3, 4]", "moments = [3, 3, 4]\nJ_d = [2, 2, 1]"),
        ("euler = [0, \"45 deg\", 0]", "quaternion = [1, 0, 0]"),
        ("euler = [0, \"45 deg\", 0]", "quaternion = [0, 0, 0, 0]"),
        ("euler = [0, \"45 deg\", 0]", "euler = [0, 0, 0]\nquaternion = [1, 0, 0, 0]"),
        ("velocity", "euler_rates = [0, 0, 1]\nvelocity"),
        ("step = \"10 ms\"", "step = \"10 min\""),
        ("step = \"10 ms\"", "step = 1e-9"),
        ("step = \"10 ms\"", "step = 1e308"),
        ("step = \"10 ms\"", "step = \"10 ms\"\naccuracy = 1e-6"),
        ("step = \"10 ms\"\n", ""),
        ("step = \"10 ms\"", "accuracy = 1e-6"),
        ("step = \"10 ms\"", "accuracy = 0"),
        ("[run]", "[picture]\npanels = [\"rates\", \"phase\"]\n[run]"),
        ("[run]", "[run"),
        ("[drag]", "[gravity]"),
        ("m = \"1 kg\"", "m = { \"größe\" = 1, 2 }"),
        ("velocity = [0, 0, \"60 rpm\"]", "velocity = [0, 0, 1]\neuler_rates = [0, 0, 1]"),
        ("euler = [0, \"45 deg\", 0]\nvelocity", "quaternion = [1, 0, 0, 0]\neuler_rates"),
        ("euler = [0, \"45 deg\", 0]\nvelocity", "euler_rates = [0, 0, 1]\nquaternion = [1, 0, 0, 0]\n#"),
        ("euler = [0, \"45 deg\", 0]\n", ""),
        ("moments = [3, 3, 4]\n", ""),
        ("moments = [3, 3, 4]", "mass = 3"),
        ("moments = [3, 3, 4]", "moments = [3, 4]"),
        ("c = 1e-3", "c = nan"),
        ("c = 1e-3", "c = 1e400"),
        ("c = 1e-3", "c = 1e-400"),
        ("c = 1e-3", "c = \"1e400 N m s\""),
        ("c = 1e-3", "c = 99999999999999999999"),
        ("rho = [0, 0, 1.0]", "rho = [0, \"1e306 km\", 0]"),
        ("moments = [3, 3, 4]", "moments = [3e-160, 3e-160, 4e-160]"),
        ("moments = [3, 3, 4]", "moments = [3e200, 3e200, 4e200]"),
        ("step = \"10 ms\"", "step = -0.0"),
    ]
    .map(|(line, by)| mistake(&folder, line, by));
    expect![[r#"
        error: top.toml:14:1: unknown field `viscosity`, expected `c`
        error: top.toml:12:2: unknown field `darg`, expected one of `title`, `body`, `gravity`, `gravity_gradient`, `dipole`, `spring`, `rotor`, `drag`, `magnetic_damping`, `torque`, `thrust`, `start`, `run`, `picture`, `event`, `output`
        error: top.toml:6:1: missing field `g`
        error: top.toml:1:1: missing field `run`
        error: top.toml:14:1: unknown field `rho`, expected `c`
        error: top.toml:7:5: a mass isn't in `m` but in `kg`, `g`, `t`
        error: top.toml:7:5: `heavy` doesn't begin with a number; a quantity is written as in "30 deg"
        error: top.toml:7:5: must be above zero
        error: top.toml:7:5: invalid type: boolean `true`, expected a mass in kg, or a text with a unit
        error: top.toml:13:5: must be finite
        error: top.toml:9:7: expected three components, found 2
        error: top.toml:9:18: a length isn't in `kg` but in `m`, `cm`, `mm`, `km`
        error: top.toml:9:7: invalid type: floating point `1.0`, expected a sequence
        error: top.toml:10:6: a direction can't be zero
        error: top.toml:4:11: no body has this inertia: J_d has the negative eigenvalue -1e0, so the largest principal moment exceeds the sum of the others; check which of the two inertias is given
        error: top.toml:4:11: a body has one of `moments` (of inertia, principal), `J_d` (nonstandard, principal), `J` (of inertia, 3 by 3)
        error: top.toml:16:14: `quaternion` has the four components w, x, y, z, found 3
        error: top.toml:16:14: `quaternion` can't be zero
        error: top.toml:17:14: an attitude is given by either `euler` or `quaternion`
        error: top.toml:18:12: a velocity is given by either `velocity` or `euler_rates`
        error: top.toml:19:1: `duration` is 2 s, shorter than one `step` of 600 s
        error: top.toml:19:1: `duration` makes 2.0e9 steps, more than 1e8; take a larger `step`
        error: top.toml:19:1: `duration` is 2 s, shorter than one `step` of 1e308 s
        error: top.toml:21:12: a run has either a `step` or an `accuracy`
        error: top.toml:19:1: a run has either a `step` or an `accuracy`
        error: top.toml:20:12: an accuracy can be asked for in conservative scenes; drag does work, so give a `step`
        error: top.toml:20:12: must be above zero
        error: top.toml:20:20: unknown variant `phase`, expected one of `rates`, `tilt`, `energy`, `energy-error`, `momentum`, `vertical-momentum-error`, `momentum-error`
        error: top.toml:19:5: unclosed table, expected `]`
        error: top.toml:12:2: duplicate key
        error: top.toml:7:22: invalid literal string, expected `'`
        error: top.toml:17:12: a velocity is given by either `velocity` or `euler_rates`
        error: top.toml:16:14: `euler_rates` need the attitude by `euler`
        error: top.toml:17:14: `euler_rates` need the attitude by `euler`
        error: top.toml:15:1: an attitude is given by either `euler` or `quaternion`
        error: top.toml:3:1: a body has one of `moments` (of inertia, principal), `J_d` (nonstandard, principal), `J` (of inertia, 3 by 3)
        error: top.toml:4:1: unknown field `mass`, expected one of `moments`, `J_d`, `J`, `kinetic`
        error: top.toml:4:11: expected three components, found 2
        error: top.toml:13:5: must be finite
        error: top.toml:13:5: floating-point number overflowed
        error: top.toml:13:5: must be above zero
        error: top.toml:13:5: must be finite
        error: top.toml:13:5: invalid type: integer `99999999999999999999` as i128, expected a damping coefficient in N m s, or a text with a unit
        error: top.toml:9:11: must be finite
        error: top.toml:4:11: the inertia has the trace 5e-160, out of range; choose units in which it is nearer to one
        error: top.toml:4:11: the inertia has the trace 4.999999999999999e200, out of range; choose units in which it is nearer to one
        error: top.toml:20:8: must be above zero
    "#]].assert_eq(&messages.concat());
}

/// The same of kinetic terms, methods, outputs and sweeps.
#[test]
fn mistakes_in_choices_have_places() {
    let folder = folder("choices");
    let messages = [
        ("moments = [3, 3, 4]", "J = [[3, 0, 0], [0, 3, 0]]"),
        ("moments = [3, 3, 4]", "J = [[3, 1, 0], [0, 3, 0], [0, 0, 4]]"),
        ("moments = [3, 3, 4]", "moments = [3, 3, 4]\nkinetic = \"quartic\""),
        ("duration = 2", "duration = 2\nmethod = { composition = \"Suzuki 4\" }"),
        ("duration = 2", "duration = 2\nmethod = { composition = \"Suzuki 5\" }"),
        ("duration = 2", "duration = 2\nmethod = \"euler\""),
        ("duration = 2", "duration = 2\nmethod = { collocation = 5 }"),
        ("[drag]\nc = 1e-3", "[output]\nevery = 0"),
        ("[drag]\nc = 1e-3", "[output]\ncolumns = [\"axis\", \"phase\"]"),
        ("[drag]\nc = 1e-3", "[output]\ncolumns = [\"axis\", \"energy\", \"axis\"]"),
        ("[run]", "[sweep]\ngravity.m = [1, 2, \"3 m\"]\n[run]"),
        ("[run]", "[sweep]\ngravity.n = [1, 2]\n[run]"),
        ("[run]", "[sweep]\ngravity.m = 1\n[run]"),
        ("[run]", "[sweep]\ngravity.m = []\n[run]"),
        ("[run]", "[sweep]\ngravity.m = { from = 1, to = \"2 g\", count = 3 }\n[run]"),
        ("[run]", "[sweep]\ngravity.m = { from = -1, to = 2, count = 3 }\n[run]"),
        ("[run]", "[sweep]\ngravity.m.x = [1]\n[run]"),
        ("[run]", "[[event]]\nname = \"a\"\n[run]"),
        ("[run]", "[[event]]\nname = \"a, b\"\ntilt = 1\n[run]"),
        ("[run]", "[[event]]\nname = \"a\"\ntilt = \"1 J\"\n[run]"),
        ("[run]", "[sweep]\n[run]"),
        ("[run]", "[sweep]\ngravity.m = { from = 1, to = 2, count = 200 }\ngravity.g = { from = 1, to = 2, count = 200 }\n[run]"),
    ]
    .map(|(line, by)| mistake(&folder, line, by));
    expect![[r"
        error: top.toml:4:5: `J` has three rows of three components, found 2 rows
        error: top.toml:4:5: the inertia is not symmetric: two entries differ by 1e0, more than rounding; give it symmetric
        error: top.toml:5:11: unknown variant `quartic`, expected one of `rigid`, `cayley`, `geodesic`, `fourth-order`, `sixth-order`
        error: top.toml:22:10: a composition needs a conservative scene; drag does work
        error: top.toml:22:10: no such scheme; there are `Suzuki 4`, `Kahan-Li 6`, `Kahan-Li 8`, `Sofroniou-Spaletta 10`, `Suzuki 6`, `Suzuki 8`
        error: top.toml:22:10: unknown variant `euler`, expected one of `step`, `composition`, `splitting`, `processed`, `collocation`
        error: top.toml:22:10: a collocation has 4 or 8 stages
        error: top.toml:13:9: must be a whole number of steps, above zero
        error: top.toml:13:20: unknown variant `phase`, expected one of `quaternion`, `axis`, `velocity`, `momentum`, `spatial-momentum`, `energy`, `energy-error`, `vertical-momentum-error`, `momentum-error`
        error: top.toml:13:11: a table has each of its columns once
        error: top.toml:20:20: a mass isn't in `m` but in `kg`, `g`, `t`
        error: top.toml:20:9: unknown field `n`, expected one of `m`, `g`, `rho`, `up`
        error: top.toml:20:13: a sweep is a list of values, or `{ from = …, to = …, count = … }`
        error: top.toml:20:13: a sweep has a value at least
        error: top.toml:20:13: a range is `{ from = …, to = …, count = … }`: two numbers, or texts with the same unit, and how many
        error: top.toml:20:13: must be above zero
        error: top.toml:20:9: `m` isn't a table
        error: top.toml:19:1: an event has one of `tilt`, `speed`, `energy`, `velocity_1`, `velocity_2`, `velocity_3`, `axis_1`, `axis_2`, `axis_3`
        error: top.toml:19:1: the `name` of an event has letters, digits, - and _ only
        error: top.toml:21:8: an angle isn't in `J` but in `rad`, `deg`, `°`
        error: top.toml:19:1: `sweep` has no key to vary
        error: top.toml:19:1: `sweep` makes more than 10000 scenes
    "]].assert_eq(&messages.concat());
}

/// What is no scene at all, with its place if there is text.
#[test]
fn files_of_another_kind() {
    let folder = folder("kinds");
    let contents: [(&str, Vec<u8>); 6] = [
        ("empty", Vec::new()),
        ("mark", [b"\xef\xbb\xbf", TOP.replace("[drag]", "[darg]").as_bytes()].concat()),
        ("bytes", [b"title = \"\xc3\xb6 \xff\"", TOP.as_bytes()].concat()),
        ("nested", [b"title = ".as_slice(), &b"[".repeat(100_000)].concat()),
        ("large", b" \n".repeat(600_000)),
        ("table", b"[[body]]\nmoments = [3, 3, 4]\n".to_vec()),
    ];
    let messages = contents.map(|(name, content)| {
        let file = format!("{name}.toml");
        fs::write(folder.join(&file), content).unwrap();
        let output = simulate(&folder, &[&file]);
        assert!(!output.status.success() && output.stdout.is_empty(), "{name}");
        String::from_utf8(output.stderr).unwrap()
    });
    expect![[r"
        error: empty.toml:1:1: missing field `title`
        error: mark.toml:12:2: unknown field `darg`, expected one of `title`, `body`, `gravity`, `gravity_gradient`, `dipole`, `spring`, `rotor`, `drag`, `magnetic_damping`, `torque`, `thrust`, `start`, `run`, `picture`, `event`, `output`
        error: bytes.toml:1:12: isn't a text in UTF-8
        error: nested.toml:1:89: cannot recurse further; max recursion depth met
        error: large.toml: has more than 1048576 bytes, so it is no scene
        error: table.toml:1:1: invalid type: sequence, expected a table with an inertia
    "]].assert_eq(&messages.concat());
}

/// A file of a hundred megabytes isn't read to its end.
#[test]
fn a_file_without_an_end() {
    let folder = folder("endless");
    fs::File::create(folder.join("endless.toml")).unwrap().set_len(100_000_000).unwrap();
    let output = simulate(&folder, &["endless.toml"]);
    assert!(!output.status.success());
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(message, "error: endless.toml: has more than 1048576 bytes, so it is no scene\n");
}

/// A mark of the byte order is no mistake.
#[test]
fn a_file_with_a_mark_of_the_byte_order() {
    let text = format!("\u{feff}{TOP}");
    assert_eq!(rows(&folder("mark"), &text).len(), 201);
}

/// Directions and quaternions of any length are brought to length one.
#[test]
fn directions_of_any_length() {
    let folder = folder("lengths");
    let plain = rows(&folder, &TOP.replace("euler = [0, \"45 deg\", 0]", "quaternion = [3, 4, 0, 0]"));
    for scale in ["e250", "e-250"] {
        let quaternion = format!("quaternion = [3{scale}, 4{scale}, 0, 0]");
        let text = TOP.replace("euler = [0, \"45 deg\", 0]", &quaternion);
        let text = text.replace("up = [0, 0, 1]", &format!("up = [0, 0, 7{scale}]"));
        let rows = rows(&folder, &text);
        assert_eq!(rows.len(), plain.len());
        let pairs = rows.iter().flatten().zip(plain.iter().flatten());
        assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() <= 1e-12 * (1.0 + b.abs())), "{scale}");
    }
}

#[test]
fn a_file_that_is_not_there() {
    let output = simulate(&folder("missing"), &["no-such.toml"]);
    assert!(!output.status.success());
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.starts_with("error: no-such.toml: cannot be read: "), "{message}");
}

/// A folder for the pictures that can't be one, no file at all, two of the same name.
#[test]
fn command_lines() {
    let folder = folder("commands");
    fs::write(folder.join("top.toml"), TOP).unwrap();
    let refused = |arguments: &[&str], code: i32, message: &str| {
        let output = Command::new(PROGRAM).current_dir(&folder).args(arguments).output().unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.starts_with("error: ") && text.contains(message), "{text}");
        assert!(output.stdout.is_empty() && output.status.code() == Some(code), "{arguments:?}: {text}");
    };
    refused(&["run"], 2, "required arguments were not provided");
    refused(&["run", "."], 1, ".: cannot be read");
    refused(&["run", "top.toml", "--out", "top.toml"], 4, "cannot write to top.toml");
    refused(&["run", "top.toml", "--out", "top.toml/out"], 4, "cannot write to top.toml/out");
    refused(&["run", "top.toml", "--out="], 2, "a value is required");
    refused(&["run", "top.toml", "--pictures"], 2, "unexpected argument '--pictures'");
    refused(&["run", "top.toml", "./top.toml"], 2, "would be written to the same files");
    refused(&["sweep", "top.toml", "./top.toml"], 2, "would be written to the same files");
    refused(&["replay", "a/top.csv", "b/top.csv"], 2, "would be written to the same files");
    refused(&["check", "no-such.toml"], 1, "no-such.toml: cannot be read");
    refused(&["sweep", "top.toml"], 1, "top.toml:1:1: has no table `sweep`");
    refused(&["replay", "top.toml"], 1, "top.toml:3:1: isn't a number");
    refused(&["derive", "no-such-effect"], 2, "'no-such-effect' is neither a scene file (*.toml) nor one of");
    refused(&["derive", "no-such.toml"], 1, "no-such.toml: cannot be read");
    refused(&["completions", "cmd"], 2, "invalid value 'cmd'");
    refused(&["ran"], 2, "unrecognized subcommand 'ran'");
}

/// What can't be printed or written is a message and an exit code.
#[test]
#[cfg(target_os = "linux")]
fn a_full_disk() {
    let folder = folder("full");
    fs::write(folder.join("top.toml"), TOP).unwrap();
    let table = folder.join("top.csv");
    // What was there may be a file.
    let _ = fs::remove_file(&table);
    std::os::unix::fs::symlink("/dev/full", &table).unwrap();
    let output = simulate(&folder, &["top.toml"]);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(4), "{text}");
    assert!(text.starts_with("error: top.toml: the table can't be written: No space left on device"), "{text}");

    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = Command::new(PROGRAM).args(["derive", "gravity"]).stdout(full).output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(4), "{text}");
    assert!(text.starts_with("error: cannot print: No space left on device"), "{text}");
}

fn printed(folder: &Path, arguments: &[&str]) -> String {
    let output = Command::new(PROGRAM).current_dir(folder).args(arguments).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn what_is_printed() {
    let folder = folder("printed");
    fs::write(folder.join("top.toml"), TOP).unwrap();
    assert_eq!(printed(&folder, &["check", "top.toml"]), "top.toml: body + gravity + drag, 200 steps of 0.01 s\n");
    assert!(!folder.join("out").exists());
    // All files are looked at.
    fs::write(folder.join("fast.toml"), TOP.replace("60 rpm", "60000 rpm")).unwrap();
    fs::write(folder.join("wrong.toml"), TOP.replace("[drag]", "[darg]")).unwrap();
    let files = ["check", "wrong.toml", "top.toml", "fast.toml"];
    let output = Command::new(PROGRAM).current_dir(&folder).args(files).output().unwrap();
    let (told, wrong) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert_eq!((told.lines().count(), wrong.lines().count(), output.status.code()), (1, 2, Some(3)), "{wrong}");
    assert!(wrong.starts_with("error: wrong.toml:12:2: unknown field `darg`"), "{wrong}");
    let names = printed(&folder, &["derive"]);
    assert_eq!(names.lines().count(), 15);
    for name in names.lines() {
        assert!(printed(&folder, &["derive", name]).contains("momentum"), "{name}");
    }
    let derived = printed(&folder, &["derive", "top.toml"]);
    let terms: Vec<_> = derived.lines().filter(|line| names.lines().any(|name| name == *line)).collect();
    assert_eq!(terms, ["principal-body", "gravity", "drag"]);
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(printed(&folder, &["completions", shell]).contains("replay"), "{shell}");
    }
}

/// A step that is too large is found out while running: with the file, the time and the largest step.
#[test]
fn a_step_that_is_too_large() {
    let folder = folder("fast");
    fs::write(folder.join("fast.toml"), TOP.replace("60 rpm", "60000 rpm")).unwrap();
    let output = simulate(&folder, &["fast.toml"]);
    assert!(!output.status.success());
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3));
    assert!(message.starts_with("error: fast.toml:20:8: stopped at t = 0 s: no solution at the step"), "{message}");
    assert!(message.ends_with(", and is `kinetic = \"cayley\"` of the body here\n"), "{message}");
}

/// The table of a file has the numbers, the signs and the digits of a program's.
#[test]
fn a_table_is_that_of_a_recorder() {
    let folder = folder("recorded");
    // The body turns over several times, so the quaternion that is nearer to the row before isn't that with `w ≥ 0`.
    let columns = "[output]\ncolumns = [\"quaternion\", \"velocity\", \"momentum\", \"energy\"]\nevery = 7\n";
    fs::write(folder.join("top.toml"), TOP.replace("[drag]\nc = 1e-3\n", columns)).unwrap();
    printed(&folder, &["run", "top.toml", "--csv", "--out", "."]);
    let table = fs::read_to_string(folder.join("top.csv")).unwrap();

    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0)).unwrap();
    let scene = PrincipalBody { J_d } + Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let stepper = Stepper::new(scene, 10.0 * 1e-3).unwrap();
    let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 45.0 * (PI / 180.0));
    let mut state = stepper.start(tilt, Vector3::new(0.0, 0.0, 60.0 * (6.0 * (PI / 180.0)))).unwrap();
    let mut recorder = Recorder::new(&stepper, Csv::new(Vec::new()));
    stepper.observed(&mut state).every(7, |now| recorder.record(now)).steps(200).unwrap();
    recorder.record(&Moment::of_step(&stepper, &state)).unwrap();
    let expected = String::from_utf8(recorder.finish().unwrap().into_inner().unwrap()).unwrap();
    // All but the defect.
    let expected: Vec<_> = expected.lines().map(|line| line.rsplit_once(',').unwrap().0).collect();
    assert_eq!(table.lines().collect::<Vec<_>>(), expected);
    assert!(self::table(&table).iter().any(|row| row[1] < -0.1), "{table}");
}

/// A run that stops leaves the rows that there were.
#[test]
fn a_run_that_stops_has_a_table() {
    let folder = folder("stops");
    let thrust = "[torque]\ntorque = [0, 0, 400]\n";
    fs::write(folder.join("top.toml"), TOP.replace("[drag]\nc = 1e-3\n", thrust)).unwrap();
    let output = simulate(&folder, &["top.toml"]);
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(3) && text.contains(": stopped at t = "), "{text}");
    let rows = table_of(&folder.join("top.csv"));
    let last = rows.last().unwrap()[0];
    assert!(rows.len() > 20 && text.contains(&format!("stopped at t = {last} s")), "{text}");
}

/// Every file that is there runs, moves, and has a picture and a table.
#[test]
fn the_scenes_run() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes");
    let gallery = fs::read_to_string(scenes.join("README.md")).unwrap();
    let mut files: Vec<_> = fs::read_dir(scenes).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    assert!(files.len() >= 12, "{}", files.len());
    let names: Vec<_> = files.iter().map(|path| path.to_str().unwrap()).collect();
    let folder = folder("scenes");
    let output = simulate(&folder, &names);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for path in &files {
        let result = |ending| {
            let name = Path::new(path.file_name().unwrap()).with_extension(ending);
            fs::read_to_string(folder.join(name)).unwrap()
        };
        let rows = table(&result("csv"));
        assert!(rows.len() > 500 && rows.first() != rows.last(), "{}", path.display());
        assert!(rows.iter().flatten().all(|value| value.is_finite()), "{}", path.display());
        assert!(result("svg").matches("<polyline").count() > 3, "{}", path.display());
        // Small enough to be kept beside the file, where the gallery has it.
        assert!(result("svg").len() < 60_000, "{}", path.display());
        let name = path.file_stem().and_then(|stem| stem.to_str()).unwrap();
        assert!(gallery.contains(&format!("({name}.toml)")) && gallery.contains(&format!("/{name}.svg)")), "{name}");
    }
}

/// What a file's scene does is what the sum in a program does, bit for bit; and the units are those of SI.
#[test]
fn a_file_is_a_sum() {
    let rows = rows(&folder("sum"), TOP);
    let last = rows.last().unwrap();

    let body = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0)).unwrap();
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let stepper = Stepper::new(
        PrincipalBody { J_d: body } + gravity + Drag { c: 1e-3, J: NonstandardInertia::from(body).to_inertia() },
        10.0 * 1e-3,
    )
    .unwrap();
    let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 45.0 * (PI / 180.0));
    let mut state = stepper.start(tilt, Vector3::new(0.0, 0.0, 60.0 * (6.0 * (PI / 180.0)))).unwrap();
    for _ in 0..200 {
        stepper.step(&mut state).unwrap();
    }
    assert_eq!(rows.len(), 201);
    assert_eq!(last[1..4], *stepper.velocity(&state).as_slice());
    assert_eq!(last[7].to_bits(), stepper.energy(&state).to_bits());
}

/// All effects at once.
#[test]
fn a_file_may_have_every_effect() {
    let others = "[gravity_gradient]\nGM = 2\nr = 3\ndirection = [1, 0, 0]\n\
                  [dipole]\nmoment = [0, 0.1, 1]\nfield = [0.2, 0, 1]\n\
                  [spring]\nk = 3\nlength = 0.5\nat = [0, 0, 1]\nanchor = [1, 0.3, 0.5]\n\
                  [rotor]\nspin = [0, 0.4, 1]\n\
                  [magnetic_damping]\nk = 0.1\nfield = [0, 0.5, 1]\n\
                  [torque]\ntorque = [0.1, 0.2, -0.1]\n\
                  [thrust]\nat = [0.3, 0, 1]\nthrust = [0, 0.2, 0.1]\n[run]";
    let rows = rows(&folder("all"), &TOP.replace("[run]", others));
    let last = rows.last().unwrap();

    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0)).unwrap();
    let J = NonstandardInertia::from(J_d).to_inertia();
    let scene = PrincipalBody { J_d }
        + Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() }
        + GravityGradient { GM: 2.0, r: 3.0, J, direction: Vector3::x() }
        + Dipole { moment: Vector3::new(0.0, 0.1, 1.0), field: Vector3::new(0.2, 0.0, 1.0) }
        + Spring { k: 3.0, length: 0.5, at: Vector3::z(), anchor: Vector3::new(1.0, 0.3, 0.5) }
        + Rotor { spin: Vector3::new(0.0, 0.4, 1.0) }
        + Drag { c: 1e-3, J }
        + MagneticDamping { k: 0.1, field: Vector3::new(0.0, 0.5, 1.0), J }
        + Torque { torque: Vector3::new(0.1, 0.2, -0.1) }
        + Thrust { at: Vector3::new(0.3, 0.0, 1.0), thrust: Vector3::new(0.0, 0.2, 0.1) };
    let stepper = Stepper::new(scene, 10.0 * 1e-3).unwrap();
    let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 45.0 * (PI / 180.0));
    let mut state = stepper.start(tilt, Vector3::new(0.0, 0.0, 60.0 * (6.0 * (PI / 180.0)))).unwrap();
    for _ in 0..200 {
        stepper.step(&mut state).unwrap();
    }
    assert_eq!(last[1..4], *stepper.velocity(&state).as_slice());
    assert_eq!(last[7].to_bits(), stepper.energy(&state).to_bits());
}

/// The last row of the top without drag, with a line in its tables `body` and `run` more.
fn last_row(test: &str, body: &str, run: &str) -> Vec<f64> {
    let text = TOP.replace("[drag]\nc = 1e-3\n", "").replace("moments = [3, 3, 4]\n", body);
    rows(&folder(test), &text.replace("duration = 2\n", &format!("duration = 2\n{run}\n"))).pop().unwrap()
}

/// What a program does with the same scene and method, with velocity and energy off by so much of themselves at most.
fn same_as<S, P>(row: &[f64], stepper: Result<Stepper<S, P>, SetupError>, tolerance: f64)
where
    S: liestep::mechanics::Effect<Scalar = f64, Group = SO3>,
    P: liestep::motion::Plan<S>,
{
    let stepper = stepper.unwrap();
    let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 45.0 * (PI / 180.0));
    let mut state = stepper.start(tilt, Vector3::new(0.0, 0.0, 60.0 * (6.0 * (PI / 180.0)))).unwrap();
    stepper.run(&mut state, 200).unwrap();
    let (velocity, energy) = (stepper.velocity(&state), stepper.energy(&state));
    assert!((Vector3::new(row[1], row[2], row[3]) - velocity).norm() <= tolerance * velocity.norm(), "{velocity}");
    assert!((row[7] - energy).abs() <= tolerance * energy.abs(), "{energy}");
}

/// By (3.13) bit for bit. Of other steps a file's scene, which could have a rotor, is solved in another order.
#[test]
fn kinetic_terms_and_methods() {
    let J = Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0)).unwrap();
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let body = RigidBody { J_d: J.to_nonstandard() };
    let (full, h) = ("J = [[3, 0, 0], [0, 3, 0], [0, 0, 4]]\n", 10.0 * 1e-3);
    same_as(&last_row("full", full, ""), Stepper::new(body + gravity, h), 0.0);
    let composed = last_row("composed", full, "method = { composition = \"Suzuki 4\" }");
    same_as(&composed, Stepper::composed(body + gravity, h, CompositionScheme::SUZUKI_4), 0.0);
    let cayley = last_row("cayley", "moments = [3, 3, 4]\nkinetic = \"cayley\"\n", "");
    same_as(&cayley, Stepper::new(CayleyBody { J } + gravity, h), 1e-13);
    let split = last_row("split", full, "method = { splitting = \"nyström 6-4\" }");
    same_as(&split, Stepper::split(body + gravity, h, ExactBody::new(&J), SplittingScheme::NYSTROM_6), 1e-13);
    let processed = last_row("processed", full, "method = { processed = \"processed 3-6 a\" }");
    same_as(&processed, Stepper::processed(body + gravity, h, ExactBody::new(&J), ProcessedScheme::SIX_A), 1e-13);
    let collocated = last_row("collocated", full, "method = { collocation = 4 }");
    same_as(&collocated, Stepper::collocated::<2>(body + gravity, h), 1e-13);

    // The others differ from these, and by no more than their order allows.
    let exact = &collocated[1..8];
    for (name, largest) in [("geodesic", 1e-2), ("fourth-order", 1e-2), ("sixth-order", 1e-2)] {
        let row = last_row(name, &format!("moments = [3, 3, 4]\nkinetic = \"{name}\"\n"), "");
        let error = row[1..8].iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error > 1e-9 && error < largest, "{name}: {error}");
    }
}

/// A ball that rolls on: its tilt passes 60° at π/6, 5π/6, 7π/6, … half seconds, between the steps.
#[test]
fn events() {
    let folder = folder("events");
    let text = "title = \"ball\"\n[body]\nmoments = [1, 1, 1]\n[start]\neuler = [0, 0, 0]\nvelocity = [2, 0, 0]\n\
                [run]\nstep = 0.07\nduration = 7\nmethod = { splitting = \"Strang\" }\n\
                [[event]]\nname = \"low\"\ntilt = \"60 deg\"\ndirection = \"rising\"\n\
                [[event]]\nname = \"side\"\naxis_2 = 0.5\n";
    fs::write(folder.join("ball.toml"), text).unwrap();
    let report = printed(&folder, &["run", "ball.toml", "--csv", "--html", "--out", "."]);
    assert!(
        report.contains("\n  low: 3 times, first at t = 0.523598775598") && report.contains("\n  side: 4 times, first")
    );
    let table = fs::read_to_string(folder.join("ball.events.csv")).unwrap();
    assert!(table.starts_with("event,rising,t,velocity_x,"), "{table}");
    let mut found: Vec<(&str, &str, f64)> = Vec::new();
    for row in table.lines().skip(1) {
        let cells: Vec<_> = row.split(',').collect();
        found.push((cells[0], cells[1], cells[2].parse().unwrap()));
    }
    // `R e₃` has the second component −sin 2t.
    let expected = [
        ("low", "1", 1.0),
        ("side", "1", 3.5),
        ("low", "1", 7.0),
        ("side", "0", 5.5),
        ("side", "1", 9.5),
        ("low", "1", 13.0),
        ("side", "0", 11.5),
    ];
    let mut expected = expected.map(|(name, rising, sixths)| (name, rising, sixths * PI / 6.0));
    expected.sort_by(|a, b| a.2.total_cmp(&b.2));
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert_eq!((found.0, found.1), (expected.0, expected.1));
        assert!((found.2 - expected.2).abs() < 1e-13, "{found:?} {expected:?}");
    }
    assert!(fs::read_to_string(folder.join("ball.html")).unwrap().contains("events: [\n[0.5235987755"));

    fs::write(folder.join("stop.toml"), text.replace("axis_2 = 0.5", "axis_2 = 0.5\nstop = true")).unwrap();
    let report = printed(&folder, &["run", "stop.toml", "--csv", "--out", "."]);
    assert!(report.contains(", 27 steps of 0.07 s\n") && report.contains(", which ended the run\n"), "{report}");
    assert_eq!(table_of(&folder.join("stop.csv")).last().unwrap()[0].to_bits(), (0.07 * 27.0_f64).to_bits());
}

/// A sweep counts events.
#[test]
fn events_of_a_sweep() {
    let folder = folder("events-of-a-sweep");
    let text = "title = \"ball\"\nbody.moments = [1, 1, 1]\nstart.euler = [0, 0, 0]\nstart.velocity = [0, 0, 0]\n\
                run.step = 0.07\nrun.duration = 7\nrun.method = { splitting = \"Strang\" }\noutput.columns = []\n\
                sweep.start.velocity = [[2, 0, 0], [0, 0, 1]]\n[[event]]\nname = \"low\"\ntilt = \"60 deg\"\n";
    fs::write(folder.join("ball.toml"), text).unwrap();
    printed(&folder, &["sweep", "ball.toml", "--out", "."]);
    let table = fs::read_to_string(folder.join("ball.sweep.csv")).unwrap();
    let rows: Vec<Vec<_>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0][4..], ["low_times", "low_first"]);
    assert_eq!((rows[1][0], rows[1][4]), ("2 0 0", "5.0"));
    assert!((rows[1][5].parse::<f64>().unwrap() - PI / 6.0).abs() < 1e-13, "{table}");
    assert_eq!(rows[2][4..], ["0.0", "NaN"]);
}

fn table_of(path: &Path) -> Vec<Vec<f64>> {
    table(&fs::read_to_string(path).unwrap())
}

/// A point of a sweep is the file with its values.
#[test]
fn sweeps() {
    let folder = folder("sweeps");
    let sweep = "[sweep]\ngravity.m = [\"1 kg\", 1.5]\ndrag.c = { from = 0.001, to = 0.002, count = 3 }\n[run]";
    fs::write(folder.join("sweep.toml"), TOP.replace("[run]", sweep)).unwrap();
    printed(&folder, &["sweep", "sweep.toml", "--out", "."]);
    let table = fs::read_to_string(folder.join("sweep.sweep.csv")).unwrap();
    let mut lines = table.lines();
    assert!(lines.next().unwrap().starts_with("gravity.m,drag.c,t,velocity_x,"));
    let points: Vec<_> = lines.map(|line| line.split(',').take(2).collect::<Vec<_>>().join(" ")).collect();
    assert_eq!(points, ["1 kg 0.001", "1 kg 0.0015", "1 kg 0.002", "1.5 0.001", "1.5 0.0015", "1.5 0.002"]);
    let row: Vec<f64> = table.lines().nth(6).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    let alone = self::rows(&folder, &TOP.replace("\"1 kg\"", "1.5").replace("1e-3", "0.002")).pop().unwrap();
    assert_eq!(row[2..17], alone[..]);

    // Points that stop have a row without numbers.
    let faster = "[sweep]\nstart.velocity = [[0, 0, 1], [0, 0, 1000]]\n[run]";
    fs::write(folder.join("faster.toml"), TOP.replace("[run]", faster)).unwrap();
    let output =
        Command::new(PROGRAM).current_dir(&folder).args(["sweep", "faster.toml", "--out", "."]).output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3));
    assert!(message.starts_with("note: start.velocity = 0 0 1000 gave no row: faster.toml:22:8: stopped at t = 0 s: "));
    assert!(message.ends_with("error: 1 scenes of the sweep stopped\n"), "{message}");
    let table = fs::read_to_string(folder.join("faster.sweep.csv")).unwrap();
    assert_eq!(table.lines().nth(2).unwrap(), format!("0 0 1000{}", ",".repeat(17)));
}

/// What a file asks for is what a program that asks the same gets, bit for bit.
#[test]
fn a_file_may_ask_for_an_accuracy() {
    let text = TOP.replace("step = \"10 ms\"", "accuracy = 1e-7").replace("[drag]\nc = 1e-3\n", "");
    let rows = rows(&folder("asked"), &text);
    let last = rows.last().unwrap();

    let body = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0)).unwrap();
    let scene = PrincipalBody { J_d: body } + Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 45.0 * (PI / 180.0));
    let velocity = Vector3::new(0.0, 0.0, 60.0 * (6.0 * (PI / 180.0)));
    let accuracy = Accuracy { tolerance: 1e-7, horizon: 2.0 };
    let stepper = Stepper::for_accuracy(scene, accuracy, tilt, velocity).unwrap();
    let mut state = stepper.start();
    stepper.run(&mut state).unwrap();
    assert_eq!(rows.len() as u64, stepper.choice().steps + 1);
    assert_eq!(last[1..4], *stepper.velocity(&state).as_slice());
}

/// The rates of Euler's angles and the body velocity that they make are those of the same motion.
#[test]
fn rates_of_euler_angles() {
    let angles = Vector3::new(0.3, 0.8, -0.5);
    let rates = Vector3::new(1.5, -0.7, 2.5);
    let at = |t: f64| {
        let angles = angles + rates * t;
        let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
        about(Vector3::z_axis(), angles.x) * about(Vector3::x_axis(), angles.y) * about(Vector3::z_axis(), angles.z)
    };
    let expected = (at(-1e-4).inverse() * at(1e-4)).scaled_axis() / 2e-4;
    let start = "euler = [0.3, 0.8, -0.5]\neuler_rates = [1.5, -0.7, 2.5]\n";
    let text = TOP.replace("euler = [0, \"45 deg\", 0]\nvelocity = [0, 0, \"60 rpm\"]\n", start);
    let row = &self::rows(&folder("rates"), &text)[0];
    let velocity = Vector3::new(row[1], row[2], row[3]);
    assert!((velocity - expected).norm() < 1e-6, "{velocity} {expected}");
    let axis = Vector3::new(row[8], row[9], row[10]);
    assert!((axis - at(0.0) * Vector3::z()).norm() < 1e-14, "{axis}");
}
