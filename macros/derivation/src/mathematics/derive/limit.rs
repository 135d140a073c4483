//! The continuous Lagrangian that `l_d` discretises, `l_d(exp hξ, w) = h l(ξ, w) + O(h²)`.
//!
//! An expansion in powers of `h` at a fixed `F` is `l_d = h⁻¹ K(F) + S(F, w) + h U(F, w) + …`. Then
//! `l = ½ ξ·Jξ + s·ξ − V`, where `J` is the second derivative of `K` at `F = I`, `s` the momentum of `S` there, and
//! `V = −U(I, w)`. A nonzero first derivative of `K` at the identity would let momenta grow without bound as `h → 0`.
//! If `h` is under functions or has lower powers, `l` follows from a series along a motion.

use std::collections::BTreeMap;

use super::series::{LimitError, of_lagrangian};
use super::{Context, Continuous, Inverse, OfFactor, momentum_equation};
use crate::mathematics::symbolic::{
    Expression, Monomial, Rational, SymbolId, Variations, monomial_contains, substitute, variation,
};

/// The continuous Lagrangian of a discretisation, and pairs of its symbols with those of the discrete Lagrangian.
#[derive(Clone, Debug)]
pub struct ContinuousSource {
    pub continuous: Continuous,
    pub symbols: Vec<(SymbolId, SymbolId)>,
}

/// `J` (linear in `E_k` and `E_j`), `s` (linear in `E_k`) and `V`.
#[derive(Clone, Debug)]
pub struct Limit {
    /// Whether there is a term in `1/h` that depends on `F`; a potential has none, and can't move by itself.
    pub has_kinetic: bool,
    /// The first derivative of `K` at the identity (linear in `E_k`): zero for all values of the parameters if there is
    /// a limit.
    pub slope: Expression,
    pub inertia: Expression,
    pub bias: Expression,
    pub potential: Expression,
    /// `l(ξ, w)`, if an `l_d` was declared and it isn't quadratic in `ξ`: the other terms are its values at rest.
    pub lagrangian: Option<Expression>,
}

pub(super) fn limit(context: &Context, momentum: &Expression) -> Result<Limit, LimitError> {
    let discretised = context.declared.discretised.as_ref();
    if let Some(discretised) = discretised.filter(|one| one.continuous.inverse == Inverse::Nonlinear) {
        return Ok(at_rest(context, discretised));
    }
    let found = by_powers(context, momentum).map_or_else(|| along_motion(context), Ok);
    found.or_else(|error| discretised.map(|discretised| at_rest(context, discretised)).ok_or(error))
}

/// The limit by powers of `h`; `None` if `h` is under functions or its lowest power with `F` is below −1.
fn by_powers(context: &Context, momentum: &Expression) -> Option<Limit> {
    let (l_d, h) = (&context.declared.expression, context.declared.step);
    let is_too_low = |(monomial, _): (&Monomial, _)| {
        let mut increments = context.declared.increments.iter();
        monomial.exponent(h) < -1 && increments.any(|&increment| monomial_contains(monomial, increment))
    };
    if !context.declared.lets.is_empty() || l_d.contains_closed(h) || l_d.terms().any(is_too_low) {
        return None;
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
    Some(Limit { has_kinetic: !kinetic.is_zero(), slope, inertia, bias, potential, lagrangian: None })
}

/// The limit by a series in `h` along `F = exp(hξ̂)`: its coefficient of `h` is `l(ξ, w)`, of any degree in `ξ`.
fn along_motion(context: &Context) -> Result<Limit, LimitError> {
    let factors = &context.directions.factors;
    let series = of_lagrangian(context, context.directions.scratch)?;
    let advected = |value: &Expression| context.declared.advected.iter().any(|w| value.contains(w.symbol));
    let moves = |value: &Expression| factors.iter().any(|one| value.contains(one.velocity));
    if let Some((order, _)) = series.terms().find(|(order, value)| *order < 0 && moves(value)) {
        return Err(LimitError::TooSingular(order));
    }
    if series.terms().any(|(order, value)| order < 1 && advected(value)) {
        return Err(LimitError::NotALagrangian);
    }
    let along = |expression: &Expression, direction: &dyn Fn(usize) -> Expression| {
        let velocities = factors.iter().enumerate().map(|(factor, one)| (one.velocity, direction(factor)));
        variation(expression, &velocities.collect::<Variations>(), context.symbols)
    };
    let (first, second) = (&|factor| context.first(factor), &|factor| context.second(factor));
    let slope = along(&series.at(0), first);
    if moves(&slope) {
        return Err(LimitError::NotALagrangian);
    }
    let lagrangian = series.at(1);
    let momentum = along(&lagrangian, first);
    let hessian = along(&momentum, second);
    let zero = |one: &OfFactor| (one.velocity, Expression::zero(context.symbols.get(one.velocity).shape));
    let zeros: BTreeMap<SymbolId, Expression> = factors.iter().map(zero).collect();
    let at_rest = |expression: &Expression| context.substituted(expression, &zeros);
    Ok(Limit {
        has_kinetic: !hessian.is_zero(),
        slope,
        inertia: at_rest(&hessian),
        bias: at_rest(&momentum),
        potential: at_rest(&lagrangian).scaled(-Rational::ONE),
        lagrangian: moves(&hessian).then_some(lagrangian),
    })
}

/// The limit near rest: the Taylor polynomial of `l` of degree two in the velocity.
fn at_rest(context: &Context, ContinuousSource { continuous, symbols }: &ContinuousSource) -> Limit {
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
        lagrangian: None,
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
