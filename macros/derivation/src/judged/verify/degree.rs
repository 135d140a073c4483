//! A bound on the degree of a computed value, as a rational function of the random numbers.
//!
//! Schwartz and Zippel: a polynomial that isn't zero vanishes at a random point of a field of `p` elements with a
//! probability of at most its degree over `p`. Degrees are computed by the same operations as the values, so the bound
//! belongs to the operations that are compared.

use std::ops::Add;
use std::rc::Rc;

use super::number::{self, Number, operator};
use super::residue::{Residue, mixed};
use super::sample::Element;
use super::value::Value;
use super::{Values, turned};
use crate::declared::{Declaration, FieldKind, Kind, Name, Tree, parts};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Function, Rational};
use crate::program::{Graph, Node};

/// The exponent `n`: a wrong identity may pass with a probability below `2⁻ⁿ`.
const ENOUGH: u32 = 100;
/// The limit on points, by the time that they take.
const MOST_POINTS: u32 = 16;
/// The number of additional points, as some may have no value.
pub const SPARE: u32 = 5;

/// The degrees of a numerator and of a denominator `Δᵐ Dⁿ r`. The denominator `Δ` is common to the entries of group
/// elements; `D` is one divisor, as sums of quotients by one number have one denominator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Degree {
    is_zero: bool,
    numerator: u64,
    /// The degree of `Δᵐ`.
    common: u64,
    /// The degree of `Dⁿ`, and the name of `D`.
    divisor: (u64, u64),
    rest: u64,
    /// The largest degree of a difference between two arguments of functions.
    argument: u64,
    /// A hash of the operations: two numbers with one name are equal.
    name: u64,
}

impl Degree {
    /// A stream of random numbers.
    pub fn stream() -> impl FnMut() -> Self {
        let mut number = 0;
        move || {
            number += 1;
            Self { numerator: 1, name: mixed(number), ..Self::ONE }
        }
    }

    /// The degree of an entry of a group element.
    pub fn of_element(self, degree: u64) -> Self {
        Self { numerator: degree, common: degree, ..self }
    }

    fn named(self, operation: u64, [a, b]: [u64; 2]) -> Self {
        Self { name: mixed(mixed(operation ^ a).rotate_left(7) ^ b), ..self }
    }

    /// The pair with the divisor of higher degree alone; the other one is multiplied into the rest.
    fn with_one_divisor(self, other: Self) -> [Self; 2] {
        let (_, kept) = self.divisor.max(other.divisor);
        [self, other].map(|one| match one.divisor {
            (degree, of) if of != kept => Self { divisor: (0, kept), rest: one.rest.saturating_add(degree), ..one },
            _ => one,
        })
    }

    fn of_product(self, other: Self) -> Self {
        let [a, b] = self.with_one_divisor(other);
        Self {
            is_zero: a.is_zero || b.is_zero,
            numerator: a.numerator.saturating_add(b.numerator),
            common: a.common.saturating_add(b.common),
            divisor: (a.divisor.0.saturating_add(b.divisor.0), a.divisor.1),
            rest: a.rest.saturating_add(b.rest),
            argument: a.argument.max(b.argument),
            ..Self::ONE
        }
    }
}

operator!(impl Add::add for Degree, |a, b| {
    let argument = a.argument.max(b.argument);
    if a.is_zero || b.is_zero {
        let sum = if a.is_zero { b } else { a };
        return Self { argument, ..sum };
    }
    let names = [a.name.min(b.name), a.name.max(b.name)];
    // The sum has a common denominator.
    let [a, b] = a.with_one_divisor(b);
    let (common, divisor) = (a.common.max(b.common), a.divisor.max(b.divisor));
    let over = |one: Self, rest: u64| {
        let factors = [common - one.common, divisor.0 - one.divisor.0, rest];
        factors.into_iter().fold(one.numerator, u64::saturating_add)
    };
    let (numerator, rest) = (over(a, b.rest).max(over(b, a.rest)), a.rest.saturating_add(b.rest));
    Self { numerator, common, divisor, rest, argument, ..Self::ONE }.named(1, names)
});
operator!(impl Sub::sub for Degree, |a, b| a + -b);
operator!(impl Mul::mul for Degree, |a, b| a.of_product(b).named(2, [a.name.min(b.name), a.name.max(b.name)]));
operator!(impl Div::div for Degree, |a, b| {
    // Powers of the shared denominator cancel.
    let left = a.common.saturating_sub(b.common);
    let above = b.common.saturating_sub(a.common);
    let numerator = [b.divisor.0, above].into_iter().fold(b.rest, u64::saturating_add);
    let divisor = (b.numerator, if b.numerator == 0 { 0 } else { b.name });
    let reciprocal = Self { numerator, common: 0, divisor, rest: 0, ..b };
    Self { common: left, ..a }.of_product(reciprocal).named(3, [a.name, b.name])
});
operator!(impl Neg::neg for Degree, |a| Self { name: !a.name, ..a });

