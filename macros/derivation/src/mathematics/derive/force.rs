//! Forces, by the discrete Lagrange–d'Alembert principle.
//!
//! A force is declared by its virtual work in a step, `δW = f⁻(F, w)·η + f⁺(F, w)·η⁺`, with the displacements of the
//! body at the beginning and at the end of the step, in its own axes there. It changes the momentum equation (2.7) to
//! `μ = U − k_0 − f⁻` and (2.6) to `μ⁺ = (L_F)* δl_d/δF + f⁺`. With the parts of `f⁻` without and with `F` that is
//!
//! ```text
//! a = μ + f⁻_0(w)      U(F, w) − f⁻_1(F, w) = a      μ⁺ = Ad*_F a + Ad*_F f⁻_1(F, w) + f⁺(F, w),    w = F·w⁺
//! ```
//!
//! so it has the stages of any effect, and a part of the Newton Jacobian.

use super::{
    Context, DeclaredFunction, Derivation, Limit, cayley, closed, directions, momentum_equation, self_adjoint,
    transport,
};
use crate::mathematics::symbolic::{Expression, Rational, SymbolId};

/// The reason why the virtual work defines no force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceError {
    /// The work isn't linear in the displacements.
    NotLinear,
}

/// The displacements `η` and `η⁺` of each factor of the group.
#[derive(Clone, Debug)]
pub struct Displacements(pub Vec<[SymbolId; 2]>);

/// The terms derived from the virtual work; those of a Lagrangian alone are zero.
pub(super) fn force(
    declared: &DeclaredFunction,
    Displacements(displacements): &Displacements,
) -> Result<Derivation, ForceError> {
    let mut symbols = declared.symbols.clone();
    let directions = directions(declared, &mut symbols);
    let mut closed = closed::without_multipliers(&declared.lets, &mut symbols);
    let context = Context { declared, lagrangian: &declared.expression, symbols: &symbols, directions: &directions };
    let direction = |factor| match context.first(factor) {
        e if context.is_added(factor) => e,
        e => context.components_of(factor, &e),
    };
    let work = |before: i128, after: i128| {
        let of_factor = |(factor, ids): (usize, &[SymbolId; 2])| {
            let along = |times| direction(factor).scaled(Rational::integer(times));
            [(ids[0], along(before)), (ids[1], along(after))]
        };
        let map = displacements.iter().enumerate().flat_map(of_factor).collect();
        context.substituted(&declared.expression, &map)
    };
    let (before, after) = (work(1, 0), work(0, 1));
    // The work of `t` times both displacements is `t` times the sum of their single works: powers and products of
    // displacements fail.
    let is_linear = |factor: i128| {
        let both = before.clone().plus(after.clone()).scaled(Rational::integer(factor));
        work(factor, factor).minus(both).is_zero()
    };
    if ![0, 1, 2, 3].into_iter().all(is_linear) {
        return Err(ForceError::NotLinear);
    }
    closed::tangents(&context, &mut closed);
    let adjoint_defect = self_adjoint::defect(&context);
    let momentum = before.clone().scaled(-Rational::ONE);
    let jacobian = momentum_equation::jacobian(&context, &momentum, &closed);
    let parts = transport::parts(&context, &momentum, &before);
    let cleared = if closed.is_empty() { cayley::cleared(&context, &parts.unknown) } else { None };
    let ends = context.ends(&closed, [&momentum, &after]);
    let after = context.substituted(&after, &transport::previous(&context).into_iter().collect());
    let kick_after = parts.kick_after.plus(after);
    let unknown =
        if closed.is_empty() { transport::in_small_increment(&context, &parts.unknown) } else { parts.unknown };
    let none = || Expression::zero((1, 1));
    Ok(Derivation {
        group: declared.group.clone(),
        right_momentum: none(),
        left_momentum: none(),
        diamond: before,
        shares: Vec::new(),
        momentum,
        jacobian,
        energy: none(),
        adjoint_defect,
        flow: None,
        closed,
        previous: transport::previous(&context),
        limit: Limit {
            has_kinetic: false,
            slope: none(),
            inertia: none(),
            bias: none(),
            potential: none(),
            lagrangian: None,
        },
        kick_before: parts.kick_before,
        kick_derivative: None,
        unknown,
        kick_after: transport::with_small_increment(&context, &kick_after),
        shown_kick_after: kick_after,
        half_step: context.half_step(),
        cleared,
        ends,
        directions,
        symbols,
    })
}
