//! Orders of declared Lagrangians, measured at motions of `tests/data`.

use declarations::Motion;
use liestep::accuracy::{End, Reference, Refinement, convergence};
use liestep::mechanics::Regular;
use liestep::prelude::*;
use workbench::measure::steps_in;

/// Above what some hundred steps lose to rounding.
const PLATEAU: f64 = 2e-14;

/// The errors at the time `t` with a coarsest step and four halvings of it.
fn errors<L: Regular<Scalar = f64, Group = SO3>>(
    motion: &Motion,
    (t, coarsest): (f64, f64),
    lagrangian: impl Fn() -> L,
) -> Refinement {
    let (attitude, velocity) = motion.at(t);
    let exact = Reference::End(End { attitude: SO3::from_matrix_unchecked(attitude), velocity });
    let family = |h| {
        let stepper = Stepper::new(lagrangian(), h)?;
        let start = stepper.start(motion.attitude, motion.velocity)?;
        Ok((stepper, start))
    };
    let counts = [1, 2, 4, 8, 16].map(|times| times * steps_in(t, coarsest));
    convergence(family, t, counts, exact).expect(motion.name)
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
    let order = errors.order_above(PLATEAU).expect(name);
    println!("{name}: order {order:.3}\n{errors}");
    assert!((order - expected).abs() < 0.1, "{name}: order {order}\n{errors}");
}
