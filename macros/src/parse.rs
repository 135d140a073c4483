//! The attribute's arguments and the struct's fields.

use proc_macro2::{Span, TokenStream};
use syn::ext::IdentExt as _;
use syn::parse::{ParseStream, Parser as _};
use syn::spanned::Spanned as _;
use syn::{
    Expr, ExprArray, Fields, GenericArgument, Ident, ItemStruct, Path, PathArguments, Token, Type, parenthesized,
};

use crate::ast::{AdvectedParameter, Declaration, Field, FieldKind, Scalar};
use crate::errors::{Errors, suggestion};
use crate::group::{self, Group};
use crate::symbolic::Rational;

/// More tokens than this, or deeper brackets, are no Lagrangian that a person wrote, and parsing them recursively could
/// overflow the compiler's stack.
const MOST_TOKENS: usize = 5_000;
const DEEPEST_BRACKETS: usize = 64;

/// Reports arguments that are too large to be parsed.
pub(crate) fn check_size(arguments: &TokenStream, errors: &mut Errors) {
    let mut open = vec![(arguments.clone().into_iter(), 0)];
    let mut count = 0;
    while let Some((mut tokens, depth)) = open.pop() {
        let Some(token) = tokens.next() else { continue };
        count += 1;
        open.push((tokens, depth));
        if count > MOST_TOKENS {
            errors.push(
                token.span(),
                format!("the Lagrangian has more than {MOST_TOKENS} tokens: the expression is too large"),
            );
            return;
        }
        if let proc_macro2::TokenTree::Group(group) = token {
            if depth >= DEEPEST_BRACKETS {
                errors.push(
                    group.span_open(),
                    format!("brackets are nested more than {DEEPEST_BRACKETS} deep: bind parts with `let`"),
                );
                return;
            }
            open.push((group.stream().into_iter(), depth + 1));
        }
    }
}

/// The arguments as written.
#[derive(Default)]
struct Arguments {
    group: Option<Path>,
    advected: Vec<(Ident, Ident)>,
    l_d: Option<Expr>,
    root: Option<Path>,
    generators: Option<ExprArray>,
}

const KEYS: [&str; 5] = ["group", "advected", "l_d", "generators", "crate"];

/// The path of the crate that expansions name: as given, or `::liestep`.
pub(crate) fn root(arguments: &TokenStream) -> Path {
    let mut ignored = Errors::default();
    let parsed = (|input: ParseStream| Ok(arguments_from(input, &mut ignored))).parse2(arguments.clone());
    parsed.ok().and_then(|arguments| arguments.root).unwrap_or_else(default_root)
}

fn default_root() -> Path {
    syn::parse_quote!(::liestep)
}

/// The declaration, or `None` if there is nothing to go on with.
pub(crate) fn parse(arguments: TokenStream, item: ItemStruct, errors: &mut Errors) -> Option<Declaration> {
    let parser = |input: ParseStream| Ok(arguments_from(input, errors));
    let arguments = match parser.parse2(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            errors.extend(error);
            return None;
        }
    };
    let structure = group(&arguments, errors);
    if arguments.l_d.is_none() {
        errors.push(Span::call_site(), "the Lagrangian is missing: write `l_d = …` with an expression in `F` and `h`");
    }
    let fields = fields(&item, errors);
    let scalar = scalar(&item, errors);
    let advected = advected(&arguments.advected, &fields, structure.size, errors);
    Some(Declaration {
        root: arguments.root.unwrap_or_else(default_root),
        group: arguments.group.unwrap_or_else(|| syn::parse_quote!(SO3)),
        structure,
        advected,
        l_d: arguments.l_d?,
        fields: fields.into_iter().map(|(field, _)| field).collect(),
        scalar,
        item,
    })
}

/// What is known of the group; SO(3) after a mistake, so that the rest can be checked.
fn group(arguments: &Arguments, errors: &mut Errors) -> Group {
    let fallback = || group::built_in("SO3").unwrap_or_else(|| Group::declared("SO3", 3, Vec::new()));
    let Some(path) = &arguments.group else {
        errors.push(Span::call_site(), "the group is missing: write `group = SO3`");
        return fallback();
    };
    let name = path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default();
    if let Some(array) = &arguments.generators {
        return match generators(array) {
            Ok((size, generators)) => Group::declared(&name, size, generators),
            Err(error) => {
                errors.extend(error);
                fallback()
            }
        };
    }
    group::built_in(&name).unwrap_or_else(|| {
        let known = group::NAMES.join(", ");
        let near = suggestion(&name, group::NAMES);
        errors.push(
            path.span(),
            format!("the group `{name}` isn't known{near}\nknown: {known}; of your own group give the `generators = [[[0.0, …], …], …]` too"),
        );
        fallback()
    })
}

