//! What has to hold of a derivation, in numbers of any kind.
//!
//! A covector is compared along one random direction `v` and a Jacobian times `v`: both are linear in it, so that an
//! identity in `v` is one of every component. First derivatives are those of dual numbers `x + ε x′`, in which
//! `(I + ε v̂) F` is an element of the group to the order that counts; second ones are those of what has been compared before.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::dual::Dual;
use super::evaluation::Evaluation;
use super::number::Number;
use super::sample::{Element, Sample, exponentials};
use super::value::Value;
use super::{Fault, Values, components_of, degree, dot, evaluated, evaluated_from, increments};
use crate::declared::{Declaration, Name, Role, Tree};
use crate::mathematics::derive::{Derived, Ends};
use crate::mathematics::symbolic::{Rational, Stage, SymbolId};
use crate::program::{
    Given, Graph, Handed, Input, Kernel, Linearisation, Node, NodeId, Scalariser, Stages, components, square, with_lets,
};

/// Values of symbols.
type Inputs<T> = BTreeMap<SymbolId, Value<T>>;

/// Compares what was found with what is expected, of a term.
pub(super) type Same<'a, T> = dyn FnMut(&'static str, T, T) -> Result<(), Fault> + 'a;

/// The derived terms as operations.
struct Terms {
    graph: Graph,
    momentum: Vec<NodeId>,
    jacobian: Vec<NodeId>,
    /// Of a Lagrangian alone.
    right: Vec<NodeId>,
    left: Vec<NodeId>,
    diamond: Vec<NodeId>,
    energy: Option<NodeId>,
}

impl Terms {
    fn new(derived: &Derived, role: Role) -> Self {
        let mut graph = Graph::default();
        let given = with_lets(&mut graph, derived, Given::new());
        let momentum = components(&mut graph, derived, &given, &derived.momentum);
        let jacobian = square(&mut graph, derived, &given, &derived.jacobian);
        let none = Self { momentum, jacobian, right: vec![], left: vec![], diamond: vec![], energy: None, graph };
        if role == Role::Force {
            return none;
        }
        let mut graph = none.graph;
        let [right, left, diamond] = [&derived.right_momentum, &derived.left_momentum, &derived.diamond]
            .map(|covector| components(&mut graph, derived, &given, covector));
        let energy = Scalariser { graph: &mut graph, symbols: &derived.symbols, given }.scalar(&derived.energy);
        Self { right, left, diamond, energy: Some(energy), graph, ..none }
    }
}

/// Of both momenta of a step, along some directions.
pub(super) struct Variation {
    /// The derivatives of `μ`, then of `μ⁺`, each along all directions.
    pub(super) rows: Vec<Vec<NodeId>>,
    /// Those of `⟨p, μ⁺⟩ − ⟨u, μ⟩`, of turns of `⟨p, μ⁺⟩`.
    pub(super) adjoint: Vec<NodeId>,
    /// What each of the two is called.
    names: [&'static str; 2],
}

/// The derivatives of the momenta at both ends of a step, where they are asked for.
pub(super) struct Derivatives {
    pub(super) graph: Graph,
    momenta: Vec<NodeId>,
    /// The scalars that the momenta have beside the increment.
    scalars: Vec<Input>,
    /// Along turns of the increment, along displacements of the body, and by each scalar.
    pub(super) variations: [Variation; 3],
}

impl Derivatives {
    fn new(derived: &Derived, ends: &Ends) -> Self {
        let mut linearisation = Linearisation::new(derived, ends);
        let momenta = linearisation.momenta().concat();
        let [_, by_turn] = linearisation.adjoint_system();
        let gradient = linearisation.adjoint_gradient();
        let adjoint = [by_turn, linearisation.by_place(&gradient)];
        let factors = &derived.directions.factors;
        let is_increment = |id: SymbolId| factors.iter().any(|one| [one.small, one.small_inverse].contains(&id));
        let inputs = linearisation.graph.reachable(&momenta).into_iter();
        let scalars: Vec<Input> = inputs
            .filter_map(|id| match linearisation.graph.node(id) {
                Node::Input(input) if !is_increment(input.symbol) => Some(input),
                _ => None,
            })
            .collect();
        let (mut columns, mut by_scalars) = (Vec::new(), Vec::new());
        for &Input { symbol, row, column } in &scalars {
            columns.push(linearisation.by_entry(symbol, row, column));
            by_scalars.push(linearisation.gradient_by_entry(&gradient, symbol, row, column));
        }
        let of = |rows: Vec<Vec<NodeId>>, adjoint, names| Variation { rows, adjoint, names };
        let rows = |[start, end]: &[Vec<NodeId>; 2]| {
            start.chunks(adjoint[0].len()).chain(end.chunks(adjoint[0].len())).map(<[NodeId]>::to_vec).collect()
        };
        let [turn, place] = linearisation.blocks().each_ref().map(rows);
        let by_scalar = (0..momenta.len()).map(|k| columns.iter().map(|by| by[k]).collect()).collect();
        let [of_turn, of_place] = adjoint;
        let names = ["derivative of a step", "adjoint of a step"];
        let by_scalar = of(by_scalar, by_scalars, ["derivative by the parameters", "gradient of a step"]);
        let variations = [of(turn, of_turn, names), of(place, of_place, names), by_scalar];
        Self { graph: linearisation.graph, momenta, scalars, variations }
    }
}

/// A declaration with all that was derived of it.
pub(super) struct Identities<'a> {
    role: Role,
    tree: &'a Rc<Tree>,
    pub(super) derived: &'a Derived,
    kernel: &'a Kernel,
    pub(super) stages: Stages,
    terms: Terms,
    pub(super) derivatives: Option<Derivatives>,
}

