//! Evaluation of Rust text, and of relative configurations, by their definitions.

use std::collections::BTreeMap;

use quote::ToTokens as _;
use syn::{BinOp, Expr, Local, Pat, Stmt};

use crate::common::numeric::Matrix;
use crate::common::random::exponential;
use liestep_derivation::declared::Declaration;
use liestep_derivation::mathematics::derive::View;

/// Values of names, in which the inverse of each increment has a name made from that of the increment.
pub(super) type Env = BTreeMap<String, Matrix>;

/// The values with that of one name replaced.
pub(super) fn with(env: &Env, name: &str, value: Matrix) -> Env {
    let mut env = env.clone();
    env.insert(name.to_owned(), value);
    env
}

pub(super) fn inverse_of(name: &str) -> String {
    format!("inverse of {name}")
}

/// The value of an expression; none if the text has no meaning.
pub(super) fn value(expression: &Expr, env: &Env) -> Option<Matrix> {
    let of = |expression: &Expr| value(expression, env);
    let number = |x: &Matrix| (x.entries.len() == 1).then(|| x.at(0, 0));
    let same = |x: &Matrix, y: &Matrix| (x.rows, x.columns) == (y.rows, y.columns);
    Some(match expression {
        Expr::Paren(inner) => of(&inner.expr)?,
        Expr::Reference(inner) => of(&inner.expr)?,
        Expr::Path(path) => env.get(&path.path.get_ident()?.to_string())?.clone(),
        Expr::Lit(literal) => Matrix::scalar(literal.to_token_stream().to_string().parse().ok()?),
        Expr::Unary(unary) => of(&unary.expr)?.scaled(-1.0),
        Expr::Binary(binary) => match (&binary.op, of(&binary.left)?, of(&binary.right)?) {
            (BinOp::Add(_), a, b) if same(&a, &b) => a.plus(&b),
            (BinOp::Sub(_), a, b) if same(&a, &b) => a.minus(&b),
            (BinOp::Mul(_), a, b) if number(&a).or(number(&b)).is_some() || a.columns == b.rows => a.times(&b),
            (BinOp::Div(_), a, b) => a.scaled(1.0 / number(&b)?),
            _ => return None,
        },
        Expr::Block(block) => {
            let mut env = env.clone();
            for statement in &block.block.stmts {
                match statement {
                    Stmt::Local(Local { pat: Pat::Ident(name), init: Some(init), .. }) => {
                        env = with(&env, &name.ident.to_string(), value(&init.expr, &env)?);
                    }
                    Stmt::Expr(expression, None) => return value(expression, &env),
                    _ => return None,
                }
            }
            return None;
        }
        // The functions of a constraint are stacked into one column.
        Expr::Tuple(parts) => {
            let parts: Option<Vec<Matrix>> = parts.elems.iter().map(of).collect();
            let entries: Vec<f64> = parts?.into_iter().flat_map(|part| part.entries).collect();
            Matrix::new(entries.len(), 1, |row, _| entries[row])
        }
        Expr::Call(call) => {
            let Expr::Path(path) = &*call.func else { return None };
            let argument = call.args.first()?;
            match path.path.get_ident()?.to_string().as_str() {
                "vee" => of(argument)?.vee(),
                "log" => logarithm(&of(argument)?),
                "exp" => exponential(&of(argument)?),
                "inverse" => inverse(argument, env)?,
                _ => return None,
            }
        }
        Expr::Field(field) => {
            let syn::Member::Named(name) = &field.member else { return None };
            let place = ["x", "y", "z"].iter().position(|known| name == known)?;
            Matrix::scalar(*of(&field.base)?.entries.get(place)?)
        }
        Expr::MethodCall(call) => {
            let (receiver, first) = (of(&call.receiver)?, call.args.first());
            let (x, other) = (number(&receiver), first.and_then(of).filter(|other| same(&receiver, other)));
            match call.method.to_string().as_str() {
                "transpose" => receiver.transpose(),
                "trace" if receiver.rows == receiver.columns => Matrix::scalar(receiver.trace()),
                "norm_squared" => Matrix::scalar(receiver.transpose().times(&receiver).trace()),
                "norm" => Matrix::scalar(receiver.transpose().times(&receiver).trace().sqrt()),
                "dot" => Matrix::scalar(receiver.transpose().times(&other?).trace()),
                "cross" => receiver.hat().times(&other?),
                "powi" => {
                    let exponent = first?.to_token_stream().to_string().replace(' ', "");
                    Matrix::scalar(x?.powi(exponent.parse().ok()?))
                }
                "sqrt" => Matrix::scalar(x?.sqrt()),
                "sin" => Matrix::scalar(x?.sin()),
                "cos" => Matrix::scalar(x?.cos()),
                "exp" => Matrix::scalar(x?.exp()),
                "ln" => Matrix::scalar(x?.ln()),
                _ => return None,
            }
        }
        _ => return None,
    })
}

