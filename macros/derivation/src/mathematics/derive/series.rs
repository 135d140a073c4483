//! Truncated power series in `h` along `F = exp(h ξ̂)`: the limit `h → 0` through `let`s and functions.

use std::cell::Cell;
use std::collections::BTreeMap;

use super::Context;
use crate::mathematics::symbolic::{
    Atom, Expression, Factor, Function, Rational, SymbolId, Variations, substitute, variation,
};

/// The reason why `l_d` has no continuous limit `l`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitError {
    /// `h` is under a function that has no value as `h → 0`.
    StepInsideFunction,
    /// A power of `h` below −1.
    TooSingular(i32),
    /// The limit `l(ξ, w)` doesn't exist.
    NotALagrangian,
    /// The limit has too many terms.
    TooLarge,
}

/// The orders from which on terms are dropped, except the first of a series; the later ones are tried where `l_d` isn't
/// known to the first order by those before. A square of a kinetic part that is multiplied out divides by `h³`, and a cube
/// by `h⁵`, in terms that aren't small one by one.
const CUTOFFS: [i32; 3] = [3, 5, 7];
/// The `end` of an exact series.
const NEVER: i32 = 1_000;
/// The limit on factors: a limit that a person would write down has a hundredth of it, that of a Cayley transform a
/// tenth. A larger coefficient ends a series, as the limit may not need it.
const MOST_FACTORS: usize = 16_000;

/// `Σ c_i hⁱ + O(hᵉ)`.
#[derive(Clone, Debug)]
pub(super) struct Series {
    shape: (usize, usize),
    coefficients: BTreeMap<i32, Expression>,
    /// The order `e` of the remainder.
    end: i32,
    /// The order from which on terms are dropped.
    cutoff: i32,
}

impl Series {
    /// The coefficient of this order in a scalar series.
    pub(super) fn at(&self, order: i32) -> Expression {
        self.coefficients.get(&order).cloned().unwrap_or_else(|| Expression::zero((1, 1)))
    }

    pub(super) fn terms(&self) -> impl Iterator<Item = (i32, &Expression)> {
        self.coefficients.iter().map(|(order, coefficient)| (*order, coefficient))
    }

    /// The lowest order with a coefficient; the end if there is none.
    fn lowest(&self) -> i32 {
        self.coefficients.keys().next().copied().unwrap_or(self.end)
    }

    fn cut(mut self, end: i32) -> Self {
        self.coefficients.retain(|_, coefficient| !coefficient.is_zero());
        self.end = self.end.min(end).min(NEVER);
        let (lowest, highest) = (self.lowest(), self.coefficients.keys().next_back().copied());
        let most = most(self.cutoff, lowest);
        if lowest < self.end && !(self.is_exact() && highest < Some(most)) {
            self.end = self.end.min(most);
        }
        self.coefficients.retain(|&order, _| order < self.end);
        self
    }

    /// Whether the series has no remainder.
    fn is_exact(&self) -> bool {
        self.end > NEVER / 2
    }

    fn plus(mut self, other: Self) -> Self {
        let end = self.end.min(other.end);
        for (order, coefficient) in other.coefficients {
            let sum = match self.coefficients.remove(&order) {
                Some(present) => present.plus(coefficient),
                None => coefficient,
            };
            self.coefficients.insert(order, sum);
        }
        self.cut(end)
    }

    fn mapped(self, operation: impl Fn(&Expression) -> Expression, shape: (usize, usize)) -> Self {
        let coefficients = self.coefficients.iter().map(|(&order, value)| (order, operation(value))).collect();
        Self { shape, coefficients, ..self }.cut(NEVER)
    }

    /// The series times `hⁿ`.
    fn shifted(self, n: i32) -> Self {
        let coefficients = self.coefficients.into_iter().map(|(order, value)| (order + n, value)).collect();
        Self { coefficients, end: self.end + n, ..self }.cut(NEVER)
    }
}

/// The order at which a series is cut.
fn most(cutoff: i32, lowest: i32) -> i32 {
    cutoff.max(lowest + 1)
}

/// The series of `l_d`, known at least to the first order in `h`.
pub(super) fn of_lagrangian(context: &Context, scratch: SymbolId) -> Result<Series, LimitError> {
    let mut found = Err(LimitError::NotALagrangian);
    for cutoff in CUTOFFS {
        found = Expansion::new(context, scratch, cutoff).and_then(|expansion| expansion.of_lagrangian());
        // Another error doesn't depend on what was dropped.
        if !matches!(found, Err(LimitError::NotALagrangian)) {
            break;
        }
    }
    found
}

/// Evaluates expressions to series.
struct Expansion<'a> {
    context: &'a Context<'a>,
    /// A scalar variable for derivatives of functions.
    scratch: SymbolId,
    cutoff: i32,
    known: BTreeMap<SymbolId, Series>,
    /// Whether a coefficient exceeded the limit on factors.
    is_too_large: Cell<bool>,
}

