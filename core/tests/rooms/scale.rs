//! The scale: how many lines each room may have, how long files and functions may be, and no circle between files.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use super::{code, root};

/// The lines of the longest file and function, and of the median file in `core` and `macros`.
const LENGTHS: [usize; 3] = [500, 80, 120];

/// The lines of each room and package, and of each room of the library the names that it makes public.
#[rustfmt::skip]
const BUDGETS: [(&str, usize, usize); 41] = [
    ("core/src/lib", 60, 11), ("core/src/prelude", 12, 28), ("core/src/private", 176, 63), ("core/src/error", 522, 2),
    ("core/src/numbers", 2644, 14), ("core/src/groups", 4009, 35), ("core/src/laws", 671, 3),
    ("core/src/mechanics", 3560, 43), ("core/src/effects", 431, 16), ("core/src/solving", 1343, 3),
    ("core/src/motion", 3524, 29), ("core/src/gradients", 1826, 13), ("core/src/methods", 7913, 25),
    ("core/src/recording", 1905, 14), ("core/src/with", 1635, 7), ("core/src/accuracy", 1132, 9),
    ("core/src/conventions", 12, 0), ("core/src/guide", 19, 0), ("core/tests", 990, 0), ("macros/src", 235, 0),
    ("macros/derivation/src/lib", 28, 0), ("macros/derivation/src/expand", 3061, 0),
    ("macros/derivation/src/staged", 714, 0), ("macros/derivation/src/emit", 3767, 0),
    ("macros/derivation/src/judged", 5746, 0), ("macros/derivation/src/declared", 5179, 0),
    ("macros/derivation/src/program", 2506, 0), ("macros/derivation/src/mathematics", 4588, 0),
    ("core/late", 3308, 0), ("core/machine", 1112, 0), ("core/python", 1821, 0), ("core/scene", 5665, 0), ("core/cli", 2976, 0),
    ("core/plot", 790, 0), ("core/refinement", 661, 0), ("core/ensemble", 5053, 0), ("core/arrow", 215, 0),
    ("core/control", 2507, 0), ("examples", 11622, 0), ("tests", 23767, 0), ("tests/ui", 1757, 0),
];

/// The circles that are still there. Lines may go, and none be added.
#[rustfmt::skip]
const CIRCLES: [&str; 0] = [];

/// Every source of the repository: its path, and its text.
fn sources(root: &Path) -> BTreeMap<String, String> {
    let (mut open, mut sources) = (vec![root.to_owned()], BTreeMap::new());
    while let Some(path) = open.pop() {
        if path.is_dir() {
            let paths = fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path());
            open.extend(paths.filter(|path| !path.ends_with("target") && !path.ends_with(".git")));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = path.strip_prefix(root).unwrap().to_str().unwrap().replace('\\', "/");
            sources.insert(name, fs::read_to_string(&path).unwrap());
        }
    }
    sources
}

/// The names that a room's page makes public, less those that are hidden where they are defined.
fn public_names(page: &str) -> usize {
    let items = page.match_indices("\npub ").filter(|(place, _)| !page[..*place].ends_with("#[doc(hidden)]"));
    let items = items.map(|(place, word)| page[place + word.len()..].split(['(', ';']).next().unwrap());
    let names = |item: &str| match item.split_once('{') {
        _ if item.starts_with("mod ") => 0,
        Some((path, names)) if path.starts_with("use ") => {
            names.split(',').filter(|name| name.contains(char::is_alphanumeric)).count()
        }
        _ => 1,
    };
    items.map(names).sum()
}

/// The lines of the longest function, which rustfmt has closed where it begins.
fn longest_function(text: &str) -> usize {
    let lines: Vec<&str> = text.lines().collect();
    let length = |start: usize| {
        let (indent, item) = lines[start].split_at(lines[start].len() - lines[start].trim_start().len());
        let begins = item.starts_with("fn ") || (item.starts_with(['p', 'c']) && item.contains(" fn "));
        let mut rest = lines[start..].iter().map(|line| line.strip_prefix(indent).unwrap_or_default());
        let end = rest.position(|rest| !rest.starts_with(' ') && rest.ends_with(['}', ';']));
        if begins { end.map_or(0, |end| end + 1) } else { 0 }
    };
    (0..lines.len()).map(length).max().unwrap_or(0)
}

