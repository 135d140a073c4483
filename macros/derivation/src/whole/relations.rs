//! The relations that a group's generators imply, the distance of a matrix from the group, and a nearer matrix.
//!
//! An invariant of the algebra is one of the group: with `EᵀB + BE = 0` for all generators, `gᵀB g = B`. Relations are linear
//! where products of generators are in the algebra, so that the group is an open part of `I + 𝔤`. Otherwise they are those of
//! fixed vectors and covectors, of a bilinear form, of what commutes with all elements, and of the determinant. These
//! describe all classical groups and their affine extensions; an invariant of the third order isn't among them.

use super::basis::{Basis, Form};
use super::matrix::Matrix;
use super::values::{Value, Words};
use crate::mathematics::chart::times;
use crate::mathematics::linear::kernel;
use crate::staged::Function;

/// The row and the column of an entry.
type Place = (usize, usize);

/// The invariants of a factor.
#[derive(Clone, Debug, Default)]
pub(super) struct Relations {
    /// Linear forms of `g − I`, by its entries.
    linear: Vec<Vec<f64>>,
    /// Forms with `gᵀB g = B`.
    covariant: Vec<Vec<f64>>,
    /// Forms with `g C gᵀ = C`.
    contravariant: Vec<Vec<f64>>,
    /// Matrices with `g M = M g`.
    commuting: Vec<Vec<f64>>,
    has_unit_determinant: bool,
}

impl Relations {
    pub(super) fn of(basis: &Basis) -> Self {
        let (n, all) = (basis.size, &basis.generators);
        let products = || all.iter().flat_map(|a| all.iter().map(|b| times(a, b)));
        let of_entries = |entries: &[Vec<f64>]| kernel(entries.to_vec(), n * n);
        if products().all(|product| basis.has(&product)) {
            return Self { linear: of_entries(all), ..Self::default() };
        }
        // Linear equations in the entries of an unknown matrix `X`: the coefficient of each entry in each entry of a sum.
        let invariant = |terms: &dyn Fn(&[f64], Place, Place) -> f64| {
            let places = || (0..n * n).map(|at| (at / n, at % n));
            let equations = all.iter().flat_map(|e| {
                places().map(move |row| places().map(|unknown| terms(e, row, unknown)).collect::<Vec<f64>>())
            });
            kernel(equations.collect(), n * n)
        };
        let entry = |e: &[f64], i: usize, j: usize| e[i * n + j];
        let only = |is_equal: bool, value: f64| if is_equal { value } else { 0.0 };
        // Covectors `a` with `aᵀE = 0`, and vectors with `E v = 0`, as linear forms of all rows or columns.
        let transposed: Vec<Vec<f64>> =
            all.iter().map(|e| (0..n * n).map(|at| entry(e, at % n, at / n)).collect()).collect();
        let rows = |matrices: &[Vec<f64>]| matrices.iter().flat_map(|e| e.chunks(n).map(<[f64]>::to_vec)).collect();
        let (vectors, covectors) = (kernel(rows(all), n), kernel(rows(&transposed), n));
        let spread = |of: &dyn Fn(usize, usize) -> f64| (0..n * n).map(|at| of(at / n, at % n)).collect::<Vec<f64>>();
        let of_rows = covectors.iter().flat_map(|a| (0..n).map(move |k| (a, k)));
        let of_columns = vectors.iter().flat_map(|v| (0..n).map(move |k| (v, k)));
        let linear = of_rows.map(|(a, k)| spread(&|i, j| only(j == k, a[i])));
        let linear = linear.chain(of_columns.map(|(v, k)| spread(&|i, j| only(i == k, v[j])))).collect();
        let commuting = invariant(&|e, (i, j), (p, q)| only(q == j, entry(e, i, p)) - only(p == i, entry(e, q, j)));
        let has_covectors = !covectors.is_empty();
        let covariant =
            |e: &[f64], (i, j): Place, (p, q): Place| only(q == j, entry(e, p, i)) + only(p == i, entry(e, q, j));
        let contravariant =
            |e: &[f64], (i, j): Place, (p, q): Place| only(q == j, entry(e, i, p)) + only(p == i, entry(e, j, q));
        Self {
            linear,
            covariant: if has_covectors { Vec::new() } else { invariant(&covariant) },
            contravariant: if has_covectors { invariant(&contravariant) } else { Vec::new() },
            // Multiples of the identity commute with all.
            commuting: if commuting.len() > 1 { commuting } else { Vec::new() },
            has_unit_determinant: all.iter().all(|e| (0..n).map(|i| entry(e, i, i)).sum::<f64>().abs() < 1e-9),
        }
    }

