//! The group of a declaration: a built-in one by its name, or a user's one by its generators.

use proc_macro2::Span;
use syn::ext::IdentExt as _;
use syn::parse::ParseStream;
use syn::spanned::Spanned as _;
use syn::{Expr, ExprArray, Ident, Path, PathArguments, Token};

use crate::declared::errors::{Errors, suggestion};
use crate::declared::{Factor, Role};
use crate::mathematics::group::{Defect, Group, NAMES, built_in};
use crate::mathematics::symbolic::Rational;

/// The name behind `group =`.
pub(super) struct GroupName {
    path: Path,
    /// Whether the name is `Name!`, a group that `matrix_group!` declares.
    is_own: bool,
}

impl GroupName {
    pub(super) fn name(&self) -> String {
        self.path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default()
    }

    /// The group of liestep by that name, if there is one.
    pub(super) fn built_in(&self) -> Option<Group> {
        if self.is_own { None } else { built_in(&self.name()) }
    }

    /// Whether the group is one of translations.
    pub(super) fn is_translation(&self) -> bool {
        self.built_in().is_some() && TRANSLATIONS.contains(&self.name().as_str())
    }

    /// Whether the name may be an increment in the place of its group.
    pub(super) fn may_be_an_increment(&self) -> bool {
        let is_misspelled = !suggestion(&self.name(), NAMES).is_empty();
        self.path.get_ident().is_some() && !self.is_own && self.built_in().is_none() && !is_misspelled
    }

    /// Whether the path can't belong to a group of the user's.
    fn is_ours(&self) -> bool {
        let segments = &self.path.segments;
        segments.len() == 1 || segments.first().is_some_and(|first| first.ident == "liestep")
    }
}

/// The advice for the value of `group`.
pub(super) const ONE_OR_SEVERAL: &str =
    "write the name of a group, `group = SO3`, or those of several bodies, `group(F_1 = SO3, F_2 = SO3)`";

/// Reads the name of a group, as `SO3` or `own::Affine!`.
pub(super) fn named(input: ParseStream, errors: &mut Errors) -> syn::Result<GroupName> {
    let span = input.span();
    let mut path: Path = input.parse().map_err(|_| syn::Error::new(span, ONE_OR_SEVERAL))?;
    let is_own = input.parse::<Option<Token![!]>>()?.is_some();
    for segment in &mut path.segments {
        // The generated code writes the scalar itself wherever it needs the type.
        let arguments = std::mem::replace(&mut segment.arguments, PathArguments::None);
        if !arguments.is_empty() {
            let (name, mark) = (&segment.ident, if is_own { "!" } else { "" });
            let message = format!("write `group = {name}{mark}`: the scalar is that of the fields");
            errors.push_over(arguments, message);
        }
    }
    Ok(GroupName { path, is_own })
}

/// The path as written, and the group. After a mistake the path is `None` and the group SO(3), so that the rest can be
/// checked.
pub(super) fn group(
    named: Option<GroupName>,
    matrices: Option<(Ident, ExprArray)>,
    is_readable: bool,
    errors: &mut Errors,
) -> (Option<Path>, Group) {
    let stand_in = || (None, built_in("SO3").unwrap_or_else(|| Group::declared(3, Vec::new())));
    let Some(named) = named else {
        // The group may stand in an argument that couldn't be read.
        if is_readable {
            errors.push(Span::call_site(), "the group is missing: write `group = SO3`");
        }
        return stand_in();
    };
    let (name, found) = (named.name(), named.built_in());
    let found = match (matrices, found) {
        (Some((key, _)), Some(group)) if named.is_ours() => {
            let message = format!(
                "`{name}` has its generators already: remove these, or give a group of your own another name than \
                 liestep's"
            );
            errors.push_decisive(key.span(), message);
            Ok(group)
        }
        (Some((_, matrices)), _) => generators(&matrices),
        (None, Some(group)) => Ok(group),
        // The generators may stand in an argument that couldn't be read.
        (None, None) if !is_readable => return stand_in(),
        (None, None) => {
            let (near, known) = (suggestion(&name, NAMES), NAMES.join(", "));
            let own = format!(
                "of a group that `matrix_group!` declares write `group = {name}!`, of another give the generators too: \
                 `generators = [[[0.0, -1.0], [1.0, 0.0]]]`"
            );
            let message = format!("the group `{name}` isn't known{near}\nknown: {known}; {own}");
            Err(syn::Error::new_spanned(&named.path, message))
        }
    };
    match found {
        Ok(group) => (Some(named.path), group),
        Err(error) => {
            errors.extend(error);
            stand_in()
        }
    }
}

