//! The self-check: derived terms against central differences of the declared expression, before anything is emitted.
//!
//! The declared tree is evaluated on numbers by itself, without the symbolic form, so a wrong rewrite can't agree with
//! itself.

mod force;

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::ast::{Declaration, FieldKind, Kind, Name, Shape, Tree};
use crate::derive::Derived;
use crate::group::Group;
use crate::lower::Lowered;
use crate::scalar::{Graph, Input, NodeId, components, square};
use crate::symbolic::{SymbolId, Variance};

pub(crate) use force::disagreement_of_force;

/// Central differences at this spacing are right to about eight digits.
const SPACING: f64 = 1e-5;
/// What they leave, relative to the size of the terms.
const TOLERANCE: f64 = 1e-5;

/// The first derived term that disagrees with the declaration, if one does.
pub(crate) fn disagreement(
    declaration: &Declaration,
    tree: &Rc<Tree>,
    lowered: &Lowered,
    derived: &Derived,
) -> Option<&'static str> {
    let terms = Terms::new(derived);
    (1..=3).find_map(|seed| Sample::new(declaration, lowered, derived, seed).disagreement(tree, &terms))
}

/// The derived terms as operations, for all samples.
struct Terms {
    graph: Graph,
    /// Right and left momentum map, diamond and momentum, each as long as the group has dimensions.
    covectors: Vec<NodeId>,
    jacobian: Vec<NodeId>,
}

impl Terms {
    fn new(derived: &Derived) -> Self {
        let (mut graph, none) = (Graph::default(), BTreeMap::new());
        let covectors = [&derived.right_momentum, &derived.left_momentum, &derived.diamond, &derived.momentum];
        let covectors =
            covectors.into_iter().flat_map(|covector| components(&mut graph, derived, &none, covector)).collect();
        let jacobian = square(&mut graph, derived, &none, &derived.jacobian);
        Self { graph, covectors, jacobian }
    }
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
struct Sample<'a> {
    derived: &'a Derived,
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
        let f = (0..group.dimension()).fold(Value::identity(group.size), |f, k| {
            let angle = 0.6 * number() - 0.3;
            f.times(&turn(group, k, angle))
        });
        values.insert(Name::Increment, f);
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
        Self { derived, values, symbols, advected }
    }

    fn disagreement(&self, tree: &Rc<Tree>, terms: &Terms) -> Option<&'static str> {
        let group = &self.derived.group;
        let dimension = group.dimension();
        let identity = Value::identity(group.size);
        let evaluated = |outputs: &[NodeId]| {
            terms.graph.evaluate(outputs, &|input: Input| {
                let value = self.symbols.get(&input.symbol).and_then(|name| self.values.get(name));
                value.map_or(f64::NAN, |value| value.at(input.row, input.column))
            })
        };
        let (covectors, jacobian) = (evaluated(&terms.covectors), evaluated(&terms.jacobian));
        let f = self.values.get(&Name::Increment)?.clone();
        // One function of two turns holds all terms: exp(sE_k) exp(tE_j) F and exp(sE_k)·w.
        let at = |k: usize, s: f64, j: usize, t: f64, w: f64| {
            let f = turn(group, k, s).times(&turn(group, j, t)).times(&f);
            self.moved(tree, &f, (&turn(group, k, w), &turn(group, k, -w)))
        };
        let slope = |g: &dyn Fn(f64) -> f64| (g(SPACING) - g(-SPACING)) / (2.0 * SPACING);
        let size: f64 = jacobian.iter().map(|x| x.abs()).sum::<f64>() + at(0, 0.0, 0, 0.0, 0.0).abs();
        // Where the declaration has a value, so have its derivatives; elsewhere (a logarithm of a negative number) none.
        let differs = |found: f64, expected: f64, slack: f64| {
            let agrees = (found - expected).abs() <= slack * TOLERANCE * (1.0 + size);
            expected.is_finite() && !agrees
        };
        for k in 0..dimension {
            let on_the_right = |s: f64| self.moved(tree, &f.times(&turn(group, k, s)), (&identity, &identity));
            let checks = [
                ("right momentum map", slope(&|s| at(k, s, 0, 0.0, 0.0))),
                ("left momentum map", slope(&on_the_right)),
                ("diamond term", -slope(&|s| at(k, 0.0, 0, 0.0, s))),
                ("momentum equation", slope(&|s| at(k, s, 0, 0.0, s))),
            ];
            for (index, (name, expected)) in checks.into_iter().enumerate() {
                if differs(covectors[dimension * index + k], expected, 1.0) {
                    return Some(name);
                }
            }
            for j in 0..dimension {
                // A second difference needs a wider spacing, and is less exact for it.
                let e = 30.0 * SPACING;
                let mixed = |s: f64, t: f64| at(k, s, j, t, s);
                let second = (mixed(e, e) - mixed(e, -e) - mixed(-e, e) + mixed(-e, -e)) / (4.0 * e * e);
                if differs(jacobian[dimension * k + j], second, 100.0) {
                    return Some("Newton Jacobian");
                }
            }
        }
        None
    }

    /// `l_d` at another `F`, with all advected parameters moved by a group element, given with its inverse.
    fn moved(&self, tree: &Rc<Tree>, f: &Value, (g, inverse): (&Value, &Value)) -> f64 {
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
        Evaluation { values: &values, known: BTreeMap::new() }.of(tree).first()
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
            Kind::Entry(a, row, column) => Value::scalar(self.of(a).at(*row, *column)),
        }
    }
}
