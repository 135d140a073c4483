//! The kinetic part at the identity: stationary, smooth and regular in the finite field, and its sign at sample values
//! of the parameters.

use std::collections::BTreeMap;

use super::degree::Content;
use super::number::Number;
use super::residue::Residue;
use super::{Element, SAMPLES, Sample, Subject, Value, Values, evaluated, linear};
use crate::declared::{Declaration, Field, FieldKind, Name};
use crate::mathematics::symbolic::Rational;
use crate::program::{Graph, NodeId, components, square};

/// Properties of `K(F)` in `l_d = K(F)/h + …` at sample values of the parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KineticPart {
    /// The first derivative vanishes, and the second, `J`, is invertible at some values.
    Regular,
    /// The first derivative doesn't vanish; it would if these fields were symmetric.
    NotStationary(Vec<usize>),
    /// `J` is singular at all values; the generators along which there is no kinetic energy.
    Singular(Vec<usize>),
    /// `J` has no value at any: the kinetic part has no second derivative.
    NotSmooth,
    /// `J` is negative at all sample values.
    Negative,
    /// `J` of a rotation is this field, whose type is that of the nonstandard inertia, or the other way round.
    OtherInertia(usize),
}

/// Whether an inertia of this type is compared with that of a rotation.
type Inertias = fn(FieldKind) -> bool;

/// The kinetic part by its first and second derivatives at several values of the parameters.
pub fn kinetic_part(of: Subject) -> KineticPart {
    let Subject { declaration, lowered, derived, .. } = of;
    let samples: Vec<Sample> = Sample::draws(of).take(SAMPLES).collect();
    let (mut graph, none) = (Graph::default(), BTreeMap::new());
    let slope = components(&mut graph, derived, &none, &derived.limit.slope);
    let inertia = square(&mut graph, derived, &none, &derived.limit.inertia);
    // Missing values are reported with the terms, and the field can't judge multiples of the prime.
    if samples.is_empty() || Content::of_graph(&graph).has_multiple {
        return KineticPart::Regular;
    }
    let sample = Sample::at(of, Element::identity(&declaration.group), &mut Residue::stream(1));
    let is_stationary = |sample: &Sample<Residue>| {
        at_identity(sample, &graph, &slope).into_iter().all(|slope| slope.is_zero() || !slope.is_defined())
    };
    if !is_stationary(&sample) {
        let fields = (0..declaration.fields.len()).filter(|&at| is_square(declaration, at)).collect::<Vec<_>>();
        let with_symmetric = |fields: &[usize]| is_stationary(&sample.with_symmetric(fields));
        let without = |at: usize| fields.iter().copied().filter(|&other| other != at).collect::<Vec<_>>();
        let needed = fields.iter().copied().filter(|&at| with_symmetric(&fields) && !with_symmetric(&without(at)));
        return KineticPart::NotStationary(needed.collect());
    }
    let dimension = derived.group.dimension();
    let exact = Value { rows: dimension, columns: dimension, entries: at_identity(&sample, &graph, &inertia) };
    let inertias = samples.iter().map(|sample| at_identity(sample, &graph, &inertia));
    let inertias = inertias.map(|entries| Value { rows: dimension, columns: dimension, entries });
    let is_used = |name: Name| lowered.names.get(&name).is_some_and(|&id| derived.limit.inertia.contains(id));
    // A discrete Lagrangian may call any symmetric matrix `J_d`.
    let can_be_wrong = |kind: FieldKind| kind == FieldKind::StandardInertia;
    classified(declaration, (&is_used, can_be_wrong), inertias.collect(), (&exact, &sample.values))
}

