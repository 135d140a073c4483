//! A body that turns steadily makes the same increment `F` in every step, or the same few by turns, and with it the
//! same rounding: `FᵀF − I` is some `ε |hΩ|²` that doesn't average out, and `RᵀR − I` and `|w|² − 1` would grow like
//! `N` where roundings at random make `√N` of them. The momentum has no such term: the error of `F` is across the axis
//! of the turn.
//!
//! An attitude that is found far from the group is put back, and what is advected with it.

use declarations::HeavyTop;
use liestep::methods::{CompositionScheme, SplittingScheme, SymmetricBody};
use liestep::motion::{Integrator, Motion};
use liestep::prelude::*;
use nalgebra::{UnitQuaternion, Vector3};

type TopMotion = liestep::motion::Motion<SO3, Vector3<f64>>;

/// Steps of a motion whose rounding errors add up without compensation: to 3·10⁻¹² for a sphere and 7·10⁻¹² for the
/// symmetric body, and more the longer it turns.
const STEPS: u32 = 4_000_000;

/// The moments of a sphere, and of the thesis' body.
const BODIES: [[f64; 3]; 2] = [[2.0, 2.0, 2.0], [3.0, 3.0, 4.0]];

fn weightless(moments: [f64; 3]) -> HeavyTop {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(moments.into()).unwrap();
    HeavyTop { J_d, g: 0.0, ..HeavyTop::thesis() }
}

fn start() -> (UnitQuaternion<f64>, Vector3<f64>) {
    (UnitQuaternion::from_scaled_axis(Vector3::new(0.8, -0.3, 0.1)), Vector3::new(0.5, 2.0, 12.0))
}

/// Asserts the bounds that T3 allows in 10⁸ steps.
fn assert_kept(name: &str, start: &TopMotion, end: &TopMotion) {
    let length = (end.advected().norm_squared() - 1.0).abs();
    let vertical = |state: &TopMotion| state.momentum().dot(&state.advected());
    let vertical = (vertical(end) / vertical(start) - 1.0).abs();
    let momentum = (end.spatial_momentum() - start.spatial_momentum()).norm() / start.momentum().norm();
    let orthogonality = end.orthogonality_defect();
    println!("{name}: ‖RᵀR − I‖ {orthogonality:.1e}, |w|² {length:.1e}, p·w {vertical:.1e}, R p {momentum:.1e}");
    assert!(orthogonality <= 2e-12, "{name}: ‖RᵀR − I‖ = {orthogonality:e}");
    assert!(length <= 3e-12 && vertical <= 3e-12 && momentum <= 3e-12, "{name}: {length:e} {vertical:e} {momentum:e}");
    // The advected vector has not drifted away from the attitude: `w` is what the attitude sees.
    let seen = end.attitude().as_matrix().row(2).transpose();
    assert!((end.advected() - seen).norm() <= 2e-12, "{name}");
}

/// Makes these steps of each body.
fn turn<I>(method: &str, steps: u32, stepper: impl Fn(HeavyTop, [f64; 3]) -> (I, I::State))
where
    I: Integrator<Motion = Motion<SO3, Vector3<f64>>>,
{
    for moments in BODIES {
        let (stepper, mut state) = stepper(weightless(moments), moments);
        let start = *state;
        stepper.run(&mut state, u64::from(steps)).unwrap();
        assert_kept(&format!("{method} {moments:?}"), &start, &state);
    }
}

/// A stepper with its initial state.
macro_rules! started {
    ($stepper:expr) => {{
        let stepper = $stepper.unwrap();
        let (attitude, velocity) = start();
        let state = stepper.start(attitude, velocity).unwrap();
        (stepper, state)
    }};
}

#[test]
fn t3_steady_turns_stay_on_the_group() {
    turn("plain", STEPS, |top, _| started!(Stepper::new(top, 0.01)));
}

#[test]
fn t3_compensated_steady_turns_stay_on_the_group() {
    turn("compensated", STEPS, |top, _| started!(Stepper::new(top, 0.01).map(Stepper::compensated)));
}

#[test]
fn t3_composed_steady_turns_stay_on_the_group() {
    turn("composed", STEPS / 5, |top, _| started!(Stepper::composed(top, 0.05, CompositionScheme::SUZUKI_4)));
}

#[test]
fn t3_split_steady_turns_stay_on_the_group() {
    turn("split", STEPS / 6, |top, moments| {
        let body = SymmetricBody::new(&Inertia::from_principal_moments(moments.into()).unwrap()).unwrap();
        started!(Stepper::split(top, 0.01, body, SplittingScheme::NYSTROM_6))
    });
}
