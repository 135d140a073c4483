//! Unevaluated sums of two doubles: the larger is the sum rounded, the smaller what the rounding left behind.
//!
//! The sums and products are those of Knuth, Dekker and Møller, exact to some `2⁻¹⁰²`.

use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

/// A number of 32 digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DoubleDouble {
    high: f64,
    low: f64,
}

/// `a + b` rounded and the rest, where `|a| ≥ |b|`.
fn quick_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// `a + b` rounded and the rest.
fn exact_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let of_b = high - a;
    DoubleDouble { high, low: (a - (high - of_b)) + (b - of_b) }
}

/// `a b` rounded and the rest.
fn exact_product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    DoubleDouble { high, low: a.mul_add(b, -high) }
}

impl DoubleDouble {
    /// From decimal digits, all of them.
    pub(crate) fn parse(text: &str) -> Self {
        let (digits, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let (sign, digits) = digits.strip_prefix('-').map_or((1.0, digits), |digits| (-1.0, digits));
        let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
        let ten = Self::from(10.0);
        let mut value = Self::zero();
        for digit in whole.chars().chain(fraction.chars()) {
            value = value * ten + f64::from(digit.to_digit(10).expect(text)).into();
        }
        let places = exponent.parse::<i32>().expect(text) - i32::try_from(fraction.len()).expect(text);
        let power = (0..places.unsigned_abs()).fold(Self::one(), |power, _| power * ten);
        (if places < 0 { value / power } else { value * power }) * sign.into()
    }

    /// The nearest double.
    pub(crate) fn rounded(self) -> f64 {
        self.high
    }

    pub(crate) fn sqrt(self) -> Self {
        let root = self.high.sqrt();
        // A step of Newton's iteration doubles the digits.
        Self::from(root) + (self - exact_product(root, root)) / (2.0 * root).into()
    }
}

/// The number itself.
pub(crate) fn long(number: f64) -> DoubleDouble {
    number.into()
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (high, low) = (exact_sum(self.high, other.high), exact_sum(self.low, other.low));
        let sum = quick_sum(high.high, high.low + low.high);
        quick_sum(sum.high, sum.low + low.low)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = exact_product(self.high, other.high);
        quick_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * first.into();
        let second = rest.high / other.high;
        let rest = rest - other * second.into();
        quick_sum(first, second) + (rest.high / other.high).into()
    }
}

macro_rules! assigned {
    ($($of:ident $name:ident $operator:tt),+) => {$(
        impl $of for DoubleDouble {
            fn $name(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    )+};
}

assigned!(AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *);

impl Zero for DoubleDouble {
    fn zero() -> Self {
        0.0.into()
    }

    fn is_zero(&self) -> bool {
        self.high == 0.0
    }
}

impl One for DoubleDouble {
    fn one() -> Self {
        1.0.into()
    }
}

#[cfg(test)]
mod tests {
    use super::DoubleDouble;

    /// The digits of a few numbers that others have computed.
    #[test]
    fn they_have_32_digits() {
        let number = DoubleDouble::parse;
        for (found, expected) in [
            (number("2").sqrt(), "1.41421356237309504880168872420969807857"),
            (number("1") / number("7"), "0.142857142857142857142857142857142857143"),
            (number("-0.1") * number("1e-1"), "-0.01"),
            (number("1.00000000000000000001") - number("1"), "0.00000000000000000001"),
        ] {
            let error = (found - number(expected)).rounded();
            assert!(error.abs() < 1e-31, "{expected}: off by {error:e}");
        }
    }
}
