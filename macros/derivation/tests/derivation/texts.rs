//! Declarations as texts, and the questions about them in `derived/*.txt`.
//!
//! A declaration is followed by lines `^ question`, each with its answer below it, indented. Declarations with holes `…`
//! are followed by rows: `… text` fills all holes, `… text … other` the first and the others, and below a row stand its
//! answers to all questions. Fields that a row doesn't name are left out. Comments are those of Rust.
//!
//! A question is a title of the derivation, as `inertia`, or one of those in `answer`.

use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use expect_test::expect_file;
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use quote::ToTokens as _;

use crate::common::{checked_as, tokens};
use crate::continuous::{discrete, equations};
use crate::mistakes::{has_name, outcome};
use crate::verify::Case;
use liestep_derivation::declared::errors::Errors;
use liestep_derivation::declared::{Declaration, Kind, Role, Tree, parse, parts};
use liestep_derivation::judged::conserved;

/// A declaration in tokens.
pub(crate) struct TokenDeclaration {
    role: Role,
    arguments: TokenStream,
    item: TokenStream,
    expansion: OnceCell<TokenStream>,
}

impl TokenDeclaration {
    /// The declaration of a text, or `None` if the text doesn't begin with an attribute.
    pub(crate) fn read(text: &str) -> Option<Self> {
        let mut tokens = tokens(text).into_iter();
        tokens.next().filter(|first| first.to_string() == "#")?;
        let Some(TokenTree::Group(attribute)) = tokens.next() else { panic!("{text}\nbegins with no attribute") };
        let (mut role, mut arguments) = (None, TokenStream::new());
        for token in attribute.stream() {
            match token {
                TokenTree::Ident(name) => role = Some(name.to_string()),
                TokenTree::Group(group) if group.delimiter() == Delimiter::Parenthesis => arguments = group.stream(),
                _ => {}
            }
        }
        let role = match role.as_deref() {
            Some("lagrangian") => Role::Lagrangian,
            Some("force") => Role::Force,
            Some("constraint") => Role::Constraint,
            Some("nonholonomic") => Role::Nonholonomic,
            other => panic!("{text}\nhas the attribute {other:?}"),
        };
        Some(Self { role, arguments, item: tokens.collect(), expansion: OnceCell::new() })
    }

    pub(crate) fn expanded(&self) -> TokenStream {
        let expand = || liestep_derivation::expand(self.role, self.arguments.clone(), &self.item);
        self.expansion.get_or_init(expand).clone()
    }

    fn declaration(&self) -> Declaration {
        let mut errors = Errors::default();
        let declaration = parse::declaration(self.role, &self.arguments, &self.item, &mut errors);
        assert!(errors.is_empty(), "{errors:?}");
        declaration.expect("a declaration")
    }

    fn file(&self) -> syn::File {
        let expansion = self.expanded();
        syn::parse2(expansion.clone()).unwrap_or_else(|error| panic!("{error} in {expansion}"))
    }

    /// The declaration without the fields that its arguments don't name.
    fn with_named_fields(mut self) -> Self {
        let mut item: syn::ItemStruct = syn::parse2(self.item).expect("a struct");
        let syn::Fields::Named(fields) = &mut item.fields else { panic!("no fields") };
        let arguments = self.arguments.to_string();
        let all = std::mem::take(&mut fields.named).into_iter();
        let is_named =
            |field: &syn::Field| field.ident.as_ref().is_some_and(|name| has_name(&arguments, &name.to_string()));
        fields.named = all.filter(is_named).collect();
        self.item = item.into_token_stream();
        self
    }

    /// The texts of the arguments and of the struct.
    fn text(&self) -> [String; 2] {
        [&self.arguments, &self.item].map(ToString::to_string)
    }
}

