//! A declaration after parsing: the struct, the attribute's arguments, and the properties that the fields' types imply.

use proc_macro2::Span;
use syn::ext::IdentExt as _;
use syn::{Expr, Ident, ItemStruct, Path};

use super::Shape;
use crate::mathematics::derive::View;
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
    /// `#[nonholonomic(… zero = …)]`.
    Nonholonomic,
    /// `#[hamiltonian(… h = …)]`, of texts alone.
    Hamiltonian,
}

impl Role {
    /// The argument that holds the expression.
    pub fn key(self) -> &'static str {
        match self {
            Self::Lagrangian => "l_d",
            Self::Force => "work",
            Self::Constraint | Self::Nonholonomic => "zero",
            Self::Hamiltonian => "h",
        }
    }

    /// The kind of the expression, in a sentence.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Lagrangian => "a Lagrangian",
            Self::Force => "virtual work",
            Self::Constraint => "a constraint",
            Self::Nonholonomic => "a constraint on velocities",
            Self::Hamiltonian => "a Hamiltonian",
        }
    }

    /// The expression of one declaration, in a sentence.
    pub fn definite(self) -> &'static str {
        match self {
            Self::Lagrangian => "the Lagrangian",
            Self::Force => "the virtual work",
            Self::Constraint | Self::Nonholonomic => "the constraint",
            Self::Hamiltonian => "the Hamiltonian",
        }
    }

    /// The reserved names of an expression, on one body or on several. No parameter, `let` or parameter of a function
    /// may have one of them: the compiled code would find that declaration in its place.
    pub fn reserved(self, is_product: bool) -> &'static [&'static str] {
        match self {
            Self::Force if !is_product => &["F", "I", "h", "hat", "vee", "log", "exp", "inverse", "eta", "eta_next"],
            Self::Lagrangian | Self::Force | Self::Nonholonomic | Self::Hamiltonian => {
                &["F", "I", "h", "hat", "vee", "log", "exp", "inverse"]
            }
            // A constraint has no steps.
            Self::Constraint => &["I", "hat", "vee", "log", "exp", "inverse"],
        }
    }

    /// The name of the attribute.
    pub fn attribute(self) -> &'static str {
        match self {
            Self::Lagrangian => "lagrangian",
            Self::Force => "force",
            Self::Constraint => "constraint",
            Self::Nonholonomic => "nonholonomic",
            Self::Hamiltonian => "hamiltonian",
        }
    }
}

/// `#[lagrangian(group = …, advected(…), l_d = …, crate = …)]` on a struct.
pub struct Declaration {
    pub role: Role,
    pub item: ItemStruct,
    /// The path of liestep, if not `::liestep`.
    pub root: Option<Path>,
    pub group: Group,
    /// The generators of a user's group, each at its place.
    pub generators: Vec<Span>,
    /// The increments, one for each factor of the group.
    pub factors: Vec<Factor>,
    pub advected: Vec<AdvectedParameter>,
    /// The Lagrangian, the virtual work of a force, or a constraint; `None` where a mistake elsewhere hides its
    /// meaning.
    pub expression: Option<Expr>,
    /// The velocities and the discretisation of a continuous Lagrangian `l`, or of a constraint on velocities; the momenta of
    /// a Hamiltonian.
    pub continuous: Option<Continuous>,
    /// The index of `E_0` among the advected and given parameters, if a pace has rewritten the expression.
    pub energy: Option<usize>,
    /// The names of the displacements of a force on several bodies, one for each factor of the group.
    pub displacements: Vec<Ident>,
    /// The argument `gradients`, if derivatives of a step are requested.
    pub gradients: Option<Span>,
    pub fields: Vec<Field>,
    /// The fields whose type has no meaning.
    pub unreadable: Vec<String>,
    pub scalar: Scalar,
    /// Whether the declaration is read at run time, without a compiler that would report a missing `&` or decimal
    /// point.
    pub is_text: bool,
}

