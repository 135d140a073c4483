//! `+ - * /`, indexing and components.

use std::rc::Rc;

use syn::ext::IdentExt as _;
use syn::spanned::Spanned as _;
use syn::{BinOp, Expr, ExprBinary, ExprField, ExprIndex, Member};

use super::Checker;
use super::advice::{called, spelled};
use super::frames::How;
use super::methods::{METHODS, integer};
use crate::declared::{Kind, Name, OF_ANY_SIZE, Scalar, Shape, Tree};

impl Checker<'_> {
    pub(super) fn binary(&mut self, binary: &ExprBinary) -> Option<Rc<Tree>> {
        if !matches!(binary.op, BinOp::Add(_) | BinOp::Sub(_) | BinOp::Mul(_) | BinOp::Div(_)) {
            return self.unknown_operator(binary.op);
        }
        let (left, right) = (self.expression(&binary.left), self.expression(&binary.right));
        let (left, right) = beside_each_other(binary.op, left?, right?);
        if let Some(identity) = [&left, &right].into_iter().find(|side| side.shape == OF_ANY_SIZE) {
            self.errors.push(identity.span, ALONE);
            return None;
        }
        if self.is_with_identity(binary, &left, &right) || self.is_number_in_front(binary, &left, &right) {
            return None;
        }
        let (whole, ends) = (Expr::Binary(binary.clone()), (&*binary.left, &*binary.right));
        let is_seen = match binary.op {
            BinOp::Add(_) => self.are_seen_alike(How::Sum('+'), &whole, ends, (&left, &right)),
            BinOp::Sub(_) => self.are_seen_alike(How::Sum('-'), &whole, ends, (&left, &right)),
            BinOp::Mul(_) => self.meet(&whole, ends, (&left, &right)),
            _ => true,
        };
        if !is_seen {
            return None;
        }
        let span = binary.span();
        match binary.op {
            BinOp::Add(_) | BinOp::Sub(_) => {
                let (shape, is_sum) = (left.shape, matches!(binary.op, BinOp::Add(_)));
                if shape != right.shape {
                    return self.unlike(binary.op, shape, right.shape);
                }
                let kind = if is_sum { Kind::Add(left, right) } else { Kind::Subtract(left, right) };
                Some(Tree::new(span, shape, kind))
            }
            BinOp::Mul(_) => {
                let shape = match (left.shape, right.shape) {
                    (Shape::Scalar, shape) | (shape, Shape::Scalar) => shape,
                    (Shape::Matrix(rows, inner), Shape::Matrix(same, columns)) if inner == same => {
                        Shape::Matrix(rows, columns)
                    }
                    _ => return self.no_product(binary.op, &left, &right),
                };
                Some(Tree::new(span, shape, Kind::Multiply(left, right)))
            }
            BinOp::Div(_) => {
                if right.shape != Shape::Scalar {
                    let shape = right.shape.describe();
                    self.errors.push(
                        binary.op.span(),
                        format!(
                            "only a scalar can divide, and this is {shape}: multiply by `inverse(F)`, or by that of a \
                             field"
                        ),
                    );
                    return None;
                }
                let shape = left.shape;
                Some(Tree::new(span, shape, Kind::Divide(left, right)))
            }
            _ => self.unknown_operator(binary.op),
        }
    }

    /// Reports a sum or a difference of two different shapes.
    fn unlike(&mut self, operator: BinOp, left: Shape, right: Shape) -> Option<Rc<Tree>> {
        let (a, b) = (left.describe(), right.describe());
        let (a, verb, b) =
            if matches!(operator, BinOp::Add(_)) { (a, "added to", b) } else { (b, "subtracted from", a) };
        let advice = match (left, right) {
            (Shape::Scalar, Shape::Matrix(1, 1)) | (Shape::Matrix(1, 1), Shape::Scalar) => {
                ": write `a.dot(&b)` for `a.transpose() * b`"
            }
            (Shape::Scalar, Shape::Matrix(_, 1)) | (Shape::Matrix(_, 1), Shape::Scalar) => {
                ": take a `.dot(…)` or a component of the vector"
            }
            (Shape::Scalar, Shape::Matrix(rows, columns)) | (Shape::Matrix(rows, columns), Shape::Scalar)
                if rows == columns =>
            {
                ": write `a * I` for a scalar `a`, or take the `.trace()` of the matrix"
            }
            _ => ": both sides need one shape",
        };
        self.errors.push(operator.span(), format!("{a} can't be {verb} {b}{advice}"));
        None
    }

    /// Reports a product of two shapes that have none.
    fn no_product(&mut self, operator: BinOp, left: &Tree, right: &Tree) -> Option<Rc<Tree>> {
        let group = &self.declaration.group;
        let hint = match (left.shape, right.shape) {
            (Shape::Matrix(m, 1), Shape::Matrix(n, 1)) if m == n => {
                let diagonal = match left.kind {
                    Kind::Name(Name::Field(index)) => {
                        let name = &self.declaration.fields[index].name;
                        format!("; if `{name}` is the diagonal of a matrix, give the matrix")
                    }
                    _ => String::new(),
                };
                format!("write `a.dot(&b)`, or `a * b.transpose()`{diagonal}")
            }
            (Shape::Matrix(_, columns), Shape::Matrix(rows @ 1..=3, 1))
                if group.is_affine() && columns == group.size && columns == rows + 1 =>
            {
                format!("on this group a point of the body has the type Point{rows}<f64>")
            }
            _ => "the columns of the left must be as many as the rows of the right".to_owned(),
        };
        let (a, b) = (left.shape.describe(), right.shape.describe());
        self.errors.push(operator.span(), format!("{a} can't be multiplied by {b}: {hint}"));
        None
    }

    /// Reports a scalar in front of a vector or a matrix over a type parameter: nalgebra has that product for `f64` and
    /// `f32` alone.
    fn is_number_in_front(&mut self, binary: &ExprBinary, left: &Tree, right: &Tree) -> bool {
        let (BinOp::Mul(star), Shape::Scalar, Shape::Matrix(..), Scalar::Parameter(scalar)) =
            (binary.op, left.shape, right.shape, &self.declaration.scalar)
        else {
            return false;
        };
        let [number, matrix] = [&binary.left, &binary.right].map(|operand| spelled(operand));
        let message = format!(
            "where the scalar is `{scalar}`, a number stands behind the vector or the matrix that it multiplies: write \
             `{matrix} * {number}`"
        );
        self.errors.push_over(star, message);
        true
    }

    /// Reports a sum of a translation's increment and `I`: a translation isn't a matrix, and its identity isn't one
    /// either.
    fn is_with_identity(&mut self, binary: &ExprBinary, left: &Tree, right: &Tree) -> bool {
        let added = |tree: &Tree| match tree.kind {
            Kind::Name(Name::Increment(factor)) if self.declaration.group.factor(factor).is_added => Some(factor),
            _ => None,
        };
        let factor = match (&left.kind, &right.kind) {
            (_, Kind::Identity) => added(left),
            (Kind::Identity, _) => added(right),
            _ => None,
        };
        let Some(factor) = factor.filter(|_| !matches!(binary.op, BinOp::Mul(_))) else { return false };
        let (name, shape) =
            (&self.declaration.factors[factor].name, if left.kind.is_identity() { right } else { left });
        let shape = shape.shape.describe();
        let message = format!("`{name}` is a translation, {shape}: its identity is zero; write `{name}`");
        self.errors.push_over(binary, message);
        true
    }

    fn unknown_operator(&mut self, operator: BinOp) -> Option<Rc<Tree>> {
        match operator {
            BinOp::BitXor(token) => {
                self.errors.push_over(token, "a power is written `x.powi(2)`");
                None
            }
            BinOp::Eq(token) if self.is_constraint() => self.has_to_be_zero(token),
            other => self.unknown(other),
        }
    }

    /// `v[i]` and `A[(i, j)]`.
    pub(super) fn index(&mut self, index: &ExprIndex) -> Option<Rc<Tree>> {
        let operand = self.expression(&index.expr)?;
        let Shape::Matrix(rows, columns) = operand.shape else {
            self.errors.push(index.index.span(), "a scalar has no entries: remove the index");
            return None;
        };
        let place = match &*index.index {
            Expr::Tuple(pair) => match (pair.elems.first().and_then(number), pair.elems.last().and_then(number)) {
                (Some(row), Some(column)) if pair.elems.len() == 2 => Some((row, column)),
                _ => None,
            },
            single => number(single).map(|i| if columns == 1 { (i, 0) } else { (i % rows, i / rows) }),
        };
        match place {
            Some((row, column)) if row < rows && column < columns => {
                Some(Tree::new(index.span(), Shape::Scalar, Kind::Entry(operand, row, column)))
            }
            Some(_) => {
                let shape = operand.shape.describe();
                self.errors.push(index.index.span(), format!("there is no such entry in {shape}; indices start at 0"));
                None
            }
            None => {
                let culprit = match &*index.index {
                    Expr::Tuple(pair) => pair.elems.iter().find(|index| number(index).is_none()),
                    _ => None,
                };
                self.errors.push_over(culprit.unwrap_or(&index.index), "write indices as numbers: `v[0]`, `A[(0, 1)]`");
                None
            }
        }
    }

    /// `v.x`, `v.y`, `v.z`, and `v.w` of four.
    pub(super) fn component(&mut self, field: &ExprField) -> Option<Rc<Tree>> {
        let member = match &field.member {
            Member::Named(name) => name.unraw().to_string(),
            Member::Unnamed(index) => index.index.to_string(),
        };
        if let Expr::Path(path) = &*field.base
            && path.path.is_ident("self")
        {
            self.errors.push_over(path, format!("write `{member}`: the fields are known by their names alone"));
            return None;
        }
        let operand = self.expression(&field.base)?;
        let axes = match operand.shape {
            Shape::Matrix(rows @ 2..=4, 1) => AXES.get(..rows).unwrap_or_default(),
            _ => &[],
        };
        if let Some(row) = axes.iter().position(|axis| *axis == member) {
            return Some(Tree::new(field.span(), Shape::Scalar, Kind::Entry(operand, row, 0)));
        }
        let advice = if METHODS.contains(&member.as_str()) {
            format!("`{member}` is a method: write `{}`", called(&member))
        } else {
            let shape = operand.shape.describe();
            let entries = match operand.shape {
                Shape::Scalar => "leave it away".to_owned(),
                Shape::Matrix(_, 1) if axes.is_empty() => "write an entry by its index, `v[0]`".to_owned(),
                Shape::Matrix(_, 1) => format!("there are {}, and `v[0]`", axes.join(", ")),
                Shape::Matrix(..) => match entry_of(&member) {
                    Some((row, column)) => format!("write `A[({row}, {column})]`"),
                    None if member == "T" => "write `.transpose()`".to_owned(),
                    None => "write an entry by its indices, `A[(0, 1)]`".to_owned(),
                },
            };
            format!("{shape} has no `{member}`: {entries}")
        };
        self.errors.push(field.member.span(), advice);
        None
    }
}

