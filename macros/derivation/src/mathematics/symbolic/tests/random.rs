//! Random values and random expressions, the same in every run.

use super::numeric::{Matrix, Values};
use crate::mathematics::symbolic::{Expression, Factor, Function, Rational, Stage, Structure, SymbolId, Symbols};

/// Random numbers by xorshift; its first numbers from a small seed are small, so some are skipped.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        for _ in 0..8 {
            random.below(2);
        }
        random
    }

    pub(crate) fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from((self.0 >> 24) % u64::try_from(bound).expect("a bound")).expect("below the bound")
    }

    /// Between −1 and 1.
    #[allow(clippy::cast_precision_loss)] // 30 bits
    pub(crate) fn signed(&mut self) -> f64 {
        self.below(1 << 30) as f64 / f64::from(1 << 29) - 1.0
    }

    pub(crate) fn matrix(&mut self, rows: usize, columns: usize) -> Matrix {
        Matrix::new(rows, columns, |_, _| self.signed())
    }

    pub(crate) fn rotation(&mut self) -> Matrix {
        let axis = self.matrix(3, 1);
        exponential(&axis.scaled(3.0))
    }

    /// A value with the promised structure.
    fn of(&mut self, structure: Structure, (rows, columns): (usize, usize)) -> Matrix {
        let any = self.matrix(rows, columns);
        match structure {
            Structure::General if (rows, columns) == (1, 1) => Matrix::scalar(1.25 + 0.5 * any.at(0, 0)),
            Structure::General => any,
            Structure::Point => Matrix::new(rows, 1, |row, _| if row + 1 < rows { any.at(row, 0) } else { 1.0 }),
            Structure::Symmetric => any.plus(&any.transpose()),
            Structure::Skew => any.minus(&any.transpose()),
            Structure::Diagonal => Matrix::new(3, 1, |row, _| any.at(row, row)).diagonal(),
            Structure::Orthogonal | Structure::Rotation => self.rotation(),
        }
    }
}

/// `exp(û)` by Rodrigues' formula.
pub(crate) fn exponential(u: &Matrix) -> Matrix {
    let angle = u.transpose().times(u).at(0, 0).sqrt();
    let hat = u.hat();
    let (first, second) =
        if angle < 1e-8 { (1.0, 0.5) } else { (angle.sin() / angle, (1.0 - angle.cos()) / (angle * angle)) };
    Matrix::identity(3).plus(&hat.scaled(first)).plus(&hat.times(&hat).scaled(second))
}

/// One symbol of each kind.
pub(crate) struct World {
    pub(crate) symbols: Symbols,
    pub(crate) values: Values,
    pub(crate) h: SymbolId,
    pub(crate) k: SymbolId,
    pub(crate) f: SymbolId,
    pub(crate) symmetric: SymbolId,
    pub(crate) diagonal: SymbolId,
    pub(crate) a: SymbolId,
    pub(crate) b: SymbolId,
    pub(crate) e: SymbolId,
    pub(crate) second: SymbolId,
    pub(crate) u: SymbolId,
    pub(crate) v: SymbolId,
    pub(crate) w: SymbolId,
}

impl World {
    pub(crate) fn new(random: &mut Random) -> Self {
        let mut symbols = Symbols::default();
        let mut values = Values::new();
        let mut add = |name: &str, shape, structure, stage| {
            let id = symbols.add(name, shape, structure, stage);
            values.insert(id, random.of(structure, shape));
            id
        };
        let (scalar, vector, square) = ((1, 1), (3, 1), (3, 3));
        Self {
            h: add("h", scalar, Structure::General, Stage::Construction),
            k: add("k", scalar, Structure::General, Stage::Construction),
            f: add("F", square, Structure::Rotation, Stage::Iteration),
            symmetric: add("S", square, Structure::Symmetric, Stage::Construction),
            diagonal: add("D", square, Structure::Diagonal, Stage::Construction),
            a: add("A", square, Structure::General, Stage::Construction),
            b: add("B", square, Structure::General, Stage::Step),
            e: add("E", square, Structure::Skew, Stage::Construction),
            second: add("E_j", square, Structure::Skew, Stage::Construction),
            u: add("u", vector, Structure::General, Stage::Construction),
            v: add("v", vector, Structure::General, Stage::Step),
            w: add("w", vector, Structure::General, Stage::Step),
            symbols,
            values,
        }
    }

    pub(crate) fn expression(&self, id: SymbolId) -> Expression {
        Expression::symbol(id, &self.symbols)
    }
}

/// An expression in normal form, and its value computed alongside by the same operations on numbers.
#[derive(Clone)]
pub(crate) struct Both {
    pub(crate) expression: Expression,
    pub(crate) value: Matrix,
}

