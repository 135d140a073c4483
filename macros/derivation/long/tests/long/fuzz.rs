//! Every text expands to an error message or to items: no panic, no hang.

use std::time::{Duration, Instant};

use proptest::prelude::*;

use crate::common::{HEAVY_TOP, expand, is_refused, tokens, top};

/// Far more than any accepted declaration needs without optimisation.
const PATIENCE: Duration = Duration::from_secs(5);

/// The parts of random texts: tokens, and phrases with a tilde between them.
const WORDS: &str = r#"
    F I h w up rho J_d m g k A group generators SO3 < > f64 "SO3" advected l_d crate = , + - * / ! & . .. ; : :: ? |
    # 'a let if else match move unsafe async mut ref as return break loop true _ r#type self super 0 1 2 3 0.5 2.0
    1e300 1e-9 3f32 2.0f64 'c' "s" b"s" 0x1F trace transpose dot cross cross_matrix component_mul norm norm_squared
    powi sqrt ln exp sin cos clone vee x y z ()"#;
const PHRASES: &str = "( F ) ~ ( & w ) ~ ( 2 ) ~ ( - 3 ) ~ [ 0 ] ~ [ ( 1 , 2 ) ] ~ [ 9 ] ~ { } ~ { 1.0 } ~ { let a = F ; a } ~ . trace ( ) ~ . transpose ( ) ~ . dot ( & w ) ~ . powi ( 3 ) ~ . sqrt ( ) ~ . x ~ . 0 ~ ( F * J_d ) ~ 1.0 / h ~ w . dot ( & ( F * rho ) )";

fn word() -> impl Strategy<Value = &'static str> {
    let words = WORDS.split_whitespace().chain(PHRASES.split(" ~ "));
    proptest::sample::select(words.collect::<Vec<_>>())
}

/// The tokens of a declaration with brackets apart, so that mutations can't unbalance them beyond repair.
pub(crate) fn pieces(text: &str) -> Vec<String> {
    let spaced: String =
        text.chars().map(|c| if "()[]{},;=+-*/&".contains(c) { format!(" {c} ") } else { c.to_string() }).collect();
    spaced.split_whitespace().map(str::to_owned).collect()
}

/// Drops unmatched closing brackets, and closes open ones.
pub(crate) fn balanced(pieces: &[String]) -> String {
    let (mut open, mut text) = (Vec::new(), String::new());
    for piece in pieces {
        let closing = match piece.as_str() {
            "(" => Some(")"),
            "[" => Some("]"),
            "{" => Some("}"),
            _ => None,
        };
        open.extend(closing);
        if [")", "]", "}"].contains(&piece.as_str()) {
            if open.last() != Some(&piece.as_str()) {
                continue;
            }
            open.pop();
        }
        text.push_str(piece);
        text.push(' ');
    }
    open.iter().rev().for_each(|closing| text.push_str(closing));
    text
}

/// A change of a text: a piece deleted, duplicated, exchanged with another or replaced.
#[derive(Clone, Debug)]
pub(crate) enum Mutation {
    Delete(usize),
    Duplicate(usize),
    Exchange(usize, usize),
    Replace(usize, &'static str),
    Insert(usize, &'static str),
}

pub(crate) fn mutation() -> impl Strategy<Value = Mutation> {
    prop_oneof![
        any::<usize>().prop_map(Mutation::Delete),
        any::<usize>().prop_map(Mutation::Duplicate),
        (any::<usize>(), any::<usize>()).prop_map(|(a, b)| Mutation::Exchange(a, b)),
        (any::<usize>(), word()).prop_map(|(at, word)| Mutation::Replace(at, word)),
        (any::<usize>(), word()).prop_map(|(at, word)| Mutation::Insert(at, word)),
    ]
}

pub(crate) fn mutated(text: &str, mutations: &[Mutation]) -> String {
    let mut all = pieces(text);
    for mutation in mutations {
        let length = all.len().max(1);
        match *mutation {
            Mutation::Delete(at) => drop(all.remove(at % length)),
            Mutation::Duplicate(at) => all.insert(at % length, all[at % length].clone()),
            Mutation::Exchange(a, b) => all.swap(a % length, b % length),
            Mutation::Replace(at, word) => word.clone_into(&mut all[at % length]),
            Mutation::Insert(at, word) => all.insert(at % length, word.to_owned()),
        }
    }
    balanced(&all)
}

fn survives(arguments: &str, item: &str) {
    // Texts that no lexer accepts never reach a macro.
    let (Ok(arguments), Ok(item)) = (arguments.parse(), item.parse::<proc_macro2::TokenStream>()) else { return };
    let start = Instant::now();
    // A text that isn't an item is returned unchanged, and the compiler reports it.
    let expansion = expand(arguments, &item);
    if syn::parse2::<syn::Item>(item.clone()).is_ok() {
        is_refused(&expansion);
    } else {
        assert_eq!(expansion.to_string(), item.to_string());
    }
    assert!(start.elapsed() < PATIENCE, "{:?}", start.elapsed());
}

pub(crate) const RICH: &str = "group = SO3, advected(w = up, b = field), crate = ::liestep, l_d = {
    let d = F - I; let tip = F * rho;
    (d * J_d * d.transpose()).trace() / (2.0 * h) - h * k * (w.dot(&tip).powi(2) / 3.0 + (3.0 + b.dot(&tip)).ln())
        + h * vee(F * A).dot(&w.cross(&b)) - h * tip[2] * F[(0, 1)] * w.x + h * (A - F).norm_squared()
        + h * k * (w.component_mul(&b).dot(&tip) - w.dot(&rho)).sin()
}";
const RICH_ITEM: &str = "pub struct Rich<T: Real> { J_d: NonstandardInertia<T>, A: Matrix3<T>, k: T,
    pub rho: Vector3<T>, up: Vector3<T>, field: Vector3<T> }";

proptest! {
    #![proptest_config(ProptestConfig { cases: 3_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn token_soup(soup in proptest::collection::vec(word(), 0..40)) {
        survives(&soup.join(" "), &top("NonstandardInertia"));
    }

    #[test]
    fn soup_as_a_lagrangian(soup in proptest::collection::vec(word(), 0..25)) {
        survives(&format!("group = SO3, advected(w = up), l_d = {}", soup.join(" ")), &top("NonstandardInertia"));
    }

    #[test]
    fn mutated_heavy_top(mutations in proptest::collection::vec(mutation(), 1..4)) {
        survives(&mutated(HEAVY_TOP, &mutations), &top("DiagonalNonstandardInertia"));
    }

    #[test]
    fn mutated_item(mutations in proptest::collection::vec(mutation(), 1..4)) {
        survives(HEAVY_TOP, &mutated(&top("NonstandardInertia"), &mutations));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutated_rich_declaration(mutations in proptest::collection::vec(mutation(), 1..4)) {
        survives(&mutated(RICH, &mutations), RICH_ITEM);
    }
}

/// The seeds of the mutations are right declarations: otherwise the test would reach error paths only.
#[test]
fn the_seeds_are_accepted() {
    assert!(!is_refused(&expand(tokens(HEAVY_TOP), &tokens(&top("NonstandardInertia")))));
    let rich = expand(tokens(RICH), &tokens(RICH_ITEM));
    assert!(!is_refused(&rich), "{rich}");
    assert!(!is_refused(&expand(tokens(&mutated(RICH, &[])), &tokens(RICH_ITEM))));
}
