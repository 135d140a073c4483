//! The free functions of the declared syntax: `hat`, `vee`, `log`, `exp` and `inverse`.

use std::rc::Rc;

use syn::spanned::Spanned as _;
use syn::{Expr, ExprCall};

use super::Checker;
use super::closures::Callee;
use super::methods::{SQUARE, VECTOR};
use crate::declared::{Kind, Name, Shape, Tree};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Function, Rational};

pub(super) const FUNCTIONS: [&str; 5] = ["hat", "vee", "log", "exp", "inverse"];

/// The rows of `Vector2::new` and `Vector3::new`, by any path.
fn rows_of_new(function: &Expr) -> Option<usize> {
    let Expr::Path(path) = function else { return None };
    let mut names = path.path.segments.iter().rev().map(|segment| segment.ident.to_string());
    match (names.next()?.as_str(), names.next()?.as_str()) {
        ("new", "Vector2") => Some(2),
        ("new", "Vector3") => Some(3),
        _ => None,
    }
}

impl Checker<'_> {
    /// `Vector3::new(x, y, z)`, as `x e_1 + y e_2 + z e_3`.
    fn column(&mut self, call: &ExprCall, rows: usize) -> Option<Rc<Tree>> {
        let (span, shape) = (call.span(), Shape::Matrix(rows, 1));
        if call.args.len() != rows {
            self.errors.push_over(call, format!("a vector of {rows} has {rows} entries"));
            return None;
        }
        let entries: Vec<Option<Rc<Tree>>> = call.args.iter().map(|entry| self.expression(entry)).collect();
        let mut sum: Option<Rc<Tree>> = None;
        for ((k, entry), written) in entries.into_iter().enumerate().zip(&call.args) {
            let entry = entry?;
            if entry.shape != Shape::Scalar {
                self.errors.push_over(
                    written,
                    format!("an entry of a vector is a scalar, and this is {}", entry.shape.describe()),
                );
                return None;
            }
            let along = Tree::new(span, shape, Kind::Components(entry, [(k, 0, 0, Rational::ONE)].into()));
            sum = Some(match sum {
                Some(sum) => Tree::new(span, shape, Kind::Add(sum, along)),
                None => along,
            });
        }
        sum
    }

    pub(super) fn call(&mut self, call: &ExprCall) -> Option<Rc<Tree>> {
        match self.callee(call) {
            Callee::Closure(name, closure) => return self.called(&name, &closure, call),
            Callee::Mistaken => return None,
            Callee::Other => {}
        }
        let function = match &*call.func {
            Expr::Path(path) => path.path.get_ident().map(ToString::to_string).unwrap_or_default(),
            _ => String::new(),
        };
        if let Some(rows) = rows_of_new(&call.func) {
            return self.column(call, rows);
        }
        if !FUNCTIONS.contains(&function.as_str()) {
            let advice = self.advice_on_function(&call.func);
            self.errors.push_over(&call.func, advice);
            self.arguments(&call.args);
            return None;
        }
        let (span, at) = (call.span(), call.func.span());
        let mut arguments = call.args.iter();
        let (Some(argument), None) = (arguments.next(), arguments.next()) else {
            let wanted = if ["exp", "hat"].contains(&function.as_str()) { "vector" } else { "matrix" };
            self.errors.push(at, format!("`{function}` takes one {wanted}"));
            return None;
        };
        let (passed, argument) = (argument, self.expression(argument)?);
        if !self.is_passed_right(&function, passed, false) {
            return None;
        }
        match (function.as_str(), argument.shape) {
            ("hat", shape) if shape == Shape::Matrix(self.matrices.dimension(), 1) => {
                let Group { size, generators, is_so3, .. } = &self.matrices;
                // The simplifier knows the identities of cross products.
                if *is_so3 && self.declaration.continuous.is_some() {
                    return Some(Tree::new(span, SQUARE, Kind::CrossMatrix(argument)));
                }
                let generators = generators.as_slice().into();
                Some(Tree::new(span, Shape::Matrix(*size, *size), Kind::Hat(argument, generators)))
            }
            ("hat", shape) => {
                let dimension = self.matrices.dimension();
                self.mismatch("hat", &format!("a vector of {dimension}, one for each generator"), shape, at)
            }
            ("vee", SQUARE) => Some(Tree::new(span, VECTOR, Kind::Vee(argument))),
            ("vee", shape) => self.mismatch("vee", "a 3 × 3 matrix", shape, at),
            ("log", SQUARE) if self.is_rotation(&argument) => Some(logarithm(span, argument)),
            ("log", SQUARE) => {
                self.errors.push(at, "`log` is that of a rotation, and this group isn't SO3");
                None
            }
            ("log", shape) => self.mismatch("log", "a rotation matrix such as `F`", shape, at),
            ("exp", VECTOR) => Some(exponential(span, &argument)),
            ("exp", Shape::Scalar) => {
                self.errors.push(at, "`exp` of a scalar is a method: write `x.exp()`");
                None
            }
            ("exp", shape) => self.mismatch("exp", "a vector of 3", shape, at),
            (_, shape) => self.inverse(span, argument, shape, at),
        }
    }

    /// Whether a square matrix may be that of a rotation: on products of other groups, too, if it is of a factor SO(3).
    fn is_rotation(&self, argument: &Tree) -> bool {
        let group = &self.declaration.group;
        let of = argument.frames[0].filter(|_| group.is_product());
        group.rotates() || of.is_some_and(|factor| group.factor(factor).is_so3)
    }

    fn inverse(
        &mut self,
        span: proc_macro2::Span,
        argument: Rc<Tree>,
        shape: Shape,
        at: proc_macro2::Span,
    ) -> Option<Rc<Tree>> {
        match (&argument.kind, shape) {
            (Kind::Name(Name::Increment(factor)), _) if self.declaration.group.factor(*factor).is_added => {
                let name = &self.declaration.factors[*factor].name;
                self.errors.push(at, format!("`{name}` is a translation, which is added: its inverse is `-{name}`"));
                None
            }
            // The inverse of an increment is that of the group.
            (Kind::Name(Name::Increment(_)), _) => Some(Tree::new(span, shape, Kind::Inverse(argument))),
            (_, Shape::Matrix(rows, columns)) if rows != columns || rows > 3 => {
                self.mismatch("inverse", "a matrix of up to 3 × 3", shape, at)
            }
            (_, Shape::Scalar) => {
                self.errors.push(at, "`inverse` is that of a matrix: write `1.0 / x` for a scalar");
                None
            }
            (Kind::Name(Name::Field(_)), _) => Some(Tree::new(span, shape, Kind::Inverse(argument))),
            // The stand-in for the parameter of a function.
            (Kind::Number(_), _) => {
                let message = "`inverse` takes `F` or a field of the struct by its name: call this function with the \
                               inverse, as in `U(inverse(J))`";
                self.errors.push(at, message);
                None
            }
            _ => {
                self.errors.push(at, "`inverse` takes `F` or a field of the struct: make this matrix a field");
                None
            }
        }
    }
}

