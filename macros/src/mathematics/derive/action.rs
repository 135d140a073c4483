//! The action of the group on the advected parameters, with `E` in the algebra and `F` in the group.
//!
//! ```text
//!            E·w               w in terms of w⁺ = F⁻¹·w
//! V          E w               F w⁺
//! V*        −Eᵀ w              F⁻ᵀ w⁺
//! V ⊗ V      E S + S Eᵀ        F S⁺ Fᵀ
//! V* ⊗ V*   −Eᵀ S − S E        F⁻ᵀ S⁺ F⁻¹
//! V ⊗ V*     E S − S E         F S⁺ F⁻¹
//! given      0                 w⁺
//! ```

use super::Context;
use crate::mathematics::symbolic::{Expression, Rational, Variance};

/// `E·w`.
pub(super) fn infinitesimal(context: &Context, variance: Variance, e: &Expression, w: &Expression) -> Expression {
    let transposed = e.transpose(context.symbols);
    let from_left = |matrix: &Expression| context.product(matrix, w);
    let from_right = |matrix: &Expression| context.product(w, matrix);
    let minus = |expression: Expression| expression.scaled(-Rational::ONE);
    match variance {
        Variance::Vector => from_left(e),
        Variance::Covector => minus(from_left(&transposed)),
        Variance::Contravariant => from_left(e).plus(from_right(&transposed)),
        Variance::Covariant => minus(from_left(&transposed).plus(from_right(e))),
        Variance::Mixed => from_left(e).minus(from_right(e)),
        Variance::Fixed => Expression::zero(w.shape()),
    }
}

/// `F·w⁺`, with `F` and its inverse.
pub(super) fn moved_back(
    context: &Context,
    variance: Variance,
    (f, inverse): (&Expression, &Expression),
    next: &Expression,
) -> Expression {
    let product = |factors: [&Expression; 3]| context.product(&context.product(factors[0], factors[1]), factors[2]);
    let (f_t, inverse_t) = (f.transpose(context.symbols), inverse.transpose(context.symbols));
    match variance {
        Variance::Vector => context.product(f, next),
        Variance::Covector => context.product(&inverse_t, next),
        Variance::Contravariant => product([f, next, &f_t]),
        Variance::Covariant => product([&inverse_t, next, inverse]),
        Variance::Mixed => product([f, next, inverse]),
        Variance::Fixed => next.clone(),
    }
}