/// `[[[0.0, -1.0], [1.0, 0.0]], …]`: for each generator its rows.
fn generators(array: &ExprArray) -> syn::Result<(usize, Vec<Vec<Rational>>)> {
    let rows = |expression: &Expr| match expression {
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
        Some(size) if (1..=MOST_ROWS).contains(&size) => Ok((size, generators)),
        _ => Err(syn::Error::new(
            array.span(),
            format!("a group has at least one generator, of at most {MOST_ROWS} rows"),
        )),
    }
}

/// Larger matrices would make the derived code grow without bound.
const MOST_ROWS: usize = 4;

fn decimal(expression: &Expr) -> syn::Result<Rational> {
    let message = "write the entry of a generator as a decimal number: `-1.0`";
    let value = match expression {
        Expr::Unary(unary) if matches!(unary.op, syn::UnOp::Neg(_)) => -decimal(&unary.expr)?,
        Expr::Lit(literal) => match &literal.lit {
            syn::Lit::Float(float) => Rational::from_decimal(float.base10_digits()),
            _ => return Err(syn::Error::new(expression.span(), message)),
        },
        _ => return Err(syn::Error::new(expression.span(), message)),
    };
    if value.is_overflow() { Err(syn::Error::new(expression.span(), message)) } else { Ok(value) }
}

/// Reads `key = value` pairs; after a syntax error the rest is skipped, as nothing tells where the next key begins.
fn arguments_from(input: ParseStream, errors: &mut Errors) -> Arguments {
    let mut arguments = Arguments::default();
    while !input.is_empty() {
        if let Err(error) = argument(input, &mut arguments, errors) {
            errors.extend(error);
            // Whatever is left would only be reported as unexpected.
            let _ = input.parse::<TokenStream>();
            break;
        }
    }
    arguments
}

fn argument(input: ParseStream, arguments: &mut Arguments, errors: &mut Errors) -> syn::Result<()> {
    let key = input.call(Ident::parse_any)?;
    let mut once = |taken: bool| {
        if taken {
            errors.push(key.span(), format!("`{key}` is given twice: remove one"));
        }
    };
    match key.to_string().as_str() {
        "group" => {
            once(arguments.group.is_some());
            input.parse::<Token![=]>()?;
            arguments.group = Some(input.parse()?);
        }
        "crate" => {
            once(arguments.root.is_some());
            input.parse::<Token![=]>()?;
            arguments.root = Some(input.parse()?);
        }
        "l_d" => {
            once(arguments.l_d.is_some());
            input.parse::<Token![=]>()?;
            arguments.l_d = Some(input.parse()?);
        }
        "generators" => {
            once(arguments.generators.is_some());
            input.parse::<Token![=]>()?;
            arguments.generators = Some(input.parse()?);
        }
        "advected" => {
            if !input.peek(syn::token::Paren) {
                return Err(syn::Error::new(
                    key.span(),
                    "write `advected(w = up)`: a name for the expression, then the field",
                ));
            }
            let content;
            parenthesized!(content in input);
            for (name, field) in content.parse_terminated(advected_pair, Token![,])? {
                arguments.advected.push((name, field));
            }
        }
        other => {
            let message = format!("`{other}` isn't an argument of `lagrangian`{}", suggestion(other, KEYS));
            return Err(syn::Error::new(
                key.span(),
                format!("{message}\nknown: group, advected, l_d, generators, crate"),
            ));
        }
    }
    if !input.is_empty() {
        input.parse::<Token![,]>()?;
    }
    Ok(())
}

fn advected_pair(input: ParseStream) -> syn::Result<(Ident, Ident)> {
    let name: Ident = input.parse()?;
    if !input.peek(Token![=]) {
        let message = format!("write `{name} = field`: the field holds the spatial value of `{name}`");
        return Err(syn::Error::new(name.span(), message));
    }
    input.parse::<Token![=]>()?;
    Ok((name, input.parse()?))
}

fn fields(item: &ItemStruct, errors: &mut Errors) -> Vec<(Field, Span)> {
    let Fields::Named(named) = &item.fields else {
        errors.push(item.ident.span(), "a Lagrangian is a struct with named fields: its parameters");
        return Vec::new();
    };
    let mut fields = Vec::new();
    for field in &named.named {
        let Some(name) = field.ident.clone() else { continue };
        let kind = field_kind(&field.ty, item).unwrap_or_else(|| {
            errors.push(
                field.ty.span(),
                "this type has no meaning in a Lagrangian: use f64, Vector3<f64>, Matrix3<f64>, NonstandardInertia, \
                 DiagonalNonstandardInertia or Inertia (or the same with the struct's type parameter)",
            );
            FieldKind::Scalar
        });
        fields.push((Field { name, kind }, field.ty.span()));
    }
    fields
}

