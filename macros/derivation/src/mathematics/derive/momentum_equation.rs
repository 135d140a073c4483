//! The momentum equation \[RDAE, (2.7)\] and its Newton Jacobian.
//!
//! ```text
//! μ_k  = ⟨(R_F)* δl_d/δF − δl_d/δw ⋄ w, E_k⟩
//! J_kj = d/dt μ_k(exp(tE_j) F, w)
//! ```
//!
//! The second variation goes through the `F` inside `δF = E_k F`, which yields the connection term `⟨G, E_k E_j F⟩`
//! that an ambient Hessian lacks.

use super::Context;
use super::closed::{ClosedLet, forwards};
use crate::mathematics::symbolic::{Expression, variation};

pub(super) fn momentum(right: &Expression, diamond: &Expression) -> Expression {
    right.clone().minus(diamond.clone())
}

pub(super) fn jacobian(context: &Context, momentum: &Expression, closed: &[ClosedLet]) -> Expression {
    variation(momentum, &forwards(context, closed), context.symbols)
}
