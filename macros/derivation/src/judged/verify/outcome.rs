//! The outcome of a verification: findings with their sureness, or the reason why nothing is confirmed.

use crate::mathematics::derive::SelfAdjointness;
use crate::program::{Derivatives, Outputs, Stages};

/// The reason why a derivation, or its expression, isn't confirmed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Objection {
    /// A derived term disagrees with the declaration.
    Disagrees(&'static str),
    /// The declaration has no value at a point, or at any of the points drawn.
    NoValue,
    /// A derived term has no value at a point where the declaration has one.
    Undefined(&'static str),
    /// The declaration isn't smooth at `F = I`.
    NotSmooth,
}

/// The results for a declaration that the self-check confirms.
pub struct Findings {
    pub self_adjointness: SelfAdjointness,
    pub sureness: Sureness,
    /// The verified graphs, to be emitted; the derivatives of a step if they are requested.
    pub stages: Stages,
    pub jacobian: Outputs,
    pub derivatives: Option<Derivatives>,
    /// The hypotheses of the equations, which are found later.
    pub hypotheses: Vec<String>,
}

/// The bound on the probability that a wrong derivation passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sureness {
    /// The probability is below `2⁻ⁿ`.
    Certified(u32),
    /// The degrees are too high for a useful bound.
    TooHigh,
    /// A constant has a numerator or a denominator that is a multiple of `2⁶¹ − 1`.
    Multiple,
    /// The group has no Cayley transforms: the comparison was in power series, without a bound.
    Series,
}

impl Sureness {
    /// The weaker of two bounds.
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Certified(one), Self::Certified(other)) => Self::Certified(one.min(other)),
            (Self::Certified(_), lesser) | (lesser, _) => lesser,
        }
    }
}
