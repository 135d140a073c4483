//! The continuous equations at random points of a finite field, where nothing is rounded.
//!
//! Derivatives of the Lagrangian are those of dual numbers, so that the symbolic rules are compared with others: along a
//! change of the velocity, and along a random `η` by which all that is advected is carried.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::degree::{self, Content, Degree};
use super::dual::Dual;
use super::evaluation::Evaluation;
use super::exact::{POINTS, certified, same};
use super::identities::Same;
use super::inertia::{KineticPart, classified};
use super::linear::Subspace;
use super::number::Number;
use super::residue::Residue;
use super::sample::{advected, exponentials, moved};
use super::series::Series;
use super::value::Value;
use super::{
    Fault, SAMPLES, Sureness, Unconfirmed, Values, block, by_blocks, components_of, dot, evaluated, exponential,
    increments, parameter, parameters, stream, velocities,
};
use crate::declared::{Declaration, FieldKind, Name, Tree};
use crate::mathematics::derive::{Continuous, Derived};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Rational, SymbolId};
use crate::program::{Graph, NodeId, along_directions, diamond_matrices, limit};

/// The derived terms as operations.
struct Terms {
    graph: Graph,
    lagrangian: NodeId,
    momentum: Vec<NodeId>,
    hessian: Vec<NodeId>,
    diamond: Vec<NodeId>,
    /// Of each factor of the group.
    diamond_matrices: Vec<Vec<NodeId>>,
    advection: Vec<NodeId>,
}

impl Terms {
    fn new(derived: &Continuous) -> Self {
        let mut graph = Graph::default();
        let [lagrangian, momentum, hessian, diamond, advection] = [
            (0, &derived.lagrangian),
            (1, &derived.momentum),
            (2, &derived.hessian),
            (1, &derived.diamond),
            (1, &derived.advection),
        ]
        .map(|(rank, expression)| along_directions(&mut graph, derived, rank, expression));
        let lagrangian = lagrangian.first().copied().unwrap_or_else(|| graph.zero());
        let diamond_matrices = diamond_matrices(&mut graph, derived);
        Self { graph, lagrangian, momentum, hessian, diamond, diamond_matrices, advection }
    }

    fn values<T: Number>(&self, outputs: &[NodeId], names: &BTreeMap<Name, SymbolId>, at: &Values<T>) -> Vec<T> {
        evaluated(&self.graph, outputs, &inputs(names, at))
    }
}

/// The values of symbols.
fn inputs<T: Number>(names: &BTreeMap<Name, SymbolId>, at: &Values<T>) -> BTreeMap<SymbolId, Value<T>> {
    names.iter().filter_map(|(name, symbol)| Some((*symbol, at.get(name)?.clone()))).collect()
}

/// A point with its kinds of parameters.
struct Point<'a, T> {
    declaration: &'a Declaration,
    values: Values<T>,
}

impl<'a, T: Number> Point<'a, T> {
    fn new(declaration: &'a Declaration, mut number: impl FnMut() -> T) -> Self {
        let mut point = Self { declaration, values: parameters(declaration, &mut number) };
        let velocity = parameter(FieldKind::Vector(declaration.group.dimension()), &mut number);
        point.set_velocity(&velocity.entries);
        point
    }

    fn set_velocity(&mut self, components: &[T]) {
        self.values.extend(velocities(&self.declaration.group, components));
    }

    fn group(&self) -> &Group {
        &self.declaration.group
    }

    fn velocity(&self) -> Vec<T> {
        velocity(self.group(), &self.values)
    }

    /// As dual numbers, whose velocity changes along `η`.
    fn along_velocity(&self, eta: &[T]) -> Values<Dual<T>> {
        let mut values = self.lifted();
        let components = self.velocity().into_iter().zip(eta);
        let varied: Vec<Dual<T>> = components.map(|(value, &slope)| Dual { value, slope }).collect();
        values.extend(velocities(self.group(), &varied));
        values
    }

