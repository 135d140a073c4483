//! The rooms of the sources import each other in one direction; and names, files and commands in the guide and README
//! exist.

#[path = "rooms/circles.rs"]
mod circles;
#[path = "rooms/scale.rs"]
mod scale;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The rooms that each room may import, as `src/lib.md` draws them. Documentation may name everything.
const MAY_IMPORT: [(&str, &[&str]); 16] = [
    ("error", &[]),
    ("numbers", &[]),
    ("groups", &["numbers"]),
    ("mechanics", &["error", "numbers", "groups"]),
    ("effects", &["error", "numbers", "groups", "mechanics"]),
    ("solving", &["error", "numbers", "groups", "mechanics"]),
    ("motion", &["error", "numbers", "groups", "mechanics", "solving"]),
    ("gradients", &["error", "numbers", "groups", "mechanics", "motion"]),
    ("methods", &["error", "numbers", "groups", "mechanics", "effects", "solving", "motion", "gradients"]),
    ("recording", &["error", "numbers", "groups", "mechanics", "motion", "methods"]),
    ("with", &["error", "numbers", "groups", "mechanics", "motion", "methods"]),
    ("accuracy", &["error", "numbers", "groups", "mechanics", "motion", "methods", "with"]),
    ("laws", &["numbers", "groups"]),
    ("conventions", &[]),
    ("guide", &[]),
    ("prelude", &["error", "groups", "mechanics", "effects", "motion"]),
];

/// The code of a file: neither comments nor tests, which stand at its end or in files of their own.
fn code(path: &Path) -> String {
    without_tests(&fs::read_to_string(path).unwrap())
}

fn without_tests(text: &str) -> String {
    let mut lines = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    let mut code = Vec::new();
    while let Some(line) = lines.next() {
        if line != "#[cfg(test)]" {
            code.push(line);
        } else if !lines.find(|line| !line.starts_with("#[")).is_some_and(|item| item.ends_with(';')) {
            break;
        }
    }
    code.join("\n")
}

#[test]
fn tests_are_no_code() {
    let text = "mod one;\n#[cfg(test)]\n#[path = \"tests.rs\"]\nmod tests;\n// A comment.\nfn two() {}\n\n#[cfg(test)]\nmod of_two {\n}\n";
    assert_eq!(without_tests(text), "mod one;\nfn two() {}\n");
}

/// The rooms in a text, by its paths that begin with `crate::`.
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
    // Tests may import any room.
    if path.extension().is_none_or(|extension| extension != "rs") || path.ends_with("tests.rs") {
        return;
    }
    let code = code(path);
    let (_, allowed) = MAY_IMPORT.iter().find(|(name, _)| *name == room).unwrap();
    for other in named(&code) {
        // A list of imports behind `crate::` has the macros of the crate's root.
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
        let has_sources = path.join("mod.rs").exists() || path.extension().is_some_and(|extension| extension == "rs");
        // The root and `private` are above all rooms; pictures are in none.
        if has_sources && name != "lib" && name != "private" {
            check(&name, &path, &mut mistakes);
            rooms.insert(name);
        }
    }
    assert!(mistakes.is_empty(), "{}", mistakes.join("\n"));
    assert_eq!(rooms, MAY_IMPORT.iter().map(|(name, _)| (*name).to_owned()).collect());
    // The table is in order: a room imports only rooms below it.
    for (place, (name, allowed)) in MAY_IMPORT.iter().enumerate() {
        for other in *allowed {
            assert!(MAY_IMPORT[..place].iter().any(|(below, _)| below == other), "`{name}` is below `{other}`");
        }
    }
}

/// The root of the repository, which a published package doesn't have.
fn root() -> Option<&'static Path> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent()?;
    if root.join(".ci/run").exists() {
        return Some(root);
    }
    println!("skipped: there is no repository around this package");
    None
}

/// The files of a folder and its subfolders with this extension, by their paths from the root, without build outputs.
fn files(root: &Path, folder: &str, extension: &str) -> Vec<String> {
    let (mut open, mut files) = (vec![root.join(folder)], Vec::new());
    while let Some(path) = open.pop() {
        if path.is_dir() {
            let paths = fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path());
            open.extend(paths.filter(|path| !path.ends_with("target") && !path.ends_with(".git")));
        } else if path.extension().is_some_and(|own| own == extension) {
            files.push(path.strip_prefix(root).unwrap().to_str().unwrap().replace('\\', "/"));
        }
    }
    files.sort();
    files
}