/// One point with one direction.
struct Point<'a, T> {
    sample: &'a Sample<'a, T>,
    dual: Sample<'a, Dual<T>>,
    /// `v`, `v̂` and `exp(±ε v̂)`.
    direction: Vec<T>,
    element: Value<T>,
    exponentials: [Value<Dual<T>>; 2],
    turned: Element<Dual<T>>,
    /// Another covector than that of the solution.
    target: Vec<T>,
    /// Weights of the momenta at both ends, `u` and `p`.
    weights: [Vec<T>; 2],
}

impl<T: Number> Point<'_, T> {
    /// Whether the rows of a matrix, along the direction, are these slopes.
    fn are_slopes(&self, term: &'static str, matrix: &[T], along: &[Dual<T>], same: &mut Same<T>) -> Result<(), Fault> {
        let mut rows = matrix.chunks(along.len()).zip(along);
        rows.try_for_each(|(row, one)| same(term, dot(row, &self.direction), one.slope))
    }
}

/// What a step has been handed, and the arguments of a kick and of an iteration.
struct Called<'a, T> {
    graph: &'a Graph,
    constants: BTreeMap<NodeId, T>,
    terms: BTreeMap<NodeId, T>,
    inputs: [Inputs<T>; 2],
}

impl<T: Number> Called<'_, T> {
    fn kick(&self, outputs: &[NodeId]) -> Vec<T> {
        evaluated_from(self.graph, outputs, &self.inputs[0], &self.constants)
    }

    fn iteration(&self, outputs: &[NodeId]) -> Vec<T> {
        evaluated_from(self.graph, outputs, &self.inputs[1], &self.terms)
    }
}

/// Along the direction of a point, what the declaration says.
struct Declared<T> {
    momentum: T,
    /// At the end of the step.
    left: T,
}

impl<'a> Identities<'a> {
    pub(super) fn new(
        declaration: &Declaration,
        tree: &'a Rc<Tree>,
        (derived, kernel): (&'a Derived, &'a Kernel),
    ) -> Self {
        let derivatives = derived.ends.as_ref().map(|ends| Derivatives::new(derived, ends));
        let (role, terms) = (declaration.role, Terms::new(derived, declaration.role));
        Self { role, tree, derived, kernel, stages: kernel.stages(), terms, derivatives }
    }

    /// How many functions are called, in the declaration and in what was derived.
    pub(super) fn functions(&self) -> u64 {
        let derivatives = self.derivatives.as_ref().map_or(0, |derivatives| degree::calls(&derivatives.graph));
        degree::functions(self.tree)
            + degree::calls(&self.terms.graph)
            + degree::calls(&self.kernel.graph)
            + derivatives
    }

