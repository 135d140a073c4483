//! The step in the transport form `μ⁺ = Ad*_F (μ + δl_d/δw ⋄ w)`, which conserves the Casimirs at any Newton tolerance.
//!
//! The parts of the diamond and of `μ` that don't depend on `F`, and aren't of the order of `1/h`, are computed once a
//! step: with `diamond = k_0(w) + k_1(F, w)` and `μ = U − k_0` with all of `F` in `U`, one solves `U(F, w) = a` for
//! `a = μ + k_0(w)`, and
//!
//! ```text
//! μ⁺ = Ad*_F a + Ad*_F k_1,      ⟨Ad*_F k_1, E⟩ = ⟨k_1, F E F⁻¹⟩,     w = F·w⁺
//! ```
//!
//! The second part is written in `w⁺`. For a potential of the new position it has no `F` then: `FᵀF = I` cancels it.

use std::collections::BTreeMap;

use super::{Context, action};
use crate::mathematics::symbolic::{Expression, Monomial, Stage, SymbolId, degree, stage_of_monomial};

pub(super) struct Parts {
    pub(super) kick_before: Expression,
    pub(super) unknown: Expression,
    pub(super) kick_after: Expression,
}

pub(super) fn parts(context: &Context, momentum: &Expression, diamond: &Expression) -> Parts {
    // Terms in 1/h without `F` cancel those with `F` at the identity: in `a` they would leave a rounding error of the
    // order of 1/h in the momentum.
    let unknown = momentum.filtered(|monomial| {
        stage_of_monomial(monomial, context.symbols) == Stage::Iteration || monomial.exponent(context.declared.step) < 0
    });
    let kick_before = unknown.clone().minus(momentum.clone());
    let moved = diamond.clone().minus(kick_before.clone());
    let mut map: BTreeMap<SymbolId, Expression> = previous(context).into_iter().collect();
    // A translation commutes with all others: there `F E F⁻¹` is `E`.
    let turning = context.directions.factors.iter().enumerate().filter(|(factor, _)| !context.is_added(*factor));
    for (factor, one) in turning {
        let (f, inverse) = context.increment(factor);
        map.insert(one.first, context.product(&context.product(&f, &context.first(factor)), &inverse));
    }
    let kick_after = context.substituted(&moved, &map);
    Parts { kick_before, unknown, kick_after }
}

/// `w = F·w⁺`.
pub(super) fn previous(context: &Context) -> Vec<(SymbolId, Expression)> {
    let pairs = context.declared.advected.iter().zip(&context.directions.next);
    let increment = |factor| context.increment(factor);
    pairs.map(|(&w, &next)| (w.symbol, action::back(context, w, &increment, &context.symbol(next)))).collect()
}

/// The two sides of the flow on increments: `μ(F⁺, w⁺)`, and the momentum after a step in `F` and `w⁺`.
pub(super) fn increments(context: &Context, momentum: &Expression, left: &Expression) -> [Expression; 2] {
    let (symbols, directions) = (context.symbols, context.directions);
    let mut map = BTreeMap::new();
    for (factor, one) in directions.factors.iter().enumerate() {
        let next = one.next_increment;
        map.insert(one.increment, context.symbol(next));
        if !context.is_added(factor) {
            map.insert(one.inverse, Expression::inverse(next, symbols));
        }
    }
    let carried = context.declared.advected.iter().zip(&directions.next);
    map.extend(carried.map(|(w, &next)| (w.symbol, context.symbol(next))));
    let after = context.substituted(left, &previous(context).into_iter().collect());
    [context.substituted(momentum, &map), after]
}

/// The kick with its terms in `1/h` written in `D`: they cancel at the identity, and would leave a rounding error of
/// that order.
pub(super) fn with_small_increment(context: &Context, kick: &Expression) -> Expression {
    let is_large = |monomial: &Monomial| monomial.exponent(context.declared.step) < 0;
    if !context.declared.group.rotates() {
        return kick.clone();
    }
    kick.filtered(|monomial| !is_large(monomial)).plus(in_small_increment(context, &kick.filtered(is_large)))
}

/// The expression with `F = I + D` and `F⁻¹ = I + D⁻`; unchanged if that would multiply its terms.
pub(super) fn in_small_increment(context: &Context, unknown: &Expression) -> Expression {
    let factors = context.directions.factors.iter().enumerate();
    let turning: Vec<_> = factors.filter(|(factor, _)| !context.is_added(*factor)).map(|(_, one)| one).collect();
    // Each F becomes the two terms I + D.
    let factors = |monomial| {
        let degrees = turning.iter().map(|one| degree(monomial, one.increment));
        u32::try_from(degrees.sum::<usize>()).unwrap_or(u32::MAX)
    };
    let terms = unknown.terms().map(|(monomial, _)| 2_usize.saturating_pow(factors(monomial)));
    if terms.fold(0, usize::saturating_add) > 4 * unknown.len() + 16 {
        return unknown.clone();
    }
    let near_identity = |small| {
        let symbol = context.symbol(small);
        Expression::identity(symbol.shape().0).plus(symbol)
    };
    let map = turning
        .iter()
        .flat_map(|one| [(one.increment, near_identity(one.small)), (one.inverse, near_identity(one.small_inverse))]);
    let map = map.collect();
    context.substituted(unknown, &map)
}