    /// As dual numbers, whose advected parameters change as a matrix carries them.
    fn carried_by(&self, element: &Value<T>) -> Values<Dual<T>> {
        let ([forwards, backwards], advected) = (exponentials(element), advected(self.declaration));
        let mut values = moved(self.group(), &advected, &self.lifted(), [&forwards, &backwards]);
        // The last coordinate of a point stays one.
        for index in (0..advected.len()).filter(|&w| matches!(self.declaration.advected_kind(w), FieldKind::Point(_))) {
            if let Some(last) = values.get_mut(&Name::Advected(index)).and_then(|w| w.entries.last_mut()) {
                last.slope = T::ZERO;
            }
        }
        values
    }

    fn lifted(&self) -> Values<Dual<T>> {
        self.in_numbers(Dual::constant)
    }

    /// In other numbers.
    fn in_numbers<U: Number>(&self, of: impl Fn(T) -> U) -> Values<U> {
        self.values.iter().map(|(name, value)| (*name, value.over(&of))).collect()
    }
}

impl<'a> Point<'a, Degree> {
    /// Attitudes are Cayley transforms.
    fn of_degrees(declaration: &'a Declaration) -> Self {
        let mut number = Degree::stream();
        let mut point = Self::new(declaration, &mut number);
        let transforms = u64::try_from(degree::attitudes(declaration).count()).unwrap_or(u64::MAX / 2);
        degree::set_attitudes(declaration, &mut point.values, 2 * transforms, &mut number);
        point
    }
}

impl Point<'_, Residue> {
    /// As power series in `h`, along `F = exp(h ξ̂)`.
    fn moving(&self) -> Values<Series> {
        let mut values = self.in_numbers(Series::constant);
        let step = element(self.group(), &velocity(self.group(), &values)).map(|entry| entry * Series::STEP);
        values.extend(increments(self.group(), &exponential(self.group(), &step)));
        values.insert(Name::Step, Value::scalar(Series::STEP));
        values
    }
}

fn element<T: Number>(group: &Group, xi: &[T]) -> Value<T> {
    Value::combination(group.size, &group.generators, xi)
}

/// The components of all velocities.
fn velocity<T: Number>(group: &Group, values: &Values<T>) -> Vec<T> {
    let of_factor =
        |factor| values.get(&Name::Velocity(factor)).map_or(&[][..], |velocity| velocity.entries.as_slice());
    (0..group.factors().len()).flat_map(of_factor).copied().collect()
}

/// `⟨ad*_ξ μ, E_k⟩ = ⟨μ, [ξ, E_k]⟩` for all `k`.
fn coadjoint<T: Number>(group: &Group, xi: &[T], momentum: &[T]) -> Vec<T> {
    let xi = element(group, xi);
    let generators = group.generators.iter().map(|entries| Value::square(group.size, entries));
    let brackets: Vec<Value<T>> = generators.map(|e| xi.times(&e).zip(&e.times(&xi), |x, y| x - y)).collect();
    components_of(group, &brackets).iter().map(|components| dot(components, momentum)).collect()
}

/// How sure it is that all equations hold; `tree` is the declared `l`, where it is one.
pub(crate) fn equations_hold(
    declaration: &Declaration,
    tree: Option<&Rc<Tree>>,
    names: &BTreeMap<Name, SymbolId>,
    derived: &Continuous,
) -> Result<Sureness, Unconfirmed> {
    let terms = Terms::new(derived);
    let of = (tree, names, &terms);
    certified(
        tree.map_or_else(Content::default, Content::of_tree) + Content::of_graph(&terms.graph),
        |same| hold_at(&Point::of_degrees(declaration), Degree::stream(), of, same),
        |seed| {
            let mut number = Residue::stream(seed);
            hold_at(&Point::new(declaration, &mut number), number, of, &mut same)
        },
    )
}

