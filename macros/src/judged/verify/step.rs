//! The emitted step: the Newton system that it solves, and the momentum that it transports.

use std::collections::BTreeMap;

use super::terms::Terms;
use super::{Fault, SPACING, Sample, Value, block, compare, evaluated, linear, remembered, translation, turn};
use crate::mathematics::derive::Derived;
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::SymbolId;
use crate::program::Kernel;

/// What agrees but for rounding.
const ROUNDING: f64 = 1e-9;

/// The stages of a step, whose solution at a sample point is the point's `F`.
pub(super) struct Step<'a> {
    pub(super) derived: &'a Derived,
    pub(super) kernel: &'a Kernel,
}

impl Step<'_> {
    /// Whether all parts of the step agree with the terms.
    pub(super) fn check(&self, sample: &Sample, terms: &Terms) -> Result<(), Fault> {
        let inputs = self.inputs(sample, &sample.increment);
        let momentum = terms.momentum(&inputs);
        let before = evaluated(&self.kernel.graph, &self.kernel.kick_before, &inputs);
        let target: Vec<f64> = momentum.iter().zip(&before).map(|(mu, kick)| mu + kick).collect();
        if target.iter().any(|entry| !entry.is_finite()) {
            return Err(Fault::Untold);
        }
        self.check_newton(sample, &inputs, &target)?;
        if self.transport_disagrees(sample, &inputs, &target, &terms.left(&inputs)) {
            return Err(Fault::Disagrees("transported momentum"));
        }
        self.check_kick_derivative(sample, &inputs)
    }

    /// Along each generator, against the kicks at `exp(∓t E_j)·w`.
    fn check_kick_derivative(&self, sample: &Sample, inputs: &BTreeMap<SymbolId, Value>) -> Result<(), Fault> {
        let (graph, group, along) = (&self.kernel.graph, &self.derived.group, self.derived.directions.along);
        let Some(outputs) = &self.kernel.kick_derivative else { return Ok(()) };
        for j in 0..group.dimension() {
            let kick = remembered(|t: f64| {
                let values = sample.moved_values(&sample.increment, (&turn(group, j, -t), &turn(group, j, t)));
                let mut inputs = inputs.clone();
                for (symbol, name) in &sample.symbols {
                    inputs.extend(values.get(name).map(|value| (*symbol, value.clone())));
                }
                evaluated(graph, &self.kernel.kick_before, &inputs)
            });
            let mut inputs = inputs.clone();
            inputs.insert(along, Value::new(group.dimension(), 1, |row, _| if row == j { 1.0 } else { 0.0 }));
            let found = evaluated(graph, outputs, &inputs);
            let size = 1.0 + found.iter().chain(&kick(SPACING)).map(|x| x.abs()).sum::<f64>();
            for (k, found) in found.into_iter().enumerate() {
                compare("derivative of the kick", found, &|t| kick(t)[k], size)?;
            }
        }
        Ok(())
    }

    /// Those of the terms, and the coordinates of the Newton system.
    pub(super) fn inputs(&self, sample: &Sample, f: &Value) -> BTreeMap<SymbolId, Value> {
        let mut inputs = sample.inputs(f);
        if self.derived.group.rotates() {
            let group = &self.derived.group;
            let coordinates = |factor: usize| match block(group, f, factor) {
                own if group.factor(factor).is_added => translation(&own).map(|d| 0.5 * d),
                own => cayley_coordinates(&own),
            };
            let parts = (0..group.factors().len()).flat_map(|factor| coordinates(factor).entries);
            inputs.insert(self.derived.directions.coordinates, column(&parts.collect::<Vec<_>>()));
        }
        inputs
    }

    /// The residual is a multiple of `U(F, w) − a`, positive as the sample's step is, and the Jacobian its derivative.
    fn check_newton(&self, sample: &Sample, inputs: &BTreeMap<SymbolId, Value>, target: &[f64]) -> Result<(), Fault> {
        let (graph, directions, dimension) = (&self.kernel.graph, &self.derived.directions, target.len());
        let with_target = |mut inputs: BTreeMap<SymbolId, Value>, target: &[f64]| {
            inputs.insert(directions.target, column(target));
            inputs
        };
        let residual = |inputs: &BTreeMap<SymbolId, Value>| evaluated(graph, &self.kernel.residual, inputs);
        let jacobian = |inputs: &BTreeMap<SymbolId, Value>| evaluated(graph, &self.kernel.jacobian, inputs);
        let at_solution = with_target(inputs.clone(), target);
        let (solved, jacobian_there) = (residual(&at_solution), jacobian(&at_solution));
        let size = 1.0 + jacobian_there.iter().chain(target).map(|x| x.abs()).sum::<f64>();
        if !is_small(&solved, ROUNDING * size) {
            return Err(Fault::Disagrees("Newton residual at the solution"));
        }
        let offset: Vec<f64> = (0..dimension).map(|k| if k % 2 == 0 { 0.7 } else { -0.4 } * size).collect();
        let shifted: Vec<f64> = target.iter().zip(&offset).map(|(a, d)| a + d).collect();
        let elsewhere = with_target(inputs.clone(), &shifted);
        let (found, jacobian) = (residual(&elsewhere), jacobian(&elsewhere));
        let factor = -dot(&found, &offset) / dot(&offset, &offset);
        let rest: Vec<f64> = found.iter().zip(&offset).map(|(r, d)| r + factor * d).collect();
        let size = 1.0 + found.iter().chain(&jacobian).map(|x| x.abs()).sum::<f64>();
        // A factor that isn't a number isn't positive.
        if factor.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) || !is_small(&rest, ROUNDING * size) {
            return Err(Fault::Disagrees("Newton residual"));
        }
        for j in 0..dimension {
            let residual = remembered(|t| residual(&with_target(self.displaced(sample, inputs, j, t), &shifted)));
            for k in 0..dimension {
                compare("Newton Jacobian of the step", jacobian[dimension * k + j], &|t| residual(t)[k], size)?;
            }
        }
        Ok(())
    }

    /// The point displaced in the coordinates of the Newton system: `y` on SO(3), elsewhere `F ↦ exp(t E_j) F`.
    fn displaced(
        &self,
        sample: &Sample,
        inputs: &BTreeMap<SymbolId, Value>,
        j: usize,
        t: f64,
    ) -> BTreeMap<SymbolId, Value> {
        if self.kernel.in_increment {
            return self.inputs(sample, &sample.turned(j, t));
        }
        let mut inputs = inputs.clone();
        if let Some(entry) = inputs.get_mut(&self.derived.directions.coordinates).and_then(|y| y.entries.get_mut(j)) {
            *entry += t;
        }
        inputs
    }

    /// `Ad*_F a + k₁⁺` against `(L_F)* δl_d/δF`.
    fn transport_disagrees(
        &self,
        sample: &Sample,
        inputs: &BTreeMap<SymbolId, Value>,
        target: &[f64],
        left: &[f64],
    ) -> bool {
        let directions = &self.derived.directions;
        let mut inputs = inputs.clone();
        for (factor, one) in directions.factors.iter().enumerate() {
            inputs.insert(one.inverse, block(&self.derived.group, &sample.inverse, factor));
        }
        let carried = sample.moved_values(&sample.increment, (&sample.inverse, &sample.increment));
        for ((name, ..), &next) in sample.advected.iter().zip(&directions.next) {
            inputs.extend(carried.get(name).map(|w| (next, w.clone())));
        }
        let after = evaluated(&self.kernel.graph, &self.kernel.kick_after, &inputs);
        let Some(turned) = adjoint_transpose(&self.derived.group, &sample.increment, &sample.inverse, target) else {
            return false;
        };
        let size = 1.0 + target.iter().chain(&after).chain(left).map(|x| x.abs()).sum::<f64>();
        let defect: Vec<f64> = turned.iter().zip(&after).zip(left).map(|((x, y), z)| x + y - z).collect();
        if !is_small(&defect, ROUNDING * size) {
            return true;
        }
        // What the gradient gives beside the residual is the same before Ad*_F.
        let moved = evaluated(&self.kernel.graph, &self.kernel.moved, &inputs);
        let carried = adjoint_transpose(&self.derived.group, &sample.increment, &sample.inverse, &moved);
        let carried = carried.filter(|_| !moved.is_empty()).unwrap_or_else(|| after.clone());
        let defect: Vec<f64> = carried.iter().zip(&after).map(|(x, y)| x - y).collect();
        !is_small(&defect, ROUNDING * size)
    }
}

