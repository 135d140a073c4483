//! The continuous equations at random points of a finite field, where nothing is rounded.
//!
//! Derivatives of the Lagrangian are computed with dual numbers, independently of the symbolic rules: along a change of
//! the velocity, and along a random `η` that moves all advected parameters.

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
use super::sample::{along_motion, exponentials, moved};
use super::series::Series;
use super::value::Value;
use super::{
    Objection, SAMPLES, Sureness, Values, algebra, dot, evaluated, increments, over, parameter, parameters, shares,
    stream, velocities,
};
use crate::declared::{Declaration, FieldKind, Name, Tree};
use crate::mathematics::derive::Continuous;
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Rational, SymbolId};
use crate::program::{Graph, NodeId, Outputs, along_directions, diamond_matrices};

/// The continuous equations of a declaration as operations.
pub struct Motion<'a> {
    declaration: &'a Declaration,
    /// The declared `l`, if the declaration is continuous.
    tree: Option<&'a Rc<Tree>>,
    names: &'a BTreeMap<Name, SymbolId>,
    derived: &'a Continuous,
    graph: Graph,
    lagrangian: Vec<NodeId>,
    momentum: Vec<NodeId>,
    hessian: Vec<NodeId>,
    diamond: Vec<NodeId>,
    /// The diamond of each factor of the group as a matrix.
    diamond_matrices: Vec<Vec<NodeId>>,
    advection: Vec<NodeId>,
}

/// The values of symbols.
fn inputs<T: Number>(names: &BTreeMap<Name, SymbolId>, at: &Values<T>) -> BTreeMap<SymbolId, Value<T>> {
    names.iter().filter_map(|(name, symbol)| Some((*symbol, at.get(name)?.clone()))).collect()
}

impl<'a> Motion<'a> {
    pub fn new(
        declaration: &'a Declaration,
        tree: Option<&'a Rc<Tree>>,
        names: &'a BTreeMap<Name, SymbolId>,
        derived: &'a Continuous,
    ) -> Self {
        let mut graph = Graph::default();
        let [lagrangian, momentum, hessian, diamond, advection] = [
            (0, &derived.lagrangian),
            (1, &derived.momentum),
            (2, &derived.hessian),
            (1, &derived.diamond),
            (1, &derived.advection),
        ]
        .map(|(rank, expression)| along_directions(&mut graph, derived, rank, expression));
        let diamond_matrices = diamond_matrices(&mut graph, derived);
        Self {
            declaration,
            tree,
            names,
            derived,
            graph,
            lagrangian,
            momentum,
            hessian,
            diamond,
            diamond_matrices,
            advection,
        }
    }

    fn values<T: Number>(&self, outputs: &[NodeId], at: &Values<T>) -> Vec<T> {
        evaluated(&self.graph, outputs, &inputs(self.names, at))
    }

    /// The declared `l`, or else the derived one.
    fn lagrangian<T: Number>(&self, at: &Values<T>) -> T {
        let derived = || self.values(&self.lagrangian, at).first().copied().unwrap_or(T::UNDEFINED);
        self.tree.map_or_else(derived, |tree| Evaluation::new(at).of(tree).first())
    }

    fn group(&self) -> &Group {
        &self.declaration.group
    }

    /// Random numbers for all parameters and for the velocity.
    fn point<T: Number>(&self, mut number: impl FnMut() -> T) -> Values<T> {
        let mut values = parameters(self.declaration, &mut number);
        let velocity = parameter(FieldKind::Vector(self.group().dimension()), &mut number);
        values.extend(velocities(self.group(), &velocity.entries));
        values
    }

    /// The degrees of a point whose attitudes are Cayley transforms.
    fn point_of_degrees(&self, number: &mut impl FnMut() -> Degree) -> Values<Degree> {
        let mut values = self.point(&mut *number);
        let transforms = u64::try_from(degree::transforms(self.declaration)).unwrap_or(u64::MAX / 2);
        degree::set_attitudes(self.declaration, &mut values, 2 * transforms, number);
        values
    }

    /// The values with zero velocity.
    fn stopped<T: Number>(&self, mut values: Values<T>) -> Values<T> {
        values.extend(velocities(self.group(), &vec![T::ZERO; self.group().dimension()]));
        values
    }

    /// The components of all velocities.
    fn velocity<T: Number>(&self, values: &Values<T>) -> Vec<T> {
        let of_factor = |factor| values.get(&Name::Velocity(factor)).map_or(&[][..], |own| own.entries.as_slice());
        (0..self.group().factors().len()).flat_map(of_factor).copied().collect()
    }

    /// Dual numbers whose velocity changes along `η`.
    fn along_velocity<T: Number>(&self, values: &Values<T>, eta: &[T]) -> Values<Dual<T>> {
        let components = self.velocity(values).into_iter().zip(eta);
        let varied: Vec<Dual<T>> = components.map(|(value, &slope)| Dual { value, slope }).collect();
        let mut values = over(values, Dual::constant);
        values.extend(velocities(self.group(), &varied));
        values
    }

