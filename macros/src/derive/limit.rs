//! The continuous Lagrangian that `l_d` discretises, `l_d(exp hξ, w) = h (½ ξ·Jξ + s·ξ − V) + O(h²)`.
//!
//! By powers of `h` with `F` held fixed: `l_d = h⁻¹ K(F) + S(F, w) + h U(F, w) + …`. Then `J` is the second derivative
//! of `K` at `F = I`, `s` the momentum of `S` there, and `V = −U(I, w)`. A first derivative of `K` at the identity
//! would let momenta grow without bound as `h → 0`.

use std::collections::BTreeMap;

use super::series::Expansion;
use super::{Context, momentum_equation};
use crate::symbolic::{Expression, Rational, SymbolId, Variations, degree, variation};

/// `J` (linear in `E_k` and `E_j`), `s` (linear in `E_k`) and `V`.
#[derive(Clone, Debug)]
pub(crate) struct Limit {
    pub(crate) inertia: Expression,
    pub(crate) bias: Expression,
    pub(crate) potential: Expression,
}

/// Why there is no continuous Lagrangian behind `l_d`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LimitError {
    /// `h` stands under a function or in a sum that is divided by.
    StepInsideFunction,
    /// A power of `h` below −1.
    TooSingular(i32),
    /// No term in `1/h` depends on `F`.
    NoKineticTerm,
    /// The kinetic term isn't stationary at the identity.
    NotStationary,
    /// The limit isn't `½ ξ·Jξ + s·ξ − V`.
    NotALagrangian,
    /// The limit has too many terms.
    TooLarge,
}

pub(super) fn limit(context: &Context, momentum: &Expression) -> Result<Limit, LimitError> {
    if !context.declared.lets.is_empty() {
        return through_lets(context);
    }
    let (l_d, h) = (&context.declared.l_d, context.declared.step);
    if l_d.contains_closed(h) {
        return Err(LimitError::StepInsideFunction);
    }
    let lowest = l_d.terms().filter(|(m, _)| crate::symbolic::monomial_contains(m, context.declared.increment));
    if let Some(power) = lowest.map(|(monomial, _)| monomial.exponent(h)).min().filter(|&power| power < -1) {
        return Err(LimitError::TooSingular(power));
    }
    let kinetic = of_order(momentum, h, -1);
    if kinetic.is_zero() {
        return Err(LimitError::NoKineticTerm);
    }
    if !at_identity(context, &kinetic).is_zero() {
        return Err(LimitError::NotStationary);
    }
    let step = context.symbol(h);
    let second = momentum_equation::jacobian(context, &kinetic, &[]);
    let inertia = context.product(&at_identity(context, &second), &step);
    let bias = at_identity(context, &of_order(momentum, h, 0));
    let inverse_step = step.power(-1, context.symbols);
    let potential = context.product(&at_identity(context, &of_order(l_d, h, 1)), &inverse_step);
    Ok(Limit { inertia, bias, potential: potential.scaled(-Rational::ONE) })
}

/// As a series in `h` along `F = exp(hξ̂)`, where `let`s hide the powers of `h`.
fn through_lets(context: &Context) -> Result<Limit, LimitError> {
    let velocity = context.directions.velocity;
    let series = Expansion::new(context, velocity, context.directions.scratch)?.of(&context.declared.l_d)?;
    if series.end() < 2 {
        return Err(LimitError::NotALagrangian);
    }
    let advected = |value: &Expression| context.declared.advected.iter().any(|&(w, _)| value.contains(w));
    for (order, value) in series.terms().filter(|&(order, _)| order < 1) {
        if value.contains(velocity) {
            return Err(if order < 0 { LimitError::TooSingular(order) } else { LimitError::NotStationary });
        }
        if advected(value) {
            return Err(LimitError::NotALagrangian);
        }
    }
    let zero = Expression::zero((1, 1));
    let lagrangian = series.terms().find(|&(order, _)| order == 1).map_or(zero, |(_, value)| value.clone());
    let of_degree = |n| lagrangian.filtered(|monomial| degree(monomial, velocity) == n);
    let (kinetic, linear, rest) = (of_degree(2), of_degree(1), of_degree(0));
    let parts = kinetic.clone().plus(linear.clone()).plus(rest.clone());
    if lagrangian.contains_closed(velocity) || parts != lagrangian {
        return Err(LimitError::NotALagrangian);
    }
    if kinetic.is_zero() {
        return Err(LimitError::NoKineticTerm);
    }
    let along = |expression: &Expression, direction| {
        let variations = Variations::from([(velocity, context.symbol(direction))]);
        variation(expression, &variations, context.symbols)
    };
    let (first, second) = (context.directions.first, context.directions.second);
    let inertia = along(&along(&kinetic, first), second);
    Ok(Limit { inertia, bias: along(&linear, first), potential: rest.scaled(-Rational::ONE) })
}

fn of_order(expression: &Expression, h: SymbolId, order: i32) -> Expression {
    expression.filtered(|monomial| monomial.exponent(h) == order)
}

fn at_identity(context: &Context, expression: &Expression) -> Expression {
    let map = BTreeMap::from([(context.declared.increment, Expression::identity(context.declared.group.size))]);
    context.substituted(expression, &map)
}