    /// Whether the momentum and its Jacobian have values where a step begins.
    pub(super) fn are_smooth_at_identity<T: Number>(&self, sample: &Sample<T>) -> bool {
        let inputs = sample.inputs_at(&Element::identity(&self.derived.group), &sample.values);
        let outputs = [self.terms.momentum.as_slice(), &self.terms.jacobian].concat();
        evaluated(&self.terms.graph, &outputs, &inputs).into_iter().all(T::is_defined)
    }

    /// Compares everything at one point, along a direction of these numbers.
    pub(super) fn hold<T: Number>(
        &self,
        sample: &Sample<T>,
        mut number: impl FnMut() -> T,
        same: &mut Same<T>,
    ) -> Result<(), Fault> {
        let group = &self.derived.group;
        let mut vector = || group.generators.iter().map(|_| number()).collect::<Vec<T>>();
        let (direction, target, weights) = (vector(), vector(), [vector(), vector()]);
        let element = Value::combination(group.size, &group.generators, &direction);
        let exponentials = exponentials(&element);
        let turned = sample.element.turned(&exponentials);
        let point = Point { sample, dual: sample.lifted(), direction, element, exponentials, turned, target, weights };
        let declared = match self.role {
            Role::Force => self.declared_work(&point, same)?,
            _ => self.lagrangian_holds(&point, same)?,
        };
        let momentum = self.momentum_holds(&point, &declared, same)?;
        self.step_holds(&point, &momentum, &declared, same)?;
        self.derivatives_hold(&point, &momentum, &declared, &mut number, same)
    }

    fn at<T: Number>(&self, values: &Values<T>) -> T {
        Evaluation::new(values).of(self.tree).first()
    }

    /// The declared work along the direction, of displacements at either end alone, which is that of both.
    fn declared_work<T: Number>(&self, point: &Point<T>, same: &mut Same<T>) -> Result<Declared<T>, Fault> {
        let group = &self.derived.group;
        let work = |before: T, after: T| {
            let mut values = point.sample.values.clone();
            for (factor, own) in group.factors().iter().enumerate() {
                let first = group.component_of(factor);
                let along = Value::column(&point.direction[first..first + own.dimension()]);
                let [before, after] = [before, after].map(|share| along.map(|x| share * x));
                values.extend([(Name::DisplacementBefore(factor), before), (Name::DisplacementAfter(factor), after)]);
            }
            self.at(&values)
        };
        let (before, after) = (work(T::ONE, T::ZERO), work(T::ZERO, T::ONE));
        same("force of both displacements", work(T::ONE, T::ONE), before + after)?;
        Ok(Declared { momentum: -before, left: after })
    }

    /// Both momentum maps, the diamond and the energy are derivatives of the declared Lagrangian.
    fn lagrangian_holds<T: Number>(&self, point: &Point<T>, same: &mut Same<T>) -> Result<Declared<T>, Fault> {
        let (group, dual) = (&self.derived.group, &point.dual);
        let [forwards, backwards] = &point.exponentials;
        let at_increment = |f: &Value<Dual<T>>| {
            let mut values = dual.values.clone();
            values.extend(increments(group, f));
            self.at(&values).slope
        };
        let right = at_increment(&point.turned.matrix);
        let left = at_increment(&dual.element.matrix.times(forwards));
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
        Ok(Declared { momentum: right + carried, left })
    }

    /// The momentum is what the declaration says, and the Jacobian its derivative; returns the momentum.
    fn momentum_holds<T: Number>(
        &self,
        point: &Point<T>,
        declared: &Declared<T>,
        same: &mut Same<T>,
    ) -> Result<Vec<T>, Fault> {
        let (graph, dual) = (&self.terms.graph, &point.dual);
        let along = evaluated(graph, &self.terms.momentum, &dual.inputs_at(&point.turned, &dual.values));
        let momentum: Vec<T> = along.iter().map(|one| one.value).collect();
        let name = if self.role == Role::Force { "force" } else { "momentum equation" };
        same(name, dot(&momentum, &point.direction), declared.momentum)?;
        let jacobian = evaluated(graph, &self.terms.jacobian, &point.sample.inputs());
        point.are_slopes("Newton Jacobian", &jacobian, &along, same)?;
        Ok(momentum)
    }

