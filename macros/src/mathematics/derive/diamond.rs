//! The diamond term of \[RDAE, (2.1) and section 3.2.1, item 3\].
//!
//! ```text
//! ⟨δl_d/δw ⋄ w, E⟩ = −⟨δl_d/δw, E·w⟩ = −d/ds l_d(F, exp(sE)·w)
//! ```
//!
//! For `w` in `V*`, `E·w = −Eᵀ w`, this is (2.1): `⟨w, E δl_d/δw⟩`.

use super::{Context, action};
use crate::mathematics::symbolic::{Expression, Rational, Variations, variation};

pub(super) fn diamond(context: &Context) -> Expression {
    let direction = context.symbol(context.directions.first);
    let carried =
        context.declared.advected.iter().map(|&(w, variance)| {
            (w, action::infinitesimal(context.symbols, variance, &direction, &context.symbol(w)))
        });
    let variations: Variations = carried.collect();
    variation(context.lagrangian, &variations, context.symbols).scaled(-Rational::ONE)
}
