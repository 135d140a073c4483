//! The momentum equation on SO(3) in Cayley coordinates with the denominators cleared.
//!
//! `F = cay(2y) = ((1 − |y|²) I + 2 yyᵀ + 2 ŷ) / (1 + |y|²)`. If `U(F, w)` is polynomial in `F`, multiplying
//! `U(F, w) − a` by a power of `D = 1 + |y|²` leaves a polynomial in `y`: for (3.13) a quadratic one. The factor `h/2`
//! reduces its coefficients to the moments of inertia.

use std::collections::BTreeMap;

use super::Context;
use crate::mathematics::symbolic::{Expression, Rational, SymbolId, Variations, degree, variation};

/// `(h/2) Dⁿ (U − a)`, linear in `E_k`, and its variation along `δy`.
#[derive(Clone, Debug)]
pub struct ClearedSystem {
    pub residual: Expression,
    pub jacobian: Expression,
    /// The power `n` of `D`.
    pub power: u32,
}

/// The limit on terms, beyond which the retracted form is surely cheaper and expanding would take long.
const MOST_TERMS: usize = 100;

pub(super) fn cleared(context: &Context, unknown: &Expression) -> Option<ClearedSystem> {
    let directions = context.directions;
    let &[factor] = directions.factors.as_slice() else { return None };
    if !context.declared.group.is_so3
        || unknown.contains_closed(factor.increment)
        || terms_in_coordinates(factor.increment, unknown) > MOST_TERMS
    {
        return None;
    }
    let integer = |n| Expression::rational(Rational::integer(n));
    let y = context.symbol(directions.coordinates);
    let d = context.symbol(directions.denominator);
    // 1 − |y|² = 2 − D.
    let scalar_part = context.product(&integer(2).minus(d.clone()), &Expression::identity(3));
    let outer = context.product(&y, &y.transpose(context.symbols)).scaled(Rational::integer(2));
    let numerator = scalar_part.plus(outer).plus(y.hat(context.symbols).scaled(Rational::integer(2)));
    let cayley = context.product(&d.clone().power(-1, context.symbols), &numerator);
    let map = BTreeMap::from([(factor.increment, cayley)]);
    let in_coordinates = context.product(&context.half_step(), &context.substituted(unknown, &map));
    // ⟨a, E⟩ = −½ tr(E â), where the symbol `a` is (h/2) a.
    let direction = context.symbol(factor.first);
    let target_hat = context.symbol(directions.target).hat(context.symbols);
    let target = context.product(&direction, &target_hat).trace(context.symbols).scaled(Rational::new(-1, 2));
    let difference = in_coordinates.minus(target);
    let lowest = difference.terms().map(|(monomial, _)| monomial.exponent(directions.denominator)).min()?;
    let power = lowest.min(0).saturating_neg();
    let residual = context.product(&d.power(power, context.symbols), &difference);
    let delta = context.symbol(directions.coordinate_direction);
    let delta_d = context.product(&y.transpose(context.symbols), &delta).scaled(Rational::integer(2));
    let variations = Variations::from([(directions.coordinates, delta), (directions.denominator, delta_d)]);
    let jacobian = variation(&residual, &variations, context.symbols);
    Some(ClearedSystem { residual, jacobian, power: power.unsigned_abs() })
}

/// The number of terms once each `F` becomes the four terms of `(2/D − 1) I + (2 yyᵀ + 2 ŷ)/D`.
fn terms_in_coordinates(increment: SymbolId, unknown: &Expression) -> usize {
    let terms = unknown.terms().map(|(monomial, _)| {
        let factors = u32::try_from(degree(monomial, increment)).unwrap_or(u32::MAX);
        4_usize.saturating_pow(factors)
    });
    terms.fold(0, usize::saturating_add)
}
