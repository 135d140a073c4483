//! Declared Lagrangians of higher order: one solve a step, and the order that is claimed for them.

use crate::common::measure::{four_halvings, order, relative, steps_in};
use crate::common::reference::Motion;
use crate::common::tops::inertia;
use liestep::{LieGroup as _, Regular, SO3, Stepper};

use crate::declarations::{FourthOrderBody, FourthOrderTop, LogTop, SixthOrderTop};

/// Above what some hundred steps lose to rounding.
const PLATEAU: f64 = 2e-14;
const TOPS: [&str; 3] = ["thesis_looping_A_Jd221", "thesis_cuspidal_B_J221", "thesis_unidirectional_A_Jd221"];

/// Errors of attitude and body velocity together, relative to the sizes of both.
fn error<L: Regular<Scalar = f64, Group = SO3>>(lagrangian: L, motion: &Motion, t: f64, h: f64) -> f64 {
    let stepper = Stepper::new(lagrangian, h).unwrap();
    let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
    for _ in 0..steps_in(t, h) {
        stepper.step(&mut state).unwrap();
    }
    let (attitude, velocity) = motion.at(t);
    relative(&state.attitude().matrix(), &attitude).hypot(relative(&stepper.velocity(&state), &velocity))
}

fn assert_order<L: Regular<Scalar = f64, Group = SO3>>(
    names: &[&str],
    expected: f64,
    (t, coarsest): (f64, f64),
    lagrangian: impl Fn(&Motion) -> L,
) {
    for name in names {
        let motion = Motion::read(name);
        let errors = four_halvings(coarsest).map(|h| (h, error(lagrangian(&motion), &motion, t, h)));
        let order = order(&errors, PLATEAU);
        println!("{name}: order {order:.3}, errors {:.2e} to {:.2e}", errors[0].1, errors[4].1);
        assert!((order - expected).abs() < 0.1, "order {order}, errors {errors:?}");
    }
}

#[test]
fn the_geodesic_kinetic_term_is_of_second_order() {
    assert_order(&TOPS, 2.0, (1.0, 1.0 / 40.0), |motion| motion.top.declared_as::<LogTop>());
}

#[test]
fn the_fourth_order_top_is_of_fourth_order() {
    assert_order(&TOPS, 4.0, (1.0, 1.0 / 40.0), |motion| motion.top.declared_as::<FourthOrderTop>());
}

#[test]
fn the_sixth_order_top_is_of_sixth_order() {
    assert_order(&TOPS, 6.0, (1.0, 1.0 / 20.0), |motion| motion.top.declared_as::<SixthOrderTop>());
}

#[test]
fn the_fourth_order_body_is_of_fourth_order() {
    let bodies = ["free_axisymmetric_Jd221", "free_asymmetric_J123_intermediate"];
    assert_order(&bodies, 4.0, (10.0, 1.0 / 20.0), |motion| FourthOrderBody { J: inertia(&motion.top) });
}
