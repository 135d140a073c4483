//! What is derived for several bodies, against dual numbers of the declaration as it is written, to rounding.
//!
//! The declarations are random: which bodies turn and which are translated, what each sees, and all terms. Of what is
//! compared they share the tree alone, which is evaluated as it stands, and the rule `f⁻¹ · w` by which values move.

mod random;

use std::collections::BTreeMap;

use super::super::dual::Dual;
use super::super::evaluation::Evaluation;
use super::super::step::Step;
use super::super::terms::Terms;
use super::super::{Sample, Value, block, evaluated, inverse_of, linear};
use super::{Declared, with_one_sign_changed};
use crate::declared::Name;
use crate::mathematics::derive::Derived;
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Expression, SymbolId};
use crate::program::{Kernel, kernel};
use random::Text;

/// Of the size of the terms, J s.
const BOUND: f64 = 1e-13;

/// Two infinitesimals, each with a square of zero.
type Twice = Dual<Dual<f64>>;

fn dual(value: f64, first: f64, second: f64) -> Twice {
    Dual { value: Dual { value, slope: second }, slope: Dual { value: first, slope: 0.0 } }
}

fn lifted(value: &Value) -> Value<Twice> {
    Value {
        rows: value.rows,
        columns: value.columns,
        entries: value.entries.iter().map(|&x| dual(x, 0.0, 0.0)).collect(),
    }
}

/// `exp(ε E_k)`, which is `I + ε E_k`.
fn turned(group: &Group, k: usize, epsilon: Twice) -> Value<Twice> {
    let generator = Value::<Twice>::square(group.size, &group.generators[k]);
    Value::identity(group.size).plus(&generator.map(|entry| entry * epsilon))
}

/// One declaration at one point.
struct Point<'a> {
    declared: &'a Declared,
    sample: Sample<'a>,
    /// The same in dual numbers.
    lifted: Sample<'a, Twice>,
}

impl<'a> Point<'a> {
    fn new(declared: &'a Declared, seed: u64) -> Self {
        let sample = Sample::new(&declared.declaration, &declared.lowered, &declared.derived, seed);
        let lifted = Sample {
            derived: sample.derived,
            increment: lifted(&sample.increment),
            inverse: lifted(&sample.inverse),
            values: sample.values.iter().map(|(name, value)| (*name, lifted(value))).collect(),
            symbols: sample.symbols.clone(),
            advected: sample.advected.clone(),
        };
        Self { declared, sample, lifted }
    }

    fn group(&self) -> &Group {
        &self.declared.derived.group
    }

    /// `l_d(F, e·w)` with `e = exp(ε E_k)`.
    fn l_d(&self, f: &Value<Twice>, moved: Option<(usize, Twice)>) -> Twice {
        let still = Value::identity(self.group().size);
        let (e, inverse) = moved.map_or((still.clone(), still), |(k, epsilon)| {
            (turned(self.group(), k, epsilon), turned(self.group(), k, dual(0.0, 0.0, 0.0) - epsilon))
        });
        let values = self.lifted.moved_values(f, (&e, &inverse));
        Evaluation::new(&values).of(&self.declared.tree).first()
    }

    /// `μ_k` with its change along the second infinitesimal, at any increment.
    fn momentum(&self, f: &Value<Twice>, k: usize) -> Dual<f64> {
        let first = dual(0.0, 1.0, 0.0);
        self.l_d(&turned(self.group(), k, first).times(f), Some((k, first))).slope
    }

    /// The same of all components, at an increment without infinitesimals.
    fn momenta(&self, f: &Value) -> Vec<f64> {
        (0..self.group().dimension()).map(|k| self.momentum(&lifted(f), k).value).collect()
    }

    /// `(L_F)* δl_d/δF`.
    fn left(&self, f: &Value) -> Vec<f64> {
        let along = |k| lifted(f).times(&turned(self.group(), k, dual(0.0, 1.0, 0.0)));
        (0..self.group().dimension()).map(|k| self.l_d(&along(k), None).slope.value).collect()
    }

    /// The increment of Cayley coordinates `y`, `cay(2y)`; of what is translated `2y`.
    fn increment(&self, y: &[Twice]) -> Value<Twice> {
        let (group, mut f) = (self.group(), Value::identity(self.group().size));
        for (factor, own) in group.factors().iter().enumerate() {
            let (row, first) = (group.row_of(factor), group.component_of(factor));
            let y = Value { rows: own.dimension(), columns: 1, entries: y[first..first + own.dimension()].to_vec() };
            let part = if own.is_added {
                let two = dual(2.0, 0.0, 0.0);
                Value::new(own.size, own.size, |i, j| match (i == j, j + 1 == own.size) {
                    (true, _) => dual(1.0, 0.0, 0.0),
                    (false, true) if i < own.dimension() => two * y.at(i, 0),
                    _ => dual(0.0, 0.0, 0.0),
                })
            } else {
                let (hat, one) = (Value::hat(&y), Value::identity(3));
                one.zip(&hat, |x, y| x - y).inverse().times(&one.plus(&hat))
            };
            let known = f.clone();
            f = Value::new(group.size, group.size, |i, j| {
                let inside = |at: usize| (row..row + own.size).contains(&at);
                if inside(i) && inside(j) { part.at(i - row, j - row) } else { known.at(i, j) }
            });
        }
        f
    }

