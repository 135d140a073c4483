//! The attribute's arguments and the struct's fields.

mod group;
mod own_group;
mod size;

use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};
use syn::ext::IdentExt as _;
use syn::parse::{ParseStream, Parser as _};
use syn::spanned::Spanned as _;
use syn::{
    Expr, ExprArray, Fields, GenericArgument, Ident, Item, ItemStruct, Path, PathArguments, Token, Type, braced,
    parenthesized,
};

use crate::declared::errors::{Errors, suggestion};
use crate::declared::{AdvectedParameter, Declaration, Field, FieldKind, Role, Scalar};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::Variance;

pub(crate) use own_group::{Asked, OwnGroup, asked, own_group};

/// The declaration, with its mistakes reported; `None` where nothing of it can be read.
pub(crate) fn declaration(
    role: Role,
    arguments: &TokenStream,
    item: &TokenStream,
    errors: &mut Errors,
) -> Option<Declaration> {
    let item = annotated(role, item, errors)?;
    size::check(role, arguments, errors)?;
    Some(as_far_as_readable(role, arguments.clone(), item, errors))
}

/// More would be a tuple that the run-time half knows nothing of.
const MOST_ADVECTED: usize = 6;

/// The annotated struct.
fn annotated(role: Role, item: &TokenStream, errors: &mut Errors) -> Option<ItemStruct> {
    let item: ItemStruct = match syn::parse2(item.clone()) {
        Ok(item) => item,
        Err(error) => {
            // Of what is no item the compiler has told before.
            if syn::parse2::<Item>(item.clone()).is_ok() {
                errors.push(error.span(), format!("`{}` belongs on a struct with named fields", role.attribute()));
            }
            return None;
        }
    };
    if let Some(again) = declared_again(&item) {
        errors.push_over(
            again,
            "this struct is declared twice: give each declaration a struct of its own, and add them, `a + b`",
        );
        return None;
    }
    Some(item)
}

/// A second attribute of ours, by the name that it is written with.
pub(crate) fn declared_again(item: &ItemStruct) -> Option<&Path> {
    item.attrs.iter().map(syn::Attribute::path).find(|path| {
        let is_ours = path.segments.len() == 1 || path.segments.first().is_some_and(|first| first.ident == "liestep");
        is_ours && path.segments.last().is_some_and(|last| last.ident == "lagrangian" || last.ident == "force")
    })
}

/// The arguments as written.
#[derive(Default)]
struct Arguments {
    group: Option<group::Named>,
    /// Name, field, and whether it is given for each step.
    advected: Vec<(Ident, Ident, bool)>,
    expression: Option<Expr>,
    root: Option<Path>,
    /// With its key.
    generators: Option<(Ident, ExprArray)>,
    /// Whether an argument has come without a name, which one message says.
    has_nameless: bool,
}

/// The declaration as far as it can be read.
pub(crate) fn as_far_as_readable(
    role: Role,
    arguments: TokenStream,
    item: ItemStruct,
    errors: &mut Errors,
) -> Declaration {
    // In braces that span the last token, so that what ends too early is reported there.
    let last = arguments.clone().into_iter().last().map_or(Span::call_site(), |token| token.span());
    let mut braces = proc_macro2::Group::new(Delimiter::Brace, arguments);
    braces.set_span(last);
    let parser = |input: ParseStream| {
        let content;
        braced!(content in input);
        Ok(arguments_from(role, &content, errors))
    };
    let arguments = parser.parse2(TokenTree::Group(braces).into()).unwrap_or_else(|error| {
        // What a mistake has left unread isn't another.
        if errors.is_empty() {
            errors.extend(error);
        }
        Arguments::default()
    });
    // What seems to be missing may stand in an argument that couldn't be read.
    let is_readable = errors.is_empty();
    let (group_path, group) = group::group(arguments.group, arguments.generators, is_readable, errors);
    if arguments.expression.is_none() && is_readable {
        let message = match role {
            Role::Lagrangian => "the Lagrangian is missing: write `l_d = …` with an expression in `F` and `h`",
            Role::Force => "the virtual work is missing: write `work = …`, linear in `eta` and `eta_next`",
        };
        errors.push(Span::call_site(), message);
    }
    let (mut fields, unreadable) = fields(role, &item, errors);
    if errors.is_empty() {
        points(&mut fields, &group, errors);
    }
    let scalar = scalar(&item, errors);
    let advected =
        advected(role, &arguments.advected, &fields, &unreadable, group_path.as_ref().map(|_| &group), errors);
    let has_names = matches!(item.fields, Fields::Named(_));
    let has_meaning = is_readable && has_names && group_path.is_some() && !errors.hides_the_rest();
    Declaration {
        role,
        root: arguments.root,
        group_path,
        group,
        advected,
        expression: arguments.expression.filter(|_| has_meaning),
        fields,
        unreadable,
        scalar,
        item,
    }
}

