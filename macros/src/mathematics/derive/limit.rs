//! The continuous Lagrangian that `l_d` discretises, `l_d(exp hξ, w) = h (½ ξ·Jξ + s·ξ − V) + O(h²)`.
//!
//! By powers of `h` with `F` held fixed: `l_d = h⁻¹ K(F) + S(F, w) + h U(F, w) + …`. Then `J` is the second derivative
//! of `K` at `F = I`, `s` the momentum of `S` there, and `V = −U(I, w)`. A first derivative of `K` at the identity
//! would let momenta grow without bound as `h → 0`.

use std::collections::BTreeMap;

use super::series::{Expansion, LimitError};
use super::{Context, Continuous, momentum_equation};
use crate::mathematics::symbolic::{
    Expression, Monomial, Rational, SymbolId, Variations, degree, substitute, variation,
};

/// A continuous Lagrangian that isn't quadratic in the velocity, and which of its symbols stand for which of the
/// discrete one that is made of it.
#[derive(Clone, Debug)]
pub(crate) struct Discretised {
    pub(crate) continuous: Continuous,
    pub(crate) symbols: Vec<(SymbolId, SymbolId)>,
}

/// `J` (linear in `E_k` and `E_j`), `s` (linear in `E_k`) and `V`.
#[derive(Clone, Debug)]
pub(crate) struct Limit {
    /// Whether there is a term in `1/h` that depends on `F`; a potential has none, and can't move by itself.
    pub(crate) has_kinetic: bool,
    /// The first derivative of `K` at the identity (linear in `E_k`): zero for all values of the parameters if there is
    /// a limit.
    pub(crate) slope: Expression,
    pub(crate) inertia: Expression,
    pub(crate) bias: Expression,
    pub(crate) potential: Expression,
}

pub(super) fn limit(context: &Context, momentum: &Expression) -> Result<Limit, LimitError> {
    if let Some(discretised) = &context.declared.discretised {
        return Ok(at_rest(context, discretised));
    }
    if !context.declared.lets.is_empty() {
        return through_lets(context);
    }
    let (l_d, h) = (&context.declared.expression, context.declared.step);
    if l_d.contains_closed(h) {
        return Err(LimitError::StepInsideFunction);
    }
    let moves = |monomial| {
        let mut increments = context.declared.increments.iter();
        increments.any(|&increment| crate::mathematics::symbolic::monomial_contains(monomial, increment))
    };
    let lowest = l_d.terms().filter(|(m, _)| moves(m));
    if let Some(power) = lowest.map(|(monomial, _)| monomial.exponent(h)).min().filter(|&power| power < -1) {
        return Err(LimitError::TooSingular(power));
    }
    let kinetic = of_order(momentum, h, -1);
    let step = context.symbol(h);
    let second = momentum_equation::jacobian(context, &kinetic, &[]);
    let inertia = context.product(&at_identity(context, &second), &step);
    let bias = at_identity(context, &of_order(momentum, h, 0));
    let inverse_step = step.power(-1, context.symbols);
    let potential = context.product(&at_identity(context, &of_order(l_d, h, 1)), &inverse_step);
    let slope = at_identity(context, &kinetic);
    let potential = potential.scaled(-Rational::ONE);
    Ok(Limit { has_kinetic: !kinetic.is_zero(), slope, inertia, bias, potential })
}

/// As a series in `h` along `F = exp(hξ̂)`, where `let`s hide the powers of `h`.
fn through_lets(context: &Context) -> Result<Limit, LimitError> {
    let factors = &context.directions.factors;
    let series = Expansion::new(context, context.directions.scratch)?.of(&context.declared.expression)?;
    if series.end() < 2 {
        return Err(LimitError::NotALagrangian);
    }
    let advected = |value: &Expression| context.declared.advected.iter().any(|w| value.contains(w.symbol));
    let moves = |value: &Expression| factors.iter().any(|one| value.contains(one.velocity));
    if let Some((order, _)) = series.terms().find(|(order, value)| *order < 0 && moves(value)) {
        return Err(LimitError::TooSingular(order));
    }
    if series.terms().any(|(order, value)| order < 1 && advected(value)) {
        return Err(LimitError::NotALagrangian);
    }
    // By powers of the velocity: there must be nothing but none, one or two of them.
    let by_degree = |order: i32| {
        let zero = Expression::zero((1, 1));
        let coefficient = series.terms().find(|&(at, _)| at == order).map_or(zero, |(_, value)| value.clone());
        let parts = [0, 1, 2].map(|n| {
            let degree = |monomial: &Monomial| factors.iter().map(|one| degree(monomial, one.velocity)).sum::<usize>();
            coefficient.filtered(|monomial| degree(monomial) == n)
        });
        let all = parts.iter().cloned().fold(Expression::zero((1, 1)), Expression::plus);
        if factors.iter().any(|one| coefficient.contains_closed(one.velocity)) || all != coefficient {
            return Err(LimitError::NotALagrangian);
        }
        Ok(parts)
    };
    let [_, slope, curvature] = by_degree(0)?;
    let [rest, linear, kinetic] = by_degree(1)?;
    if !curvature.is_zero() {
        return Err(LimitError::NotALagrangian);
    }
    let along = |expression: &Expression, direction: &dyn Fn(usize) -> Expression| {
        let velocities = factors.iter().enumerate().map(|(factor, one)| (one.velocity, direction(factor)));
        variation(expression, &velocities.collect::<Variations>(), context.symbols)
    };
    let (first, second) = (&|factor| context.first(factor), &|factor| context.second(factor));
    let inertia = along(&along(&kinetic, first), second);
    let (slope, bias) = (along(&slope, first), along(&linear, first));
    Ok(Limit { has_kinetic: !kinetic.is_zero(), slope, inertia, bias, potential: rest.scaled(-Rational::ONE) })
}

/// What is left of `l` near rest: its Taylor polynomial of degree two in the velocity.
fn at_rest(context: &Context, Discretised { continuous, symbols }: &Discretised) -> Limit {
    let mut map: BTreeMap<SymbolId, Expression> =
        symbols.iter().map(|&(from, to)| (from, context.symbol(to))).collect();
    for (factor, directions) in continuous.directions.iter().enumerate() {
        for (direction, image) in directions.iter().zip([context.first(factor), context.second(factor)]) {
            let is_added = context.is_added(factor);
            let components = if is_added { image.clone() } else { context.components_of(factor, &image) };
            map.insert(direction.components, components);
            map.extend(direction.matrix.map(|matrix| (matrix, image)));
        }
    }
    let here = |expression: &Expression| substitute(&continuous.at_rest(expression), &map, context.symbols);
    Limit {
        has_kinetic: continuous.has_kinetic(),
        slope: Expression::zero((1, 1)),
        inertia: here(&continuous.hessian),
        bias: here(&continuous.momentum),
        potential: here(&continuous.lagrangian).scaled(-Rational::ONE),
    }
}

fn of_order(expression: &Expression, h: SymbolId, order: i32) -> Expression {
    expression.filtered(|monomial| monomial.exponent(h) == order)
}

fn at_identity(context: &Context, expression: &Expression) -> Expression {
    let map = context.directions.factors.iter().enumerate().flat_map(|(factor, one)| {
        let shape = context.symbol(one.increment).shape();
        let identity = if context.is_added(factor) { Expression::zero(shape) } else { Expression::identity(shape.0) };
        [one.increment, one.inverse].map(|id| (id, identity.clone()))
    });
    let map: BTreeMap<SymbolId, Expression> = map.collect();
    context.substituted(expression, &map)
}
