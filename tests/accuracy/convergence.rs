//! Measured orders.

use declarations::Motion;
use liestep::SO3;
use liestep::accuracy::Refinement;
use nalgebra::{Matrix3, Vector3};
use workbench::measure::relative;

/// The tops whose equations are nonlinear in every variable: three of the thesis, and one without any symmetry.
pub(crate) const TOPS: [&str; 4] = ["looping A", "cuspidal B", "third A", "chaotic"];

/// Above what some thousand stages lose to rounding in attitude and velocity.
const PLATEAU: f64 = 2e-13;

/// A motion at its end: attitude and body velocity.
pub(crate) type End = (SO3, Vector3<f64>);

/// The error of attitude and body velocity together, relative to the sizes of both.
fn error(end: &End, (attitude, velocity): &(Matrix3<f64>, Vector3<f64>)) -> f64 {
    relative(end.0.as_matrix(), attitude).hypot(relative(&end.1, velocity))
}

/// Asserts the order of a method from its errors at the time `t` after these numbers of steps.
///
/// `run` makes so many steps of the length given and returns where they end.
pub(crate) fn assert_order(
    (name, expected): (&str, u32),
    (motion, t): (&str, f64),
    counts: &[u32],
    run: impl Fn(&Motion, f64, u32) -> End,
) {
    let read = Motion::read(motion);
    let reference = read.at(t);
    let errors = Refinement::of(counts.iter().map(|&steps| {
        let h = t / f64::from(steps);
        (h, error(&run(&read, h, steps), &reference))
    }));
    let order = errors.order_above(PLATEAU).expect(name);
    println!("{name}, {motion}: order {order:.3}\n{errors}");
    assert!((order - f64::from(expected)).abs() < 0.1, "{name}, {motion}: order {order}\n{errors}");
}

/// `count` numbers of steps, each about a `ratio` more than the one before.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small positive numbers
pub(crate) fn counts(first: u32, ratio: f64, count: i32) -> Vec<u32> {
    (0..count).map(|k| (f64::from(first) * ratio.powi(k)).round() as u32).collect()
}
