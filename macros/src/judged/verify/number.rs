//! What a declared expression can be evaluated in: floating-point numbers, and a finite field.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::mathematics::symbolic::{Function, Rational};

/// Numbers with the operations of the declared syntax.
pub(super) trait Number:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    const ZERO: Self;
    const ONE: Self;
    /// What an operation gives that has no value; what is computed with it has none either.
    const UNDEFINED: Self;

    fn of(value: Rational) -> Self;

    fn power(self, exponent: i32) -> Self;

    fn apply(self, function: Function) -> Self;

    /// Whether nothing is seen of it beside a one.
    fn is_lost(self) -> bool {
        false
    }
}

impl Number for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const UNDEFINED: Self = Self::NAN;

    fn of(value: Rational) -> Self {
        value.to_f64()
    }

    fn power(self, exponent: i32) -> Self {
        self.powi(exponent)
    }

    fn apply(self, function: Function) -> Self {
        function.apply(self)
    }

    fn is_lost(self) -> bool {
        self.abs() < 1e-18
    }
}
