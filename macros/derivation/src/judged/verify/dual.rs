//! Dual numbers `x + ε x'` over any numbers: exact derivatives of the declared tree, without the symbolic rules.

use super::number::{self, Number, operator};
use crate::mathematics::symbolic::{Function, Rational};

/// A value and its derivative.
#[derive(Clone, Copy, Debug)]
pub struct Dual<T> {
    pub value: T,
    pub slope: T,
}

impl<T: Number> Dual<T> {
    pub fn constant(value: T) -> Self {
        Self { value, slope: T::ZERO }
    }
}

operator!(impl<T: Number> Add::add for Dual<T>, |a, b| Self { value: a.value + b.value, slope: a.slope + b.slope });
operator!(impl<T: Number> Sub::sub for Dual<T>, |a, b| Self { value: a.value - b.value, slope: a.slope - b.slope });
operator!(impl<T: Number> Mul::mul for Dual<T>, |a, b| Self {
    value: a.value * b.value,
    slope: a.slope * b.value + a.value * b.slope
});
operator!(impl<T: Number> Div::div for Dual<T>, |a, b| {
    // The reciprocal is computed once: in a finite field it takes a hundred products.
    let reciprocal = T::ONE / b.value;
    let value = a.value * reciprocal;
    Self { value, slope: (a.slope - value * b.slope) * reciprocal }
});
operator!(impl<T: Number> Neg::neg for Dual<T>, |a| Self { value: -a.value, slope: -a.slope });

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
