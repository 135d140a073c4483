//! Unevaluated sums of two doubles: the larger is the rounded sum, the smaller its rounding error.
//!
//! The sums and products are those of Knuth, Dekker and Møller, exact to some `2⁻¹⁰²`.

use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

/// A number of 32 digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// The rounded sum `a + b` and its rounding error, for `|a| ≥ |b|`.
#[inline]
fn quick_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// The rounded sum `a + b` and its rounding error.
#[inline]
fn exact_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let of_b = high - a;
    DoubleDouble { high, low: (a - (high - of_b)) + (b - of_b) }
}

/// The rounded product `a b` and its rounding error.
#[inline]
fn exact_product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    DoubleDouble { high, low: a.mul_add(b, -high) }
}

impl DoubleDouble {
    /// The number from decimal digits, with all of them.
    pub fn parse(text: &str) -> Self {
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
    #[inline]
    pub fn rounded(self) -> f64 {
        self.high
    }

    #[inline]
    pub fn sqrt(self) -> Self {
        let root = self.high.sqrt();
        // A step of Newton's iteration doubles the digits.
        Self::from(root) + (self - exact_product(root, root)) / (2.0 * root).into()
    }
}

/// The double as a number of 32 digits.
#[inline]
pub fn long(number: f64) -> DoubleDouble {
    number.into()
}

impl From<f64> for DoubleDouble {
    #[inline]
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let (high, low) = (exact_sum(self.high, other.high), exact_sum(self.low, other.low));
        let sum = quick_sum(high.high, high.low + low.high);
        quick_sum(sum.high, sum.low + low.low)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let product = exact_product(self.high, other.high);
        quick_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;

    #[inline]
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
            #[inline]
            fn $name(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    )+};
}

assigned!(AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *);

impl Zero for DoubleDouble {
    #[inline]
    fn zero() -> Self {
        0.0.into()
    }

    #[inline]
    fn is_zero(&self) -> bool {
        self.high == 0.0
    }
}

impl One for DoubleDouble {
    #[inline]
    fn one() -> Self {
        1.0.into()
    }
}
