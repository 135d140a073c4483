//! A declaration after parsing: the struct, the attribute's arguments, and what the fields' types promise.

use proc_macro2::Span;
use syn::ext::IdentExt as _;
use syn::{Expr, Ident, ItemStruct, Path};

use super::Shape;
use crate::mathematics::derive::View;
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::Variance;

/// What an attribute declares.
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
    pub fn key(self) -> &'static str {
        match self {
            Self::Lagrangian => "l_d",
            Self::Force => "work",
            Self::Constraint => "zero",
        }
    }

    /// What the expression is, in a sentence.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Lagrangian => "a Lagrangian",
            Self::Force => "virtual work",
            Self::Constraint => "a constraint",
        }
    }

    /// The expression of one declaration, in a sentence.
    pub fn definite(self) -> &'static str {
        match self {
            Self::Lagrangian => "the Lagrangian",
            Self::Force => "the virtual work",
            Self::Constraint => "the constraint",
        }
    }

    /// The names that mean something in each expression, on one body or on several, and can't be those of parameters, of `let`s
    /// or of what a function is called with: what is compiled finds the one that was declared, whatever else has its name.
    pub fn reserved(self, is_product: bool) -> &'static [&'static str] {
        match self {
            Self::Force if !is_product => &["F", "I", "h", "hat", "vee", "log", "exp", "inverse", "eta", "eta_next"],
            Self::Lagrangian | Self::Force => &["F", "I", "h", "hat", "vee", "log", "exp", "inverse"],
            // There are no steps in it.
            Self::Constraint => &["I", "hat", "vee", "log", "exp", "inverse"],
        }
    }

    /// The name of the attribute.
    pub fn attribute(self) -> &'static str {
        match self {
            Self::Lagrangian => "lagrangian",
            Self::Force => "force",
            Self::Constraint => "constraint",
        }
    }
}

/// `#[lagrangian(group = …, advected(…), l_d = …, crate = …)]` on a struct.
pub struct Declaration {
    pub role: Role,
    pub item: ItemStruct,
    /// Where liestep is found, if not at `::liestep`.
    pub root: Option<Path>,
    pub group: Group,
    /// The increments, one for each factor of the group.
    pub factors: Vec<Factor>,
    pub advected: Vec<AdvectedParameter>,
    /// The Lagrangian, or the virtual work of a force; `None` where a mistake elsewhere hides what it means.
    pub expression: Option<Expr>,
    /// Of a continuous Lagrangian `l`, what it is written and discretised with.
    pub continuous: Option<Continuous>,
    /// Where there is a pace, which the expression has been rewritten by, the place of `E_0` in what is advected or given.
    pub energy: Option<usize>,
    /// Of a force on several bodies the names of the displacements, one for each factor of the group.
    pub displacements: Vec<Ident>,
    /// Where the derivatives of a step are asked for.
    pub gradients: Option<Span>,
    pub fields: Vec<Field>,
    /// The fields whose type has no meaning.
    pub unreadable: Vec<String>,
    pub scalar: Scalar,
    /// Whether it is read while a program runs: no compiler will ask for the `&` of an argument or the point of a number.
    pub is_text: bool,
}

/// An increment: `F`, or one of those that `group(F_1 = SO3, …)` names.
pub struct Factor {
    /// Without `r#`.
    pub name: String,
    pub place: Span,
    /// The group's name as written; `None` after a mistake.
    pub path: Option<Path>,
}

/// How velocities of these factors may be named: `velocity = Omega`, or `velocity(Omega_1, v)`.
pub fn named_velocities(factors: &[Factor]) -> String {
    match factors {
        [] | [_] => "velocity = Omega".to_owned(),
        several => format!("velocity({})", named(several, ["Omega", "v"])),
    }
}

/// How displacements of these factors may be named: `displacement(eta_1, s)`.
pub fn named_displacements(factors: &[Factor]) -> String {
    format!("displacement({})", named(factors, ["eta", "s"]))
}

/// A name for each factor, by what turns and by what is translated.
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
    /// The group's name without what it is found in.
    pub fn group_name(&self) -> String {
        let segment = self.path.as_ref().and_then(|path| path.segments.last());
        segment.map(|segment| segment.ident.to_string()).unwrap_or_default()
    }
}

