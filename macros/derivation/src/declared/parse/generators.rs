//! Generators of a user's groups.

use proc_macro2::{Ident, Span};
use syn::parse::ParseStream;
use syn::punctuated::Punctuated;
use syn::spanned::Spanned as _;
use syn::{Expr, ExprArray, Token, parenthesized};

use crate::declared::Factor;
use crate::declared::errors::Errors;
use crate::mathematics::group::{Defect, Group};
use crate::mathematics::symbolic::Rational;

/// The argument `generators = [[[…]]]`, or `generators(Own = [[[…]]], …)` with the name of each group.
pub(super) struct Generators {
    pub(super) key: Ident,
    each: Vec<(Option<Ident>, ExprArray)>,
}

impl Generators {
    /// Reads the generators behind the key.
    pub(super) fn of(key: Ident, input: ParseStream) -> syn::Result<Self> {
        if !input.peek(syn::token::Paren) {
            let message = "write `generators = [[[0.0, -1.0], [1.0, 0.0]]]`, or in a product with the name of the group, \
                           `generators(Own = [[[0.0, -1.0], [1.0, 0.0]]])`";
            let equals = input.parse::<Token![=]>();
            equals.map_err(|_| syn::Error::new(key.span(), message))?;
            return Ok(Self { key, each: vec![(None, array(input)?)] });
        }
        let content;
        parenthesized!(content in input);
        let named = |input: ParseStream| {
            let name: Ident = input.parse()?;
            input.parse::<Token![=]>()?;
            Ok((Some(name), array(input)?))
        };
        let each: Punctuated<_, Token![,]> = content.parse_terminated(named, Token![,])?;
        Ok(Self { key, each: each.into_iter().collect() })
    }

    /// The matrices of a user's group with this name.
    pub(super) fn matrices(&self, group: &str) -> Option<&ExprArray> {
        let is_of = |name: &Option<Ident>| name.as_ref().is_none_or(|name| name == group);
        self.each.iter().find(|(name, _)| is_of(name)).map(|(_, array)| array)
    }

    /// Whether there are generators with this name.
    pub(super) fn has_name(&self, group: &str) -> bool {
        self.each.iter().any(|(name, _)| name.as_ref().is_some_and(|name| name == group))
    }

    /// The places of the generators of a group.
    pub(super) fn places(&self, group: &str) -> Vec<Span> {
        self.matrices(group).into_iter().flat_map(|array| &array.elems).map(syn::spanned::Spanned::span).collect()
    }

    /// Reports generators of no group and of several; `groups` are the names of the user's groups.
    pub(super) fn check(&self, groups: &[String], errors: &mut Errors) {
        for (at, (name, _)) in self.each.iter().enumerate() {
            let is_again = name.is_some() && self.each[..at].iter().any(|(other, _)| other == name);
            match (name, groups) {
                (Some(name), _) if is_again => {
                    errors.push(name.span(), format!("the generators of `{name}` are given twice: remove one"));
                }
                (Some(name), groups) if !groups.iter().any(|group| name == group) => {
                    let message = format!("no group of your own is called `{name}`: remove its generators");
                    errors.push_decisive(name.span(), message);
                }
                (None, []) => {
                    let message = "liestep's groups have their generators already: remove these";
                    errors.push_decisive(self.key.span(), message);
                }
                (None, several) if several.iter().any(|group| *group != several[0]) => {
                    let message = format!(
                        "several groups are your own: give the generators of each, `generators({} = [[[0.0, -1.0], \
                         [1.0, 0.0]]], …)`",
                        several[0]
                    );
                    errors.push_decisive(self.key.span(), message);
                }
                _ => {}
            }
        }
    }
}

/// The place of each generator: its own in a user's group, else that of the increment.
pub(super) fn places(group: &Group, factors: &[Factor], generators: Option<&Generators>) -> Vec<Span> {
    let of_factor = |(factor, own): (&Factor, &Group)| {
        let own_places = generators.map(|all| all.places(&factor.group_name())).unwrap_or_default();
        let place = move |k: usize| own_places.get(k).copied().unwrap_or(factor.place);
        (0..own.dimension()).map(place).collect::<Vec<_>>()
    };
    factors.iter().zip(group.factors()).flat_map(of_factor).collect()
}