impl<'a> Expansion<'a> {
    fn new(context: &'a Context, scratch: SymbolId, cutoff: i32) -> Result<Self, LimitError> {
        let mut expansion = Self { context, scratch, cutoff, known: BTreeMap::new(), is_too_large: Cell::new(false) };
        for (factor, one) in context.directions.factors.iter().enumerate() {
            if context.is_added(factor) {
                let velocity = expansion.constant(context.symbol(one.velocity)).shifted(1);
                expansion.known.insert(one.increment, velocity);
                continue;
            }
            let [increment, inverse] =
                [Rational::ONE, -Rational::ONE].map(|sign| expansion.exponential(one.velocity, sign));
            expansion.known.insert(one.increment, increment);
            expansion.known.insert(one.inverse, inverse);
        }
        let h = expansion.one().shifted(1);
        expansion.known.insert(context.declared.step, h);
        for one in &context.declared.lets {
            let value = expansion.of(&one.value)?;
            expansion.known.insert(one.symbol, value);
        }
        Ok(expansion)
    }

    fn constant(&self, value: Expression) -> Series {
        let shape = value.shape();
        let coefficients = if value.is_zero() { BTreeMap::new() } else { BTreeMap::from([(0, value)]) };
        Series { shape, coefficients, end: NEVER, cutoff: self.cutoff }
    }

    fn one(&self) -> Series {
        self.constant(Expression::identity(1))
    }

    /// `I ± h ξ̂ + h² ξ̂²/2 ± …`.
    fn exponential(&self, velocity: SymbolId, sign: Rational) -> Series {
        let xi = self.context.symbol(velocity).scaled(sign);
        let identity = Expression::identity(xi.shape().0);
        let mut series = self.constant(identity.clone());
        let mut power = identity;
        for order in 1..self.cutoff {
            power = self.context.product(&power, &xi).scaled(Rational::new(1, order.into()));
            series.coefficients.insert(order, power.clone());
        }
        series.cut(self.cutoff)
    }

    fn of_lagrangian(&self) -> Result<Series, LimitError> {
        let found = self.of(&self.context.declared.expression);
        match found {
            Ok(series) if series.end >= 2 => Ok(series),
            _ if self.is_too_large.get() => Err(LimitError::TooLarge),
            found => found.and(Err(LimitError::NotALagrangian)),
        }
    }

    fn of(&self, expression: &Expression) -> Result<Series, LimitError> {
        let mut sum = self.constant(Expression::zero(expression.shape()));
        for (monomial, coefficient) in expression.terms() {
            let mut product = self.constant(Expression::rational(coefficient));
            for (atom, exponent) in &monomial.scalars {
                product = self.times(&product, &self.power(self.atom(atom)?, *exponent)?)?;
            }
            let word = match self.word(&monomial.word)? {
                Some(word) => word,
                None => self.constant(Expression::identity(expression.shape().0)),
            };
            sum = sum.plus(self.times(&product, &word)?);
        }
        Ok(sum)
    }

    fn atom(&self, atom: &Atom) -> Result<Series, LimitError> {
        let symbols = self.context.symbols;
        match atom {
            Atom::Symbol(id) => Ok(self.symbol(*id)),
            Atom::Trace(word) => {
                let product = self.word(word)?.unwrap_or_else(|| self.one());
                Ok(product.mapped(|value| value.trace(symbols), (1, 1)))
            }
            Atom::Function(function, inner) => self.function(*function, self.of(inner)?),
            Atom::Sum(inner) => self.of(inner),
        }
    }

    fn symbol(&self, id: SymbolId) -> Series {
        self.known.get(&id).cloned().unwrap_or_else(|| self.constant(self.context.symbol(id)))
    }

    fn word(&self, word: &[Factor]) -> Result<Option<Series>, LimitError> {
        let mut product: Option<Series> = None;
        for factor in word {
            let factor = self.factor(factor)?;
            product = Some(match product {
                Some(product) => self.times(&product, &factor)?,
                None => factor,
            });
        }
        Ok(product)
    }

    fn factor(&self, factor: &Factor) -> Result<Series, LimitError> {
        let symbols = self.context.symbols;
        let turned = |series: Series, transposed: bool| {
            let (rows, columns) = series.shape;
            if transposed { series.mapped(|value| value.transpose(symbols), (columns, rows)) } else { series }
        };
        let inner = |word: &[Factor]| Ok(self.word(word)?.unwrap_or_else(|| self.one()));
        Ok(match factor {
            Factor::Symbol { id, transposed } => turned(self.symbol(*id), *transposed),
            Factor::Inverse { id, transposed } if symbols.inverse_of(*id).is_some() => {
                let inverse = symbols.inverse_of(*id).unwrap_or(*id);
                turned(self.symbol(inverse), *transposed)
            }
            Factor::Inverse { .. } | Factor::Unit { .. } => {
                let mut value = Expression::zero(factor.shape(symbols));
                value.add_term(
                    crate::mathematics::symbolic::Monomial { word: vec![factor.clone()], ..Default::default() },
                    Rational::ONE,
                );
                self.constant(value)
            }
            Factor::Hat(word) => inner(word)?.mapped(|value| value.hat(symbols), (3, 3)),
            Factor::Diagonal(word) => inner(word)?.mapped(|value| value.diagonal(symbols), factor.shape(symbols)),
            Factor::Vee { word, transposed } => {
                turned(inner(word)?.mapped(|value| value.vee(symbols), (3, 1)), *transposed)
            }
        })
    }

