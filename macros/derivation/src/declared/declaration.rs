//! A declaration after parsing: the struct, the attribute's arguments, and the properties that the fields' types imply.

use proc_macro2::Span;
use syn::ext::IdentExt as _;
use syn::{Expr, Ident, ItemStruct, Path};

use super::Shape;
use crate::mathematics::derive::Seen;
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::Variance;

/// The kind of a declaration, one for each attribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// `#[lagrangian(… l_d = …)]`.
    Lagrangian,
    /// `#[force(… work = …)]`.
    Force,
    /// `#[constraint(… zero = …)]`.
    Constraint,
}

impl Role {
    /// The argument that holds the expression.
    pub(crate) fn key(self) -> &'static str {
        match self {
            Self::Lagrangian => "l_d",
            Self::Force => "work",
            Self::Constraint => "zero",
        }
    }

    /// The kind of the expression, in a sentence.
    pub(crate) fn noun(self) -> &'static str {
        match self {
            Self::Lagrangian => "a Lagrangian",
            Self::Force => "virtual work",
            Self::Constraint => "a constraint",
        }
    }

    /// The expression of one declaration, in a sentence.
    pub(crate) fn definite(self) -> &'static str {
        match self {
            Self::Lagrangian => "the Lagrangian",
            Self::Force => "the virtual work",
            Self::Constraint => "the constraint",
        }
    }

    /// The reserved names of an expression, on one body or on several. No parameter, `let` or parameter of a function
    /// may have one of them: the compiled code would find that declaration in its place.
    pub(crate) fn reserved(self, is_product: bool) -> &'static [&'static str] {
        match self {
            Self::Force if !is_product => &["F", "I", "h", "hat", "vee", "log", "exp", "inverse", "eta", "eta_next"],
            Self::Lagrangian | Self::Force => &["F", "I", "h", "hat", "vee", "log", "exp", "inverse"],
            // A constraint has no steps.
            Self::Constraint => &["I", "hat", "vee", "log", "exp", "inverse"],
        }
    }

    /// The name of the attribute.
    pub(crate) fn attribute(self) -> &'static str {
        match self {
            Self::Lagrangian => "lagrangian",
            Self::Force => "force",
            Self::Constraint => "constraint",
        }
    }
}

/// `#[lagrangian(group = …, advected(…), l_d = …, crate = …)]` on a struct.
pub(crate) struct Declaration {
    pub(crate) role: Role,
    pub(crate) item: ItemStruct,
    /// The path of liestep, if not `::liestep`.
    pub(crate) root: Option<Path>,
    pub(crate) group: Group,
    /// The increments, one for each factor of the group.
    pub(crate) factors: Vec<Factor>,
    pub(crate) advected: Vec<AdvectedParameter>,
    /// The Lagrangian, the virtual work of a force, or the constraint; `None` where a mistake elsewhere hides its
    /// meaning.
    pub(crate) expression: Option<Expr>,
    /// The velocities and the discretisation of a continuous Lagrangian `l`.
    pub(crate) continuous: Option<Continuous>,
    /// The index of `E_0` among the advected and given parameters, if a pace has rewritten the expression.
    pub(crate) energy: Option<usize>,
    /// The names of the displacements of a force on several bodies, one for each factor of the group.
    pub(crate) displacements: Vec<Ident>,
    /// The argument `gradients`, if derivatives of a step are requested.
    pub(crate) gradients: Option<Span>,
    pub(crate) fields: Vec<Field>,
    /// The fields whose type has no meaning.
    pub(crate) unreadable: Vec<String>,
    pub(crate) scalar: Scalar,
    /// Whether the declaration is read at run time, without a compiler that would report a missing `&` or decimal
    /// point.
    pub(crate) is_text: bool,
}

/// An increment: `F`, or one of those that `group(F_1 = SO3, …)` names.
pub(crate) struct Factor {
    /// The name without `r#`.
    pub(crate) name: String,
    pub(crate) place: Span,
    /// The group's name as written; `None` after a mistake.
    pub(crate) path: Option<Path>,
}

/// An example of names for the velocities of these factors: `velocity = Omega`, or `velocity(Omega_1, v)`.
pub(crate) fn named_velocities(factors: &[Factor]) -> String {
    match factors {
        [] | [_] => "velocity = Omega".to_owned(),
        several => format!("velocity({})", named(several, ["Omega", "v"])),
    }
}

