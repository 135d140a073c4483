//! The identities of a derivation, in numbers of any kind.
//!
//! A covector is compared along one random direction `v`, and a Jacobian by its product with `v`: both are linear in
//! it, so an identity in `v` holds for every component. First derivatives use dual numbers `x + ε x′`, where
//! `(I + ε v̂) F` is an element of the group to first order; second derivatives are first derivatives of terms already
//! compared.

use std::collections::BTreeMap;
use std::ops::Add as _;

use super::degree::Content;
use super::dual::Dual;
use super::evaluation::Evaluation;
use super::number::Number;
use super::residue::Residue;
use super::sample::{Element, Sample, Subject, exponentials, products};
use super::value::Value;
use super::{Objection, Values, algebra, components_of, dot, evaluated, evaluated_from, increments, shares};
use crate::declared::{FieldKind, Name, Role};
use crate::judged::places::{places, shape, variables};
use crate::mathematics::derive::Derivation;
use crate::mathematics::symbolic::{Rational, Stage, SymbolId};
use crate::program::{
    Beginning, ByNumbers, Derivatives, Graph, Handover, Kernel, NodeId, Outputs, Scalariser, Stages, WeightedGradient,
    components, square,
};

/// The values of symbols.
type Inputs<T> = BTreeMap<SymbolId, Value<T>>;

/// The comparison of a found value with an expected one, for a named term.
pub type Same<'a, T> = dyn FnMut(&'static str, T, T) -> Result<(), Objection> + 'a;

/// The derived terms as operations.
pub struct Terms {
    pub graph: Graph,
    /// The Jacobian, built first, so that its nodes are those of a graph with nothing else in it.
    pub jacobian: Vec<NodeId>,
    pub momentum: Vec<NodeId>,
    /// The right-trivialised momentum `(R_F)* δl_d/δF`, empty for a force, like the terms below.
    pub right: Vec<NodeId>,
    pub left: Vec<NodeId>,
    pub diamond: Vec<NodeId>,
    pub energy: Option<NodeId>,
}

impl Terms {
    fn new(derived: &Derivation, role: Role, Beginning { mut graph, given }: Beginning) -> Self {
        let jacobian = square(&mut graph, derived, &given, &derived.jacobian);
        let momentum = components(&mut graph, derived, &given, &derived.momentum);
        let none = Self { momentum, jacobian, right: vec![], left: vec![], diamond: vec![], energy: None, graph };
        if role == Role::Force {
            return none;
        }
        let mut graph = none.graph;
        let [right, left, diamond] = [&derived.right_momentum, &derived.left_momentum, &derived.diamond]
            .map(|covector| components(&mut graph, derived, &given, covector));
        let energy = Scalariser::new(&mut graph, &derived.symbols, &given).scalar(&derived.energy);
        Self { right, left, diamond, energy: Some(energy), graph, ..none }
    }
}

/// A declaration with its derivation.
pub struct Identities<'a> {
    pub of: Subject<'a>,
    pub kernel: &'a Kernel,
    pub stages: Stages,
    pub terms: Terms,
    pub derivatives: Option<Derivatives>,
    /// `J`, `s` and `V` of the limit, if derivatives of a step are requested.
    limit: Option<Outputs<[Vec<NodeId>; 3]>>,
}

/// One point with one direction.
struct Point<'a, T> {
    sample: &'a Sample<'a, T>,
    dual: Sample<'a, Dual<T>>,
    /// `v`, `v̂` and `exp(±ε v̂)`.
    direction: Vec<T>,
    element: Vec<Value<T>>,
    exponentials: [Vec<Value<Dual<T>>>; 2],
    turned: Element<Dual<T>>,
    /// A random covector, different from that of the solution.
    target: Vec<T>,
    /// Weights of the momenta at both ends, `u` and `p`.
    weights: [Vec<T>; 2],
}

impl<T: Number> Point<'_, T> {
    /// Whether the rows of a matrix, times the direction, are these slopes.
    fn are_slopes(
        &self,
        term: &'static str,
        matrix: &[T],
        along: &[Dual<T>],
        same: &mut Same<T>,
    ) -> Result<(), Objection> {
        let mut rows = matrix.chunks(along.len()).zip(along);
        rows.try_for_each(|(row, one)| same(term, dot(row, &self.direction), one.slope))
    }
}

/// The declared derivatives along the direction of a point.
struct DeclaredValues<T> {
    momentum: T,
    /// The momentum at the end of the step.
    left: T,
}

