//! A list of errors, so that one compilation reports all mistakes of a declaration.

use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use quote::ToTokens;

/// A mistake of a declaration, at its place in the text.
#[derive(Clone, Debug)]
pub struct Mistake {
    /// The mistake, then the correction.
    pub message: String,
    /// The first token of the mistake.
    pub span: Span,
}

/// The mistakes found so far.
#[derive(Debug, Default)]
pub struct Errors {
    list: Vec<syn::Error>,
    /// Whether a mistake makes the expression meaningless.
    hides_the_rest: bool,
}

impl Errors {
    /// Adds a mistake at a token; the message states the mistake, then the correction.
    pub fn push(&mut self, span: Span, message: impl std::fmt::Display) {
        self.list.push(syn::Error::new(span, message));
    }

    /// Adds a mistake that changes the meaning of the expression: errors found there would only follow from it.
    pub fn push_decisive(&mut self, span: Span, message: impl std::fmt::Display) {
        self.push(span, message);
        self.hides_the_rest = true;
    }

    /// Adds a mistake that extends from one token to another.
    pub fn push_between(&mut self, [first, last]: [Span; 2], message: impl std::fmt::Display) {
        let ends = [first, last].map(|span| TokenTree::Ident(Ident::new("_", span)));
        self.push_over(TokenStream::from_iter(ends), message);
    }

    /// Adds a mistake of a whole expression or type.
    pub fn push_over(&mut self, tokens: impl ToTokens, message: impl std::fmt::Display) {
        self.list.push(syn::Error::new_spanned(tokens, message));
    }

    pub fn extend(&mut self, error: syn::Error) {
        self.list.extend(error);
    }

    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Whether the expression shouldn't be checked.
    pub fn hides_the_rest(&self) -> bool {
        self.hides_the_rest
    }

    /// All mistakes with their places, at least one.
    pub fn mistakes(&self) -> Vec<Mistake> {
        let single = self.list.iter().flat_map(|error| error.clone().into_iter().collect::<Vec<_>>());
        let mut mistakes: Vec<Mistake> =
            single.map(|error| Mistake { message: error.to_string(), span: error.span() }).collect();
        if mistakes.is_empty() {
            let message = "this isn't a declaration that can be read".to_owned();
            mistakes.push(Mistake { message, span: Span::call_site() });
        }
        mistakes
    }

    pub fn iter(&self) -> impl Iterator<Item = &syn::Error> {
        self.list.iter()
    }
}

/// `; did you mean …?` with the known name that an unknown one most likely misspells; empty if there is none.
///
/// A misspelling changes at most one letter of three, and no digit, as `rho1` isn't `rho2`. Only the digit zero may
/// stand for the letter, as in `S03` for `SO3`.
#[must_use]
pub fn suggestion<'a>(unknown: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let length = unknown.chars().count();
    let digits = |name: &str| name.chars().filter(char::is_ascii_digit).collect::<String>();
    let letters = unknown.replace('0', "O");
    let is_misread = |name: &str| letters != unknown && name.eq_ignore_ascii_case(&letters);
    let alike = known
        .into_iter()
        .filter(|name| is_misread(name) || (digits(name) == digits(unknown) && !is_other_letter(unknown, name)));
    let nearest = alike.map(|name| (distance(unknown, name), name)).min();
    match nearest {
        Some((distance, name)) if distance == 0 || (distance < length && distance <= (length / 3).max(1)) => {
            format!("; did you mean `{name}`?")
        }
        _ => String::new(),
    }
}

/// Whether the known name is one letter, with a number or without, and the unknown one is another letter: `PI` isn't
/// `I`, and `R_1` isn't `F_1`. Case is ignored.
fn is_other_letter(unknown: &str, known: &str) -> bool {
    let stem = |name: &str| name.trim_end_matches(|last: char| last == '_' || last.is_ascii_digit()).to_lowercase();
    stem(known).chars().count() == 1 && stem(known) != stem(unknown)
}

/// Levenshtein's distance with swaps of neighbours, and without regard to case.
pub fn distance(a: &str, b: &str) -> usize {
    let [a, b] = [a, b].map(|name| name.to_lowercase().chars().collect::<Vec<char>>());
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(before[j - 2] + 1);
            }
            row.push(best);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}
