//! The actions on advected parameters: their change by an increment, and their values at an attitude.

use super::factor::MatrixFactor;
use super::matrix::Matrix;
use super::values::{Value, Words};
use crate::mathematics::symbolic::{Space, Variance};
use crate::staged::Action;

/// The change of `w` by the increments `F − I` of all factors.
pub(super) fn change(words: &mut Words, factors: &[MatrixFactor], action: Action, w: &Matrix, d: &[Matrix]) -> Matrix {
    let inverse = |words: &mut Words, k: usize| factors[k].inverse_increment(words, &d[k]);
    // `A w B − w` of `A − I` and `B − I`.
    let both = |words: &mut Words, left: &Matrix, right: &Matrix| {
        let moved = left.times(words, w);
        let other = w.plus(words, &moved).times(words, right);
        moved.plus(words, &other)
    };
    let zero = || Matrix::of(w.rows, w.columns, |_, _| Value::ZERO);
    match action {
        Action::Given => zero(),
        Action::Moved(variance, k) => {
            let back = of_vectors(variance, &d[k], || inverse(words, k));
            match variance.sides([&back, &d[k]], Matrix::transpose) {
                [Some(left), Some(right)] => both(words, &left, &right),
                [Some(left), None] => left.times(words, w),
                [None, Some(right)] => w.times(words, &right),
                [None, None] => zero(),
            }
        }
        Action::Point(k) => {
            let inverse = factors[k].inverse_of_increment(words, &d[k]);
            let moved = d[k].times(words, &homogeneous(w));
            affine(&inverse.times(words, &moved).negated(words), w.rows)
        }
        Action::Relative { of, from } => {
            let inverse = inverse(words, from);
            both(words, &inverse, &d[of])
        }
        Action::Configuration(of) => w.times(words, &d[of]),
    }
}

/// The value at the attitudes `g` of all factors for the value `w` in space; `inverse` has the inverse of a factor's.
pub(super) fn at_attitude(
    words: &mut Words,
    action: Action,
    w: &Matrix,
    g: &[Matrix],
    inverse: &dyn Fn(&mut Words, usize) -> Matrix,
) -> Matrix {
    match action {
        Action::Given => w.clone(),
        Action::Moved(variance, k) => {
            let back = of_vectors(variance, &g[k], || inverse(words, k));
            variance.moved(w, [&back, &g[k]], Matrix::transpose, |a, b| a.times(words, b))
        }
        Action::Point(k) => affine(&inverse(words, k).times(words, &homogeneous(w)), w.rows),
        Action::Relative { of, from } => inverse(words, from).times(words, w).times(words, &g[of]),
        Action::Configuration(of) => w.times(words, &g[of]),
    }
}

/// The inverse, if vectors are moved by it; covectors are not, and it isn't computed for them.
fn of_vectors(variance: Variance, g: &Matrix, inverse: impl FnOnce() -> Matrix) -> Matrix {
    if variance.spaces().contains(&Some(Space::Own)) { inverse() } else { g.clone() }
}

/// A point with its last coordinate, one.
fn homogeneous(point: &Matrix) -> Matrix {
    Matrix::column_of([point.entries.as_slice(), &[Value::ONE]].concat())
}

/// The first coordinates of a column.
fn affine(column: &Matrix, rows: usize) -> Matrix {
    Matrix::column_of(column.entries[..rows].to_vec())
}