    /// Dual numbers whose advected parameters change by the action of these matrices.
    fn carried_by<T: Number>(&self, values: &Values<T>, element: &[Value<T>]) -> Values<Dual<T>> {
        let [forwards, backwards] = exponentials(element);
        let mut values = moved(self.declaration, &over(values, Dual::constant), [&forwards, &backwards]);
        let is_point = |name| matches!(name, Name::Advected(w) if matches!(self.declaration.advected_kind(w), FieldKind::Point(_)));
        // The last coordinate of a point stays one.
        for (_, w) in values.iter_mut().filter(|(name, _)| is_point(**name)) {
            w.entries.last_mut().into_iter().for_each(|last| last.slope = T::ZERO);
        }
        values
    }

    /// Power series in `h`, along `F = exp(h ξ̂)`.
    fn moving(&self, seed: u64) -> Values<Series> {
        let mut values = over(&self.point(Residue::stream(seed)), Series::constant);
        values.extend(increments(self.group(), &along_motion(self.group(), &self.velocity(&values))));
        values.insert(Name::Step, Value::scalar(Series::STEP));
        values
    }

    /// Checks all equations, and returns a bound on the probability of a wrong result.
    pub fn holds(&self) -> Result<Sureness, Objection> {
        let degrees = |same: &mut Same<Degree>| {
            let mut number = Degree::stream();
            self.holds_at(&self.point_of_degrees(&mut number), number, same)
        };
        let content = self.tree.map_or_else(Content::default, Content::of_tree) + Content::of_graph(&self.graph);
        certified(content, degrees, |seed| {
            let mut number = Residue::stream(seed);
            self.holds_at(&self.point(&mut number), number, &mut same)
        })
    }

    /// Compares all equations along a direction of these numbers.
    fn holds_at<T: Number>(
        &self,
        point: &Values<T>,
        mut number: impl FnMut() -> T,
        same: &mut Same<T>,
    ) -> Result<(), Objection> {
        let group = self.group();
        let eta: Vec<T> = group.generators.iter().map(|_| number()).collect();
        let at = |outputs: &[NodeId]| self.values(outputs, point);
        let varied = self.along_velocity(point, &eta);
        same("momentum ∂l/∂ξ", dot(&at(&self.momentum), &eta), self.lagrangian(&varied).slope)?;
        let change = self.values(&self.momentum, &varied);
        for (row, momentum) in at(&self.hessian).chunks(eta.len()).zip(change) {
            same("inertia ∂²l/∂ξ²", dot(row, &eta), momentum.slope)?;
        }
        let carried = |element: &[Value<T>]| -self.lagrangian(&self.carried_by(point, element)).slope;
        let along_group = algebra(group, &eta);
        let expected = carried(&along_group);
        same("diamond term ∂l/∂w ⋄ w", dot(&at(&self.diamond), &eta), expected)?;
        // The diamond is compared along the group; and along all matrices, unless the attitude of a body is a
        // parameter, for which `RᵀR = I` may have been used.
        let along = |along: &[Value<T>]| {
            let of_factors = self.diamond_matrices.iter().zip(along);
            of_factors.fold(T::ZERO, |sum, (entries, along)| sum + dot(&at(entries), &along.entries))
        };
        same("diamond along all matrices", along(&along_group), expected)?;
        if degree::attitudes(self.declaration).next().is_none() {
            let any = |own: &Group| parameter(FieldKind::Matrix(own.size), &mut number);
            let any: Vec<Value<T>> = group.factors().iter().map(any).collect();
            same("diamond along all matrices", along(&any), carried(&any))?;
        }
        let along_motion = self.carried_by(point, &algebra(group, &self.velocity(point)));
        let mut pairs = at(&self.advection).into_iter().zip(self.values(&self.momentum, &along_motion));
        pairs.try_for_each(|(found, varied)| same("change of the momentum with w", found, varied.slope))
    }

    /// Checks that `J`, `s` and `V` of the limit of a discrete Lagrangian are the derivatives of `l` at rest, and
    /// returns a bound on the probability of a wrong result.
    pub fn rest_holds(
        &self,
        names: &BTreeMap<Name, SymbolId>,
        (graph, limit): Outputs<[Vec<NodeId>; 3]>,
    ) -> Result<Sureness, Objection> {
        let limit = limit.concat();
        let degrees = |same: &mut Same<Degree>| {
            let point = self.point_of_degrees(&mut Degree::stream());
            self.rests_at(&self.stopped(point), (names, &graph, &limit), same)
        };
        certified(Content::of_graph(&self.graph) + Content::of_graph(&graph), degrees, |seed| {
            let point = self.point(Residue::stream(seed));
            self.rests_at(&self.stopped(point), (names, &graph, &limit), &mut same)
        })
    }

    fn rests_at<T: Number>(
        &self,
        point: &Values<T>,
        (names, graph, limit): (&BTreeMap<Name, SymbolId>, &Graph, &[NodeId]),
        same: &mut Same<T>,
    ) -> Result<(), Objection> {
        let mut here = self.values(&[self.hessian.as_slice(), &self.momentum, &self.lagrangian].concat(), point);
        here.last_mut().into_iter().for_each(|l| *l = -*l);
        let mut pairs = here.into_iter().zip(evaluated(graph, limit, &inputs(names, point)));
        pairs.try_for_each(|(here, there)| same("continuous limit", there, here))
    }