/// The components of nalgebra's vectors.
const AXES: [&str; 4] = ["x", "y", "z", "w"];

/// `m12`, as nalgebra calls the entry `(0, 1)`.
fn entry_of(member: &str) -> Option<(u32, u32)> {
    let mut digits = member.strip_prefix('m')?.chars().map(|digit| digit.to_digit(10)?.checked_sub(1));
    match (digits.next()??, digits.next()??, digits.next()) {
        (row, column, None) => Some((row, column)),
        _ => None,
    }
}

fn number(expression: &Expr) -> Option<usize> {
    integer(expression)?.try_into().ok()
}

/// Both sides of an operator, with an `I` of the size of the matrix or the vector it stands beside.
fn beside_each_other(operator: BinOp, left: Rc<Tree>, right: Rc<Tree>) -> (Rc<Tree>, Rc<Tree>) {
    let sized = |identity: &Tree, other: Shape, is_left: bool| {
        let rows = match (operator, other) {
            (BinOp::Add(_) | BinOp::Sub(_), Shape::Matrix(rows, columns)) if rows == columns => rows,
            (BinOp::Mul(_), Shape::Matrix(rows, columns)) => {
                if is_left {
                    rows
                } else {
                    columns
                }
            }
            _ => return None,
        };
        Some(Tree::new(identity.span, Shape::Matrix(rows, rows), Kind::Identity))
    };
    match [left.shape, right.shape].map(|shape| shape == OF_ANY_SIZE) {
        [true, _] => (sized(&left, right.shape, true).unwrap_or(left), right),
        [_, true] => {
            let found = sized(&right, left.shape, false);
            (left, found.unwrap_or(right))
        }
        _ => (left, right),
    }
}

/// The message for an `I` whose size nothing says.
pub(super) const ALONE: &str = "the matrices of the factors have several sizes, and `I` has that of the matrix it is added to or \
                                multiplied by: write `F - I`, or `(F - I) * a` for a scalar `a`";