impl Both {
    fn times(&self, other: &Self, symbols: &Symbols) -> Self {
        Self { expression: self.expression.times(&other.expression, symbols), value: self.value.times(&other.value) }
    }
}

/// A symbol or a constant.
fn leaf(random: &mut Random, world: &World, shape: (usize, usize)) -> Both {
    let symbol = |id: SymbolId| Both { expression: world.expression(id), value: world.values[&id].clone() };
    match shape {
        (1, 1) => symbol([world.h, world.k][random.below(2)]),
        (3, 1) if random.below(6) == 0 => {
            let index = random.below(3);
            let unit = vec![Factor::Unit { index, size: 3, transposed: false }];
            Both { expression: Expression::from_word(unit, shape, &world.symbols), value: Matrix::unit(index, 3) }
        }
        (3, 1) => symbol([world.u, world.v, world.w][random.below(3)]),
        _ if random.below(8) == 0 => Both { expression: Expression::identity(3), value: Matrix::identity(3) },
        _ => {
            let all = [world.f, world.f, world.symmetric, world.diagonal, world.a, world.b, world.e];
            symbol(all[random.below(all.len())])
        }
    }
}

/// `sin a + 2`, between 1 and 3: away from singularities, and small enough for central differences.
fn bounded(a: Both) -> Both {
    let sine = Expression::function(Function::Sin, a.expression);
    Both {
        expression: sine.plus(Expression::rational(Rational::integer(2))),
        value: Matrix::scalar(a.value.at(0, 0).sin() + 2.0),
    }
}

/// A random expression of at most `depth` nested operations.
pub(crate) fn both(random: &mut Random, world: &World, shape: (usize, usize), depth: usize) -> Both {
    if depth == 0 {
        return leaf(random, world, shape);
    }
    let symbols = &world.symbols;
    let pick = random.below(9);
    let exponent = [-2, -1, 2, 3, 5][random.below(5)];
    let function = Function::METHODS[random.below(Function::METHODS.len())];
    let mut part = |shape| both(random, world, shape, depth - 1);
    let product = |a: &Both, b: &Both| a.times(b, symbols);
    let turned = |a: Both| Both { expression: a.expression.transpose(symbols), value: a.value.transpose() };
    let (scalar, vector, square) = ((1, 1), (3, 1), (3, 3));
    match (shape, pick) {
        (_, 0) => {
            let a = part(shape);
            Both { expression: a.expression.scaled(Rational::new(-3, 2)), value: a.value.scaled(-1.5) }
        }
        (_, 7) => {
            let (a, b) = (part(shape), part(shape));
            Both { expression: a.expression.plus(b.expression), value: a.value.plus(&b.value) }
        }
        ((1, 1), 5) => {
            let a = bounded(part(scalar));
            let base = a.expression.scaled(Rational::new(1, 3));
            let value = a.value.at(0, 0) / 3.0;
            Both { expression: base.power(exponent, symbols), value: Matrix::scalar(value.powi(exponent)) }
        }
        ((1, 1), 6) => {
            let a = bounded(part(scalar));
            let value = function.apply(a.value.at(0, 0));
            Both { expression: Expression::function(function, a.expression), value: Matrix::scalar(value) }
        }
        (_, 8) => {
            let (a, b) = (part(shape), part(shape));
            Both { expression: a.expression.minus(b.expression), value: a.value.minus(&b.value) }
        }
        ((1, 1), 1 | 2) => {
            let a = part(square);
            Both { expression: a.expression.trace(symbols), value: Matrix::scalar(a.value.trace()) }
        }
        ((1, 1), 3 | 4) => {
            let (a, b) = (turned(part(vector)), part(vector));
            product(&a, &b)
        }
        ((3, 1), 1) => {
            let a = part(square);
            Both { expression: a.expression.vee(symbols), value: a.value.vee() }
        }
        ((3, 1), 2) => {
            let (a, b) = (part(vector), part(vector));
            let hat = Both { expression: a.expression.hat(symbols), value: a.value.hat() };
            product(&hat, &b)
        }
        ((3, 1), 3 | 4) => {
            let (a, b) = (part(square), part(vector));
            product(&a, &b)
        }
        ((3, 3), 1) => turned(part(square)),
        ((3, 3), 2) => {
            let a = part(vector);
            Both { expression: a.expression.hat(symbols), value: a.value.hat() }
        }
        ((3, 3), 3) => {
            let a = part(vector);
            Both { expression: a.expression.diagonal(symbols), value: a.value.diagonal() }
        }
        ((3, 3), 4) => {
            let (a, b) = (part(vector), turned(part(vector)));
            product(&a, &b)
        }
        ((3, 3), _) => {
            let (a, b) = (part(square), part(square));
            product(&a, &b)
        }
        _ => {
            let (a, b) = (part(scalar), part(shape));
            product(&a, &b)
        }
    }
}
