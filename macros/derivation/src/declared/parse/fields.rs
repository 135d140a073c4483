//! The struct's fields: the properties that their types imply, and their common scalar.

use proc_macro2::Span;
use syn::ext::IdentExt as _;
use syn::spanned::Spanned as _;
use syn::{Expr, Fields, GenericArgument, Ident, ItemStruct, PathArguments, Type};

use super::check_free;
use crate::declared::errors::Errors;
use crate::declared::{Field, FieldKind, Role, Scalar};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::Variance;

/// The fields of a declaration, on one body or on several, and the names of those whose type has no meaning.
pub(super) fn fields(
    (role, is_product): (Role, bool),
    item: &ItemStruct,
    errors: &mut Errors,
) -> (Vec<Field>, Vec<String>) {
    let Fields::Named(named) = &item.fields else {
        let what = match role {
            Role::Lagrangian => "a Lagrangian",
            Role::Force => "a force",
            Role::Constraint | Role::Nonholonomic => "a constraint",
            Role::Hamiltonian => "a Hamiltonian",
        };
        errors.push(item.ident.span(), format!("{what} is a struct with named fields: its parameters"));
        return Default::default();
    };
    let (mut fields, mut unreadable) = (Vec::new(), Vec::new());
    for field in &named.named {
        let Some(name) = field.ident.clone() else { continue };
        check_free((role, is_product), &name, errors);
        if let Some(kind) = field_kind(&field.ty, item) {
            fields.push(Field { name, kind, at: field.ty.span() });
        } else {
            unreadable.push(name.unraw().to_string());
            let carried = Variance::TYPES.map(|(name, _)| format!("{name}<f64, 3>")).join(", ");
            errors.push_over(
                &field.ty,
                format!(
                    "this type has no meaning in {}: use f64, Vector3<f64>, Point3<f64>, Matrix3<f64>, \
                     SVector<f64, 7>, SMatrix<f64, 7, 7>, {carried}, NonstandardInertia, DiagonalNonstandardInertia or \
                     Inertia (or the same with the struct's type parameter)",
                    role.noun()
                ),
            );
        }
    }
    (fields, unreadable)
}

fn last_segment(ty: &Type) -> Option<&syn::PathSegment> {
    match ty {
        Type::Path(path) if path.qself.is_none() => path.path.segments.last(),
        // A type that a `macro_rules!` fragment passed on is in an invisible group.
        Type::Group(group) => last_segment(&group.elem),
        Type::Paren(paren) => last_segment(&paren.elem),
        _ => None,
    }
}

/// The properties that a type implies, if it has a meaning.
pub fn field_kind(ty: &Type, item: &ItemStruct) -> Option<FieldKind> {
    let name = last_segment(ty)?.ident.to_string();
    Some(match name.as_str() {
        "f64" | "f32" => FieldKind::Scalar,
        "Vector2" | "Vector3" | "Vector4" | "Vector5" | "Vector6" => FieldKind::Vector(digit(&name)?),
        "Point1" | "Point2" | "Point3" => FieldKind::Point(digit(&name)? + 1),
        "Matrix2" | "Matrix3" | "Matrix4" | "Matrix5" | "Matrix6" => FieldKind::Matrix(digit(&name)?),
        "SVector" => FieldKind::Vector(length(ty)?),
        "SMatrix" => FieldKind::Matrix(square(ty)?),
        "NonstandardInertia" => FieldKind::SymmetricInertia,
        "Inertia" => FieldKind::StandardInertia,
        "DiagonalNonstandardInertia" => FieldKind::DiagonalInertia,
        _ if item.generics.type_params().any(|parameter| parameter.ident == name) => FieldKind::Scalar,
        _ => {
            let (_, variance) = Variance::TYPES.into_iter().find(|(own, _)| *own == name)?;
            FieldKind::Advected(variance, length(ty)?)
        }
    })
}

