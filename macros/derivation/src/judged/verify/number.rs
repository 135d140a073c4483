//! The numbers that a declared expression can be evaluated in: floating-point numbers, a finite field, and dual numbers
//! and power series over these.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::mathematics::symbolic::{Function, Rational};

/// Numbers with the operations of the declared syntax.
pub trait Number:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    const ZERO: Self;
    const ONE: Self;
    /// The result of an operation without a value; every operation on it is undefined too.
    const UNDEFINED: Self;

    fn of(value: Rational) -> Self;

    fn power(self, exponent: i32) -> Self;

    fn apply(self, function: Function) -> Self;

    fn is_defined(self) -> bool;

    /// Whether the number is zero, as far as its digits are known.
    fn is_zero(self) -> bool;
}

/// An operator of numbers.
macro_rules! operator {
    (impl$(<$t:ident: Number>)? $operator:ident::$method:ident for $number:ty, |$a:ident $(, $b:ident)?| $value:expr) => {
        #[allow(clippy::suspicious_arithmetic_impl)] // a quotient is a product with a reciprocal
        impl$(<$t: Number>)? std::ops::$operator for $number {
            type Output = Self;

            fn $method(self $(, $b: Self)?) -> Self {
                let $a = self;
                $value
            }
        }
    };
}
pub(super) use operator;

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

    fn is_defined(self) -> bool {
        self.is_finite()
    }

    fn is_zero(self) -> bool {
        self == 0.0
    }
}

/// A power by repeated squaring.
pub fn raised<T: Number>(x: T, exponent: u64) -> T {
    let (mut power, mut square) = (T::ONE, x);
    for bit in 0..u64::BITS - exponent.leading_zeros() {
        if exponent >> bit & 1 == 1 {
            power = power * square;
        }
        square = square * square;
    }
    power
}

/// `f′(x)`, where `value` returns `f(x)`.
pub fn derivative<T: Number>(function: Function, x: T, value: impl FnOnce() -> T) -> T {
    let of = |numerator, denominator| T::of(Rational::new(numerator, denominator));
    match function {
        Function::Sqrt => of(1, 2) / value(),
        Function::Ln => T::ONE / x,
        Function::Exp => value(),
        Function::Sin => x.apply(Function::Cos),
        Function::Cos => -x.apply(Function::Sin),
        Function::Stumpff(k) => {
            let [first, second] = [k + 1, k + 2].map(|k| x.apply(Function::Stumpff(k)));
            of(1, 2) * (of(k.into(), 1) * second - first)
        }
        Function::LogRatio(k) => x.apply(Function::LogRatio(k + 1)),
    }
}

/// A member of a family of functions, computed from lower members if it isn't one of the first two.
///
/// ```text
/// c_{k+2} = (1/k! − c_k)/q
/// 2 u G′ = 1 − s G      u G⁽ᵏ⁺²⁾ = (k + 1)² G⁽ᵏ⁾ − (k + 3/2) s G⁽ᵏ⁺¹⁾      u = n(1 − n),  s = 1 − 2n
/// ```
pub fn of_those_below<T: Number>(function: Function, x: T) -> Option<T> {
    let of = |numerator, denominator| T::of(Rational::new(numerator, denominator));
    let (rest, s) = (T::ONE - x, T::ONE - x - x);
    match function {
        Function::Stumpff(k @ 2..) => {
            let below = Function::Stumpff(k - 2);
            let first = below.at_zero().map_or(T::UNDEFINED, T::of);
            Some((first - x.apply(below)) / x)
        }
        Function::LogRatio(1) => Some((T::ONE - s * x.apply(Function::LogRatio(0))) / (of(2, 1) * x * rest)),
        Function::LogRatio(k @ 2..) => {
            let below = i128::from(k) - 2;
            let [first, second] = [k - 2, k - 1].map(|k| x.apply(Function::LogRatio(k)));
            let sum = of((below + 1) * (below + 1), 1) * first - of(2 * below + 3, 2) * s * second;
            Some(sum / (x * rest))
        }
        _ => None,
    }
}
