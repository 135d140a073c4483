//! The declarations of `mistakes/*.txt`, each with its messages and with the place that each message underlines.
//!
//! A blank line ends a declaration. Below it stands what the compiler is to show: `^`, the line and column where the
//! underlined text begins, that text, and on the next line the message. Of a type that is underlined as a whole here the
//! compiler underlines the first token.

use expect_test::expect_file;
use proc_macro2::{LineColumn, TokenStream, TokenTree};

use crate::common::{is_refused, tokens};
use crate::texts::TokenDeclaration;

/// The expansion of a declaration, as the compiler gets it.
fn expansion(declaration: &str) -> TokenStream {
    if let Some(declared) = TokenDeclaration::read(declaration) {
        return declared.expanded();
    }
    let body = tokens(declaration).into_iter().find_map(|token| match token {
        TokenTree::Group(body) => Some(body.stream()),
        _ => None,
    });
    liestep_derivation::matrix_group(body.expect("the braces of `matrix_group!`"))
}

/// The messages of an expansion, each with the places where its underlined text begins and ends.
fn messages(expansion: TokenStream) -> Vec<([LineColumn; 2], String)> {
    let tokens: Vec<TokenTree> = expansion.into_iter().collect();
    let errors = tokens.windows(3).filter_map(|three| match three {
        [TokenTree::Ident(name), TokenTree::Punct(_), TokenTree::Group(message)] if name == "compile_error" => {
            let text: syn::LitStr = syn::parse2(message.stream()).expect("one message");
            Some(([name.span().start(), message.span().end()], text.value()))
        }
        _ => None,
    });
    errors.collect()
}

/// The text between two places, on one line.
fn between(text: &str, ends: [LineColumn; 2]) -> String {
    let [from, to] = ends.map(|LineColumn { line, column }| {
        text.lines().take(line - 1).map(|before| before.chars().count() + 1).sum::<usize>() + column
    });
    let underlined: String = text.chars().take(to).skip(from).collect();
    underlined.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Whether a name stands in a text.
pub(super) fn has_name(text: &str, name: &str) -> bool {
    text.split(|letter: char| !letter.is_alphanumeric() && letter != '_').any(|word| word == name)
}

/// The messages with the texts that they underline, or the word `accepted`.
pub(super) fn outcome(declaration: &str, expansion: TokenStream) -> String {
    if !is_refused(&expansion) {
        return "accepted".to_owned();
    }
    let lines =
        messages(expansion).into_iter().map(|(ends, message)| format!("{}: {message}", between(declaration, ends)));
    lines.collect::<Vec<_>>().join("\n")
}

/// A declaration with its messages; asserts that none recommends `h` for an `l`, which has no step.
fn annotated(declaration: &str) -> String {
    let expansion = expansion(declaration);
    assert!(is_refused(&expansion), "{declaration}\nis right");
    assert!(syn::parse2::<syn::File>(expansion.clone()).is_ok(), "{declaration}\nbecomes no items");
    let (mut lines, has_step) =
        (vec![declaration.to_owned()], !has_name(declaration, "l") || has_name(declaration, "h"));
    for (ends, message) in messages(expansion) {
        let (LineColumn { line, column }, text) = (ends[0], between(declaration, ends));
        // The quotient `(F - I) / h`, which a rule puts in the place of a velocity, may be named.
        let is_code = |code: &str| has_name(code, "h") && !code.ends_with("- I) / h");
        assert!(
            has_step || !message.split('`').skip(1).step_by(2).any(is_code),
            "{declaration}\nhas no step: {message}"
        );
        // A missing argument has no place: the compiler underlines the attribute.
        let place = if text.is_empty() { "^".to_owned() } else { format!("^ {line}:{} {text}", column + 1) };
        lines.extend([place, format!("  {}", message.replace('\n', "\n  "))]);
    }
    lines.join("\n")
}

#[test]
fn have_their_messages_at_their_places() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("mistakes");
    let mut declarations = 0;
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let text = std::fs::read_to_string(&path).expect("text");
        let paragraphs =
            text.trim_end().split("\n\n").map(|paragraph| paragraph.split("\n^").next().unwrap_or_default());
        let found: Vec<String> = paragraphs.map(annotated).collect();
        declarations += found.len();
        expect_file![path].assert_eq(&(found.join("\n\n") + "\n"));
    }
    assert!(declarations > 300, "{declarations}");
}
