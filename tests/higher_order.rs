//! Declared Lagrangians of higher order: one solve a step, and the order that is claimed for them.

// The letters of the field.
#![allow(non_snake_case)]
// The declarations are shared with the examples.
#![allow(unreachable_pub)]

mod common;

use common::measure::{four_halvings, order, relative, steps_in};
use common::reference::Motion;
use liestep::{Inertia, LieGroup as _, Regular, SO3, Stepper};

#[path = "../examples/declarations/fourth_order_body.rs"]
mod fourth_order_body;
#[path = "../examples/declarations/fourth_order_top.rs"]
mod fourth_order_top;
#[path = "../examples/declarations/log_top.rs"]
mod log_top;
#[path = "../examples/declarations/sixth_order_top.rs"]
mod sixth_order_top;

use fourth_order_body::FourthOrderBody;
use fourth_order_top::FourthOrderTop;
use log_top::LogTop;
use sixth_order_top::SixthOrderTop;

/// Above what some hundred steps lose to rounding.
const PLATEAU: f64 = 2e-14;
const TOPS: [&str; 3] = ["thesis_looping_A_Jd221", "thesis_cuspidal_B_J221", "thesis_unidirectional_A_Jd221"];

fn inertia(motion: &Motion) -> Inertia {
    Inertia::from_principal_moments(common::tops::moments(&motion.top)).unwrap()
}

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
    name: &str,
    expected: f64,
    (t, coarsest): (f64, f64),
    lagrangian: impl Fn(&Motion) -> L,
) {
    let motion = Motion::read(name);
    let errors = four_halvings(coarsest).map(|h| (h, error(lagrangian(&motion), &motion, t, h)));
    let order = order(&errors, PLATEAU);
    println!("{name}: order {order:.3}, errors {:.2e} to {:.2e}", errors[0].1, errors[4].1);
    assert!((order - expected).abs() < 0.1, "order {order}, errors {errors:?}");
}

#[test]
fn the_geodesic_kinetic_term_is_of_second_order() {
    for name in TOPS {
        assert_order(name, 2.0, (1.0, 1.0 / 40.0), |motion| {
            let top = &motion.top;
            LogTop { J: inertia(motion), weight: top.m * top.g, rho: top.rho, up: top.up }
        });
    }
}

#[test]
fn the_fourth_order_top_is_of_fourth_order() {
    for name in TOPS {
        assert_order(name, 4.0, (1.0, 1.0 / 40.0), |motion| {
            let top = &motion.top;
            FourthOrderTop { J: inertia(motion), weight: top.m * top.g, rho: top.rho, up: top.up }
        });
    }
}

#[test]
fn the_sixth_order_top_is_of_sixth_order() {
    for name in TOPS {
        assert_order(name, 6.0, (1.0, 1.0 / 20.0), |motion| {
            let top = &motion.top;
            SixthOrderTop { J: inertia(motion), weight: top.m * top.g, rho: top.rho, up: top.up }
        });
    }
}

#[test]
fn the_fourth_order_body_is_of_fourth_order() {
    for name in ["free_axisymmetric_Jd221", "free_asymmetric_J123_intermediate"] {
        assert_order(name, 4.0, (10.0, 1.0 / 20.0), |motion| FourthOrderBody { J: inertia(motion) });
    }
}
