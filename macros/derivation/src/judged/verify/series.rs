//! Power series in `h` with coefficients in the finite field, where nothing is rounded: the order of a declared
//! expression as `h → 0`.

use super::number::{self, Number, operator};
use super::residue::Residue;
use crate::mathematics::symbolic::{Function, Rational};

/// The number of coefficients, from the first nonzero one on.
const LENGTH: usize = 8;
const LENGTH_I32: i32 = 8;
/// The `end` of an exact number.
const NEVER: i32 = 1_000;

type Coefficients = [Residue; LENGTH];
const NONE: Coefficients = [Residue::ZERO; LENGTH];

/// `Σ c_i hⁱ + O(hᵉ)`, from the first power with a nonzero coefficient; undefined if a coefficient is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Series {
    first: i32,
    /// The order `e` of the remainder.
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

    /// The series with these coefficients from the power `first` on.
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

    /// The lowest power of `h`; `None` if all known coefficients are zero.
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

    /// The series with a remainder of lower order.
    fn until(self, end: i32) -> Self {
        Self::new(self.first, self.end.min(end), self.coefficients)
    }

    /// The derivative by `h`.
    fn slope(self) -> Self {
        let factors = (self.first..).map(|power| Residue::of(Rational::integer(power.into())));
        let mut coefficients = self.coefficients;
        coefficients.iter_mut().zip(factors).for_each(|(one, factor)| *one = *one * factor);
        Self::new(self.first - 1, self.end - 1, coefficients)
    }

    /// `f(x) = f(x(0)) + ∫ f′(x) x′ dh`, where `f′(x)` is needed to one power less.
    fn integrated(self, function: Function) -> Self {
        let (end, mut coefficients) = (self.end.min(LENGTH_I32), NONE);
        coefficients[0] = self.at(0).apply(function);
        if end > 1 {
            let x = self.until(end - 1);
            let derivative = match function {
                // The form y/(2x) keeps `y²/x` constant, although the square of a stand-in isn't its argument.
                Function::Sqrt => Self::of(Rational::new(1, 2)) * x.apply(function) / x,
                _ => number::derivative(function, x, || x.apply(function)),
            };
            let slope = derivative * self.slope();
            for (power, coefficient) in (1..end).zip(&mut coefficients[1..]) {
                *coefficient = slope.at(power - 1) / Residue::of(Rational::integer(power.into()));
            }
        }
        Self::new(0, end, coefficients)
    }

    /// The square root of an even power of `h` times a series with a nonzero constant.
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
        let root = unit.integrated(Function::Sqrt);
        Self { first: root.first + middle, end: root.end + middle, ..root }
    }
}

operator!(impl Add::add for Series, |a, b| {
    if !a.is_defined() || !b.is_defined() {
        return Self::UNDEFINED;
    }
    let (first, end) = (a.first.min(b.first), a.end.min(b.end));
    let mut coefficients = NONE;
    for (power, sum) in (first..end).zip(&mut coefficients) {
        *sum = a.at(power) + b.at(power);
    }
    Self::new(first, end, coefficients)
});
operator!(impl Neg::neg for Series, |a| Self { coefficients: a.coefficients.map(|c| -c), ..a });
operator!(impl Sub::sub for Series, |a, b| a + -b);
operator!(impl Mul::mul for Series, |a, b| {
    if !a.is_defined() || !b.is_defined() {
        return Self::UNDEFINED;
    }
    let first = a.first.saturating_add(b.first).min(NEVER);
    let end = a.end.saturating_add(b.first).min(b.end.saturating_add(a.first)).min(NEVER);
    let mut coefficients = NONE;
    // Most numbers have one nonzero coefficient.
    for (i, &x) in a.coefficients.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
        for (&y, sum) in b.coefficients.iter().zip(&mut coefficients[i..]).filter(|(y, _)| !y.is_zero()) {
            *sum = *sum + x * y;
        }
    }
    Self::new(first, end, coefficients)
});
operator!(impl Div::div for Series, |a, b| a * b.reciprocal());

impl Number for Series {
    const ZERO: Self = Self { first: NEVER, end: NEVER, coefficients: NONE };
    const ONE: Self = Self::from_one_coefficient(0, Residue::ONE);
    const UNDEFINED: Self = Self::from_one_coefficient(0, Residue::UNDEFINED);

    fn of(value: Rational) -> Self {
        Self::constant(Residue::of(value))
    }

    fn power(self, exponent: i32) -> Self {
        let factor = if exponent < 0 { self.reciprocal() } else { self };
        number::raised(factor, exponent.unsigned_abs().into())
    }

    fn apply(self, function: Function) -> Self {
        match function {
            _ if !self.is_defined() => Self::UNDEFINED,
            Function::Sqrt => self.root(),
            _ if self.first < 0 => Self::UNDEFINED,
            // The series is a constant.
            _ if self.first == NEVER || self.first == 0 && self.coefficients[1..].iter().all(|c| c.is_zero()) => {
                let constant = Self::from_one_coefficient(0, self.at(0).apply(function));
                Self::new(0, self.end, constant.coefficients)
            }
            _ => self.integrated(function),
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
    use super::{LENGTH_I32, Series};
    use crate::judged::verify::number::{Number as _, derivative};
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

    /// Against the chain rule, `f(x(h))' = f'(x) x'` with the derivatives that dual numbers have, and `1/(1 − h) = Σ hⁿ`.
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
        let families = [0, 1, 2].into_iter().flat_map(|k| [Function::Stumpff(k), Function::LogRatio(k)]);
        let functions: Vec<Function> =
            [Function::Ln, Function::Exp, Function::Sin, Function::Cos].into_iter().chain(families).collect();
        for _ in 0..3 {
            let x = quadratic(&mut next);
            for &function in &functions {
                let of_x = x.apply(function);
                assert_slope(of_x, derivative(function, x, || of_x) * slope(x));
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
        let small = |n: usize| Residue::of(Rational::integer(n.try_into().expect("small")));
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
