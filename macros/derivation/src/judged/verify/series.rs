//! Power series in `h` with numbers for coefficients: how a declared expression goes as `h → 0`. In a finite field nothing
//! is rounded.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::number::Number;
use super::residue::Residue;
use crate::mathematics::symbolic::{Function, Rational};

/// As many coefficients are known from the first on.
const LENGTH: usize = 8;
const LENGTH_I32: i32 = 8;
/// From here on nothing is known of a number that is exact.
const NEVER: i32 = 1_000;
/// What rounding leaves where numbers cancel, with some digits to spare: what is taken for nothing is no mistake.
const ROUNDING: f64 = 1e-11;

/// What coefficients are.
pub(super) trait Coefficient: Number + PartialEq {
    fn is_defined(self) -> bool;

    /// `x + y`, zero where only rounding is left.
    fn sum(self, other: Self) -> Self;

    /// Whether it has a root, and isn't zero.
    fn has_root(self) -> bool;

    /// `Σ_{i ≥ n} C(i, n) (−1)ⁱ a^(i − n)/(2i + k)!` of `a`.
    fn stumpff(self, k: u8, n: usize) -> Self;
}

impl Coefficient for f64 {
    fn is_defined(self) -> bool {
        self.is_finite()
    }

    fn sum(self, other: Self) -> Self {
        let sum = self + other;
        if sum.abs() <= ROUNDING * (self.abs() + other.abs()) { 0.0 } else { sum }
    }

    fn has_root(self) -> bool {
        self > 0.0
    }

    fn stumpff(self, k: u8, n: usize) -> Self {
        let (mut sum, mut term) = (0.0, first_of_stumpff::<Self>(k, n));
        for i in n..n + 100 {
            sum += term;
            let next = 2 * i + usize::from(k);
            let [above, below, once, twice] = [i + 1, i + 1 - n, next + 1, next + 2].map(small::<Self>);
            term *= -self * above / (below * once * twice);
        }
        sum
    }
}

impl Coefficient for Residue {
    fn is_defined(self) -> bool {
        Self::is_defined(self)
    }

    fn sum(self, other: Self) -> Self {
        self + other
    }

    /// The stand-in for roots has a value everywhere.
    fn has_root(self) -> bool {
        Self::is_defined(self) && self != Self::ZERO
    }

    /// At zero; elsewhere the field has no such sums.
    fn stumpff(self, k: u8, n: usize) -> Self {
        if self == Self::ZERO { first_of_stumpff(k, n) } else { Self::UNDEFINED }
    }
}

/// `(−1)ⁿ/(2n + k)!`.
fn first_of_stumpff<T: Number>(k: u8, n: usize) -> T {
    let first = (1..=2 * n + usize::from(k)).fold(T::ONE, |product, i| product / small(i));
    if n.is_multiple_of(2) { first } else { -first }
}

/// With numbers that are rounded.
pub(super) type Series = PowerSeries<f64>;

/// `Σ c_i hⁱ + O(hᵉ)`, from the first power whose coefficient isn't zero; undefined where that is.
#[derive(Clone, Copy, Debug)]
pub(super) struct PowerSeries<T> {
    first: i32,
    /// The power `e` from which on nothing is known.
    end: i32,
    coefficients: [T; LENGTH],
}

impl<T: Coefficient> PowerSeries<T> {
    /// `h`.
    pub(super) const STEP: Self = Self::from_one_coefficient(1, T::ONE);

    const fn from_one_coefficient(first: i32, value: T) -> Self {
        let mut coefficients = [T::ZERO; LENGTH];
        coefficients[0] = value;
        Self { first, end: first + LENGTH_I32, coefficients }
    }

    pub(super) fn constant(value: T) -> Self {
        if value == T::ZERO { Self::ZERO } else { Self::from_one_coefficient(0, value) }
    }

    /// With the coefficients from the power `first` on.
    fn new(first: i32, end: i32, coefficients: [T; LENGTH]) -> Self {
        let end = end.min(first.saturating_add(LENGTH_I32));
        let known = usize::try_from(end.saturating_sub(first)).unwrap_or(0);
        let Some(zeros) = coefficients[..known].iter().position(|c| *c != T::ZERO) else {
            return Self { first: end, end, coefficients: [T::ZERO; LENGTH] };
        };
        let mut shifted = [T::ZERO; LENGTH];
        shifted[..known - zeros].copy_from_slice(&coefficients[zeros..known]);
        Self { first: first + i32::try_from(zeros).unwrap_or(0), end, coefficients: shifted }
    }

