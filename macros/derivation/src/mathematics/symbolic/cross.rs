//! Vectors as cross matrices and back: `û`, the vector of a skew part, and `diag(u)`.

use super::expression::{Atom, Expression};
use super::rational::Rational;
use super::symbols::Symbols;
use super::word::{Factor, transpose};

impl Expression {
    /// `û` of a vector.
    pub fn hat(&self, symbols: &Symbols) -> Self {
        self.by_word((3, 3), |word| hat(word, symbols))
    }

    /// `½ (A − Aᵀ)^∨` of a 3 × 3 matrix.
    pub fn vee(&self, symbols: &Symbols) -> Self {
        self.by_word((3, 1), |word| vee(word, symbols))
    }

    /// `diag(u)` of a vector.
    pub fn diagonal(&self, symbols: &Symbols) -> Self {
        let shape = (self.shape().0, self.shape().0);
        self.by_word(shape, |word| Self::from_word(vec![Factor::Diagonal(word.to_vec())], shape, symbols))
    }

    /// `½ (A − Aᵀ)`.
    pub fn skew_part(self, symbols: &Symbols) -> Self {
        let transposed = self.transpose(symbols);
        self.minus(transposed).scaled(Rational::new(1, 2))
    }
}

/// `û` of a vector word; for the vector of a skew part, that part itself.
fn hat(word: &[Factor], symbols: &Symbols) -> Expression {
    if let [Factor::Vee { word: inner, transposed: false }] = word {
        let matrix = Expression::from_word(inner.clone(), (3, 3), symbols);
        return matrix.skew_part(symbols);
    }
    Expression::from_word(vec![Factor::Hat(word.to_vec())], (3, 3), symbols)
}

/// `½ (W − Wᵀ)^∨` of a matrix word.
fn vee(word: &[Factor], symbols: &Symbols) -> Expression {
    if let [Factor::Hat(inner)] = word {
        return Expression::from_word(inner.clone(), (3, 1), symbols);
    }
    let (sign, turned) = transpose(word, symbols);
    if turned == word {
        if sign > 0 {
            return Expression::zero((3, 1));
        }
        let factor = Factor::Vee { word: word.to_vec(), transposed: false };
        return Expression::from_word(vec![factor], (3, 1), symbols);
    }
    let (sign, word) = if word < turned.as_slice() { (1, word.to_vec()) } else { (-sign, turned) };
    let factor = Factor::Vee { word, transposed: false };
    Expression::from_word(vec![factor], (3, 1), symbols).scaled(Rational::integer(sign.into()))
}

impl Expression {
    /// The expression with products of cross matrices multiplied out, `û v̂ = v uᵀ − ⟨u, v⟩ I`, and
    /// `tr(W û) = −2 ⟨vee(W), u⟩`.
    pub fn with_hats_resolved(&self, symbols: &Symbols) -> Self {
        let mut result = Self::zero(self.shape());
        for (monomial, coefficient) in self.terms() {
            let resolved = monomial.scalars.iter().find_map(|(atom, &exponent)| {
                let image = match atom {
                    Atom::Trace(word) => resolved(word, symbols)?,
                    Atom::Function(function, inner) => {
                        let image = inner.with_hats_resolved(symbols);
                        (image != **inner).then(|| Self::function(*function, image))?
                    }
                    Atom::Sum(inner) => {
                        let image = inner.with_hats_resolved(symbols);
                        (image != **inner).then(|| image.power(1, symbols))?
                    }
                    Atom::Symbol(_) => return None,
                };
                Some((atom, image.power(exponent, symbols)))
            });
            let mut term = Self::zero(self.shape());
            match resolved {
                None => term.add_term(monomial.clone(), coefficient),
                Some((atom, image)) => {
                    let mut rest = monomial.clone();
                    rest.scalars.remove(atom);
                    term.add_term(rest, coefficient);
                    term = term.times(&image, symbols).with_hats_resolved(symbols);
                }
            }
            result = result.plus(term);
        }
        result
    }
}

/// A closed word without its first pair of neighbouring cross matrices, or without its only one.
fn resolved(word: &[Factor], symbols: &Symbols) -> Option<Expression> {
    let is_form = word.first().is_some_and(|factor| factor.shape(symbols).0 == 1);
    let hat_at = |word: &[Factor], at: usize| match word.get(at) {
        Some(Factor::Hat(inner)) => Some(inner.clone()),
        _ => None,
    };
    let starts = if is_form { 1 } else { word.len() };
    for start in 0..starts {
        let (tail, head) = word.split_at(start);
        let turned = [head, tail].concat();
        for at in 0..turned.len().saturating_sub(1) {
            let (Some(u), Some(v)) = (hat_at(&turned, at), hat_at(&turned, at + 1)) else { continue };
            let [u, v] = [u, v].map(|vector| Expression::from_word(vector, (3, 1), symbols));
            let product = |factors: &[Factor]| {
                let shape = match (factors.first(), factors.last()) {
                    (Some(first), Some(last)) => (first.shape(symbols).0, last.shape(symbols).1),
                    _ => return Expression::identity(3),
                };
                Expression::from_word(factors.to_vec(), shape, symbols)
            };
            let (before, after) = (product(turned.get(..at)?), product(turned.get(at + 2..)?));
            let whole = |middle: &Expression| before.times(middle, symbols).times(&after, symbols).trace(symbols);
            let outer = v.times(&u.transpose(symbols), symbols);
            let inner = u.transpose(symbols).times(&v, symbols);
            return Some(whole(&outer).minus(inner.times(&whole(&Expression::identity(3)), symbols)));
        }
    }
    let only = (0..word.len()).find_map(|at| hat_at(word, at).map(|inner| (at, inner)));
    let (at, inner) = only.filter(|_| !is_form && word.len() > 1)?;
    if word.iter().filter(|factor| matches!(factor, Factor::Hat(_))).count() > 1 {
        return None;
    }
    let others = [word.get(at + 1..)?, word.get(..at)?].concat();
    let matrix = Expression::from_word(others, (3, 3), symbols).vee(symbols);
    let vector = Expression::from_word(inner, (3, 1), symbols);
    Some(matrix.transpose(symbols).times(&vector, symbols).scaled(Rational::integer(-2)))
}
