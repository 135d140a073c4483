//! Self-adjointness by values: the normal form doesn't know every relation of a group.

use std::rc::Rc;

use super::degree;
use super::exact::Exact;
use super::number::Number;
use super::residue::Residue;
use super::sample::Sample;
use crate::declared::{Name, Tree};
use crate::mathematics::derive::SelfAdjointness;
use crate::mathematics::symbolic::Variance;

/// What rounding leaves of `l_d(F, w, h) + l_d(F⁻¹, F⁻¹·w, −h)`, relative to the size of its terms.
const TOLERANCE: f64 = 1e-11;

/// Whether the Lagrangian is self-adjoint for all values of its parameters; an error if the symbolic form, which may have
/// found it, is wrong. `points` are those of the field, where they decide.
pub(super) fn self_adjointness(
    draws: &[Sample],
    points: &[Sample<Residue>],
    tree: &Rc<Tree>,
    is_symbolic: bool,
) -> Result<SelfAdjointness, &'static str> {
    // A root may have no value at the negative step.
    let Some(is_close) = are_all(draws, tree, f64::is_finite, is_close) else { return Ok(SelfAdjointness::Unknown) };
    let exact = are_all(points, tree, Exact::is_defined, Exact::is);
    // A function may have relations that a random one hasn't.
    let exact = exact.filter(|&is_equal| is_equal || degree::functions(tree) == 0);
    match (exact.unwrap_or(is_close), is_symbolic) {
        (true, true) => Ok(SelfAdjointness::Symbolic),
        (true, false) if exact.is_some() => Ok(SelfAdjointness::Exact),
        (true, false) => Ok(SelfAdjointness::Numeric),
        (false, true) => Err("adjoint"),
        (false, false) => {
            let is_found = match exact {
                Some(_) => are_all(&with_points(points), tree, Exact::is_defined, Exact::is),
                None => are_all(&with_points(draws), tree, f64::is_finite, self::is_close),
            };
            let is_found = is_found == Some(true);
            Ok(if is_found { SelfAdjointness::ForPoints } else { SelfAdjointness::No })
        }
    }
}

/// Whether both values are equal at all points that have them; none if there is no such point.
fn are_all<T: Number>(
    points: &[Sample<T>],
    tree: &Rc<Tree>,
    is_defined: fn(T) -> bool,
    are_equal: fn(T, T) -> bool,
) -> Option<bool> {
    let values = points.iter().map(|point| (point.declared(tree), point.reversed(tree)));
    let defined: Vec<(T, T)> = values.filter(|(l, reversed)| is_defined(*l) && is_defined(*reversed)).collect();
    (!defined.is_empty()).then(|| defined.iter().all(|&(l, reversed)| are_equal(l, reversed)))
}

fn with_points<'a, T: Number>(samples: &[Sample<'a, T>]) -> Vec<Sample<'a, T>> {
    samples.iter().filter_map(Sample::with_points).collect()
}

fn is_close(l: f64, reversed: f64) -> bool {
    (l - reversed).abs() <= TOLERANCE * (1.0 + l.abs() + reversed.abs())
}

impl<T: Number> Sample<'_, T> {
    /// On a group of affine maps, the same with one for the last coordinate of all vectors.
    fn with_points(&self) -> Option<Self> {
        let group = &self.derived.group;
        if !group.is_affine() {
            return None;
        }
        let mut sample = self.clone();
        for (name, value) in &mut sample.values {
            let is_vector = match name {
                Name::Field(_) => true,
                Name::Advected(_) => self.advected.iter().any(|w| (w.0, w.1) == (*name, Variance::Vector)),
                Name::Increment(_)
                | Name::Step
                | Name::Velocity(_)
                | Name::DisplacementBefore(_)
                | Name::DisplacementAfter(_) => false,
            };
            if is_vector && (value.rows, value.columns) == (group.size, 1) {
                value.entries.pop();
                value.entries.push(T::ONE);
            }
        }
        Some(sample)
    }
}
