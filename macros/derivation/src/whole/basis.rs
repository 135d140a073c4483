//! The basis of a matrix Lie algebra, in numbers, and the form of the group that follows from it.

use super::StepRefusal;
use crate::mathematics::chart::{Chart, chart, cube, dual, has, times};
use crate::mathematics::linear::ROUNDING;

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

/// The basis of the rotations of the plane.
const TURN: [f64; 4] = [0.0, -1.0, 1.0, 0.0];

impl Basis {
    /// The basis of these matrices.
    pub(super) fn of(generators: &[Vec<f64>]) -> Result<Self, StepRefusal> {
        let size = generators.first().map_or(0, Vec::len).isqrt();
        let pairing = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let count = generators.len();
        let gram = |i: usize, j: usize| pairing(&generators[i], &generators[j]);
        let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (i, j)));
        let is_orthogonal = pairs.into_iter().all(|(i, j)| gram(i, j).abs() < ROUNDING);
        let dual = dual(generators).ok_or(StepRefusal::Dependent)?;
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
        let cubes = self.generators.iter().filter_map(|e| cube(e));
        let squares = self.generators.iter().flat_map(|e| times(e, e));
        let all = self.generators.iter().flatten().copied().chain(self.dual.iter().map(|term| term.2));
        all.chain(lengths).chain(cubes).chain(squares)
    }

    /// The form of the group.
    pub(super) fn form(&self) -> Form {
        let (n, all) = (self.size, &self.generators);
        if all.iter().eq(ROTATIONS.iter()) {
            return Form::Rotation;
        }
        if all.iter().all(|a| all.iter().all(|b| times(a, b).iter().all(|&entry| entry == 0.0))) {
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

    /// The number of rows of the rotations in a group of all rigid motions of the plane or of space, with any number of columns
    /// beside the rotation, in the basis of the library's groups: rotations, then the columns row by row.
    pub(super) fn rigid_motions(&self) -> Option<usize> {
        [2, 3].into_iter().filter(|&rows| rows < self.size).find(|&rows| {
            let n = self.size;
            let wider = |e: &[f64]| -> Vec<f64> {
                let inside = |at: usize| at / n < rows && at % n < rows;
                (0..n * n).map(|at| if inside(at) { e[at / n * rows + at % n] } else { 0.0 }).collect()
            };
            let turns: Vec<Vec<f64>> =
                if rows == 2 { vec![wider(&TURN)] } else { ROTATIONS.iter().map(|e| wider(e)).collect() };
            let unit =
                |column: usize, row: usize| (0..n * n).map(|at| f64::from(u8::from(at == row * n + column))).collect();
            let moves = (rows..n).flat_map(|column| (0..rows).map(move |row| unit(column, row)));
            turns.into_iter().chain(moves).eq(self.generators.iter().cloned())
        })
    }

    /// Coordinates about the identity that stay in the group.
    pub(super) fn chart(&self) -> Result<Chart, StepRefusal> {
        chart(&self.generators).map_err(|generator| StepRefusal::Cube { generator })
    }

    /// Whether a matrix is in the algebra.
    pub(super) fn has(&self, matrix: &[f64]) -> bool {
        has(&self.generators, &self.dual, matrix)
    }
}