impl Number for Degree {
    const ZERO: Self = Self { is_zero: true, ..Self::ONE };
    const ONE: Self = Self { is_zero: false, numerator: 0, common: 0, divisor: (0, 0), rest: 0, argument: 0, name: 0 };
    const UNDEFINED: Self = Self { numerator: u64::MAX, ..Self::ONE };

    fn of(value: Rational) -> Self {
        let (numerator, denominator) = value.parts();
        let name = |whole: i128| whole.to_le_bytes().into_iter().fold(0, |name, byte| mixed(name ^ u64::from(byte)));
        let one = if value.is_zero() { Self::ZERO } else { Self::ONE };
        one.named(4, [numerator, denominator].map(name))
    }

    fn power(self, exponent: i32) -> Self {
        if exponent == 0 {
            return Self { argument: self.argument, ..Self::ONE };
        }
        let times = |degree: u64| degree.saturating_mul(exponent.unsigned_abs().into());
        let [numerator, common, rest] = [self.numerator, self.common, self.rest].map(times);
        let divisor = (times(self.divisor.0), self.divisor.1);
        let power = Self { numerator, common, divisor, rest, ..self };
        let power = power.named(5, [self.name, exponent.unsigned_abs().into()]);
        if exponent < 0 { Self::ONE / power } else { power }
    }

    /// The value of a function: a random number, for an exponential maybe its reciprocal, or a member of a family
    /// computed from lower ones.
    fn apply(self, function: Function) -> Self {
        let parts = [self.common, self.divisor.0, self.rest];
        let whole = parts.into_iter().fold(self.numerator, u64::saturating_add);
        let argument = self.argument.max(whole.saturating_mul(2));
        let variable = Self { rest: u64::from(function == Function::Exp), numerator: 1, ..Self::ONE };
        let value = number::of_those_below(function, self).unwrap_or(variable);
        let number = u64::try_from(function.number()).unwrap_or(u64::MAX);
        Self { argument, ..value }.named(6, [self.name, number])
    }

    fn is_defined(self) -> bool {
        self.numerator < u64::MAX
    }

    fn is_zero(self) -> bool {
        self.is_zero
    }
}

/// The degrees of a product of Cayley transforms and of its coordinates; `Δ` is the product of their denominators and
/// of those of `attitudes` more transforms.
pub fn element(group: &Group, attitudes: usize, number: &mut impl FnMut() -> Degree) -> (Element<Degree>, u64) {
    let of_factor = |own: &Group| match own {
        _ if own.is_added => 0,
        _ if own.is_so3 => 1,
        _ => own.dimension(),
    };
    let transforms = attitudes + group.factors().iter().map(of_factor).sum::<usize>();
    // cay(tE) is a quotient of polynomials of degree 2, or less, as the numerator and denominator of cay(2y) are.
    let degree = 2 * u64::try_from(transforms).unwrap_or(u64::MAX / 2);
    let mut entry = |own: &Group, row: usize, column: usize| match (row == column, column + 1 == own.size) {
        _ if !own.is_added => number().of_element(degree),
        (true, _) => Degree::ONE,
        (false, true) => number(),
        (false, false) => Degree::ZERO,
    };
    let [matrices, inverses] = [(); 2].map(|()| {
        let of_factor = |own: &Group| Value::new(own.size, own.size, |row, column| entry(own, row, column));
        group.factors().iter().map(of_factor).collect()
    });
    let coordinates = group.generators.iter().map(|_| number()).collect();
    (Element { matrices, inverses, coordinates }, degree)
}