/// An increment: `F`, or one of those that `group(F_1 = SO3, …)` names.
pub struct Factor {
    /// The name without `r#`.
    pub name: String,
    pub place: Span,
    /// The group's name as written; `None` after a mistake.
    pub path: Option<Path>,
}

/// An example of names for the velocities of these factors: `velocity = Omega`, or `velocity(Omega_1, v)`.
pub fn named_velocities(factors: &[Factor]) -> String {
    match factors {
        [] | [_] => "velocity = Omega".to_owned(),
        several => format!("velocity({})", named(several, ["Omega", "v"])),
    }
}

/// An example of names for the displacements of these factors: `displacement(eta_1, s)`.
pub fn named_displacements(factors: &[Factor]) -> String {
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
    pub fn group_name(&self) -> String {
        let segment = self.path.as_ref().and_then(|path| path.segments.last());
        segment.map(|segment| segment.ident.to_string()).unwrap_or_default()
    }
}

/// The arguments that belong to `l = …`.
pub struct Continuous {
    /// The names of `ξ`, one for each factor of the group; a term without a velocity may leave them out.
    pub velocities: Vec<Ident>,
    /// The discretisation of `l`; `None` if only the continuous equations are requested.
    pub discretisation: Option<Discretisation>,
}

/// `discretise = trapezoid(Cayley)`.
#[derive(Clone, Copy)]
pub struct Discretisation {
    pub quadrature: Quadrature,
    pub coordinates: Coordinates,
    /// The first and the last token.
    pub place: [Span; 2],
}

/// The points of a step at which `l` is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quadrature {
    /// The trapezoidal rule at both ends of a step, `(h/2) (l(ξ, w) + l(ξ, F⁻¹·w))`.
    Trapezoid,
    /// In the middle of the curve, `h l(ξ, τ(hξ/2)⁻¹·w)`.
    Midpoint,
    /// In the middle of the chord, `h l(ξ, (w + F⁻¹·w)/2)`.
    Chord,
}

/// The velocity of a step as a function of `F`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// The matrix `ξ̂ = (F − I)/h`, near the algebra and not in it.
    Ambient,
    /// `hξ = cay⁻¹(F)`.
    Cayley,
    /// `hξ = log F`.
    Exponential,
}

/// `w = up`: in the expression `w` is the field `up`, moved by the group or prescribed for each step.
pub struct AdvectedParameter {
    pub name: Ident,
    /// The index of the field; `None` where there is no such field of a known type.
    pub field: Option<usize>,
    /// Whether the parameter is a prescribed value of the step, which the group doesn't move: `given(…)`.
    pub is_given: bool,
    /// The bodies that move the parameter.
    pub seen: View,
}

impl AdvectedParameter {
    /// The name without `r#`.
    pub fn plain_name(&self) -> String {
        self.name.unraw().to_string()
    }
}

impl Declaration {
    /// The names of the velocities in `l`.
    pub fn velocities(&self) -> &[Ident] {
        self.continuous.as_ref().map_or(&[], |continuous| &continuous.velocities)
    }

    /// The names of a factor's displacements at both ends of a force's step; `None` where they have no names.
    pub fn displacement(&self, factor: usize) -> Option<[String; 2]> {
        let name = match self.displacements.get(factor) {
            Some(name) => name.unraw().to_string(),
            None if self.role == Role::Force && !self.group.is_product() => "eta".to_owned(),
            None => return None,
        };
        let next = format!("{name}_next");
        Some([name, next])
    }

    /// The name of the velocity of a factor in `l`.
    pub fn velocity(&self, factor: usize) -> Option<&Ident> {
        self.velocities().get(factor)
    }

    /// The name of the velocity of a factor for messages, `Omega` where it has none.
    pub fn velocity_or_omega(&self, factor: usize) -> String {
        self.velocity(factor).map_or_else(|| "Omega".to_owned(), ToString::to_string)
    }

