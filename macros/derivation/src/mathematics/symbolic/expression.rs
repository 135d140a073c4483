//! Sums of words with scalar coefficients, in normal form.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::rc::Rc;

use super::functions::Function;
use super::rational::Rational;
use super::symbols::{Stage, SymbolId, Symbols};
use super::word::{self, Factor};
use super::work;

/// The limit on exponents: a larger one would soon saturate.
const LARGEST_EXPONENT: u32 = 1 << 16;

/// A scalar that the normal form doesn't split.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Atom {
    /// A named scalar.
    Symbol(SymbolId),
    /// The trace of a closed word, or a bilinear form `uᵀ W v`, in canonical form.
    Trace(Vec<Factor>),
    /// A smooth function of a scalar.
    Function(Function, Rc<Expression>),
    /// A sum under a power that isn't expanded.
    Sum(Rc<Expression>),
}

/// The factors of a coefficient: powers of scalars and a word (empty: the identity, or one for a scalar).
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Monomial {
    pub scalars: BTreeMap<Atom, i32>,
    pub word: Vec<Factor>,
}

impl Monomial {
    fn times(&self, other: &Self) -> BTreeMap<Atom, i32> {
        let mut scalars = self.scalars.clone();
        for (atom, exponent) in &other.scalars {
            let sum = scalars.get(atom).map_or(*exponent, |present| present.saturating_add(*exponent));
            if sum == 0 {
                scalars.remove(atom);
            } else {
                scalars.insert(atom.clone(), sum);
            }
        }
        scalars
    }

    /// The exponent of a scalar symbol.
    pub fn exponent(&self, symbol: SymbolId) -> i32 {
        self.scalars.get(&Atom::Symbol(symbol)).copied().unwrap_or(0)
    }
}

/// A scalar, vector or matrix expression.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Expression {
    shape: (usize, usize),
    terms: BTreeMap<Monomial, Rational>,
}

impl Ord for Expression {
    /// A comparison that begins with addresses: expressions inside of scalars are shared, and mostly compared with
    /// themselves.
    fn cmp(&self, other: &Self) -> Ordering {
        if std::ptr::eq(self, other) {
            return Ordering::Equal;
        }
        (self.shape, &self.terms).cmp(&(other.shape, &other.terms))
    }
}

impl PartialOrd for Expression {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Expression {
    pub fn zero(shape: (usize, usize)) -> Self {
        Self { shape, terms: BTreeMap::new() }
    }

    pub fn rational(value: Rational) -> Self {
        Self::identity(1).scaled(value)
    }

    /// The identity of `size` rows; one for size 1.
    pub fn identity(size: usize) -> Self {
        Self { shape: (size, size), terms: BTreeMap::from([(Monomial::default(), Rational::ONE)]) }
    }

    pub fn symbol(id: SymbolId, symbols: &Symbols) -> Self {
        let shape = symbols.get(id).shape;
        if shape == (1, 1) {
            return Self::atom(Atom::Symbol(id), 1);
        }
        Self::from_word(vec![Factor::symbol(id)], shape, symbols)
    }

    /// The inverse of a group element.
    pub fn inverse(id: SymbolId, symbols: &Symbols) -> Self {
        let symbol = symbols.get(id);
        let factor = if symbol.structure.is_orthogonal() {
            Factor::Symbol { id, transposed: true }
        } else {
            Factor::Inverse { id, transposed: false }
        };
        Self::from_word(vec![factor], symbol.shape, symbols)
    }

    pub fn function(function: Function, argument: Self) -> Self {
        if argument.is_zero()
            && let Some(value) = function.at_zero()
        {
            return Self::rational(value);
        }
        Self::atom(Atom::Function(function, Rc::new(argument)), 1)
    }

    pub fn atom(atom: Atom, exponent: i32) -> Self {
        let scalars = BTreeMap::from([(atom, exponent)]);
        Self { shape: (1, 1), terms: BTreeMap::from([(Monomial { scalars, word: Vec::new() }, Rational::ONE)]) }
    }

    /// A product of factors, split into scalars at every inner dimension of one.
    pub fn from_word(word: Vec<Factor>, shape: (usize, usize), symbols: &Symbols) -> Self {
        let word = word::reduce(word, symbols);
        let mut segments: Vec<Vec<Factor>> = vec![Vec::new()];
        for factor in word {
            let starts_new = factor.shape(symbols).0 == 1 && segments.last().is_some_and(|last| !last.is_empty());
            if starts_new {
                segments.push(Vec::new());
            }
            if let Some(last) = segments.last_mut() {
                last.push(factor);
            }
        }
        let (mut open, mut sign, mut scalars) = (Vec::new(), 1, BTreeMap::new());
        for segment in segments {
            let rows = segment.first().map_or(shape.0, |factor| factor.shape(symbols).0);
            let columns = segment.last().map_or(shape.1, |factor| factor.shape(symbols).1);
            if (rows, columns) != (1, 1) {
                open.extend(segment);
                continue;
            }
            if segment.is_empty() {
                continue;
            }
            let (turn, form) = word::canonical_trace(segment, symbols);
            sign *= turn;
            *scalars.entry(Atom::Trace(form)).or_insert(0) += 1;
        }
        let mut expression = Self::zero(shape);
        expression.add_term(Monomial { scalars, word: open }, Rational::integer(sign.into()));
        expression
    }