/// Reads `key = value` pairs; after a syntax error it goes on behind the next comma.
fn arguments_from(role: Role, input: ParseStream, errors: &mut Errors) -> Arguments {
    let mut arguments = Arguments::default();
    while !input.is_empty() {
        if let Err(error) = argument(role, input, &mut arguments, errors) {
            errors.extend(error);
            skip_argument(input);
        }
    }
    arguments
}

fn skip_argument(input: ParseStream) {
    while !input.is_empty() && !input.peek(Token![,]) {
        let _ = input.parse::<TokenTree>();
    }
    let _ = input.parse::<Token![,]>();
}

fn argument(role: Role, input: ParseStream, arguments: &mut Arguments, errors: &mut Errors) -> syn::Result<()> {
    let known = ["group", "advected", "given", role.key(), "generators", "crate"];
    let Some(key) = key(input, &known) else {
        if !arguments.has_nameless {
            errors.push(input.span(), format!("arguments have names: write `group = SO3`, `{} = …`", role.key()));
        }
        arguments.has_nameless = true;
        skip_argument(input);
        return Ok(());
    };
    let mut once = |taken: bool| {
        if taken {
            errors.push(key.span(), format!("`{key}` is given twice: remove one"));
        }
    };
    match key.to_string().as_str() {
        "group" => {
            once(arguments.group.is_some());
            equals(&key, input)?;
            without_quotes(&key, input)?;
            arguments.group = Some(group::named(input, errors)?);
        }
        "crate" => {
            once(arguments.root.is_some());
            equals(&key, input)?;
            without_quotes(&key, input)?;
            arguments.root = Some(input.call(Path::parse_mod_style)?);
        }
        expression if expression == role.key() => {
            once(arguments.expression.is_some());
            equals(&key, input)?;
            arguments.expression = Some(input.parse()?);
        }
        "generators" => {
            once(arguments.generators.is_some());
            equals(&key, input)?;
            arguments.generators = Some((key, group::array(input)?));
        }
        pairs @ ("advected" | "given") => {
            let is_given = pairs == "given";
            if !input.peek(syn::token::Paren) {
                let example = if is_given { "given(u = torque)" } else { "advected(w = up)" };
                let message = format!("write `{example}`: a name for the expression, then the field");
                return Err(syn::Error::new(key.span(), message));
            }
            let content;
            parenthesized!(content in input);
            let pairs = content.parse_terminated(advected_pair, Token![,]);
            // What is left after a mistake would be reported as unexpected.
            content.parse::<TokenStream>()?;
            arguments.advected.extend(pairs?.into_iter().map(|(name, field)| (name, field, is_given)));
        }
        other => {
            let near = suggestion(other, known);
            let list = if near.is_empty() { format!("\nknown: {}", known.join(", ")) } else { String::new() };
            let attribute = role.attribute();
            return Err(syn::Error::new(
                key.span(),
                format!("`{other}` isn't an argument of `{attribute}`{near}{list}"),
            ));
        }
    }
    if !input.is_empty() {
        input.parse::<Token![,]>()?;
    }
    Ok(())
}

/// The name of an argument, known or followed by what it would be given.
fn key(input: ParseStream, known: &[&str]) -> Option<Ident> {
    let ahead = input.fork();
    let key = ahead.call(Ident::parse_any).ok()?;
    let is_given = ahead.peek(Token![=]) || ahead.peek(syn::token::Paren);
    (is_given || known.iter().any(|name| key == name)).then(|| input.call(Ident::parse_any).ok())?
}

