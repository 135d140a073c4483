//! Symmetric compositions of declared Lagrangians.

use checks::random::Random;
use checks::structure::poisson::{TOLERANCE, defect_of};
use declarations::{FourthOrderTop, FreeBody, HeavyTop, Motion, SixthOrderTop, Top as _};
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::methods::CompositionScheme;
use liestep::prelude::*;
use nalgebra::Vector3;
use workbench::measure::relative;

use crate::convergence::{End, TOPS, assert_order, counts};
use crate::many_digits::heavy_top::Top;
use crate::many_digits::{self, DoubleDouble};

const SCHEMES: [CompositionScheme; 4] = [
    CompositionScheme::SUZUKI_4,
    CompositionScheme::KAHAN_LI_6,
    CompositionScheme::KAHAN_LI_8,
    CompositionScheme::SOFRONIOU_SPALETTA_10,
];

fn end<L>(lagrangian: L, scheme: CompositionScheme, motion: &Motion, h: f64, steps: u32) -> End
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular + Clone,
{
    let composed = Stepper::composed(lagrangian, h, scheme).unwrap();
    let mut state = composed.start(motion.attitude, motion.velocity).unwrap();
    for _ in 0..steps {
        composed.step(&mut state).unwrap();
    }
    (state.attitude(), composed.velocity(&state))
}

/// On as many of the tops as there are coarsest steps, for ten seconds.
fn assert_order_on_tops(scheme: CompositionScheme, ratio: f64, coarsest: &[u32]) {
    for (name, coarsest) in TOPS.iter().zip(coarsest) {
        let counts = counts(*coarsest, ratio, 5);
        assert_order((scheme.name(), scheme.order()), (name, 10.0), &counts, |motion, h, steps| {
            end(motion.top.clone(), scheme, motion, h, steps)
        });
    }
}

#[test]
fn suzuki_4_is_of_order_4() {
    assert_order_on_tops(CompositionScheme::SUZUKI_4, 2.0, &[1000, 1000, 1000, 160]);
}

#[test]
fn kahan_li_6_is_of_order_6() {
    assert_order_on_tops(CompositionScheme::KAHAN_LI_6, 1.5, &[800, 800, 800, 160]);
}

#[test]
fn kahan_li_8_is_of_order_8() {
    assert_order_on_tops(CompositionScheme::KAHAN_LI_8, 1.3, &[600, 600, 600, 140]);
}

/// In a double the errors fall faster than their order until rounding shows.
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
            |motion, h, steps| end(motion.top.clone(), scheme, motion, h, steps),
        );
    }
}

#[test]
fn suzuki_6_of_the_fourth_order_top_is_of_order_6() {
    let scheme = CompositionScheme::SUZUKI_6;
    assert_order((scheme.name(), 6), (TOPS[0], 1.0), &counts(40, 1.5, 5), |motion, h, steps| {
        end(FourthOrderTop::of(&motion.top), scheme, motion, h, steps)
    });
}

#[test]
fn suzuki_8_of_the_sixth_order_top_is_of_order_8() {
    let scheme = CompositionScheme::SUZUKI_8;
    assert_order((scheme.name(), 8), (TOPS[0], 1.0), &counts(10, 1.3, 5), |motion, h, steps| {
        end(SixthOrderTop::of(&motion.top), scheme, motion, h, steps)
    });
}

/// A parameter off the orbit of the declared one is that of another top, whose vertical it is.
#[test]
fn p1_compositions_are_poisson_maps() {
    let mut random = Random::new(21);
    for scheme in SCHEMES {
        for h in [0.1, 0.3] {
            let (momentum, w) = (random.vector() * 5.0, random.vector());
            let step = |momentum: &Vector3<f64>, w: &Vector3<f64>| {
                let top = HeavyTop { up: *w, ..HeavyTop::asymmetric() };
                let composed = Stepper::composed(top, h, scheme).unwrap();
                let mut state = composed.start_with_momentum(SO3::identity(), *momentum).unwrap();
                composed.step(&mut state).unwrap();
                (state.momentum(), state.advected())
            };
            let (defect, _) = defect_of::<HeavyTop, 3, 3>(step, &momentum, &w);
            println!("{}, h = {h}: {defect:.1e}", scheme.name());
            assert!(defect < TOLERANCE, "{}, h = {h}: {defect:e}", scheme.name());
        }
    }
}

#[test]
fn s5_negative_composed_step_is_the_inverse_map() {
    let mut random = Random::new(22);
    for scheme in SCHEMES {
        for h in [0.1, 0.01, 1e-6] {
            let [there, back] = [h, -h].map(|h| Stepper::composed(HeavyTop::asymmetric(), h, scheme).unwrap());
            for _ in 0..10 {
                let mut state = there.start(random.rotation(), random.vector()).unwrap();
                let before = state;
                there.step(&mut state).unwrap();
                back.step(&mut state).unwrap();
                // Some roundings a stage.
                assert!(relative(&state.attitude().matrix(), &before.attitude().matrix()) < 2e-14);
                assert!(relative(&state.momentum(), &before.momentum()) < 2e-14);
                assert!(relative(&state.advected(), &before.advected()) < 2e-14);
            }
        }
    }
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

/// 10⁴ steps of up to 35 stages each.
#[test]
fn compositions_keep_the_vertical_momentum() {
    let motion = Motion::looping();
    for scheme in SCHEMES {
        let composed = Stepper::composed(motion.top.clone(), 0.02, scheme).unwrap();
        let mut state = composed.start(motion.attitude, motion.velocity).unwrap();
        let (vertical, spin) = (state.momentum_along(&Vector3::z()), state.momentum().z);
        for _ in 0..10_000 {
            composed.step(&mut state).unwrap();
        }
        let drift = (state.momentum_along(&Vector3::z()) - vertical).abs() / vertical.abs();
        let defect = state.orthogonality_defect();
        println!("{}: vertical momentum {drift:.1e}, orthogonality {defect:.1e}", scheme.name());
        assert!(drift < 1e-12 && defect < 2e-12 && (state.momentum().z - spin).abs() < 1e-12 * spin.abs());
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

/// The longest substep meets the limit first; what is reported is a whole step, and that one can be made.
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

/// What the extrapolated guesses are for: without them a stage takes four iterations.
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

#[test]
fn a_composition_of_one_stage_is_the_step_itself() {
    let one = CompositionScheme::new("one", 2, 2, &[1.0]);
    let motion = Motion::looping();
    let composed = Stepper::composed(motion.top.clone(), 0.01, one).unwrap();
    let stepper = Stepper::new(motion.top.clone(), 0.01).unwrap();
    let mut state = composed.start(motion.attitude, motion.velocity).unwrap();
    let mut alone = stepper.start(motion.attitude, motion.velocity).unwrap();
    for _ in 0..100 {
        composed.step(&mut state).unwrap();
        stepper.step(&mut alone).unwrap();
    }
    assert!(relative(&state.momentum(), &alone.momentum()) < 1e-14);
    assert!(relative(&state.attitude().matrix(), &alone.attitude().matrix()) < 1e-14);
}