/// The logarithm of a rotation, `G(n) vee(A)` with `n = (3 − tr A)/4`.
fn logarithm(span: proc_macro2::Span, rotation: Rc<Tree>) -> Rc<Tree> {
    let scalar = |kind| Tree::new(span, Shape::Scalar, kind);
    let three = scalar(Kind::Number(Rational::integer(3)));
    let quarter = scalar(Kind::Number(Rational::new(1, 4)));
    let trace = scalar(Kind::Trace(rotation.clone()));
    let difference = scalar(Kind::Subtract(three, trace));
    let n = scalar(Kind::Multiply(quarter, difference));
    let ratio = scalar(Kind::Apply(Function::LogRatio(0), n));
    let vee = Tree::new(span, VECTOR, Kind::Vee(rotation));
    Tree::new(span, VECTOR, Kind::Multiply(ratio, vee))
}

/// The rotation by a vector, `I + c₁(q) v̂ + c₂(q) v̂²` with `q = |v|²`.
fn exponential(span: proc_macro2::Span, v: &Rc<Tree>) -> Rc<Tree> {
    let matrix = |kind| Tree::new(span, SQUARE, kind);
    let q = Tree::new(span, Shape::Scalar, Kind::Dot(v.clone(), v.clone()));
    let coefficient = |k| Tree::new(span, Shape::Scalar, Kind::Apply(Function::Stumpff(k), q.clone()));
    let hat = matrix(Kind::CrossMatrix(v.clone()));
    let square = matrix(Kind::Multiply(hat.clone(), hat.clone()));
    let first = matrix(Kind::Multiply(coefficient(1), hat));
    let second = matrix(Kind::Multiply(coefficient(2), square));
    let sum = matrix(Kind::Add(matrix(Kind::Identity), first));
    matrix(Kind::Add(sum, second))
}
