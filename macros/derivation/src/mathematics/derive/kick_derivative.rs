//! The derivative of the kick `k₀(w)` along a motion, for the force gradient of kinetic-potential splittings.
//!
//! ```text
//! d/dt k₀(exp(−tE)·w),      δw = −E·w
//! ```
//!
//! is the derivative along the motion `R exp(tE)` of a body with `w` in its axes. For a potential's torque it is the
//! second derivative of the potential but for a bracket, which the splittings add.

use super::Context;
use crate::mathematics::symbolic::{Expression, Rational, Variations, variation};

pub(super) fn kick_derivative(context: &Context, kick_before: &Expression) -> Expression {
    let carried = context.declared.advected.iter().map(|&w| {
        let moved = context.along(w, &|factor| context.second(factor));
        (w.symbol, moved.scaled(-Rational::ONE))
    });
    let variations: Variations = carried.collect();
    variation(kick_before, &variations, context.symbols)
}