    /// An example of a product with the velocity, `a.dot(&Omega)`; texts need no `&`.
    pub fn product_with_velocity(&self) -> String {
        format!("`a.dot({}{})`", if self.is_text { "" } else { "&" }, self.velocity_or_omega(0))
    }

    /// The name of the velocity of a factor in formulas.
    pub fn name_of_velocity(&self, factor: usize) -> String {
        match self.velocities().get(factor) {
            Some(name) => name.unraw().to_string(),
            None if self.group.is_product() => format!("ξ_{}", factor + 1),
            None => "ξ".to_owned(),
        }
    }

    /// The discretisation of `l`, if one is requested.
    pub fn discretisation(&self) -> Option<Discretisation> {
        self.continuous.as_ref()?.discretisation
    }

    /// The kind of an advected parameter's field; a plain vector after a mistake.
    pub fn advected_kind(&self, index: usize) -> FieldKind {
        let parameter = self.advected.get(index);
        let size = match parameter.map(|w| w.seen) {
            Some(View::Relative { of, .. } | View::Configuration(of)) => {
                let factor = self.group.factor(of);
                let is_place = factor.is_added;
                return if is_place {
                    FieldKind::Place(factor.dimension())
                } else {
                    FieldKind::Configuration(factor.size)
                };
            }
            Some(View::From(factor)) => self.group.factor(factor).size,
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
pub struct Field {
    pub name: Ident,
    pub kind: FieldKind,
    /// The span of the field's type.
    pub at: Span,
}

impl Field {
    /// The name without `r#`.
    pub fn plain_name(&self) -> String {
        self.name.unraw().to_string()
    }
}

/// The properties that a field's type implies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
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
    /// `NonstandardInertia`.
    SymmetricInertia,
    /// `Inertia`.
    StandardInertia,
    /// `DiagonalNonstandardInertia`.
    DiagonalInertia,
}

impl FieldKind {
    /// The action of the group on a field of this kind: a plain vector is a covector.
    pub fn variance(self) -> Variance {
        match self {
            Self::Advected(variance, _) => variance,
            Self::Point(_) => Variance::Vector,
            Self::Given(_) | Self::Configuration(_) | Self::Place(_) => Variance::Fixed,
            _ => Variance::Covector,
        }
    }

    /// Whether a group with matrices of this size can move a field of this kind.
    pub fn is_carried_by(self, size: usize) -> bool {
        matches!(self, Self::Vector(rows) | Self::Point(rows) | Self::Advected(_, rows) if rows == size)
    }

    /// Whether the type of a field's value names the action of the group.
    pub fn is_wrapped(self) -> bool {
        matches!(self, Self::Advected(..))
    }

    /// Whether the type promises a symmetric and positive matrix.
    pub fn is_inertia(self) -> bool {
        matches!(self, Self::SymmetricInertia | Self::StandardInertia | Self::DiagonalInertia)
    }

    /// Whether a field of this kind can be prescribed for each step.
    pub fn can_be_given(self) -> bool {
        matches!(self, Self::Scalar | Self::Vector(_) | Self::Matrix(_))
    }

    pub fn shape(self) -> Shape {
        match self {
            Self::Scalar | Self::Place(1) => Shape::Scalar,
            Self::Given(shape) => shape,
            Self::Vector(rows) | Self::Point(rows) | Self::Place(rows) => Shape::Matrix(rows, 1),
            Self::Advected(variance, rows) => Shape::Matrix(rows, if variance.is_tensor() { rows } else { 1 }),
            Self::Matrix(rows) | Self::Configuration(rows) => Shape::Matrix(rows, rows),
            Self::SymmetricInertia | Self::StandardInertia | Self::DiagonalInertia => Shape::Matrix(3, 3),
        }
    }
}

/// The scalar that all fields share.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// `f64` or `f32`.
    Primitive(Ident),
    /// A type parameter of the struct.
    Parameter(Ident),
}
