//! Sessions with the program in `sessions/*.txt`: files, commands, and the output of each.
//!
//! `scene NAME` is the file `scenes/NAME.toml`, also as `scene NAME as FILE`, and `file FILE` is an empty one. Its lines
//! `-` are replaced by the lines `+` below them. `$ ARGUMENTS` calls the program, and `$ ARGUMENTS | WORD` displays the
//! lines with a word. Output, messages and an exit code that isn't zero are indented. A paragraph without a file changes
//! the last one of those before it, and one without a command repeats the commands before it.

use std::fs;
use std::path::Path;

use expect_test::{ExpectFile, expect_file};

use crate::called::{called, folder};

/// A file with its name.
#[derive(Clone)]
struct TextFile {
    name: String,
    text: String,
}

/// A scene of `scenes`.
fn scene(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/program/scenes/{name}.toml"));
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Replaces the removed lines by the added ones, once.
fn change(file: &mut TextFile, removed: &mut String, added: &mut String) {
    assert!(file.text.contains(removed.as_str()), "{} has no\n{removed}", file.name);
    file.text =
        if removed.is_empty() { file.text.clone() + added } else { file.text.replacen(removed.as_str(), added, 1) };
    removed.clear();
    added.clear();
}

/// Applies the lines of a paragraph to its files.
fn changed<'a>(mut files: Vec<TextFile>, lines: impl Iterator<Item = &'a str>) -> Vec<TextFile> {
    let (mut removed, mut added, mut has_own) = (String::new(), String::new(), false);
    for line in lines.filter(|line| !line.starts_with("//")).chain(["end"]) {
        if let Some(line) = line.strip_prefix('+') {
            added.extend([line.strip_prefix(' ').unwrap_or(line), "\n"]);
            continue;
        }
        if let Some(file) = files.last_mut().filter(|_| !added.is_empty() || !line.starts_with('-')) {
            change(file, &mut removed, &mut added);
        }
        if let Some(line) = line.strip_prefix('-') {
            removed.extend([line.strip_prefix(' ').unwrap_or(line), "\n"]);
        }
        let file = line.strip_prefix("scene ").map(|line| {
            let (name, file) =
                line.split_once(" as ").map_or_else(|| (line, format!("{line}.toml")), |(a, b)| (a, b.to_owned()));
            TextFile { name: file, text: scene(name) }
        });
        let file =
            file.or_else(|| Some(TextFile { name: line.strip_prefix("file ")?.to_owned(), text: String::new() }));
        if let Some(file) = file {
            if !std::mem::replace(&mut has_own, true) {
                files.clear();
            }
            files.push(file);
        }
    }
    files
}

/// The output of a command, without the words of the operating system.
fn output(folder: &Path, command: &str) -> Vec<String> {
    let (arguments, word) = command.split_once(" | ").unwrap_or((command, ""));
    let output = called(folder, &arguments.split_whitespace().collect::<Vec<_>>());
    let text = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap()).concat();
    let plain = |line: &str| match line.find(" (os error ") {
        Some(_) => format!("{}: …", line.rsplit_once(": ").map_or(line, |(before, _)| before)),
        None => line.to_owned(),
    };
    let mut lines: Vec<String> = text
        .lines()
        .filter(|line| !line.is_empty() && line.contains(word))
        .map(|line| format!("  {}", plain(line)))
        .collect();
    match output.status.code() {
        Some(0) if lines.is_empty() => lines.push("  nothing".to_owned()),
        Some(0) => {}
        code => lines.push(format!("  exit {code:?}").replace("Some(", "").replace(')', "")),
    }
    lines
}

/// A text with the output of its commands.
fn answered(text: &str, folder: &Path) -> String {
    let (mut paragraphs, mut is_blank) = (Vec::<Vec<&str>>::new(), true);
    for line in text.lines() {
        if line.is_empty() || line.starts_with(' ') {
            is_blank |= line.is_empty();
            continue;
        }
        if std::mem::take(&mut is_blank) {
            paragraphs.push(Vec::new());
        }
        paragraphs.last_mut().expect("a paragraph").push(line);
    }
    let (mut files, mut commands): (Vec<TextFile>, Vec<&str>) = (Vec::new(), Vec::new());
    let answered = paragraphs.iter().map(|lines| {
        let written = changed(files.clone(), lines.iter().copied());
        for TextFile { name, text } in &written {
            fs::write(folder.join(name), text).unwrap();
        }
        if lines.iter().any(|line| line.starts_with("scene ") || line.starts_with("file ")) {
            files = written;
        }
        let own: Vec<&str> = lines.iter().filter_map(|line| line.strip_prefix("$ ")).collect();
        let mut all = Vec::new();
        for line in lines {
            all.push((*line).to_owned());
            all.extend(line.strip_prefix("$ ").iter().flat_map(|command| output(folder, command)));
        }
        if own.is_empty() {
            all.extend(commands.iter().flat_map(|command| output(folder, command)));
        } else {
            commands = own;
        }
        all.join("\n")
    });
    answered.collect::<Vec<_>>().join("\n\n") + "\n"
}

/// Compares a text with its answers, and names the first line that differs below its paragraph.
fn check(name: &str, text: &str, file: &ExpectFile) {
    let found = answered(text, &folder(&format!("session-{name}")));
    let is_updated = std::env::var_os("UPDATE_EXPECT").is_some();
    let mut lines = text.lines().zip(found.lines()).enumerate();
    if let Some((at, (expected, found))) = lines.find(|(_, (a, b))| a != b).filter(|_| !is_updated) {
        let above: Vec<&str> = text.lines().take(at).collect();
        let paragraph = above.rsplit(|line| line.is_empty()).next().unwrap_or_default().join("\n");
        panic!("sessions/{name}.txt:{}\n{paragraph}\nexpected {expected}\nfound    {found}", at + 1);
    }
    file.assert_eq(&found);
}

macro_rules! sessions {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            let text = include_str!(concat!("sessions/", stringify!($name), ".txt"));
            check(stringify!($name), text, &expect_file![concat!("sessions/", stringify!($name), ".txt")]);
        })*

        #[test]
        fn each_text_is_a_test() {
            let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/program/sessions");
            assert_eq!(fs::read_dir(folder).unwrap().count(), [$(stringify!($name)),*].len());
        }
    };
}

sessions! { calls choices conventions ensembles groups judged lagrangians orbits replays scenes several }