/// Along a direction of these numbers.
fn hold_at<T: Number>(
    point: &Point<T>,
    mut number: impl FnMut() -> T,
    (tree, names, terms): (Option<&Rc<Tree>>, &BTreeMap<Name, SymbolId>, &Terms),
    same: &mut Same<T>,
) -> Result<(), Fault> {
    let slope = |values: &Values<Dual<T>>| match tree {
        Some(tree) => Evaluation::new(values).of(tree).first().slope,
        None => terms.values(&[terms.lagrangian], names, values).first().map_or(T::UNDEFINED, |l| l.slope),
    };
    let group = point.group();
    let eta: Vec<T> = group.generators.iter().map(|_| number()).collect();
    let at = |outputs: &[NodeId]| terms.values(outputs, names, &point.values);
    let varied = point.along_velocity(&eta);
    same("momentum ∂l/∂ξ", dot(&at(&terms.momentum), &eta), slope(&varied))?;
    let change = terms.values(&terms.momentum, names, &varied);
    for (row, momentum) in at(&terms.hessian).chunks(eta.len()).zip(change) {
        same("inertia ∂²l/∂ξ²", dot(row, &eta), momentum.slope)?;
    }
    let carried = point.carried_by(&element(group, &eta));
    same("diamond term ∂l/∂w ⋄ w", dot(&at(&terms.diamond), &eta), -slope(&carried))?;
    // The diamond as a matrix, on the group; and where it is meant along all matrices: not of an attitude that is seen, of
    // which `RᵀR = I` may have been used.
    let is_general = degree::attitudes(point.declaration).next().is_none();
    let any = by_blocks(group, |factor| parameter(FieldKind::Matrix(group.factor(factor).size), &mut number));
    let along = |along: &Value<T>| {
        let of_factor =
            |(factor, entries): (usize, &Vec<NodeId>)| dot(&at(entries), &block(group, along, factor).entries);
        terms.diamond_matrices.iter().enumerate().map(of_factor).fold(T::ZERO, |sum, one| sum + one)
    };
    same("diamond along all matrices", along(&element(group, &eta)), -slope(&carried))?;
    if is_general {
        same("diamond along all matrices", along(&any), -slope(&point.carried_by(&any)))?;
    }
    let carried = point.carried_by(&element(group, &point.velocity()));
    let varied = terms.values(&terms.momentum, names, &carried);
    let mut pairs = at(&terms.advection).into_iter().zip(varied);
    pairs.try_for_each(|(found, varied)| same("change of the momentum with w", found, varied.slope))
}

/// How sure it is that `J`, `s` and `V` of the limit are what the derivatives of `l` are at rest.
pub(crate) fn rest_holds(
    declaration: &Declaration,
    (names, continuous): (&BTreeMap<Name, SymbolId>, &Continuous),
    (symbols, derived): (&BTreeMap<Name, SymbolId>, &Derived),
) -> Result<Sureness, Unconfirmed> {
    let (graph, limit) = limit(derived);
    let of = ((names, &Terms::new(continuous)), (symbols, &(&graph, limit.concat())));
    let content = Content::of_graph(&of.0.1.graph) + Content::of_graph(&graph);
    let degrees = |same: &mut Same<Degree>| hold_at_rest(Point::of_degrees(declaration), of, same);
    let point = |seed| hold_at_rest(Point::new(declaration, Residue::stream(seed)), of, &mut same);
    certified(content, degrees, point)
}

/// Terms with the symbols of their names.
type Named<'a, T> = (&'a BTreeMap<Name, SymbolId>, &'a T);

fn hold_at_rest<T: Number>(
    mut point: Point<T>,
    ((names, terms), (symbols, (graph, limit))): (Named<Terms>, Named<(&Graph, Vec<NodeId>)>),
    same: &mut Same<T>,
) -> Result<(), Fault> {
    point.set_velocity(&vec![T::ZERO; point.group().dimension()]);
    let outputs = [terms.hessian.as_slice(), &terms.momentum, &[terms.lagrangian]].concat();
    let mut here = terms.values(&outputs, names, &point.values);
    here.last_mut().into_iter().for_each(|l| *l = -*l);
    let mut pairs = here.into_iter().zip(evaluated(graph, limit, &inputs(symbols, &point.values)));
    pairs.try_for_each(|(here, there)| same("continuous limit", there, here))
}

/// A continuous Lagrangian.
#[derive(Clone, Copy)]
pub(crate) enum Lagrangian<'a> {
    Declared(&'a Rc<Tree>),
    Derived(&'a BTreeMap<Name, SymbolId>, &'a Continuous),
}

