//! Vectors as cross matrices and back: `û`, the vector of a skew part, and `diag(u)`.

use super::expression::Expression;
use super::rational::Rational;
use super::symbols::Symbols;
use super::word::{Factor, transpose};

impl Expression {
    /// `û` of a vector.
    pub(crate) fn hat(&self, symbols: &Symbols) -> Self {
        self.by_word((3, 3), |word| hat(word, symbols))
    }

    /// `½ (A − Aᵀ)^∨` of a 3 × 3 matrix.
    pub(crate) fn vee(&self, symbols: &Symbols) -> Self {
        self.by_word((3, 1), |word| vee(word, symbols))
    }

    /// `diag(u)` of a vector.
    pub(crate) fn diagonal(&self, symbols: &Symbols) -> Self {
        let shape = (self.shape().0, self.shape().0);
        self.by_word(shape, |word| Self::from_word(vec![Factor::Diagonal(word.to_vec())], shape, symbols))
    }

    /// `½ (A − Aᵀ)`.
    pub(crate) fn skew_part(self, symbols: &Symbols) -> Self {
        let transposed = self.transpose(symbols);
        self.minus(transposed).scaled(Rational::new(1, 2))
    }
}

/// `û` of a vector word: of a skew part it is that part, otherwise a factor of its own.
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
