//! Orders of declared Lagrangians, measured at motions of `tests/data`.

use declarations::Motion;
use liestep::mechanics::Regular;
use liestep::prelude::*;
use workbench::measure::{four_halvings, order, relative, steps_in};

/// Above what some hundred steps lose to rounding.
const PLATEAU: f64 = 2e-14;

/// Steps and errors at the time `t` for a coarsest step and four halvings of it: errors of attitude and body velocity
/// together, relative to the sizes of both.
pub fn errors<L: Regular<Scalar = f64, Group = SO3>>(
    motion: &Motion,
    (t, coarsest): (f64, f64),
    lagrangian: impl Fn() -> L,
) -> [(f64, f64); 5] {
    let (attitude, velocity) = motion.at(t);
    four_halvings(coarsest).map(|h| {
        let stepper = Stepper::new(lagrangian(), h).unwrap();
        let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
        for _ in 0..steps_in(t, h) {
            stepper.step(&mut state).unwrap();
        }
        (h, relative(&state.attitude().matrix(), &attitude).hypot(relative(&stepper.velocity(&state), &velocity)))
    })
}

/// Asserts the order from the errors at a time for a coarsest step and its halvings.
pub fn assert_order<L: Regular<Scalar = f64, Group = SO3>>(
    name: &str,
    expected: f64,
    span: (f64, f64),
    lagrangian: impl Fn(&Motion) -> L,
) {
    let motion = Motion::read(name);
    let errors = errors(&motion, span, || lagrangian(&motion));
    let order = order(&errors, PLATEAU);
    println!("{name}: order {order:.3}, errors {:.2e} to {:.2e}", errors[0].1, errors[4].1);
    assert!((order - expected).abs() < 0.1, "{name}: order {order}, errors {errors:?}");
}