/// The logarithm of a rotation, `(θ/sin θ) vee(R)`; none if the trace is that of no rotation.
fn logarithm(rotation: &Matrix) -> Matrix {
    let cosine = 0.5 * (rotation.trace() - 1.0);
    let angle = if (cosine - 1.0).abs() < 1e-12 { 0.0 } else { cosine.acos() };
    rotation.vee().scaled(if angle == 0.0 { 1.0 } else { angle / angle.sin() })
}

/// The inverse of an increment by its name; of a field with three rows by vector products of its columns.
fn inverse(argument: &Expr, env: &Env) -> Option<Matrix> {
    let Expr::Path(name) = argument else { return None };
    let name = name.path.get_ident()?.to_string();
    if let Some(known) = env.get(&inverse_of(&name)) {
        return Some(known.clone());
    }
    let matrix = env.get(&name).filter(|field| field.entries.len() == 9)?;
    let row = |at: usize| Matrix::new(3, 1, |k, _| matrix.at(at % 3, k));
    let column = |at: usize| row(at + 1).hat().times(&row(at + 2));
    let determinant = row(0).transpose().times(&column(0)).trace();
    Some(Matrix::new(3, 3, |k, at| column(at).at(k, 0) / determinant))
}

fn exp(x: &Matrix) -> Matrix {
    let next = |(sum, power): (Matrix, Matrix), order: i32| {
        let power = power.times(x).scaled(1.0 / f64::from(order));
        (sum.plus(&power), power)
    };
    (1..25).fold((Matrix::identity(x.rows), Matrix::identity(x.rows)), next).0
}

/// A change of a body: an element of its algebra, or a displacement of a translated one.
#[derive(Clone)]
pub(super) struct Change<'a> {
    pub(super) declaration: &'a Declaration,
    pub(super) factor: usize,
    pub(super) along: Matrix,
}

impl Change<'_> {
    fn name(&self) -> &str {
        &self.declaration.factors[self.factor].name
    }

    fn is_added(&self) -> bool {
        self.declaration.group.factor(self.factor).is_added
    }

    pub(super) fn scaled(&self, size: f64) -> Self {
        Self { along: self.along.scaled(size), ..self.clone() }
    }

    /// The values with `exp(x) F` in the place of `F`, or with `x` on the right side of `F`; for a translation with
    /// `d + x`.
    pub(super) fn turned(&self, env: &Env, is_right: bool) -> Env {
        let (name, of_inverse) = (self.name(), inverse_of(self.name()));
        if self.is_added() {
            return with(env, name, env[name].plus(&self.along));
        }
        let [forwards, backwards] = [1.0, -1.0].map(|sign| exp(&self.along.scaled(sign)));
        let (f, inverse) = (&env[name], &env[&of_inverse]);
        let (f, inverse) = if is_right {
            (f.times(&forwards), backwards.times(inverse))
        } else {
            (forwards.times(f), inverse.times(&backwards))
        };
        with(&with(env, name, f), &of_inverse, inverse)
    }

    /// The values with all advected parameters moved by `exp(x)`.
    pub(super) fn carried(&self, env: &Env) -> Env {
        let elements = [1.0, -1.0].map(|sign| self.along.scaled(sign));
        let elements = if self.is_added() { elements } else { elements.map(|x| exp(&x)) };
        carried(self.declaration, self.factor, elements.each_ref(), env)
    }
}

/// The values with all advected parameters moved by an element of a factor, passed with its inverse; a plain vector is
/// a covector.
pub(super) fn carried(declaration: &Declaration, factor: usize, [g, inverse]: [&Matrix; 2], env: &Env) -> Env {
    let (mut moved, is_added) = (env.clone(), declaration.group.factor(factor).is_added);
    for w in declaration.advected.iter().filter(|w| !w.is_given) {
        let name = w.plain_name();
        let value = &env[&name];
        let value = match w.seen {
            View::Configuration(of) | View::Relative { of, .. } if of == factor && is_added => value.plus(inverse),
            View::Configuration(of) | View::Relative { of, .. } if of == factor => value.times(inverse),
            View::Relative { from, .. } if from == factor && is_added => value.plus(g),
            View::Relative { from, .. } if from == factor => g.times(value),
            View::From(of) if of == factor && !is_added => inverse.transpose().times(value),
            _ => continue,
        };
        moved.insert(name, value);
    }
    moved
}

/// The derivative at zero by a difference formula of fourth order.
pub(super) fn slope(f: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let difference = |e: f64| Some((f(e)? - f(-e)?) / (2.0 * e));
    let [near, far] = [difference(5e-4)?, difference(1e-3)?];
    // Neither difference is accurate near the zero of a root.
    ((near - far).abs() <= 1e-4 * (1.0 + near.abs())).then_some((4.0 * near - far) / 3.0)
}
