//! Limits on the size of the text that is parsed.

use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};

use crate::declared::errors::Errors;

/// The limit on tokens: those of a sum of a hundred terms.
const MOST_TOKENS: usize = 8_000;
/// The limit on numbers in rows of matrices, which nest nothing: whether nine rows' generators span an algebra takes a second.
const MOST_NUMBERS: usize = 4_096;
/// The limits on tokens that may nest each other, as in `a + b + c`, and on brackets and operators: parsing more recursively could
/// overflow a stack of 2 MB without optimisation.
const LONGEST_CHAIN: usize = 2_000;
const DEEPEST: usize = 32;

/// Words followed by a part of an expression or of a type, which may begin with such a word again.
const NESTING_WORDS: [&str; 20] = [
    "as", "async", "await", "break", "const", "dyn", "else", "fn", "for", "if", "impl", "loop", "match", "move", "mut",
    "raw", "return", "unsafe", "while", "yield",
];

/// A stream of tokens within brackets, read up to some token.
struct Open {
    tokens: proc_macro2::token_stream::IntoIter,
    /// The number of brackets around it.
    depth: usize,
    /// The number of consecutive operators read last.
    operators: usize,
    /// The number of tokens since the last `;` or `,` that may each nest the tokens behind them.
    nesting: usize,
    /// Whether a group was read last. An attribute behind one doesn't nest.
    follows_group: bool,
    /// The number of tokens since the last `;` or `,`, and the longest chain in a bracket among them.
    chain: usize,
    within: usize,
    /// The longest chain so far, with those in brackets.
    longest: usize,
}

impl Open {
    fn new(tokens: TokenStream, depth: usize) -> Self {
        let tokens = tokens.into_iter();
        Self { tokens, depth, operators: 0, nesting: 0, follows_group: false, chain: 0, within: 0, longest: 0 }
    }

    fn count(&mut self, token: &TokenTree) {
        self.chain += 1;
        self.longest = self.longest.max(self.chain + self.within);
        match token {
            TokenTree::Punct(operator) if [';', ','].contains(&operator.as_char()) => {
                (self.operators, self.nesting, self.chain, self.within) = (0, 0, 0, 0);
            }
            TokenTree::Punct(operator) => {
                self.operators += 1;
                self.nesting += usize::from(['=', '|', '<', '@', '\''].contains(&operator.as_char()));
                self.nesting += usize::from(operator.as_char() == '#' && !self.follows_group);
            }
            TokenTree::Ident(word) => {
                self.operators = 0;
                self.nesting += usize::from(NESTING_WORDS.iter().any(|nesting| word == nesting));
            }
            TokenTree::Group(_) | TokenTree::Literal(_) => self.operators = 0,
        }
        self.follows_group = matches!(token, TokenTree::Group(_));
    }

    /// Takes the chains of a bracket that has been read.
    fn enclose(&mut self, bracket: &Self) {
        self.within = self.within.max(bracket.longest);
        self.longest = self.longest.max(self.chain + self.within);
    }

    fn is_too_deep(&self) -> bool {
        self.depth.max(self.operators).max(self.nesting) > DEEPEST
    }
}

/// Checks the size of the arguments; `None` if they are too large, which has been reported.
pub(super) fn check(the: &str, arguments: &TokenStream, errors: &mut Errors) -> Option<()> {
    let mut open = vec![Open::new(arguments.clone(), 0)];
    let (mut count, mut numbers, mut last) = (0, 0, Span::call_site());
    while let Some(mut innermost) = open.pop() {
        if innermost.longest > LONGEST_CHAIN {
            errors.push(last, format!("more than {LONGEST_CHAIN} tokens in a chain: bind parts with `let`"));
            return None;
        }
        let Some(token) = innermost.tokens.next() else {
            if let Some(outer) = open.last_mut() {
                outer.enclose(&innermost);
            }
            continue;
        };
        (count, last) = (count + 1, token.span());
        if count > MOST_TOKENS {
            let message = format!(
                "{the} has more than {MOST_TOKENS} tokens: declare parts as terms of their own, and add them, `a + b`"
            );
            errors.push(token.span(), message);
            return None;
        }
        innermost.count(&token);
        if innermost.is_too_deep() {
            let span = match &token {
                TokenTree::Group(group) => group.span_open(),
                other => other.span(),
            };
            errors.push(span, format!("nested more than {DEEPEST} deep: bind parts with `let`"));
            return None;
        }
        let row = row(&token);
        numbers += row.unwrap_or_default();
        if numbers > MOST_NUMBERS {
            errors.push(token.span(), format!("{the} has more than {MOST_NUMBERS} numbers: declare a smaller group"));
            return None;
        }
        let inside = match token {
            TokenTree::Group(group) if row.is_none() => Some(Open::new(group.stream(), innermost.depth + 1)),
            _ => None,
        };
        open.push(innermost);
        open.extend(inside);
    }
    Some(())
}

/// The number of numbers in a row of a matrix, `[0.0, -1.0]`; `None` for other tokens.
fn row(token: &TokenTree) -> Option<usize> {
    let TokenTree::Group(group) = token else { return None };
    let (mut is_open, mut is_signed, mut count) = (true, false, 0);
    for token in group.stream() {
        match token {
            TokenTree::Punct(sign) if sign.as_char() == '-' && is_open && !is_signed => is_signed = true,
            TokenTree::Punct(comma) if comma.as_char() == ',' && !is_open => is_open = true,
            TokenTree::Literal(_) if is_open => {
                count += 1;
                (is_open, is_signed) = (false, false);
            }
            _ => return None,
        }
    }
    (group.delimiter() == Delimiter::Bracket).then_some(count)
}
