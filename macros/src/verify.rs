//! The self-check: derived terms and the emitted step against the declared expression, before anything is emitted.
//!
//! The declared tree is evaluated on numbers by itself, without the symbolic form, so a wrong rewrite can't agree with
//! itself. First derivatives are compared with its central differences; what is built from them, with them.

mod inertia;
mod linear;
mod reversal;
mod step;
mod terms;
#[cfg(test)]
mod tests;

mod force;

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::ast::{Declaration, FieldKind, Kind, Name, Shape, Tree};
use crate::derive::{Derived, SelfAdjointness};
use crate::group::Group;
use crate::lower::Lowered;
use crate::scalar::{Graph, Input, Kernel, NodeId};
use crate::symbolic::{SymbolId, Variance};

pub(crate) use force::force;
pub(crate) use inertia::{KineticPart, kinetic_part};
use step::Step;
use terms::Terms;

/// Central differences at this spacing are right to about eight digits.
const SPACING: f64 = 1e-5;
/// What they leave, relative to the size of the terms.
const TOLERANCE: f64 = 1e-5;

/// Checks all that was derived. The error is the first term that disagrees.
pub(crate) fn verify(
    declaration: &Declaration,
    tree: &Rc<Tree>,
    lowered: &Lowered,
    derived: &Derived,
    kernel: &Kernel,
) -> Result<SelfAdjointness, &'static str> {
    let (terms, step) = (Terms::new(derived), Step { derived, kernel });
    let samples: Vec<Sample> = (1..=3).map(|seed| Sample::new(declaration, lowered, derived, seed)).collect();
    for sample in &samples {
        let found = terms.disagreement(sample, tree).or_else(|| step.disagreement(sample, &terms));
        if let Some(term) = found {
            return Err(term);
        }
    }
    reversal::self_adjointness(&samples, tree, &derived.adjoint_defect)
}

/// The slope of a function at zero.
fn slope(function: &dyn Fn(f64) -> f64) -> f64 {
    (function(SPACING) - function(-SPACING)) / (2.0 * SPACING)
}

fn evaluated(graph: &Graph, outputs: &[NodeId], inputs: &BTreeMap<SymbolId, Value>) -> Vec<f64> {
    graph.evaluate(outputs, &|input: Input| {
        inputs.get(&input.symbol).map_or(f64::NAN, |value| value.at(input.row, input.column))
    })
}

/// A matrix, row by row.
#[derive(Clone, Debug)]
struct Value {
    rows: usize,
    columns: usize,
    entries: Vec<f64>,
}

impl Value {
    fn new(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let entries = (0..rows * columns).map(|at| entry(at / columns, at % columns)).collect();
        Self { rows, columns, entries }
    }

    fn scalar(value: f64) -> Self {
        Self { rows: 1, columns: 1, entries: vec![value] }
    }

    fn at(&self, row: usize, column: usize) -> f64 {
        self.entries.get(row * self.columns + column).copied().unwrap_or(f64::NAN)
    }

    fn first(&self) -> f64 {
        self.at(0, 0)
    }

    fn map(&self, f: impl Fn(f64) -> f64) -> Self {
        Self { entries: self.entries.iter().map(|&x| f(x)).collect(), ..*self }
    }

    fn zip(&self, other: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self { entries: self.entries.iter().zip(&other.entries).map(|(&x, &y)| f(x, y)).collect(), ..*self }
    }

    fn transpose(&self) -> Self {
        Self::new(self.columns, self.rows, |row, column| self.at(column, row))
    }

    fn times(&self, other: &Self) -> Self {
        Self::new(self.rows, other.columns, |row, column| {
            (0..self.columns).map(|k| self.at(row, k) * other.at(k, column)).sum()
        })
    }

    /// By Cramer's rule.
    fn inverse(&self) -> Self {
        let determinant = self.determinant();
        Self::new(self.rows, self.rows, |row, column| {
            let sign = if (row + column).is_multiple_of(2) { 1.0 } else { -1.0 };
            sign * self.without(column, row).determinant() / determinant
        })
    }

    fn determinant(&self) -> f64 {
        if self.rows == 0 {
            return 1.0;
        }
        let sign = |row: usize| if row.is_multiple_of(2) { 1.0 } else { -1.0 };
        (0..self.rows).map(|row| sign(row) * self.at(row, 0) * self.without(row, 0).determinant()).sum()
    }

    fn without(&self, row: usize, column: usize) -> Self {
        let size = self.rows - 1;
        Self::new(size, size, |i, j| self.at(i + usize::from(i >= row), j + usize::from(j >= column)))
    }

    fn hat(v: &Self) -> Self {
        let [x, y, z] = [v.at(0, 0), v.at(1, 0), v.at(2, 0)];
        let entries = vec![0.0, -z, y, z, 0.0, -x, -y, x, 0.0];
        Self { rows: 3, columns: 3, entries }
    }