/// The texts between backquotes.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.lines().flat_map(|line| line.split('`').skip(1).step_by(2))
}

/// The chapters of the guide by name, with their text.
fn chapters() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/guide");
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    files
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"))
        .map(|path| (path.file_stem().unwrap().to_str().unwrap().to_owned(), fs::read_to_string(path).unwrap()))
        .collect()
}

#[test]
fn the_guide_and_readme_name_files_that_there_are() {
    let Some(root) = root() else { return };
    let mut pages = chapters();
    pages.push(("README".to_owned(), fs::read_to_string(root.join("README.md")).unwrap()));
    let mut named = 0;
    for (page, text) in &pages {
        for word in quoted(text) {
            let is_path = ["core/", "macros/", "examples/", "tests/"].iter().any(|room| word.starts_with(room));
            if is_path && !word.contains([' ', '*']) {
                assert!(root.join(word).exists(), "{page} names {word}");
                named += 1;
            }
        }
    }
    assert!(named > 40, "{named} paths are named");
}

/// Tables on pages have a head: an empty one is displayed as an empty bar.
#[test]
fn tables_have_heads() {
    let Some(root) = root() else { return };
    let mut pages = vec!["README.md".to_owned(), "CONTRIBUTING.md".to_owned()];
    for folder in ["core", "macros", "examples", "tests"] {
        pages.extend(["md", "rs"].iter().flat_map(|extension| files(root, folder, extension)));
    }
    let mut tables = 0;
    for page in pages {
        let text = fs::read_to_string(root.join(&page)).unwrap();
        let is_page = page.rsplit_once('.').is_some_and(|(_, extension)| extension == "md");
        let lines: Vec<&str> = text
            .lines()
            .map(|line| line.trim_start().trim_start_matches("///").trim_start_matches("//!").trim())
            .collect();
        for (number, pair) in lines.windows(2).enumerate().filter(|(_, pair)| pair[1].starts_with("|---")) {
            assert!(pair[0].contains(char::is_alphabetic), "{page}:{}: a table without a head", number + 1);
            tables += usize::from(is_page);
        }
    }
    assert!(tables > 50, "{tables} tables are on pages");
}

#[test]
fn every_chapter_is_listed_and_leads_on() {
    let chapters = chapters();
    let (_, list) = chapters.iter().find(|(name, _)| name == "README").unwrap();
    for (name, text) in chapters.iter().filter(|(name, _)| name != "README") {
        assert!(list.contains(&format!("| [`{name}`] |")), "the list has no {name}");
        assert!(text.lines().count() <= 400, "{name} is too long to be read at once");
    }
    // The links from chapter to chapter lead from the first to the last, each once; the chapter for readers of the
    // thesis stands before them.
    let mut left: BTreeSet<&str> = chapters.iter().map(|(name, _)| name.as_str()).collect();
    left.remove("README");
    left.remove("thesis");
    let mut now = "first_program";
    loop {
        assert!(left.remove(now), "{now} is led to twice, or isn't there");
        let (_, text) = chapters.iter().find(|(name, _)| name == now).unwrap();
        let before = now;
        let Some(following) = next(text) else { break };
        now = following;
        let (_, text) =
            chapters.iter().find(|(name, _)| name == now).unwrap_or_else(|| panic!("{before} leads to {now}"));
        assert_eq!(leads(text, "Before: ["), Some(before), "{now} doesn't lead back");
    }
    assert_eq!((now, left), ("inside", BTreeSet::new()));
}

fn next(chapter: &str) -> Option<&str> {
    leads(chapter, "Next: [")
}

/// The chapter that the head of another chapter links to, behind this word.
fn leads<'t>(chapter: &'t str, word: &str) -> Option<&'t str> {
    let (_, rest) = chapter.lines().take(5).find_map(|line| line.split_once(word))?;
    let (_, rest) = rest.split_once("](super::")?;
    Some(rest.split_once(')')?.0)
}

/// A command of cargo: its subcommand, its packages and targets, and whether it is for the whole workspace.
struct Cargo<'t> {
    verb: &'t str,
    flags: Vec<(&'t str, &'t str)>,
    is_workspace: bool,
}

