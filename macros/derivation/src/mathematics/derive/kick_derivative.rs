//! How the kick `k₀(w)` changes as the body turns, for the force gradient of kinetic-potential splittings.
//!
//! ```text
//! d/dt k₀(exp(−tE)·w),      δw = −E·w
//! ```
//!
//! is its derivative along the motion `R exp(tE)` of a body from which `w` is seen. For a potential's torque that is
//! its second derivative but for a bracket, which the splittings add.

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