    /// The lowest power of `h`; none where all coefficients that are known are zero.
    pub(super) fn order(&self) -> Option<i32> {
        (!self.is_zero()).then_some(self.first)
    }

    pub(super) fn is_defined(&self) -> bool {
        self.coefficients.iter().all(|c| c.is_defined())
    }

    pub(super) fn is_zero(&self) -> bool {
        self.coefficients.iter().all(|c| *c == T::ZERO)
    }

    /// Whether all coefficients of lower powers are known.
    pub(super) const fn is_known_below(&self, power: i32) -> bool {
        self.end >= power
    }

    pub(super) fn at(&self, power: i32) -> T {
        let index = usize::try_from(power - self.first).ok();
        index.and_then(|index| self.coefficients.get(index)).copied().unwrap_or(T::ZERO)
    }

    fn reciprocal(self) -> Self {
        if self.is_zero() || !self.is_defined() {
            return Self::UNDEFINED;
        }
        let mut coefficients = [T::ZERO; LENGTH];
        coefficients[0] = T::ONE / self.coefficients[0];
        for n in 1..LENGTH {
            let sum = (1..=n).fold(T::ZERO, |sum, i| sum.sum(self.coefficients[i] * coefficients[n - i]));
            coefficients[n] = -sum * coefficients[0];
        }
        let length = self.end - self.first;
        Self::new(-self.first, length - self.first, coefficients)
    }

    /// `f(a + x)` with `x` the rest without the constant `a`, from the coefficients of Taylor's series about `a`.
    fn composed(self, taylor: &[T; LENGTH]) -> Self {
        let rest = self - Self::constant(self.at(0));
        let mut sum = Self::ZERO;
        for coefficient in taylor.iter().rev() {
            sum = sum * rest + Self::constant(*coefficient);
        }
        sum
    }

    /// Of an even power of `h` times a number that has a root.
    fn root(self) -> Self {
        if self.is_zero() {
            // The root of O(hᵉ) is O(h^(e/2)), that of an exact zero exactly zero.
            let end = if self.end >= NEVER { self.end } else { self.end / 2 };
            return Self { first: end, end, ..self };
        }
        if !self.coefficients[0].has_root() || self.first % 2 != 0 {
            return Self::UNDEFINED;
        }
        let half = self.first / 2;
        let unit = Self { first: 0, end: self.end - self.first, ..self };
        let first = unit.at(0).apply(Function::Sqrt);
        let (mut taylor, half_of_one) = ([first; LENGTH], T::of(Rational::new(1, 2)));
        for n in 1..LENGTH {
            taylor[n] = taylor[n - 1] * (half_of_one - small(n - 1)) / (small::<T>(n) * unit.at(0));
        }
        let root = unit.composed(&taylor);
        Self { first: root.first + half, end: root.end + half, ..root }
    }
}

/// Below a hundred.
fn small<T: Number>(n: usize) -> T {
    T::of(Rational::integer(i128::try_from(n).unwrap_or(0)))
}

/// `f⁽ⁿ⁾(a)/n!`.
fn taylor<T: Coefficient>(function: Function, a: T) -> [T; LENGTH] {
    let mut factorial = T::ONE;
    let [sine, cosine] = [Function::Sin, Function::Cos];
    std::array::from_fn(|n| {
        factorial = factorial * small(n.max(1));
        match function {
            Function::Exp => a.apply(function) / factorial,
            Function::Sin | Function::Cos => {
                let turned = n + usize::from(function == cosine);
                let value = a.apply(if turned.is_multiple_of(2) { sine } else { cosine });
                (if turned % 4 < 2 { value } else { -value }) / factorial
            }
            Function::Ln if n == 0 => a.apply(function),
            Function::Ln => -(-T::ONE / a).power(i32::try_from(n).unwrap_or(0)) / small(n),
            // Not asked for.
            Function::Sqrt => T::UNDEFINED,
            Function::LogRatio(k) => {
                a.apply(Function::LogRatio(k.saturating_add(u8::try_from(n).unwrap_or(u8::MAX)))) / factorial
            }
            Function::Stumpff(k) => a.stumpff(k, n),
        }
    })
}