/// The value of a constant in an expansion; for a text within a block the text itself.
fn constant(name: &str, file: &syn::File) -> Option<String> {
    let constants = file.items.iter().filter_map(|item| match item {
        syn::Item::Impl(implementation) => Some(&implementation.items),
        _ => None,
    });
    let mut values = constants.flatten().filter_map(|item| match item {
        syn::ImplItem::Const(constant) if constant.ident == name => Some(match &constant.expr {
            syn::Expr::Block(block) => block.block.stmts.iter().find_map(|statement| match statement {
                syn::Stmt::Item(syn::Item::Const(constant)) => text_of(&constant.expr),
                _ => None,
            }),
            value => Some(value.to_token_stream().to_string()),
        }),
        _ => None,
    });
    values.next()?
}

fn text_of(value: &syn::Expr) -> Option<String> {
    match value {
        syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => Some(text.value()),
        _ => None,
    }
}

/// The struct's own documentation, in the lines of `///`.
fn page(file: &syn::File) -> String {
    let Some(syn::Item::Struct(item)) = file.items.first() else { panic!("no struct") };
    let values = item.attrs.iter().filter_map(|attribute| match &attribute.meta {
        syn::Meta::NameValue(doc) if doc.path.is_ident("doc") => text_of(&doc.value),
        _ => None,
    });
    let lines = values.collect::<Vec<_>>().join("\n");
    lines.lines().map(|line| line.strip_prefix(' ').unwrap_or(line)).collect::<Vec<_>>().join("\n")
}

/// The lines of all texts of an expansion that contain a word, each once.
fn lines_with(word: &str, expansion: TokenStream, found: &mut Vec<String>) {
    for token in expansion {
        match token {
            TokenTree::Group(group) => lines_with(word, group.stream(), found),
            TokenTree::Literal(literal) => {
                let Ok(text) = syn::parse2::<syn::LitStr>(literal.into_token_stream()) else { continue };
                for line in text.value().lines().map(str::trim).filter(|line| line.contains(word)) {
                    if found.iter().all(|other| other != line) {
                        found.push(line.to_owned());
                    }
                }
            }
            _ => {}
        }
    }
}

/// The lines below a title.
fn section(title: &str, file: &syn::File) -> Option<String> {
    ["DERIVATION", "CONTINUOUS_DERIVATION"].iter().find_map(|name| {
        let text = constant(name, file)?;
        let lines = text.lines().skip_while(|line| *line != title).skip(1);
        let lines: Vec<&str> = lines.take_while(|line| line.starts_with(' ')).map(str::trim).collect();
        (!lines.is_empty()).then(|| lines.join("\n"))
    })
}

/// The bodies of each conserved momentum, and the field along which it is conserved.
fn momenta(declaration: &Declaration) -> String {
    let name = |at: usize| declaration.fields[at].name.to_string();
    let all = conserved(declaration).into_iter().map(|one| {
        let bodies: Vec<&str> = one.bodies.iter().map(|&body| declaration.factors[body].name.as_str()).collect();
        format!("{}{}", bodies.join(", "), one.along.map(|at| format!(" along {}", name(at))).unwrap_or_default())
    });
    all.chain(["no other".to_owned()]).collect::<Vec<_>>().join("\n")
}

/// The names of the `let`s in a tree, one for each value.
fn bound_names(tree: &Rc<Tree>) -> String {
    let names = parts(tree).into_iter().filter_map(|part| match &part.kind {
        Kind::Bound(name, _) => Some((Rc::as_ptr(part), name.clone())),
        _ => None,
    });
    let mut names: Vec<_> = names.collect::<BTreeMap<_, _>>().into_values().collect();
    names.sort();
    names.join(", ")
}

/// A struct, with the first line of each page.
fn first_item(file: &syn::File) -> String {
    let Some(syn::Item::Struct(item)) = file.items.first() else { panic!("no struct") };
    let attributes = item.attrs.iter().map(|attribute| match &attribute.meta {
        syn::Meta::NameValue(doc) if doc.path.is_ident("doc") => {
            let text = text_of(&doc.value).expect("a text");
            format!("/// {}", text.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or_default())
        }
        _ => attribute.to_token_stream().to_string(),
    });
    let item = syn::ItemStruct { attrs: Vec::new(), ..item.clone() };
    attributes.chain([item.into_token_stream().to_string()]).collect::<Vec<_>>().join("\n")
}

