//! The principal axes of a body, the middle moment last.

use nalgebra::{Matrix3, SimdBool as _, Vector3};

use super::super::axes::Axes;
use super::super::quaternion::Quaternion;
use crate::numbers::{Lanes, Real};

/// The orientation of the principal axes in the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Frame<T> {
    /// The principal axes are the body's axes.
    Along(Axes),
    /// The principal axes are the columns of a rotation.
    Turned(Matrix3<T>),
}

impl<T: Real> Frame<T> {
    /// The moments about three right-handed principal axes, with the middle moment last, and these axes.
    pub(super) fn of(inertia: &Matrix3<T>) -> ([T; 3], Self) {
        let diagonal = inertia.diagonal();
        let beside = inertia - Matrix3::from_diagonal(&diagonal);
        if beside.iter().all(|entry| entry.simd_eq(T::zero()).all()) {
            let is_between = |axes: &Axes| {
                let [a, b, c] = axes.of(&diagonal);
                ((c - a) * (c - b)).simd_le(T::zero()).all()
            };
            if let Some(axes) = [Axes::Xyz, Axes::Yzx, Axes::Zxy].into_iter().find(is_between) {
                return (axes.of(&diagonal), Self::Along(axes));
            }
        }
        let (moments, axes) = principal_axes(inertia);
        (moments, Self::Turned(axes))
    }

    /// The index among the body's axes of each principal axis. If they aren't the body's axes, the numbers are in
    /// order.
    pub(super) fn places(&self) -> [usize; 3] {
        match self {
            Self::Along(Axes::Yzx) => [1, 2, 0],
            Self::Along(Axes::Zxy) => [2, 0, 1],
            _ => [0, 1, 2],
        }
    }

    /// The components of a body vector along the principal axes.
    #[hot]
    pub(super) fn within(&self, v: &Vector3<T>) -> [T; 3] {
        match self {
            Self::Along(axes) => axes.of(v),
            Self::Turned(axes) => {
                let along = |k: usize| axes[(0, k)] * v.x + axes[(1, k)] * v.y + axes[(2, k)] * v.z;
                [along(0), along(1), along(2)]
            }
        }
    }

    /// A quaternion in the body's axes, from one in the principal axes.
    #[hot]
    pub(super) fn back(&self, quaternion: Quaternion<T>) -> Quaternion<T> {
        match self {
            Self::Along(axes) => axes.back(quaternion),
            Self::Turned(axes) => {
                let [w, a, b, c] = quaternion;
                let along = |i: usize| axes[(i, 0)] * a + axes[(i, 1)] * b + axes[(i, 2)] * c;
                [w, along(0), along(1), along(2)]
            }
        }
    }
}

/// The lanes of a vector must have frames of one variant.
impl<T: Real> Lanes for Frame<T> {
    type Lane = Frame<T::Element>;

    fn splat(lane: &Self::Lane) -> Self {
        match lane {
            Frame::Along(axes) => Self::Along(*axes),
            Frame::Turned(axes) => Self::Turned(Lanes::splat(axes)),
        }
    }

    fn lane(&self, k: usize) -> Self::Lane {
        match self {
            Self::Along(axes) => Frame::Along(*axes),
            Self::Turned(axes) => Frame::Turned(Lanes::lane(axes, k)),
        }
    }

    fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool {
        match (self, lane) {
            (Self::Along(own), Frame::Along(axes)) => own == axes,
            (Self::Turned(own), Frame::Turned(axes)) => own.set_lane(k, axes),
            _ => false,
        }
    }
}

/// Sweeps of Jacobi's iteration: it converges quadratically, and four or five sweeps leave zero beside the diagonal.
const SWEEPS: usize = 6;

/// The principal moments and axes of a symmetric matrix, the middle moment last and the axes right-handed.
///
/// Jacobi's iteration needs no pivots, so all lanes have the same control flow.
fn principal_axes<T: Real>(inertia: &Matrix3<T>) -> ([T; 3], Matrix3<T>) {
    let (mut a, mut axes) = (*inertia, Matrix3::<T>::identity());
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let (rest, off) = (a[(q, q)] - a[(p, p)], a[(p, q)] + a[(p, q)]);
            // tan θ = ± off/(|rest| + √(rest² + off²)), the smaller of the two rotations.
            let length = rest.simd_abs() + (rest * rest + off * off).simd_sqrt();
            let signed = off.select(rest.simd_ge(T::zero()), -off);
            let tangent = (signed / length).select(length.simd_gt(T::zero()), T::zero());
            let cosine = T::one() / (T::one() + tangent * tangent).simd_sqrt();
            let sine = tangent * cosine;
            for k in 0..3 {
                let (x, y) = (a[(k, p)], a[(k, q)]);
                (a[(k, p)], a[(k, q)]) = (cosine * x - sine * y, sine * x + cosine * y);
            }
            for k in 0..3 {
                let (x, y) = (a[(p, k)], a[(q, k)]);
                (a[(p, k)], a[(q, k)]) = (cosine * x - sine * y, sine * x + cosine * y);
                let (x, y) = (axes[(k, p)], axes[(k, q)]);
                (axes[(k, p)], axes[(k, q)]) = (cosine * x - sine * y, sine * x + cosine * y);
            }
        }
    }
    let mut moments = [a[(0, 0)], a[(1, 1)], a[(2, 2)]];
    // Sorting by size. An axis that is swapped also changes its sign, so that the axes stay right-handed.
    for (p, q) in [(0, 1), (1, 2), (0, 1)] {
        let is_swapped = moments[p].simd_gt(moments[q]);
        let (x, y) = (moments[p], moments[q]);
        (moments[p], moments[q]) = (y.select(is_swapped, x), x.select(is_swapped, y));
        for k in 0..3 {
            let (x, y) = (axes[(k, p)], axes[(k, q)]);
            (axes[(k, p)], axes[(k, q)]) = (y.select(is_swapped, x), (-x).select(is_swapped, y));
        }
    }
    let places = [2, 0, 1];
    (places.map(|k| moments[k]), Matrix3::from_fn(|i, j| axes[(i, places[j])]))
}
