//! The rooms of the sources import each other in one direction.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// What each room may import besides itself, as `src/lib.rs` draws it. Documentation may name everything.
const MAY_IMPORT: [(&str, &[&str]); 14] = [
    ("error", &[]),
    ("numbers", &[]),
    ("groups", &["numbers"]),
    ("mechanics", &["error", "numbers", "groups"]),
    ("effects", &["error", "numbers", "groups", "mechanics"]),
    ("solving", &["error", "numbers", "groups", "mechanics"]),
    ("motion", &["error", "numbers", "groups", "mechanics", "solving"]),
    ("methods", &["error", "numbers", "groups", "mechanics", "effects", "solving", "motion"]),
    ("with", &["error", "numbers", "groups", "mechanics", "effects", "solving", "motion", "methods"]),
    ("accuracy", &["error", "numbers", "groups", "mechanics", "effects", "solving", "motion", "methods"]),
    ("laws", &["numbers", "groups"]),
    ("conventions", &[]),
    ("guide", &[]),
    ("prelude", &["error", "groups", "mechanics", "effects", "motion"]),
];

/// The code of a file: neither comments nor tests.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    let lines = text.lines().take_while(|line| !line.starts_with("#[cfg(test)]"));
    lines.filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

/// The rooms that a text names behind `crate::`.
fn named(code: &str) -> BTreeSet<&str> {
    let after = code.match_indices("crate::").filter(|(place, _)| !code[..*place].ends_with('$'));
    after
        .map(|(place, word)| {
            let rest = &code[place + word.len()..];
            &rest[..rest.find(|letter: char| !letter.is_alphanumeric() && letter != '_').unwrap_or(rest.len())]
        })
        .collect()
}

fn check(room: &str, path: &Path, mistakes: &mut Vec<String>) {
    if path.is_dir() {
        for entry in fs::read_dir(path).unwrap() {
            check(room, &entry.unwrap().path(), mistakes);
        }
        return;
    }
    // Tests may import what they like.
    if path.extension().is_none_or(|extension| extension != "rs") || path.ends_with("tests.rs") {
        return;
    }
    let code = code(path);
    let (_, allowed) = MAY_IMPORT.iter().find(|(name, _)| *name == room).unwrap();
    for other in named(&code) {
        // A brace behind `crate::` holds the macros that stand at the root.
        if !other.is_empty() && other != room && !allowed.contains(&other) {
            mistakes.push(format!("{}: `{room}` mustn't import `{other}`", path.display()));
        }
    }
    for word in ["HashMap", "HashSet"] {
        if code.contains(word) {
            mistakes.push(format!("{}: the order of a {word} changes from run to run", path.display()));
        }
    }
}

#[test]
fn rooms_import_in_one_direction() {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut mistakes = Vec::new();
    let mut rooms = BTreeSet::new();
    for entry in fs::read_dir(&sources).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        // The front door and what expansions name are above all rooms.
        if name != "lib" && name != "private" {
            check(&name, &path, &mut mistakes);
            rooms.insert(name);
        }
    }
    assert!(mistakes.is_empty(), "{}", mistakes.join("\n"));
    assert_eq!(rooms, MAY_IMPORT.iter().map(|(name, _)| (*name).to_owned()).collect());
    // One direction: whoever imports a room stands above it in the table.
    for (place, (name, allowed)) in MAY_IMPORT.iter().enumerate() {
        for other in *allowed {
            assert!(MAY_IMPORT[..place].iter().any(|(below, _)| below == other), "`{name}` is below `{other}`");
        }
    }
}
