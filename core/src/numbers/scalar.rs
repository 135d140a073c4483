//! The scalars that the steppers run on.

use nalgebra::{RealField, SimdBool as _, SimdRealField, SimdValue};

roots!();

/// A real scalar: `f64`, `f32`, a dual number, or several of them in SIMD lanes.
///
/// Everything that nalgebra accepts as a real field is a `Real`, and lanes of these; there is nothing to implement.
///
/// # Dual numbers
///
/// A dual number carries derivatives with respect to parameters or initial values through every step, so that the
/// sensitivity of a whole trajectory is known at its end. Newton's iteration stops by the values. Each iteration
/// multiplies the error of the derivatives by that of the values before it, so they converge to rounding, too.
///
/// # Lanes
///
/// A scalar of several lanes, such as `AutoF64x8` of the crate simba, makes one stepper move as many scenes at once.
/// [`Lanes`](crate::numbers::Lanes) gathers scenes, steppers and states of single bodies or systems and separates them,
/// and a [`Batch`](crate::motion::Batch) does it for a run in which each body may stop by itself:
///
/// - Each lane moves, bit for bit, as a stepper of its own would; Newton's iteration goes on until all have converged.
///   Exceptions are logarithms and exponentials in a Lagrangian, which round by the lane that is farthest from the
///   identity, and sines and cosines, which differ by roundings if the lanes compute them in their own way.
/// - Every lane's step is solved, or the whole step is an error and the state of all lanes is unchanged. An error's
///   numbers are NaN if the lanes differ. All steps `h` are zero, or none is. In a `Batch` only the failing lane stops.
/// - Coordinates are Cayley's. The group is [`SO3`](crate::groups::SO3), one of translations, a product of these or an
///   array of them, whose steps are vector instructions; or another [`MatrixGroup`](crate::groups::MatrixGroup), whose
///   inverses and relations are computed lane by lane, as pivots differ from lane to lane.
///
/// [`Stepper::step`](crate::motion::Stepper::step), like every method's step, detects the vector instructions of the
/// machine and uses them, up to [four `f64`](crate::numbers::Vectors::Four) a register: a program needn't be compiled
/// for one machine. That holds for lanes which are arrays, such as `AutoF64x8`. The `Wide` types of simba use the
/// instructions that the program is compiled for, two `f64` a register on x86-64 by default.
/// `cargo bench -p liestep-lanes --bench lanes` and `--bench vectors` measure both.
///
/// With `-C target-cpu=native` on a machine with AVX-512, lanes that are arrays are two to three times slower, probably
/// as the compiler then fills registers of eight `f64` from parts of different arrays. `-C target-feature=-avx512f`
/// beside it undoes that; collocation detects AVX-512 by itself all the same.
pub trait Real: SimdRealField<Element: RealField + Copy> + Copy {}

impl<T: SimdRealField<Element: RealField + Copy> + Copy> Real for T {}

/// One truth value for each lane of a scalar; `bool` for a scalar of one lane.
pub type Mask<T> = <T as SimdValue>::SimdBool;

/// The empty mask.
#[hot]
pub(crate) fn nowhere<T: Real>() -> Mask<T> {
    T::zero().simd_ne(T::zero())
}

/// The scalar nearest to `value`.
#[hot]
#[must_use]
pub fn real<T: Real>(value: f64) -> T {
    nalgebra::convert(value)
}

/// A small whole number as a scalar.
#[allow(clippy::cast_precision_loss)] // far below the integers that a float represents
pub(crate) fn count<T: Real>(number: usize) -> T {
    real(number as f64)
}

/// The whole number equal to a scalar, if there is one below a million.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked
pub(crate) fn counted<T: Real>(number: T) -> Option<usize> {
    let number = reported(number);
    ((0.0..1e6).contains(&number) && number.fract() == 0.0).then_some(number as usize)
}

/// Whether every lane is finite: zero times an infinity or a NaN is NaN.
#[hot]
pub(crate) fn is_finite<T: Real>(value: T) -> bool {
    (value * T::zero()).simd_eq(T::zero()).all()
}

/// The value as `f64` for a message; NaN where the lanes differ.
pub(crate) fn reported<T: Real>(value: T) -> f64 {
    nalgebra::try_convert(value).unwrap_or(f64::NAN)
}

/// The largest of the lanes, for a message.
pub(crate) fn largest_lane<T: Real>(value: T) -> f64 {
    (0..T::LANES).map(|lane| reported(T::splat(value.extract(lane)))).fold(0.0, f64::max)
}