impl<T: Coefficient> Add for PowerSeries<T> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        if !self.is_defined() || !other.is_defined() {
            return Self::UNDEFINED;
        }
        let (first, end) = (self.first.min(other.first), self.end.min(other.end));
        let mut coefficients = [T::ZERO; LENGTH];
        for (power, sum) in (first..end).zip(&mut coefficients) {
            *sum = self.at(power).sum(other.at(power));
        }
        Self::new(first, end, coefficients)
    }
}

impl<T: Coefficient> Neg for PowerSeries<T> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { coefficients: self.coefficients.map(|c| -c), ..self }
    }
}

impl<T: Coefficient> Sub for PowerSeries<T> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<T: Coefficient> Mul for PowerSeries<T> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        if !self.is_defined() || !other.is_defined() {
            return Self::UNDEFINED;
        }
        let first = self.first.saturating_add(other.first).min(NEVER);
        let end = self.end.saturating_add(other.first).min(other.end.saturating_add(self.first)).min(NEVER);
        let mut coefficients = [T::ZERO; LENGTH];
        for (n, sum) in coefficients.iter_mut().enumerate() {
            *sum = (0..=n).fold(T::ZERO, |sum, i| sum.sum(self.coefficients[i] * other.coefficients[n - i]));
        }
        Self::new(first, end, coefficients)
    }
}

impl<T: Coefficient> Div for PowerSeries<T> {
    type Output = Self;

    #[allow(clippy::suspicious_arithmetic_impl)] // by the reciprocal
    fn div(self, other: Self) -> Self {
        self * other.reciprocal()
    }
}

impl<T: Coefficient> Number for PowerSeries<T> {
    const ZERO: Self = Self { first: NEVER, end: NEVER, coefficients: [T::ZERO; LENGTH] };
    const ONE: Self = Self::from_one_coefficient(0, T::ONE);
    const UNDEFINED: Self = Self::from_one_coefficient(0, T::UNDEFINED);

