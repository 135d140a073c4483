//! What a Newton iteration that stops too early costs: the energy drifts, and so does every momentum that only the
//! solution conserves. The Casimirs `|w|²` and `p·w` don't tell, as the transport form keeps them for any `F`.
//!
//! The step is made here of the terms of a declared Lagrangian, so that it may stop where it shouldn't.

use declarations::HeavyTop;
use declarations::Motion;
use liestep::groups::{CayleyRetraction, LieGroup as _, Retraction};
use liestep::mechanics::Effect;
use liestep::numbers::Coordinates as _;
use liestep::{SO3, Stepper};
use nalgebra::Vector3;

const STEPS: u64 = 1_000_000;
const H: f64 = 0.01;
/// Far more than any of the tolerances needs.
const MOST_ITERATIONS: u32 = 20;

/// The state of a step of (3.13) that stops at a tolerance of its own.
struct Loose {
    constants: <HeavyTop as Effect>::Constants,
    tolerance: f64,
    momentum: Vector3<f64>,
    w: Vector3<f64>,
    half: Vector3<f64>,
    iterations: u64,
}

impl Loose {
    /// From the solution of the step before, until an update is smaller than that part of the unknown.
    fn step(&mut self) {
        let a = self.momentum + HeavyTop::kick_before(&self.constants, &self.w);
        let terms = HeavyTop::step_terms(&self.constants, &a, &self.w);
        for _ in 0..MOST_ITERATIONS {
            let (residual, jacobian) = HeavyTop::newton_system(&self.constants, &terms, &self.half);
            let (update, _) = Vector3::solve(&jacobian, &residual);
            self.half -= update;
            self.iterations += 1;
            if update.norm() <= self.tolerance * self.half.norm() {
                break;
            }
        }
        let increment = <CayleyRetraction as Retraction<SO3>>::increment_of_half(&self.half);
        let next = self.w + increment.transpose() * self.w;
        let kick = HeavyTop::kick_after(&self.constants, &increment, &next);
        self.momentum += (a - self.momentum) + SO3::adjoint_transpose_increment(&increment, &a) + kick;
        self.w = next;
    }
}

/// Of a million steps: the mean energy of the last tenth less that of the first, relative to the energy; the largest
/// changes of `p_3` and of `p·w`, relative as well.
#[derive(Debug)]
struct Kept {
    energy: f64,
    axial: f64,
    casimir: f64,
}

/// `next` makes a step and returns momentum and `w`.
#[allow(clippy::cast_precision_loss)] // a million
fn kept(stepper: &Stepper<HeavyTop>, mut next: impl FnMut() -> (Vector3<f64>, Vector3<f64>)) -> Kept {
    let inertia = stepper.scene().inertia();
    let energy = |p: &Vector3<f64>, w: &Vector3<f64>| {
        0.5 * p.dot(&p.component_div(&inertia.diagonal())) + stepper.scene().potential(w)
    };
    let (first, window) = (next(), STEPS / 10);
    let start = energy(&first.0, &first.1);
    let (mut means, mut weights) = ([0.0; 2], 0.0);
    let mut kept = Kept { energy: 0.0, axial: 0.0, casimir: 0.0 };
    for step in 0..STEPS {
        let (p, w) = next();
        // Weighted by `sin²`, so that the oscillations which the ends of the windows cut don't count.
        let weight = (core::f64::consts::PI * (step % window) as f64 / window as f64).sin().powi(2);
        if step < window {
            weights += weight;
            means[0] += weight * (energy(&p, &w) - start);
        } else if step >= STEPS - window {
            means[1] += weight * (energy(&p, &w) - start);
        }
        kept.axial = kept.axial.max((p.z / first.0.z - 1.0).abs());
        kept.casimir = kept.casimir.max((p.dot(&w) / first.0.dot(&first.1) - 1.0).abs());
    }
    kept.energy = (means[1] - means[0]) / (weights * start);
    kept
}

#[test]
#[allow(clippy::cast_precision_loss)] // a million
fn p4_energy_drift_against_the_newton_tolerance() {
    let motion = Motion::looping();
    let stepper = Stepper::new(motion.top.clone(), H).unwrap();
    let start = stepper.start(motion.attitude, motion.velocity).unwrap();
    println!("tolerance  iterations  energy drift       p_3        p·w");
    let mut rows = Vec::new();
    for tolerance in [1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-12] {
        let mut loose = Loose {
            constants: motion.top.constants(H),
            tolerance,
            momentum: start.momentum(),
            w: start.advected(),
            half: motion.velocity * (0.5 * H),
            iterations: 0,
        };
        let kept = kept(&stepper, || {
            loose.step();
            (loose.momentum, loose.w)
        });
        let iterations = loose.iterations as f64 / STEPS as f64;
        println!("{tolerance:9.0e} {iterations:11.2} {:13.1e} {:9.1e} {:10.1e}", kept.energy, kept.axial, kept.casimir);
        rows.push(kept);
    }
    let mut state = start;
    let mut iterations = 0_u64;
    let default = kept(&stepper, || {
        iterations += u64::from(stepper.step(&mut state).unwrap().iterations);
        (state.momentum(), state.advected())
    });
    let iterations = iterations as f64 / STEPS as f64;
    println!("  default {iterations:11.2} {:13.1e} {:9.1e} {:10.1e}", default.energy, default.axial, default.casimir);

    // At the default nothing but rounding is left, and no tolerance does better.
    assert!(default.energy.abs() < 1e-11 && default.axial == 0.0 && default.casimir < 1e-12, "{default:?}");
    // One iteration a step: the drift is there, and the Casimirs hide it.
    assert!(rows[0].energy.abs() > 1e-7 && rows[0].axial > 1e-7 && rows[0].casimir < 1e-12, "{:?}", rows[0]);
}
