//! `+ - * /`, indexing and components.

use std::rc::Rc;

use syn::spanned::Spanned as _;
use syn::{BinOp, Expr, ExprBinary, ExprField, ExprIndex, Lit, Member};

use super::Checker;
use crate::declared::{Kind, Shape, Tree};

impl Checker<'_> {
    pub(super) fn binary(&mut self, binary: &ExprBinary) -> Option<Rc<Tree>> {
        let (left, right) = (self.expression(&binary.left), self.expression(&binary.right));
        let (left, right) = (left?, right?);
        let (span, operator) = (binary.span(), binary.op.span());
        match binary.op {
            BinOp::Add(_) | BinOp::Sub(_) => {
                if left.shape != right.shape {
                    let (a, b) = (left.shape.describe(), right.shape.describe());
                    let verb = if matches!(binary.op, BinOp::Add(_)) { "added to" } else { "subtracted from" };
                    let (a, b) = if matches!(binary.op, BinOp::Add(_)) { (a, b) } else { (b, a) };
                    let advice = match (left.shape, right.shape) {
                        (Shape::Scalar, Shape::Matrix(3, 3)) | (Shape::Matrix(3, 3), Shape::Scalar) => {
                            ": write `a * I` for a scalar `a`"
                        }
                        _ => ": both sides need one shape",
                    };
                    self.errors.push(operator, format!("{a} can't be {verb} {b}{advice}"));
                    return None;
                }
                let shape = left.shape;
                let kind = if matches!(binary.op, BinOp::Add(_)) {
                    Kind::Add(left, right)
                } else {
                    Kind::Subtract(left, right)
                };
                Some(Tree::new(span, shape, kind))
            }
            BinOp::Mul(_) => {
                let shape = match (left.shape, right.shape) {
                    (Shape::Scalar, shape) | (shape, Shape::Scalar) => shape,
                    (Shape::Matrix(rows, inner), Shape::Matrix(same, columns)) if inner == same => {
                        Shape::Matrix(rows, columns)
                    }
                    (a, b) => {
                        let hint = match (a, b) {
                            (Shape::Matrix(3, 1), Shape::Matrix(3, 1)) => ": write `a.dot(&b)`, or `a * b.transpose()`",
                            _ => ": the columns of the left must be as many as the rows of the right",
                        };
                        self.errors
                            .push(operator, format!("{} can't be multiplied by {}{hint}", a.describe(), b.describe()));
                        return None;
                    }
                };
                Some(Tree::new(span, shape, Kind::Multiply(left, right)))
            }
            BinOp::Div(_) => {
                if right.shape != Shape::Scalar {
                    let shape = right.shape.describe();
                    self.errors.push(
                        operator,
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
            _ => self.unknown(operator),
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

    /// `v.x`, `v.y`, `v.z`.
    pub(super) fn component(&mut self, field: &ExprField) -> Option<Rc<Tree>> {
        let operand = self.expression(&field.base)?;
        let place = match &field.member {
            Member::Named(name) => ["x", "y", "z"].iter().position(|axis| name == axis),
            Member::Unnamed(_) => None,
        };
        if let (Some(row), Shape::Matrix(3, 1)) = (place, operand.shape) {
            Some(Tree::new(field.span(), Shape::Scalar, Kind::Entry(operand, row, 0)))
        } else {
            let shape = operand.shape.describe();
            self.errors.push(field.member.span(), format!("{shape} has no such component; a vector has x, y and z"));
            None
        }
    }
}

fn number(expression: &Expr) -> Option<usize> {
    match expression {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Int(integer) => integer.base10_parse().ok(),
            _ => None,
        },
        Expr::Paren(inner) => number(&inner.expr),
        Expr::Group(inner) => number(&inner.expr),
        _ => None,
    }
}
