//! Power series in `h` with coefficients in the finite field, where nothing is rounded: how a declared expression goes as
//! `h → 0`.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::number::Number;
use super::residue::Residue;
use crate::mathematics::symbolic::{Function, Rational};

/// As many coefficients are known from the first on.
const LENGTH: usize = 8;
const LENGTH_I32: i32 = 8;
/// From here on nothing is known of a number that is exact.
const NEVER: i32 = 1_000;

type Coefficients = [Residue; LENGTH];
const NONE: Coefficients = [Residue::ZERO; LENGTH];

/// `Σ c_i hⁱ + O(hᵉ)`, from the first power whose coefficient isn't zero; undefined where that is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Series {
    first: i32,
    /// The power `e` from which on nothing is known.
    end: i32,
    coefficients: Coefficients,
}

impl Series {
    /// `h`.
    pub(super) const STEP: Self = Self::from_one_coefficient(1, Residue::ONE);

    const fn from_one_coefficient(first: i32, value: Residue) -> Self {
        let mut coefficients = NONE;
        coefficients[0] = value;
        Self { first, end: first + LENGTH_I32, coefficients }
    }

    pub(super) fn constant(value: Residue) -> Self {
        if value == Residue::ZERO { Self::ZERO } else { Self::from_one_coefficient(0, value) }
    }

    /// With the coefficients from the power `first` on.
    fn new(first: i32, end: i32, coefficients: Coefficients) -> Self {
        let end = end.min(first.saturating_add(LENGTH_I32));
        let known = usize::try_from(end.saturating_sub(first)).unwrap_or(0);
        let Some(zeros) = coefficients[..known].iter().position(|c| *c != Residue::ZERO) else {
            return Self { first: end, end, coefficients: NONE };
        };
        let mut shifted = NONE;
        shifted[..known - zeros].copy_from_slice(&coefficients[zeros..known]);
        Self { first: first + i32::try_from(zeros).unwrap_or(0), end, coefficients: shifted }
    }

    /// The lowest power of `h`; none where all coefficients that are known are zero.
    pub(super) fn order(&self) -> Option<i32> {
        (!self.is_zero()).then_some(self.first)
    }

    /// Whether all coefficients of lower powers are known.
    pub(super) const fn is_known_below(&self, power: i32) -> bool {
        self.end >= power
    }

    pub(super) fn at(&self, power: i32) -> Residue {
        let index = usize::try_from(power - self.first).ok();
        index.and_then(|index| self.coefficients.get(index)).copied().unwrap_or(Residue::ZERO)
    }

    fn reciprocal(self) -> Self {
        if self.is_zero() || !self.is_defined() {
            return Self::UNDEFINED;
        }
        let mut coefficients = NONE;
        coefficients[0] = Residue::ONE / self.coefficients[0];
        for n in 1..LENGTH {
            let sum = (1..=n).fold(Residue::ZERO, |sum, i| sum + self.coefficients[i] * coefficients[n - i]);
            coefficients[n] = -sum * coefficients[0];
        }
        let length = self.end - self.first;
        Self::new(-self.first, length - self.first, coefficients)
    }

    /// `f(a + x)` with `x` the rest without the constant `a`, from the coefficients of Taylor's series about `a`.
    fn composed(self, taylor: impl FnOnce() -> Coefficients) -> Self {
        let rest = self - Self::constant(self.at(0));
        taylor().iter().rev().fold(Self::ZERO, |sum, coefficient| sum * rest + Self::constant(*coefficient))
    }

    /// Of an even power of `h` times a number.
    fn root(self) -> Self {
        if self.is_zero() {
            // The root of O(hᵉ) is O(h^(e/2)), that of an exact zero exactly zero.
            let end = if self.end >= NEVER { self.end } else { self.end / 2 };
            return Self { first: end, end, ..self };
        }
        if self.first % 2 != 0 {
            return Self::UNDEFINED;
        }
        let middle = self.first / 2;
        let unit = Self { first: 0, end: self.end - self.first, ..self };
        let first = unit.at(0).apply(Function::Sqrt);
        let (mut taylor, half_of_one) = ([first; LENGTH], half());
        for n in 1..LENGTH {
            taylor[n] = taylor[n - 1] * (half_of_one - small(n - 1)) / (small(n) * unit.at(0));
        }
        let root = unit.composed(|| taylor);
        Self { first: root.first + middle, end: root.end + middle, ..root }
    }
}

fn half() -> Residue {
    Residue::of(Rational::new(1, 2))
}

/// Below a hundred.
fn small(n: usize) -> Residue {
    Residue::of(Rational::integer(i128::try_from(n).unwrap_or(0)))
}