    /// `Ad*_F`: a body's own rotation turns its momentum back, and a translation leaves it.
    fn transported(&self, f: &Value, covector: &[f64]) -> Vec<f64> {
        let group = self.group();
        let parts = group.factors().iter().enumerate().flat_map(|(factor, own)| {
            let first = group.component_of(factor);
            let entries = covector[first..first + own.dimension()].to_vec();
            let part = Value { rows: own.dimension(), columns: 1, entries };
            if own.is_added { part.entries } else { block(group, f, factor).transpose().times(&part).entries }
        });
        parts.collect()
    }

    /// All terms that don't know stages.
    fn check_terms(&self, derived: &Derived) -> Result<(), &'static str> {
        let (terms, dimension, f) = (Terms::new(derived), self.group().dimension(), &self.sample.increment);
        let inputs = self.sample.inputs(f);
        let found = |outputs: &[_]| evaluated(&terms.graph, outputs, &inputs);
        let [right, left, diamond, momentum, jacobian] =
            [&terms.right, &terms.left, &terms.diamond, &terms.momentum, &terms.jacobian].map(|all| found(all));
        let size: f64 = [&right, &left, &diamond, &jacobian].into_iter().flatten().map(|entry| entry.abs()).sum();
        let close = |what, found: f64, expected: f64| near(what, found, expected, size);
        let (first, still) = (dual(0.0, 1.0, 0.0), lifted(f));
        for (k, expected) in self.left(f).into_iter().enumerate() {
            let turn = turned(self.group(), k, first).times(&still);
            close("right momentum", right[k], self.l_d(&turn, None).slope.value)?;
            close("left momentum", left[k], expected)?;
            close("diamond", diamond[k], -self.l_d(&still, Some((k, first))).slope.value)?;
            close("momentum", momentum[k], self.momentum(&still, k).value)?;
            for j in 0..dimension {
                let inner = turned(self.group(), j, dual(0.0, 0.0, 1.0)).times(&still);
                close("Jacobian", jacobian[dimension * k + j], self.momentum(&inner, k).slope)?;
            }
        }
        let mut at_step = self.lifted.values.clone();
        at_step.insert(Name::Step, self.lifted.values[&Name::Step].map(|h| h + first));
        let rate = Evaluation::new(&at_step).of(&self.declared.tree).first().slope.value;
        let h = self.sample.values[&Name::Step].first();
        near("energy", found(&[terms.energy])[0], -rate, size / h)
    }

    /// What a stepper runs: from a point next to the solution Newton's iteration finds an `F` of the momentum, and the
    /// momentum behind the step is that of the declaration.
    fn check_step(&self, kernel: &Kernel) -> Result<(), &'static str> {
        let directions = &self.declared.derived.directions;
        let (dimension, graph) = (self.group().dimension(), &kernel.graph);
        let mu = self.momenta(&self.sample.increment);
        let kick = evaluated(graph, &kernel.kick_before, &self.sample.inputs(&self.sample.increment));
        let a: Vec<f64> = mu.iter().zip(&kick).map(|(mu, kick)| mu + kick).collect();
        let column = |entries: &[f64]| Value { rows: entries.len(), columns: 1, entries: entries.to_vec() };
        let at = |y: &[f64]| self.increment(&y.iter().map(|&y| dual(y, 0.0, 0.0)).collect::<Vec<_>>());
        let plain = |f: &Value<Twice>| Value {
            rows: f.rows,
            columns: f.columns,
            entries: f.entries.iter().map(|x| x.value.value).collect(),
        };
        let step = Step { derived: &self.declared.derived, kernel };
        let inputs = |y: &[f64], a: &[f64]| {
            let mut inputs = step.inputs(&self.sample, &plain(&at(y)));
            inputs.extend([(directions.coordinates, column(y)), (directions.target, column(a))]);
            inputs
        };
        let mut y = step.inputs(&self.sample, &self.sample.increment)[&directions.coordinates].entries.clone();
        y.iter_mut().enumerate().for_each(|(k, y)| *y += 1e-3 * f64::from(u8::from(k % 2 == 0)));
        for _ in 0..8 {
            let inputs = inputs(&y, &a);
            let (residual, jacobian) =
                (evaluated(graph, &kernel.residual, &inputs), evaluated(graph, &kernel.jacobian, &inputs));
            let square = Value { rows: dimension, columns: dimension, entries: jacobian };
            let update = linear::solve(&square, &column(&residual)).ok_or("singular")?;
            y.iter_mut().zip(&update.entries).for_each(|(y, update)| *y -= update);
        }
        let there = inputs(&y, &a);
        let jacobian = evaluated(graph, &kernel.jacobian, &there);
        let f = plain(&at(&y));
        let scale = 2.0 / self.sample.values[&Name::Step].first();
        let size = mu.iter().chain(&kick).map(|x| x.abs()).sum::<f64>()
            + scale * jacobian.iter().map(|x| x.abs()).sum::<f64>();
        for (found, expected) in self.momenta(&f).into_iter().zip(&mu) {
            near("momentum of the step", found, *expected, size)?;
        }
        // Where the residual is zero, the Jacobian is that of the momentum, times what the row is multiplied by.
        for k in 0..dimension {
            let mut shifted = a.clone();
            shifted[k] -= 1.0;
            let factor = evaluated(graph, &kernel.residual, &inputs(&y, &shifted))[k];
            for j in 0..dimension {
                let along = |i: usize| dual(y[i], 0.0, f64::from(u8::from(i == j)));
                let f = self.increment(&(0..dimension).map(along).collect::<Vec<_>>());
                near("Newton Jacobian", jacobian[dimension * k + j], factor * self.momentum(&f, k).slope, size)?;
            }
        }
        self.check_transport(kernel, there, (&f, &a), size)
    }

    /// `μ⁺ = Ad*_F a + k₁⁺` is `(L_F)* δl_d/δF`.
    fn check_transport(
        &self,
        kernel: &Kernel,
        mut inputs: BTreeMap<SymbolId, Value>,
        (f, a): (&Value, &[f64]),
        size: f64,
    ) -> Result<(), &'static str> {
        let (group, directions) = (self.group(), &self.declared.derived.directions);
        let inverse = inverse_of(group, f);
        let next = self.sample.moved_values(f, (&inverse, f));
        for ((name, ..), &symbol) in self.sample.advected.iter().zip(&directions.next) {
            inputs.insert(symbol, next[name].clone());
        }
        let after = evaluated(&kernel.graph, &kernel.kick_after, &inputs);
        let moved = evaluated(&kernel.graph, &kernel.moved, &inputs);
        let carried = self.transported(f, a);
        for (k, expected) in self.left(f).into_iter().enumerate() {
            near("momentum behind the step", carried[k] + after[k], expected, size)?;
        }
        if !moved.is_empty() {
            for (found, expected) in self.transported(f, &moved).into_iter().zip(after) {
                near("moved diamond", found, expected, size)?;
            }
        }
        Ok(())
    }

    fn check(&self, derived: &Derived, kernel: &Kernel) -> Result<(), &'static str> {
        self.check_terms(derived)?;
        self.check_step(kernel)
    }
}

