//! The methods of high order once more, in plain arithmetic of 32 digits.
//!
//! In a double the error of a method of order 10 and more falls by its first power alone only where rounding already
//! shows. Here the same maps are written down from their equations in unevaluated sums of two doubles, where there are
//! sixteen digits more, and each is compared with the library's at the steps that a double has the digits for. So what
//! is measured here is the order of what the library does, and none of its code is in it.
//!
//! The library itself can't run on such a scalar in these tests: nalgebra's real fields have unsafe functions to be
//! implemented, and there is no unsafe code here.

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

/// Three of them.
pub(crate) type Vector = Vector3<DoubleDouble>;
/// Three by three of them.
pub(crate) type Matrix = Matrix3<DoubleDouble>;

/// `v̂`, which nalgebra has for fields only.
fn hat<T: nalgebra::Scalar + Copy + Zero + Sub<Output = T>>(v: &Vector3<T>) -> Matrix3<T> {
    Matrix3::from_fn(|i, j| match (i + 3 - j) % 3 {
        0 => T::zero(),
        1 => v[3 - i - j],
        _ => T::zero() - v[3 - i - j],
    })
}

/// Attitude and body velocity.
pub(crate) type LongEnd = (Matrix, Vector);

/// Above what some ten thousand stages lose to rounding here.
const PLATEAU: f64 = 1e-24;

/// As [`checks::order::assert_order`]; and after fewer steps, `compared`, so few that what they miss is more than
/// rounding, the library has come to the same place.
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

/// The digits of a few numbers that others have computed.
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
