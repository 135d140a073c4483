//! The continuous equations at random points of a finite field, where nothing is rounded.
//!
//! Derivatives of the Lagrangian are those of dual numbers, so that the symbolic rules are compared with others. With
//! `h(μ, w) = ⟨μ, ξ⟩ − l(ξ, w)`, two identities hold whatever the Lagrangian is: `∂h/∂μ = ξ`, and the energy doesn't
//! change, `⟨∂h/∂μ, μ̇⟩ + ⟨∂h/∂w, ẇ⟩ = 0`.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::dual::Dual;
use super::evaluation::Evaluation;
use super::exact::{confirmed, same};
use super::inertia::{KineticPart, classified};
use super::linear::Subspace;
use super::number::Number;
use super::residue::Residue;
use super::sample::{advected, exponentials, moved};
use super::series::PowerSeries;
use super::value::Value;
use super::{
    Fault, SAMPLES, Unconfirmed, components_of, dot, evaluated, exponential, increments, parameter, stream, velocities,
};
use crate::declared::{Declaration, FieldKind, Name, Tree};
use crate::mathematics::derive::{Continuous, Derived};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Rational, SymbolId};
use crate::program::{Graph, NodeId, along_directions, components, diamond_matrices, square};

/// Independent points.
const POINTS: u32 = 3;

type Values<T> = BTreeMap<Name, Value<T>>;

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
        let inputs = names.iter().filter_map(|(name, symbol)| Some((*symbol, at.get(name)?.clone())));
        evaluated(&self.graph, outputs, &inputs.collect())
    }
}

/// A point with its kinds of parameters.
struct Point<'a, T> {
    declaration: &'a Declaration,
    values: Values<T>,
}

