//! Four component vectors side by side, so that one vector instruction acts on all of them.

use core::ops::{Add, Sub};

use nalgebra::SMatrix;

use super::entries::Entries;
use super::scalar::Real;

/// Four vectors with `D` components, stored component by component.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct FourVectors<T, const D: usize>(pub(super) [[T; 4]; D]);

impl<T: Real, const D: usize> FourVectors<T, D> {
    /// Each vector mapped by the matrix.
    #[hot]
    pub(super) fn mapped(&self, matrix: &SMatrix<T, D, D>) -> Self {
        let mut mapped = [[T::zero(); 4]; D];
        for (i, sums) in mapped.iter_mut().enumerate() {
            for (k, row) in self.0.iter().enumerate() {
                let factor = matrix[(i, k)];
                for (sum, entry) in sums.iter_mut().zip(row) {
                    let product = factor * *entry;
                    *sum = if k == 0 { product } else { *sum + product };
                }
            }
        }
        Self(mapped)
    }
}

operation!([T: Real, const D: usize] FourVectors<T, D>, Add add |a, b| a.zip(&b, &mut |a, b| a + b));
operation!([T: Real, const D: usize] FourVectors<T, D>, Sub sub |a, b| a.zip(&b, &mut |a, b| a - b));

#[hot]
impl<T: Real, const D: usize> Entries<T> for FourVectors<T, D> {
    fn from_entries(next: &mut impl FnMut() -> T) -> Self {
        Self(core::array::from_fn(|_| core::array::from_fn(|_| next())))
    }

    fn each(&self, visit: &mut impl FnMut(T)) {
        self.0.as_flattened().iter().for_each(|entry| visit(*entry));
    }

    fn zip(&self, other: &Self, combine: &mut impl FnMut(T, T) -> T) -> Self {
        let mut combined = *self;
        for (entry, other) in combined.0.as_flattened_mut().iter_mut().zip(other.0.as_flattened()) {
            *entry = combine(*entry, *other);
        }
        combined
    }
}
