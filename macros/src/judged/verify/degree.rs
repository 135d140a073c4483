//! A bound on the degree of a declared expression, as a rational function of the numbers that it is evaluated at.
//!
//! Schwartz and Zippel: a function that isn't zero vanishes at a random point of a field of `p` elements with a
//! probability of at most its degree over `p`.

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::declared::{Kind, Name, Shape, Tree};

/// Of a numerator and a denominator; a matrix has one denominator for all entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Degree {
    numerator: u64,
    denominator: u64,
}

impl Degree {
    fn new(numerator: u64, denominator: u64) -> Self {
        Self { numerator, denominator }
    }

    fn plus(self, other: Self) -> Self {
        let left = self.numerator.saturating_add(other.denominator);
        let right = other.numerator.saturating_add(self.denominator);
        Self::new(left.max(right), self.denominator.saturating_add(other.denominator))
    }

    fn times(self, other: Self) -> Self {
        Self::new(self.numerator.saturating_add(other.numerator), self.denominator.saturating_add(other.denominator))
    }

    fn reciprocal(self) -> Self {
        Self::new(self.denominator, self.numerator)
    }

    fn power(self, exponent: u64) -> Self {
        Self::new(self.numerator.saturating_mul(exponent), self.denominator.saturating_mul(exponent))
    }

    /// Of the difference of two such functions.
    fn of_difference(self) -> u64 {
        self.numerator.saturating_add(self.denominator)
    }
}

/// What has been found so far.
struct Degrees {
    /// Of `F`, and with it of all that it moves.
    increment: Degree,
    known: BTreeMap<*const Tree, Degree>,
    /// Of the differences of arguments of functions: how large, and how many functions.
    arguments: u64,
    functions: u64,
}

/// How often two different values of the expression, or two different arguments of functions within, coincide at a
/// random point, in units of `1/p`.
pub(super) fn coincidences(tree: &Rc<Tree>, dimension: usize) -> u64 {
    // For each of the generators a quotient of two quadratic polynomials.
    let quadratic = 2 * u64::try_from(dimension).unwrap_or(u64::MAX / 2);
    let increment = Degree::new(quadratic, quadratic);
    let mut degrees = Degrees { increment, known: BTreeMap::new(), arguments: 0, functions: 0 };
    let of_value = degrees.of(tree).of_difference();
    // Of either side of the identity, each argument and its negative or reciprocal.
    let pairs = degrees.functions.saturating_mul(4).saturating_pow(2);
    of_value.saturating_add(pairs.saturating_mul(degrees.arguments))
}

impl Degrees {
    fn of(&mut self, tree: &Rc<Tree>) -> Degree {
        if let Some(known) = self.known.get(&Rc::as_ptr(tree)) {
            return *known;
        }
        let degree = self.operation(tree);
        self.known.insert(Rc::as_ptr(tree), degree);
        degree
    }

    fn operation(&mut self, tree: &Rc<Tree>) -> Degree {
        match &tree.kind {
            Kind::Number(_) | Kind::Identity => Degree::new(0, 0),
            Kind::Name(Name::Increment(_)) => self.increment,
            // At most as a tensor, F⁻¹ S F.
            Kind::Name(Name::Advected(_)) => self.increment.power(2).times(Degree::new(1, 0)),
            // A symmetric matrix is a product of two.
            Kind::Name(_) => Degree::new(2, 0),
            Kind::Negate(a)
            | Kind::Transpose(a)
            | Kind::Trace(a)
            | Kind::CrossMatrix(a)
            | Kind::Vee(a)
            | Kind::Hat(a, _)
            | Kind::Components(a, _)
            | Kind::Entry(a, ..)
            | Kind::Bound(_, a) => self.of(a),
            Kind::Add(a, b) | Kind::Subtract(a, b) => self.of(a).plus(self.of(b)),
            Kind::Multiply(a, b) | Kind::Dot(a, b) | Kind::Cross(a, b) | Kind::ComponentMultiply(a, b) => {
                self.of(a).times(self.of(b))
            }
            Kind::Divide(a, b) => self.of(a).times(self.of(b).reciprocal()),
            Kind::Power(a, exponent) => {
                let power = self.of(a).power(exponent.unsigned_abs().into());
                if *exponent < 0 { power.reciprocal() } else { power }
            }
            // A number that is as good as random, or its reciprocal.
            Kind::Apply(_, a) => {
                self.functions = self.functions.saturating_add(1);
                self.arguments = self.arguments.max(self.of(a).of_difference());
                Degree::new(1, 1)
            }
            // The adjugate over the determinant.
            Kind::Inverse(a) if matches!(a.kind, Kind::Name(Name::Increment(_))) => self.increment,
            Kind::Inverse(a) => {
                let (degree, rows) = (
                    self.of(a),
                    match a.shape {
                        Shape::Matrix(rows, _) => u64::try_from(rows).unwrap_or(u64::MAX),
                        Shape::Scalar => 1,
                    },
                );
                let minor = degree.numerator.saturating_mul(rows.saturating_sub(1));
                Degree::new(minor.saturating_add(degree.denominator), degree.numerator.saturating_mul(rows))
            }
        }
    }
}
