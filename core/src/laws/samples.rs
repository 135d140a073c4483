//! Samples of groups at which the laws are tested, and comparisons of two sides.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::{Add, Mul, Sub};

use nalgebra::{SMatrix, SVector};

roots!();

use crate::groups::{LieGroup, exponential};
use crate::numbers::Entries;

/// A group of `N` × `N` matrices of dimension `D` over `f64`.
pub trait MatrixLieGroup<const N: usize, const D: usize>:
    LieGroup<Scalar = f64, Vector = SVector<f64, D>, Matrix = SMatrix<f64, N, N>>
{
}

impl<G, const N: usize, const D: usize> MatrixLieGroup<N, D> for G where
    G: LieGroup<Scalar = f64, Vector = SVector<f64, D>, Matrix = SMatrix<f64, N, N>>
{
}

/// A stream of pseudo-random numbers, `SplitMix64` of Steele, Lea and Flood (2014).
#[derive(Debug)]
pub struct Random(u64);

impl Random {
    /// The stream of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A uniform number in `[−1, 1)`.
    #[allow(clippy::cast_precision_loss)] // 53 bits are left
    pub fn signed(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A number of the normal distribution with the mean 0 and the deviation 1.
    pub fn normal(&mut self) -> f64 {
        let radius = 0.5 * (1.0 + self.signed());
        normal([radius, 0.5 * self.signed()])
    }

    /// Entries uniform in `[−1, 1)`.
    pub fn sample<A: Entries<f64>>(&mut self) -> A {
        A::from_entries(&mut || self.signed())
    }

    /// Coordinates of the identity, of elements next to it, and random ones of the size of one.
    pub fn coordinates<const D: usize>(&mut self) -> Vec<SVector<f64, D>> {
        let mut coordinates = vec![SVector::zeros()];
        for _ in 0..20 {
            coordinates.push(self.sample::<SVector<f64, D>>() * 1e-8);
            coordinates.push(self.sample());
        }
        coordinates
    }

    /// A product of two exponentials, which lies on none of the one-parameter subgroups sampled elsewhere.
    pub fn element<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>(&mut self) -> G {
        let (first, second) = (self.sample(), self.sample());
        along::<G, N, D>(&first, 1.0).compose(&along::<G, N, D>(&second, 1.0))
    }

    /// The identity, elements next to it, and elements anywhere.
    pub fn elements<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>(&mut self) -> Vec<G> {
        let mut elements: Vec<G> = self.coordinates().iter().map(|xi| along::<G, N, D>(xi, 1.0)).collect();
        for _ in 0..20 {
            elements.push(self.element::<G, N, D>());
        }
        elements
    }
}

/// A number of the normal distribution with the mean 0 and the deviation 1, from two that are uniform on an interval of
/// length one, by the transform of Box and Muller.
///
/// The first lies in `[0, 1)`: at 1 the result is infinite, and beyond it is NaN. The second is an angle in turns,
/// modulo whole turns, so that `[−½, ½)` does as well as `[0, 1)`.
#[must_use]
pub fn normal([radius, angle]: [f64; 2]) -> f64 {
    // The radius is below one, so that the logarithm is finite.
    (-2.0 * (1.0 - radius).ln()).sqrt() * (core::f64::consts::TAU * angle).cos()
}

/// `exp(t ξ̂)`, computed from the group's basis alone.
#[must_use]
pub fn along<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>(xi: &SVector<f64, D>, t: f64) -> G {
    G::from_increment(&exponential(&(G::hat(xi) * t)).0)
}

/// `F⁻¹` by elimination, independent of the group's own inverse.
#[must_use]
pub fn eliminated_inverse<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>(f: &G) -> SMatrix<f64, N, N> {
    crate::groups::inverse(&f.matrix())
}

/// The condition number `‖F‖ ‖F⁻¹‖`, by which a conjugation with `F` magnifies rounding.
#[must_use]
pub fn condition<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>(f: &G) -> f64 {
    f.matrix().norm() * eliminated_inverse(f).norm()
}

/// The derivative `f'(0)`, from six values at a spacing of 10⁻³.
///
/// The remainder is of the order of 10⁻¹⁸ by the seventh derivative, rounding of 10⁻¹³ by the size of `f`.
pub fn derivative<V: Add<Output = V> + Sub<Output = V> + Mul<f64, Output = V>>(f: impl Fn(f64) -> V) -> V {
    let d = 1e-3;
    let odd = |k: f64| f(k * d) - f(-k * d);
    (odd(1.0) * 45.0 - odd(2.0) * 9.0 + odd(3.0)) * (1.0 / (60.0 * d))
}

/// Rounding of some products of small matrices, for a scale of one.
pub const ROUNDING: f64 = 2e-14;
/// Error of [`derivative`], for a scale of one.
pub const DIFFERENCE: f64 = 1e-11;
/// Error of a [`derivative`] of a [`derivative`], for a scale of one.
pub const NESTED_DIFFERENCE: f64 = 1e-8;

/// Asserts `‖a − b‖ ≤ allowed`; a NaN fails.
///
/// # Panics
///
/// If the inequality doesn't hold.
#[track_caller]
pub fn assert_close<const R: usize, const C: usize>(
    a: &SMatrix<f64, R, C>,
    b: &SMatrix<f64, R, C>,
    allowed: f64,
    law: &str,
) {
    assert_small((a - b).norm(), allowed, law);
}

/// Asserts `size ≤ allowed`; a NaN fails.
///
/// # Panics
///
/// If the inequality doesn't hold.
#[track_caller]
pub fn assert_small(size: f64, allowed: f64, law: &str) {
    assert!(size <= allowed, "{law}: off by {size:e}, allowed are {allowed:e}");
}