impl<'a, T: Number> Point<'a, T> {
    fn new(declaration: &'a Declaration, mut number: impl FnMut() -> T) -> Self {
        let mut values = Values::new();
        for (index, field) in declaration.fields.iter().enumerate() {
            values.insert(Name::Field(index), parameter(field.kind, &mut number));
        }
        for index in 0..declaration.advected.len() {
            values.insert(Name::Advected(index), parameter(declaration.advected_kind(index), &mut number));
        }
        let velocity = parameter(FieldKind::Vector(declaration.group.dimension()), &mut number);
        let mut point = Self { declaration, values };
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

    /// As dual numbers, whose velocity changes along component `j`.
    fn along_velocity(&self, j: usize) -> Values<Dual<T>> {
        let mut values = self.lifted();
        let components = self.velocity().into_iter().enumerate();
        let varied = components.map(|(at, value)| Dual { value, slope: if at == j { T::ONE } else { T::ZERO } });
        values.extend(velocities(self.group(), &varied.collect::<Vec<_>>()));
        values
    }

    /// As dual numbers, whose advected parameters change by `ξ·w`.
    fn carried_by(&self, xi: &[T]) -> Values<Dual<T>> {
        self.carried_by_matrix(&element(self.group(), xi))
    }

    /// The same for any matrix.
    fn carried_by_matrix(&self, element: &Value<T>) -> Values<Dual<T>> {
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

impl Point<'_, Residue> {
    /// As power series in `h`, along `F = exp(h ξ̂)`.
    fn moving(&self) -> Values<PowerSeries<Residue>> {
        let mut values = self.in_numbers(PowerSeries::constant);
        let step = element(self.group(), &velocity(self.group(), &values)).map(|entry| entry * PowerSeries::STEP);
        values.extend(increments(self.group(), &exponential(self.group(), &step)));
        values.insert(Name::Step, Value::scalar(PowerSeries::STEP));
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

/// Whether all equations hold, at points at which they have values; `tree` is the declared `l`, where it is one.
pub(crate) fn equations_hold(
    declaration: &Declaration,
    tree: Option<&Rc<Tree>>,
    names: &BTreeMap<Name, SymbolId>,
    derived: &Continuous,
) -> Result<(), Unconfirmed> {
    let terms = Terms::new(derived);
    confirmed(POINTS, |seed| hold_at(&Point::new(declaration, Residue::stream(seed)), tree, names, &terms)).map(drop)
}

fn hold_at(
    point: &Point<Residue>,
    tree: Option<&Rc<Tree>>,
    names: &BTreeMap<Name, SymbolId>,
    terms: &Terms,
) -> Result<(), Fault> {
    let slope = |values: &Values<Dual<Residue>>| {
        let value = match tree {
            Some(tree) => Evaluation::new(values).of(tree).first(),
            None => terms.values(&[terms.lagrangian], names, values).first().copied().unwrap_or(Dual::UNDEFINED),
        };
        value.slope
    };
    let (dimension, xi) = (point.group().dimension(), point.velocity());
    let at = |outputs: &[NodeId]| terms.values(outputs, names, &point.values);
    let (momentum, hessian, diamond, advection) =
        (at(&terms.momentum), at(&terms.hessian), at(&terms.diamond), at(&terms.advection));
    for j in 0..dimension {
        let varied = point.along_velocity(j);
        let momenta = terms.values(&terms.momentum, names, &varied);
        let change = dot(&momenta, &velocity(point.group(), &varied)).slope - slope(&varied);
        let column: Vec<Residue> = hessian.iter().skip(j).step_by(dimension).copied().collect();
        same("velocity ∂h/∂μ", dot(&xi, &column), change)?;
    }
    for (k, &found) in diamond.iter().enumerate() {
        let unit: Vec<Residue> = (0..dimension).map(|j| if j == k { Residue::ONE } else { Residue::ZERO }).collect();
        same("diamond term ∂l/∂w ⋄ w", found, -slope(&point.carried_by(&unit)))?;
    }
    diamond_matrix_holds(point, &diamond, &at, terms, &slope)?;
    let carried = point.carried_by(&xi);
    same("rate of the energy", energy_rate(point, &momentum, &diamond, slope(&carried)), Residue::ZERO)?;
    let varied = terms.values(&terms.momentum, names, &carried);
    let mut pairs = advection.iter().zip(&varied);
    pairs.try_for_each(|(&found, varied)| same("change of the momentum with w", found, varied.slope))
}

/// The diamond as a matrix, paired with the generators, and where it is meant along all matrices.
///
/// Of an attitude that is seen `RᵀR = I` may have been used. So it is compared on the group, where that holds.
fn diamond_matrix_holds(
    point: &Point<Residue>,
    diamond: &[Residue],
    at: &dyn Fn(&[NodeId]) -> Vec<Residue>,
    terms: &Terms,
    slope: &dyn Fn(&Values<Dual<Residue>>) -> Residue,
) -> Result<(), Fault> {
    let (group, term) = (point.group(), "diamond along all matrices");
    let kinds = (0..point.declaration.advected.len()).map(|index| point.declaration.advected_kind(index));
    let is_general = kinds.into_iter().all(|kind| !matches!(kind, FieldKind::Configuration(_)));
    for (factor, entries) in terms.diamond_matrices.iter().enumerate() {
        let (own, found) = (group.factor(factor), at(entries));
        let components = &diamond[group.component_of(factor)..];
        for (generator, &expected) in own.generators.iter().zip(components) {
            same(term, dot(&found, &Value::square(own.size, generator).entries), expected)?;
        }
        let row = group.row_of(factor);
        for (place, &found) in found.iter().enumerate().filter(|_| is_general) {
            let is_one = |i, j| (i, j) == (row + place / own.size, row + place % own.size);
            let unit =
                Value::new(group.size, group.size, |i, j| if is_one(i, j) { Residue::ONE } else { Residue::ZERO });
            same(term, found, -slope(&point.carried_by_matrix(&unit)))?;
        }
    }
    Ok(())
}

/// `⟨∂h/∂μ, μ̇⟩ + ⟨∂h/∂w, ẇ⟩` with `∂h/∂μ = ξ`, `∂h/∂w = −∂l/∂w` and `ẇ = −ξ·w`; `carried` is `⟨∂l/∂w, ξ·w⟩`.
fn energy_rate(point: &Point<Residue>, momentum: &[Residue], diamond: &[Residue], carried: Residue) -> Residue {
    let xi = point.velocity();
    let rate = coadjoint(point.group(), &xi, momentum);
    let rate: Vec<Residue> = rate.iter().zip(diamond).map(|(&x, &y)| x + y).collect();
    dot(&xi, &rate) + carried
}

/// Whether the rate of the energy vanishes, by itself.
#[cfg(test)]
pub(crate) fn energy_is_kept(
    declaration: &Declaration,
    tree: &Rc<Tree>,
    names: &BTreeMap<Name, SymbolId>,
    derived: &Continuous,
) -> bool {
    let terms = Terms::new(derived);
    (1..=u64::from(POINTS)).all(|seed| {
        let point = Point::new(declaration, Residue::stream(seed));
        let at = |outputs: &[NodeId]| terms.values(outputs, names, &point.values);
        let carried = Evaluation::new(&point.carried_by(&point.velocity())).of(tree).first().slope;
        energy_rate(&point, &at(&terms.momentum), &at(&terms.diamond), carried) == Residue::ZERO
    })
}

/// `J`, `s` and `V` of the limit of a discrete Lagrangian, as operations.
struct LimitTerms {
    graph: Graph,
    inertia: Vec<NodeId>,
    bias: Vec<NodeId>,
    potential: NodeId,
}

impl LimitTerms {
    fn new(derived: &Derived) -> Self {
        let (mut graph, none) = (Graph::default(), BTreeMap::new());
        let inertia = square(&mut graph, derived, &none, &derived.limit.inertia);
        let bias = components(&mut graph, derived, &none, &derived.limit.bias);
        let mut scalariser = crate::program::Scalariser { graph: &mut graph, symbols: &derived.symbols, given: none };
        let potential = scalariser.scalar(&derived.limit.potential);
        Self { graph, inertia, bias, potential }
    }

    /// `J` by rows, `s` and `V`.
    fn at(&self, names: &BTreeMap<Name, SymbolId>, point: &Point<Residue>) -> (Vec<Residue>, Vec<Residue>, Residue) {
        let inputs = names.iter().filter_map(|(name, symbol)| Some((*symbol, point.values.get(name)?.clone())));
        let inputs = inputs.collect();
        let at = |outputs: &[NodeId]| evaluated(&self.graph, outputs, &inputs);
        let potential = at(&[self.potential]).first().copied().unwrap_or(Residue::UNDEFINED);
        (at(&self.inertia), at(&self.bias), potential)
    }
}

/// Whether `J`, `s` and `V` of the limit are what the derivatives of `l` are at rest.
pub(crate) fn rest_holds(
    declaration: &Declaration,
    (names, continuous): (&BTreeMap<Name, SymbolId>, &Continuous),
    (symbols, derived): (&BTreeMap<Name, SymbolId>, &Derived),
) -> Result<(), Unconfirmed> {
    let (terms, limit) = (Terms::new(continuous), LimitTerms::new(derived));
    let point = |seed| {
        let mut point = Point::new(declaration, Residue::stream(seed));
        point.set_velocity(&vec![Residue::ZERO; declaration.group.dimension()]);
        let at = |outputs: &[NodeId]| terms.values(outputs, names, &point.values);
        let (inertia, bias, potential) = limit.at(symbols, &point);
        let pairs =
            [(at(&terms.hessian), inertia), (at(&terms.momentum), bias), (at(&[terms.lagrangian]), vec![-potential])];
        let mut pairs = pairs.iter().flat_map(|(here, there)| here.iter().zip(there));
        pairs.try_for_each(|(&here, &there)| same("continuous limit", there, here))
    };
    confirmed(POINTS, point).map(drop)
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
    let rest = |values: &Values<PowerSeries<Residue>>| {
        let l = match l {
            Lagrangian::Declared(tree) => Evaluation::new(values).of(tree).first(),
            Lagrangian::Derived(names, derived) => {
                let terms = Terms::new(derived);
                let value = terms.values(&[terms.lagrangian], names, values);
                value.first().copied().unwrap_or(PowerSeries::UNDEFINED)
            }
        };
        Evaluation::new(values).of(discrete).first() - PowerSeries::STEP * l
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
    let (terms, dimension) = (Terms::new(derived), declaration.group.dimension());
    let samples = (1..=u64::try_from(SAMPLES).unwrap_or(1)).map(|seed| {
        let mut point = Point::new(declaration, stream(seed));
        point.set_velocity(&vec![0.0; dimension]);
        let entries = terms.values(&terms.hessian, names, &point.values);
        Value { rows: dimension, columns: dimension, entries }
    });
    let is_used = |name: Name| names.get(&name).is_some_and(|&id| derived.hessian.contains(id));
    let mut point = Point::new(declaration, Residue::stream(1));
    point.set_velocity(&vec![Residue::ZERO; dimension]);
    let exact = terms.values(&terms.hessian, names, &point.values);
    classified(declaration, &is_used, samples.collect(), &exact)
}
