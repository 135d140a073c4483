//! The basis of a matrix Lie algebra, in numbers, and the form of the group that follows from it.

use super::StepRefusal;
use super::linear::{ROUNDING, inverse_of};

/// The form of a group, by which inverses and increments are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The rotations of space in the basis of SO(3), whose Cayley map has a closed form.
    Rotation,
    /// Translations: products of generators vanish, and increments are added.
    Translation,
    /// Rigid motions `[R, X; 0, I]` with an orthogonal `R` of this many rows.
    Rigid(usize),
    /// Orthogonal matrices: the generators are skew.
    Orthogonal,
    /// Matrices of two rows with determinant one.
    Unimodular,
    /// A group of no special form.
    General,
}

/// The coordinates of an increment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chart {
    /// The Cayley map of an element of the algebra.
    Cayley,
    /// The product of the Cayley maps of all generators, where that of a sum leaves the group.
    Product,
}

/// The generators of a factor, and the linear forms that give components.
#[derive(Clone, Debug)]
pub struct Basis {
    /// The number of rows of the matrices.
    pub size: usize,
    /// `E_k`, by rows.
    pub generators: Vec<Vec<f64>>,
    /// `tr(E_kᵀ E_k)`.
    pub(super) lengths: Vec<f64>,
    /// The components of an element of the algebra as sums of terms `(k, entry, factor)`.
    pub(super) dual: Vec<(usize, usize, f64)>,
    pub(super) is_orthogonal: bool,
}

/// The basis of SO(3), in its order.
const ROTATIONS: [[f64; 9]; 3] = [
    [0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
];

impl Basis {
    /// The basis of these matrices.
    pub(super) fn of(generators: &[Vec<f64>]) -> Result<Self, StepRefusal> {
        let size = generators.first().map_or(0, Vec::len).isqrt();
        let pairing = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let count = generators.len();
        let gram = |i: usize, j: usize| pairing(&generators[i], &generators[j]);
        let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (i, j)));
        let is_orthogonal = pairs.into_iter().all(|(i, j)| gram(i, j).abs() < ROUNDING);
        let pairings: Vec<f64> = (0..count * count).map(|at| gram(at / count, at % count)).collect();
        let inverse = inverse_of(count, &pairings).ok_or(StepRefusal::Dependent)?;
        let factor =
            |place: usize, k: usize| (0..count).map(|j| inverse[k * count + j] * generators[j][place]).sum::<f64>();
        let places = (0..size * size).flat_map(|place| (0..count).map(move |k| (k, place)));
        let dual = places.map(|(k, place)| (k, place, factor(place, k))).filter(|term| term.2.abs() > 1e-14).collect();
        Ok(Self {
            size,
            generators: generators.to_vec(),
            lengths: (0..count).map(|k| gram(k, k)).collect(),
            dual,
            is_orthogonal,
        })
    }

    /// The number of generators.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.generators.len()
    }

    /// The constants of the basis that programs contain.
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> {
        let lengths = self.lengths.iter().map(|length| 1.0 / length);
        let cubes = self.generators.iter().filter_map(|e| self.cube(e));
        let squares = self.generators.iter().flat_map(|e| self.times(e, e));
        let all = self.generators.iter().flatten().copied().chain(self.dual.iter().map(|term| term.2));
        all.chain(lengths).chain(cubes).chain(squares)
    }

    /// The form of the group.
    pub(super) fn form(&self) -> Form {
        let (n, all) = (self.size, &self.generators);
        if all.iter().eq(ROTATIONS.iter()) {
            return Form::Rotation;
        }
        if all.iter().all(|a| all.iter().all(|b| self.times(a, b).iter().all(|&entry| entry == 0.0))) {
            return Form::Translation;
        }
        let vanish = |a: f64, b: f64| a + b == 0.0;
        let is_skew = |e: &[f64], k: usize| (0..k * k).all(|at| vanish(e[at / k * n + at % k], e[at % k * n + at / k]));
        if all.iter().all(|e| is_skew(e, n)) {
            return Form::Orthogonal;
        }
        let is_rigid = |&k: &usize| all.iter().all(|e| is_skew(e, k) && e[k * n..].iter().all(|&entry| entry == 0.0));
        if let Some(k) = (2..n).rev().find(is_rigid) {
            return Form::Rigid(k);
        }
        let is_traceless = |e: &Vec<f64>| vanish(e[0], e[3]);
        if n == 2 && all.iter().all(is_traceless) { Form::Unimodular } else { Form::General }
    }

    /// Coordinates about the identity that stay in the group.
    pub(super) fn chart(&self) -> Result<Chart, StepRefusal> {
        if self.has_cayley_map() {
            return Ok(Chart::Cayley);
        }
        match self.generators.iter().position(|e| self.cube(e).is_none()) {
            Some(generator) => Err(StepRefusal::Cube { generator }),
            None => Ok(Chart::Product),
        }
    }

    /// `A B`.
    pub(super) fn times(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
        let n = self.size;
        (0..n * n).map(|at| (0..n).map(|k| a[at / n * n + k] * b[k * n + at % n]).sum()).collect()
    }

    /// The number `c` with `E³ = c E`.
    pub(super) fn cube(&self, e: &[f64]) -> Option<f64> {
        let cube = self.times(&self.times(e, e), e);
        let at = e.iter().position(|&entry| entry != 0.0)?;
        let c = cube[at] / e[at];
        cube.iter().zip(e).all(|(a, b)| (a - c * b).abs() < ROUNDING).then_some(c)
    }

    /// Whether a matrix is in the algebra.
    pub(super) fn has(&self, matrix: &[f64]) -> bool {
        let mut rest = matrix.to_vec();
        for &(k, place, factor) in &self.dual {
            for (rest, e) in rest.iter_mut().zip(&self.generators[k]) {
                *rest -= factor * matrix[place] * e;
            }
        }
        rest.iter().all(|entry| entry.abs() < ROUNDING)
    }

    /// Whether the Cayley map of the algebra is in the group, as it is if and only if cubes of elements are in the algebra:
    /// `Σ E_i E_j E_k` over all orders, for all three.
    fn has_cayley_map(&self) -> bool {
        let (all, count) = (&self.generators, self.dimension());
        let products = |a: &[f64], b: &[f64], c: &[f64]| self.times(&self.times(a, b), c);
        let orders = |i: usize, j: usize, k: usize| {
            let orders = [[i, j, k], [i, k, j], [j, i, k], [j, k, i], [k, i, j], [k, j, i]];
            let each = orders.map(|[i, j, k]| products(&all[i], &all[j], &all[k]));
            (0..self.size * self.size).map(|at| each.iter().map(|product| product[at]).sum()).collect::<Vec<f64>>()
        };
        (0..count).all(|i| (i..count).all(|j| (j..count).all(|k| self.has(&orders(i, j, k)))))
    }
}
