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
//!
//! Among several bodies, with `E_a` in the algebra of the factor `a`:
//!
//! ```text
//! seen from a           as above, with E_a and F_a
//! b relative to a       E_a Q − Q E_b           F_a Q⁺ F_b⁻¹
//! b in space            −R E_b                  R⁺ F_b⁻¹
//! ```
//!
//! Translations `d` are added. With elements `e` of their algebra:
//!
//! ```text
//! b relative to a       e_a − e_b               r⁺ + d_a − d_b
//! b in space            −e_b                    x⁺ − d_b
//! ```

use super::Context;
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Expression, Rational, SymbolId, Symbols, Variance};

/// An advected parameter, and the action of the group on it.
#[derive(Clone, Copy, Debug)]
pub struct AdvectedSymbol {
    pub symbol: SymbolId,
    pub variance: Variance,
    pub seen: View,
}

/// The factors of the group that move a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// A single factor, by the variance.
    From(usize),
    /// The configuration of a factor relative to another.
    Relative { of: usize, from: usize },
    /// The configuration of a factor in space.
    Configuration(usize),
}

impl View {
    /// Whether the parameter is a configuration.
    pub fn is_configuration(self) -> bool {
        matches!(self, Self::Relative { .. } | Self::Configuration(_))
    }
}

/// `E·w`, with an element of the algebra for each factor.
pub(super) fn along(
    (group, symbols): (&Group, &Symbols),
    carried: AdvectedSymbol,
    e: &dyn Fn(usize) -> Expression,
) -> Expression {
    let w = Expression::symbol(carried.symbol, symbols);
    match carried.seen {
        View::Relative { of, from } if group.factor(of).is_added => e(from).minus(e(of)),
        View::Configuration(of) if group.factor(of).is_added => e(of).scaled(-Rational::ONE),
        View::From(factor) => infinitesimal(symbols, carried.variance, &e(factor), &w),
        View::Relative { of, from } => e(from).times(&w, symbols).minus(w.times(&e(of), symbols)),
        View::Configuration(of) => w.times(&e(of), symbols).scaled(-Rational::ONE),
    }
}

/// `F·w⁺`, with an element of the group and its inverse for each factor.
pub(super) fn back(
    context: &Context,
    carried: AdvectedSymbol,
    f: &dyn Fn(usize) -> (Expression, Expression),
    next: &Expression,
) -> Expression {
    match carried.seen {
        View::Relative { of, from } if context.is_added(of) => next.clone().plus(f(from).0).plus(f(of).1),
        View::Configuration(of) if context.is_added(of) => next.clone().plus(f(of).1),
        View::From(factor) => {
            let (f, inverse) = f(factor);
            let symbols = context.symbols;
            carried.variance.moved(next, [&f, &inverse], |m| m.transpose(symbols), |a, b| a.times(b, symbols))
        }
        View::Relative { of, from } => context.product(&context.product(&f(from).0, next), &f(of).1),
        View::Configuration(of) => context.product(next, &f(of).1),
    }
}

/// `E·w` in the defining representation.
pub(super) fn infinitesimal(symbols: &Symbols, variance: Variance, e: &Expression, w: &Expression) -> Expression {
    let negative = e.clone().scaled(-Rational::ONE);
    let [left, right] = variance.sides([e, &negative], |matrix| matrix.transpose(symbols));
    let terms = [left.map(|left| left.times(w, symbols)), right.map(|right| w.times(&right, symbols))];
    terms.into_iter().flatten().reduce(Expression::plus).unwrap_or_else(|| Expression::zero(w.shape()))
}
