//! Dual numbers through the stepper: derivatives of a whole trajectory with respect to a parameter.

use checks::any_scalar::Top;
use liestep::numbers::Real;
use liestep::prelude::*;
use nalgebra::{RealField, UnitQuaternion, Vector3};
use num_dual::Dual64;

const STEPS: usize = 1000;
const STEP: f64 = 0.01;

/// The differentiated quantities: attitude, momentum and vertical.
type Outcome<T> = [T; 15];

/// The quantity that a parameter `s` of value one scales.
#[derive(Clone, Copy, Debug)]
enum ScaledQuantity {
    Weight,
    Moment,
    Velocity,
}

type TopRun<T> = (Stepper<Top<T>>, State<SO3<T>, Vector3<T>>);

/// The asymmetric top with a scaled parameter, in its initial state.
fn start<T: Real + RealField>(scaled: ScaledQuantity, s: T) -> TopRun<T> {
    let vector = |x: f64, y: f64, z: f64| Vector3::new(x, y, z).map(nalgebra::convert::<f64, T>);
    let mut moments = vector(2.0, 3.0, 4.5);
    let mut weight: T = nalgebra::convert(9.81);
    let mut velocity = vector(0.5, 2.0, 6.0);
    match scaled {
        ScaledQuantity::Weight => weight *= s,
        ScaledQuantity::Moment => moments.y *= s,
        ScaledQuantity::Velocity => velocity *= s,
    }
    let J_d = DiagonalNonstandardInertia::from_principal_moments(moments).unwrap();
    let top = Top { J_d, weight, rho: vector(0.3, 0.2, 0.4), up: Vector3::z() };
    let stepper = Stepper::new(top, nalgebra::convert(STEP)).unwrap();
    let attitude = UnitQuaternion::from_scaled_axis(vector(0.8, 0.0, 0.0));
    let state = stepper.start(attitude, velocity).unwrap();
    (stepper, state)
}

/// The quantities after [`STEPS`] steps.
fn outcome<T: Real + RealField>(scaled: ScaledQuantity, s: T) -> Outcome<T> {
    let (stepper, mut state) = start(scaled, s);
    for _ in 0..STEPS {
        stepper.step(&mut state).unwrap();
    }
    let (attitude, momentum, vertical) = (state.attitude().matrix(), state.momentum(), state.advected());
    let entries = [attitude.as_slice(), momentum.as_slice(), vertical.as_slice()].concat();
    entries.try_into().unwrap()
}

/// Central differences of orders 2, 4, 6, … by Richardson's extrapolation.
fn differences(scaled: ScaledQuantity) -> Outcome<f64> {
    let central = |e: f64| {
        let (plus, minus) = (outcome(scaled, 1.0 + e), outcome(scaled, 1.0 - e));
        core::array::from_fn::<f64, 15, _>(|k| (plus[k] - minus[k]) / (2.0 * e))
    };
    let [coarse, middle, fine] = [1e-3, 5e-4, 2.5e-4].map(central);
    core::array::from_fn(|k| (64.0 * fine[k] - 20.0 * middle[k] + coarse[k]) / 45.0)
}

const ALL: [ScaledQuantity; 3] = [ScaledQuantity::Weight, ScaledQuantity::Moment, ScaledQuantity::Velocity];

#[test]
fn of_a_trajectory() {
    for scaled in ALL {
        let dual = outcome(scaled, Dual64::from(1.0).derivative());
        let (plain, expected) = (outcome(scaled, 1.0), differences(scaled));
        let size = expected.iter().fold(0.0, |size: f64, entry| size.max(entry.abs()));
        assert!(size > 1.0, "{scaled:?} matters: {size}");
        for k in 0..15 {
            let (value, derivative) = (dual[k].re, dual[k].eps);
            assert!((value - plain[k]).abs() < 1e-12, "{scaled:?}, entry {k}: {value} against {}", plain[k]);
            // The bound is the rounding error of the differences, in a motion that amplifies initial errors.
            let error = (derivative - expected[k]).abs();
            assert!(error < 1e-10 * size, "{scaled:?}, entry {k}: {derivative} against {}", expected[k]);
        }
    }
}

/// Newton's iteration converges by the values, but the derivative of the momentum equation is solved to rounding too.
#[test]
fn of_one_solve() {
    for scaled in ALL {
        let (stepper, mut state) = start(scaled, Dual64::from(1.0).derivative());
        for _ in 0..STEPS {
            // The guess is zero, or a number without a derivative.
            let (momentum, vertical) = (state.momentum(), state.advected());
            let cold = stepper.flow().step(&momentum, &vertical, &Vector3::zeros()).unwrap();
            let constant = cold.coordinates.map(|entry| Dual64::from(entry.re * (1.0 + 1e-4)));
            let warm = stepper.flow().step(&momentum, &vertical, &constant).unwrap();
            for step in [cold, warm] {
                let f = step.element().matrix();
                let solved = stepper.scene().legendre_minus(&f, &vertical, STEP.into());
                let residual = (solved - momentum).map(|entry| entry.eps).norm();
                let size = momentum.map(|entry| entry.re).norm() + momentum.map(|entry| entry.eps).norm();
                assert!(residual < 1e-14 * size, "{scaled:?}: {residual:e} of {size}");
            }
            stepper.step(&mut state).unwrap();
        }
    }
}
