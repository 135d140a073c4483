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

use crate::mathematics::symbolic::{Expression, Rational, Symbols, Variance};

/// `E·w`.
pub(super) fn infinitesimal(symbols: &Symbols, variance: Variance, e: &Expression, w: &Expression) -> Expression {
    let transposed = e.transpose(symbols);
    let from_left = |matrix: &Expression| matrix.times(w, symbols);
    let from_right = |matrix: &Expression| w.times(matrix, symbols);
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
    symbols: &Symbols,
    variance: Variance,
    (f, inverse): (&Expression, &Expression),
    next: &Expression,
) -> Expression {
    let product = |factors: [&Expression; 3]| factors[0].times(factors[1], symbols).times(factors[2], symbols);
    let (f_t, inverse_t) = (f.transpose(symbols), inverse.transpose(symbols));
    match variance {
        Variance::Vector => f.times(next, symbols),
        Variance::Covector => inverse_t.times(next, symbols),
        Variance::Contravariant => product([f, next, &f_t]),
        Variance::Covariant => product([&inverse_t, next, inverse]),
        Variance::Mixed => product([f, next, inverse]),
        Variance::Fixed => next.clone(),
    }
}