/// An example of names for the displacements of these factors: `displacement(eta_1, s)`.
pub(crate) fn named_displacements(factors: &[Factor]) -> String {
    format!("displacement({})", named(factors, ["eta", "s"]))
}

/// A name for each factor, one word for rotations and one for translations.
fn named(factors: &[Factor], [turn, shift]: [&'static str; 2]) -> String {
    let letters = |factor: &Factor| if factor.group_name() == "SO3" { turn } else { shift };
    let name = |(at, factor): (usize, &Factor)| {
        let alike = |factors: &[Factor]| factors.iter().filter(|other| letters(other) == letters(factor)).count();
        if alike(factors) == 1 {
            letters(factor).to_owned()
        } else {
            format!("{}_{}", letters(factor), alike(&factors[..=at]))
        }
    };
    factors.iter().enumerate().map(name).collect::<Vec<_>>().join(", ")
}

impl Factor {
    /// The group's name without its module path.
    pub(crate) fn group_name(&self) -> String {
        let segment = self.path.as_ref().and_then(|path| path.segments.last());
        segment.map(|segment| segment.ident.to_string()).unwrap_or_default()
    }
}

/// The arguments that belong to `l = …`.
pub(crate) struct Continuous {
    /// The names of `ξ`, one for each factor of the group; a term without a velocity may leave them out.
    pub(crate) velocities: Vec<Ident>,
    /// The discretisation of `l`; `None` if only the continuous equations are requested.
    pub(crate) discretisation: Option<Discretisation>,
}

/// `discretise = trapezoid(Cayley)`.
#[derive(Clone, Copy)]
pub(crate) struct Discretisation {
    pub(crate) quadrature: Quadrature,
    pub(crate) coordinates: Coordinates,
    /// The first and the last token.
    pub(crate) place: [Span; 2],
}

/// The points of a step at which `l` is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Quadrature {
    /// At both ends, `(h/2) (l(ξ, w) + l(ξ, F⁻¹·w))`.
    Trapezoid,
    /// In the middle of the curve, `h l(ξ, τ(hξ/2)⁻¹·w)`.
    Midpoint,
    /// In the middle of the chord, `h l(ξ, (w + F⁻¹·w)/2)`.
    Chord,
}

/// The velocity of a step as a function of `F`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coordinates {
    /// The matrix `ξ̂ = (F − I)/h`, near the algebra and not in it.
    Ambient,
    /// `hξ = cay⁻¹(F)`.
    Cayley,
    /// `hξ = log F`.
    Exponential,
}

/// `w = up`: in the expression `w` is the field `up`, moved by the group or prescribed for each step.
pub(crate) struct AdvectedParameter {
    pub(crate) name: Ident,
    /// The index of the field; `None` where there is no such field of a known type.
    pub(crate) field: Option<usize>,
    /// Whether it is a value of the step, which the group doesn't move: `given(…)`.
    pub(crate) is_given: bool,
    /// The bodies that move it.
    pub(crate) seen: Seen,
}

impl AdvectedParameter {
    /// The name without `r#`.
    pub(crate) fn plain_name(&self) -> String {
        self.name.unraw().to_string()
    }
}

impl Declaration {
    /// The names of the velocities in `l`.
    pub(crate) fn velocities(&self) -> &[Ident] {
        self.continuous.as_ref().map_or(&[], |continuous| &continuous.velocities)
    }

    /// The names of a factor's displacements at both ends of a force's step; `None` where they have no names.
    pub(crate) fn displacement(&self, factor: usize) -> Option<[String; 2]> {
        let name = match self.displacements.get(factor) {
            Some(name) => name.unraw().to_string(),
            None if self.role == Role::Force && !self.group.is_product() => "eta".to_owned(),
            None => return None,
        };
        let next = format!("{name}_next");
        Some([name, next])
    }

    /// The name of the velocity of a factor in `l`.
    pub(crate) fn velocity(&self, factor: usize) -> Option<&Ident> {
        self.velocities().get(factor)
    }

    /// The name of the velocity of a factor for messages, `Omega` where it has none.
    pub(crate) fn velocity_or_omega(&self, factor: usize) -> String {
        self.velocity(factor).map_or_else(|| "Omega".to_owned(), ToString::to_string)
    }

