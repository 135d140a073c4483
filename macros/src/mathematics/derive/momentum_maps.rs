//! The momentum maps of \[RDAE, section 3.2.1, items 1 and 2\].
//!
//! ```text
//! ⟨(R_F)* δl_d/δF, E⟩ = d/ds l_d(exp(sE) F, w)      δF = E F
//! ⟨(L_F)* δl_d/δF, E⟩ = d/ds l_d(F exp(sE), w)      δF = F E
//! ```

use super::Context;
use crate::mathematics::symbolic::{Expression, Variations, variation};

pub(super) fn right(context: &Context) -> Expression {
    let f = context.symbol(context.declared.increment);
    along(context, context.product(&context.symbol(context.directions.first), &f))
}

pub(super) fn left(context: &Context) -> Expression {
    let f = context.symbol(context.declared.increment);
    along(context, context.product(&f, &context.symbol(context.directions.first)))
}

fn along(context: &Context, delta_f: Expression) -> Expression {
    let variations = Variations::from([(context.declared.increment, delta_f)]);
    variation(context.lagrangian, &variations, context.symbols)
}
