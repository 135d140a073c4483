//! The momentum maps of \[RDAE, section 3.2.1, items 1 and 2\].
//!
//! ```text
//! ⟨(R_F)* δl_d/δF, E⟩ = d/ds l_d(exp(sE) F, w)      δF = E F
//! ⟨(L_F)* δl_d/δF, E⟩ = d/ds l_d(F exp(sE), w)      δF = F E
//! ```
//!
//! For a translation `d`, which is added, both are `δd = E`.

use super::Context;
use crate::mathematics::symbolic::{Expression, Variations, variation};

pub(super) fn right(context: &Context) -> Expression {
    along(context, &|factor| context.turned(factor, &context.first(factor)))
}

pub(super) fn left(context: &Context) -> Expression {
    along(context, &|factor| match context.first(factor) {
        e if context.is_added(factor) => e,
        e => context.product(&context.increment(factor).0, &e),
    })
}

/// The derivative along `δF` of each factor: the covector of several bodies is linear in all `E_k` together.
fn along(context: &Context, delta_f: &dyn Fn(usize) -> Expression) -> Expression {
    let increments = context.declared.increments.iter().enumerate();
    let variations: Variations = increments.map(|(factor, &increment)| (increment, delta_f(factor))).collect();
    variation(context.lagrangian, &variations, context.symbols)
}
