//! The flow on increments (2.5) and the flow on momenta (2.8) are one, seen through the Legendre transforms: with
//! `μ_i = 𝔽l_d⁻(f_i, w_i)` both give the same `f_i` and `w_i`, and (2.10) the same attitudes.

use declarations::Motion;
use declarations::{FreeBody, FullTop, HeavyTop};
use liestep::groups::LieGroup as _;
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::motion::{DiscreteEulerPoincare, DiscreteLiePoisson, reconstruct};
use liestep::{SO3, Stepper};
use nalgebra::Vector3;
use workbench::measure::relative;

const STEPS: u32 = 1000;

/// The flow on increments takes `μ` from `F` itself and so rounds it to `ε J/h`, relatively `ε/(hΩ)`, in every step.
/// Such errors walk to `√n ε/(hΩ)` in the rate and to `n^{3/2} ε` in the angle after `n` steps, for any `h`.
fn rounding_after(steps: u32) -> f64 {
    4.0 * f64::from(steps).powf(1.5) * f64::EPSILON
}

fn assert_flows_agree<L>(lagrangian: &L, h: f64)
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular + Clone,
{
    let motion = Motion::looping();
    let stepper = Stepper::new(lagrangian.clone(), h).unwrap();
    let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
    let (mut attitude, mut w) = (state.attitude(), state.advected());
    let on_momenta = DiscreteLiePoisson::new(lagrangian.clone(), h).unwrap();
    let mut f = on_momenta.invert_legendre_minus(&state.momentum(), &w, &Vector3::zeros()).unwrap();
    let on_increments = DiscreteEulerPoincare::new(lagrangian.clone(), h).unwrap();
    let mut worst = 0.0_f64;
    for step in 1..=STEPS {
        let before = state.attitude();
        stepper.step(&mut state).unwrap();
        let increment = before.inverse().compose(&state.attitude());
        attitude = reconstruct(&attitude, &f);
        let mut error = relative(&f.matrix(), &increment.matrix());
        error = error.max(relative(&attitude.matrix(), &state.attitude().matrix()));
        (f, w) = on_increments.step(&f, &w).unwrap();
        let momentum = lagrangian.legendre_minus(&f.matrix(), &w, h);
        error = error.max((momentum - state.momentum()).norm() * h / lagrangian.inertia().norm());
        worst = worst.max(error / rounding_after(step));
        assert!(error < rounding_after(step), "step {step}: {error:e}");
    }
    println!("h = {h}: {worst:.2} of what is allowed");
}

#[test]
fn p5_tops() {
    for h in [0.001, 0.01, 0.05] {
        assert_flows_agree(&HeavyTop::thesis(), h);
    }
    let axes = nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1).into_inner();
    assert_flows_agree(&FullTop::in_axes(&HeavyTop::thesis(), &axes), 0.01);
}

#[test]
fn p5_free_bodies() {
    assert_flows_agree(&FreeBody::with_moments([3.0, 3.0, 4.0]), 0.01);
    assert_flows_agree(&FreeBody::with_moments([2.0, 3.0, 4.5]), 0.01);
}
