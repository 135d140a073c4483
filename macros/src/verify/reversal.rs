//! Self-adjointness by numbers: the normal form doesn't know every relation of a group.

use std::rc::Rc;

use super::Sample;
use crate::ast::Tree;
use crate::derive::SelfAdjointness;
use crate::symbolic::Expression;

/// What rounding leaves of `l_d(F, w, h) + l_d(F⁻¹, F⁻¹·w, −h)`, relative to the size of its terms.
const TOLERANCE: f64 = 1e-11;

/// Whether the Lagrangian is self-adjoint for all values of its parameters; an error if the symbolic form is wrong.
pub(super) fn self_adjointness(
    samples: &[Sample],
    tree: &Rc<Tree>,
    defect: &Expression,
) -> Result<SelfAdjointness, &'static str> {
    let values = samples.iter().map(|sample| (sample.declared(tree), sample.reversed(tree)));
    let finite: Vec<(f64, f64)> = values.filter(|(l, reversed)| l.is_finite() && reversed.is_finite()).collect();
    let is_equal = |&(l, reversed): &(f64, f64)| (l - reversed).abs() <= TOLERANCE * (1.0 + l.abs() + reversed.abs());
    match (finite.iter().all(is_equal), defect.is_zero()) {
        _ if finite.is_empty() => Ok(SelfAdjointness::Unknown),
        (true, true) => Ok(SelfAdjointness::Symbolic),
        (true, false) => Ok(SelfAdjointness::Numeric),
        (false, false) => Ok(SelfAdjointness::No),
        (false, true) => Err("adjoint"),
    }
}
