//! Symmetric compositions of the declared systems on other groups than SO(3): the order that their scheme has.

use checks::structure::System;
use liestep::Stepper;
use liestep::groups::LieGroup as _;
use liestep::laws::samples::MatrixLieGroup;
use liestep::methods::CompositionScheme;
use nalgebra::SVector;
use workbench::measure::{four_halvings, order, relative, steps_in};

use crate::continuous::{Body, Phase};
use crate::order::{PLATEAU, kirchhoff, orbit, tether};
use crate::samples::{self, Start};

const TIME: f64 = 1.0;
/// `1/(2 − 2^⅓)` and what three stages leave for the middle one.
const TRIPLE_JUMP: CompositionScheme =
    CompositionScheme::new("triple jump", 2, 4, &[1.351_207_191_959_657_8, -1.702_414_383_919_315_3]);
const SCHEMES: [CompositionScheme; 2] = [CompositionScheme::SUZUKI_4, TRIPLE_JUMP];

/// The errors of place and momentum together over four halvings of a step.
fn errors<L, const N: usize, const D: usize>(
    system: &L,
    scheme: CompositionScheme,
    body: &Body<N, D>,
    (attitude, velocity): Start<L::Group>,
    coarsest: f64,
) -> [(f64, f64); 5]
where
    L: System<Group: MatrixLieGroup<N, D>> + Clone,
{
    let momentum: SVector<f64, D> = body.inertia * velocity;
    let exact: Phase<N, D> = body.solution::<L::Group>((attitude.matrix(), momentum), TIME, 1000);
    four_halvings(coarsest).map(|h| {
        let composed = Stepper::composed(system.clone(), h, scheme).unwrap();
        let mut state = composed.start_with_momentum(attitude, momentum).unwrap();
        for _ in 0..steps_in(TIME, h) {
            composed.step(&mut state).unwrap();
        }
        (h, relative(&state.attitude().matrix(), &exact.0).hypot(relative(&state.momentum(), &exact.1)))
    })
}

fn assert_fourth_order<L, const N: usize, const D: usize>(
    system: &L,
    body: &Body<N, D>,
    start: Start<L::Group>,
    coarsest: f64,
) where
    L: System<Group: MatrixLieGroup<N, D>> + Clone,
{
    for scheme in SCHEMES {
        let errors = errors(system, scheme, body, start, coarsest);
        let order = order(&errors, PLATEAU);
        println!("{}: order {order:.4}, errors {:.2e} to {:.2e}", scheme.name(), errors[0].1, errors[4].1);
        assert!((order - 4.0).abs() < 0.1, "{}: order {order}, errors {errors:?}", scheme.name());
    }
}

#[test]
fn orbiting_body() {
    let body = samples::orbiting_body();
    let (inertia, potential) = orbit(&body);
    assert_fourth_order(&body, &Body { inertia, potential: &potential }, samples::in_orbit(), 0.1);
}

#[test]
fn underwater_body() {
    let body = samples::underwater_body();
    let (inertia, potential) = kirchhoff(&body);
    assert_fourth_order(&body, &Body { inertia, potential: &potential }, samples::on_se3(), 0.2);
}

#[test]
fn tethered_plate() {
    let body = samples::tethered_plate();
    let (inertia, potential) = tether(&body);
    assert_fourth_order(&body, &Body { inertia, potential: &potential }, samples::on_se2(), 0.1);
}