impl<'t> Cargo<'t> {
    fn read(line: &'t str) -> Option<Self> {
        const FLAGS: [&str; 6] = ["-p", "--test", "--bin", "--bench", "--example", "--manifest-path"];
        let words: Vec<&str> = line.split_whitespace().take_while(|word| *word != "--").collect();
        let place = words.iter().position(|word| *word == "cargo")?;
        let [_, verb, ref own @ ..] = words[place..] else { return None };
        let pairs = own.windows(2).filter(|pair| FLAGS.contains(&pair[0]));
        let is_workspace = own.contains(&"--workspace");
        Some(Self { verb, flags: pairs.map(|pair| (pair[0], pair[1])).collect(), is_workspace })
    }

    /// Whether this command includes the other one; `lock` has the names of the packages.
    fn has_run(&self, other: &Self, lock: &str) -> bool {
        let all = |(flag, value): &(&str, &str)| match *flag {
            "-p" => self.is_workspace && lock.contains(&format!("name = \"{value}\"\n")),
            "--test" | "--bin" => self.is_workspace && self.verb == "test",
            _ => false,
        };
        self.verb == other.verb
            && (self.is_workspace || !other.is_workspace)
            && self.flags.iter().all(|flag| other.flags.contains(flag))
            && other.flags.iter().all(|flag| self.flags.contains(flag) || all(flag))
    }
}

#[test]
fn a_command_is_run_by_one_of_its_packages_and_targets() {
    let lock = "name = \"liestep\"\nname = \"liestep-tests\"\n";
    let has_run = |one: &str, other: &str| Cargo::read(one).unwrap().has_run(&Cargo::read(other).unwrap(), lock);
    let all = "cargo test --locked --workspace";
    assert!(has_run(all, "LIESTEP=1 cargo test -p liestep-tests --test robustness -- inputs"));
    assert!(has_run("cargo doc --workspace", "cargo doc --open -p liestep --all-features"));
    assert!(has_run("cargo run --locked --example heavy-top -- --time 2", "cargo run --example heavy-top"));
    for (one, other) in [
        (all, "cargo test -p liestep-other"),
        (all, "cargo doc -p liestep"),
        (all, "cargo test --manifest-path other/Cargo.toml"),
        ("cargo doc -p liestep", "cargo doc -p liestep-tests"),
        ("cargo clippy -p liestep", "cargo clippy --workspace"),
        ("cargo test -p liestep --test rooms", "cargo test -p liestep"),
        ("cargo test -p liestep", "cargo test"),
        ("cargo run --example heavy-top", "cargo run --example heavy-tops"),
    ] {
        assert!(!has_run(one, other), "{one}: {other}");
    }
}

/// Continuous integration runs the commands of README and of the examples' page, but for those that the page lists as
/// long.
#[test]
fn commands_of_readme_are_run_or_said_to_be_long() {
    let Some(root) = root() else { return };
    let [readme, examples] =
        ["README.md", "examples/README.md"].map(|page| fs::read_to_string(root.join(page)).unwrap());
    let lock = fs::read_to_string(root.join("Cargo.lock")).unwrap();
    // Calls of `built` in the script are examples of the workspace, which are built and run.
    let script = fs::read_to_string(root.join(".ci/run")).unwrap();
    let script: Vec<String> =
        script.lines().map(|line| line.replacen("built ", "cargo run --workspace --example ", 1)).collect();
    let are_run: Vec<Cargo<'_>> = script.iter().filter_map(|line| Cargo::read(line)).collect();
    let (_, list) = examples.split_once("`.ci/run` runs these commands and those").unwrap();
    let list = list.split("\n\n").next().unwrap();
    let long: Vec<&str> = quoted(list).collect();
    let pages = format!("{readme}{examples}");
    let blocks =
        pages.split("```sh\n").skip(1).filter_map(|rest| rest.split_once("```")).flat_map(|(block, _)| block.lines());
    let mut found = 0;
    for text in quoted(&pages).chain(blocks.map(|line| line.split('#').next().unwrap_or(line))) {
        let Some(command) = Cargo::read(text) else { continue };
        if long.iter().any(|long| text.contains(long)) {
            continue;
        }
        assert!(are_run.iter().any(|other| other.has_run(&command, &lock)), "`{text}` isn't in .ci/run");
        found += 1;
    }
    assert!(found >= 6, "{found} commands were found");
}
