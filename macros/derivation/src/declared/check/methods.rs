//! Methods of the declared syntax.

use std::rc::Rc;

use proc_macro2::Span;
use syn::punctuated::Punctuated;
use syn::spanned::Spanned as _;
use syn::{Expr, ExprMethodCall, Lit, Token, UnOp};

use super::Checker;
use super::frames::How;
use crate::declared::{Kind, Shape, Tree};
use crate::mathematics::symbolic::Function;

pub(super) const METHODS: [&str; 15] = [
    "transpose",
    "trace",
    "dot",
    "norm_squared",
    "norm",
    "cross",
    "cross_matrix",
    "component_mul",
    "powi",
    "sqrt",
    "ln",
    "exp",
    "sin",
    "cos",
    "clone",
];

pub(super) const VECTOR: Shape = Shape::Matrix(3, 1);
pub(super) const SQUARE: Shape = Shape::Matrix(3, 3);

impl Checker<'_> {
    pub(super) fn method(&mut self, call: &ExprMethodCall) -> Option<Rc<Tree>> {
        let receiver = self.expression(&call.receiver);
        let name = call.method.to_string();
        if !METHODS.contains(&name.as_str()) {
            let shape = receiver.as_ref().map(|receiver| receiver.shape);
            let advice = self.advice_on_method(&name, &call.receiver, shape);
            self.errors.push(call.method.span(), advice);
            self.arguments(&call.args);
            return None;
        }
        if let Some(arguments) = &call.turbofish {
            self.errors.push(arguments.span(), "leave the type arguments away");
        }
        let wanted = usize::from(matches!(name.as_str(), "dot" | "cross" | "component_mul" | "powi"));
        if call.args.len() != wanted {
            let count = match (wanted, name.as_str()) {
                (0, _) => "no argument",
                (_, "powi") => "one argument: write `.powi(2)`",
                _ => "one argument, a reference: write `(&v)`",
            };
            let span = call.args.get(wanted).map_or(call.method.span(), syn::spanned::Spanned::span);
            self.errors.push(span, format!("`{name}` takes {count}"));
            return None;
        }
        let (receiver, span, at) = (receiver?, call.span(), call.method.span());
        match (name.as_str(), call.args.first()) {
            ("powi", Some(exponent)) => self.power(receiver, exponent, span, at),
            (_, Some(argument)) => {
                let (passed, argument) = (argument, self.expression(argument)?);
                let (whole, ends) = (Expr::MethodCall(call.clone()), (&*call.receiver, passed));
                if receiver.shape == argument.shape
                    && !self.are_seen_alike(How::Method(&name), &whole, ends, (&receiver, &argument))
                {
                    return None;
                }
                let product = self.of_two(&name, receiver, argument, span, at)?;
                self.is_passed_right(&name, passed, true).then_some(product)
            }
            (_, None) => self.of_one(&name, receiver, span, at),
        }
    }

    fn of_one(&mut self, name: &str, receiver: Rc<Tree>, span: Span, at: Span) -> Option<Rc<Tree>> {
        let shape = receiver.shape;
        let (expected, result) = match (name, shape) {
            ("clone", _) => return Some(receiver),
            ("transpose", Shape::Matrix(rows, columns)) => {
                return Some(Tree::new(span, Shape::Matrix(columns, rows), Kind::Transpose(receiver)));
            }
            ("transpose", Shape::Scalar) => ("a matrix", None),
            ("trace", Shape::Matrix(rows, columns)) if rows == columns => {
                ("", Some((Shape::Scalar, Kind::Trace(receiver))))
            }
            ("trace", _) => ("a square matrix", None),
            ("cross_matrix", VECTOR) => ("", Some((SQUARE, Kind::CrossMatrix(receiver)))),
            ("cross_matrix", _) => ("a vector of 3", None),
            ("norm_squared" | "norm", Shape::Matrix(_, 1)) => {
                let squared = Tree::new(span, Shape::Scalar, Kind::Dot(receiver.clone(), receiver));
                let norm = |squared| Kind::Apply(Function::Sqrt, squared);
                return Some(if name == "norm" { Tree::new(span, Shape::Scalar, norm(squared)) } else { squared });
            }
            ("norm_squared" | "norm", Shape::Matrix(..)) => {
                let turned = match shape {
                    Shape::Matrix(rows, columns) => Shape::Matrix(columns, rows),
                    Shape::Scalar => shape,
                };
                if turned != shape {
                    return self.mismatch(name, "a vector of 3 or a square matrix", shape, at);
                }
                let transposed = Tree::new(span, turned, Kind::Transpose(receiver.clone()));
                let product = Tree::new(span, shape, Kind::Multiply(receiver, transposed));
                let squared = Tree::new(span, Shape::Scalar, Kind::Trace(product));
                let norm = |squared| Kind::Apply(Function::Sqrt, squared);
                return Some(if name == "norm" { Tree::new(span, Shape::Scalar, norm(squared)) } else { squared });
            }
            ("norm_squared" | "norm", Shape::Scalar) => ("a vector or a matrix", None),
            ("exp", VECTOR) => {
                self.errors.push(at, "`exp` of a vector is a function: write `exp(v)`");
                return None;
            }
            (function, Shape::Scalar) => {
                let function = Function::METHODS.into_iter().find(|known| known.name() == function);
                ("", function.map(|function| (Shape::Scalar, Kind::Apply(function, receiver))))
            }
            _ => ("a scalar", None),
        };
        match result {
            Some((shape, kind)) => Some(Tree::new(span, shape, kind)),
            None => self.mismatch(name, expected, shape, at),
        }
    }

    fn of_two(&mut self, name: &str, left: Rc<Tree>, right: Rc<Tree>, span: Span, at: Span) -> Option<Rc<Tree>> {
        for operand in [&left, &right] {
            let fits =
                if name == "cross" { operand.shape == VECTOR } else { matches!(operand.shape, Shape::Matrix(_, 1)) };
            if !fits || operand.shape != left.shape {
                let expected = if name == "cross" { "two vectors of 3" } else { "two vectors of one size" };
                return self.mismatch(name, expected, operand.shape, at);
            }
        }
        let shape = left.shape;
        Some(match name {
            "dot" => Tree::new(span, Shape::Scalar, Kind::Dot(left, right)),
            "cross" => Tree::new(span, VECTOR, Kind::Cross(left, right)),
            _ => Tree::new(span, shape, Kind::ComponentMultiply(left, right)),
        })
    }

    fn power(&mut self, base: Rc<Tree>, exponent: &Expr, span: Span, at: Span) -> Option<Rc<Tree>> {
        if base.shape != Shape::Scalar {
            return self.mismatch("powi", "a scalar", base.shape, at);
        }
        if let Some(exponent) = integer(exponent).filter(|n| (-16..=16).contains(n)) {
            // An even power of a norm is smooth where the norm itself isn't.
            if let Some(squared) = norm_squared(&base).filter(|_| exponent % 2 == 0) {
                let kind = Kind::Power(squared.clone(), exponent / 2);
                return Some(if exponent == 2 { squared } else { Tree::new(span, Shape::Scalar, kind) });
            }
            Some(Tree::new(span, Shape::Scalar, Kind::Power(base, exponent)))
        } else {
            self.errors.push(exponent.span(), "write the exponent as a whole number from −16 to 16");
            None
        }
    }

    pub(super) fn mismatch(&mut self, name: &str, expected: &str, found: Shape, at: Span) -> Option<Rc<Tree>> {
        self.errors.push(at, format!("`{name}` needs {expected}, and this is {}", found.describe()));
        None
    }

    /// Checks the arguments of an unknown function, which may have mistakes of their own.
    pub(super) fn arguments(&mut self, arguments: &Punctuated<Expr, Token![,]>) {
        for argument in arguments {
            // A whole number may be a valid argument of such a function.
            if integer(argument).is_none() {
                self.expression(argument);
            }
        }
    }
}

/// The square of a norm, if the tree is a norm.
fn norm_squared(norm: &Rc<Tree>) -> Option<Rc<Tree>> {
    match &norm.kind {
        Kind::Bound(_, inner) => norm_squared(inner),
        Kind::Apply(Function::Sqrt, squared) => match &squared.kind {
            Kind::Dot(a, b) if Rc::ptr_eq(a, b) => Some(squared.clone()),
            Kind::Trace(product) => match &product.kind {
                Kind::Multiply(a, b) => match &b.kind {
                    Kind::Transpose(b) if Rc::ptr_eq(a, b) => Some(squared.clone()),
                    _ => None,
                },
                _ => None,
            },
            _ => None,
        },
        _ => None,
    }
}

pub(super) fn integer(expression: &Expr) -> Option<i32> {
    match expression {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Int(integer) => integer.base10_parse().ok(),
            _ => None,
        },
        Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => integer(&unary.expr).map(|n: i32| -n),
        Expr::Paren(inner) => integer(&inner.expr),
        Expr::Group(inner) => integer(&inner.expr),
        _ => None,
    }
}
