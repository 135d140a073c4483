//! Matrices of three rows and columns, turns and shifts as registers load them.

use nalgebra::{Matrix3, Vector6};

use crate::numbers::{Columns, Register};

/// A matrix of three rows by columns.
pub(super) type Square = [[f64; 4]; 3];

pub(super) const ZERO: Square = [[0.0; 4]; 3];

pub(super) fn matrix(square: &Square) -> Matrix3<f64> {
    Matrix3::from_fn(|row, column| square[column][row])
}

#[hot]
pub(super) fn loaded<R: Register>(zero: R, square: &Square) -> Columns<R> {
    Columns([zero.of(square[0]), zero.of(square[1]), zero.of(square[2])])
}

/// The columns of a matrix; their fourth entries are such that registers load and permute neighbours.
#[hot]
pub(super) fn stored<R: Register>(zero: R, m: &Matrix3<f64>) -> Columns<R> {
    let [x, y, z] = &m.data.0;
    Columns([zero.of([x[0], x[1], x[2], y[0]]), zero.of([y[0], y[1], y[2], z[0]]), zero.of([z[0], z[1], z[2], y[2]])])
}

/// The entries of a matrix.
#[hot]
pub(super) fn three<R: Register>(columns: Columns<R>) -> [[f64; 3]; 3] {
    let [[a, b, c, _], [d, e, f, _], [g, h, i, _]] = columns.entries();
    [[a, b, c], [d, e, f], [g, h, i]]
}

/// The turn of a body. The fourth entry, which has no meaning, is such that registers load and permute neighbours.
#[hot]
pub(super) fn turn_of<R: Register>(zero: R, of: &Vector6<f64>) -> R {
    zero.of([of[0], of[1], of[2], of[3]])
}

/// The shift of a body.
#[hot]
pub(super) fn shift_of<R: Register>(zero: R, of: &Vector6<f64>) -> R {
    zero.of([of[3], of[4], of[5], of[2]])
}

/// Writes the turn and the shift of a body.
#[hot]
pub(super) fn write<R: Register>(to: &mut Vector6<f64>, [turn, shift]: [R; 2]) {
    let [a, b, c, _] = shift.entries();
    to.as_mut_slice()[..4].copy_from_slice(&turn.entries());
    to.as_mut_slice()[3..].copy_from_slice(&[a, b, c]);
}