/// `f⁽ⁿ⁾(a)/n!`.
fn taylor(function: Function, a: Residue) -> Coefficients {
    let mut factorial = Residue::ONE;
    let [sine, cosine] = [Function::Sin, Function::Cos];
    let derivatives = if let Function::Stumpff(k) = function { of_stumpff(k, a) } else { NONE };
    std::array::from_fn(|n| {
        factorial = factorial * small(n.max(1));
        let above = |k: u8| k.saturating_add(u8::try_from(n).unwrap_or(u8::MAX));
        match function {
            Function::Exp => a.apply(function) / factorial,
            Function::Sin | Function::Cos => {
                let turned = n + usize::from(function == cosine);
                let value = a.apply(if turned.is_multiple_of(2) { sine } else { cosine });
                (if turned % 4 < 2 { value } else { -value }) / factorial
            }
            Function::Ln if n == 0 => a.apply(function),
            Function::Ln => -(-Residue::ONE / a).power(i32::try_from(n).unwrap_or(0)) / small(n),
            // Not asked for.
            Function::Sqrt => Residue::UNDEFINED,
            Function::LogRatio(k) => a.apply(Function::LogRatio(above(k))) / factorial,
            Function::Stumpff(_) => derivatives[n] / factorial,
        }
    })
}

/// The derivatives of `c_k`, by `c_k′ = (k c_{k+2} − c_{k+1})/2`.
fn of_stumpff(k: u8, a: Residue) -> Coefficients {
    const MEMBERS: usize = 2 * LENGTH - 1;
    let orders = || (k..=u8::MAX).take(MEMBERS);
    let values: Vec<Residue> = orders().map(|k| a.apply(Function::Stumpff(k))).collect();
    let mut shares = [Residue::ZERO; MEMBERS];
    shares[0] = Residue::ONE;
    std::array::from_fn(|_| {
        let derivative = values.iter().zip(&shares).fold(Residue::ZERO, |sum, (&value, &share)| sum + value * share);
        let mut next = [Residue::ZERO; MEMBERS];
        for (at, order) in orders().enumerate().take(MEMBERS - 2) {
            next[at + 1] = next[at + 1] - half() * shares[at];
            next[at + 2] = next[at + 2] + half() * small(order.into()) * shares[at];
        }
        shares = next;
        derivative
    })
}

impl Add for Series {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        if !self.is_defined() || !other.is_defined() {
            return Self::UNDEFINED;
        }
        let (first, end) = (self.first.min(other.first), self.end.min(other.end));
        let mut coefficients = NONE;
        for (power, sum) in (first..end).zip(&mut coefficients) {
            *sum = self.at(power) + other.at(power);
        }
        Self::new(first, end, coefficients)
    }
}

impl Neg for Series {
    type Output = Self;

    fn neg(self) -> Self {
        Self { coefficients: self.coefficients.map(|c| -c), ..self }
    }
}

impl Sub for Series {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Series {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        if !self.is_defined() || !other.is_defined() {
            return Self::UNDEFINED;
        }
        let first = self.first.saturating_add(other.first).min(NEVER);
        let end = self.end.saturating_add(other.first).min(other.end.saturating_add(self.first)).min(NEVER);
        let mut coefficients = NONE;
        // Most numbers have one coefficient.
        for (i, &a) in self.coefficients.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
            for (&b, sum) in other.coefficients.iter().zip(&mut coefficients[i..]).filter(|(b, _)| !b.is_zero()) {
                *sum = *sum + a * b;
            }
        }
        Self::new(first, end, coefficients)
    }
}

impl Div for Series {
    type Output = Self;

    #[allow(clippy::suspicious_arithmetic_impl)] // by the reciprocal
    fn div(self, other: Self) -> Self {
        self * other.reciprocal()
    }
}

impl Number for Series {
    const ZERO: Self = Self { first: NEVER, end: NEVER, coefficients: NONE };
    const ONE: Self = Self::from_one_coefficient(0, Residue::ONE);
    const UNDEFINED: Self = Self::from_one_coefficient(0, Residue::UNDEFINED);

    fn of(value: Rational) -> Self {
        Self::constant(Residue::of(value))
    }

    fn power(self, exponent: i32) -> Self {
        let factor = if exponent < 0 { self.reciprocal() } else { self };
        let (mut product, mut square, mut rest) = (Self::ONE, factor, exponent.unsigned_abs());
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

    fn apply(self, function: Function) -> Self {
        match function {
            _ if !self.is_defined() => Self::UNDEFINED,
            Function::Sqrt => self.root(),
            _ if self.first < 0 => Self::UNDEFINED,
            // A constant.
            _ if self.coefficients[1..].iter().all(|c| c.is_zero()) && self.first == 0 => {
                let constant = Self::from_one_coefficient(0, self.at(0).apply(function));
                Self::new(0, self.end, constant.coefficients)
            }
            _ => self.composed(|| taylor(function, self.at(0))),
        }
    }

    fn is_defined(self) -> bool {
        self.coefficients.iter().all(|c| c.is_defined())
    }

    fn is_zero(self) -> bool {
        self.coefficients.iter().all(|c| c.is_zero())
    }
}

#[cfg(test)]
mod tests {
    use super::{LENGTH_I32, Series, half, small};
    use crate::judged::verify::number::Number as _;
    use crate::judged::verify::residue::Residue;
    use crate::mathematics::symbolic::{Function, Rational};

