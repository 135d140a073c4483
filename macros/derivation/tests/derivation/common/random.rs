//! Random values, the same in every run.

use super::numeric::{Matrix, Values};
use liestep_derivation::mathematics::symbolic::{Expression, Stage, Structure, SymbolId, Symbols};

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

    /// A number between −1 and 1.
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

    /// A random matrix with a structure, such as symmetry.
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

/// Symbols of each structure, with random values.
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
