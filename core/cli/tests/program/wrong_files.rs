//! Wrong scene files and command lines: each mistake has its place; and printing.

use std::fs;
use std::process::{Command, Stdio};

use expect_test::expect;

use crate::called::{PROGRAM, TOP, apart, called, folder, mistakes, printed, refused, refuses, rows, simulate};

/// Control characters don't reach the terminal, and the picture stays valid XML.
#[test]
fn control_characters_are_written_out() {
    let folder = folder("control-characters");
    let text = TOP.replace("A heavy top", r"A \u0000 \u001b[31mred\r\n top");
    fs::write(folder.join("top.toml"), text).unwrap();
    let printed = printed(&folder, &["run", "top.toml", "--csv", "--out", "."]);
    let drawn = fs::read_to_string(folder.join("top.svg")).unwrap();
    for text in [&printed, &drawn] {
        assert!(text.contains(r"\u{0} \u{1b}[31mred\r\n top"), "{text}");
        assert!(!text.chars().any(|character| character.is_control() && character != '\n'));
    }
}

#[test]
fn mistakes_have_places() {
    let folder = folder("mistakes");
    for file in ["scenes", "choices"] {
        mistakes(file, TOP, |text| refused(&folder, text));
    }
}

/// Files that are no scene, with the place of the mistake if there is text.
#[test]
fn files_of_another_kind() {
    let folder = folder("kinds");
    let contents: [(&str, Vec<u8>); 5] = [
        ("empty", Vec::new()),
        ("mark", [b"\xef\xbb\xbf", TOP.replace("[drag]", "[darg]").as_bytes()].concat()),
        ("bytes", [b"title = \"\xc3\xb6 \xff\"", TOP.as_bytes()].concat()),
        ("nested", [b"title = ".as_slice(), &b"[".repeat(100_000)].concat()),
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
        error: mark.toml:12:2: unknown field `darg`, expected one of `title`, `body`, `start`, `run`, `picture`, `event`, `output`, `lagrangian`, `force`, `gravity`, `gravity_gradient`, `dipole`, `spring`, `rotor`, `drag`, `air_drag`, `torque`, `thrust`, `magnetic_damping`; did you mean `drag`?
        error: bytes.toml:1:12: isn't a text in UTF-8
        error: nested.toml:1:89: cannot recurse further; max recursion depth met
        error: table.toml:1:1: missing field `name`
    "]].assert_eq(&messages.concat());
}

/// A file of a hundred megabytes isn't read to its end.
#[test]
fn a_file_without_an_end() {
    let folder = folder("endless");
    fs::File::create(folder.join("endless.toml")).unwrap().set_len(100_000_000).unwrap();
    refuses(
        &folder,
        &["run", "endless.toml"],
        1,
        "error: endless.toml: has more than 1048576 bytes, so it is no scene\n",
    );
}

/// A byte order mark is no mistake.
#[test]
fn a_file_with_a_mark_of_the_byte_order() {
    let text = format!("\u{feff}{TOP}");
    assert_eq!(rows(&folder("mark"), &text).len(), 201);
}

/// Quaternions of any length are normalised, and so are directions with a length of one up to the typed digits. Other
/// directions are refused, as a Lagrangian and a program would give them different weights.
#[test]
fn lengths_of_directions() {
    let folder = folder("lengths");
    let plain = rows(&folder, &TOP.replace("euler = [0, \"45 deg\", 0]", "quaternion = [3, 4, 0, 0]"));
    for scale in ["e250", "e-250"] {
        let quaternion = format!("quaternion = [3{scale}, 4{scale}, 0, 0]");
        let text = TOP.replace("euler = [0, \"45 deg\", 0]", &quaternion);
        let rows = rows(&folder, &text);
        assert_eq!(rows.len(), plain.len());
        let pairs = rows.iter().flatten().zip(plain.iter().flatten());
        assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() <= 1e-12 * (1.0 + b.abs())), "{scale}");
    }
    let up = |up: &str| TOP.replace("up = [0, 0, 1]", &format!("up = {up}"));
    let [typed, rounded] = ["[0.6, 0, 0.8005]", "[0.6, 0, 0.8]"].map(|given| self::rows(&folder, &up(given)));
    assert!(apart(&typed, &rounded) < 1e-2);
    for (given, length, better) in [
        ("[0, 0, 2]", "2", "[0, 0, 1]"),
        ("[3, 0, 4]", "5", "[0.6, 0, 0.8]"),
        ("[0, 0, -7e250]", "7e250", "[0, 0, -1]"),
        ("[1, 1, 0]", "1.414213562", "[0.707107, 0.707107, 0]"),
        ("[0, 0, 0.998]", "0.998", "[0, 0, 1]"),
    ] {
        let message = refused(&folder, &up(given));
        let expected = format!("top.toml:10:6: a direction has the length 1, and this {length}: write {better}\n");
        assert_eq!(message, format!("error: {expected}"));
        // The advised direction is accepted.
        assert_eq!(self::rows(&folder, &up(better)).len(), 201, "{better}");
    }
}

