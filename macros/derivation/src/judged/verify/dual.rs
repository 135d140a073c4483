//! Dual numbers `x + ε x'` over any numbers: exact derivatives of the declared tree, without the symbolic rules.

use super::number::{self, Number, operator};
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
