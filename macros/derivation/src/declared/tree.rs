//! The declared expression as a tree with shapes and a mathematical meaning.

use std::collections::BTreeSet;
use std::rc::Rc;

use proc_macro2::Span;

use crate::mathematics::symbolic::{Function, Rational};

/// The shape of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Scalar,
    /// Rows and columns; a vector has one column.
    Matrix(usize, usize),
}

impl Shape {
    /// The number of rows.
    pub fn rows(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Matrix(rows, _) => rows,
        }
    }

    pub fn is_vector(self) -> bool {
        matches!(self, Self::Matrix(_, 1))
    }

    /// In a message: `a scalar`, `a vector of 3`, `a 3 × 3 matrix`.
    pub fn describe(self) -> String {
        match self {
            Self::Scalar => "a scalar".to_owned(),
            OF_ANY_SIZE => "an identity, which has the size of the matrix it stands beside".to_owned(),
            Self::Matrix(rows, 1) => format!("a vector of {rows}"),
            Self::Matrix(1, columns) => format!("a row of {columns}"),
            Self::Matrix(rows, columns) => format!("a {rows} × {columns} matrix"),
        }
    }
}

/// The shape of `I` among factors with matrices of several sizes, until it stands beside one.
pub const OF_ANY_SIZE: Shape = Shape::Matrix(0, 0);

/// An expression with its shape and its mathematical meaning.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The span of the expression's first token; `end` is that of its last one.
    pub span: Span,
    pub end: Span,
    pub shape: Shape,
    pub kind: Kind,
    /// The depth of nested operations, including those of `let`s.
    pub depth: usize,
    pub frames: Frames,
    /// Whether the expression consists of increments, relative configurations and numbers alone.
    pub is_of_turns: bool,
}

/// The bodies, by the index of their factors, in whose axes a tensor is given: the frame of its rows, then that of its
/// columns, if known. A matrix maps vectors from its columns' frame to its rows'.
pub type Frames = [Option<usize>; 2];

impl Tree {
    pub fn new(span: Span, shape: Shape, kind: Kind) -> Rc<Self> {
        let depth = kind.operands().into_iter().flatten().map(|operand| operand.depth).max().unwrap_or(0) + 1;
        let frames = if shape == Shape::Scalar { [None; 2] } else { kind.frames() };
        let is_of_turns = shape == Shape::Scalar || kind.operands().into_iter().flatten().all(|part| part.is_of_turns);
        Rc::new(Self { span, end: span, shape, kind, depth, frames, is_of_turns })
    }

    /// A name with its frames.
    pub fn seen(span: Span, shape: Shape, name: Name, (frames, is_turn): (Frames, bool)) -> Rc<Self> {
        let is_of_turns = is_turn || shape == Shape::Scalar;
        Rc::new(Self { span, end: span, shape, kind: Kind::Name(name), depth: 1, frames, is_of_turns })
    }

    /// A scalar operation in the place of a part of the text.
    pub fn in_place_of(part: &Self, kind: Kind) -> Rc<Self> {
        Self::until(Self::new(part.span, Shape::Scalar, kind), part.end)
    }

    /// The tree with its last token set, if it isn't shared yet.
    pub fn until(mut tree: Rc<Self>, end: Span) -> Rc<Self> {
        if let Some(tree) = Rc::get_mut(&mut tree) {
            tree.end = end;
        }
        tree
    }
}

/// Every part of a tree once, the inner ones first.
pub fn parts(tree: &Rc<Tree>) -> Vec<&Rc<Tree>> {
    fn inside<'a>(tree: &'a Rc<Tree>, seen: &mut BTreeSet<*const Tree>, parts: &mut Vec<&'a Rc<Tree>>) {
        if seen.insert(Rc::as_ptr(tree)) {
            tree.kind.operands().into_iter().flatten().for_each(|operand| inside(operand, seen, parts));
            parts.push(tree);
        }
    }
    let mut parts = Vec::new();
    inside(tree, &mut BTreeSet::new(), &mut parts);
    parts
}

/// A name in scope.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Name {
    /// `F`, the increment of one factor of the group.
    Increment(usize),
    /// `h`.
    Step,
    /// The components of the velocity in a continuous Lagrangian, of one factor of the group.
    Velocity(usize),
    /// The displacement `eta` at the beginning of the step, of one factor of the group.
    DisplacementBefore(usize),
    /// The displacement `eta_next` at the end of the step, of one factor of the group.
    DisplacementAfter(usize),
    /// An advected parameter, by its index in the list.
    Advected(usize),
    /// A field, by its index in the struct.
    Field(usize),
}

/// The operations of the declared syntax.
#[derive(Clone, Debug)]
pub enum Kind {
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
    /// `Σ v_k E_k`, with the generators by rows.
    Hat(Rc<Tree>, Rc<[Vec<Rational>]>),
    /// `v` of `Σ v_k E_k`, by linear forms in its entries: the component, row, column and factor of each term.
    Components(Rc<Tree>, Rc<[(usize, usize, usize, Rational)]>),
    /// The inverse of a parameter or of `F`.
    Inverse(Rc<Tree>),
    Entry(Rc<Tree>, usize, usize),
    /// The value of a `let` by its name.
    Bound(String, Rc<Tree>),
}

impl Kind {
    pub fn is_identity(&self) -> bool {
        matches!(self, Self::Identity)
    }

    /// The frames of the result, if the operands fit.
    fn frames(&self) -> Frames {
        match self {
            Self::Negate(a) | Self::Bound(_, a) | Self::Divide(a, _) => a.frames,
            Self::Transpose(a) | Self::Inverse(a) => [a.frames[1], a.frames[0]],
            Self::Add(a, b) | Self::Subtract(a, b) | Self::Cross(a, b) | Self::ComponentMultiply(a, b) => {
                [0, 1].map(|side| match (a.frames[side], b.frames[side]) {
                    // A comparison of two bodies, each in its own axes, is in the axes of neither.
                    (Some(first), Some(second)) if first != second => None,
                    (first, second) => first.or(second),
                })
            }
            Self::Multiply(a, b) if a.shape == Shape::Scalar => b.frames,
            Self::Multiply(a, b) if b.shape == Shape::Scalar => a.frames,
            Self::Multiply(a, b) => match (a.frames[1], b.frames[0]) {
                (Some(from), Some(of)) if from != of => [None; 2],
                _ => [a.frames[0], b.frames[1]],
            },
            // The vector of a matrix from one body to another is in the axes of neither.
            Self::Vee(a) => match a.frames {
                [Some(row), Some(column)] if row != column => [None; 2],
                [row, column] => [row.or(column), None],
            },
            Self::CrossMatrix(a) | Self::Hat(a, _) => [a.frames[0]; 2],
            Self::Number(_)
            | Self::Identity
            | Self::Name(_)
            | Self::Trace(_)
            | Self::Dot(..)
            | Self::Power(..)
            | Self::Apply(..)
            | Self::Components(..)
            | Self::Entry(..) => [None; 2],
        }
    }

    pub fn operands(&self) -> [Option<&Rc<Tree>>; 2] {
        match self {
            Self::Number(_) | Self::Identity | Self::Name(_) => [None, None],
            Self::Negate(a)
            | Self::Transpose(a)
            | Self::Trace(a)
            | Self::CrossMatrix(a)
            | Self::Power(a, _)
            | Self::Apply(_, a)
            | Self::Vee(a)
            | Self::Hat(a, _)
            | Self::Components(a, _)
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
