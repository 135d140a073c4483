//! The continuous limit of every declared system, see [`checks::limit`].

use checks::limit::assert_limit;
use checks::samples::{self, every_system};
use liestep::effects::{RigidBody, Rotor};

every_system!(assert_limit);

/// The momentum isn't zero at rest.
#[test]
fn body_with_a_rotor() {
    let J_d = samples::free_body().J_d;
    assert_limit(&(RigidBody { J_d } + Rotor { spin: nalgebra::Vector3::new(0.4, -1.0, 2.0) }), "rotor");
}