/// Replaces attitudes among the parameters by entries of Cayley transforms.
pub fn set_attitudes(
    declaration: &Declaration,
    values: &mut Values<Degree>,
    degree: u64,
    number: &mut impl FnMut() -> Degree,
) {
    for index in attitudes(declaration) {
        let rows = declaration.advected_kind(index).shape().rows();
        let entries = (0..rows * rows).map(|_| number().of_element(degree)).collect();
        values.insert(Name::Advected(index), Value { rows, columns: rows, entries });
    }
}

/// The indices of the advected parameters that are attitudes.
pub fn attitudes(declaration: &Declaration) -> impl Iterator<Item = usize> {
    let all = 0..declaration.advected.len();
    all.filter(|&index| matches!(declaration.advected_kind(index), FieldKind::Configuration(_)))
}

/// The number of Cayley transforms of which the attitudes among the parameters are products.
pub fn transforms(declaration: &Declaration) -> usize {
    let of_attitude = |index: usize| {
        let (name, kind) = (Name::Advected(index), declaration.advected_kind(index));
        turned(declaration, name, kind).filter(|&rows| rows > 3).map_or(1, |rows| rows * (rows - 1) / 2)
    };
    attitudes(declaration).map(of_attitude).sum()
}

/// The functions and constants of a tree or of a graph.
#[derive(Clone, Copy, Debug, Default)]
pub struct Content {
    /// The number of function calls.
    pub functions: u64,
    /// Whether a constant that isn't zero is zero in the field, or has no value there.
    pub has_multiple: bool,
}

impl Content {
    fn of_constant(value: Rational) -> Self {
        let residue = Residue::of(value);
        Self { functions: 0, has_multiple: !value.is_zero() && (residue.is_zero() || !residue.is_defined()) }
    }

    pub fn of_tree(tree: &Rc<Tree>) -> Self {
        parts(tree).into_iter().fold(Self::default(), |content, part| match part.kind {
            Kind::Apply(..) => content + Self { functions: 1, ..Self::default() },
            Kind::Number(value) => content + Self::of_constant(value),
            _ => content,
        })
    }

    pub fn of_graph(graph: &Graph) -> Self {
        graph.nodes().fold(Self::default(), |content, node| match node {
            Node::Apply(..) => content + Self { functions: 1, ..Self::default() },
            Node::Constant(value) => content + Self::of_constant(*value),
            _ => content,
        })
    }
}

impl Add for Content {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            functions: self.functions.saturating_add(other.functions),
            has_multiple: self.has_multiple || other.has_multiple,
        }
    }
}

/// The largest degrees of all comparisons.
#[derive(Clone, Copy, Debug, Default)]
pub struct Largest {
    numerator: u64,
    argument: u64,
}

impl Largest {
    pub fn compared(&mut self, found: Degree, expected: Degree) {
        let difference = found - expected;
        self.numerator = self.numerator.max(if difference.is_zero { 0 } else { difference.numerator });
        self.argument = self.argument.max(difference.argument);
    }

    /// A bound on the probability that different values coincide at a random point, in units of `1/p`: those of a
    /// comparison, or two arguments of that many functions, each of which may be replaced by its negative or
    /// reciprocal.
    pub fn coincidences(self, functions: u64) -> u64 {
        let pairs = functions.saturating_mul(4).saturating_pow(2);
        self.numerator.saturating_add(pairs.saturating_mul(self.argument))
    }

    /// The number of points to compare, and the `n` of the probability `2⁻ⁿ`; `None` if the limit on points is too low.
    ///
    /// A wrong identity passes if it has a value and coincides at some `n` of the `n + SPARE` points that may be drawn.
    /// For `n` fixed points the probability is the `n`-th power of that for one: no element of the field's `2⁶¹ − 1` is
    /// drawn more than 9/8 times as often as another, and `9/8 · 1/(2⁶¹ − 1) < 2⁻⁶⁰`. The number of such choices is
    /// `ways`.
    pub fn points(self, functions: u64) -> Option<(u32, u32)> {
        let of_point = 60_u32.saturating_sub(u64::BITS - self.coincidences(functions).leading_zeros());
        let mut ways = 1_u64;
        (1..=MOST_POINTS).find_map(|points| {
            ways = ways * u64::from(points + SPARE) / u64::from(points);
            let exponent = (points * of_point).saturating_sub(u64::BITS - ways.leading_zeros());
            (exponent >= ENOUGH).then_some((points, exponent))
        })
    }
}