fn near(what: &'static str, found: f64, expected: f64, size: f64) -> Result<(), &'static str> {
    if (found - expected).abs() <= BOUND * size { Ok(()) } else { Err(what) }
}

/// Every kind of term is in some of them: the text that shows it.
const KINDS: [(&str, &str); 12] = [
    ("a field that a body sees", ".dot(&w_"),
    ("a relative attitude in the kinetic energy", ".dot(&(Q_"),
    ("one between velocities by `vee`", "* vee(F_"),
    ("both ends of a relative attitude", ".transpose() * Q_"),
    ("an attitude in space", "(R_"),
    ("a place", "x_"),
    ("a place from another body", "r_"),
    ("a turn about an axis", "y_"),
    ("a velocity of translation with one of rotation", ".dot(&(R_"),
    ("an inertia that depends on what is seen", ").powi(2) / h"),
    ("a function that is called", "U("),
    ("a value that is named", "let z = y - "),
];

#[test]
fn random_declarations_on_products() {
    let mut missing = BTreeMap::from(KINDS);
    for seed in 0..40 {
        let (arguments, item) = Text::of(seed);
        // Of the one that fails.
        println!("{seed}: {arguments}\n{item}");
        missing.retain(|_, text| !arguments.contains(*text));
        let declared = Declared::new(&arguments, &item);
        let kernel = kernel(&declared.derived);
        for point in 1..3 {
            let found = Point::new(&declared, point).check(&declared.derived, &kernel);
            assert_eq!(found, Ok(()), "{seed}");
        }
    }
    assert!(missing.is_empty(), "in no declaration: {:?}", missing.keys());
}

/// One wrong sign among the terms of each equation is seen.
#[test]
fn a_wrong_sign_is_seen() {
    type Equation = (&'static str, fn(&mut Derived) -> &mut Expression);
    let equations: [Equation; 9] = [
        ("right momentum", |d| &mut d.right_momentum),
        ("left momentum", |d| &mut d.left_momentum),
        ("diamond", |d| &mut d.diamond),
        ("momentum", |d| &mut d.momentum),
        ("Jacobian", |d| &mut d.jacobian),
        ("energy", |d| &mut d.energy),
        ("kick before", |d| &mut d.kick_before),
        ("kick after", |d| &mut d.kick_after),
        ("unknown", |d| &mut d.unknown),
    ];
    for seed in 0..6 {
        let (arguments, item) = Text::of(seed);
        let declared = Declared::new(&arguments, &item);
        let point = Point::new(&declared, 1);
        for (name, of) in equations {
            let mut derived = declared.derived.clone();
            let term = of(&mut derived);
            if term.is_zero() {
                continue;
            }
            *term = with_one_sign_changed(term);
            let found = point.check(&derived, &kernel(&derived));
            assert!(found.is_err(), "{name} in {arguments}");
        }
    }
}
