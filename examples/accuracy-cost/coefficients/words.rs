//! Words in `A` and `B`, the flows of the kinetic energy and of the potential, and what their logarithms are made of.
//!
//! A flow `exp(a A)` is a series of words, a product of flows the product of the series, and the logarithm of that is in
//! the Lie algebra: its part of `n` letters is the method's error of the power `hⁿ`. As the kinetic energy is quadratic
//! in the momentum, `[B, [B, [B, A]]]` vanishes, and with it all that is made of it.

use core::ops::{Add, Div, Mul, Neg, Sub};

use nalgebra::{DMatrix, DVector};
use workbench::double_double::DoubleDouble;

/// What coefficients are computed in.
pub(crate) trait Number:
    Copy
    + PartialEq
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// With the digits that it has.
    fn of(number: DoubleDouble) -> Self;
}

impl Number for f64 {
    fn of(number: DoubleDouble) -> Self {
        number.rounded()
    }
}

impl Number for DoubleDouble {
    fn of(number: DoubleDouble) -> Self {
        number
    }
}

/// The longest words that are looked at: those of the error of a method of order 6.
pub(crate) const LONGEST: usize = 7;

/// A drift or a kick by turns, with its share of the step, and of `½ [B, [A, B]]`, the force gradient.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Part<T> {
    Drift(T),
    Kick(T, T),
}

impl Part<DoubleDouble> {
    /// With the digits that other numbers have.
    pub(crate) fn rounded<T: Number>(self) -> Part<T> {
        match self {
            Self::Drift(a) => Part::Drift(T::of(a)),
            Self::Kick(b, g) => Part::Kick(T::of(b), T::of(g)),
        }
    }
}

impl<T: Number> Part<T> {
    /// The logarithm, as words with their coefficients.
    fn terms(self) -> Vec<(usize, T)> {
        match self {
            Self::Drift(a) => vec![(A, a)],
            // ½ [B, [A, B]] = B A B − ½ (A B B + B B A).
            Self::Kick(b, g) => {
                let half = g * T::from(-0.5);
                vec![(B, b), (0b1101, g), (0b1011, half), (0b1110, half)]
            }
        }
    }
}

/// The coefficients of all words of up to [`LONGEST`] letters, each at the place that is a one followed by its letters
/// in binary, `A` as 0 and `B` as 1.
#[derive(Clone, Debug)]
pub(crate) struct Words<T>(Vec<T>);

const COUNT: usize = 2 << LONGEST;
const A: usize = 0b10;
const B: usize = 0b11;

fn letters(place: usize) -> usize {
    place.ilog2() as usize
}

/// The places of all words of so many letters.
fn of_length(n: usize) -> core::ops::Range<usize> {
    1 << n..2 << n
}

impl<T: Number> Words<T> {
    fn zero() -> Self {
        Self(vec![0.0.into(); COUNT])
    }

    pub(crate) fn one() -> Self {
        let mut one = Self::zero();
        one.0[1] = 1.0.into();
        one
    }

    /// The coefficients of the words of so many letters.
    pub(crate) fn part(&self, n: usize) -> &[T] {
        &self.0[of_length(n)]
    }

    fn nonzero(&self) -> Vec<(usize, T)> {
        self.0.iter().copied().enumerate().filter(|(_, x)| *x != 0.0.into()).collect()
    }

    fn times_terms(&self, terms: &[(usize, T)]) -> Self {
        let mut product = Self::zero();
        for &(end, x) in terms {
            let n = letters(end);
            let end = end - (1 << n);
            for place in 1..2 << (LONGEST - n) {
                let sum = &mut product.0[place << n | end];
                *sum = *sum + self.0[place] * x;
            }
        }
        product
    }

    pub(crate) fn times(&self, other: &Self) -> Self {
        self.times_terms(&other.nonzero())
    }

    /// The product with the exponential of a sum of words, none of which is empty.
    fn times_exponential(&self, terms: &[(usize, T)]) -> Self {
        let (mut sum, mut last) = (self.clone(), self.clone());
        for n in 1_u8..=7 {
            last = last.times_terms(terms);
            for (sum, last) in sum.0.iter_mut().zip(&mut last.0) {
                *last = *last / f64::from(n).into();
                *sum = *sum + *last;
            }
        }
        sum
    }

