//! The invariants of every declared system: the momenta along the symmetries of the advected parameters, the
//! parameters' orbit, and, if the body has a symmetry too, the momentum along that.

use checks::structure::System;
use checks::structure::numbers::numbers;
use checks::structure::symmetry::{drift, symmetries};
use liestep::motion::DiscreteLiePoisson;
use liestep::prelude::*;
use nalgebra::{Matrix2, Matrix3, Matrix4, Point3, Vector3, Vector4};

use checks::samples::{self, Start};

const STEP: f64 = 0.02;
const STEPS: u32 = 2000;

/// The bound is some thousands of roundings, which accumulate like a random walk.
const ROUNDING: f64 = 1e-12;

/// Checks that the invariants of a system are conserved; `count` is the dimension of the symmetry of the spatial
/// parameters.
fn assert_conserved<L: System + Clone>(system: &L, start: Start<L::Group>, count: usize) {
    assert_eq!(symmetries(system).len(), count);
    let flow = DiscreteLiePoisson::new(system.clone(), STEP).unwrap();
    let (momentum, parameters) = drift(&flow, start, STEPS);
    println!("momentum {momentum:.1e}, parameters {parameters:.1e}");
    assert!(momentum < ROUNDING, "momentum: {momentum:e}");
    assert!(parameters < ROUNDING, "parameters: {parameters:e}");
}

macro_rules! conserved {
    ($($symmetry:literal: $($system:ident $start:ident)+ = $count:literal;)+) => {$($(
        #[doc = $symmetry]
        #[test]
        fn $system() {
            assert_conserved(&samples::$system(), samples::$start(), $count);
        }
    )+)+};
}

conserved! {
    "The turns about one vector.": heavy_top on_so3 full_top on_so3 log_trace_top on_so3 cayley_top on_so3 log_top on_so3
        fourth_order_top on_so3 sixth_order_top on_so3 satellite on_so3 spring on_so3 sliding_top on_so3 = 1;
    "All turns.": free_body on_so3 fourth_order_body on_so3 = 3;
    "The turns about the centre: the angular momentum of orbit and spin together.": orbiting_body in_orbit = 3;
    "Horizontal translations and the turns about a vertical.": underwater_body on_se3 = 3;
    "The turns about the anchor.": tethered_plate on_se2 = 1;
    "The rotations of space, which keep its metric.": elastic_flow on_sl2 = 1;
}

/// The magnet has no symmetry in general, and one under turns about the field if the field's gradient is invariant
/// under these, too.
#[test]
fn magnet() {
    let mut magnet = samples::magnet();
    assert_conserved(&magnet, samples::on_so3(), 0);
    magnet.field = Vector3::z();
    magnet.gradient.0 = Matrix3::from_diagonal(&Vector3::new(0.8, 0.8, -1.6));
    assert_conserved(&magnet, samples::on_so3(), 1);
}

/// If the body is symmetric about an axis, the component of its momentum along that is constant.
fn assert_component<L: System>(system: L, (attitude, velocity): Start<L::Group>, component: usize) {
    let stepper = Stepper::new(system, STEP).unwrap();
    let mut state = stepper.start(attitude, velocity).unwrap();
    let start = numbers(&state.momentum());
    let mut others = 0.0_f64;
    for _ in 0..STEPS {
        stepper.step(&mut state).unwrap();
        let change = numbers(&state.momentum()) - &start;
        assert!(change[component].abs() < ROUNDING * start.norm(), "{:e}", change[component]);
        others = others.max(change.norm());
    }
    assert!(others > 0.1 * start.norm(), "something has moved");
}

#[test]
fn bodies_with_an_axis() {
    let symmetric = NonstandardInertia::from_diagonal(Vector3::new(1.0, 1.0, 0.5)).unwrap();
    let mut top = samples::heavy_top();
    (top.J_d, top.rho) =
        (DiagonalNonstandardInertia::from_diagonal(Vector3::new(1.0, 1.0, 0.5)).unwrap(), Vector3::z() * 0.4);
    assert_component(top, samples::on_so3(), 2);
    let mut top = samples::cayley_top();
    (top.J, top.rho) = (Inertia::from_principal_moments(Vector3::new(2.0, 2.0, 1.0)).unwrap(), Vector3::z() * 0.4);
    assert_component(top, samples::on_so3(), 2);
    let mut top = samples::log_trace_top();
    top.rho = Vector3::z();
    assert_component(top, samples::on_so3(), 2);
    let mut satellite = samples::satellite();
    (satellite.J_d, satellite.tip) = (symmetric, Vector3::z());
    assert_component(satellite, samples::on_so3(), 2);
    let mut body = samples::spring();
    (body.J_d, body.rho) = (symmetric, Vector3::z());
    assert_component(body, samples::on_so3(), 2);
    let mut magnet = samples::magnet();
    (magnet.J_d, magnet.m, magnet.Q) = (symmetric, Vector3::z(), Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -2.0)));
    assert_component(magnet, samples::on_so3(), 2);
    let mut body = samples::underwater_body();
    (body.J, body.M) = (
        Matrix4::from_diagonal(&Vector4::new(0.9, 0.9, 0.5, 0.0)),
        Matrix4::from_diagonal(&Vector4::new(1.0, 1.0, 3.0, 0.0)),
    );
    (body.origin, body.weight) = (Point3::new(0.0, 0.0, -0.2), Vector4::new(0.0, 0.0, -1.5, 0.6));
    assert_component(body, samples::on_se3(), 2);
    let mut flow = samples::elastic_flow();
    flow.M = Matrix2::identity();
    assert_component(flow, samples::on_sl2(), 2);
}
