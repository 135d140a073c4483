//! Kinetic-potential splittings.

use checks::order::{End, TOPS, assert_order, counts, end, error};
use checks::solvers::JacobianCounter;
use declarations::{FourthOrderBody, FourthOrderTop, FreeBody, HeavyTop, LogTop, Motion, SixthOrderBody, Top as _};
use liestep::accuracy::Accuracy;
use liestep::effects::{GravityGradient, Rotor, Spring};
use liestep::mechanics::{Term as _, inertia};
use liestep::methods::{CompositionScheme, KineticFlow, SplittingScheme, SymmetricBody};
use liestep::prelude::*;
use nalgebra::Vector3;
use workbench::measure::relative;

use crate::many_digits::heavy_top::Top;
use crate::many_digits::{self, DoubleDouble};

pub(crate) fn symmetric(top: &HeavyTop) -> SymmetricBody {
    SymmetricBody::new(&top.ordinary_inertia()).unwrap()
}

fn split<K: KineticFlow<f64>>(kinetic: K, scheme: SplittingScheme, motion: &Motion, h: f64, steps: u32) -> End {
    end(&Stepper::split(motion.top.clone(), h, kinetic, scheme).unwrap(), motion, steps)
}

/// The order is measured in long numbers: in doubles an exact kinetic flow reaches rounding at long steps.
#[test]
fn sofroniou_spaletta_10_of_strang_is_of_order_10() {
    let scheme = SplittingScheme::SOFRONIOU_SPALETTA_10;
    let stages = many_digits::coefficients::refined(&CompositionScheme::SOFRONIOU_SPALETTA_10);
    let half = DoubleDouble::from(0.5);
    for (name, coarsest) in TOPS.into_iter().zip([160, 80, 120]) {
        let run = |motion: &many_digits::motion::Motion, h: DoubleDouble, steps: u32| {
            let mut top = Top::at_start_of(motion);
            for gamma in stages.iter().cycle().take(stages.len() * steps as usize) {
                top.kick(h * *gamma * half);
                top.drift(h * *gamma);
                top.kick(h * *gamma * half);
            }
            (top.attitude, top.velocity())
        };
        many_digits::assert_order(
            (scheme.name(), 10),
            (name, 10.0),
            (coarsest / 2, &counts(coarsest, 1.4, 5)),
            run,
            |motion, h, steps| split(symmetric(&motion.top), scheme, motion, h, steps),
        );
    }
}

/// The top has a potential that isn't small: on the others the measured order at usual steps is between 8 and 4.
#[test]
fn near_integrable_8_6_4_and_10_6_4_are_of_order_4() {
    for scheme in [SplittingScheme::NEAR_INTEGRABLE_8_6_4, SplittingScheme::NEAR_INTEGRABLE_10_6_4] {
        assert_order((scheme.name(), 4), (TOPS[3], 10.0), &counts(200, 1.5, 5), |motion, h, steps| {
            split(SixthOrderBody { J: motion.top.ordinary_inertia() }, scheme, motion, h, steps)
        });
    }
}

/// The gradients of nonlinear potentials and their sum, compared with shorter steps.
#[test]
fn force_gradients_of_any_potential() {
    let top = HeavyTop::thesis();
    let scene = || {
        let spring =
            Spring { k: 40.0, length: 0.5, at: Vector3::new(0.2, 0.3, 0.9), anchor: Vector3::new(1.5, 0.5, 1.0) };
        // The shape of the gravity gradient differs from the body's, as for a satellite's mass.
        let J = Inertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.0)).unwrap();
        let gradient = GravityGradient { GM: 20.0, r: 1.5, J, direction: Vector3::new(0.0, 0.6, 0.8) };
        top.clone() + spring + gradient
    };
    let run = |scheme, steps: u32| {
        let splitting = Stepper::split(scene(), 2.0 / f64::from(steps), symmetric(&top), scheme).unwrap();
        let mut state = splitting.start(SO3::identity(), Vector3::new(0.5, 2.0, 6.0)).unwrap();
        splitting.run(&mut state, steps.into()).unwrap();
        (*state.attitude().as_matrix(), state.momentum())
    };
    let exact = run(SplittingScheme::NYSTROM_14, 800);
    for (scheme, coarse) in [
        (SplittingScheme::FORCE_GRADIENT_2, 100),
        (SplittingScheme::FORCE_GRADIENT_4, 50),
        (SplittingScheme::FORCE_GRADIENT_5, 30),
    ] {
        let [first, second] = [coarse, 2 * coarse].map(|steps| {
            let end = run(scheme, steps);
            relative(&end.0, &exact.0) + relative(&end.1, &exact.1)
        });
        let measured = (first / second).log2();
        println!("{}: {first:.1e}, {second:.1e}, order {measured:.2}", scheme.name());
        assert!((measured - f64::from(scheme.order())).abs() < 0.25, "{}: {measured}", scheme.name());
    }
}

/// Splittings with a declared kinetic flow have their order for a top without a closed exact flow.
#[test]
fn declared_kinetic_flows_keep_the_order() {
    let chaotic = (TOPS[3], 10.0);
    for scheme in [SplittingScheme::NYSTROM_11, SplittingScheme::NYSTROM_14] {
        assert_order((scheme.name(), 6), chaotic, &counts(60, 1.3, 5), |motion, h, steps| {
            split(SixthOrderBody { J: motion.top.ordinary_inertia() }, scheme, motion, h, steps)
        });
    }
    let scheme = SplittingScheme::NYSTROM_6;
    assert_order((scheme.name(), 4), chaotic, &counts(160, 1.5, 5), |motion, h, steps| {
        split(FourthOrderBody { J: motion.top.ordinary_inertia() }, scheme, motion, h, steps)
    });
}

