//! Whether a Lagrangian is its own adjoint, `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)`: then a step of `−h` undoes a step of
//! `h`, and the order is even \[RDAE, section 1.4; Hairer, Lubich and Wanner, V.1\].
//!
//! A force is, if its virtual work has `δW(F, w, h, η, η⁺) = −δW(F⁻¹, F⁻¹·w, −h, η⁺, η)`. With (2.6) and (2.7) that is
//! `f⁺(F, w, h) = −f⁻(F⁻¹, F⁻¹·w, −h)`, by which the two equations of a step change places as they do without a force.

use std::collections::BTreeMap;

use super::{Context, action};
use crate::mathematics::symbolic::{Expression, Rational};

/// The self-adjointness of a Lagrangian or of a force, and its proof.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelfAdjointness {
    /// The normal forms are equal.
    Symbolic,
    /// The two sides have equal values at random points, where nothing is rounded.
    Exact,
    /// The two sides have equal values at squares of `F`, where the composition of `exp` and `log` is known.
    WithoutBound,
    /// The two sides have different values, but equal ones if all vectors have one for their last coordinate, which is
    /// guaranteed by the types of points, not by those of vectors.
    ForPoints,
    /// The two sides have different values.
    No,
}

impl SelfAdjointness {
    pub fn is_found(self) -> bool {
        matches!(self, Self::Symbolic | Self::Exact | Self::WithoutBound)
    }
}

/// `l_d(F, w, h) + l_d(F⁻¹, F⁻¹·w, −h)`, of virtual work with the displacements exchanged; terms that cancel by relations
/// beyond the normal form remain.
pub(super) fn defect(context: &Context) -> Expression {
    let declared = context.declared;
    // Closed `let`s aren't compared.
    if !declared.lets.is_empty() {
        return declared.expression.clone();
    }
    let mut map = BTreeMap::from([(declared.step, context.symbol(declared.step).scaled(-Rational::ONE))]);
    let turned_back = |factor: usize| {
        let (f, inverse) = context.increment(factor);
        (inverse, f)
    };
    for (factor, one) in context.directions.factors.iter().enumerate() {
        let (inverse, f) = turned_back(factor);
        map.extend([(one.increment, inverse), (one.inverse, f)]);
    }
    for &[before, after] in declared.displacements.iter().flat_map(|both| &both.0) {
        map.extend([(before, context.symbol(after)), (after, context.symbol(before))]);
    }
    for &w in &declared.advected {
        map.insert(w.symbol, action::back(context, w, &turned_back, &context.symbol(w.symbol)));
    }
    declared.expression.clone().plus(context.substituted(&declared.expression, &map))
}
