//! A bound on the degree of whatever is computed, as a rational function of the numbers that are random.
//!
//! Schwartz and Zippel: a polynomial that isn't zero vanishes at a random point of a field of `p` elements with a
//! probability of at most its degree over `p`. Degrees are computed as numbers are, so the bound is that of the very
//! operations that are compared.

use std::collections::BTreeSet;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::rc::Rc;

use super::number::{self, Number};
use super::sample::Element;
use super::value::Value;
use crate::declared::{Kind, Tree};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Function, Rational};
use crate::program::{Graph, Node};

/// A wrong identity passes with a probability below `2⁻ⁿ` for this `n`.
const ENOUGH: u32 = 100;
/// With more points than these it takes too long.
const MOST_POINTS: u32 = 12;

/// Of a numerator, and of a denominator `Δⁿ r` with the denominator `Δ` that the entries of group elements share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Degree {
    is_zero: bool,
    numerator: u64,
    /// Of `Δⁿ`.
    common: u64,
    rest: u64,
    /// The largest of the differences of arguments of functions.
    argument: u64,
}

impl Degree {
    /// A random number.
    pub(super) const VARIABLE: Self = Self { numerator: 1, ..Self::ONE };

    /// An entry of a group element.
    pub(super) fn of_element(degree: u64) -> Self {
        Self { numerator: degree, common: degree, ..Self::ONE }
    }

    fn over(self, common: u64, rest: u64) -> u64 {
        self.numerator.saturating_add(common - self.common).saturating_add(rest)
    }

    fn of_product(self, other: Self) -> Self {
        Self {
            is_zero: self.is_zero || other.is_zero,
            numerator: self.numerator.saturating_add(other.numerator),
            common: self.common.saturating_add(other.common),
            rest: self.rest.saturating_add(other.rest),
            argument: self.argument.max(other.argument),
        }
    }
}

impl Add for Degree {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let argument = self.argument.max(other.argument);
        if self.is_zero || other.is_zero {
            let sum = if self.is_zero { other } else { self };
            return Self { argument, ..sum };
        }
        let common = self.common.max(other.common);
        let numerator = self.over(common, other.rest).max(other.over(common, self.rest));
        Self { is_zero: false, numerator, common, rest: self.rest.saturating_add(other.rest), argument }
    }
}

impl Sub for Degree {
    type Output = Self;

    #[allow(clippy::suspicious_arithmetic_impl)] // the degrees of a sum
    fn sub(self, other: Self) -> Self {
        self + other
    }
}

impl Mul for Degree {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        self.of_product(other)
    }
}

impl Div for Degree {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let numerator = other.rest.saturating_add(other.common);
        let reciprocal = Self { numerator, common: 0, rest: other.numerator, ..other };
        let Some(left) = self.common.checked_sub(other.common) else { return self.of_product(reciprocal) };
        // Powers of the shared denominator cancel.
        let rest = Self { common: left, ..self };
        rest.of_product(Self { numerator: other.rest, ..reciprocal })
    }
}

impl Neg for Degree {
    type Output = Self;

    fn neg(self) -> Self {
        self
    }
}

impl Number for Degree {
    const ZERO: Self = Self { is_zero: true, ..Self::ONE };
    const ONE: Self = Self { is_zero: false, numerator: 0, common: 0, rest: 0, argument: 0 };
    const UNDEFINED: Self = Self { numerator: u64::MAX, ..Self::ONE };

    fn of(value: Rational) -> Self {
        if value.is_zero() { Self::ZERO } else { Self::ONE }
    }

    fn power(self, exponent: i32) -> Self {
        let times = |degree: u64| degree.saturating_mul(exponent.unsigned_abs().into());
        let [numerator, common, rest] = [self.numerator, self.common, self.rest].map(times);
        let power = Self { numerator, common, rest, ..self };
        if exponent < 0 { Self::ONE / power } else { power }
    }