/// The kinetic part by its second derivative in the field, and by its sign at sample values. `is_used` selects the
/// names that it depends on, `can_be_wrong` the types of inertias that are compared with that of a rotation.
pub(super) fn classified(
    declaration: &Declaration,
    (is_used, can_be_wrong): (&dyn Fn(Name) -> bool, Inertias),
    samples: Vec<Value>,
    (exact, values): (&Value<Residue>, &Values<Residue>),
) -> KineticPart {
    let is_finite = |inertia: &Value| inertia.entries.iter().all(|entry| entry.is_finite());
    let samples: Vec<Value> = samples.into_iter().filter(is_finite).collect();
    if samples.is_empty() || exact.entries.iter().any(|entry| !entry.is_defined()) {
        KineticPart::NotSmooth
    } else if has_a_sign(declaration, is_used) && samples.iter().all(|j| is_positive(&j.map(|x| -x))) {
        KineticPart::Negative
    } else if let Some(field) = other_inertia(declaration, can_be_wrong, (exact, values)) {
        KineticPart::OtherInertia(field)
    } else if linear::is_regular(&exact.entries, exact.rows) {
        KineticPart::Regular
    } else {
        let is_idle = |&k: &usize| (0..exact.rows).all(|j| exact.at(k, j).is_zero() && exact.at(j, k).is_zero());
        KineticPart::Singular((0..exact.rows).filter(is_idle).collect())
    }
}

/// The field whose type has the other inertia than that of a rotation: the kinetic energy of a `NonstandardInertia` `J_d` is
/// `½ Ω·(tr(J_d) I − J_d) Ω`, that of an `Inertia` `J` is `½ Ω·J Ω`. Other multiples of these, and groups of the user's own, are
/// not compared.
fn other_inertia(
    declaration: &Declaration,
    can_be_wrong: Inertias,
    (exact, values): (&Value<Residue>, &Values<Residue>),
) -> Option<usize> {
    let mut first = 0;
    for factor in declaration.group.factors() {
        let start = first;
        first += factor.dimension();
        if !factor.is_so3 {
            continue;
        }
        let block = Value::new(3, 3, |i, j| exact.at(start + i, start + j));
        let is_other = |(at, field): (usize, &Field)| {
            let value = values.get(&Name::Field(at)).filter(|_| can_be_wrong(field.kind))?;
            let trace = (0..3).map(|k| value.at(k, k)).fold(Residue::ZERO, |sum, entry| sum + entry);
            let spread = Value::diagonal(3, |_| trace).zip(value, |x, y| x - y);
            let other = if field.kind == FieldKind::StandardInertia { &spread } else { value };
            other.zip(&block, |x, y| x - y).entries.iter().all(|entry| entry.is_zero()).then_some(at)
        };
        if let Some(field) = declaration.fields.iter().enumerate().find_map(is_other) {
            return Some(field);
        }
    }
    None
}

/// Whether the kinetic part depends on one field alone, whose type promises a positive matrix, or on none.
fn has_a_sign(declaration: &Declaration, is_used: &dyn Fn(Name) -> bool) -> bool {
    let is_advected = (0..declaration.advected.len()).any(|index| is_used(Name::Advected(index)));
    let used: Vec<_> = (0..declaration.fields.len()).filter(|&index| is_used(Name::Field(index))).collect();
    match used.as_slice() {
        _ if is_advected => false,
        [] => true,
        [one] => declaration.fields.get(*one).is_some_and(|field| field.kind.is_inertia()),
        _ => false,
    }
}

/// Whether a symmetric matrix is positive definite: all pivots of elimination are positive.
fn is_positive(matrix: &Value) -> bool {
    let (size, mut rest) = (matrix.rows, matrix.clone());
    (0..size).all(|k| {
        let pivot = rest.at(k, k);
        rest = Value::new(size, size, |i, j| rest.at(i, j) - rest.at(i, k) * rest.at(k, j) / pivot);
        pivot > 0.0
    })
}

fn at_identity<T: Number>(sample: &Sample<T>, graph: &Graph, outputs: &[NodeId]) -> Vec<T> {
    evaluated(graph, outputs, &sample.inputs_at(&Element::identity(&sample.of.derived.group), &sample.values))
}

/// Whether a field is a matrix without known symmetry.
fn is_square(declaration: &Declaration, field: usize) -> bool {
    matches!(declaration.fields.get(field), Some(field) if matches!(field.kind, FieldKind::Matrix(_)))
}

impl Sample<'_, Residue> {
    /// The sample with some fields replaced by their symmetric parts.
    fn with_symmetric(&self, fields: &[usize]) -> Self {
        let (mut sample, half) = (self.clone(), Residue::of(Rational::new(1, 2)));
        for &field in fields {
            if let Some(value) = sample.values.get_mut(&Name::Field(field)) {
                *value = value.zip(&value.transpose(), |x, y| half * (x + y));
            }
        }
        sample
    }
}