/// Whether the discrete Lagrangian is `h l(ξ, w) + O(h²)` along `F = exp(h ξ̂)`, at all points that tell; nothing where
/// none does. Of lower orders only what depends on the motion counts.
///
/// The field has roots of all numbers, so this says nothing of where `l` has a value.
pub(crate) fn has_limit(declaration: &Declaration, l: Lagrangian, discrete: &Rc<Tree>) -> Option<bool> {
    let rest = |values: &Values<Series>| {
        let l = match l {
            Lagrangian::Declared(tree) => Evaluation::new(values).of(tree).first(),
            Lagrangian::Derived(names, derived) => {
                let terms = Terms::new(derived);
                let value = terms.values(&[terms.lagrangian], names, values);
                value.first().copied().unwrap_or(Series::UNDEFINED)
            }
        };
        Evaluation::new(values).of(discrete).first() - Series::STEP * l
    };
    let told = (1..=u64::from(POINTS)).filter_map(|seed| {
        let values = Point::new(declaration, Residue::stream(seed)).moving();
        let mut elsewhere = Point::new(declaration, Residue::stream(seed + u64::from(POINTS))).moving();
        elsewhere
            .extend(values.iter().filter(|(name, _)| matches!(name, Name::Field(_))).map(|(n, v)| (*n, v.clone())));
        let here = rest(&values);
        let difference = here - rest(&elsewhere);
        if !difference.is_defined() {
            return None;
        }
        let is_right = difference.order().is_none_or(|order| order >= 2) && here.at(1) == Residue::ZERO;
        difference.is_known_below(2).then_some(is_right)
    });
    told.reduce(|all, one| all && one)
}

/// A basis of the directions `ζ` with `⟨μ̇, ζ⟩ = 0` for all values of the parameters: `⟨μ, ζ⟩` is conserved.
pub(crate) fn right_symmetries(
    declaration: &Declaration,
    names: &BTreeMap<Name, SymbolId>,
    derived: &Continuous,
) -> Vec<Vec<Rational>> {
    let (terms, dimension) = (Terms::new(derived), declaration.group.dimension());
    let mut rates = Subspace::default();
    for seed in 1..=2 * u64::try_from(dimension).unwrap_or(0) + 2 {
        let point = Point::new(declaration, Residue::stream(seed));
        let at = |outputs: &[NodeId]| terms.values(outputs, names, &point.values);
        let rate = coadjoint(point.group(), &point.velocity(), &at(&terms.momentum));
        let rate: Vec<Residue> = rate.iter().zip(at(&terms.diamond)).map(|(&x, y)| x + y).collect();
        if rate.iter().any(|entry| !entry.is_defined()) {
            return Vec::new();
        }
        rates.extend(rate);
    }
    rates
        .null_space(dimension)
        .into_iter()
        .filter_map(|vector| vector.into_iter().map(Residue::small).collect())
        .collect()
}

/// What sample values of the parameters show of the second derivative of a continuous Lagrangian, at rest.
pub(crate) fn kinetic_hessian(
    declaration: &Declaration,
    names: &BTreeMap<Name, SymbolId>,
    derived: &Continuous,
) -> KineticPart {
    let terms = Terms::new(derived);
    let exact = hessian_at_rest(Point::new(declaration, Residue::stream(1)), names, &terms);
    let samples = (1..=u64::try_from(SAMPLES).unwrap_or(1))
        .map(|seed| hessian_at_rest(Point::new(declaration, stream(seed)), names, &terms));
    let is_used = |name: Name| names.get(&name).is_some_and(|&id| derived.hessian.contains(id));
    classified(declaration, &is_used, samples.collect(), &exact)
}

fn hessian_at_rest<T: Number>(mut point: Point<T>, names: &BTreeMap<Name, SymbolId>, terms: &Terms) -> Value<T> {
    let dimension = point.group().dimension();
    point.set_velocity(&vec![T::ZERO; dimension]);
    Value { rows: dimension, columns: dimension, entries: terms.values(&terms.hessian, names, &point.values) }
}