    /// The distance of a matrix from the relations; zero in the group.
    pub(super) fn defect(&self, words: &mut Words, form: Form, g: &Matrix) -> Value {
        if form == Form::Rotation {
            return rotation_defect(words, g);
        }
        let (n, mut missed) = (g.rows, Vec::new());
        let difference = g.minus(words, &Matrix::identity(n));
        for relation in &self.linear {
            let relation: Vec<Value> = relation.iter().map(|&factor| Value::of(factor)).collect();
            missed.push(words.dot(&relation, &difference.entries));
        }
        let [left, right] = [&self.covariant, &self.contravariant];
        let forms = left.iter().map(|b| (b, g.transpose(), g.clone()));
        for (b, left, right) in forms.chain(right.iter().map(|c| (c, g.clone(), g.transpose()))) {
            let b = Matrix::known(n, b);
            missed.extend(left.times(words, &b).times(words, &right).minus(words, &b).entries);
        }
        for m in &self.commuting {
            let m = Matrix::known(n, m);
            let (left, right) = (g.times(words, &m), m.times(words, g));
            missed.extend(left.minus(words, &right).entries);
        }
        if self.has_unit_determinant {
            let determinant = g.determinant(words);
            missed.push(words.subtract(determinant, Value::ONE));
        }
        let square = words.dot(&missed, &missed);
        words.apply(Function::Sqrt, square)
    }
}

/// The distance `‖gᵀg − I‖` of a matrix from the orthogonal ones, and `g + g (I − gᵀg)/2`, a Newton step of the polar
/// decomposition.
pub(super) fn restored(words: &mut Words, g: &Matrix) -> Vec<Value> {
    let (one, product) = (Matrix::identity(g.rows), g.transpose().times(words, g));
    let (missed, rest) = (product.minus(words, &one), one.minus(words, &product));
    let distance = norm(words, &missed);
    let change = g.times(words, &rest).scaled(words, Value::of(0.5));
    let nearer = g.plus(words, &change);
    [vec![distance], nearer.entries].concat()
}

/// The Frobenius norm of a matrix that is its transpose or the negative of it: twice what is above the diagonal.
fn norm(words: &mut Words, m: &Matrix) -> Value {
    let on: Vec<Value> = (0..m.rows).map(|i| m.at(i, i)).collect();
    let above = (0..m.rows).flat_map(|i| (i + 1..m.rows).map(move |j| (i, j)));
    let off: Vec<Value> = above.map(|(i, j)| m.at(i, j)).collect();
    let (on, off) = (words.dot(&on, &on), words.dot(&off, &off));
    let off = words.multiply(off, Value::of(2.0));
    let square = words.add(on, off);
    words.apply(Function::Sqrt, square)
}

/// `‖RᵀR − I‖`, and `|det R − 1|` for a reflection.
fn rotation_defect(words: &mut Words, r: &Matrix) -> Value {
    let gram = Matrix::of(3, 3, |i, j| words.dot(&r.column(i), &r.column(j)));
    let missed = gram.minus(words, &Matrix::identity(3));
    let departure = norm(words, &missed);
    let determinant = r.determinant(words);
    // The root of a square is the number without its sign, to the bit: the quotient is one or minus one.
    let square = words.multiply(determinant, determinant);
    let size = words.apply(Function::Sqrt, square);
    let sign = words.divide(determinant, size);
    let twice = words.subtract(Value::ONE, sign);
    let is_reflection = words.multiply(twice, Value::of(0.5));
    let missed = words.subtract(Value::ONE, determinant);
    let reflected = words.multiply(is_reflection, missed);
    words.add(departure, reflected)
}