/// Refused command lines: an impossible folder for the pictures, no file, two files of one name.
#[test]
fn command_lines() {
    let folder = folder("commands");
    fs::write(folder.join("top.toml"), TOP).unwrap();
    let refused = |arguments: &[&str], code, message| refuses(&folder, arguments, code, message);
    refused(&["run"], 2, "required arguments were not provided");
    refused(&["run", "."], 1, "error: .: cannot be read");
    refused(&["run", "no-such.toml"], 1, "error: no-such.toml: cannot be read: ");
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
    fs::write(folder.join("top.arrows"), [0xff; 8]).unwrap();
    refused(&["replay", "top.arrows"], 1, "top.arrows:1:1: is a table of Arrow IPC; pages are made of CSV");
    refused(&["derive", "no-such-effect"], 2, "'no-such-effect' is neither a scene file (*.toml) nor one of");
    refused(&["derive", "no-such.toml"], 1, "no-such.toml: cannot be read");
    refused(&["completions", "cmd"], 2, "invalid value 'cmd'");
    refused(&["ran"], 2, "unrecognized subcommand 'ran'");
}

/// A failure to print or to write is a message and an exit code.
#[test]
#[cfg(target_os = "linux")]
fn a_full_disk() {
    let folder = folder("full");
    fs::write(folder.join("top.toml"), TOP).unwrap();
    std::os::unix::fs::symlink("/dev/full", folder.join("top.csv.part")).unwrap();
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

/// A reader that closes the pipe is no failure.
#[test]
fn a_reader_that_goes_away() {
    let mut program =
        Command::new(PROGRAM).args(["derive", "gravity"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    drop(program.as_mut().unwrap().stdout.take());
    let output = program.unwrap().wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
}

/// An unfinished table has another name than a finished one.
#[test]
fn a_killed_table_has_no_name() {
    let folder = folder("a_killed_table_has_no_name");
    fs::write(folder.join("top.toml"), TOP.replace("duration = 2", "duration = 1e6")).unwrap();
    let mut program = Command::new(PROGRAM);
    let mut program = program.current_dir(&folder).args(["run", "top.toml", "--csv", "--out", "."]).spawn().unwrap();
    let part = folder.join("top.csv.part");
    while !fs::metadata(&part).is_ok_and(|file| file.len() > 0) {
        assert!(program.try_wait().unwrap().is_none());
        std::thread::yield_now();
    }
    program.kill().unwrap();
    program.wait().unwrap();
    assert!(!folder.join("top.csv").exists() && part.exists());
}

#[test]
fn what_is_printed() {
    let folder = folder("printed");
    fs::write(folder.join("top.toml"), TOP).unwrap();
    assert_eq!(
        printed(&folder, &["check", "top.toml"]),
        "top.toml: body + gravity + drag, 200 steps of 0.01 s, hΩ = 0.0628 rad\n"
    );
    assert!(!folder.join("out").exists());
    // All files are checked.
    fs::write(folder.join("fast.toml"), TOP.replace("60 rpm", "60000 rpm")).unwrap();
    fs::write(folder.join("wrong.toml"), TOP.replace("[drag]", "[darg]")).unwrap();
    let files = ["check", "wrong.toml", "top.toml", "fast.toml"];
    let output = called(&folder, &files);
    let (told, wrong) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert_eq!((told.lines().count(), wrong.lines().count(), output.status.code()), (1, 2, Some(3)), "{wrong}");
    assert!(wrong.starts_with("error: wrong.toml:12:2: unknown field `darg`"), "{wrong}");
    let names = printed(&folder, &["derive"]);
    assert_eq!(names.lines().count(), 16);
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

/// Neither number is a double, and their ratio isn't ten.
#[test]
fn a_duration_is_a_whole_number_of_steps() {
    let folder = folder("durations");
    let text = TOP.replace("step = \"10 ms\"\nduration = 2\n", "step = \"0.1 ms\"\nduration = 0.001\n");
    fs::write(folder.join("top.toml"), text).unwrap();
    assert!(printed(&folder, &["check", "top.toml"]).contains("10 steps of 0.0001 s,"));
}

/// Control characters in keys, units and file names don't reach the terminal.
#[test]
fn control_characters_in_mistakes_are_written_out() {
    let folder = folder("controls");
    for (line, by) in [("[drag]", "\"dr\\u001bag\" = 1\n[drag]"), ("m = \"1 kg\"", "m = \"5 k\\u0007g\"")] {
        let text = TOP.replace(line, by);
        assert_ne!(text, TOP, "{line}");
        fs::write(folder.join("top\u{1b}.toml"), text).unwrap();
        for command in ["check", "run"] {
            let output = called(&folder, &[command, "top\u{1b}.toml"]);
            let message = String::from_utf8(output.stderr).unwrap();
            assert!(output.status.code() == Some(1) && message.contains("top\\u{1b}.toml:"), "{message}");
            assert!(message.chars().all(|letter| letter == '\n' || !letter.is_control()), "{message:?}");
        }
    }
}
