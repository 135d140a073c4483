//! A user's group: its declaration by `matrix_group!`, and `group = Name!`, which takes its generators from that.

use proc_macro2::{TokenStream, TokenTree};
use syn::parse::{Parse, ParseStream, Parser as _};
use syn::{Attribute, ExprArray, Ident, ImplItem, Path, Token, Visibility};

use super::generators::generators;
use super::size;
use crate::declared::errors::Errors;

/// The declaration in `matrix_group!`.
pub struct OwnGroup {
    /// The path of liestep, if not `::liestep`.
    pub root: Option<Path>,
    pub attributes: Vec<Attribute>,
    pub visibility: Visibility,
    pub name: Ident,
    /// The generators as written, each by rows.
    pub generators: ExprArray,
    /// The number of rows of the matrices.
    pub size: usize,
    /// The functions of `Generators`.
    pub functions: Vec<ImplItem>,
}

impl Parse for OwnGroup {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        let mut root = None;
        if input.peek(Token![crate]) {
            input.parse::<Token![crate]>()?;
            input.parse::<Token![=]>()?;
            root = Some(input.parse()?);
            input.parse::<Token![;]>()?;
        }
        let attributes = input.call(Attribute::parse_outer)?;
        let visibility = input.parse()?;
        input.parse::<Token![type]>()?;
        let name: Ident = input.parse()?;
        input.parse::<Token![=]>()?;
        let array: ExprArray = input.parse()?;
        input.parse::<Token![;]>()?;
        let size = generators(&array)?.size;
        let mut functions = Vec::new();
        while !input.is_empty() {
            functions.push(input.parse()?);
        }
        Ok(Self { root, attributes, visibility, name, generators: array, size, functions })
    }
}

/// The group that `matrix_group!` declares.
pub fn own_group(tokens: TokenStream, errors: &mut Errors) -> Option<OwnGroup> {
    size::check("the group", &tokens, errors)?;
    syn::parse2(tokens).map_err(|error| errors.extend(error)).ok()
}

/// The name behind `type`, whatever follows it.
pub fn name_of_own_group(tokens: &TokenStream) -> Option<Ident> {
    let mut tokens = tokens.clone().into_iter();
    tokens.find(|token| matches!(token, TokenTree::Ident(word) if word == "type"))?;
    match tokens.next()? {
        TokenTree::Ident(name) => Some(name),
        _ => None,
    }
}

/// The arguments of a declaration with `group = Name!`, and the values of some keys.
pub struct Request {
    pub group: Path,
    pub root: Option<Path>,
    pub arguments: TokenStream,
}

/// The request for the generators of a group; `None` if neither `group = Name!` nor a factor
/// `F = Name!` is there, or if the generators have arrived.
pub fn asked(arguments: &TokenStream) -> Option<Request> {
    let tokens: Vec<TokenTree> = arguments.clone().into_iter().collect();
    let is = |token: &TokenTree, mark: char| matches!(token, TokenTree::Punct(found) if found.as_char() == mark);
    let path = |tokens: &[TokenTree]| Path::parse_mod_style.parse2(tokens.iter().cloned().collect()).ok();
    let of_factor = |factor: &[TokenTree]| match factor {
        [_, equals, name @ .., mark] if is(equals, '=') && is(mark, '!') => path(name),
        _ => None,
    };
    let (mut group, mut root) = (None, None);
    for argument in tokens.split(|token| is(token, ',')) {
        let [TokenTree::Ident(key), equals, value @ ..] = argument else { continue };
        match (value, equals) {
            _ if key == "generators" => return None,
            ([], TokenTree::Group(factors)) if key == "group" => {
                let factors: Vec<TokenTree> = factors.stream().into_iter().collect();
                group = factors.split(|token| is(token, ',')).find_map(of_factor);
            }
            ([name @ .., mark], _) if key == "group" && is(equals, '=') && is(mark, '!') => group = path(name),
            _ if key == "crate" => root = path(value),
            _ => {}
        }
    }
    group.map(|group| Request { group, root, arguments: arguments.clone() })
}
