//! Symmetric compositions of declared Lagrangians.

use checks::order::{TOPS, assert_order, counts, end};
use declarations::{FourthOrderTop, FreeBody, Motion, SixthOrderTop, Top as _};
use liestep::methods::CompositionScheme;
use liestep::prelude::*;
use nalgebra::Vector3;

use crate::many_digits::heavy_top::Top;
use crate::many_digits::{self, DoubleDouble};

const SCHEMES: [CompositionScheme; 4] = [
    CompositionScheme::SUZUKI_4,
    CompositionScheme::KAHAN_LI_6,
    CompositionScheme::KAHAN_LI_8,
    CompositionScheme::SOFRONIOU_SPALETTA_10,
];

/// The order is measured in long numbers: in doubles errors fall faster than their order until rounding dominates.
#[test]
fn sofroniou_spaletta_10_is_of_order_10() {
    let scheme = CompositionScheme::SOFRONIOU_SPALETTA_10;
    let stages = many_digits::coefficients::refined(&scheme);
    for (name, coarsest) in TOPS.into_iter().zip([500, 500, 500, 250]) {
        let run = |motion: &many_digits::motion::Motion, h: DoubleDouble, steps: u32| {
            let mut top = Top::at_start_of(motion);
            for gamma in stages.iter().cycle().take(stages.len() * steps as usize) {
                top.step(h * *gamma);
            }
            (top.attitude, top.velocity())
        };
        many_digits::assert_order(
            (scheme.name(), 10),
            (name, 10.0),
            (coarsest / 2, &counts(coarsest, 1.4, 5)),
            run,
            |motion, h, steps| end(&Stepper::composed(motion.top.clone(), h, scheme).unwrap(), motion, steps),
        );
    }
}

#[test]
fn suzuki_6_of_the_fourth_order_top_is_of_order_6() {
    let scheme = CompositionScheme::SUZUKI_6;
    assert_order((scheme.name(), 6), (TOPS[0], 1.0), &counts(40, 1.5, 5), |motion, h, steps| {
        end(&Stepper::composed(FourthOrderTop::of(&motion.top), h, scheme).unwrap(), motion, steps)
    });
}

#[test]
fn suzuki_8_of_the_sixth_order_top_is_of_order_8() {
    let scheme = CompositionScheme::SUZUKI_8;
    assert_order((scheme.name(), 8), (TOPS[0], 1.0), &counts(10, 1.3, 5), |motion, h, steps| {
        end(&Stepper::composed(SixthOrderTop::of(&motion.top), h, scheme).unwrap(), motion, steps)
    });
}

#[test]
fn a_composed_step_of_zero_is_the_identity() {
    let motion = Motion::looping();
    for scheme in SCHEMES {
        let composed = Stepper::composed(motion.top.clone(), 0.0, scheme).unwrap();
        let mut state = composed.start(motion.attitude, motion.velocity).unwrap();
        let before = state;
        composed.step(&mut state).unwrap();
        assert_eq!(
            (before.attitude(), before.momentum(), before.advected(), 1),
            (state.attitude(), state.momentum(), state.advected(), state.steps())
        );
    }
}

#[test]
fn compositions_keep_the_energy_of_the_free_body() {
    let composed =
        Stepper::composed(FreeBody::with_moments([1.0, 2.0, 3.0]), 0.1, CompositionScheme::KAHAN_LI_8).unwrap();
    let mut state = composed.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02)).unwrap();
    let energy = composed.energy(&state);
    for _ in 0..10_000 {
        composed.step(&mut state).unwrap();
    }
    assert!((composed.energy(&state) - energy).abs() < 1e-12 * energy);
}

/// The longest substep reaches its limit first; the error reports a whole step, and that step is solvable.
#[test]
fn a_substep_that_is_too_long_is_an_error() {
    let motion = Motion::looping();
    for scheme in SCHEMES {
        let limit = 0.0815 / scheme.largest();
        let composed = Stepper::composed(motion.top.clone(), 1.2 * limit, scheme).unwrap();
        let mut state = composed.start(motion.attitude, motion.velocity).unwrap();
        let before = state;
        let error = composed.step(&mut state).unwrap_err();
        assert_eq!(state, before);
        let StepError::BeyondSolvable { step, largest, .. } = error else { panic!("{error}") };
        println!("{}: {step} s, largest {largest} s, estimated {limit}", scheme.name());
        assert!((step - 1.2 * limit).abs() < 1e-15 && largest < step);
        assert!((largest / limit - 1.0).abs() < 0.1, "{}: {largest}, {limit}", scheme.name());
        let shorter = Stepper::composed(motion.top.clone(), largest, scheme).unwrap();
        let mut state = shorter.start(motion.attitude, motion.velocity).unwrap();
        shorter.step(&mut state).unwrap();
    }
}

/// The extrapolated guesses save iterations: without them a stage takes four.
#[test]
fn a_stage_takes_few_iterations() {
    let motion = Motion::looping();
    for scheme in SCHEMES {
        let composed = Stepper::composed(motion.top.clone(), 0.02, scheme).unwrap();
        let mut state = composed.start(motion.attitude, motion.velocity).unwrap();
        let mut iterations = 0;
        for _ in 0..100 {
            iterations += composed.step(&mut state).unwrap().iterations;
        }
        let each = f64::from(iterations) / 100.0 / f64::from(u32::try_from(scheme.stages().count()).unwrap());
        println!("{}: {each:.2}", scheme.name());
        assert!(each < 3.0, "{}: {each}", scheme.name());
    }
}