/// The nalgebra type of a vector of that size.
pub(super) fn vector_type(size: usize) -> String {
    if size <= 6 { format!("Vector{size}<f64>") } else { format!("SVector<f64, {size}>") }
}

/// The number in a type's arguments, `3` in `MixedTensor<f64, 3>`.
fn length(ty: &Type) -> Option<usize> {
    lengths(ty).last().copied().flatten()
}

/// The number of rows of a matrix that has as many columns.
fn square(ty: &Type) -> Option<usize> {
    match lengths(ty)[..] {
        [_, rows, columns] if rows == columns => rows,
        _ => None,
    }
}

/// The numbers in a type's arguments; none where an argument isn't a number.
fn lengths(ty: &Type) -> Vec<Option<usize>> {
    let Some(PathArguments::AngleBracketed(arguments)) = last_segment(ty).map(|segment| &segment.arguments) else {
        return Vec::new();
    };
    let number = |argument: &GenericArgument| match argument {
        GenericArgument::Const(Expr::Lit(literal)) => match &literal.lit {
            syn::Lit::Int(integer) => integer.base10_parse().ok().filter(|&length| length > 0),
            _ => None,
        },
        _ => None,
    };
    arguments.args.iter().map(number).collect()
}

/// The number that a type's name ends with.
fn digit(name: &str) -> Option<usize> {
    usize::try_from(name.chars().last()?.to_digit(10)?).ok()
}

/// The scalar of a type; an inertia without arguments has `f64`.
pub fn scalar_of(ty: &Type) -> Option<Ident> {
    let segment = last_segment(ty)?;
    match &segment.arguments {
        PathArguments::AngleBracketed(arguments) if !arguments.args.is_empty() => match arguments.args.first()? {
            GenericArgument::Type(inner) => last_segment(inner).map(|segment| segment.ident.clone()),
            _ => None,
        },
        _ if segment.ident.to_string().ends_with("Inertia") => Some(Ident::new("f64", segment.ident.span())),
        _ => Some(segment.ident.clone()),
    }
}

pub(super) fn scalar(item: &ItemStruct, errors: &mut Errors) -> Scalar {
    let mut common: Option<Ident> = None;
    for field in &item.fields {
        if field_kind(&field.ty, item).is_none() {
            continue;
        }
        let Some(scalar) = scalar_of(&field.ty) else { continue };
        let is_parameter = item.generics.type_params().any(|parameter| parameter.ident == scalar);
        if !is_parameter && scalar != "f64" && scalar != "f32" {
            // A vector without a scalar is an alias, or the compiler reports the missing argument.
            if last_segment(&field.ty).is_none_or(|segment| segment.ident != scalar) {
                errors.push(scalar.span(), "a scalar is `f64`, `f32` or a type parameter of the struct");
            }
            continue;
        }
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

/// Checks that points have the dimension of the space that the group, or one of its factors, acts on; after a mistake they count as its
/// vectors.
pub(super) fn points(fields: &mut [Field], group: &Group, errors: &mut Errors) {
    for field in fields {
        let FieldKind::Point(rows) = field.kind else { continue };
        let (name, size) = (field.plain_name(), group.size);
        if group.turning().any(|factor| factor.is_affine() && factor.size == rows) {
            continue;
        }
        if group.is_product() {
            let rows = rows - 1;
            errors.push(
                field.at,
                format!("among several bodies a point is the vector of its place: use Vector{rows}<f64>"),
            );
            field.kind = FieldKind::Vector(rows);
            continue;
        }
        let message = if group.is_affine() {
            let (found, wanted) = (rows - 1, size - 1);
            format!(
                "`{name}` is a point of {found} coordinates, but the group moves points of {wanted}: use \
                 Point{wanted}<f64>"
            )
        } else {
            format!(
                "`{name}` is a point, but this group moves vectors only, as it leaves the origin: use {}",
                vector_type(size)
            )
        };
        errors.push(field.at, message);
        field.kind = FieldKind::Vector(size);
    }
}