    /// A number that is as good as random, or its reciprocal, or what follows from these.
    fn apply(self, function: Function) -> Self {
        let whole = self.numerator.saturating_add(self.common).saturating_add(self.rest);
        let argument = self.argument.max(whole.saturating_mul(2));
        let value = number::of_those_below(function, self).unwrap_or(Self { numerator: 1, rest: 1, ..Self::ONE });
        Self { argument, ..value }
    }
}

/// The degrees of an element by Cayley transforms and of its coordinates; `Δ` is the product of all of their denominators
/// and of those of as many attitudes that are seen.
pub(super) fn element(group: &Group, attitudes: usize) -> (Element<Degree>, Degree) {
    let of_factor = |own: &Group| match own {
        _ if own.is_added => 0,
        _ if own.is_so3 => 1,
        _ => own.dimension(),
    };
    let transforms = attitudes + group.factors().iter().map(of_factor).sum::<usize>();
    // cay(tE) is a quotient of polynomials of degree 2, or less, as the numerator and denominator of cay(2y) are.
    let entry = Degree::of_element(2 * u64::try_from(transforms).unwrap_or(u64::MAX / 2));
    let matrix = super::by_blocks(group, |factor| {
        let own = group.factor(factor);
        Value::new(own.size, own.size, |row, column| match (row == column, column + 1 == own.size) {
            _ if !own.is_added => entry,
            (true, _) => Degree::ONE,
            (false, true) => Degree::VARIABLE,
            (false, false) => Degree::ZERO,
        })
    });
    let coordinates = vec![Degree::VARIABLE; group.dimension()];
    (Element { inverse: matrix.clone(), matrix, coordinates }, entry)
}

/// How many functions a tree calls.
pub(super) fn functions(tree: &Rc<Tree>) -> u64 {
    let (mut seen, mut open, mut count) = (BTreeSet::new(), vec![tree], 0);
    while let Some(tree) = open.pop() {
        if seen.insert(Rc::as_ptr(tree)) {
            count += u64::from(matches!(tree.kind, Kind::Apply(..)));
            open.extend(tree.kind.operands().into_iter().flatten());
        }
    }
    count
}

/// How many functions a graph calls.
pub(super) fn calls(graph: &Graph) -> u64 {
    u64::try_from(graph.nodes().filter(|node| matches!(node, Node::Apply(..))).count()).unwrap_or(u64::MAX)
}

/// The largest degrees of all that is compared.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Largest {
    numerator: u64,
    argument: u64,
}

impl Largest {
    pub(super) fn compared(&mut self, found: Degree, expected: Degree) {
        let difference = found - expected;
        self.numerator = self.numerator.max(if difference.is_zero { 0 } else { difference.numerator });
        self.argument = self.argument.max(difference.argument);
    }

    /// How often what differs coincides at a random point, in units of `1/p`: a value, or two of the arguments of that
    /// many functions, each of which stands for its negative or reciprocal as well.
    pub(super) fn coincidences(self, functions: u64) -> u64 {
        let pairs = functions.saturating_mul(4).saturating_pow(2);
        self.numerator.saturating_add(pairs.saturating_mul(self.argument))
    }

    pub(super) fn sureness(self, functions: u64) -> Option<Sureness> {
        Sureness::of(self.coincidences(functions))
    }
}

/// How many points are compared, and how sure that is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Sureness {
    pub(super) points: u32,
    /// What is wrong passes with a probability below `2⁻ⁿ`.
    pub(super) exponent: u32,
}

impl Sureness {
    /// `None` where no few points are enough.
    fn of(coincidences: u64) -> Option<Self> {
        // Of the field's 2⁶¹ − 1 elements none is drawn more than 9/8 times as often as another, and at least half of the
        // points have values: 9/8 · 2/(2⁶¹ − 1) < 2⁻⁵⁹.
        let of_point = 59_u32.checked_sub(u64::BITS - coincidences.leading_zeros()).filter(|&bits| bits > 0)?;
        let points = ENOUGH.div_ceil(of_point);
        (points <= MOST_POINTS).then_some(Self { points, exponent: points * of_point })
    }
}
