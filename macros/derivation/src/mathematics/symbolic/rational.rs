//! Exact rational coefficients.

use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// A rational number in lowest terms with a positive denominator.
///
/// A result out of the range of 128 bits is [`OVERFLOW`](Self::OVERFLOW), and so is every result from it: a caller
/// checks once at the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rational {
    numerator: i128,
    denominator: i128,
}

impl Rational {
    pub const ZERO: Self = Self { numerator: 0, denominator: 1 };
    pub const ONE: Self = Self { numerator: 1, denominator: 1 };
    pub const OVERFLOW: Self = Self { numerator: 0, denominator: 0 };

    pub fn new(numerator: i128, denominator: i128) -> Self {
        if denominator == 1 && numerator > i128::MIN {
            return Self::integer(numerator);
        }
        let divisor = gcd(numerator.unsigned_abs(), denominator.unsigned_abs());
        let Ok(divisor) = i128::try_from(divisor) else { return Self::OVERFLOW };
        // The least number has no negative.
        if denominator == 0 || divisor == 0 || numerator.min(denominator) == i128::MIN {
            return Self::OVERFLOW;
        }
        let sign = if denominator < 0 { -1 } else { 1 };
        Self { numerator: sign * (numerator / divisor), denominator: sign * (denominator / divisor) }
    }

    pub fn integer(value: i128) -> Self {
        Self { numerator: value, denominator: 1 }
    }

    /// The exact value of a decimal literal such as `9.81` or `2.5e-3`; overflows beyond some 36 digits.
    pub fn from_decimal(digits: &str) -> Self {
        let (mantissa, exponent) = digits.split_once(['e', 'E']).unwrap_or((digits, "0"));
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let fraction = fraction.trim_end_matches('0');
        let parsed = format!("{whole}{fraction}").parse::<i128>();
        let (Ok(number), Ok(exponent), Ok(places)) = (parsed, exponent.parse::<i32>(), i32::try_from(fraction.len()))
        else {
            return Self::OVERFLOW;
        };
        let power = |n: i32| u32::try_from(n).ok().and_then(|n| 10_i128.checked_pow(n));
        let shift = exponent.saturating_sub(places);
        match (power(shift), power(shift.saturating_neg())) {
            (Some(scale), _) => number.checked_mul(scale).map_or(Self::OVERFLOW, Self::integer),
            (None, Some(scale)) => Self::new(number, scale),
            (None, None) => Self::OVERFLOW,
        }
    }

    pub fn is_zero(self) -> bool {
        self.numerator == 0 && self.denominator != 0
    }

    pub fn is_overflow(self) -> bool {
        self.denominator == 0
    }

    pub fn is_negative(self) -> bool {
        self.numerator < 0
    }

    pub fn inverse(self) -> Self {
        Self::new(self.denominator, self.numerator)
    }

    pub fn power(self, exponent: i32) -> Self {
        let (mut square, mut rest) = (if exponent < 0 { self.inverse() } else { self }, exponent.unsigned_abs());
        let mut product = Self::ONE;
        while rest > 0 {
            if rest % 2 == 1 {
                product = product * square;
            }
            rest /= 2;
            if rest > 0 {
                square = square * square;
            }
        }
        product
    }

    /// The nearest `f64`.
    #[allow(clippy::cast_precision_loss)] // 53 bits are what the emitted literal can hold
    pub fn to_f64(self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }

    pub fn parts(self) -> (i128, i128) {
        (self.numerator, self.denominator)
    }
}

fn gcd(a: u128, b: u128) -> u128 {
    if b == 0 { a } else { gcd(b, a % b) }
}

impl Add for Rational {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let sum = || {
            let left = self.numerator.checked_mul(other.denominator)?;
            let right = other.numerator.checked_mul(self.denominator)?;
            Some(Self::new(left.checked_add(right)?, self.denominator.checked_mul(other.denominator)?))
        };
        sum().unwrap_or(Self::OVERFLOW)
    }
}

impl Neg for Rational {
    type Output = Self;

    fn neg(self) -> Self {
        self.numerator.checked_neg().map_or(Self::OVERFLOW, |numerator| Self { numerator, ..self })
    }
}

impl Sub for Rational {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Rational {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = || {
            let numerator = self.numerator.checked_mul(other.numerator)?;
            Some(Self::new(numerator, self.denominator.checked_mul(other.denominator)?))
        };
        product().unwrap_or(Self::OVERFLOW)
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.numerator, self.denominator).cmp(&(other.numerator, other.denominator))
    }
}