/// A derived term by its name, for a comparison of two declarations.
fn term(name: &str, declared: &TokenDeclaration) -> String {
    let [arguments, item] = declared.text();
    let continuous = || equations(&arguments, &item).derived;
    match name {
        "normal form" => format!("{:?}", discrete(&arguments, &item)),
        "Lagrangian" => format!("{:?}", continuous().lagrangian),
        "Hessian" => format!("{:?}", continuous().hessian),
        "momentum" => format!("{:?}", continuous().momentum),
        "derivation" => constant("DERIVATION", &declared.file()).expect("a derivation"),
        "stages" => {
            let text = declared.expanded().to_string();
            let after = text.split_once("fn constants").expect("stages").1;
            after.split_once("impl").expect("an end").0.to_owned()
        }
        _ => panic!("no term is called `{name}`"),
    }
}

/// The answer to a question about a declaration, and its name.
fn answer(question: &str, text: &str, declared: &TokenDeclaration, others: &[(String, TokenDeclaration)]) -> String {
    if let Some((name, other)) = question.split_once(" as ") {
        let other = others.iter().find(|(own, _)| own == other).unwrap_or_else(|| panic!("no `{other}`"));
        let is_equal = term(name, declared) == term(name, &other.1);
        return if is_equal { "the same" } else { "another" }.to_owned();
    }
    if let Some(name) = question.strip_prefix("const ") {
        return constant(name, &declared.file()).unwrap_or_else(|| "none".to_owned());
    }
    if let Some(name) = question.strip_prefix("fact ") {
        let facts = constant("FACTS", &declared.file()).expect("facts");
        let facts: syn::ExprStruct = syn::parse_str(&facts).expect("a struct");
        let fact = facts.fields.into_iter().find(|field| field.member.to_token_stream().to_string() == name);
        return fact.map_or("none".to_owned(), |fact| fact.expr.to_token_stream().to_string());
    }
    if let Some(word) = question.strip_prefix("lines with ") {
        let mut found = Vec::new();
        lines_with(word, declared.expanded(), &mut found);
        return found.join("\n");
    }
    let [arguments, item] = declared.text();
    match question {
        "outcome" => outcome(text, declared.expanded()),
        "parts" => {
            let text = declared.expanded().to_string();
            let parts = text.split_once("Parts {").and_then(|(_, after)| after.split_once('}'));
            parts.map_or("none", |(parts, _)| parts.trim()).to_owned()
        }
        "derivation" => term("derivation", declared),
        "continuous derivation" => constant("CONTINUOUS_DERIVATION", &declared.file()).expect("a derivation"),
        "page" => page(&declared.file()),
        "adjoint" => format!("{:?}", Case::new(&arguments, &item).verified().expect("right")),
        "kinetic part" => format!("{:?}", Case::new(&arguments, &item).kinetic_part()),
        "inverse" => format!("{:?}", equations(&arguments, &item).derived.inverse),
        "right symmetries" => {
            let all = equations(&arguments, &item).right_symmetries;
            let all = all.iter().map(|one| format!("{:?}", one.iter().map(|entry| entry.to_f64()).collect::<Vec<_>>()));
            all.chain(["no other".to_owned()]).collect::<Vec<_>>().join("\n")
        }
        "momenta" => momenta(&declared.declaration()),
        "bound names" => bound_names(&checked_as(declared.role, &arguments, &item).1[0]),
        "item" => first_item(&declared.file()),
        title => section(title, &declared.file()).unwrap_or_else(|| panic!("{text}\nhas no `{title}`")),
    }
}

/// A declaration, its questions, and its rows or comments between them.
struct Paragraph<'a> {
    declaration: String,
    questions: Vec<&'a str>,
    rows: Vec<&'a str>,
}

