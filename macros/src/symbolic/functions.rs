//! Smooth functions of one scalar.

use super::{Expression, Rational, Symbols};

/// A function with its derivative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Function {
    Sqrt,
    Ln,
    Exp,
    Sin,
    Cos,
}

impl Function {
    pub(crate) const ALL: [Self; 5] = [Self::Sqrt, Self::Ln, Self::Exp, Self::Sin, Self::Cos];

    /// The method of a Rust float, and the name in print.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Sqrt => "sqrt",
            Self::Ln => "ln",
            Self::Exp => "exp",
            Self::Sin => "sin",
            Self::Cos => "cos",
        }
    }

    pub(crate) fn apply(self, argument: f64) -> f64 {
        match self {
            Self::Sqrt => argument.sqrt(),
            Self::Ln => argument.ln(),
            Self::Exp => argument.exp(),
            Self::Sin => argument.sin(),
            Self::Cos => argument.cos(),
        }
    }

    /// `f'(u)`.
    pub(crate) fn derivative(self, argument: &Expression, symbols: &Symbols) -> Expression {
        let itself = || Expression::function(self, argument.clone());
        match self {
            Self::Sqrt => itself().power(-1, symbols).scaled(Rational::new(1, 2)),
            Self::Ln => argument.clone().power(-1, symbols),
            Self::Exp => itself(),
            Self::Sin => Expression::function(Self::Cos, argument.clone()),
            Self::Cos => Expression::function(Self::Sin, argument.clone()).scaled(-Rational::ONE),
        }
    }
}