    /// Whether the discrete Lagrangian is `h l(ξ, w) + O(h²)` along `F = exp(h ξ̂)`, at all points where the series has
    /// a value; `None` if there is no such point. Terms of lower order count only if they depend on the motion.
    ///
    /// The field has roots of all numbers, so the domain of `l` isn't checked here. A constant that vanishes in the
    /// field alone is no reason to refuse.
    pub fn has_limit(&self, discrete: &Rc<Tree>) -> Option<bool> {
        if Content::of_tree(discrete).has_multiple {
            return Some(true);
        }
        let rest = |values: &Values<Series>| {
            Evaluation::new(values).of(discrete).first() - Series::STEP * self.lagrangian(values)
        };
        let told = (1..=u64::from(POINTS)).filter_map(|seed| {
            let (values, mut elsewhere) = (self.moving(seed), self.moving(seed + u64::from(POINTS)));
            let fields = values.iter().filter(|(name, _)| matches!(name, Name::Field(_)));
            elsewhere.extend(fields.map(|(name, value)| (*name, value.clone())));
            let here = rest(&values);
            let difference = here - rest(&elsewhere);
            let is_right = difference.order().is_none_or(|order| order >= 2) && here.at(1) == Residue::ZERO;
            (difference.is_defined() && difference.is_known_below(2)).then_some(is_right)
        });
        told.reduce(|all, one| all && one)
    }

    /// A basis of the directions `ζ` with `⟨μ̇, ζ⟩ = 0` for all values of the parameters: `⟨μ, ζ⟩` is conserved. Empty
    /// if a constant vanishes in the field alone.
    pub fn right_symmetries(&self) -> Vec<Vec<Rational>> {
        let (dimension, mut rates) = (self.group().dimension(), Subspace::default());
        let has_multiple = Content::of_graph(&self.graph).has_multiple;
        for seed in 1..=2 * u64::try_from(dimension).unwrap_or(0) + 2 {
            let point = self.point(Residue::stream(seed));
            let at = |outputs: &[NodeId]| self.values(outputs, &point);
            let rate = coadjoint(self.group(), &self.velocity(&point), &at(&self.momentum));
            let rate: Vec<Residue> = rate.iter().zip(at(&self.diamond)).map(|(&x, y)| x + y).collect();
            if has_multiple || rate.iter().any(|entry| !entry.is_defined()) {
                return Vec::new();
            }
            rates.extend(rate);
        }
        let small = |vector: Vec<Residue>| vector.into_iter().map(Residue::small).collect();
        rates.null_space(dimension).into_iter().filter_map(small).collect()
    }

    /// The kinetic part by its second derivative at rest, at sample values of the parameters.
    pub fn kinetic_part(&self) -> KineticPart {
        if Content::of_graph(&self.graph).has_multiple {
            return KineticPart::Regular;
        }
        let samples = (1..=u64::try_from(SAMPLES).unwrap_or(1)).map(|seed| self.hessian_at_rest(stream(seed)));
        let is_used = |name: Name| self.names.get(&name).is_some_and(|&id| self.derived.hessian.contains(id));
        let samples: Vec<Value> = samples.map(|(hessian, _)| hessian).collect();
        let (exact, point) = self.hessian_at_rest(Residue::stream(1));
        classified(self.declaration, (&is_used, FieldKind::is_inertia), samples, (&exact, &point))
    }

    /// The second derivative at rest, and the values at which it is taken.
    fn hessian_at_rest<T: Number>(&self, number: impl FnMut() -> T) -> (Value<T>, Values<T>) {
        let dimension = self.group().dimension();
        let point = self.stopped(self.point(number));
        let entries = self.values(&self.hessian, &point);
        (Value { rows: dimension, columns: dimension, entries }, point)
    }
}

/// `⟨ad*_ξ μ, E_k⟩ = ⟨μ, [ξ, E_k]⟩` for all `k`.
fn coadjoint<T: Number>(group: &Group, xi: &[T], momentum: &[T]) -> Vec<T> {
    let of_factor = |((own, xi), (_, momentum)): ((&Group, &[T]), (_, &[T]))| {
        let xi = Value::combination(own.size, &own.generators, xi);
        let mut pairing = vec![T::ZERO; own.size * own.size];
        for (k, row, column, share) in own.dual() {
            let entry = &mut pairing[row * own.size + column];
            *entry = *entry + T::of(share) * momentum[k];
        }
        let along = |entries| {
            let e = Value::square(own.size, entries);
            dot(&xi.times(&e).zip(&e.times(&xi), |x, y| x - y).entries, &pairing)
        };
        own.generators.iter().map(|entries| along(entries)).collect::<Vec<T>>()
    };
    shares(group, xi).zip(shares(group, momentum)).flat_map(of_factor).collect()
}
