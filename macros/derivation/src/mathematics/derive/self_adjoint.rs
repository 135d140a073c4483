//! Whether a Lagrangian is its own adjoint, `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)`: then a step of `−h` undoes a step of
//! `h`, and the order is even \[RDAE, section 1.4; Hairer, Lubich and Wanner, V.1\].

use std::collections::BTreeMap;

use super::{Context, action};
use crate::mathematics::symbolic::{Expression, Rational};

/// The self-adjointness of a Lagrangian, and its proof.
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

/// `l_d(F, w, h) + l_d(F⁻¹, F⁻¹·w, −h)`; terms that cancel by relations beyond the normal form remain.
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
    for &w in &declared.advected {
        map.insert(w.symbol, action::back(context, w, &turned_back, &context.symbol(w.symbol)));
    }
    declared.expression.clone().plus(context.substituted(&declared.expression, &map))
}