    fn identity(size: usize) -> Self {
        Self::new(size, size, |row, column| if row == column { 1.0 } else { 0.0 })
    }
}

/// `exp(s E_k)`, by its series: `s` is small.
fn turn(group: &Group, k: usize, s: f64) -> Value {
    let size = group.size;
    let entries = group.generators.get(k).map_or(&[][..], Vec::as_slice);
    let step = Value { rows: size, columns: size, entries: entries.iter().map(|entry| s * entry.to_f64()).collect() };
    let (mut sum, mut power) = (Value::identity(size), Value::identity(size));
    for order in 1..20 {
        power = power.times(&step).map(|x| x / f64::from(order));
        if power.entries.iter().all(|entry| entry.abs() < f64::EPSILON * f64::EPSILON) {
            break;
        }
        sum = sum.zip(&power, |x, y| x + y);
    }
    sum
}

/// Numbers for all names.
#[derive(Clone)]
struct Sample<'a> {
    derived: &'a Derived,
    increment: Value,
    inverse: Value,
    values: BTreeMap<Name, Value>,
    symbols: BTreeMap<SymbolId, Name>,
    advected: Vec<(Name, Variance)>,
}

impl<'a> Sample<'a> {
    fn new(declaration: &Declaration, lowered: &Lowered, derived: &'a Derived, seed: u64) -> Self {
        let mut state = seed;
        // A linear congruence (Knuth's MMIX constants) is random enough for sample points.
        #[allow(clippy::cast_precision_loss)] // 53 bits are left
        let mut number = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut values = BTreeMap::new();
        values.insert(Name::Step, Value::scalar(0.1 + 0.1 * number()));
        let group = &declaration.structure;
        let (mut increment, mut inverse) = (Value::identity(group.size), Value::identity(group.size));
        for k in 0..group.dimension() {
            let angle = 0.6 * number() - 0.3;
            increment = increment.times(&turn(group, k, angle));
            inverse = turn(group, k, -angle).times(&inverse);
        }
        values.insert(Name::Increment, increment.clone());
        for (index, field) in declaration.fields.iter().enumerate() {
            let value = match field.kind {
                FieldKind::Scalar => Value::scalar(0.5 + number()),
                kind => {
                    let (rows, columns) = match kind.shape() {
                        Shape::Scalar => (1, 1),
                        Shape::Matrix(rows, columns) => (rows, columns),
                    };
                    let entries: Vec<f64> = (0..rows * columns).map(|_| 2.0 * number() - 1.0).collect();
                    let any = Value { rows, columns, entries };
                    match kind {
                        FieldKind::SymmetricInertia => any.times(&any.transpose()),
                        FieldKind::DiagonalInertia => {
                            Value::new(3, 3, |row, column| if row == column { 1.0 + any.at(row, column) } else { 0.0 })
                        }
                        _ => any,
                    }
                }
            };
            values.insert(Name::Field(index), value);
        }
        let mut advected = Vec::new();
        for index in 0..declaration.advected.len() {
            let kind = declaration.advected_kind(index);
            let Shape::Matrix(rows, columns) = kind.shape() else { continue };
            let entries = (0..rows * columns).map(|_| 2.0 * number() - 1.0).collect();
            values.insert(Name::Advected(index), Value { rows, columns, entries });
            advected.push((Name::Advected(index), kind.variance()));
        }
        let symbols = lowered.names.iter().map(|(name, id)| (*id, *name)).collect();
        Self { derived, increment, inverse, values, symbols, advected }
    }

    /// `F` turned by `exp(s E_k)` from the left.
    fn turned(&self, k: usize, s: f64) -> Value {
        turn(&self.derived.group, k, s).times(&self.increment)
    }

    /// The values of all symbols at an increment: of the names, and of what the derivation adds.
    fn inputs(&self, f: &Value) -> BTreeMap<SymbolId, Value> {
        let mut inputs: BTreeMap<SymbolId, Value> = BTreeMap::new();
        for (symbol, name) in &self.symbols {
            inputs.extend(self.values.get(name).map(|value| (*symbol, value.clone())));
        }
        let identity = Value::identity(f.rows);
        inputs.insert(self.derived.increment(), f.clone());
        inputs.insert(self.derived.directions.small, f.zip(&identity, |x, y| x - y));
        inputs
    }

    /// `l_d` at this point.
    fn declared(&self, tree: &Rc<Tree>) -> f64 {
        Evaluation { values: &self.values, known: BTreeMap::new() }.of(tree).first()
    }

