//! The terms that don't know stages: momentum maps, diamond, momentum equation, its Jacobian, discrete energy.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::{SPACING, Sample, TOLERANCE, Value, evaluated, slope, turn};
use crate::declared::{Name, Tree};
use crate::mathematics::derive::Derived;
use crate::mathematics::symbolic::SymbolId;
use crate::program::{Given, Graph, NodeId, Scalariser, components, square, with_lets};

/// The derived terms as operations, for all samples.
pub(super) struct Terms {
    graph: Graph,
    right: Vec<NodeId>,
    left: Vec<NodeId>,
    diamond: Vec<NodeId>,
    momentum: Vec<NodeId>,
    jacobian: Vec<NodeId>,
    energy: NodeId,
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

    /// The first term that disagrees with the declaration.
    pub(super) fn disagreement(&self, sample: &Sample, tree: &Rc<Tree>) -> Option<&'static str> {
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
        let size: f64 = jacobian.iter().map(|x| x.abs()).sum::<f64>() + sample.declared(tree).abs();
        let differs = |found: f64, expected: f64| differs(found, expected, 1.0 + size);
        let still = (&identity, &identity);
        for k in 0..dimension {
            let turn = |s: f64| (turn(group, k, s), turn(group, k, -s));
            let on_the_left = |s: f64| sample.moved(tree, &sample.turned(k, s), still);
            let on_the_right = |s: f64| sample.moved(tree, &f.times(&turn(s).0), still);
            let advected = |s: f64| sample.moved(tree, f, (&turn(s).0, &turn(s).1));
            let jointly = |s: f64| sample.moved(tree, &sample.turned(k, s), (&turn(s).0, &turn(s).1));
            let checks = [
                ("right momentum map", slope(&on_the_left)),
                ("left momentum map", slope(&on_the_right)),
                ("diamond term", -slope(&advected)),
                ("momentum equation", slope(&jointly)),
            ];
            for (index, (name, expected)) in checks.into_iter().enumerate() {
                if differs(covectors[dimension * index + k], expected) {
                    return Some(name);
                }
            }
        }
        // The momentum agrees with the declaration, so its differences are those of the declaration.
        for j in 0..dimension {
            let [after, before] = [SPACING, -SPACING].map(|t| self.momentum(&sample.inputs(&sample.turned(j, t))));
            for k in 0..dimension {
                if differs(jacobian[dimension * k + j], (after[k] - before[k]) / (2.0 * SPACING)) {
                    return Some("Newton Jacobian");
                }
            }
        }
        self.energy_disagrees(sample, tree, &inputs).then_some("discrete energy")
    }

    fn energy_disagrees(&self, sample: &Sample, tree: &Rc<Tree>, inputs: &BTreeMap<SymbolId, Value>) -> bool {
        let Some(h) = sample.values.get(&Name::Step).map(Value::first) else { return false };
        let found = evaluated(&self.graph, &[self.energy], inputs).first().copied().unwrap_or(f64::NAN);
        // A power of h has a second derivative of the order of the energy over h².
        let expected = -slope(&|s| sample.at_step(tree, h * (1.0 + s))) / h;
        differs(found, expected, 1.0 + found.abs() + sample.declared(tree).abs() / h)
    }
}

/// Where the declaration has a value, so have its derivatives; elsewhere (a logarithm of a negative number) none.
fn differs(found: f64, expected: f64, size: f64) -> bool {
    let agrees = (found - expected).abs() <= TOLERANCE * size;
    expected.is_finite() && !agrees
}