#[test]
fn rooms_stay_within_their_budgets() {
    let Some(root) = root() else { return };
    let sources = sources(root);
    let (mut lines, mut shown, mut hidden) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
    let (mut of_each, mut mistakes) = (Vec::new(), Vec::new());
    let mut judge = |what: &str, measured: usize, most: usize| {
        if measured > most {
            mistakes.push(format!("{what}: {measured}, and at most {most}"));
        }
    };
    for (path, text) in &sources {
        let is_in = |room: &str| path.strip_prefix(room).is_some_and(|rest| rest.starts_with(['/', '.']));
        let rooms = BUDGETS.iter().map(|(room, ..)| *room).filter(|room| is_in(room));
        let room = rooms.max_by_key(|room| room.len()).unwrap_or_else(|| panic!("{path} is in no room of the table"));
        let count = text.lines().count();
        *lines.entry(room).or_insert(0) += count;
        if *path == format!("{room}.rs") || *path == format!("{room}/mod.rs") {
            *shown.entry(room).or_insert(0) += public_names(text);
        } else {
            *hidden.entry(room).or_insert(0) += text.matches("\n#[doc(hidden)]\npub ").count();
        }
        if room.starts_with("core/src") || room.starts_with("macros/derivation/src") {
            of_each.push(count);
        }
        judge(&format!("lines of {path}"), count, LENGTHS[0]);
        judge(&format!("lines of a function in {path}"), longest_function(text), LENGTHS[1]);
    }
    of_each.sort_unstable();
    judge("lines of the median file", of_each[of_each.len() / 2], LENGTHS[2]);
    for (room, most, names) in BUDGETS {
        judge(&format!("lines of {room}"), lines.remove(room).unwrap_or(0), most);
        if room.starts_with("core/src") {
            let public = shown.remove(room).unwrap_or(0) - hidden.remove(room).unwrap_or(0);
            judge(&format!("public names of {room}"), public, names);
        }
    }
    assert!(
        mistakes.is_empty(),
        "{}\nMake it smaller; or write the new number and the reason in the same commit.",
        mistakes.join("\n")
    );
}

fn is_no_letter(letter: char) -> bool {
    !letter.is_alphanumeric() && letter != '_'
}

fn first(text: &str) -> &str {
    text.split(is_no_letter).next().unwrap_or_default()
}

/// The words of what a file imports from its own room.
fn imported<'c>(code: &'c str, room: &str, files: &[&str]) -> BTreeSet<&'c str> {
    let own = room.split_once("/src/").map_or("crate::".to_owned(), |(_, room)| format!("crate::{room}"));
    let trees = code.split(';').filter_map(|statement| Some(statement.rsplit_once("\nuse ")?.1));
    let is_file = |name: &str| files.iter().any(|path| path.contains(&format!("/{name}")));
    let trees = trees.filter(|tree| tree.starts_with("super::") || tree.starts_with(&own) || is_file(first(tree)));
    trees.flat_map(|tree| tree.split(is_no_letter)).collect()
}

/// The name of a file, and those that it defines for others.
fn defined<'c>(path: &'c str, code: &'c str) -> BTreeSet<&'c str> {
    let lines = code.lines().filter(|line| line.starts_with("pub"));
    let items = lines.filter_map(|line| {
        ["struct ", "enum ", "trait ", "type ", "fn ", "const "].iter().find_map(|item| Some(line.split_once(item)?.1))
    });
    let names = items.map(first);
    let file = path.trim_end_matches(".rs").trim_end_matches("/mod").rsplit('/').next();
    names.chain(file).collect()
}

/// The circles of a room: files that import each other, maybe by way of others. A name that several files define counts
/// for none.
fn circles(root: &Path, room: &str, sources: &BTreeMap<String, String>) -> BTreeSet<String> {
    let files: Vec<&str> =
        sources.keys().map(String::as_str).filter(|path| path.starts_with(room) && !path.contains("tests")).collect();
    let codes: Vec<String> = files.iter().map(|path| format!("\n{}", code(&root.join(path)))).collect();
    let names: Vec<_> = files.iter().zip(&codes).map(|(path, code)| defined(path, code)).collect();
    let is_only_one = |name: &&&str| names.iter().filter(|names| names.contains(**name)).count() == 1;
    let imports = |from: usize, to: usize| {
        let words = imported(&codes[from], room, &files);
        from != to && names[to].intersection(&words).any(|name| is_only_one(&name))
    };
    let all = 0..files.len();
    let mut reaches: Vec<Vec<bool>> = all.clone().map(|a| all.clone().map(|b| imports(a, b)).collect()).collect();
    for over in all.clone() {
        for from in all.clone() {
            for to in all.clone() {
                reaches[from][to] |= reaches[from][over] && reaches[over][to];
            }
        }
    }
    let circle =
        |a: usize| -> Vec<&str> { all.clone().filter(|&b| reaches[a][b] && reaches[b][a]).map(|b| files[b]).collect() };
    all.clone().map(|a| circle(a).join(" ")).filter(|circle| !circle.is_empty()).collect()
}

#[test]
fn no_room_has_circles() {
    let Some(root) = root() else { return };
    let sources = sources(root);
    let rooms =
        BUDGETS.iter().map(|(room, ..)| *room).filter(|room| room.contains("/src") || room.matches('/').count() == 1);
    let found: BTreeSet<String> = rooms.flat_map(|room| circles(root, room, &sources)).collect();
    let known: BTreeSet<String> = CIRCLES.iter().map(|files| (*files).to_owned()).collect();
    assert_eq!(found, known, "files import each other (left); who ends a circle takes it out of the list (right)");
}