    /// The product of flows.
    pub(crate) fn of(parts: &[Part<T>]) -> Self {
        parts.iter().fold(Self::one(), |product, part| product.times_exponential(&part.terms()))
    }

    /// Adds multiples of elements of the Lie algebra.
    pub(crate) fn add<'a>(&mut self, elements: impl Iterator<Item = (&'a Element, T)>) {
        for (element, x) in elements {
            for (sum, of_word) in self.0[of_length(element.letters)].iter_mut().zip(&element.words) {
                *sum = *sum + x * (*of_word).into();
            }
        }
    }

    /// The exponential of a sum of elements of the Lie algebra.
    pub(crate) fn exponential<'a>(elements: impl Iterator<Item = (&'a Element, T)>) -> Self {
        let mut sum = Self::zero();
        sum.add(elements);
        Self::one().times_exponential(&sum.nonzero())
    }

    /// The inverse of a product of exponentials of elements of the Lie algebra: each word is turned round, and has the
    /// other sign where its letters are odd in number.
    pub(crate) fn inverse(&self) -> Self {
        let mut inverse = Self::zero();
        for (place, x) in self.0.iter().enumerate().skip(1) {
            let n = letters(place);
            let turned = (0..n).fold(1, |turned, k| turned << 1 | place >> k & 1);
            inverse.0[turned] = if n.is_multiple_of(2) { *x } else { -*x };
        }
        inverse
    }

    /// The logarithm of a series that begins with one.
    pub(crate) fn logarithm(&self) -> Self {
        let mut rest = self.clone();
        rest.0[1] = 0.0.into();
        let (mut sum, mut last) = (rest.clone(), rest.clone());
        for n in 2_u8..=7 {
            last = last.times(&rest);
            let factor = T::from(if n % 2 == 0 { -1.0 } else { 1.0 }) / f64::from(n).into();
            for (sum, last) in sum.0.iter_mut().zip(&last.0) {
                *sum = *sum + *last * factor;
            }
        }
        sum
    }
}

/// An element of the Lie algebra, with whole coefficients of its words, which have all so many letters.
#[derive(Clone, Debug)]
pub(crate) struct Element {
    letters: usize,
    words: DVector<f64>,
}

impl Element {
    fn letter(place: usize) -> Self {
        Self { letters: 1, words: DVector::from_fn(2, |k, _| if k + 2 == place { 1.0 } else { 0.0 }) }
    }

    /// `[X, element]` for a letter `X`.
    fn commutator(&self, letter: usize) -> Self {
        let (n, first) = (self.letters, letter - 2);
        let mut words = DVector::zeros(2 << n);
        for (word, x) in self.words.iter().enumerate() {
            words[first << n | word] += x;
            words[word << 1 | first] -= x;
        }
        Self { letters: n + 1, words }
    }
}

/// The Lie algebra of `A` and `B` in which `[B, [B, [B, A]]]` vanishes, by the number of letters.
pub(crate) struct Algebra {
    /// A basis of what vanishes.
    pub(crate) vanishing: Vec<Vec<Element>>,
    /// A basis of what doesn't.
    pub(crate) basis: Vec<Vec<Element>>,
    /// The coordinates of the words of an element, orthogonal to what vanishes.
    coordinates: Vec<DMatrix<f64>>,
}

impl Algebra {
    pub(crate) fn new() -> Self {
        let mut vanishing: Vec<Vec<Element>> = vec![Vec::new(); 2];
        let mut basis = vec![Vec::new(), vec![Element::letter(A), Element::letter(B)]];
        let mut coordinates = vec![DMatrix::zeros(0, 1), DMatrix::identity(2, 2)];
        for n in 2..=LONGEST {
            let longer = |elements: &[Element]| -> Vec<Element> {
                elements.iter().flat_map(|element| [A, B].map(|letter| element.commutator(letter))).collect()
            };
            let candidates = if n == 4 {
                vec![[B, B, B].iter().fold(Element::letter(A), |element, letter| element.commutator(*letter))]
            } else {
                longer(&vanishing[n - 1])
            };
            let mut directions = Vec::new();
            let vanish = independent(candidates, &mut directions);
            let rest = independent(longer(&basis[n - 1]), &mut directions);
            let rows: Vec<_> = directions[vanish.len()..].iter().map(DVector::transpose).collect();
            coordinates.push(DMatrix::from_rows(&rows));
            vanishing.push(vanish);
            basis.push(rest);
        }
        Self { vanishing, basis, coordinates }
    }

