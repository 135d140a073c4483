//! Whole numbers modulo the prime `2⁶¹ − 1`: arithmetic without rounding, in which rational functions that differ have
//! different values at nearly all points.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

use super::number::{self, Number, operator};
use crate::mathematics::symbolic::{Function, Rational};

const PRIME: u64 = (1 << 61) - 1;

thread_local! {
    /// The seed of the stand-ins for functions. Each stream has another one, so that functions of constants, as
    /// `2.0.sqrt()`, have different values at different points.
    static STAND_INS: Cell<u64> = const { Cell::new(0) };
    /// Arguments with prescribed values of `c_0` and `c_1`.
    static KNOWN: RefCell<BTreeMap<u64, [Residue; 2]>> = const { RefCell::new(BTreeMap::new()) };
}

/// The limit on numerators and denominators that are recognised as a fraction.
const LARGEST: i128 = 64;

/// An element of the field; `None` if there is no value, as after a division by zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Residue(Option<u64>);

/// `x mod p` of an `x` below `2¹²²`, as `2⁶¹ = 1` in the field.
fn folded(x: u128) -> u64 {
    let low = |x: u128| u64::try_from(x & u128::from(PRIME)).unwrap_or(0);
    let sum = low(x) + low(x >> 61);
    if sum >= PRIME { sum - PRIME } else { sum }
}

impl Residue {
    /// The residue of any whole number.
    fn reduced(value: i128) -> Self {
        let size = value.unsigned_abs();
        let size = Self(Some(if size >> 121 == 0 { folded(size) } else { folded(size % u128::from(PRIME)) }));
        if value < 0 { -size } else { size }
    }

    /// A pseudorandom stream of elements; it also selects new stand-ins for functions.
    pub fn stream(seed: u64) -> impl FnMut() -> Self {
        let mut state = mixed(seed);
        STAND_INS.set(state);
        KNOWN.with_borrow_mut(BTreeMap::clear);
        move || {
            state = mixed(state);
            Self(Some(state % PRIME))
        }
    }

    /// Prescribes `c_0` and `c_1` at this argument, until the next stream.
    pub fn remember(self, values: [Self; 2]) {
        KNOWN.with_borrow_mut(|known| self.0.map(|argument| known.insert(argument, values)));
    }

    /// The fraction of small whole numbers that this element represents, if there is one.
    pub fn small(self) -> Option<Rational> {
        let value = i128::from(self.0?);
        let centred = |value: i128| if 2 * value > i128::from(PRIME) { value - i128::from(PRIME) } else { value };
        let fractions = (1..=LARGEST).map(|q| (centred((value * q).rem_euclid(PRIME.into())), q));
        fractions.into_iter().find(|(p, _)| p.abs() <= LARGEST).map(|(p, q)| Rational::new(p, q))
    }

    /// The result of an operation that stays below `2¹²²` for any two elements.
    fn with(self, other: Self, operation: impl Fn(u64, u64) -> u128) -> Self {
        match (self.0, other.0) {
            (Some(a), Some(b)) => Self(Some(folded(operation(a, b)))),
            _ => Self(None),
        }
    }

    /// The inverse by Fermat's theorem, `a^(p − 2)`.
    fn reciprocal(self) -> Self {
        if self == Self::ZERO { Self::UNDEFINED } else { number::raised(self, PRIME - 2) }
    }
}

operator!(impl Add::add for Residue, |a, b| a.with(b, |a, b| (a + b).into()));
operator!(impl Sub::sub for Residue, |a, b| a.with(b, |a, b| (a + PRIME - b).into()));
operator!(impl Mul::mul for Residue, |a, b| a.with(b, |a, b| u128::from(a) * u128::from(b)));
operator!(impl Div::div for Residue, |a, b| a * b.reciprocal());
operator!(impl Neg::neg for Residue, |a| Self::ZERO - a);

impl Number for Residue {
    const ZERO: Self = Self(Some(0));
    const ONE: Self = Self(Some(1));
    const UNDEFINED: Self = Self(None);

    fn of(value: Rational) -> Self {
        let (numerator, denominator) = value.parts();
        // Most denominators are powers of two, and as 2⁶¹ = 1 a division by 2ⁿ is a product with 2⁶¹⁻ⁿ.
        let halvings = denominator.trailing_zeros() % 61;
        let halved = Self(Some(folded(1 << (61 - halvings))));
        let (numerator, odd) = (Self::reduced(numerator) * halved, denominator >> denominator.trailing_zeros());
        if odd == 1 { numerator } else { numerator / Self::reduced(odd) }
    }

    fn power(self, exponent: i32) -> Self {
        let power = number::raised(self, exponent.unsigned_abs().into());
        if exponent < 0 { power.reciprocal() } else { power }
    }

    /// The field has no sines or logarithms. Pseudorandom functions with the same symmetries and recurrences stand in
    /// for them. An identity that holds for these holds for all functions with these relations, wherever both sides
    /// have values.
    fn apply(self, function: Function) -> Self {
        let partner = match function {
            Function::Sin | Function::Cos | Function::Exp => -self,
            Function::Ln => self.reciprocal(),
            Function::Sqrt | Function::Stumpff(_) | Function::LogRatio(_) => self,
        };
        let (Some(argument), Some(other)) = (self.0, partner.0) else { return Self::UNDEFINED };
        if argument == 0
            && let Some(value) = function.at_zero()
        {
            return Self::of(value);
        }
        if let Function::Stumpff(k @ ..2) = function
            && let Some(known) = KNOWN.with_borrow(|known| known.get(&argument).copied())
        {
            return known[usize::from(k)];
        }
        if let Some(value) = number::of_those_below(function, self) {
            return value;
        }
        let number = u64::try_from(function.number()).unwrap_or(u64::MAX);
        let value = Self(Some(mixed(mixed(argument.min(other) ^ STAND_INS.get()) ^ number) % PRIME));
        match function {
            Function::Ln if argument == other => Self::ZERO,
            _ if argument <= other => value,
            Function::Sin | Function::Ln => -value,
            Function::Exp => value.reciprocal(),
            _ => value,
        }
    }

    fn is_defined(self) -> bool {
        self.0.is_some()
    }

    fn is_zero(self) -> bool {
        self == Self::ZERO
    }
}

/// A step of `SplitMix64` (Steele, Lea and Flood 2014).
pub fn mixed(state: u64) -> u64 {
    let z = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