    /// The stages of the step, as a stepper calls them.
    fn step_holds<T: Number>(
        &self,
        point: &Point<T>,
        momentum: &[T],
        declared: &Declared<T>,
        same: &mut Same<T>,
    ) -> Result<(), Fault> {
        let (sample, kernel) = (point.sample, self.kernel);
        // The solve is for `F` in `U(F) = a` with `a = μ + k₀`, which mustn't have it.
        if kernel.kick_before.iter().any(|&kick| kernel.graph.stage(kick) > Stage::Step) {
            return Err(Fault::Disagrees("kick before the solve"));
        }
        let (dimension, group) = (momentum.len(), &self.derived.group);
        let Element { matrix, inverse, coordinates } = &sample.element;
        let inputs = self.inputs_of_stages(sample, [&point.target, &point.direction]);
        let called = self.called(&inputs);
        let (before, after) = (called.kick(&kernel.kick_before), called.kick(&kernel.kick_after));
        let change = kernel.kick_derivative.as_ref().map_or_else(Vec::new, |change| called.kick(change));
        let jacobian = called.iteration(&self.stages.system[dimension..]);
        // Emitted with the residual alone, where there is one.
        let moved = if kernel.jacobian_is_expensive() {
            called.iteration(&kernel.moved)
        } else {
            evaluated(&kernel.graph, &kernel.moved, &inputs)
        };
        let a: Vec<T> = momentum.iter().zip(before).map(|(&momentum, kick)| momentum + kick).collect();
        // (h/2) (1 + |y|²)ⁿ (U − a), whose factor is positive.
        let square = dot(coordinates, coordinates);
        let half = sample.values.get(&Name::Step).map_or(T::UNDEFINED, Value::first) * T::of(Rational::new(1, 2));
        let factor = (0..kernel.denominators).fold(half, |factor, _| factor * (T::ONE + square));
        let residual = self.called(&self.displaced(point)).iteration(&self.stages.system[..dimension]);
        for (k, found) in residual.iter().enumerate() {
            same("Newton residual", found.value, factor * (a[k] - point.target[k]))?;
        }
        point.are_slopes("Newton Jacobian of the step", &jacobian, &residual, same)?;
        // μ⁺ = Ad*_F a + k₁⁺, and what the gradient gives beside the residual is k₁⁺ before Ad*_F.
        let turned = components_of(group, &[matrix.times(&point.element).times(inverse)]).concat();
        let after = dot(&after, &point.direction);
        same("transported momentum", dot(&a, &turned) + after, declared.left)?;
        if !moved.is_empty() {
            same("transported momentum", dot(&moved, &turned), after)?;
        }
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

    /// The stages as a stepper calls them: each has its own arguments, and of all else what those before it hand on.
    fn called<T: Number>(&self, inputs: &Inputs<T>) -> Called<'_, T> {
        let (graph, Stages { constants, terms, .. }) = (&self.kernel.graph, &self.stages);
        let of = |is_meant: fn(Stage) -> bool| -> Inputs<T> {
            let own = inputs.iter().filter(|(id, _)| is_meant(self.derived.symbols.get(**id).stage));
            own.map(|(id, value)| (*id, value.clone())).collect()
        };
        let numbers = |handed: &Handed, inputs: Inputs<T>, given: &BTreeMap<NodeId, T>| -> BTreeMap<NodeId, T> {
            let nodes: Vec<NodeId> = handed.keys().copied().collect();
            let numbers = evaluated_from(graph, &nodes, &inputs, given);
            handed.iter().map(|(&id, &place)| (id, numbers[place])).collect()
        };
        let constants = numbers(constants, of(|stage| stage == Stage::Construction), &BTreeMap::new());
        let mut terms = numbers(terms, of(|stage| stage == Stage::Step), &constants);
        terms.extend(&constants);
        let inputs = [of(|stage| stage > Stage::Construction), of(|stage| stage == Stage::Iteration)];
        Called { graph, constants, terms, inputs }
    }

    /// With what is carried along, a covector for that of the solution and a velocity.
    fn inputs_of_stages<T: Number>(&self, sample: &Sample<T>, [target, along]: [&[T]; 2]) -> Inputs<T> {
        let (mut inputs, directions) = (sample.inputs(), &self.derived.directions);
        let carried = sample.moved([&sample.element.inverse, &sample.element.matrix]);
        for ((name, ..), &next) in sample.advected.iter().zip(&directions.next) {
            inputs.extend(carried.get(name).map(|w| (next, w.clone())));
        }
        inputs.extend([(directions.target, Value::column(target)), (directions.along, Value::column(along))]);
        inputs
    }

