//! A declaration after parsing: the struct, the attribute's arguments, and the expression as a tree with shapes.

use std::rc::Rc;

use proc_macro2::Span;
use syn::{Expr, Ident, ItemStruct, Path};

use crate::group::Group;
use crate::symbolic::{Function, Rational, Variance};

/// What an attribute declares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// `#[lagrangian(… l_d = …)]`.
    Lagrangian,
    /// `#[force(… work = …)]`.
    Force,
}

impl Role {
    /// The argument that holds the expression.
    pub(crate) fn key(self) -> &'static str {
        match self {
            Self::Lagrangian => "l_d",
            Self::Force => "work",
        }
    }

    /// The name of the attribute.
    pub(crate) fn attribute(self) -> &'static str {
        match self {
            Self::Lagrangian => "lagrangian",
            Self::Force => "force",
        }
    }
}

/// `#[lagrangian(group = …, advected(…), l_d = …, crate = …)]` on a struct.
pub(crate) struct Declaration {
    pub(crate) role: Role,
    pub(crate) item: ItemStruct,
    /// Where liestep is found.
    pub(crate) root: Path,
    /// The group as written.
    pub(crate) group: Path,
    /// What is known of it.
    pub(crate) structure: Group,
    pub(crate) advected: Vec<AdvectedParameter>,
    /// The Lagrangian, or the virtual work of a force; `None` where a mistake elsewhere hides what it means.
    pub(crate) l_d: Option<Expr>,
    pub(crate) fields: Vec<Field>,
    /// The fields whose type has no meaning.
    pub(crate) unreadable: Vec<String>,
    pub(crate) scalar: Scalar,
}

/// `w = up`: `w` in the expression is the field `up`, carried by the group.
pub(crate) struct AdvectedParameter {
    pub(crate) name: Ident,
    /// The index of the field; `None` where there is no such field of a known type.
    pub(crate) field: Option<usize>,
}

impl Declaration {
    /// What an advected parameter's field promises; a plain vector after a mistake.
    pub(crate) fn advected_kind(&self, index: usize) -> FieldKind {
        let size = self.structure.size;
        let field = self.advected.get(index).and_then(|w| self.fields.get(w.field?));
        let kind = field.map(|field| field.kind).filter(|kind| kind.is_carried_by(size));
        kind.unwrap_or(FieldKind::Vector(size))
    }
}

/// A field of the struct.
pub(crate) struct Field {
    pub(crate) name: Ident,
    pub(crate) kind: FieldKind,
}

/// What a field's type promises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FieldKind {
    Scalar,
    /// Rows.
    Vector(usize),
    /// Rows of the homogeneous coordinates, the last of which is one.
    Point(usize),
    /// Rows, as many columns.
    Matrix(usize),
    /// An advected parameter with its kind in its type.
    Advected(Variance, usize),
    /// `NonstandardInertia`, `Inertia`.
    SymmetricInertia,
    /// `DiagonalNonstandardInertia`.
    DiagonalInertia,
}

impl FieldKind {
    /// How the group moves it: a plain vector is a covector.
    pub(crate) fn variance(self) -> Variance {
        match self {
            Self::Advected(variance, _) => variance,
            Self::Point(_) => Variance::Vector,
            _ => Variance::Covector,
        }
    }

    /// Whether a group of matrices of this size can move it.
    pub(crate) fn is_carried_by(self, size: usize) -> bool {
        matches!(self, Self::Vector(rows) | Self::Point(rows) | Self::Advected(_, rows) if rows == size)
    }

    /// Whether its value is wrapped in a type that says how the group moves it.
    pub(crate) fn is_wrapped(self) -> bool {
        matches!(self, Self::Advected(..))
    }

    pub(crate) fn shape(self) -> Shape {
        match self {
            Self::Scalar => Shape::Scalar,
            Self::Vector(rows) | Self::Point(rows) => Shape::Matrix(rows, 1),
            Self::Advected(variance, rows) => Shape::Matrix(rows, if variance.is_tensor() { rows } else { 1 }),
            Self::Matrix(rows) => Shape::Matrix(rows, rows),
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

/// The shape of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Scalar,
    /// Rows and columns; a vector has one column.
    Matrix(usize, usize),
}

impl Shape {
    /// In a message: `a scalar`, `a vector of 3`, `a 3 × 3 matrix`.
    pub(crate) fn describe(self) -> String {
        match self {
            Self::Scalar => "a scalar".to_owned(),
            Self::Matrix(rows, 1) => format!("a vector of {rows}"),
            Self::Matrix(1, columns) => format!("a row of {columns}"),
            Self::Matrix(rows, columns) => format!("a {rows} × {columns} matrix"),
        }
    }
}

/// An expression with its shape, read as mathematics.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) span: Span,
    pub(crate) shape: Shape,
    pub(crate) kind: Kind,
    /// How deep the operations are nested, through `let`s too.
    pub(crate) depth: usize,
}

impl Tree {
    pub(crate) fn new(span: Span, shape: Shape, kind: Kind) -> Rc<Self> {
        let depth = kind.operands().into_iter().flatten().map(|operand| operand.depth).max().unwrap_or(0) + 1;
        Rc::new(Self { span, shape, kind, depth })
    }
}

/// A name in scope.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Name {
    /// `F`.
    Increment,
    /// `h`.
    Step,
    /// `eta`, the displacement at the beginning of the step.
    DisplacementBefore,
    /// `eta_next`, the one at its end.
    DisplacementAfter,
    /// An advected parameter, by its place in `advected(…)`.
    Advected(usize),
    /// A field, by its place in the struct.
    Field(usize),
}

/// The operations of the declared syntax.
#[derive(Clone, Debug)]
pub(crate) enum Kind {
    Number(Rational),
    Identity,
    Name(Name),
    Negate(Rc<Tree>),
    Add(Rc<Tree>, Rc<Tree>),
    Subtract(Rc<Tree>, Rc<Tree>),
    Multiply(Rc<Tree>, Rc<Tree>),
    Divide(Rc<Tree>, Rc<Tree>),
    Transpose(Rc<Tree>),
    Trace(Rc<Tree>),
    Dot(Rc<Tree>, Rc<Tree>),
    Cross(Rc<Tree>, Rc<Tree>),
    CrossMatrix(Rc<Tree>),
    ComponentMultiply(Rc<Tree>, Rc<Tree>),
    Power(Rc<Tree>, i32),
    Apply(Function, Rc<Tree>),
    Vee(Rc<Tree>),
    /// Of a parameter or of `F`.
    Inverse(Rc<Tree>),
    Entry(Rc<Tree>, usize, usize),
    /// What a `let` has named.
    Bound(String, Rc<Tree>),
}

impl Kind {
    pub(crate) fn operands(&self) -> [Option<&Rc<Tree>>; 2] {
        match self {
            Self::Number(_) | Self::Identity | Self::Name(_) => [None, None],
            Self::Negate(a)
            | Self::Transpose(a)
            | Self::Trace(a)
            | Self::CrossMatrix(a)
            | Self::Power(a, _)
            | Self::Apply(_, a)
            | Self::Vee(a)
            | Self::Inverse(a)
            | Self::Entry(a, ..)
            | Self::Bound(_, a) => [Some(a), None],
            Self::Add(a, b)
            | Self::Subtract(a, b)
            | Self::Multiply(a, b)
            | Self::Divide(a, b)
            | Self::Dot(a, b)
            | Self::Cross(a, b)
            | Self::ComponentMultiply(a, b) => [Some(a), Some(b)],
        }
    }
}
