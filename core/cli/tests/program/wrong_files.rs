//! Wrong scene files and command lines: each mistake has its place; and printing.

use std::fs;
use std::process::{Command, Stdio};

use expect_test::expect;

use crate::called::{PROGRAM, TOP, apart, called, folder, printed, refuses, rows, simulate};

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

/// Files that are no scene, with the place of the mistake if there is text.
#[test]
fn files_of_another_kind() {
    let folder = folder("kinds");
    let contents: [(&str, Vec<u8>); 6] = [
        ("empty", Vec::new()),
        ("mark", [b"\xef\xbb\xbf", TOP.replace("[drag]", "[darg]").as_bytes()].concat()),
        ("bytes", [b"title = \"\xc3\xb6 \xff\"", TOP.as_bytes()].concat()),
        ("nested", [b"title = ".as_slice(), &b"[".repeat(100_000)].concat()),
        ("model", b"\xef\xbb\xbf\n<?xml version=\"1.0\"?>\n<robot name=\"arm\"/>\n".to_vec()),
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
        error: empty.toml:1:1: missing field `start`
        error: mark.toml:12:2: unknown field `darg`, expected one of `title`, `body`, `start`, `run`, `orbit`, `pointing`, `picture`, `event`, `output`, `lagrangian`, `hamiltonian`, `force`, `nonholonomic`, `control`, `wheel`, `gravity`, `gravity_gradient`, `dipole`, `spring`, `rotor`, `drag`, `air_drag`, `torque`, `thrust`, `magnetic_damping`; did you mean `drag`?
        error: bytes.toml:1:12: isn't a text in UTF-8
        error: nested.toml:1:89: cannot recurse further; max recursion depth met
        error: model.toml:2:1: is XML, and a scene is TOML: `liestep import model.toml` makes one of a robot's model, of URDF, SDF or MJCF
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

/// Quaternions of any length are normalised, and so are directions with a length of one up to the typed digits.
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
    printed(&folder, &["check", "top.toml"]);
    assert!(!folder.join("out").exists());
    let names = printed(&folder, &["derive"]);
    for name in names.lines() {
        assert!(printed(&folder, &["derive", name]).contains("momentum"), "{name}");
    }
    let derived = printed(&folder, &["derive", "top.toml"]);
    let terms: Vec<_> = derived.lines().filter(|line| names.lines().any(|name| name == *line)).collect();
    assert_eq!(terms, ["principal-body", "gravity", "drag"]);
    fs::write(folder.join("top.arrows"), [0xff; 8]).unwrap();
    let message = "top.arrows:1:1: is a table of Arrow IPC; pages are made of CSV";
    refuses(&folder, &["replay", "top.arrows"], 1, message);
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(printed(&folder, &["completions", shell]).contains("replay"), "{shell}");
    }
}

/// XML has no letters U+FFFE and U+FFFF, not even escaped.
#[test]
fn a_title_with_letters_that_no_picture_may_have() {
    let folder = folder("title");
    let title = TOP.lines().find(|line| line.starts_with("title")).unwrap();
    fs::write(folder.join("top.toml"), TOP.replace(title, "title = \"a\\uFFFEb\\uFFFFc\"")).unwrap();
    printed(&folder, &["run", "top.toml", "--out", "."]);
    let picture = fs::read_to_string(folder.join("top.svg")).unwrap();
    assert!(picture.contains("a\\u{fffe}b\\u{ffff}c") && !picture.contains(['\u{fffe}', '\u{ffff}']));
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