/// A paragraph ends with a blank line before one that is neither indented nor a question nor a row.
fn paragraphs(text: &str) -> Vec<Paragraph<'_>> {
    let (mut all, mut is_blank) = (Vec::<Paragraph<'_>>::new(), true);
    for line in text.lines() {
        let is_new = is_blank && !line.is_empty() && !line.starts_with([' ', '^', '…']);
        is_blank = line.is_empty();
        if is_new {
            all.push(Paragraph { declaration: line.to_owned(), questions: Vec::new(), rows: Vec::new() });
            continue;
        }
        let paragraph = all.last_mut().expect("a declaration first");
        if let Some(question) = line.strip_prefix("^ ") {
            paragraph.questions.push(question);
        } else if line.starts_with('…') || (!paragraph.questions.is_empty() && line.starts_with("//")) {
            paragraph.rows.push(line);
        } else if paragraph.questions.is_empty() && !is_blank {
            paragraph.declaration.extend(["\n", line]);
        }
    }
    all
}

/// A declaration with its holes filled by a row.
fn filled(declaration: &str, row: &str) -> String {
    let mut parts = row.split('…').skip(1).map(str::trim).peekable();
    let mut filling = parts.next().unwrap_or_default();
    let mut pieces = declaration.split('…');
    let mut text = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        text += filling;
        text += piece;
        filling = parts.next().unwrap_or(filling);
    }
    text
}

/// A text with its answers.
fn answered(text: &str) -> String {
    let paragraphs = paragraphs(text);
    let name = |declared: &TokenDeclaration| {
        let item: syn::ItemStruct = syn::parse2(declared.item.clone()).expect("a struct");
        item.ident.to_string()
    };
    let whole = paragraphs.iter().filter(|paragraph| !paragraph.declaration.contains('…'));
    let others = whole.map(|paragraph| {
        let declared = TokenDeclaration::read(&paragraph.declaration).expect("an attribute");
        (name(&declared), declared)
    });
    let others: Vec<_> = others.collect();
    let indented = |answer: String| {
        let lines = answer.lines().map(|line| if line.is_empty() { String::new() } else { format!("  {line}") });
        lines.collect::<Vec<_>>()
    };
    let answered = paragraphs.iter().map(|Paragraph { declaration, questions, rows }| {
        let mut lines = vec![declaration.clone()];
        if rows.is_empty() {
            let declared = TokenDeclaration::read(declaration).expect("an attribute");
            for question in questions {
                lines.push(format!("^ {question}"));
                lines.extend(indented(answer(question, declaration, &declared, &others)));
            }
        }
        if !rows.is_empty() {
            lines.extend(questions.iter().map(|question| format!("^ {question}")));
        }
        for row in rows {
            lines.push((*row).to_owned());
            if row.starts_with('…') {
                let text = filled(declaration, row);
                let declared = TokenDeclaration::read(&text).expect("an attribute").with_named_fields();
                lines.extend(
                    questions.iter().flat_map(|question| indented(answer(question, &text, &declared, &others))),
                );
            }
        }
        lines.join("\n")
    });
    answered.collect::<Vec<_>>().join("\n\n") + "\n"
}

/// Compares a text with its answers, and names the first line that differs, its row and its declaration.
fn check(text: &str, file: &expect_test::ExpectFile) {
    let found = answered(text);
    let mut lines = text.lines().zip(found.lines()).enumerate();
    let is_updated = std::env::var_os("UPDATE_EXPECT").is_some();
    if let Some((at, (expected, found))) = lines.find(|(_, (a, b))| a != b).filter(|_| !is_updated) {
        let above: Vec<&str> = text.lines().take(at).collect();
        let last = |marks: &[&str]| above.iter().rfind(|line| marks.iter().any(|mark| line.contains(mark)));
        let [declaration, row] = [last(&["struct "]), last(&["…", "^ "])].map(|line| line.copied().unwrap_or_default());
        panic!("{}:{}\n{declaration}\n{row}\nexpected {expected}\nfound    {found}", file.path.display(), at + 1);
    }
    file.assert_eq(&found);
}

macro_rules! texts {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            let text = include_str!(concat!("derived/", stringify!($name), ".txt"));
            check(text, &expect_file![concat!("derived/", stringify!($name), ".txt")]);
        })*

        #[test]
        fn each_text_is_a_test() {
            let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/derivation/derived");
            assert_eq!(std::fs::read_dir(folder).expect("a folder").count(), [$(stringify!($name)),*].len());
        }
    };
}

texts! { bodies continuous discretised heavy_top printed right tour verified }