    pub fn shape(&self) -> (usize, usize) {
        self.shape
    }

    pub fn terms(&self) -> impl Iterator<Item = (&Monomial, Rational)> {
        self.terms.iter().map(|(monomial, coefficient)| (monomial, *coefficient))
    }

    pub fn len(&self) -> usize {
        self.terms.len()
    }

    pub fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }

    /// The number of scalars and factors in the text. Those inside a function count twice: the variation of `f(u)` is
    /// `f'(u) δu`, which has `u` twice.
    pub fn size(&self) -> usize {
        let terms = self.terms.keys().map(|monomial| {
            let scalars = monomial.scalars.keys().map(|atom| match atom {
                Atom::Symbol(_) => 1,
                Atom::Trace(word) => word::size(word),
                Atom::Function(_, inner) | Atom::Sum(inner) => 1 + 2 * inner.size(),
            });
            1 + scalars.sum::<usize>() + word::size(&monomial.word)
        });
        terms.sum()
    }

    /// The number of factors in the longest word.
    pub fn longest_word(&self) -> usize {
        let words = self.terms.keys().map(|monomial| {
            let scalars = monomial.scalars.keys().map(|atom| match atom {
                Atom::Symbol(_) => 1,
                Atom::Trace(word) => word::size(word),
                Atom::Function(_, inner) | Atom::Sum(inner) => inner.longest_word(),
            });
            scalars.max().unwrap_or(0).max(word::size(&monomial.word))
        });
        words.max().unwrap_or(0)
    }

    /// Whether a coefficient or an exponent has left the range of exact arithmetic, inside functions too.
    pub fn has_overflow(&self) -> bool {
        self.terms.iter().any(|(monomial, coefficient)| {
            if monomial.scalars.values().any(|exponent| exponent.unsigned_abs() > LARGEST_EXPONENT) {
                return true;
            }
            let inside = monomial.scalars.keys().any(|atom| match atom {
                Atom::Function(_, inner) | Atom::Sum(inner) => inner.has_overflow(),
                Atom::Symbol(_) | Atom::Trace(_) => false,
            });
            inside || coefficient.is_overflow()
        })
    }

    pub fn add_term(&mut self, monomial: Monomial, coefficient: Rational) {
        if coefficient.is_zero() {
            return;
        }
        let sum = self.terms.get(&monomial).map_or(coefficient, |present| *present + coefficient);
        if sum.is_zero() {
            self.terms.remove(&monomial);
        } else {
            self.terms.insert(monomial, sum);
        }
    }

    /// The part whose monomials satisfy the condition.
    pub fn filtered(&self, condition: impl Fn(&Monomial) -> bool) -> Self {
        let terms = self.terms.iter().filter(|(monomial, _)| condition(monomial));
        Self { shape: self.shape, terms: terms.map(|(monomial, value)| (monomial.clone(), *value)).collect() }
    }

    pub fn scaled(mut self, factor: Rational) -> Self {
        for coefficient in self.terms.values_mut() {
            *coefficient = *coefficient * factor;
        }
        self.terms.retain(|_, coefficient| !coefficient.is_zero());
        self
    }

    pub fn plus(mut self, other: Self) -> Self {
        for (monomial, coefficient) in other.terms {
            self.add_term(monomial, coefficient);
        }
        self
    }

    pub fn minus(self, other: Self) -> Self {
        self.plus(other.scaled(-Rational::ONE))
    }

    /// The matrix product; if one factor is a scalar, the multiple.
    pub fn times(&self, other: &Self, symbols: &Symbols) -> Self {
        let shape = match (self.shape, other.shape) {
            ((1, 1), shape) | (shape, (1, 1)) => shape,
            ((rows, _), (_, columns)) => (rows, columns),
        };
        let mut product = Self::zero(shape);
        if !work::spend(self.len().saturating_mul(other.len())) {
            return product;
        }
        for (left, a) in self.terms() {
            for (right, b) in other.terms() {
                let word = [left.word.as_slice(), right.word.as_slice()].concat();
                let joined = Self::from_word(word, shape, symbols);
                let scalars = Monomial { scalars: left.times(right), word: Vec::new() };
                for (monomial, sign) in joined.terms() {
                    let all = Monomial { scalars: scalars.times(monomial), word: monomial.word.clone() };
                    product.add_term(all, a * b * sign);
                }
            }
        }
        product
    }