    #[test]
    fn what_has_no_value() {
        let (h, zero) = (Series::STEP, Series::ONE - Series::ONE);
        assert!(zero.is_zero() && (zero * h).is_zero() && zero.order().is_none());
        for undefined in [Series::ONE / zero, zero.power(-1), h.apply(Function::Sqrt), h.apply(Function::Ln)] {
            assert!(!undefined.is_defined() && !(undefined * zero + h).is_defined(), "{undefined:?}");
        }
        assert!(!(Series::ONE / h).apply(Function::Exp).is_defined());
    }

    /// That two are the same as far as both are known, which is up to a power at least.
    fn assert_equal(found: Series, expected: Series, known: i32) {
        let rest = found - expected;
        assert!(rest.is_defined() && rest.is_zero() && rest.is_known_below(known), "{found:?} and {expected:?}");
    }

    /// `a + b h + c h²` of numbers of the field.
    fn quadratic(next: &mut impl FnMut() -> Residue) -> Series {
        let h = Series::STEP;
        let [a, b, c] = [next(), next(), next()].map(Series::constant);
        a + h * (b + h * c)
    }

    /// `y' = y/(2x)` for a root, whatever stands in for it, so that `y²/x` stays what it is at the first coefficient.
    #[test]
    fn roots_in_the_field() {
        let (mut next, h) = (Residue::stream(3), Series::STEP);
        for half in [0, 1, 2] {
            let x = quadratic(&mut next);
            let root = (x * h.power(2 * half)).apply(Function::Sqrt);
            let [first, of_first] = [x.at(0), x.at(0).apply(Function::Sqrt)].map(Series::constant);
            assert_eq!(root.order(), Some(half));
            assert_eq!(root.at(half), of_first.at(0));
            assert_equal(root * root * first, x * h.power(2 * half) * of_first * of_first, LENGTH_I32);
        }
        for undefined in [h, h.power(3), Series::UNDEFINED] {
            assert!(!undefined.apply(Function::Sqrt).is_defined(), "{undefined:?}");
        }
    }

    /// Against the chain rule, `f(x(h))' = f'(x) x'`, and `1/(1 − h) = Σ hⁿ`.
    #[test]
    fn functions_in_the_field() {
        let (mut next, h, one) = (Residue::stream(4), Series::STEP, Series::ONE);
        let slope = |y: Series| {
            let terms = (1..LENGTH_I32).map(|n| {
                let factor = Residue::of(Rational::integer(n.into()));
                Series::constant(y.at(n) * factor) * h.power(n - 1)
            });
            terms.fold(Series::ZERO, |sum, term| sum + term)
        };
        // The slope is known below the power that the series of seven coefficients ends at.
        let assert_slope = |y, expected: Series| {
            for power in 0..LENGTH_I32 - 1 {
                assert_eq!(slope(y).at(power), expected.at(power), "{y:?}");
            }
        };
        for _ in 0..3 {
            let x = quadratic(&mut next);
            assert_slope(x.apply(Function::Ln), slope(x) / x);
            assert_slope(x.apply(Function::Exp), x.apply(Function::Exp) * slope(x));
            assert_slope(x.apply(Function::Sin), x.apply(Function::Cos) * slope(x));
            assert_slope(x.apply(Function::Cos), -x.apply(Function::Sin) * slope(x));
            for k in 0..3 {
                let [value, second, third] = [k, k + 1, k + 2].map(|k| x.apply(Function::Stumpff(k)));
                let order = Series::constant(small(k.into()));
                assert_slope(value, Series::constant(half()) * (order * third - second) * slope(x));
                assert_slope(x.apply(Function::LogRatio(k)), x.apply(Function::LogRatio(k + 1)) * slope(x));
            }
            assert_eq!(x.apply(Function::Ln).at(0), x.at(0).apply(Function::Ln));
            assert_equal(x * x.power(-1), one, LENGTH_I32);
        }
        let geometric = one / (one - h);
        assert!((0..LENGTH_I32).all(|n| geometric.at(n) == Residue::ONE));
    }

    /// `Σ (−x)ⁱ/(2i + k)!` about zero.
    #[test]
    fn stumpff_in_the_field() {
        for k in 0..4_u8 {
            let series = Series::STEP.apply(Function::Stumpff(k));
            let mut expected = (1..=k).fold(Residue::ONE, |product, n| product / small(n.into()));
            for power in 0..LENGTH_I32 {
                assert_eq!(series.at(power), expected, "{k}");
                let next = usize::try_from(2 * power).expect("positive") + usize::from(k);
                expected = -expected / (small(next + 1) * small(next + 2));
            }
        }
    }
}
