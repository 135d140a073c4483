//! The rooms of `lib.rs`: the direction of their imports, and the rooms that use tokens.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::common::{HEAVY_TOP, expanded, is_refused, tokens, top};
use liestep_derivation::declared::Role;

/// Every source: its path from `src`, and its code without comments.
fn sources() -> BTreeMap<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut open, mut sources) = (vec![root.clone()], BTreeMap::new());
    while let Some(path) = open.pop() {
        if path.is_dir() {
            let entries = std::fs::read_dir(path).expect("a directory");
            let paths = entries.map(|entry| entry.expect("an entry").path());
            open.extend(paths);
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("text");
        let code: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
        let name: Vec<String> = path.strip_prefix(&root).expect("below src").iter().map(text_of).collect();
        sources.insert(name.join("/"), code.join("\n"));
    }
    assert!(sources.len() > 30);
    sources
}

fn text_of(part: &std::ffi::OsStr) -> String {
    part.to_string_lossy().into_owned()
}

/// The room of a source, as `judged` of `judged/verify/mod.rs` and `expand` of `expand.rs`.
fn room(file: &str) -> &str {
    file.split('/').next().unwrap_or_default().trim_end_matches(".rs")
}

/// The floor of each room, from below, as `lib.rs` states it.
fn floors() -> BTreeMap<String, usize> {
    let page = include_str!("../../src/lib.rs");
    let line = page.lines().find_map(|line| line.strip_prefix("//! `lib →")).expect("the direction of dependency");
    let floors = line.trim_end_matches('`').split('→').rev().enumerate();
    let rooms = |(floor, rooms): (usize, &'static str)| {
        rooms.split(',').map(move |room| (room.trim_matches([' ', '{', '}']).to_owned(), floor))
    };
    floors.flat_map(rooms).chain([("lib".to_owned(), usize::MAX)]).collect()
}

/// The first names of all paths that begin with `crate`.
fn named(code: &str) -> BTreeSet<&str> {
    let mut names = BTreeSet::new();
    for (_, rest) in code.match_indices("crate::").map(|(at, found)| code.split_at(at + found.len())) {
        let group = rest.strip_prefix('{').and_then(|inner| inner.split("};").next());
        for path in group.map_or(vec![rest], |group| group.split(',').collect()) {
            names.extend(path.trim().split(|c: char| !c.is_alphanumeric() && c != '_').next());
        }
    }
    names
}

#[test]
fn depend_in_one_direction() {
    let floors = floors();
    for (file, code) in sources() {
        let room = room(&file);
        let floor = floors.get(room).unwrap_or_else(|| panic!("{room} has no place in lib.rs"));
        for other in named(&code).into_iter().filter(|other| *other != room) {
            let below = floors.get(other).unwrap_or_else(|| panic!("{file}: crate::{other} isn't a room"));
            assert!(below < floor, "{file}: {room} may not know {other}");
        }
        // Paths with `super` stay in the room of their file.
        let depth = file.split('/').count() - usize::from(file.ends_with("/mod.rs"));
        assert!(!code.contains(&"super::".repeat(depth)) || !file.contains('/'), "{file}: `super` leaves {room}");
    }
}

#[test]
fn tokens_are_quoted_in_one_room() {
    let only = |what: &[&str], rooms: &[&str]| {
        for (file, code) in sources().iter().filter(|(file, _)| !rooms.contains(&room(file))) {
            let found = what.iter().find(|what| code.contains(**what));
            assert!(found.is_none(), "{file}: {found:?} belongs in {rooms:?}");
        }
    };
    only(&["quote!", "format_ident!"], &["emit"]);
    // The room `declared` writes tokens too, as a pace rewrites the declared text.
    only(&["quote_spanned!"], &["declared", "emit"]);
    only(&["syn::"], &["declared", "emit"]);
    only(&["Span"], &["declared", "judged", "emit"]);
    only(&["TokenStream", "proc_macro"], &["declared", "judged", "emit", "expand", "staged", "lib"]);
}