    /// An integer power of a scalar; a negative power of a sum stays closed.
    pub fn power(self, exponent: i32, symbols: &Symbols) -> Self {
        if let Some((monomial, coefficient)) = self.terms().next()
            && self.len() == 1
        {
            let scalars = monomial.scalars.iter().map(|(atom, e)| (atom.clone(), e.saturating_mul(exponent)));
            let monomial = Monomial { scalars: scalars.filter(|(_, e)| *e != 0).collect(), word: Vec::new() };
            let mut power = Self::zero((1, 1));
            power.add_term(monomial, coefficient.power(exponent));
            return power;
        }
        if !(0..=4).contains(&exponent) {
            return Self::atom(Atom::Sum(Rc::new(self)), exponent);
        }
        (0..exponent).fold(Self::identity(1), |product, _| product.times(&self, symbols))
    }

    pub fn transpose(&self, symbols: &Symbols) -> Self {
        let mut transposed = Self::zero((self.shape.1, self.shape.0));
        for (monomial, coefficient) in self.terms() {
            let (sign, word) = word::transpose(&monomial.word, symbols);
            let monomial = Monomial { scalars: monomial.scalars.clone(), word };
            transposed.add_term(monomial, coefficient * Rational::integer(sign.into()));
        }
        transposed
    }

    pub fn trace(&self, symbols: &Symbols) -> Self {
        if self.shape == (1, 1) {
            return self.clone();
        }
        self.by_word((1, 1), |word| {
            if word.is_empty() {
                return Self::rational(Rational::integer(i128::try_from(self.shape.0).unwrap_or(0)));
            }
            // An outer product u vᵀ has the trace vᵀ u.
            if let Some(cut) = (1..word.len()).find(|&i| word.get(i).is_some_and(|f| f.shape(symbols).0 == 1)) {
                let (column, row) = word.split_at(cut);
                return Self::from_word([row, column].concat(), (1, 1), symbols);
            }
            let (sign, word) = word::canonical_trace(word.to_vec(), symbols);
            if word.is_empty() {
                return Self::rational(Rational::integer(i128::try_from(self.shape.0).unwrap_or(0)));
            }
            Self::atom(Atom::Trace(word), 1).scaled(Rational::integer(sign.into()))
        })
    }

    /// Applies a linear operation to the word of each term.
    pub(super) fn by_word(&self, shape: (usize, usize), operation: impl Fn(&[Factor]) -> Self) -> Self {
        let mut image = Self::zero(shape);
        for (monomial, coefficient) in self.terms() {
            for (inner, factor) in operation(&monomial.word).terms() {
                let all = Monomial { scalars: monomial.times(inner), word: inner.word.clone() };
                image.add_term(all, coefficient * factor);
            }
        }
        image
    }

    /// Whether the symbol occurs anywhere.
    pub fn contains(&self, symbol: SymbolId) -> bool {
        self.terms.keys().any(|monomial| monomial_contains(monomial, symbol))
    }

    /// Whether the symbol occurs under a function or an unexpanded power.
    pub fn contains_closed(&self, symbol: SymbolId) -> bool {
        self.terms.keys().flat_map(|monomial| monomial.scalars.keys()).any(|atom| match atom {
            Atom::Function(_, inner) | Atom::Sum(inner) => inner.contains(symbol),
            Atom::Symbol(_) | Atom::Trace(_) => false,
        })
    }
}

pub fn monomial_contains(monomial: &Monomial, symbol: SymbolId) -> bool {
    monomial.word.iter().any(|factor| factor.contains(symbol))
        || monomial.scalars.keys().any(|atom| match atom {
            Atom::Symbol(id) => *id == symbol,
            Atom::Trace(word) => word.iter().any(|factor| factor.contains(symbol)),
            Atom::Function(_, inner) | Atom::Sum(inner) => inner.contains(symbol),
        })
}

/// The stage at which the value of a monomial is known: that of the last of its symbols.
pub fn stage_of_monomial(monomial: &Monomial, symbols: &Symbols) -> Stage {
    symbols.ids().fold(Stage::Construction, |latest, id| {
        let stage = symbols.get(id).stage;
        if stage > latest && monomial_contains(monomial, id) { stage } else { latest }
    })
}

/// The stage at which the value of an expression is known.
pub fn stage_of(expression: &Expression, symbols: &Symbols) -> Stage {
    expression.terms.keys().map(|monomial| stage_of_monomial(monomial, symbols)).max().unwrap_or(Stage::Construction)
}

/// A bound on the degree of a monomial in a symbol.
pub fn degree(monomial: &Monomial, symbol: SymbolId) -> usize {
    let of_word = |word: &[Factor]| word.iter().map(|factor| factor.degree(symbol)).sum::<usize>();
    let scalars = monomial.scalars.iter().map(|(atom, exponent)| {
        let inside = match atom {
            Atom::Symbol(id) => usize::from(*id == symbol),
            Atom::Trace(word) => of_word(word),
            Atom::Function(_, inner) | Atom::Sum(inner) => usize::from(inner.contains(symbol)),
        };
        inside.saturating_mul(usize::try_from(exponent.unsigned_abs()).unwrap_or(usize::MAX))
    });
    scalars.fold(of_word(&monomial.word), usize::saturating_add)
}
