//! The continuous Lagrangian that `l_d` discretises, `l_d(exp hξ, w) = h (½ ξ·Jξ + s·ξ − V) + O(h²)`.
//!
//! By powers of `h` with `F` held fixed: `l_d = h⁻¹ K(F) + S(F, w) + h U(F, w) + …`. Then `J` is the second derivative
//! of `K` at `F = I`, `s` the momentum of `S` there, and `V = −U(I, w)`. A first derivative of `K` at the identity
//! would let momenta grow without bound as `h → 0`.

use std::collections::BTreeMap;

use super::{Context, momentum_equation};
use crate::symbolic::{Expression, SymbolId};

/// `J` (linear in `E_k` and `E_j`), `s` (linear in `E_k`) and `V`.
#[derive(Clone, Debug)]
pub(crate) struct Limit {
    /// Whether there is a term in `1/h` that depends on `F`; a potential has none, and can't move by itself.
    pub(crate) has_kinetic: bool,
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
    /// The kinetic term isn't stationary at the identity.
    NotStationary,
}

pub(super) fn limit(context: &Context, momentum: &Expression) -> Result<Limit, LimitError> {
    let (l_d, h) = (&context.declared.l_d, context.declared.step);
    if l_d.contains_closed(h) {
        return Err(LimitError::StepInsideFunction);
    }
    let lowest = l_d.terms().filter(|(m, _)| crate::symbolic::monomial_contains(m, context.declared.increment));
    if let Some(power) = lowest.map(|(monomial, _)| monomial.exponent(h)).min().filter(|&power| power < -1) {
        return Err(LimitError::TooSingular(power));
    }
    let kinetic = of_order(momentum, h, -1);
    if !at_identity(context, &kinetic).is_zero() {
        return Err(LimitError::NotStationary);
    }
    let step = context.symbol(h);
    let second = momentum_equation::jacobian(context, &kinetic);
    let inertia = context.product(&at_identity(context, &second), &step);
    let bias = at_identity(context, &of_order(momentum, h, 0));
    let inverse_step = step.power(-1, context.symbols);
    let potential = context.product(&at_identity(context, &of_order(l_d, h, 1)), &inverse_step);
    Ok(Limit {
        has_kinetic: !kinetic.is_zero(),
        inertia,
        bias,
        potential: potential.scaled(-crate::symbolic::Rational::ONE),
    })
}

fn of_order(expression: &Expression, h: SymbolId, order: i32) -> Expression {
    expression.filtered(|monomial| monomial.exponent(h) == order)
}

fn at_identity(context: &Context, expression: &Expression) -> Expression {
    let map = BTreeMap::from([(context.declared.increment, Expression::identity(context.declared.group.size))]);
    context.substituted(expression, &map)
}
