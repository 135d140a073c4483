//! Processed splittings: their orders and invariants, and outputs that don't disturb the motion.

use checks::order::{TOPS, counts, end, measured};
use declarations::{FreeBody, HeavyTop, Motion};
use liestep::methods::{ExactBody, ProcessedScheme, SplittingScheme};
use liestep::prelude::*;
use nalgebra::Vector3;
use workbench::measure::relative;

use crate::splitting::symmetric;

fn exact(top: &HeavyTop) -> ExactBody {
    ExactBody::new(&top.ordinary_inertia())
}

/// The orders on tops with and without symmetry. The processor's error is as large as the kernel's, except for `SIX_C`, and
/// on the chaotic top they cancel in part.
#[test]
fn processed_splittings_have_their_orders() {
    for (scheme, coarsest) in [
        (ProcessedScheme::SIX_A, 240),
        (ProcessedScheme::SIX_B, 160),
        (ProcessedScheme::SIX_C, 160),
        (ProcessedScheme::FOUR_A, 500),
        (ProcessedScheme::FOUR_B, 500),
        (ProcessedScheme::FOUR_C, 500),
    ] {
        for name in TOPS {
            let order = measured(scheme.name(), (name, 10.0), &counts(coarsest, 1.25, 5), |motion, h, steps| {
                end(&Stepper::processed(motion.top.clone(), h, exact(&motion.top), scheme).unwrap(), motion, steps)
            });
            assert!((order - f64::from(scheme.order())).abs() < 0.35, "{}, {name}: {order}", scheme.name());
        }
    }
}

/// Reading the state after each step, after some or none doesn't change its bits.
#[test]
fn looking_does_not_disturb() {
    let motion = Motion::chaotic();
    for scheme in ProcessedScheme::ALL {
        let processed = Stepper::processed(motion.top.clone(), 0.05, exact(&motion.top), scheme).unwrap();
        let start = processed.start(motion.attitude, motion.velocity).unwrap();
        let (mut single, mut some, mut many) = (start, start, start);
        for _ in 0..100 {
            processed.step(&mut single).unwrap();
        }
        for part in [1, 0, 40, 7, 52] {
            processed.run(&mut some, part).unwrap();
        }
        processed.run(&mut many, 100).unwrap();
        assert_eq!(single, many, "{}", scheme.name());
        assert_eq!(some, many, "{}", scheme.name());
    }
}

/// The invariants over a million steps of the chaotic top: the momentum about the vertical, lengths, and orthogonality.
/// The energy stays within its initial bound.
#[test]
fn processed_splittings_keep_the_momenta() {
    let motion = Motion::chaotic();
    for scheme in ProcessedScheme::ALL {
        let processed = Stepper::processed(motion.top.clone(), 0.1, exact(&motion.top), scheme).unwrap();
        let mut state = processed.start(motion.attitude, motion.velocity).unwrap();
        let (vertical, energy) = (state.momentum_along(&Vector3::z()), processed.energy(&state));
        let mut windows = Vec::new();
        for _ in 0..10 {
            let mut widest = 0.0_f64;
            for _ in 0..100 {
                processed.run(&mut state, 1000).unwrap();
                widest = widest.max((processed.energy(&state) - energy).abs() / energy.abs());
            }
            windows.push(widest);
        }
        let drift = ((state.momentum_along(&Vector3::z()) - vertical) / vertical).abs();
        let (length, defect) = ((state.advected().norm() - 1.0).abs(), state.orthogonality_defect());
        let (first, last) = (windows[0], windows[9]);
        println!("{}: {drift:.1e}, {length:.1e}, {defect:.1e}, {first:.1e} to {last:.1e}", scheme.name());
        assert!(drift.max(length).max(defect) < 2e-12, "{}: {drift:e}, {length:e}, {defect:e}", scheme.name());
        assert!(last < 2.0 * first, "{}: {windows:?}", scheme.name());
    }
}

/// A symmetric top by its own flow has the motion of any other exact flow.
#[test]
fn other_flows_will_do() {
    let (motion, scheme) = (Motion::looping(), ProcessedScheme::SIX_A);
    let own = Stepper::processed(motion.top.clone(), 0.05, symmetric(&motion.top), scheme).unwrap();
    let exact = Stepper::processed(motion.top.clone(), 0.05, exact(&motion.top), scheme).unwrap();
    let (own, exact) = (end(&own, &motion, 100), end(&exact, &motion, 100));
    assert!(relative(own.0.as_matrix(), exact.0.as_matrix()) < 1e-12);
}

/// A push acts on the output: the torque of a step is that of a splitting to the order of both.
#[test]
fn a_push_acts_on_what_is_read() {
    let motion = Motion::chaotic();
    let processed = Stepper::processed(motion.top.clone(), 0.01, exact(&motion.top), ProcessedScheme::SIX_A).unwrap();
    let split = Stepper::split(motion.top.clone(), 0.01, exact(&motion.top), SplittingScheme::NYSTROM_14).unwrap();
    let mut states = (
        processed.start(motion.attitude, motion.velocity).unwrap(),
        split.start(motion.attitude, motion.velocity).unwrap(),
    );
    for torque in [Vector3::new(5.0, -3.0, 2.0), Vector3::zeros(), Vector3::new(-1.0, 4.0, 2.0)] {
        processed.step_forced(&mut states.0, &torque).unwrap();
        split.step_forced(&mut states.1, &torque).unwrap();
    }
    assert!(relative(&states.0.momentum(), &states.1.momentum()) < 1e-10);
}

/// A processed free body moves as by one exact drift: kicks and their gradients are zero.
#[test]
fn a_free_body_is_processed_exactly() {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.6, 2.6, 3.0)).unwrap();
    let flow = ExactBody::new(&J_d.to_inertia());
    let scene = FreeBody { J_d };
    let velocity = Vector3::new(0.3, -1.0, 0.8);
    let processed = Stepper::processed(scene.clone(), 1.0, flow, ProcessedScheme::SIX_A).unwrap();
    let whole = Stepper::split(scene, 10.0, flow, SplittingScheme::STRANG).unwrap();
    let mut states =
        (processed.start(SO3::identity(), velocity).unwrap(), whole.start(SO3::identity(), velocity).unwrap());
    processed.run(&mut states.0, 10).unwrap();
    whole.step(&mut states.1).unwrap();
    assert!(relative(&states.0.momentum(), &states.1.momentum()) < 1e-13);
}
