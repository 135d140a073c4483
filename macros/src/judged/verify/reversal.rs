//! Self-adjointness by values: the normal form doesn't know every relation of a group.

use std::rc::Rc;

use super::Sample;
use crate::declared::{Name, Tree};
use crate::mathematics::derive::SelfAdjointness;
use crate::mathematics::symbolic::{Expression, Variance};

/// What rounding leaves of `l_d(F, w, h) + l_d(F⁻¹, F⁻¹·w, −h)`, relative to the size of its terms.
const TOLERANCE: f64 = 1e-11;

/// Whether the Lagrangian is self-adjoint for all values of its parameters; an error if the symbolic form is wrong.
pub(super) fn self_adjointness(
    samples: &[Sample],
    tree: &Rc<Tree>,
    defect: &Expression,
    exact: impl FnOnce() -> Option<bool>,
) -> Result<SelfAdjointness, &'static str> {
    match (is_equal(samples, tree), defect.is_zero()) {
        (None, _) => Ok(SelfAdjointness::Unknown),
        (Some(true), true) => Ok(SelfAdjointness::Symbolic),
        (Some(true), false) => Ok(match exact() {
            Some(true) => SelfAdjointness::Exact,
            Some(false) => SelfAdjointness::No,
            None => SelfAdjointness::Numeric,
        }),
        (Some(false), true) => Err("adjoint"),
        (Some(false), false) => {
            let points: Vec<Sample> = samples.iter().filter_map(Sample::with_points).collect();
            let is_found = is_equal(&points, tree) == Some(true);
            Ok(if is_found { SelfAdjointness::ForPoints } else { SelfAdjointness::No })
        }
    }
}

/// Whether both values are equal at all samples that have them; none if there is no such sample.
fn is_equal(samples: &[Sample], tree: &Rc<Tree>) -> Option<bool> {
    let values = samples.iter().map(|sample| (sample.declared(tree), sample.reversed(tree)));
    let finite: Vec<(f64, f64)> = values.filter(|(l, reversed)| l.is_finite() && reversed.is_finite()).collect();
    let is_equal = |&(l, reversed): &(f64, f64)| (l - reversed).abs() <= TOLERANCE * (1.0 + l.abs() + reversed.abs());
    (!finite.is_empty()).then(|| finite.iter().all(is_equal))
}

impl Sample<'_> {
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
                value.entries.push(1.0);
            }
        }
        Some(sample)
    }
}
