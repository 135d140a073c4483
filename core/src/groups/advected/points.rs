//! Points as advected parameters of a group of affine maps.
//!
//! The group's matrices act on homogeneous coordinates `(p, 1)`, and their last row is that of the identity. The last
//! coordinate isn't stored: the type implies that it is one.

use nalgebra::{Point, SMatrix, SVector};

use super::Advected;
use crate::groups::LieGroup;
use crate::groups::affine::times;
use crate::numbers::{Entries, Real};

/// The homogeneous coordinates `(p, 1)`.
#[hot]
pub(crate) fn homogeneous<T: Real, const N: usize, const M: usize>(point: &Point<T, N>) -> SVector<T, M> {
    const { assert!(M == N + 1) };
    SVector::from_fn(|row, _| if row < N { point[row] } else { T::one() })
}

impl<T: Real, const N: usize> Entries<T> for Point<T, N> {
    fn from_entries(next: &mut impl FnMut() -> T) -> Self {
        Self::from(SVector::from_entries(next))
    }

    fn each(&self, visit: &mut impl FnMut(T)) {
        self.coords.each(visit);
    }

    fn zip(&self, other: &Self, combine: &mut impl FnMut(T, T) -> T) -> Self {
        Self::from(self.coords.zip(&other.coords, combine))
    }
}

macro_rules! points {
    ($($dimension:literal in $size:literal),+) => {
        $(impl<G, T: Real> Advected<G> for Point<T, $dimension>
        where
            G: LieGroup<Scalar = T, Matrix = SMatrix<T, $size, $size>>,
        {
            fn seen_from(&self, attitude: &G) -> Self {
                let moved: SVector<T, $size> = attitude.inverse().matrix() * homogeneous(self);
                Self::from(moved.fixed_rows::<$dimension>(0).into_owned())
            }

            #[hot]
            fn change(&self, increment: &SMatrix<T, $size, $size>) -> Self {
                // The change is F⁻¹(p, 1) − (p, 1) = −F⁻¹D(p, 1).
                let inverse = G::from_increment(increment).inverse().matrix();
                let mut moved = SVector::<T, $size>::zeros();
                for row in 0..G::ROWS.min($size) {
                    // The last coordinate is one.
                    let sum = (1..$dimension).fold(increment[(row, 0)] * self[0], |sum, column| sum + increment[(row, column)] * self[column]);
                    moved[row] = sum + increment[(row, $dimension)];
                }
                let change = -times(&inverse, &moved, G::ROWS);
                Self::from(change.fixed_rows::<$dimension>(0).into_owned())
            }

            /// The rate `−ξ̂(p, 1)`.
            fn rate(&self, velocity: &SMatrix<T, $size, $size>) -> Self {
                let rate: SVector<T, $size> = -(velocity * homogeneous(self));
                Self::from(rate.fixed_rows::<$dimension>(0).into_owned())
            }

            fn seen_through(&self, _: &SMatrix<T, $size, $size>, inverse: &SMatrix<T, $size, $size>) -> Self {
                let moved: SVector<T, $size> = inverse * homogeneous(self);
                Self::from(moved.fixed_rows::<$dimension>(0).into_owned())
            }
        })+
    };
}

points!(1 in 2, 2 in 3, 3 in 4);
