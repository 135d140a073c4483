//! Units don't matter: with masses in units 2ᵏ times smaller, or times, the motion is the same to the last bit. Every
//! tolerance of the solver is relative, and no constant has a dimension.

use declarations::HeavyTop;
use declarations::Motion;
use liestep::Stepper;
use liestep::groups::LieGroup as _;
use liestep::mechanics::DiagonalNonstandardInertia;
use nalgebra::{Matrix3, Vector3};

/// The looping top, or one without symmetry, with masses and times multiplied; momenta in the old units.
fn moved(top: &HeavyTop, mass: f64, time: f64) -> (Matrix3<f64>, Vector3<f64>, Vector3<f64>) {
    let motion = Motion::looping();
    let scaled = HeavyTop {
        J_d: DiagonalNonstandardInertia::new(top.J_d.diagonal() * mass).unwrap(),
        m: top.m * mass,
        g: top.g / (time * time),
        ..top.clone()
    };
    let stepper = Stepper::new(scaled, 0.01 * time).unwrap();
    let mut state = stepper.start(motion.attitude, motion.velocity / time).unwrap();
    for _ in 0..100_000 {
        stepper.step(&mut state).unwrap();
    }
    (state.attitude().matrix(), state.momentum() * (time / mass), state.advected())
}

#[test]
fn t9_masses_and_times_in_powers_of_two() {
    for top in [HeavyTop::thesis(), HeavyTop::asymmetric()] {
        let original = moved(&top, 1.0, 1.0);
        for exponent in [30, -30, 200, -200] {
            assert_eq!(moved(&top, 2.0_f64.powi(exponent), 1.0), original, "mass times 2^{exponent}");
        }
        for exponent in [30, -40] {
            assert_eq!(moved(&top, 1.0, 2.0_f64.powi(exponent)), original, "time times 2^{exponent}");
        }
    }
}