/// The flow without an equation is that of the free body: compared with the closed form to thirty digits.
#[test]
fn the_symmetric_body_moves_exactly() {
    let motion = Motion::read("free symmetric");
    let expected = motion.at(10.0);
    for (h, steps) in [(10.0, 1), (1.0, 10), (0.01, 1000)] {
        let found = split(symmetric(&motion.top), SplittingScheme::STRANG, &motion, h, steps);
        assert!(error(&found, &expected) < 1e-13, "h = {h}");
    }
}

/// Strang's splitting of (3.13) with its own kinetic flow is (3.13).
#[test]
fn strang_with_the_flow_of_3_13_is_3_13() {
    let motion = Motion::looping();
    let kinetic = FreeBody { J_d: motion.top.J_d.into() };
    let expected = end(&Stepper::new(motion.top.clone(), 0.01).unwrap(), &motion, 100);
    let found = split(kinetic, SplittingScheme::STRANG, &motion, 0.01, 100);
    assert!(error(&found, &(expected.0.matrix(), expected.1)) < 1e-13);
}

#[test]
fn another_body_is_refused() {
    let top = HeavyTop::thesis();
    let other = SymmetricBody::new(&Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.5)).unwrap()).unwrap();
    let error = Stepper::split(top, 0.01, other, SplittingScheme::STRANG).unwrap_err();
    assert_eq!(error, SetupError::InertiaMismatch { difference: 0.5 });
}

#[test]
fn a_body_without_symmetry_has_no_exact_flow() {
    for moments in [[2.0, 3.0, 4.5], [3.0, 4.0, 3.0]] {
        let inertia = Inertia::from_principal_moments(moments.into()).unwrap();
        assert!(matches!(SymmetricBody::new(&inertia), Err(SetupError::Parameter { field: "inertia", .. })));
    }
}

/// The fourth-order top couples `F` and `w` in one term; a splitting admits only half-step kicks.
#[test]
fn a_lagrangian_that_cannot_be_split_is_refused() {
    let top = HeavyTop::thesis();
    let coupled = FourthOrderTop::of(&top);
    let error = Stepper::split(coupled, 0.01, symmetric(&top), SplittingScheme::STRANG).unwrap_err();
    assert!(matches!(error, SetupError::NotSeparable { defect } if defect > 1e-3), "{error:?}");
}

/// A scene without the derivative of its kick can be split, but not with force gradients.
#[test]
fn a_force_gradient_has_to_be_written() {
    let top = JacobianCounter(HeavyTop::thesis());
    let split = |scheme| Stepper::split(top.clone(), 0.01, symmetric(&top.0), scheme).map(|_| ());
    assert_eq!(split(SplittingScheme::NYSTROM_6), Ok(()));
    assert_eq!(split(SplittingScheme::FORCE_GRADIENT_2), Err(SetupError::NoForceGradient));
    // The choice by accuracy leaves out schemes with force gradients.
    let accuracy = Accuracy { tolerance: 1e-4, horizon: 1.0 };
    let stepper = Stepper::for_accuracy(top, accuracy, SO3::identity(), Vector3::new(0.5, 2.0, 12.0)).unwrap();
    assert!(!stepper.choice().to_string().contains("force gradient"));
}

/// `p_3` is constant, but the rounding of its square varies from step to step: a constant rounding error would change
/// `|w|²` by 9e-14 here.
#[test]
fn the_exact_flow_keeps_lengths() {
    let motion = Motion::looping();
    let scheme = SplittingScheme::NEAR_INTEGRABLE_10_6_4;
    let splitting = Stepper::split(motion.top.clone(), 0.19, symmetric(&motion.top), scheme).unwrap();
    let mut state = splitting.start(motion.attitude, motion.velocity).unwrap();
    let before = state.advected().norm_squared();
    splitting.run(&mut state, 10_000).unwrap();
    let change = (state.advected().norm_squared() / before - 1.0).abs();
    assert!(change < 6e-14, "{change:e}");
}

/// The flow of a body without a rotor doesn't agree with a scene that has one.
#[test]
fn a_rotor_that_the_flow_does_not_have_is_refused() {
    let top = HeavyTop::thesis();
    let scene = top.clone() + Rotor { spin: Vector3::new(0.0, 0.0, 0.5) };
    let error = Stepper::split(scene, 0.01, symmetric(&top), SplittingScheme::STRANG).unwrap_err();
    assert_eq!(error, SetupError::BiasMismatch);
}

/// The kinetic part of the declared Lagrangian doesn't matter, as it is replaced.
#[test]
fn the_kinetic_part_is_replaced() {
    let motion = Motion::looping();
    let log = LogTop::of(&motion.top);
    let scheme = SplittingScheme::NYSTROM_11;
    let found = end(&Stepper::split(log, 0.05, symmetric(&motion.top), scheme).unwrap(), &motion, 100);
    let expected = split(symmetric(&motion.top), scheme, &motion, 0.05, 100);
    assert!(error(&found, &(expected.0.matrix(), expected.1)) < 1e-13);
}

#[test]
fn a_failed_step_leaves_the_state() {
    let top = HeavyTop::asymmetric();
    let kinetic = FreeBody { J_d: DiagonalNonstandardInertia::from_diagonal(*top.J_d.diagonal()).unwrap().into() };
    assert!((inertia(&kinetic, &kinetic.advected()) - inertia(&top, &top.advected())).norm() < 1e-14);
    let splitting = Stepper::split(top, 1.0, kinetic, SplittingScheme::STRANG).unwrap();
    let mut state = splitting.start(SO3::identity(), Vector3::new(5.0, 5.0, 5.0)).unwrap();
    let before = state;
    splitting.run(&mut state, 10).unwrap_err();
    assert_eq!(state, before);
}