/// What belongs to `l = …`.
pub struct Continuous {
    /// The names of `ξ`, one for each factor of the group; a term without a velocity may leave them out.
    pub velocities: Vec<Ident>,
    /// How `l_d` is made of it; left out where only the continuous equations are wanted.
    pub discretisation: Option<Discretisation>,
}

/// `discretise = trapezoid(Cayley)`.
#[derive(Clone, Copy)]
pub struct Discretisation {
    pub quadrature: Quadrature,
    pub coordinates: Coordinates,
    /// From the first token to the last.
    pub place: [Span; 2],
}

/// Where in a step `l` is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quadrature {
    /// At both ends, `(h/2) (l(ξ, w) + l(ξ, F⁻¹·w))`.
    Trapezoid,
    /// In the middle of the curve, `h l(ξ, τ(hξ/2)⁻¹·w)`.
    Midpoint,
    /// In the middle of the chord, `h l(ξ, (w + F⁻¹·w)/2)`.
    Chord,
}

/// What the velocity of a step is, as a function of `F`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// The matrix `ξ̂ = (F − I)/h`, near the algebra and not in it.
    Ambient,
    /// `hξ = cay⁻¹(F)`.
    Cayley,
    /// `hξ = log F`.
    Exponential,
}

/// `w = up`: `w` in the expression is the field `up`, carried by the group, or given for each step.
pub struct AdvectedParameter {
    pub name: Ident,
    /// The index of the field; `None` where there is no such field of a known type.
    pub field: Option<usize>,
    /// Whether it is a value of the step, which the group doesn't move: `given(…)`.
    pub is_given: bool,
    /// Which bodies move it.
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

    /// Of a force, what a factor's displacements at both ends of a step are called; `None` where that is left out.
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

    /// The same for messages, which show one where none is named.
    pub fn velocity_or_omega(&self, factor: usize) -> String {
        self.velocity(factor).map_or_else(|| "Omega".to_owned(), ToString::to_string)
    }

    /// The name of the velocity of a factor in print.
    pub fn name_of_velocity(&self, factor: usize) -> String {
        match self.velocities().get(factor) {
            Some(name) => name.unraw().to_string(),
            None if self.group.is_product() => format!("ξ_{}", factor + 1),
            None => "ξ".to_owned(),
        }
    }

    /// How `l` is discretised.
    pub fn discretisation(&self) -> Option<Discretisation> {
        self.continuous.as_ref()?.discretisation
    }

    /// What an advected parameter's field promises; a plain vector after a mistake.
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
    /// The place of its type.
    pub at: Span,
}

impl Field {
    /// The name without `r#`.
    pub fn plain_name(&self) -> String {
        self.name.unraw().to_string()
    }
}

/// What a field's type promises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
    Scalar,
    /// Rows.
    Vector(usize),
    /// Rows of the homogeneous coordinates, the last of which is one.
    Point(usize),
    /// Rows, as many columns.
    Matrix(usize),
    /// An advected parameter with its kind in its type.
    Advected(Variance, usize),
    /// A body as another sees it, or as it is in space; rows.
    Configuration(usize),
    /// The same of a body that is translated: its coordinates.
    Place(usize),
    /// A value of the step: as a field it is a scalar, a vector or a matrix.
    Given(Shape),
    /// `NonstandardInertia`, `Inertia`.
    SymmetricInertia,
    /// `DiagonalNonstandardInertia`.
    DiagonalInertia,
}

impl FieldKind {
    /// How the group moves it: a plain vector is a covector.
    pub fn variance(self) -> Variance {
        match self {
            Self::Advected(variance, _) => variance,
            Self::Point(_) => Variance::Vector,
            Self::Given(_) | Self::Configuration(_) | Self::Place(_) => Variance::Fixed,
            _ => Variance::Covector,
        }
    }

    /// Whether a group of matrices of this size can move it.
    pub fn is_carried_by(self, size: usize) -> bool {
        matches!(self, Self::Vector(rows) | Self::Point(rows) | Self::Advected(_, rows) if rows == size)
    }

    /// Whether its value is wrapped in a type that says how the group moves it.
    pub fn is_wrapped(self) -> bool {
        matches!(self, Self::Advected(..))
    }

    /// Whether a step can be given such a value.
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
            Self::SymmetricInertia | Self::DiagonalInertia => Shape::Matrix(3, 3),
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