fn equals(key: &Ident, input: ParseStream) -> syn::Result<()> {
    if !input.peek(Token![=]) {
        return Err(syn::Error::new(input.span(), format!("write `{key} = …`")));
    }
    input.parse::<Token![=]>().map(|_| ())
}

/// A mistake where there is text in the place of a name.
fn without_quotes(key: &Ident, input: ParseStream) -> syn::Result<()> {
    match input.fork().parse::<syn::LitStr>() {
        Ok(text) => {
            let name = text.value();
            Err(syn::Error::new(text.span(), format!("write the name without quotes: `{key} = {name}`")))
        }
        Err(_) => Ok(()),
    }
}

fn advected_pair(input: ParseStream) -> syn::Result<(Ident, Ident)> {
    if !input.peek(Ident::peek_any) {
        return Err(input.error("write `w = up`: a name for the expression, then the field"));
    }
    let name: Ident = input.parse()?;
    if !input.peek(Token![=]) {
        let message = format!("write `{name} = field`: the field holds the spatial value of `{name}`");
        return Err(syn::Error::new(name.span(), message));
    }
    input.parse::<Token![=]>()?;
    without_quotes(&name, input)?;
    let span = input.span();
    let message = format!("write `{name} = field` with the name of a field and nothing else");
    let field = input.parse().map_err(|_| syn::Error::new(span, &message))?;
    if !input.is_empty() && !input.peek(Token![,]) {
        return Err(input.error(message));
    }
    Ok((name, field))
}

/// The fields, and the names of those whose type has no meaning.
fn fields(role: Role, item: &ItemStruct, errors: &mut Errors) -> (Vec<Field>, Vec<String>) {
    let Fields::Named(named) = &item.fields else {
        let what = match role {
            Role::Lagrangian => "a Lagrangian",
            Role::Force => "a force",
        };
        errors.push(item.ident.span(), format!("{what} is a struct with named fields: its parameters"));
        return Default::default();
    };
    let (mut fields, mut unreadable) = (Vec::new(), Vec::new());
    for field in &named.named {
        let Some(name) = field.ident.clone() else { continue };
        check_free(role, &name, errors);
        if let Some(kind) = field_kind(&field.ty, item) {
            fields.push(Field { name, kind, at: field.ty.span() });
        } else {
            unreadable.push(name.unraw().to_string());
            errors.push_over(
                &field.ty,
                format!(
                    "this type has no meaning in {}: use f64, Vector3<f64>, Point3<f64>, Matrix3<f64>, \
                     NonstandardInertia, DiagonalNonstandardInertia or Inertia (or the same with the struct's type \
                     parameter)",
                    role.noun()
                ),
            );
        }
    }
    (fields, unreadable)
}

/// A mistake where a parameter has a name that means something else.
fn check_free(role: Role, name: &Ident, errors: &mut Errors) {
    let (unraw, the) = (name.unraw().to_string(), role.definite());
    if role.reserved().contains(&unraw.as_str()) {
        errors.push_decisive(name.span(), format!("`{unraw}` already has a meaning in {the}: choose another name"));
    }
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
        "Vector2" | "Vector3" | "Vector4" | "Vector5" | "Vector6" => FieldKind::Vector(digit(&name)?),
        "Point1" | "Point2" | "Point3" => FieldKind::Point(digit(&name)? + 1),
        "Matrix2" | "Matrix3" | "Matrix4" | "Matrix5" | "Matrix6" => FieldKind::Matrix(digit(&name)?),
        "ContravariantVector" => FieldKind::Advected(Variance::Vector, length(ty)?),
        "ContravariantTensor" => FieldKind::Advected(Variance::Contravariant, length(ty)?),
        "CovariantTensor" => FieldKind::Advected(Variance::Covariant, length(ty)?),
        "MixedTensor" => FieldKind::Advected(Variance::Mixed, length(ty)?),
        "NonstandardInertia" | "Inertia" => FieldKind::SymmetricInertia,
        "DiagonalNonstandardInertia" => FieldKind::DiagonalInertia,
        _ if item.generics.type_params().any(|parameter| parameter.ident == name) => FieldKind::Scalar,
        _ => return None,
    })
}

