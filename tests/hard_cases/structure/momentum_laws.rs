//! P2 for tops and free bodies: the momenta of a declared `l_d` are its derivatives, hang together as the theory says,
//! and the step in stages says the same. `tests/systems/momenta.rs` has the other declarations.
//!
//! `(μ, w)` moves on a coadjoint orbit of the semidirect product, so `|w|²` and `μ·w` are exact.

use checks::random::Random;
use checks::structure::momenta::assert_momenta;
use checks::structure::stages::{assert_stages, assert_step};
use declarations::{FreeBody, FullTop, HeavyTop};

const STEPS: [f64; 3] = [1e-3, 0.1, 0.3];

fn full() -> FullTop {
    FullTop::in_axes(&HeavyTop::asymmetric(), Random::new(22).rotation().as_matrix())
}

#[test]
fn p2_momenta_are_derivatives_and_the_left_is_the_right_one_moved() {
    assert_momenta(&HeavyTop::thesis(), 21);
    assert_momenta(&HeavyTop::asymmetric(), 23);
    assert_momenta(&full(), 24);
    assert_momenta(&FreeBody::with_moments([2.0, 3.0, 4.5]), 26);
}

#[test]
fn p2_the_staged_newton_system_is_the_momentum_equation() {
    assert_stages(&HeavyTop::asymmetric(), 27);
    assert_stages(&full(), 28);
    assert_stages(&FreeBody::with_moments([2.0, 3.0, 4.5]), 29);
}

#[test]
fn p2_a_step_is_the_discrete_lie_poisson_map() {
    assert_step(&HeavyTop::asymmetric(), &STEPS, 30);
    assert_step(&full(), &STEPS, 31);
    assert_step(&FreeBody::with_moments([2.0, 3.0, 4.5]), &STEPS, 32);
}