impl<'a> Identities<'a> {
    pub fn new(of: Subject<'a>, kernel: &'a Kernel) -> Self {
        let Subject { declaration, lowered, derived, .. } = of;
        let derivatives =
            derived.ends.as_ref().map(|ends| Derivatives::new(derived, ends, &places(declaration, &lowered.names)));
        let has_gradient = derivatives.as_ref().is_some_and(|all| all.of_kick.is_some());
        let terms = Terms::new(derived, declaration.role, kernel.beginning.clone());
        let limit = has_gradient.then(|| kernel.beginning.limit(derived));
        Self { of, kernel, stages: kernel.stages(), terms, derivatives, limit }
    }

    /// The functions and constants of the declaration and of all graphs.
    pub fn content(&self) -> Content {
        let derivatives = self.derivatives.iter().map(|all| &all.graph);
        let limit = self.limit.iter().map(|(graph, _)| graph);
        let graphs = [&self.terms.graph, &self.kernel.graph].into_iter().chain(derivatives).chain(limit);
        graphs.map(Content::of_graph).fold(Content::of_tree(self.of.tree), Content::add)
    }

    /// Whether the momentum and its Jacobian have values at the identity, where a step begins: in the field only a
    /// division by zero and a root or a logarithm of zero have none.
    pub fn are_smooth(&self) -> bool {
        let identity = Element::identity(&self.of.declaration.group);
        let sample: Sample<Residue> = Sample::at(self.of, identity, &mut Residue::stream(1));
        let outputs = [self.terms.momentum.as_slice(), &self.terms.jacobian].concat();
        evaluated(&self.terms.graph, &outputs, &sample.inputs()).into_iter().all(Number::is_defined)
    }

    /// Compares everything at one point, along a direction of these numbers.
    pub fn hold<T: Number>(
        &self,
        sample: &Sample<T>,
        mut number: impl FnMut() -> T,
        same: &mut Same<T>,
    ) -> Result<(), Objection> {
        let group = &self.of.derived.group;
        let mut vector = || group.generators.iter().map(|_| number()).collect::<Vec<T>>();
        let (direction, target, weights) = (vector(), vector(), [vector(), vector()]);
        let element = algebra(group, &direction);
        let exponentials = exponentials(&element);
        let turned = sample.element.turned(&exponentials);
        let point = Point { sample, dual: sample.lifted(), direction, element, exponentials, turned, target, weights };
        let declared = match self.of.declaration.role {
            Role::Force => self.declared_work(&point, same)?,
            _ => self.lagrangian_holds(&point, same)?,
        };
        let momentum = self.momentum_holds(&point, &declared, same)?;
        self.step_holds(&point, &momentum, &declared, same)?;
        self.derivatives_hold(&point, &momentum, &declared, &mut number, same)
    }

    fn at<T: Number>(&self, values: &Values<T>) -> T {
        Evaluation::new(values).of(self.of.tree).first()
    }

    /// Compares the declared virtual work along the direction, of the displacement at each end alone; their sum must be
    /// the work of both.
    fn declared_work<T: Number>(&self, point: &Point<T>, same: &mut Same<T>) -> Result<DeclaredValues<T>, Objection> {
        let group = &self.of.derived.group;
        let work = |before: T, after: T| {
            let mut values = point.sample.values.clone();
            for (factor, (_, share)) in shares(group, &point.direction).enumerate() {
                let along = Value::column(share);
                let [before, after] = [before, after].map(|share| along.map(|x| share * x));
                values.extend([(Name::DisplacementBefore(factor), before), (Name::DisplacementAfter(factor), after)]);
            }
            self.at(&values)
        };
        let (before, after) = (work(T::ONE, T::ZERO), work(T::ZERO, T::ONE));
        same("force of both displacements", work(T::ONE, T::ONE), before + after)?;
        Ok(DeclaredValues { momentum: -before, left: after })
    }

