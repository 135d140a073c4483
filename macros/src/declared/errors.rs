//! Errors accumulate, so that one compilation reports all mistakes of a declaration.

use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use quote::ToTokens;

/// The mistakes found so far.
#[derive(Debug, Default)]
pub(crate) struct Errors(Vec<syn::Error>);

impl Errors {
    /// A mistake at a token: what is wrong, then what to write.
    pub(crate) fn push(&mut self, span: Span, message: impl std::fmt::Display) {
        self.0.push(syn::Error::new(span, message));
    }

    /// A mistake from one token to another.
    pub(crate) fn push_between(&mut self, [first, last]: [Span; 2], message: impl std::fmt::Display) {
        let ends = [first, last].map(|span| TokenTree::Ident(Ident::new("_", span)));
        self.push_over(TokenStream::from_iter(ends), message);
    }

    /// A mistake that a whole expression or type makes.
    pub(crate) fn push_over(&mut self, tokens: impl ToTokens, message: impl std::fmt::Display) {
        self.0.push(syn::Error::new_spanned(tokens, message));
    }

    pub(crate) fn extend(&mut self, error: syn::Error) {
        self.0.extend(error);
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &syn::Error> {
        self.0.iter()
    }
}

/// ` (did you mean …?)` for the known name nearest to an unknown one, if it is near.
pub(crate) fn suggestion<'a>(unknown: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let length = unknown.chars().count();
    let nearest = known.into_iter().map(|name| (distance(unknown, name), name)).min();
    match nearest {
        // A name of which every letter differs is another name.
        Some((distance, name)) if distance < length && distance <= 1 + length / 3 => {
            format!("; did you mean `{name}`?")
        }
        _ => String::new(),
    }
}

/// Levenshtein's distance with swaps of neighbours, and a change of case for free.
fn distance(a: &str, b: &str) -> usize {
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

#[cfg(test)]
mod tests {
    use super::{distance, suggestion};

    #[test]
    fn distances() {
        assert_eq!(distance("rho", "rho"), 0);
        assert_eq!(distance("roh", "rho"), 1);
        assert_eq!(distance("J_D", "J_d"), 0);
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(suggestion("rh", ["m", "rho", "g"]), "; did you mean `rho`?");
        assert_eq!(suggestion("roh", ["h", "rho"]), "; did you mean `rho`?");
        assert_eq!(suggestion("f", ["m", "F"]), "; did you mean `F`?");
        assert_eq!(suggestion("w", ["m", "F"]), "");
        assert_eq!(suggestion("velocity", ["m", "rho"]), "");
    }
}
