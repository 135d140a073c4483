//! The identity matrix of any size, where a declaration has matrices of several.

use core::ops::{Add, Mul, Sub};

use super::Real;
use nalgebra::SMatrix;

/// The identity matrix, with as many rows as the matrix it is added to or multiplied by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identity;

impl<T: Real, const N: usize> Add<Identity> for SMatrix<T, N, N> {
    type Output = Self;

    fn add(self, _: Identity) -> Self {
        self + Self::identity()
    }
}

impl<T: Real, const N: usize> Sub<Identity> for SMatrix<T, N, N> {
    type Output = Self;

    fn sub(self, _: Identity) -> Self {
        self - Self::identity()
    }
}

impl<T: Real, const R: usize, const C: usize> Mul<Identity> for SMatrix<T, R, C> {
    type Output = Self;

    fn mul(self, _: Identity) -> Self {
        self
    }
}

impl<T: Real, const N: usize> Add<SMatrix<T, N, N>> for Identity {
    type Output = SMatrix<T, N, N>;

    fn add(self, matrix: SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        matrix + self
    }
}

impl<T: Real, const N: usize> Sub<SMatrix<T, N, N>> for Identity {
    type Output = SMatrix<T, N, N>;

    fn sub(self, matrix: SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        SMatrix::identity() - matrix
    }
}

impl<T: Real, const R: usize, const C: usize> Mul<SMatrix<T, R, C>> for Identity {
    type Output = SMatrix<T, R, C>;

    fn mul(self, matrix: SMatrix<T, R, C>) -> SMatrix<T, R, C> {
        matrix
    }
}
