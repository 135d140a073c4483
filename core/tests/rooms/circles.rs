//! No circle between the files of a room, in Rust and in Python.
//!
//! A file imports another where it names a path that ends there: in a `use`, within a line, or by a re-export. Behind the
//! last module of a path a name counts for that module, whether its text or a macro defines it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use super::{code, files, root};

/// A path as the list of its names.
type Names = Vec<String>;

fn is_no_letter(letter: char) -> bool {
    !letter.is_alphanumeric() && letter != '_'
}

fn first(text: &str) -> &str {
    text.split(is_no_letter).next().unwrap_or_default()
}

/// All paths in a tree of imports, each with the name that it has in this file.
fn leaves(tree: &str, before: &[String], found: &mut Vec<(Names, String)>) {
    let tree = tree.trim();
    let (head, rest) = tree.split_at(tree.find('{').unwrap_or(tree.len()));
    let (head, alias) = head.split_once(" as ").map_or((head, None), |(head, alias)| (head, Some(alias.trim())));
    let names = head.split("::").map(str::trim).filter(|name| !name.is_empty() && *name != "self");
    let path: Names = before.iter().cloned().chain(names.map(str::to_owned)).collect();
    let Some(inner) = rest.strip_prefix('{').and_then(|rest| rest.strip_suffix('}')) else {
        let last = alias.map(str::to_owned).or_else(|| path.last().cloned());
        found.extend(last.map(|last| (path, last)));
        return;
    };
    let (mut depth, mut start) = (0, 0);
    for (place, letter) in inner.char_indices().chain([(inner.len(), ',')]) {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                if !inner[start..place].trim().is_empty() {
                    leaves(&inner[start..place], &path, found);
                }
                start = place + 1;
            }
            _ => {}
        }
    }
}

/// A source of Rust.
struct Source {
    /// The path of the file's module.
    module: Names,
    /// Whether the file has modules of its own, as `mod.rs` and `lib.rs` have.
    is_page: bool,
    /// The names defined in the file, and those that are public.
    defined: BTreeSet<String>,
    public: BTreeSet<String>,
    /// The file's imports and re-exports, each with the name that it has here.
    imports: Vec<(Names, String)>,
    /// The paths that the file's code uses: those of imports, not of re-exports, and those within lines.
    paths: Vec<Names>,
}

impl Source {
    fn new(path: &str, code: &str) -> Self {
        let (_, own) = path.rsplit_once("src/").unwrap_or(("", path));
        let own = own.trim_end_matches(".rs");
        let is_page = own.ends_with("/mod") || ["mod", "lib", "main"].contains(&own);
        let module = own.split('/').filter(|name| !["mod", "lib", "main"].contains(name));
        let module: Names = module.map(str::to_owned).collect();
        let items =
            ["struct ", "enum ", "union ", "trait ", "type ", "fn ", "const ", "static ", "mod ", "macro_rules! "];
        let lines =
            code.lines().filter(|line| !line.starts_with([' ', '}', '#', ')', ']']) && !line.starts_with("use "));
        let name = |line: &str| items.iter().find_map(|item| Some(first(line.split_once(item)?.1).to_owned()));
        let public = lines.clone().filter(|line| line.starts_with("pub")).filter_map(name).collect();
        let (mut imports, mut paths, mut rest) = (Vec::new(), Vec::new(), String::new());
        for statement in code.split_inclusive(';') {
            let begins = statement.match_indices("use ").map(|(place, _)| place).find(|&place| {
                let before = statement[..place].rsplit('\n').next().unwrap_or_default().trim();
                before.is_empty() || before == "pub" || before.starts_with("pub(")
            });
            let Some(place) = begins else {
                rest.push_str(statement);
                continue;
            };
            let (before, tree) = statement.split_at(place);
            let known = imports.len();
            leaves(tree["use ".len()..].trim_end_matches(';'), &[], &mut imports);
            if before.ends_with('\n') || before.ends_with("    ") || before.is_empty() {
                paths.extend(imports[known..].iter().map(|(path, _)| path.clone()));
            }
            rest.push_str(before);
        }
        paths.extend(within(&rest));
        Self { module, is_page, defined: lines.filter_map(name).collect(), public, imports, paths }
    }
}

/// The paths in a text that begin with a module.
fn within(code: &str) -> Vec<Names> {
    let begins = ["crate::", "super::", "self::"].into_iter().flat_map(|word| code.match_indices(word));
    let begins = begins.filter(|(place, _)| {
        !code[..*place].ends_with(|letter: char| !is_no_letter(letter) || "$:\"".contains(letter))
    });
    begins
        .map(|(place, _)| {
            let rest = &code[place..];
            let end = rest.find(|letter: char| is_no_letter(letter) && letter != ':').unwrap_or(rest.len());
            rest[..end].split("::").filter(|name| !name.is_empty()).map(str::to_owned).collect()
        })
        .collect()
}