    fn of(value: Rational) -> Self {
        Self::constant(T::of(value))
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
            _ => self.composed(&taylor(function, self.at(0))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Coefficient as _, LENGTH_I32, PowerSeries, Series, small};
    use crate::judged::verify::number::Number as _;
    use crate::judged::verify::residue::Residue;
    use crate::mathematics::symbolic::{Function, Rational};

    const H: f64 = 1e-2;

    /// The sum of what is known.
    fn value(series: Series) -> f64 {
        (series.first..series.end).map(|power| series.at(power) * H.powi(power)).sum()
    }

    fn assert_is(series: Series, order: i32, expected: f64) {
        assert_eq!(series.order(), Some(order), "{series:?}");
        let error = (value(series) - expected).abs();
        assert!(error <= 1e-13 * expected.abs() + H.powi(LENGTH_I32 - 1), "{series:?}: {} {expected}", value(series));
    }

    #[test]
    fn series_against_values() {
        let h = Series::STEP;
        let x = Series::constant(0.7) + h * Series::constant(0.3);
        let number = 0.7 + 0.3 * H;
        assert_is(x * x - Series::constant(0.49), 1, number * number - 0.49);
        assert_is(Series::ONE / (h * h * x), -2, 1.0 / (H * H * number));
        assert_is(x.power(-3), 0, number.powi(-3));
        assert_is((h * h * x).apply(Function::Sqrt), 1, H * number.sqrt());
        assert_is(h.apply(Function::Sin), 1, H.sin());
        assert_is(h.apply(Function::Cos) - Series::ONE, 2, H.cos() - 1.0);
        for function in [Function::Ln, Function::Exp, Function::Sin, Function::Cos, Function::Sqrt] {
            assert_is(x.apply(function), 0, function.apply(number));
        }
        for k in 0..4 {
            assert_is(x.apply(Function::Stumpff(k)), 0, Function::Stumpff(k).apply(number));
            assert_is(h.apply(Function::LogRatio(k)), 0, Function::LogRatio(k).apply(H));
        }
    }

    #[test]
    fn what_has_no_value() {
        let (h, zero) = (Series::STEP, Series::ONE - Series::ONE);
        assert!(zero.is_zero() && (zero * h).is_zero() && zero.order().is_none());
        for undefined in
            [Series::ONE / zero, zero.power(-1), h.apply(Function::Sqrt), (-Series::ONE).apply(Function::Ln)]
        {
            assert!(!undefined.is_defined() && !(undefined * zero + h).is_defined(), "{undefined:?}");
        }
        assert!(!(Series::ONE / h).apply(Function::Exp).is_defined());
    }

    /// That two are the same as far as both are known, which is up to a power at least.
    fn assert_equal(found: PowerSeries<Residue>, expected: PowerSeries<Residue>, known: i32) {
        let rest = found - expected;
        assert!(rest.is_defined() && rest.is_zero() && rest.is_known_below(known), "{found:?} and {expected:?}");
    }

    /// `a + b h + c h²` of numbers of the field.
    fn quadratic(next: &mut impl FnMut() -> Residue) -> PowerSeries<Residue> {
        let h = PowerSeries::STEP;
        let [a, b, c] = [next(), next(), next()].map(PowerSeries::constant);
        a + h * (b + h * c)
    }

    /// `y' = y/(2x)` for a root, whatever stands in for it, so that `y²/x` stays what it is at the first coefficient.
    #[test]
    fn roots_in_the_field() {
        let (mut next, h) = (Residue::stream(3), PowerSeries::STEP);
        for half in [0, 1, 2] {
            let x = quadratic(&mut next);
            let root = (x * h.power(2 * half)).apply(Function::Sqrt);
            let [first, of_first] = [x.at(0), x.at(0).apply(Function::Sqrt)].map(PowerSeries::constant);
            assert_eq!(root.order(), Some(half));
            assert_eq!(root.at(half), of_first.at(0));
            assert_equal(root * root * first, x * h.power(2 * half) * of_first * of_first, LENGTH_I32);
        }
        for undefined in [h, h.power(3), PowerSeries::UNDEFINED] {
            assert!(!undefined.apply(Function::Sqrt).is_defined(), "{undefined:?}");
        }
        assert!(!Residue::ZERO.has_root() && !Residue::UNDEFINED.has_root());
    }

    /// Against the chain rule, `f(x(h))' = f'(x) x'`, and `1/(1 − h) = Σ hⁿ`.
    #[test]
    fn functions_in_the_field() {
        let (mut next, h, one) = (Residue::stream(4), PowerSeries::<Residue>::STEP, PowerSeries::<Residue>::ONE);
        let slope = |y: PowerSeries<Residue>| {
            let terms = (1..LENGTH_I32).map(|n| {
                let factor = Residue::of(Rational::integer(n.into()));
                PowerSeries::constant(y.at(n) * factor) * h.power(n - 1)
            });
            terms.fold(PowerSeries::ZERO, |sum, term| sum + term)
        };
        // The slope is known below the power that the series of seven coefficients ends at.
        let assert_slope = |y, expected: PowerSeries<Residue>| {
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
            assert_eq!(x.apply(Function::Ln).at(0), x.at(0).apply(Function::Ln));
            assert_equal(x * x.power(-1), one, LENGTH_I32);
        }
        let geometric = one / (one - h);
        assert!((0..LENGTH_I32).all(|n| geometric.at(n) == Residue::ONE));
    }

    /// `Σ (−x)ⁱ/(2i + k)!` about zero; the field has no such sums elsewhere.
    #[test]
    fn stumpff_in_the_field() {
        let (h, one) = (PowerSeries::<Residue>::STEP, PowerSeries::<Residue>::ONE);
        for k in 0..4_u8 {
            let series = h.apply(Function::Stumpff(k));
            let mut expected = (1..=k).fold(Residue::ONE, |product, n| product / small(n.into()));
            for power in 0..LENGTH_I32 {
                assert_eq!(series.at(power), expected, "{k}");
                let next = usize::try_from(2 * power).expect("positive") + usize::from(k);
                expected = -expected / (small::<Residue>(next + 1) * small(next + 2));
            }
            assert!(!(one + h).apply(Function::Stumpff(k)).is_defined());
        }
    }
}
