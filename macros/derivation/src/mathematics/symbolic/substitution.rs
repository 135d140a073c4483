//! The substitution of expressions for symbols.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::expression::{Atom, Expression, Monomial};
use super::symbols::{SymbolId, Symbols};
use super::word::Factor;

/// The expression with every symbol of the map replaced, in normal form. A matrix and its inverse are replaced
/// separately: the inverse by the image of the [symbol](Symbols::inverse_of) of its entries.
pub fn substitute(expression: &Expression, map: &BTreeMap<SymbolId, Expression>, symbols: &Symbols) -> Expression {
    let mut result = Expression::zero(expression.shape());
    for (monomial, coefficient) in expression.terms() {
        let mut product = Expression::rational(coefficient);
        for (atom, exponent) in &monomial.scalars {
            product = product.times(&atom_image(atom, map, symbols).power(*exponent, symbols), symbols);
        }
        let word = product_image(&monomial.word, map, symbols);
        let word = match (word, expression.shape()) {
            (Some(word), _) => word,
            (None, (rows, _)) => Expression::identity(rows),
        };
        result = result.plus(product.times(&word, symbols));
    }
    result
}

fn atom_image(atom: &Atom, map: &BTreeMap<SymbolId, Expression>, symbols: &Symbols) -> Expression {
    match atom {
        Atom::Symbol(id) => map.get(id).cloned().unwrap_or_else(|| Expression::symbol(*id, symbols)),
        Atom::Trace(word) => product_image(word, map, symbols)
            .map_or_else(|| Expression::atom(atom.clone(), 1), |image| image.trace(symbols)),
        Atom::Function(function, inner) => Expression::function(*function, substitute(inner, map, symbols)),
        Atom::Sum(inner) => {
            let inner = substitute(inner, map, symbols);
            if inner.len() == 1 { inner } else { Expression::atom(Atom::Sum(Rc::new(inner)), 1) }
        }
    }
}

/// The product of the images of the factors; `None` for the empty word.
fn product_image(word: &[Factor], map: &BTreeMap<SymbolId, Expression>, symbols: &Symbols) -> Option<Expression> {
    let mut images = word.iter().map(|factor| factor_image(factor, map, symbols));
    let first = images.next()?;
    Some(images.fold(first, |product, image| product.times(&image, symbols)))
}

fn factor_image(factor: &Factor, map: &BTreeMap<SymbolId, Expression>, symbols: &Symbols) -> Expression {
    let inner = |word: &[Factor]| {
        product_image(word, map, symbols).unwrap_or_else(|| Expression::identity(factor.shape(symbols).0))
    };
    match factor {
        Factor::Symbol { id, transposed } => match map.get(id) {
            Some(image) if *transposed => image.transpose(symbols),
            Some(image) => image.clone(),
            None => single(factor, symbols),
        },
        // An inverse is replaced if the symbol of its entries is.
        Factor::Inverse { id, transposed } => match symbols.inverse_of(*id).and_then(|inverse| map.get(&inverse)) {
            Some(image) if *transposed => image.transpose(symbols),
            Some(image) => image.clone(),
            None => single(factor, symbols),
        },
        Factor::Unit { .. } => single(factor, symbols),
        Factor::Hat(word) => inner(word).hat(symbols),
        Factor::Diagonal(word) => inner(word).diagonal(symbols),
        Factor::Vee { word, transposed } => {
            let image = inner(word).vee(symbols);
            if *transposed { image.transpose(symbols) } else { image }
        }
    }
}

/// A factor as an expression.
pub(super) fn single(factor: &Factor, symbols: &Symbols) -> Expression {
    let mut expression = Expression::zero(factor.shape(symbols));
    let monomial = Monomial { scalars: BTreeMap::new(), word: vec![factor.clone()] };
    expression.add_term(monomial, super::Rational::ONE);
    expression
}