/// The number in a type's arguments, `3` in `MixedTensor<f64, 3>`.
fn length(ty: &Type) -> Option<usize> {
    let PathArguments::AngleBracketed(arguments) = &last_segment(ty)?.arguments else { return None };
    match arguments.args.last()? {
        GenericArgument::Const(Expr::Lit(literal)) => match &literal.lit {
            syn::Lit::Int(integer) => integer.base10_parse().ok(),
            _ => None,
        },
        _ => None,
    }
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

/// Points belong to the space that the group acts on; after a mistake they are taken for vectors of that space.
fn points(fields: &mut [Field], group: &Group, errors: &mut Errors) {
    for field in fields {
        let FieldKind::Point(rows) = field.kind else { continue };
        let (name, size) = (field.plain_name(), group.size);
        let message = if !group.is_affine() {
            format!(
                "`{name}` is a point, but this group moves vectors only, as it leaves the origin: use Vector{size}<f64>"
            )
        } else if rows != size {
            let (found, wanted) = (rows - 1, size - 1);
            format!(
                "`{name}` is a point of {found} coordinates, but the group moves points of {wanted}: use \
                 Point{wanted}<f64>"
            )
        } else {
            continue;
        };
        errors.push(field.at, message);
        field.kind = FieldKind::Vector(size);
    }
}

fn advected(
    role: Role,
    pairs: &[(Ident, Ident, bool)],
    fields: &[Field],
    unreadable: &[String],
    group: Option<&Group>,
    errors: &mut Errors,
) -> Vec<AdvectedParameter> {
    let mut parameters: Vec<AdvectedParameter> = Vec::new();
    for &(ref name, ref field, is_given) in pairs {
        let unraw = name.unraw().to_string();
        let field_names: Vec<String> = fields.iter().map(Field::plain_name).collect();
        if field_names.contains(&unraw) {
            errors.push_decisive(name.span(), format!("`{unraw}` is a field already: choose another name"));
            continue;
        }
        check_free(role, name, errors);
        if parameters.len() == MOST_ADVECTED {
            let message =
                format!("at most {MOST_ADVECTED} are advected: declare the rest in a term of its own, and add it");
            errors.push_decisive(name.span(), message);
            break;
        }
        if parameters.iter().any(|other| other.name == *name) {
            errors.push(name.span(), format!("`{unraw}` is declared twice: remove one"));
            continue;
        }
        let wanted = field.unraw().to_string();
        let index = field_names.iter().position(|known| *known == wanted);
        if index.is_none() && !unreadable.contains(&wanted) {
            let near = suggestion(&wanted, field_names.iter().map(String::as_str));
            errors.push(field.span(), format!("the struct has no field `{wanted}`{near}"));
        }
        if let Some(found) = index.and_then(|index| fields.get(index)).filter(|_| is_given) {
            if !found.kind.can_be_given() {
                let message =
                    format!("a step is given numbers: make `{wanted}` an f64, a Vector3<f64> or a Matrix3<f64>");
                errors.push_decisive(found.at, message);
            }
        } else if let (Some(found), Some(group)) = (index.and_then(|index| fields.get(index)), group)
            && let size = group.size
            && !found.kind.is_carried_by(size)
            && !matches!(found.kind, FieldKind::Point(_))
        {
            let shape = found.kind.shape().describe();
            let message = if found.kind.is_wrapped() {
                format!("`{wanted}` is {shape}, but the group's matrices have {size} rows: write {size} for its size")
            } else {
                let point = match found.kind {
                    FieldKind::Vector(rows @ 1..=3) if group.is_affine() && rows + 1 == size => {
                        format!(", or Point{rows}<f64> for a point")
                    }
                    _ => String::new(),
                };
                format!("`{wanted}` is {shape}, but the group carries a vector of {size}: use Vector{size}<f64>{point}")
            };
            errors.push_decisive(found.at, message);
        }
        parameters.push(AdvectedParameter { name: name.clone(), field: index, is_given });
    }
    parameters
}