    /// Compares both momentum maps, the diamond and the energy with derivatives of the declared Lagrangian.
    fn lagrangian_holds<T: Number>(
        &self,
        point: &Point<T>,
        same: &mut Same<T>,
    ) -> Result<DeclaredValues<T>, Objection> {
        let (group, dual) = (&self.of.derived.group, &point.dual);
        let [forwards, backwards] = &point.exponentials;
        let at_increment = |f: &[Value<Dual<T>>]| {
            let mut values = dual.values.clone();
            values.extend(increments(group, f));
            self.at(&values).slope
        };
        let right = at_increment(&point.turned.matrices);
        let left = at_increment(&products(&dual.element.matrices, forwards));
        let carried = self.at(&dual.moved([forwards, backwards])).slope;
        let mut at_step = dual.values.clone();
        if let Some(h) = at_step.get_mut(&Name::Step) {
            *h = h.map(|h| Dual { slope: T::ONE, ..h });
        }
        let terms = &self.terms;
        let outputs = [terms.right.as_slice(), &terms.left, &terms.diamond, terms.energy.as_slice()].concat();
        let found = evaluated(&terms.graph, &outputs, &point.sample.inputs());
        let (covectors, energy) = found.split_at(3 * group.dimension());
        let names = [("right momentum map", right), ("left momentum map", left), ("diamond term", -carried)];
        for ((name, expected), found) in names.into_iter().zip(covectors.chunks(group.dimension())) {
            same(name, dot(found, &point.direction), expected)?;
        }
        for &found in energy {
            same("discrete energy", found, -self.at(&at_step).slope)?;
        }
        Ok(DeclaredValues { momentum: right + carried, left })
    }

    /// Compares the momentum with the declaration, and the Jacobian with the momentum's derivative; returns the
    /// momentum.
    fn momentum_holds<T: Number>(
        &self,
        point: &Point<T>,
        declared: &DeclaredValues<T>,
        same: &mut Same<T>,
    ) -> Result<Vec<T>, Objection> {
        let (graph, dual) = (&self.terms.graph, &point.dual);
        let along = evaluated(graph, &self.terms.momentum, &dual.inputs_at(&point.turned, &dual.values));
        let momentum: Vec<T> = along.iter().map(|one| one.value).collect();
        let name = if self.of.declaration.role == Role::Force { "force" } else { "momentum equation" };
        same(name, dot(&momentum, &point.direction), declared.momentum)?;
        let jacobian = evaluated(graph, &self.terms.jacobian, &point.sample.inputs());
        point.are_slopes("Newton Jacobian", &jacobian, &along, same)?;
        Ok(momentum)
    }

    /// Compares the stages of the step, evaluated in a stepper's order.
    fn step_holds<T: Number>(
        &self,
        point: &Point<T>,
        momentum: &[T],
        declared: &DeclaredValues<T>,
        same: &mut Same<T>,
    ) -> Result<(), Objection> {
        let (sample, kernel) = (point.sample, self.kernel);
        // The solve finds `F` in `U(F) = a` with `a = μ + k₀`, which mustn't depend on `F`.
        if kernel.kick_before.iter().any(|&kick| kernel.graph.stage(kick) > Stage::Step) {
            return Err(Objection::Disagrees("kick before the solve"));
        }
        let (dimension, group) = (momentum.len(), &self.of.derived.group);
        let Element { matrices, inverses, coordinates } = &sample.element;
        let inputs = self.inputs_of_stages(sample, [&point.target, &point.direction]);
        let [kick, iteration] = self.called(&inputs);
        let (before, after) = (kick(&kernel.kick_before), kick(&kernel.kick_after));
        let change = kernel.kick_derivative.as_ref().map_or_else(Vec::new, |change| kick(change));
        let jacobian = iteration(&self.stages.system[dimension..]);
        let a: Vec<T> = momentum.iter().zip(before).map(|(&momentum, kick)| momentum + kick).collect();
        // The residual is (h/2) (1 + |y|²)ⁿ (U − a), whose factor is positive.
        let square = dot(coordinates, coordinates);
        let half = sample.values.get(&Name::Step).map_or(T::UNDEFINED, Value::first) * T::of(Rational::new(1, 2));
        let factor = (0..kernel.denominators).fold(half, |factor, _| factor * (T::ONE + square));
        let residual = self.called(&self.displaced(point))[1](&self.stages.system[..dimension]);
        for (k, found) in residual.iter().enumerate() {
            same("Newton residual", found.value, factor * (a[k] - point.target[k]))?;
        }
        point.are_slopes("Newton Jacobian of the step", &jacobian, &residual, same)?;
        // μ⁺ = Ad*_F a + k₁⁺.
        let turned = components_of(group, &products(&products(matrices, &point.element), inverses));
        let after = dot(&after, &point.direction);
        same("transported momentum", dot(&a, &turned) + after, declared.left)?;
        if !change.is_empty() {
            let [forwards, backwards] = &point.exponentials;
            let (dual, values) = (&point.dual, point.dual.moved([backwards, forwards]));
            let kick = evaluated(&kernel.graph, &kernel.kick_before, &dual.inputs_at(&dual.element, &values));
            for (&found, expected) in change.iter().zip(kick) {
                same("derivative of the kick", found, expected.slope)?;
            }
        }
        Ok(())
    }