    /// In the coordinates of the Newton system: `y + ε v` or `exp(ε v̂) F`.
    fn displaced<T: Number>(&self, point: &Point<T>) -> Inputs<Dual<T>> {
        let (dual, directions) = (&point.dual, &self.derived.directions);
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

    /// The momenta at both ends with their derivatives, along a turn of the increment, along `δw = −v̂·w`, and along a random
    /// change of all parameters, with what is advected and `h`.
    fn derivatives_hold<T: Number>(
        &self,
        point: &Point<T>,
        momentum: &[T],
        declared: &Declared<T>,
        number: &mut impl FnMut() -> T,
        same: &mut Same<T>,
    ) -> Result<(), Fault> {
        let Some(Derivatives { graph, momenta, scalars, variations }) = &self.derivatives else { return Ok(()) };
        let (dual, [forwards, backwards]) = (&point.dual, &point.exponentials);
        let seen = dual.inputs_at(&dual.element, &dual.moved([backwards, forwards]));
        let turned = dual.inputs_at(&point.turned, &dual.values);
        let (mut varied, changes) = (dual.inputs(), scalars.iter().map(|_| number()).collect::<Vec<T>>());
        for (&change, Input { symbol, row, column }) in changes.iter().zip(scalars) {
            if let Some(value) = varied.get_mut(symbol) {
                value.entries[row * value.columns + column].slope = change;
            }
        }
        let [u, p] = &point.weights;
        let plain = self.inputs_of_stages(point.sample, [u, p]);
        let values = evaluated(graph, momenta, &plain);
        let (start, end) = values.split_at(u.len());
        let name = "momentum to be differentiated";
        same(name, dot(start, &point.direction), dot(momentum, &point.direction))?;
        same(name, dot(end, &point.direction), declared.left)?;
        let along = [(turned, &point.direction), (seen, &point.direction), (varied, &changes)];
        for (at, (Variation { rows, adjoint, names }, (inputs, along))) in variations.iter().zip(along).enumerate() {
            let slopes: Vec<T> = evaluated(graph, momenta, &inputs).iter().map(|one| one.slope).collect();
            let (start, end) = slopes.split_at(u.len());
            let of_start = if at == 0 { T::ZERO } else { dot(u, start) };
            same(names[1], dot(&evaluated(graph, adjoint, &plain), along), dot(p, end) - of_start)?;
            let found = evaluated(graph, &rows.concat(), &plain);
            for (row, &slope) in found.chunks(along.len().max(1)).zip(&slopes) {
                same(names[0], dot(row, along), slope)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
impl Identities<'_> {
    /// All that is emitted, at a point.
    pub(super) fn emitted<T: Number>(&self, sample: &Sample<T>, mut number: impl FnMut() -> T) -> Vec<T> {
        let mut vector = || self.derived.group.generators.iter().map(|_| number()).collect::<Vec<T>>();
        let inputs = self.inputs_of_stages(sample, [&vector(), &vector()]);
        let Terms { graph, momentum, jacobian, right, left, diamond, energy } = &self.terms;
        let terms = [momentum.as_slice(), jacobian, right, left, diamond, energy.as_slice()].concat();
        let kernel = self.kernel;
        let stages = [&kernel.kick_before, &kernel.residual, &kernel.jacobian, &kernel.kick_after, &kernel.moved];
        let change = kernel.kick_derivative.clone().unwrap_or_default();
        let stages = stages.into_iter().chain([&change]).flatten().copied().collect::<Vec<_>>();
        let mut all = [evaluated(graph, &terms, &inputs), evaluated(&kernel.graph, &stages, &inputs)].concat();
        if let Some(Derivatives { graph, variations, momenta, .. }) = &self.derivatives {
            let rows = variations[..2].iter().flat_map(|one| one.rows.concat());
            all.extend(evaluated(graph, &rows.chain(momenta.iter().copied()).collect::<Vec<_>>(), &inputs));
        }
        all
    }
}
