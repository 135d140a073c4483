//! Declared Lagrangians of higher order: one solve a step, and the claimed order.

use checks::order::{TOPS, assert_own_order};
use declarations::{FourthOrderBody, FourthOrderTop, LogTop, SixthOrderTop, Top as _};

#[test]
fn the_geodesic_kinetic_term_is_of_second_order() {
    for name in &TOPS[..3] {
        assert_own_order(name, 2, (1.0, 1.0 / 40.0), |motion| LogTop::of(&motion.top));
    }
}

#[test]
fn the_fourth_order_top_is_of_fourth_order() {
    for name in &TOPS[..3] {
        assert_own_order(name, 4, (1.0, 1.0 / 40.0), |motion| FourthOrderTop::of(&motion.top));
    }
}

#[test]
fn the_sixth_order_top_is_of_sixth_order() {
    for name in &TOPS[..3] {
        assert_own_order(name, 6, (1.0, 1.0 / 20.0), |motion| SixthOrderTop::of(&motion.top));
    }
}

#[test]
fn the_fourth_order_body_is_of_fourth_order() {
    for name in ["free symmetric", "free flip"] {
        assert_own_order(name, 4, (10.0, 1.0 / 20.0), |motion| FourthOrderBody { J: motion.top.ordinary_inertia() });
    }
}
