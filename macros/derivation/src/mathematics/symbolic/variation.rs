//! The first variation of an expression; all derivatives of expressions are computed here.
//!
//! Given `δs` for some symbols `s`, the variation is linear in them and follows from four rules:
//!
//! ```text
//! δ(A B)     = δA B + A δB          each factor of a word in turn
//! δ tr(W)    = tr(δW)
//! δ(aⁿ)      = n aⁿ⁻¹ δa
//! δ f(u)     = f'(u) δu
//! ```
//!
//! `û`, `diag(u)` and `W ↦ ½ (W − Wᵀ)^∨` are linear, so the variation goes inside. A variation along the group is
//! `δF = Ê F` or `F Ê` with a symbol `Ê` for the direction. Varying twice gives second derivatives; as `δF` is itself
//! varied through its `F`, they include the connection term that an ambient Hessian lacks.

use std::collections::BTreeMap;

use super::expression::{Atom, Expression, Monomial};
use super::functions::Function;
use super::rational::Rational;
use super::substitution::single;
use super::symbols::{SymbolId, Symbols};
use super::word::Factor;

/// `δs` for each symbol `s` that varies.
pub type Variations = BTreeMap<SymbolId, Expression>;

/// The variation `δ` of an expression.
pub fn variation(expression: &Expression, variations: &Variations, symbols: &Symbols) -> Expression {
    let mut result = Expression::zero(expression.shape());
    for (monomial, coefficient) in expression.terms() {
        let varied = vary_monomial(monomial, expression.shape(), variations, symbols);
        result = result.plus(varied.scaled(coefficient));
    }
    result
}

fn vary_monomial(monomial: &Monomial, shape: (usize, usize), variations: &Variations, symbols: &Symbols) -> Expression {
    let mut result = Expression::zero(shape);
    for (atom, exponent) in &monomial.scalars {
        let varied = vary_atom(atom, variations, symbols);
        if varied.is_zero() {
            continue;
        }
        let mut rest = monomial.clone();
        if *exponent == 1 {
            rest.scalars.remove(atom);
        } else {
            rest.scalars.insert(atom.clone(), exponent - 1);
        }
        let mut others = Expression::zero(shape);
        others.add_term(rest, Rational::integer((*exponent).into()));
        result = result.plus(varied.times(&others, symbols));
    }
    let scalars = Monomial { scalars: monomial.scalars.clone(), word: Vec::new() };
    let mut coefficient = Expression::zero((1, 1));
    coefficient.add_term(scalars, Rational::ONE);
    for varied in vary_word(&monomial.word, variations, symbols) {
        result = result.plus(coefficient.times(&varied, symbols));
    }
    result
}

fn vary_atom(atom: &Atom, variations: &Variations, symbols: &Symbols) -> Expression {
    match atom {
        Atom::Symbol(id) => variations.get(id).cloned().unwrap_or_else(|| Expression::zero((1, 1))),
        Atom::Trace(word) => {
            let parts = vary_word(word, variations, symbols).into_iter();
            parts.fold(Expression::zero((1, 1)), |sum, part| sum.plus(part.trace(symbols)))
        }
        Atom::Function(function, inner) => {
            let varied = variation(inner, variations, symbols);
            if varied.is_zero() { varied } else { derivative(*function, inner, symbols).times(&varied, symbols) }
        }
        Atom::Sum(inner) => variation(inner, variations, symbols),
    }
}

/// `f'(u)`.
fn derivative(function: Function, argument: &Expression, symbols: &Symbols) -> Expression {
    let at = |function: Function| Expression::function(function, argument.clone());
    match function {
        Function::Sqrt => at(function).power(-1, symbols).scaled(Rational::new(1, 2)),
        Function::Ln => argument.clone().power(-1, symbols),
        Function::Exp => at(function),
        Function::Sin => at(Function::Cos),
        Function::Cos => at(Function::Sin).scaled(-Rational::ONE),
        Function::Stumpff(k) => {
            let second = at(Function::Stumpff(k + 2)).scaled(Rational::new(k.into(), 2));
            second.minus(at(Function::Stumpff(k + 1)).scaled(Rational::new(1, 2)))
        }
        Function::LogRatio(k) => at(Function::LogRatio(k + 1)),
    }
}

/// The product with each factor varied in turn.
fn vary_word(word: &[Factor], variations: &Variations, symbols: &Symbols) -> Vec<Expression> {
    let mut parts = Vec::new();
    for (at, factor) in word.iter().enumerate() {
        let varied = vary_factor(factor, variations, symbols);
        if varied.is_zero() {
            continue;
        }
        let product = |factors: &[Factor]| {
            let mut factors = factors.iter().map(|factor| single(factor, symbols));
            let first = factors.next();
            first.map(|first| factors.fold(first, |product, factor| product.times(&factor, symbols)))
        };
        let before = product(word.get(..at).unwrap_or_default());
        let after = product(word.get(at + 1..).unwrap_or_default());
        let left = before.map_or_else(|| varied.clone(), |before| before.times(&varied, symbols));
        parts.push(after.map_or_else(|| left.clone(), |after| left.times(&after, symbols)));
    }
    parts
}

fn vary_factor(factor: &Factor, variations: &Variations, symbols: &Symbols) -> Expression {
    let linear = |word: &[Factor], shape: (usize, usize)| {
        let parts = vary_word(word, variations, symbols).into_iter();
        parts.fold(Expression::zero(shape), Expression::plus)
    };
    match factor {
        Factor::Symbol { id, transposed } => match variations.get(id) {
            Some(varied) if *transposed => varied.transpose(symbols),
            Some(varied) => varied.clone(),
            None => Expression::zero(factor.shape(symbols)),
        },
        // δ(F⁻¹) = −F⁻¹ δF F⁻¹.
        Factor::Inverse { id, transposed } => match variations.get(id) {
            Some(varied) => {
                let inverse = single(&Factor::Inverse { id: *id, transposed: false }, symbols);
                let varied = inverse.times(varied, symbols).times(&inverse, symbols).scaled(-Rational::ONE);
                if *transposed { varied.transpose(symbols) } else { varied }
            }
            None => Expression::zero(factor.shape(symbols)),
        },
        Factor::Unit { .. } => Expression::zero(factor.shape(symbols)),
        Factor::Hat(word) => linear(word, (3, 1)).hat(symbols),
        Factor::Diagonal(word) => linear(word, (factor.shape(symbols).0, 1)).diagonal(symbols),
        Factor::Vee { word, transposed } => {
            let varied = linear(word, (3, 3)).vee(symbols);
            if *transposed { varied.transpose(symbols) } else { varied }
        }
    }
}
