//! The methods of high order in plain arithmetic of 32 digits.
//!
//! In doubles the error of a method of order 10 and more reaches rounding before its leading term dominates. Here the
//! same maps are written down from their equations in unevaluated sums of two doubles, which have sixteen more digits,
//! and each is compared with the library's at steps for which doubles suffice. So the measured order is that of the
//! library's map, without any of its code.
//!
//! The library itself can't run on such a scalar in these tests: nalgebra's real fields require unsafe functions, and
//! there is no unsafe code here.

pub(crate) mod coefficients;
pub(crate) mod collocation;
mod cotangent;
pub(crate) mod free_body;
pub(crate) mod heavy_top;
pub(crate) mod motion;
pub(crate) mod poisson;

use core::ops::Sub;

use checks::order::{End, error};
use nalgebra::{Matrix3, Vector3};
use num_traits::Zero;
pub(crate) use workbench::double_double::{DoubleDouble, long};
use workbench::measure::order;

use motion::Motion;

/// A vector of long numbers.
pub(crate) type Vector = Vector3<DoubleDouble>;
/// A matrix of long numbers.
pub(crate) type Matrix = Matrix3<DoubleDouble>;

/// The matrix `v̂`; nalgebra's is for fields only.
fn hat<T: nalgebra::Scalar + Copy + Zero + Sub<Output = T>>(v: &Vector3<T>) -> Matrix3<T> {
    Matrix3::from_fn(|i, j| match (i + 3 - j) % 3 {
        0 => T::zero(),
        1 => v[3 - i - j],
        _ => T::zero() - v[3 - i - j],
    })
}

/// The attitude and the body velocity.
pub(crate) type LongEnd = (Matrix, Vector);

/// The plateau is above the rounding of some ten thousand stages.
const PLATEAU: f64 = 1e-24;

/// Checks the order as [`checks::order::assert_order`] does. It also checks that after `compared` steps, for which the
/// method's error exceeds rounding, the library has the same end.
pub(crate) fn assert_order(
    (name, expected): (&str, u32),
    (motion, t): (&str, f64),
    (compared, counts): (u32, &[u32]),
    run: impl Fn(&Motion, DoubleDouble, u32) -> LongEnd,
    library: impl Fn(&declarations::Motion, f64, u32) -> End,
) {
    let read = Motion::read(motion);
    let after = |steps: u32| {
        let (attitude, velocity) = run(&read, long(t) / long(steps.into()), steps);
        (read.error(t, &attitude, &velocity), attitude, velocity)
    };
    let errors: Vec<_> = counts.iter().map(|&steps| (t / f64::from(steps), after(steps).0)).collect();
    let order = order(&errors, PLATEAU);
    let (missed, attitude, velocity) = after(compared);
    let found = library(&declarations::Motion::read(motion), t / f64::from(compared), compared);
    let apart = error(&found, &(attitude.map(DoubleDouble::rounded), velocity.map(DoubleDouble::rounded)));
    let listed: Vec<_> = errors.iter().map(|(_, error)| format!("{error:.1e}")).collect();
    println!("{name}, {motion}: order {order:.3}, errors {}", listed.join(" "));
    println!("    the library: {apart:.1e} apart where the error is {missed:.1e}");
    assert!((order - f64::from(expected)).abs() < 0.1, "{name}, {motion}: order {order}, errors {errors:?}");
    assert!(apart < 0.2 * missed, "{name}, {motion}: the library is {apart:e} apart, the error {missed:e}");
}

/// The digits of some numbers from other sources.
#[test]
fn numbers_have_32_digits() {
    let number = DoubleDouble::parse;
    for (found, expected) in [
        (number("2").sqrt(), "1.41421356237309504880168872420969807857"),
        (number("1") / number("7"), "0.142857142857142857142857142857142857143"),
        (number("-0.1") * number("1e-1"), "-0.01"),
        (number("1.00000000000000000001") - number("1"), "0.00000000000000000001"),
    ] {
        let error = (found - number(expected)).rounded();
        assert!(error.abs() < 1e-31, "{expected}: off by {error:e}");
    }
}