/// The sources of a package.
struct Package {
    files: Vec<String>,
    sources: Vec<Source>,
    modules: BTreeMap<Names, usize>,
}

impl Package {
    /// The sources of these texts, by their paths, without comments and tests.
    fn new(texts: &BTreeMap<String, String>) -> Self {
        let sources: Vec<Source> = texts.iter().map(|(path, code)| Source::new(path, code)).collect();
        let modules = sources.iter().enumerate().map(|(at, source)| (source.module.clone(), at)).collect();
        Self { files: texts.keys().cloned().collect(), sources, modules }
    }

    fn below(root: &Path, folder: &str) -> Self {
        let is_test = |path: &String| path.contains("/tests/") || path.ends_with("/tests.rs");
        let files = files(root, folder, "rs").into_iter().filter(|path| !is_test(path));
        let texts = files.map(|path| (path.clone(), code(&root.join(path))));
        Self::new(&texts.collect())
    }

    /// The file to which a path leads from another file, if it is in this package.
    fn resolved(&self, from: usize, path: &[String], depth: usize) -> Option<usize> {
        let source = &self.sources[from];
        let (mut at, mut rest) = (source.module.clone(), path);
        match rest.first()?.as_str() {
            "crate" => (at, rest) = (Names::new(), &rest[1..]),
            "self" => rest = &rest[1..],
            "super" => {
                while let ["super", ..] = rest.iter().map(String::as_str).collect::<Vec<_>>()[..] {
                    at.pop();
                    rest = &rest[1..];
                }
            }
            own => {
                at.push(own.to_owned());
                if !source.is_page || !self.modules.contains_key(&at) {
                    return None;
                }
                rest = &rest[1..];
            }
        }
        while let [name, ..] = rest {
            at.push(name.clone());
            if !self.modules.contains_key(&at) {
                at.pop();
                break;
            }
            rest = &rest[1..];
        }
        let file = *self.modules.get(&at)?;
        let Some(name) = rest.first() else { return Some(file) };
        self.defining(file, name, depth)
    }

    /// The file that defines a name of a module, itself or by its imports.
    fn defining(&self, file: usize, name: &str, depth: usize) -> Option<usize> {
        let source = &self.sources[file];
        if source.defined.contains(name) || depth == 0 {
            return Some(file);
        }
        let named = source.imports.iter().filter(|(_, own)| own == name);
        let found = named.clone().find_map(|(path, _)| self.resolved(file, path, depth - 1));
        if found.is_some() || named.count() > 0 {
            return found;
        }
        let all = source.imports.iter().filter(|(path, _)| path.last().is_some_and(|last| last == "*"));
        let mut all = all.filter_map(|(path, _)| self.resolved(file, &path[..path.len() - 1], depth - 1));
        all.find(|&other| self.sources[other].defined.contains(name)).or(Some(file))
    }

    /// The files that a file imports.
    fn imported(&self, from: usize) -> BTreeSet<usize> {
        let source = &self.sources[from];
        let found = |path: &Names| {
            let to = self.resolved(from, path, 8)?;
            let page = &self.sources[to];
            // A page's helpers for the files below it aren't imports.
            let is_below = page.is_page && source.module.starts_with(&page.module);
            let is_helper = is_below && !path.last().is_some_and(|name| page.public.contains(name));
            (to != from && !is_helper).then_some(to)
        };
        source.paths.iter().filter_map(found).collect()
    }

    /// The circles of a room.
    fn circles(&self, room: &str) -> BTreeSet<String> {
        let is_in = |at: &usize| self.files[*at].starts_with(room);
        let own: Vec<usize> = (0..self.files.len()).filter(is_in).collect();
        let edges = own.iter().map(|&from| (self.files[from].as_str(), self.imported(from)));
        let names = |all: BTreeSet<usize>| all.into_iter().map(|to| self.files[to].as_str()).collect();
        circles(&edges.map(|(from, to)| (from, names(to))).collect())
    }
}

/// The files that import each other, directly or through others.
fn circles(imports: &BTreeMap<&str, BTreeSet<&str>>) -> BTreeSet<String> {
    let mut reached = imports.clone();
    for all in reached.values_mut() {
        let mut open: Vec<&str> = all.iter().copied().collect();
        while let Some(at) = open.pop() {
            open.extend(imports.get(at).into_iter().flatten().filter(|to| all.insert(**to)));
        }
    }
    let circle = |from: &str| -> Vec<&str> {
        reached[from].iter().filter(|to| reached.get(*to).is_some_and(|back| back.contains(from))).copied().collect()
    };
    reached.keys().map(|from| circle(from).join(" ")).filter(|circle| !circle.is_empty()).collect()
}