    /// The name of the velocity of a factor in formulas.
    pub(crate) fn name_of_velocity(&self, factor: usize) -> String {
        match self.velocities().get(factor) {
            Some(name) => name.unraw().to_string(),
            None if self.group.is_product() => format!("ξ_{}", factor + 1),
            None => "ξ".to_owned(),
        }
    }

    /// The discretisation of `l`, if one is requested.
    pub(crate) fn discretisation(&self) -> Option<Discretisation> {
        self.continuous.as_ref()?.discretisation
    }

    /// The kind of an advected parameter's field; a plain vector after a mistake.
    pub(crate) fn advected_kind(&self, index: usize) -> FieldKind {
        let parameter = self.advected.get(index);
        let size = match parameter.map(|w| w.seen) {
            Some(Seen::Relative { of, .. } | Seen::Configuration(of)) => {
                let factor = self.group.factor(of);
                let is_place = factor.is_added;
                return if is_place {
                    FieldKind::Place(factor.dimension())
                } else {
                    FieldKind::Configuration(factor.size)
                };
            }
            Some(Seen::From(factor)) => self.group.factor(factor).size,
            None => self.group.size,
        };
        let field = parameter.and_then(|w| self.fields.get(w.field?));
        if parameter.is_some_and(|w| w.is_given) {
            return FieldKind::Given(field.map_or(Shape::Scalar, |field| field.kind.shape()));
        }
        let kind = field.map(|field| field.kind).filter(|kind| kind.is_carried_by(size));
        kind.unwrap_or(FieldKind::Vector(size))
    }
}

/// A field of the struct.
pub(crate) struct Field {
    pub(crate) name: Ident,
    pub(crate) kind: FieldKind,
    /// The span of its type.
    pub(crate) at: Span,
}

impl Field {
    /// The name without `r#`.
    pub(crate) fn plain_name(&self) -> String {
        self.name.unraw().to_string()
    }
}

/// The properties that a field's type implies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FieldKind {
    Scalar,
    /// A vector with this number of rows.
    Vector(usize),
    /// A point with this number of homogeneous coordinates, the last of which is one.
    Point(usize),
    /// A square matrix with this number of rows.
    Matrix(usize),
    /// An advected parameter with its kind in its type.
    Advected(Variance, usize),
    /// The attitude of a body relative to another or to space, with this number of rows.
    Configuration(usize),
    /// The position of a translated body, with this number of coordinates.
    Place(usize),
    /// A parameter that is prescribed for each step: a scalar, a vector or a matrix.
    Given(Shape),
    /// `NonstandardInertia`, `Inertia`.
    SymmetricInertia,
    /// `DiagonalNonstandardInertia`.
    DiagonalInertia,
}

impl FieldKind {
    /// The action of the group on it: a plain vector is a covector.
    pub(crate) fn variance(self) -> Variance {
        match self {
            Self::Advected(variance, _) => variance,
            Self::Point(_) => Variance::Vector,
            Self::Given(_) | Self::Configuration(_) | Self::Place(_) => Variance::Fixed,
            _ => Variance::Covector,
        }
    }

    /// Whether a group with matrices of this size can move it.
    pub(crate) fn is_carried_by(self, size: usize) -> bool {
        matches!(self, Self::Vector(rows) | Self::Point(rows) | Self::Advected(_, rows) if rows == size)
    }

    /// Whether the type of its value names the action of the group.
    pub(crate) fn is_wrapped(self) -> bool {
        matches!(self, Self::Advected(..))
    }

    /// Whether it can be prescribed for each step.
    pub(crate) fn can_be_given(self) -> bool {
        matches!(self, Self::Scalar | Self::Vector(_) | Self::Matrix(_))
    }

    pub(crate) fn shape(self) -> Shape {
        match self {
            Self::Scalar | Self::Place(1) => Shape::Scalar,
            Self::Given(shape) => shape,
            Self::Vector(rows) | Self::Point(rows) | Self::Place(rows) => Shape::Matrix(rows, 1),
            Self::Advected(variance, rows) => Shape::Matrix(rows, if variance.is_tensor() { rows } else { 1 }),
            Self::Matrix(rows) | Self::Configuration(rows) => Shape::Matrix(rows, rows),
            Self::SymmetricInertia | Self::DiagonalInertia => Shape::Matrix(3, 3),
        }
    }
}

/// The scalar that all fields share.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Scalar {
    /// `f64` or `f32`.
    Primitive(Ident),
    /// A type parameter of the struct.
    Parameter(Ident),
}
