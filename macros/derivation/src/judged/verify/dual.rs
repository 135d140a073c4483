//! Dual numbers `x + ε x'` over any numbers: exact derivatives of the declared tree, by none of the symbolic rules.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::number::{self, Number};
use crate::mathematics::symbolic::{Function, Rational};

/// A value and its derivative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dual<T> {
    pub(super) value: T,
    pub(super) slope: T,
}

impl<T: Number> Dual<T> {
    pub(super) fn constant(value: T) -> Self {
        Self { value, slope: T::ZERO }
    }
}

impl<T: Number> Add for Dual<T> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl<T: Number> Sub for Dual<T> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl<T: Number> Mul for Dual<T> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, slope: self.slope * other.value + self.value * other.slope }
    }
}

impl<T: Number> Div for Dual<T> {
    type Output = Self;

    #[allow(clippy::suspicious_arithmetic_impl)] // by the reciprocal
    fn div(self, other: Self) -> Self {
        // Once, as in a finite field it is a hundred products.
        let reciprocal = T::ONE / other.value;
        let value = self.value * reciprocal;
        Self { value, slope: (self.slope - value * other.slope) * reciprocal }
    }
}

impl<T: Number> Neg for Dual<T> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}

impl<T: Number> Number for Dual<T> {
    const ZERO: Self = Self { value: T::ZERO, slope: T::ZERO };
    const ONE: Self = Self { value: T::ONE, slope: T::ZERO };
    const UNDEFINED: Self = Self { value: T::UNDEFINED, slope: T::UNDEFINED };

    fn of(value: Rational) -> Self {
        Self::constant(T::of(value))
    }

    fn power(self, exponent: i32) -> Self {
        let slope = if exponent == 0 {
            T::ZERO
        } else {
            T::of(Rational::integer(exponent.into())) * self.value.power(exponent - 1) * self.slope
        };
        Self { value: self.value.power(exponent), slope }
    }

    fn apply(self, function: Function) -> Self {
        let value = self.value.apply(function);
        let derivative = number::derivative(function, self.value, || value);
        Self { value, slope: derivative * self.slope }
    }

    fn is_defined(self) -> bool {
        self.value.is_defined() && self.slope.is_defined()
    }

    fn is_zero(self) -> bool {
        self.value.is_zero() && self.slope.is_zero()
    }
}

#[cfg(test)]
mod tests {
    use super::{Dual, Number as _};
    use crate::mathematics::symbolic::Function;

    /// Against central differences.
    #[test]
    fn derivatives() {
        let functions = [Function::Sqrt, Function::Ln, Function::Exp, Function::Sin, Function::Cos];
        let families = [0, 1, 2, 5].into_iter().flat_map(|k| [Function::Stumpff(k), Function::LogRatio(k)]);
        let at = |x: f64| Dual { value: x, slope: 1.0 };
        let assert_slope = |f: &dyn Fn(Dual<f64>) -> Dual<f64>, name: &str| {
            let difference = (f(at(0.3 + 1e-5)).value - f(at(0.3 - 1e-5)).value) / 2e-5;
            let slope = f(at(0.3)).slope;
            assert!((slope - difference).abs() < 1e-7 * (1.0 + slope.abs()), "{name}: {slope} and {difference}");
        };
        for function in functions.into_iter().chain(families) {
            assert_slope(&|x| x.apply(function), &format!("{function:?}"));
        }
        for exponent in [-2, 0, 1, 3] {
            assert_slope(&|x| x.power(exponent), "power");
        }
        assert_slope(&|x| (x * x - Dual::ONE) / (x + x), "quotient");
    }
}