    /// A kick and an iteration as a stepper calls them: with their own arguments, and the values that the stages before
    /// them pass on.
    fn called<T: Number>(&self, inputs: &Inputs<T>) -> [impl Fn(&[NodeId]) -> Vec<T>; 2] {
        let (graph, Stages { constants, terms, .. }) = (&self.kernel.graph, &self.stages);
        let of = |is_meant: fn(Stage) -> bool| -> Inputs<T> {
            let own = inputs.iter().filter(|(id, _)| is_meant(self.of.derived.symbols.get(**id).stage));
            own.map(|(id, value)| (*id, value.clone())).collect()
        };
        let numbers = |handed: &Handover, inputs: Inputs<T>, given: &BTreeMap<NodeId, T>| -> BTreeMap<NodeId, T> {
            let nodes: Vec<NodeId> = handed.keys().copied().collect();
            let numbers = evaluated_from(graph, &nodes, &inputs, given);
            handed.iter().map(|(&id, &place)| (id, numbers[place])).collect()
        };
        let constants = numbers(constants, of(|stage| stage == Stage::Construction), &BTreeMap::new());
        let mut terms = numbers(terms, of(|stage| stage == Stage::Step), &constants);
        terms.extend(&constants);
        [(of(|stage| stage > Stage::Construction), constants), (of(|stage| stage == Stage::Iteration), terms)]
            .map(|(inputs, given)| move |outputs: &[NodeId]| evaluated_from(graph, outputs, &inputs, &given))
    }

    /// The inputs of all stages: the sample, the moved parameters, a random covector and a velocity.
    pub fn inputs_of_stages<T: Number>(&self, sample: &Sample<T>, [target, along]: [&[T]; 2]) -> Inputs<T> {
        let (mut inputs, directions) = (sample.inputs(), &self.of.derived.directions);
        let carried = sample.moved([&sample.element.inverses, &sample.element.matrices]);
        for (index, &next) in directions.next.iter().enumerate() {
            inputs.extend(carried.get(&Name::Advected(index)).map(|w| (next, w.clone())));
        }
        inputs.extend([(directions.target, Value::column(target)), (directions.along, Value::column(along))]);
        inputs
    }

    /// A displacement in the coordinates of the Newton system: `y + ε v` or `exp(ε v̂) F`.
    fn displaced<T: Number>(&self, point: &Point<T>) -> Inputs<Dual<T>> {
        let (dual, directions) = (&point.dual, &self.of.derived.directions);
        let mut inputs = if self.kernel.in_increment {
            dual.inputs_at(&point.turned, &dual.values)
        } else {
            let mut inputs = dual.inputs();
            let along = point.sample.element.coordinates.iter().zip(&point.direction);
            let along: Vec<Dual<T>> = along.map(|(&value, &slope)| Dual { value, slope }).collect();
            inputs.insert(directions.coordinates, Value::column(&along));
            inputs
        };
        inputs.insert(directions.target, Value::column(&point.target).over(Dual::constant));
        inputs
    }

