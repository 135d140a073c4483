//! The scalars that the steppers run on.

use nalgebra::SimdBool as _;
use nalgebra::SimdRealField;

/// A real scalar: `f64`, `f32`, a dual number, or several of them in SIMD lanes.
///
/// Everything that nalgebra accepts as a (lane-wise) real field is a `Real`; there is nothing to implement.
pub trait Real: SimdRealField + Copy {}

impl<T: SimdRealField + Copy> Real for T {}

/// The scalar nearest to `value`.
#[inline(always)]
#[must_use]
pub fn real<T: Real>(value: f64) -> T {
    nalgebra::convert(value)
}

/// Whether every lane is finite: zero times an infinity or a NaN is NaN.
#[inline(always)]
pub(crate) fn is_finite<T: Real>(value: T) -> bool {
    (value * T::zero()).simd_eq(T::zero()).all()
}

/// The value as `f64` for a message; NaN where the lanes differ.
pub(crate) fn reported<T: Real>(value: T) -> f64 {
    nalgebra::try_convert(value).unwrap_or(f64::NAN)
}
