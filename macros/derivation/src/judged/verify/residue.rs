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
pub(super) struct Residue(Option<u64>);

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
    pub(super) fn stream(seed: u64) -> impl FnMut() -> Self {
        let mut state = mixed(seed);
        STAND_INS.set(state);
        KNOWN.with_borrow_mut(BTreeMap::clear);
        move || {
            state = mixed(state);
            Self(Some(state % PRIME))
        }
    }

    /// Prescribes `c_0` and `c_1` at this argument, until the next stream.
    pub(super) fn remember(self, values: [Self; 2]) {
        KNOWN.with_borrow_mut(|known| self.0.map(|argument| known.insert(argument, values)));
    }

    /// The fraction of small whole numbers that this element represents, if there is one.
    pub(super) fn small(self) -> Option<Rational> {
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
pub(super) fn mixed(state: u64) -> u64 {
    let z = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::{Number, Residue};
    use crate::judged::verify::dual::Dual;
    use crate::mathematics::symbolic::{Function, Rational};

    #[test]
    fn it_is_a_field() {
        let mut next = Residue::stream(1);
        for _ in 0..20 {
            let (a, b, c) = (next(), next(), next());
            assert_eq!((a + b) * c - a * c, b * c);
            assert_eq!(a / b * b, a);
            assert_eq!(a.power(-3) * a * a * a, Residue::ONE);
        }
        assert!(!(Residue::ONE / Residue::ZERO).is_defined());
        assert!(!(Residue::ONE / Residue::ZERO * Residue::ZERO).is_defined());
    }

    #[test]
    fn rational_numbers_keep_their_relations() {
        let of = |numerator, denominator| Residue::of(Rational::new(numerator, denominator));
        assert_eq!(of(1, 3) + of(-5, 7), of(-8, 21));
        assert_eq!(of(2, 9) * of(9, 2), Residue::ONE);
    }

    #[test]
    fn functions_keep_no_other_relations() {
        let mut next = Residue::stream(2);
        for _ in 0..20 {
            let x = next();
            assert_ne!((-x).apply(Function::Sqrt), x.apply(Function::Sqrt));
            assert_ne!(x.apply(Function::Stumpff(1)), x.apply(Function::Stumpff(2)));
            // Relations that no derivation uses.
            let squared = |function| x.apply(function) * x.apply(function);
            assert_ne!((x * x).apply(Function::Sqrt), x);
            assert_ne!(squared(Function::Sqrt), x);
            assert_ne!(squared(Function::Sin) + squared(Function::Cos), Residue::ONE);
            assert_ne!(squared(Function::Stumpff(0)) + x * squared(Function::Stumpff(1)), Residue::ONE);
            assert_ne!(x.apply(Function::Exp).apply(Function::Ln), x);
            assert_ne!((x + x).apply(Function::Exp), squared(Function::Exp));
            assert_ne!((x * x).apply(Function::Ln), x.apply(Function::Ln) + x.apply(Function::Ln));
        }
        assert_eq!(Residue::ZERO.apply(Function::Cos), Residue::ONE);
        assert_eq!(Residue::ONE.apply(Function::Ln), Residue::ZERO);
        assert!(!Residue::ZERO.apply(Function::Ln).is_defined());
    }

    /// Else a wrong share of `√2` would be right at all points, or wrong at all.
    #[test]
    fn functions_differ_from_point_to_point() {
        let two = Residue::ONE + Residue::ONE;
        for function in [Function::Sqrt, Function::Sin, Function::Exp, Function::Ln, Function::Stumpff(1)] {
            let values = [5, 6, 5].map(|seed| {
                let _ = Residue::stream(seed);
                two.apply(function)
            });
            assert!(values[0] != values[1] && values[0] == values[2], "{function:?}");
        }
    }

    /// The symmetries, `c_k = 1/k! − q c_{k+2}`, and what the derivatives of `θ/sin θ` follow from, as far as they are asked
    /// for.
    fn assert_relations<T: Number>(x: T) {
        let of = |value: u8| T::of(Rational::integer(value.into()));
        let none = |rest: T| assert!(rest.is_zero(), "{rest:?} at {x:?}");
        none((-x).apply(Function::Sin) + x.apply(Function::Sin));
        none((-x).apply(Function::Cos) - x.apply(Function::Cos));
        none((-x).apply(Function::Exp) * x.apply(Function::Exp) - T::ONE);
        none((T::ONE / x).apply(Function::Ln) + x.apply(Function::Ln));
        let mut factorial = T::ONE;
        for k in 0..12 {
            factorial = if k == 0 { factorial } else { factorial * of(k) };
            let [value, above] = [k, k + 2].map(|k| x.apply(Function::Stumpff(k)));
            none(value + x * above - T::ONE / factorial);
        }
        let (u, s) = (x * (T::ONE - x), T::ONE - of(2) * x);
        let g = |k| x.apply(Function::LogRatio(k));
        none(of(2) * u * g(1) + s * g(0) - T::ONE);
        for k in 0..6 {
            none(of(2) * u * g(k + 2) + of(2 * k + 3) * s * g(k + 1) - of(2) * of(k + 1) * of(k + 1) * g(k));
        }
        // What a graph makes of the second derivative.
        none(g(1) * (of(3) - of(8) * u) - of(2) * (T::ONE - s * u * g(2)));
    }

    /// The derivative of each relation is a relation: dual numbers and stand-ins know the same functions.
    #[test]
    fn functions_keep_their_relations() {
        let mut next = Residue::stream(3);
        for _ in 0..20 {
            assert_relations(next());
            assert_relations(Dual { value: next(), slope: next() });
        }
    }
}