/// `(Ad*_F ν)_k = ⟨ν, F E_k F⁻¹⟩`.
fn adjoint_transpose(group: &Group, f: &Value, inverse: &Value, covector: &[f64]) -> Option<Vec<f64>> {
    let generators: Vec<Value> = (0..group.dimension()).map(|k| generator(group, k)).collect();
    let dimension = generators.len();
    let gram = Value::new(dimension, dimension, |i, j| dot(&generators[i].entries, &generators[j].entries));
    let turned: Vec<Value> = generators.iter().map(|e| f.times(e).times(inverse)).collect();
    let projected = Value::new(dimension, dimension, |i, k| dot(&generators[i].entries, &turned[k].entries));
    let components = linear::solve(&gram, &projected)?;
    Some(components.transpose().times(&column(covector)).entries)
}

fn generator(group: &Group, k: usize) -> Value {
    let entries = group.generators.get(k).map_or(&[][..], Vec::as_slice);
    let entries = entries.iter().map(|entry| entry.to_f64()).collect();
    Value { rows: group.size, columns: group.size, entries }
}

/// `y` with `cay(2y) = F`.
fn cayley_coordinates(f: &Value) -> Value {
    let scale = 1.0 / (1.0 + f.at(0, 0) + f.at(1, 1) + f.at(2, 2));
    Value::new(3, 1, |row, _| {
        let (i, j) = ((row + 2) % 3, (row + 1) % 3);
        scale * (f.at(i, j) - f.at(j, i))
    })
}

fn column(entries: &[f64]) -> Value {
    Value { rows: entries.len(), columns: 1, entries: entries.to_vec() }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Whether all entries are numbers of at most that size.
fn is_small(entries: &[f64], size: f64) -> bool {
    entries.iter().all(|entry| entry.abs() <= size)
}