fn last_segment(ty: &Type) -> Option<&syn::PathSegment> {
    match ty {
        Type::Path(path) if path.qself.is_none() => path.path.segments.last(),
        // A type that a `macro_rules!` fragment passed on comes in an invisible group.
        Type::Group(group) => last_segment(&group.elem),
        Type::Paren(paren) => last_segment(&paren.elem),
        _ => None,
    }
}

fn field_kind(ty: &Type, item: &ItemStruct) -> Option<FieldKind> {
    let name = last_segment(ty)?.ident.to_string();
    Some(match name.as_str() {
        "f64" | "f32" => FieldKind::Scalar,
        "Vector2" | "Vector3" | "Vector4" => FieldKind::Vector(digit(&name)?),
        "Matrix2" | "Matrix3" | "Matrix4" => FieldKind::Matrix(digit(&name)?),
        "NonstandardInertia" | "Inertia" => FieldKind::SymmetricInertia,
        "DiagonalNonstandardInertia" => FieldKind::DiagonalInertia,
        _ if item.generics.type_params().any(|parameter| parameter.ident == name) => FieldKind::Scalar,
        _ => return None,
    })
}

/// The number that a type's name ends with.
fn digit(name: &str) -> Option<usize> {
    usize::try_from(name.chars().last()?.to_digit(10)?).ok()
}

/// The scalar that a type is made of; an inertia without arguments has `f64`.
fn scalar_of(ty: &Type) -> Option<Ident> {
    let segment = last_segment(ty)?;
    match &segment.arguments {
        PathArguments::AngleBracketed(arguments) => match arguments.args.first()? {
            GenericArgument::Type(inner) => scalar_of(inner),
            _ => None,
        },
        _ if segment.ident.to_string().ends_with("Inertia") => Some(Ident::new("f64", segment.ident.span())),
        _ => Some(segment.ident.clone()),
    }
}

fn scalar(item: &ItemStruct, errors: &mut Errors) -> Scalar {
    let mut common: Option<Ident> = None;
    for field in &item.fields {
        if field_kind(&field.ty, item).is_none() {
            continue;
        }
        let Some(scalar) = scalar_of(&field.ty) else { continue };
        match &common {
            None => common = Some(scalar),
            Some(first) if *first != scalar => {
                errors.push(
                    scalar.span(),
                    format!("all parameters share one scalar: write `{first}` here, or `{scalar}` everywhere"),
                );
            }
            Some(_) => {}
        }
    }
    let scalar = common.unwrap_or_else(|| Ident::new("f64", Span::call_site()));
    if item.generics.type_params().any(|parameter| parameter.ident == scalar) {
        Scalar::Parameter(scalar)
    } else {
        Scalar::Primitive(Ident::new(&scalar.to_string(), Span::call_site()))
    }
}

fn advected(
    pairs: &[(Ident, Ident)],
    fields: &[(Field, Span)],
    size: usize,
    errors: &mut Errors,
) -> Vec<AdvectedParameter> {
    let mut parameters: Vec<AdvectedParameter> = Vec::new();
    for (name, field) in pairs {
        let unraw = name.unraw().to_string();
        let field_names: Vec<String> = fields.iter().map(|(field, _)| field.name.unraw().to_string()).collect();
        if ["F", "I", "h"].contains(&unraw.as_str()) || field_names.contains(&unraw) {
            errors.push(name.span(), format!("`{unraw}` already has a meaning in the Lagrangian: choose another name"));
            continue;
        }
        if parameters.iter().any(|other| other.name == *name) {
            errors.push(name.span(), format!("`{unraw}` is advected twice: remove one"));
            continue;
        }
        let wanted = field.unraw().to_string();
        let Some(index) = field_names.iter().position(|known| *known == wanted) else {
            let near = suggestion(&wanted, field_names.iter().map(String::as_str));
            errors.push(field.span(), format!("the struct has no field `{wanted}`{near}"));
            continue;
        };
        if let Some((found, span)) = fields.get(index)
            && found.kind != FieldKind::Vector(size)
        {
            let shape = found.kind.shape().describe();
            errors.push(
                *span,
                format!("`{wanted}` is {shape}, but the group carries a vector of {size}: use Vector{size}<f64>"),
            );
        }
        parameters.push(AdvectedParameter { name: name.clone(), field: index });
    }
    parameters
}