    fn times(&self, a: &Series, b: &Series) -> Result<Series, LimitError> {
        let shape = match (a.shape, b.shape) {
            ((1, 1), shape) | (shape, (1, 1)) => shape,
            ((rows, _), (_, columns)) => (rows, columns),
        };
        let lowest = a.lowest() + b.lowest();
        if lowest < -NEVER {
            return Err(LimitError::TooSingular(lowest));
        }
        let end = (a.end + b.lowest()).min(b.end + a.lowest());
        let mut end = if a.is_exact() && b.is_exact() { end } else { end.min(most(self.cutoff, lowest)) };
        let mut coefficients: BTreeMap<i32, Expression> = BTreeMap::new();
        for (i, x) in a.terms() {
            for (j, y) in b.terms() {
                if i + j >= end {
                    break;
                }
                if x.size().saturating_mul(y.size()) > MOST_FACTORS {
                    self.is_too_large.set(true);
                    end = i + j;
                    break;
                }
                let product = self.context.product(x, y);
                let sum = match coefficients.remove(&(i + j)) {
                    Some(present) => present.plus(product),
                    None => product,
                };
                coefficients.insert(i + j, sum);
            }
        }
        Ok(Series { shape, coefficients, end, cutoff: self.cutoff }.cut(NEVER))
    }

    fn power(&self, base: Series, exponent: i32) -> Result<Series, LimitError> {
        let mut square = if exponent < 0 { self.reciprocal(&base)? } else { base };
        let (mut product, mut left) = (self.one(), exponent.unsigned_abs());
        while left > 0 {
            if left % 2 == 1 {
                product = self.times(&product, &square)?;
            }
            left /= 2;
            if left > 0 {
                square = self.times(&square, &square)?;
            }
        }
        Ok(product)
    }

    /// `1/(c hˡ (1 + ε)) = c⁻¹ h⁻ˡ Σ (−ε)ᵐ`.
    fn reciprocal(&self, series: &Series) -> Result<Series, LimitError> {
        let (order, leading) = series.terms().next().ok_or(LimitError::NotALagrangian)?;
        let inverse = self.constant(leading.clone().power(-1, self.context.symbols)).shifted(-order);
        let mut epsilon = self.times(series, &inverse)?;
        epsilon.coefficients.remove(&0);
        let minus = epsilon.mapped(|value| value.clone().scaled(-Rational::ONE), (1, 1));
        let (mut sum, mut power) = (self.one(), self.one());
        for _ in 0..self.cutoff {
            power = self.times(&power, &minus)?;
            sum = sum.plus(power.clone());
        }
        self.times(&inverse, &sum.cut((self.cutoff + 1) * minus.lowest()))
    }

    /// Taylor's series about the value at `h = 0`; for a root, the even leading power of `h` is taken out first.
    fn function(&self, function: Function, argument: Series) -> Result<Series, LimitError> {
        let lowest = argument.lowest();
        if function == Function::Sqrt && lowest != 0 && lowest < argument.end && lowest % 2 == 0 {
            return Ok(self.function(function, argument.shifted(-lowest))?.shifted(lowest / 2));
        }
        let is_singular = lowest > 0 && matches!(function, Function::Sqrt | Function::Ln);
        if lowest < 0 || is_singular {
            return Err(LimitError::StepInsideFunction);
        }
        let symbols = self.context.symbols;
        let mut change = argument;
        let at = change.coefficients.remove(&0).unwrap_or_else(|| Expression::zero((1, 1)));
        let along = Variations::from([(self.scratch, Expression::identity(1))]);
        let map = BTreeMap::from([(self.scratch, at)]);
        let mut derivative = Expression::function(function, self.context.symbol(self.scratch));
        let (mut sum, mut power) = (self.constant(Expression::zero((1, 1))), self.one());
        for order in 1..=self.cutoff {
            let value = self.constant(substitute(&derivative, &map, symbols));
            sum = sum.plus(self.times(&value, &power)?);
            derivative = variation(&derivative, &along, symbols);
            power = self
                .times(&power, &change)?
                .mapped(|value| value.clone().scaled(Rational::new(1, order.into())), (1, 1));
        }
        Ok(sum.cut(self.cutoff * change.lowest()))
    }
}