/// The array of generators, read when the group is known.
fn array(input: ParseStream) -> syn::Result<ExprArray> {
    let expression: Expr = input.parse()?;
    match plain(&expression) {
        Expr::Array(array) => Ok(array.clone()),
        other => {
            let message = "write the generators as an array of matrices, each by its rows: \
                           `[[[0.0, -1.0], [1.0, 0.0]]]`";
            Err(syn::Error::new_spanned(other, message))
        }
    }
}

/// The expression without the parentheses around it, and without the invisible group of a `macro_rules!` fragment.
fn plain(expression: &Expr) -> &Expr {
    match expression {
        Expr::Group(inner) => plain(&inner.expr),
        Expr::Paren(inner) => plain(&inner.expr),
        other => other,
    }
}

/// The group of the generators `[[[0.0, -1.0], [1.0, 0.0]], …]`, each by rows, which are a basis of a Lie algebra.
pub(super) fn generators(array: &ExprArray) -> syn::Result<Group> {
    let rows = |expression: &Expr| match plain(expression) {
        Expr::Array(array) => Ok(array.elems.clone()),
        other => Err(syn::Error::new(other.span(), "write a matrix as an array of rows: `[[0.0, -1.0], [1.0, 0.0]]`")),
    };
    let mut generators = Vec::new();
    let mut size = None;
    for matrix in &array.elems {
        let mut entries = Vec::new();
        let matrix_rows = rows(matrix)?;
        let expected = *size.get_or_insert(matrix_rows.len());
        for row in &matrix_rows {
            let row_entries = rows(row)?;
            if row_entries.len() != expected || matrix_rows.len() != expected {
                return Err(syn::Error::new(row.span(), "all generators are square matrices of one size"));
            }
            for entry in &row_entries {
                entries.push(decimal(entry)?);
            }
        }
        generators.push(entries);
    }
    match size {
        Some(size) if (1..=MOST_ROWS).contains(&size) => {
            let group = Group::declared(size, generators);
            match group.defect() {
                None => Ok(group),
                Some(defect) => Err(explained(defect, array)),
            }
        }
        _ => Err(syn::Error::new(
            array.span(),
            format!("a group has at least one generator, of at most {MOST_ROWS} rows"),
        )),
    }
}

/// The error at the superfluous generator, or at all of them if one is missing.
fn explained(defect: Defect, array: &ExprArray) -> syn::Error {
    let at = |k: usize| array.elems.get(k).map_or_else(|| array.span(), syn::spanned::Spanned::span);
    match defect {
        Defect::Zero(k) => syn::Error::new(at(k), "this generator is zero, and moves nothing: leave it out"),
        Defect::Dependent(k) => {
            syn::Error::new(at(k), "this generator is a combination of those before it: leave it out")
        }
        Defect::Open(i, j) => syn::Error::new(
            array.span(),
            format!(
                "the bracket of generators {} and {} isn't a combination of them: add it to them, so that they span a \
                 Lie algebra",
                i + 1,
                j + 1
            ),
        ),
    }
}

/// The limit on the size of matrices: larger ones would make the derived code grow without bound.
const MOST_ROWS: usize = 16;

fn decimal(expression: &Expr) -> syn::Result<Rational> {
    let message = "write the entry of a generator as a number: `-1.0`";
    let value = match plain(expression) {
        Expr::Unary(unary) if matches!(unary.op, syn::UnOp::Neg(_)) => -decimal(&unary.expr)?,
        Expr::Lit(literal) => match &literal.lit {
            syn::Lit::Float(float) => Rational::from_decimal(float.base10_digits()),
            syn::Lit::Int(whole) if whole.suffix().is_empty() => Rational::from_decimal(whole.base10_digits()),
            _ => return Err(syn::Error::new_spanned(expression, message)),
        },
        _ => return Err(syn::Error::new_spanned(expression, message)),
    };
    if value.is_overflow() { Err(syn::Error::new_spanned(expression, message)) } else { Ok(value) }
}