    /// `−l_d` turned back: at `F⁻¹`, `F⁻¹·w` and `−h`.
    fn reversed(&self, tree: &Rc<Tree>) -> f64 {
        let mut values = self.moved_values(&self.inverse, (&self.inverse, &self.increment));
        if let Some(h) = self.values.get(&Name::Step) {
            values.insert(Name::Step, h.map(|h| -h));
        }
        -Evaluation { values: &values, known: BTreeMap::new() }.of(tree).first()
    }

    /// `l_d` at another step.
    fn at_step(&self, tree: &Rc<Tree>, h: f64) -> f64 {
        let mut values = self.values.clone();
        values.insert(Name::Step, Value::scalar(h));
        Evaluation { values: &values, known: BTreeMap::new() }.of(tree).first()
    }

    /// `l_d` at another `F`, with all advected parameters moved by a group element, given with its inverse.
    fn moved(&self, tree: &Rc<Tree>, f: &Value, element: (&Value, &Value)) -> f64 {
        let values = self.moved_values(f, element);
        Evaluation { values: &values, known: BTreeMap::new() }.of(tree).first()
    }

    fn moved_values(&self, f: &Value, (g, inverse): (&Value, &Value)) -> BTreeMap<Name, Value> {
        let mut values = self.values.clone();
        values.insert(Name::Increment, f.clone());
        for (name, variance) in &self.advected {
            let Some(w) = self.values.get(name) else { continue };
            let moved = match variance {
                Variance::Vector => g.times(w),
                Variance::Covector => inverse.transpose().times(w),
                Variance::Contravariant => g.times(w).times(&g.transpose()),
                Variance::Covariant => inverse.transpose().times(w).times(inverse),
                Variance::Mixed => g.times(w).times(inverse),
            };
            values.insert(*name, moved);
        }
        values
    }
}

/// The values of names, and of what a `let` has bound.
struct Evaluation<'a> {
    values: &'a BTreeMap<Name, Value>,
    known: BTreeMap<*const Tree, Value>,
}

impl Evaluation<'_> {
    fn of(&mut self, tree: &Rc<Tree>) -> Value {
        if let Some(known) = self.known.get(&Rc::as_ptr(tree)) {
            return known.clone();
        }
        let value = self.operation(tree);
        if Rc::strong_count(tree) > 1 {
            self.known.insert(Rc::as_ptr(tree), value.clone());
        }
        value
    }

    fn operation(&mut self, tree: &Rc<Tree>) -> Value {
        match &tree.kind {
            Kind::Number(value) => Value::scalar(value.to_f64()),
            Kind::Identity => Value::identity(match tree.shape {
                Shape::Matrix(rows, _) => rows,
                Shape::Scalar => 1,
            }),
            Kind::Name(name) => self.values.get(name).cloned().unwrap_or_else(|| Value::scalar(f64::NAN)),
            Kind::Negate(a) => self.of(a).map(|x| -x),
            Kind::Add(a, b) => self.of(a).zip(&self.of(b), |x, y| x + y),
            Kind::Subtract(a, b) => self.of(a).zip(&self.of(b), |x, y| x - y),
            Kind::Multiply(a, b) => match (a.shape, b.shape) {
                (Shape::Scalar, _) => {
                    let factor = self.of(a).first();
                    self.of(b).map(|x| x * factor)
                }
                (_, Shape::Scalar) => {
                    let factor = self.of(b).first();
                    self.of(a).map(|x| x * factor)
                }
                _ => self.of(a).times(&self.of(b)),
            },
            Kind::Divide(a, b) => {
                let divisor = self.of(b).first();
                self.of(a).map(|x| x / divisor)
            }
            Kind::Transpose(a) => self.of(a).transpose(),
            Kind::Trace(a) => {
                let a = self.of(a);
                Value::scalar((0..a.rows).map(|i| a.at(i, i)).sum())
            }
            Kind::Dot(a, b) => self.of(a).transpose().times(&self.of(b)),
            Kind::Cross(a, b) => Value::hat(&self.of(a)).times(&self.of(b)),
            Kind::CrossMatrix(a) => Value::hat(&self.of(a)),
            Kind::ComponentMultiply(a, b) => self.of(a).zip(&self.of(b), |x, y| x * y),
            Kind::Power(a, exponent) => Value::scalar(self.of(a).first().powi(*exponent)),
            Kind::Apply(function, a) => Value::scalar(function.apply(self.of(a).first())),
            Kind::Vee(a) => {
                let a = self.of(a);
                Value::new(3, 1, |row, _| {
                    let (i, j) = ((row + 2) % 3, (row + 1) % 3);
                    0.5 * (a.at(i, j) - a.at(j, i))
                })
            }
            Kind::Inverse(a) => self.of(a).inverse(),
            Kind::Bound(_, a) => self.of(a),
            Kind::Entry(a, row, column) => Value::scalar(self.of(a).at(*row, *column)),
        }
    }
}
