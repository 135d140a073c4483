//! The terms that don't know stages: momentum maps, diamond, momentum equation, its Jacobian, discrete energy.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::{Fault, Sample, Value, compare, evaluated, remembered, turn};
use crate::declared::{Name, Tree};
use crate::mathematics::derive::Derived;
use crate::mathematics::symbolic::SymbolId;
use crate::program::{Given, Graph, NodeId, Scalariser, components, square, with_lets};

/// The derived terms as operations, for all samples.
pub(super) struct Terms {
    pub(super) graph: Graph,
    pub(super) right: Vec<NodeId>,
    pub(super) left: Vec<NodeId>,
    pub(super) diamond: Vec<NodeId>,
    pub(super) momentum: Vec<NodeId>,
    pub(super) jacobian: Vec<NodeId>,
    pub(super) energy: NodeId,
}

impl Terms {
    pub(super) fn new(derived: &Derived) -> Self {
        let mut graph = Graph::default();
        let none = with_lets(&mut graph, derived, Given::new());
        let [right, left, diamond, momentum] =
            [&derived.right_momentum, &derived.left_momentum, &derived.diamond, &derived.momentum]
                .map(|covector| components(&mut graph, derived, &none, covector));
        let jacobian = square(&mut graph, derived, &none, &derived.jacobian);
        let energy = Scalariser { graph: &mut graph, symbols: &derived.symbols, given: none }.scalar(&derived.energy);
        Self { graph, right, left, diamond, momentum, jacobian, energy }
    }

    /// `μ(F, w)`.
    pub(super) fn momentum(&self, inputs: &BTreeMap<SymbolId, Value>) -> Vec<f64> {
        evaluated(&self.graph, &self.momentum, inputs)
    }

    /// `(L_F)* δl_d/δF`.
    pub(super) fn left(&self, inputs: &BTreeMap<SymbolId, Value>) -> Vec<f64> {
        evaluated(&self.graph, &self.left, inputs)
    }

    /// Whether the momentum and its Jacobian are numbers where a step begins.
    pub(super) fn are_finite_at_identity(&self, sample: &Sample) -> bool {
        let inputs = sample.inputs(&Value::identity(sample.increment.rows));
        let outputs = [self.momentum.as_slice(), &self.jacobian].concat();
        evaluated(&self.graph, &outputs, &inputs).iter().all(|entry| entry.is_finite())
    }

    /// Whether all terms agree with the declaration.
    pub(super) fn check(&self, sample: &Sample, tree: &Rc<Tree>) -> Result<(), Fault> {
        let group = &sample.derived.group;
        let dimension = group.dimension();
        let (f, identity) = (&sample.increment, Value::identity(group.size));
        let inputs = sample.inputs(f);
        let outputs: Vec<NodeId> = [&self.right, &self.left, &self.diamond, &self.momentum, &self.jacobian]
            .into_iter()
            .flatten()
            .copied()
            .collect();
        let found = evaluated(&self.graph, &outputs, &inputs);
        let (covectors, jacobian) = found.split_at(4 * dimension);
        let size = 1.0 + jacobian.iter().map(|x| x.abs()).sum::<f64>() + sample.declared(tree).abs();
        let still = (&identity, &identity);
        for k in 0..dimension {
            let turn = |s: f64| (turn(group, k, s), turn(group, k, -s));
            let on_the_left = |s: f64| sample.moved(tree, &sample.turned(k, s), still);
            let on_the_right = |s: f64| sample.moved(tree, &f.times(&turn(s).0), still);
            let advected = |s: f64| -sample.moved(tree, f, (&turn(s).0, &turn(s).1));
            let jointly = |s: f64| sample.moved(tree, &sample.turned(k, s), (&turn(s).0, &turn(s).1));
            let checks: [(&'static str, &dyn Fn(f64) -> f64); 4] = [
                ("right momentum map", &on_the_left),
                ("left momentum map", &on_the_right),
                ("diamond term", &advected),
                ("momentum equation", &jointly),
            ];
            for (index, (name, function)) in checks.into_iter().enumerate() {
                compare(name, covectors[dimension * index + k], function, size)?;
            }
        }
        // The momentum agrees with the declaration, so its differences are those of the declaration.
        for j in 0..dimension {
            let momentum = remembered(|t| self.momentum(&sample.inputs(&sample.turned(j, t))));
            for k in 0..dimension {
                compare("Newton Jacobian", jacobian[dimension * k + j], &|t| momentum(t)[k], size)?;
            }
        }
        self.check_energy(sample, tree, &inputs)
    }

    fn check_energy(&self, sample: &Sample, tree: &Rc<Tree>, inputs: &BTreeMap<SymbolId, Value>) -> Result<(), Fault> {
        let Some(h) = sample.values.get(&Name::Step).map(Value::first) else { return Ok(()) };
        let found = evaluated(&self.graph, &[self.energy], inputs).first().copied().unwrap_or(f64::NAN);
        // A power of h has a second derivative of the order of the energy over h².
        let size = 1.0 + found.abs() + sample.declared(tree).abs() / h;
        compare("discrete energy", found, &|s| -sample.at_step(tree, h * (1.0 + s)) / h, size)
    }
}
