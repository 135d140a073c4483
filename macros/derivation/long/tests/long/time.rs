//! Times of expansions, which a user mustn't notice.

use std::fs;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::Path;
use std::time::{Duration, Instant};

use proc_macro2::TokenStream;
use quote::ToTokens as _;
use syn::visit_mut::VisitMut;

use crate::common::{HEAVY_TOP, arguments_and_struct, expanded, top};
use liestep_derivation::declared::Role;

/// The times of some expansions, the shortest first: longer ones include work of other programs.
fn times(count: usize, arguments: &str, item: &str) -> Vec<Duration> {
    let mut times: Vec<Duration> = (0..count)
        .map(|_| {
            let start = Instant::now();
            drop(expanded(arguments, item));
            start.elapsed()
        })
        .collect();
    times.sort();
    println!("median {:?}", times[count / 2]);
    times
}

#[test]
#[ignore = "a time, for a quiet machine: `cargo test -p liestep-derivation-long-tests time:: -- --ignored --nocapture`"]
fn the_heavy_top_expands_quickly() {
    let times = times(50, HEAVY_TOP, &top("NonstandardInertia"));
    assert!(times[0] <= Duration::from_millis(50), "{times:?}");
}

#[test]
#[ignore = "a time, for a quiet machine: `cargo test -p liestep-derivation-long-tests time:: -- --ignored --nocapture`"]
fn the_sixth_order_top_expands_within_a_second() {
    let (arguments, item) =
        arguments_and_struct(include_str!("../../../../../examples/declarations/sixth_order_top.rs"));
    let times = times(5, arguments, item);
    assert!(times[0] <= Duration::from_secs(1), "{times:?}");
}

/// Every declaration below a folder of the repository: where it is, the role, arguments and the item.
pub(crate) fn declarations_in(folder: &Path, found: &mut Vec<(String, Role, TokenStream, TokenStream)>) {
    struct Finder<'a>(&'a Path, &'a mut Vec<(String, Role, TokenStream, TokenStream)>);

    impl VisitMut for Finder<'_> {
        fn visit_item_struct_mut(&mut self, item: &mut syn::ItemStruct) {
            let role = |attribute: &syn::Attribute| match attribute.path().segments.last()?.ident.to_string().as_str() {
                "lagrangian" => Some(Role::Lagrangian),
                "force" => Some(Role::Force),
                "constraint" => Some(Role::Constraint),
                _ => None,
            };
            if let Some(at) = item.attrs.iter().position(|attribute| role(attribute).is_some()) {
                let attribute = item.attrs.remove(at);
                let role = role(&attribute).expect("it has one");
                let syn::Meta::List(list) = attribute.meta else { return };
                let name = format!("{} in {}", item.ident, self.0.display());
                self.1.push((name, role, list.tokens, item.to_token_stream()));
            }
        }
    }

    let mut entries: Vec<_> =
        fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            // Folders of mistakes and of build outputs are left out.
            if !path.ends_with("tests/ui") && !path.ends_with("target") {
                declarations_in(&path, found);
            }
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).expect("text");
            let mut file = syn::parse_file(&text).expect("Rust");
            Finder(&path, found).visit_file_mut(&mut file);
        }
    }
}

/// Prints the time of each declaration's expansion, the slowest last. A declaration within a macro isn't seen.
#[test]
#[ignore = "measures all declarations of the repository, a minute: `cargo test -p liestep-derivation-long-tests every_declaration -- --ignored --nocapture`"]
fn every_declaration_of_the_repository_expands_the_same_twice() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let mut found = Vec::new();
    for folder in ["core/src", "examples", "tests"] {
        declarations_in(&root.join(folder), &mut found);
    }
    assert!(found.len() > 50, "only {} declarations found", found.len());
    // The digest of all expansions, to be compared before and after a change that should change nothing.
    let mut digest = DefaultHasher::new();
    let mut times: Vec<(Duration, String)> = found
        .into_iter()
        .map(|(name, role, arguments, item)| {
            let start = Instant::now();
            let first = liestep_derivation::expand(role, arguments.clone(), &item).to_string();
            let once = start.elapsed();
            let start = Instant::now();
            let second = liestep_derivation::expand(role, arguments, &item).to_string();
            assert!(first == second, "{name} expands differently");
            assert!(!first.contains("compile_error"), "{name} is refused");
            first.hash(&mut digest);
            (once.min(start.elapsed()), name)
        })
        .collect();
    times.sort();
    for (time, name) in &times {
        println!("{:8.1} ms  {name}", time.as_secs_f64() * 1e3);
    }
    let median = times[times.len() / 2].0;
    println!("{} declarations, median {median:?}, digest {:016x}", times.len(), digest.finish());
}
