//! The diamond term of \[RDAE, (2.1) and section 3.2.1, item 3\].
//!
//! With `w` in `V*`, moved by the contragredient action, `E·w = −Eᵀ w` and
//!
//! ```text
//! ⟨δl_d/δw ⋄ w, E⟩ = ⟨w, E δl_d/δw⟩ = −d/ds l_d(F, exp(sE)·w)
//! ```

use super::Context;
use crate::symbolic::{Expression, Variations, variation};

pub(super) fn diamond(context: &Context) -> Expression {
    let direction = context.symbol(context.directions.first).transpose(context.symbols);
    let carried = context.declared.advected.iter().map(|&w| (w, context.product(&direction, &context.symbol(w))));
    // −E·w = Eᵀ w: the two signs of the formula above have met.
    let variations: Variations = carried.collect();
    variation(&context.declared.l_d, &variations, context.symbols)
}