/// The circles of a folder of Python, whose modules import each other by `from .name import …`.
fn circles_of_python(root: &Path, folder: &str) -> BTreeSet<String> {
    let files = files(root, folder, "py");
    let texts: Vec<String> = files.iter().map(|path| fs::read_to_string(root.join(path)).unwrap()).collect();
    let names = |line: &str| -> Vec<String> {
        let Some(rest) = line.trim().strip_prefix("from .") else { return Vec::new() };
        match rest.strip_prefix(" import ") {
            Some(modules) => modules.split(',').map(|name| first(name.trim()).to_owned()).collect(),
            None => vec![first(rest).to_owned()],
        }
    };
    let imported = |text: &String| -> BTreeSet<&str> {
        let names: Vec<String> = text.lines().flat_map(names).collect();
        let is_meant = |path: &&String| names.iter().any(|name| **path == format!("{folder}/{name}.py"));
        files.iter().filter(is_meant).map(String::as_str).collect()
    };
    circles(&files.iter().map(String::as_str).zip(texts.iter().map(imported)).collect())
}

/// The folders in a folder that have these sources.
fn folders(root: &Path, folder: &str, has: &str) -> Vec<String> {
    let paths = fs::read_dir(root.join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let names = paths.filter(|path| path.join(has).is_dir()).map(|path| path.file_name().unwrap().to_owned());
    names.map(|name| format!("{folder}/{}", name.to_str().unwrap())).collect()
}

#[test]
fn no_room_has_circles() {
    let Some(root) = root() else { return };
    let mut found = BTreeSet::new();
    // Each folder of these two packages is a room; any other package is one room.
    for sources in ["core/src", "macros/derivation/src"] {
        let package = Package::below(root, sources);
        found.extend(folders(root, sources, ".").iter().flat_map(|room| package.circles(&format!("{room}/"))));
    }
    for package in folders(root, "core", "src") {
        found.extend(Package::below(root, &format!("{package}/src")).circles(""));
    }
    found.extend(circles_of_python(root, "core/python/python/liestep"));
    assert!(found.is_empty(), "files import each other: {found:?}");
}

/// A circle of two files is found for each way in which one defines a name and the other imports it.
#[test]
fn a_circle_is_found_however_a_name_is_made_and_imported() {
    let found = |texts: &[(&str, &str)]| {
        let texts = texts.iter().map(|(path, code)| (format!("a/src/{path}"), (*code).to_owned()));
        Package::new(&texts.collect()).circles("")
    };
    let page = ("lib.rs", "mod one;\nmod two;\npub use one::One;\npub use two::*;\n");
    let of_macro = "macro_rules! table {\n    ($name:ident) => { pub struct $name; };\n}\ntable!(Two);\n";
    let circle = BTreeSet::from(["a/src/one.rs a/src/two.rs".to_owned()]);
    for defined in ["pub struct Two;\n", "pub(crate) fn Two() {}\n", of_macro] {
        for import in [
            "use crate::two::Two;\n",
            "use crate::{two::{Other, Two as T}};\n",
            "use super::two::{self, Two};\n",
            "fn of() {\n    use crate::two::Two;\n}\n",
            "fn of() -> crate::two::Two {}\n",
            "fn of(two: super::two::Two) {}\n",
        ] {
            let one = format!("{import}pub struct One;\n");
            for back in ["use crate::one::One;\n", "use crate::One;\n", "type Of = super::One;\n"] {
                let two = format!("{back}{defined}");
                assert_eq!(found(&[page, ("one.rs", &one), ("two.rs", &two)]), circle, "{one}{two}");
            }
            assert_eq!(found(&[page, ("one.rs", &one), ("two.rs", defined)]), BTreeSet::new(), "{one}");
        }
    }
    // A page may re-export the names of files below it and have helpers for them; these files may not import its public
    // names.
    let [helper, public] =
        ["fn help() {}\n", "pub fn help() {}\n"].map(|item| format!("mod one;\nuse one::One;\n{item}"));
    let one = ("one.rs", "use super::help;\npub struct One;\n");
    assert_eq!(found(&[("lib.rs", &helper), one]), BTreeSet::new());
    assert_eq!(found(&[("lib.rs", &public), one]), BTreeSet::from(["a/src/lib.rs a/src/one.rs".to_owned()]));
}