    /// Compares the derivatives of the momenta at both ends, along a left variation of the increment, along
    /// `δw = −v̂·w`, and along a random change of all numbers; and the gradient of a kick, along the last two.
    fn derivatives_hold<T: Number>(
        &self,
        point: &Point<T>,
        momentum: &[T],
        declared: &DeclaredValues<T>,
        number: &mut impl FnMut() -> T,
        same: &mut Same<T>,
    ) -> Result<(), Objection> {
        let Some(all) = &self.derivatives else { return Ok(()) };
        let (dual, direction, [u, p], [forwards, backwards]) =
            (&point.dual, &point.direction, &point.weights, &point.exponentials);
        let plain = self.inputs_of_stages(point.sample, [u, p]);
        let values = |outputs: &[NodeId]| evaluated(&all.graph, outputs, &plain);
        let momenta = values(&all.momenta);
        let (start, end) = momenta.split_at(u.len());
        same("momentum to be differentiated", dot(start, direction), dot(momentum, direction))?;
        same("momentum to be differentiated", dot(end, direction), declared.left)?;

        let (varied, changes) = self.varied(dual, number);
        let seen = dual.moved([backwards, forwards]);
        let [seen, varied] = [seen, varied].map(|values| dual.inputs_at(&dual.element, &values));
        let [turned, seen_slopes, varied_slopes] = [&dual.inputs_at(&point.turned, &dual.values), &seen, &varied]
            .map(|inputs| slopes(evaluated(&all.graph, &all.momenta, inputs)));
        for (blocks, slopes) in all.blocks.iter().zip([&turned, &seen_slopes]) {
            for (row, &slope) in values(&blocks.concat()).chunks(u.len()).zip(slopes) {
                same("derivative of a step", dot(row, direction), slope)?;
            }
        }
        let found = changes.along(&all.by_numbers, momenta.len(), values);
        found
            .into_iter()
            .zip(&varied_slopes)
            .try_for_each(|(found, &slope)| same("derivative by the parameters", found, slope))?;
        same("adjoint of a step", dot(&values(&all.by_turn), direction), dot(p, &turned[u.len()..]))?;
        let mut gradient_holds =
            |name, gradient: &WeightedGradient, inputs: &Inputs<T>, [by_place, by_numbers]: [T; 2]| {
                let values = |outputs: &[NodeId]| evaluated(&all.graph, outputs, inputs);
                same(name, dot(&values(&gradient.by_place), direction), by_place)?;
                same(name, changes.along(&gradient.by_numbers, 1, values)[0], by_numbers)
            };
        let adjoint =
            [seen_slopes, varied_slopes].map(|slopes| dot(p, &slopes[u.len()..]) - dot(u, &slopes[..u.len()]));
        gradient_holds("gradient of a step", &all.gradient, &plain, adjoint)?;
        let (Some(of_kick), Some(limit)) = (&all.of_kick, &self.limit) else { return Ok(()) };
        // ⟨u, D_v k⟩ + ⟨r, k − J u⟩ consists of terms already compared.
        let (r, directions) = (&point.target, &self.of.derived.directions);
        let mut inputs = plain.clone();
        inputs.insert(directions.coordinates, Value::column(r));
        let kick = [seen, varied].map(|mut inputs| {
            inputs.insert(directions.along, Value::column(p).over(Dual::constant));
            let of = |graph: &Graph, outputs: &[NodeId]| slopes(evaluated(graph, outputs, &inputs));
            let (graph, change) = (&self.kernel.graph, self.kernel.kick_derivative.as_deref().unwrap_or_default());
            let inertia = of(&limit.0, &limit.1[0]);
            let inertia: Vec<T> = inertia.chunks(u.len()).map(|row| dot(row, u)).collect();
            dot(u, &of(graph, change)) + dot(r, &of(graph, &self.kernel.kick_before)) - dot(r, &inertia)
        });
        gradient_holds("gradient of a kick", of_kick, &inputs, kick)
    }

    /// A random change of all numbers that a step is differentiated by, within their kinds.
    fn varied<T: Number>(
        &self,
        dual: &Sample<Dual<T>>,
        number: &mut impl FnMut() -> T,
    ) -> (Values<Dual<T>>, Changes<T>) {
        let mut varied = dual.values.clone();
        let changes = variables(self.of.declaration).map(|each| {
            let change = |(name, kind)| {
                let (rows, columns) = shape(kind);
                let any = Value { rows, columns, entries: (0..rows * columns).map(|_| number()).collect() };
                let change = match kind {
                    FieldKind::SymmetricInertia | FieldKind::StandardInertia => any.plus(&any.transpose()),
                    FieldKind::DiagonalInertia => Value::diagonal(rows, |k| any.at(k, k)),
                    _ => any,
                };
                let entries = varied.get_mut(&name).into_iter().flat_map(|value| &mut value.entries);
                entries.zip(&change.entries).for_each(|(entry, &change)| entry.slope = change);
                change.entries
            };
            each.into_iter().flat_map(change).collect()
        });
        (varied, Changes(changes))
    }
}

fn slopes<T>(values: Vec<Dual<T>>) -> Vec<T> {
    values.into_iter().map(|one| one.slope).collect()
}

/// The changes of the numbers of the parameters, and of the advected parameters.
struct Changes<T>([Vec<T>; 2]);

impl<T: Number> Changes<T> {
    /// The changes of `outputs` values, by their derivatives.
    fn along(&self, by: &ByNumbers, outputs: usize, values: impl Fn(&[NodeId]) -> Vec<T>) -> Vec<T> {
        let nodes: Vec<NodeId> = by.iter().flatten().flat_map(|(_, nodes)| nodes).copied().collect();
        let changes = by.iter().zip(&self.0).flat_map(|(by, all)| by.iter().map(|(number, _)| all[*number]));
        let (values, mut sums) = (values(&nodes), vec![T::ZERO; outputs]);
        for (change, derivatives) in changes.zip(values.chunks(outputs)) {
            sums.iter_mut().zip(derivatives).for_each(|(sum, &one)| *sum = *sum + change * one);
        }
        sums
    }
}