/// The factors of a product, with their increments.
pub(super) fn product(named: Vec<(Ident, GroupName)>, errors: &mut Errors) -> (Vec<Factor>, Group) {
    let (mut factors, mut groups): (Vec<Factor>, Vec<Group>) = (Vec::new(), Vec::new());
    for (increment, named) in named {
        let name = increment.unraw().to_string();
        if factors.iter().any(|other| other.name == name) {
            let message = format!("`{name}` is declared twice: each factor has its own increment");
            errors.push_decisive(increment.span(), message);
            continue;
        }
        if factors.len() == MOST_FACTORS {
            let message = format!(
                "at most {MOST_FACTORS} factors are declared together: declare what one body or two have as terms of \
                 their own, and put them at the places of a system of many, `Each::<N>::of([…]) + Along::<N>::of([…])`"
            );
            errors.push_decisive(increment.span(), message);
            break;
        }
        let known = named.built_in().map(|group| if named.is_translation() { group.added() } else { group });
        if known.is_none() {
            let near = if named.is_own { String::new() } else { suggestion(&named.name(), NAMES) };
            let message = if near.is_empty() {
                format!(
                    "the factors of a product are groups of liestep's, {}: of a group of your own write the \
                     `DiscreteLagrangian` by hand",
                    NAMES.join(", ")
                )
            } else {
                format!("the group `{}` isn't known{near}", named.name())
            };
            errors.push_over(&named.path, message);
        }
        let path = known.is_some().then_some(named.path);
        // A stand-in after a mistake lets the rest be checked.
        groups.extend(known.or_else(|| built_in("SO3")));
        factors.push(Factor { name, place: increment.span(), path });
    }
    (factors, Group::product(groups))
}

/// The groups whose increments are vectors, which are added.
const TRANSLATIONS: [&str; 3] = ["R1", "R2", "R3"];

/// The limit on factors: more would make the derived code grow without bound.
const MOST_FACTORS: usize = 4;

/// Reports increments, of one body or of several, whose names have another meaning.
pub(super) fn check_increments(role: Role, factors: &[Factor], taken: &TakenNames, errors: &mut Errors) {
    // An increment without a name is `F`, which no other name can be.
    for Factor { name, place, .. } in factors.iter().filter(|factor| factor.name != "F") {
        let meaning = if Role::Lagrangian.reserved(true).contains(&name.as_str()) {
            &format!("already has a meaning in {}", role.definite())
        } else if name == "space" {
            "is what isn't a body, as in `seen_from(space)`"
        } else if taken.fields.contains(name) {
            "is a field already"
        } else if taken.advected.contains(name) {
            "is advected already"
        } else if taken.velocities.contains(name) {
            "is a velocity or a displacement already"
        } else {
            continue;
        };
        errors.push_decisive(*place, format!("`{name}` {meaning}: choose another name for the increment"));
    }
}

/// Names that other parts of the declaration have.
pub(super) struct TakenNames {
    pub(super) fields: Vec<String>,
    pub(super) advected: Vec<String>,
    pub(super) velocities: Vec<String>,
}

/// The array of generators, read when the group is known.
pub(super) fn array(input: ParseStream) -> syn::Result<ExprArray> {
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