    /// The coordinates of the part of so many letters of a logarithm, but for what vanishes.
    pub(crate) fn coordinates(&self, logarithm: &Words<f64>, n: usize) -> DVector<f64> {
        &self.coordinates[n] * DVector::from_column_slice(logarithm.part(n))
    }
}

/// Those that aren't sums of the ones before, and orthonormal directions to which theirs are added.
fn independent(candidates: Vec<Element>, directions: &mut Vec<DVector<f64>>) -> Vec<Element> {
    let mut is_new = |candidate: &Element| {
        let mut rest = candidate.words.clone();
        // Twice, so that rounding doesn't count.
        for _ in 0..2 {
            for direction in directions.iter() {
                rest -= direction * direction.dot(&rest);
            }
        }
        let is_new = rest.norm() > 1e-9 * (1.0 + candidate.words.norm());
        if is_new {
            directions.push(rest.normalize());
        }
        is_new
    };
    candidates.into_iter().filter(|candidate| is_new(candidate)).collect()
}

#[cfg(test)]
mod tests {
    use super::{A, Algebra, B, COUNT, Part, Words};

    #[track_caller]
    fn assert_equal(found: &Words<f64>, expected: &[(usize, f64)], longest: usize) {
        for place in 1..2 << longest {
            let expected = expected.iter().find(|(word, _)| *word == place).map_or(0.0, |(_, x)| *x);
            assert!((found.0[place] - expected).abs() < 1e-15, "{place:b}: {}", found.0[place]);
        }
    }

    /// `log(e^A e^B) = A + B + ½ [A, B] + 1/12 [A, [A, B]] + 1/12 [B, [B, A]] + …`, of Baker, Campbell and Hausdorff.
    #[test]
    fn two_flows_have_their_logarithm() {
        let (ab, ba) = (0b101, 0b110);
        let twelfth = 1.0 / 12.0;
        let third = [(0b1001, 1.0), (0b1010, -2.0), (0b1100, 1.0), (0b1110, 1.0), (0b1101, -2.0), (0b1011, 1.0)];
        let expected: Vec<_> = [(A, 1.0), (B, 1.0), (ab, 0.5), (ba, -0.5)]
            .into_iter()
            .chain(third.map(|(word, x)| (word, x * twelfth)))
            .collect();
        assert_equal(&Words::of(&[Part::Drift(1.0), Part::Kick(1.0, 0.0)]).logarithm(), &expected, 3);
    }

    #[test]
    fn the_inverse_undoes() {
        let flows = Words::of(&[Part::Drift(0.7), Part::Kick(-0.4, 0.2), Part::Drift(0.3)]);
        for product in [flows.inverse().times(&flows), flows.times(&flows.inverse())] {
            assert_equal(&product, &[(1, 1.0)], COUNT.ilog2() as usize - 1);
        }
    }

    /// By Witt's formula there are 2, 1, 2, 3, 6, 9, 18 elements without what vanishes.
    #[test]
    fn the_algebra_has_its_dimensions() {
        let algebra = Algebra::new();
        let dimensions = |all: &[Vec<_>]| all.iter().skip(1).map(Vec::len).collect::<Vec<_>>();
        let (basis, vanishing) = (dimensions(&algebra.basis), dimensions(&algebra.vanishing));
        assert_eq!(basis.iter().zip(&vanishing).map(|(a, b)| a + b).collect::<Vec<_>>(), [2, 1, 2, 3, 6, 9, 18]);
        assert_eq!(basis[..5], [2, 1, 2, 2, 4]);
    }
}
