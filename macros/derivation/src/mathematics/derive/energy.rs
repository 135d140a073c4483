//! The discrete energy `−∂l_d/∂h`.

use super::Context;
use crate::mathematics::symbolic::{Expression, Rational, Variations, variation};

pub(super) fn discrete(context: &Context) -> Expression {
    let variations = Variations::from([(context.declared.step, Expression::rational(-Rational::ONE))]);
    variation(context.lagrangian, &variations, context.symbols)
}
