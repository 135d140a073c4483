//! Derivatives through closed `let`s, by Lagrange multipliers.
//!
//! A Lagrangian that is too large when multiplied out is `l_d(v, F, w)` with `v_i = d_i(v_1 … v_{i−1}, F, w)` for its
//! `let`s. With a multiplier for each,
//!
//! ```text
//! L = l_d + Σ ⟨λ_i, d_i⟩,      ⟨λ_i, δv_i⟩ = δL along δv_i,      from the last to the first
//! ```
//!
//! the first variation of `l_d` is that of `L` with `v` and `λ` fixed, so that all momentum maps follow from the usual
//! rules. This is differentiation in the reverse mode: a gradient costs a few evaluations. The second variation goes
//! through `v` and `λ` as well, in the forward mode.
//!
//! Virtual work isn't differentiated to give a force: its `let`s have no multipliers.

use super::Context;
use super::transport::in_small_increment;
use crate::mathematics::symbolic::{Expression, Stage, Structure, SymbolId, Symbols, Variations, stage_of, variation};

/// A `let` that isn't multiplied out.
#[derive(Clone, Debug)]
pub struct Let {
    /// The symbol `v` of the `let`.
    pub symbol: SymbolId,
    /// The defining expression `d` of the `let`.
    pub value: Expression,
}

/// A closed `let` with its derivatives.
#[derive(Clone, Debug)]
pub struct ClosedLet {
    pub symbol: SymbolId,
    pub value: Expression,
    /// The variation `δv` of the `let`'s symbol.
    pub direction: SymbolId,
    /// `λ`, and `⟨λ, δv⟩`.
    pub multiplier: SymbolId,
    pub pairing: Expression,
    /// The pairing by `D = F − I`, if its constants cancel in this form.
    pub near: Expression,
    /// `v` and `⟨λ, δv⟩` varied along `F ↦ exp(t E_j) F`.
    pub tangent: (SymbolId, Expression),
    pub multiplier_tangent: (SymbolId, Expression),
}

/// The symbols that each `let` adds, with multipliers of zero.
pub(super) fn without_multipliers(lets: &[Let], symbols: &mut Symbols) -> Vec<ClosedLet> {
    let mut closed = Vec::new();
    for Let { symbol, value } in lets {
        let (name, shape, stage) = {
            let symbol = symbols.get(*symbol);
            (symbol.name.clone(), symbol.shape, symbol.stage)
        };
        // A direction is no value of a step: a multiplier is known as early as what it is multiplied with.
        let direction = symbols.add(format!("δ{name}"), shape, Structure::General, Stage::Construction);
        let mut add = |prefix: &str| symbols.add(format!("{prefix}{name}"), shape, Structure::General, stage);
        let multiplier = add("λ_");
        let (tangent, multiplier_tangent) = (add("∂"), add("∂λ_"));
        let zero = || Expression::zero((1, 1));
        closed.push(ClosedLet {
            symbol: *symbol,
            value: value.clone(),
            direction,
            multiplier,
            pairing: zero(),
            near: zero(),
            tangent: (tangent, Expression::zero(shape)),
            multiplier_tangent: (multiplier_tangent, zero()),
        });
    }
    closed
}

/// The symbols that each `let` adds, and the Lagrangian `L` with multipliers.
pub(super) fn multipliers(lets: &[Let], l_d: &Expression, symbols: &mut Symbols) -> (Vec<ClosedLet>, Expression) {
    let mut closed = without_multipliers(lets, symbols);
    let mut lagrangian = l_d.clone();
    for one in closed.iter_mut().rev() {
        let along = Variations::from([(one.symbol, Expression::symbol(one.direction, symbols))]);
        one.pairing = variation(&lagrangian, &along, symbols);
        symbols.set_stage(one.multiplier, stage_of(&one.pairing, symbols));
        let multiplier = Expression::symbol(one.multiplier, symbols).transpose(symbols);
        lagrangian = lagrangian.plus(multiplier.times(&one.value, symbols).trace(symbols));
    }
    (closed, lagrangian)
}

/// Sets the variations of `let`s and multipliers along `E_j F`.
pub(super) fn tangents(context: &Context, closed: &mut [ClosedLet]) {
    let mut varied = forwards(context, &[]);
    for one in closed.iter_mut() {
        one.tangent.1 = variation(&one.value, &varied, context.symbols);
        if !one.tangent.1.is_zero() {
            varied.insert(one.symbol, context.symbol(one.tangent.0));
        }
    }
    for one in closed.iter_mut().rev() {
        one.multiplier_tangent.1 = variation(&one.pairing, &varied, context.symbols);
        if !one.multiplier_tangent.1.is_zero() {
            varied.insert(one.multiplier, context.symbol(one.multiplier_tangent.0));
        }
        let near = in_small_increment(context, &one.pairing);
        one.near = if near.len() < one.pairing.len() { near } else { one.pairing.clone() };
    }
}

/// The variation `δF = E_j F`, and those of `let`s and multipliers that follow.
pub(super) fn forwards(context: &Context, closed: &[ClosedLet]) -> Variations {
    let increments = context.declared.increments.iter().enumerate();
    let mut variations: Variations =
        increments.map(|(factor, &increment)| (increment, context.turned(factor, &context.second(factor)))).collect();
    for one in closed {
        let (tangent, multiplier_tangent) = (&one.tangent, &one.multiplier_tangent);
        if !tangent.1.is_zero() {
            variations.insert(one.symbol, context.symbol(tangent.0));
        }
        if !multiplier_tangent.1.is_zero() {
            variations.insert(one.multiplier, context.symbol(multiplier_tangent.0));
        }
    }
    variations
}
