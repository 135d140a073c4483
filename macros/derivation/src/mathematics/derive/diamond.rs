//! The diamond term of \[RDAE, (2.1) and section 3.2.1, item 3\].
//!
//! ```text
//! ⟨δl_d/δw ⋄ w, E⟩ = −⟨δl_d/δw, E·w⟩ = −d/ds l_d(F, exp(sE)·w)
//! ```
//!
//! For `w` in `V*`, `E·w = −Eᵀ w`, this is (2.1): `⟨w, E δl_d/δw⟩`.

use super::{AdvectedSymbol, Context};
use crate::mathematics::symbolic::{Expression, Rational, Variations, variation};

pub(super) fn diamond(context: &Context) -> Expression {
    of(context, &context.declared.advected)
}

/// The share of each parameter, if there are several.
pub(super) fn shares(context: &Context) -> Vec<Expression> {
    match context.declared.advected.as_slice() {
        [_] => Vec::new(),
        several => several.chunks(1).map(|one| of(context, one)).collect(),
    }
}

fn of(context: &Context, advected: &[AdvectedSymbol]) -> Expression {
    let variations: Variations =
        advected.iter().map(|&w| (w.symbol, context.along(w, &|factor| context.first(factor)))).collect();
    variation(context.lagrangian, &variations, context.symbols).scaled(-Rational::ONE)
}
