//! Power series in `h` with coefficients in the finite field, where nothing is rounded: the order of a declared
//! expression as `h → 0`.

use super::number::{self, Number, operator};
use super::residue::Residue;
use crate::mathematics::symbolic::{Function, Rational};

/// The number of coefficients, from the first nonzero one on.
const LENGTH: usize = 8;
pub const LENGTH_I32: i32 = 8;
/// The `end` of an exact number.
const NEVER: i32 = 1_000;

type Coefficients = [Residue; LENGTH];
const NONE: Coefficients = [Residue::ZERO; LENGTH];

/// `Σ c_i hⁱ + O(hᵉ)`, from the first power with a nonzero coefficient; undefined if a coefficient is.
#[derive(Clone, Copy, Debug)]
pub struct Series {
    first: i32,
    /// The order `e` of the remainder.
    end: i32,
    coefficients: Coefficients,
}

impl Series {
    /// The series of the step `h`.
    pub const STEP: Self = Self::from_one_coefficient(1, Residue::ONE);

    const fn from_one_coefficient(first: i32, value: Residue) -> Self {
        let mut coefficients = NONE;
        coefficients[0] = value;
        Self { first, end: first + LENGTH_I32, coefficients }
    }

    pub fn constant(value: Residue) -> Self {
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
    pub fn order(&self) -> Option<i32> {
        (!self.is_zero()).then_some(self.first)
    }

    /// Whether all coefficients of lower powers are known.
    pub const fn is_known_below(&self, power: i32) -> bool {
        self.end >= power
    }

    pub fn at(&self, power: i32) -> Residue {
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