/// Expansions name paths below `__private` alone, so that public names may move.
#[test]
fn expansions_name_the_private_module_alone() {
    let emitted = sources().into_iter().filter(|(file, _)| room(file) == "emit").map(|(_, code)| code);
    let roots = emitted.flat_map(|code| code.split("#root").skip(1).map(str::to_owned).collect::<Vec<_>>());
    assert!(roots.map(|rest| assert!(rest.starts_with("::__private"), "{rest}")).count() > 0);
    let work = "group = SO3, work = exp(a).trace() * log(F).dot(&(inverse(J) * eta))";
    let force =
        liestep_derivation::expand(Role::Force, tokens(work), &tokens("struct Push { a: Vector3<f64>, J: Inertia }"));
    let held = liestep_derivation::expand(
        Role::Constraint,
        tokens(
            "group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected(Q = F_2.seen_from(F_1), r = d_2.seen_from(d_1)),
            zero = (r.dot(&(A * r)) - l, vee(Q), exp(r).trace())",
        ),
        &tokens("struct Held { A: Matrix3<f64>, l: f64 }"),
    );
    let generic =
        "struct Top<T: Real> { J_d: DiagonalNonstandardInertia<T>, m: T, g: T, rho: Vector3<T>, up: Vector3<T> }";
    let planar =
        "group = SE2, advected(w = up, p = P, c = C), l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h)
        + h * w.dot(&p) * (c * inverse(F)).trace()";
    let fields = "struct Planar { J: Matrix3<f64>, up: Point2<f64>, P: Vector3<f64>, C: MixedTensor<f64, 3> }";
    let (heavy, planar) = (expanded(HEAVY_TOP, generic), expanded(planar, fields));
    let refused = expanded("group = SO3, l_d = rho", &top("Inertia"));
    for (expansion, refused) in [(force, false), (held, false), (heavy, false), (planar, false), (refused, true)] {
        assert_eq!(is_refused(&expansion), refused, "{expansion}");
        let text = expansion.to_string();
        let mut named = text.split("liestep ::").skip(1);
        assert!(named.all(|rest| rest.starts_with(" __private ::")), "{text}");
    }
}

/// Every public function of a room is used in the crate: rooms are public for these tests, so the compiler doesn't
/// report one that tests alone use.
#[test]
fn what_a_room_makes_public_is_used_in_the_crate() {
    let is_letter = |letter: char| letter.is_alphanumeric() || letter == '_';
    let without_exports = |code: &String| {
        let statements = code.split_inclusive(';').map(|statement| match statement.find("pub use ") {
            Some(place) => statement[..place].to_owned(),
            None => statement.to_owned(),
        });
        statements.collect::<String>()
    };
    let codes: Vec<(String, String)> =
        sources().into_iter().map(|(file, code)| (file, without_exports(&code))).collect();
    let mut uses: BTreeMap<&str, usize> = BTreeMap::new();
    for word in codes.iter().flat_map(|(_, code)| code.split(|letter| !is_letter(letter))) {
        *uses.entry(word).or_default() += 1;
    }
    let items = ["fn ", "const ", "struct ", "enum ", "trait ", "type "].map(|item| format!("pub {item}"));
    let hidden = |file: &str| ["declared", "judged", "mathematics", "program"].contains(&room(file));
    let of_rooms = codes.iter().filter(|(file, _)| hidden(file));
    let names = of_rooms.flat_map(|(_, code)| code.lines()).filter_map(|line| {
        let rest = items.iter().find_map(|item| line.trim_start().strip_prefix(item.as_str()))?;
        rest.trim_start_matches("fn ").split(|letter| !is_letter(letter)).next()
    });
    let unused: Vec<&str> = names.filter(|name| uses[name] < 2).collect();
    assert_eq!(unused, Vec::<&str>::new());
}

/// No source has a hash map or a hash set: their order differs from run to run, which no repetition in one process
/// shows for sure.
#[test]
fn nothing_is_hashed() {
    for (file, code) in sources() {
        assert!(!code.contains("HashMap") && !code.contains("HashSet"), "{file}");
    }
}
