//! The continuous heavy top, for references that aren't in files.

use liestep::mechanics::ContinuousLagrangian as _;
use nalgebra::{SVector, Vector3};

use super::declaration::HeavyTop;
use crate::runge_kutta::change;

/// The body momentum and `w`, one below the other.
pub type Phase = SVector<f64, 6>;

pub fn phase(momentum: &Vector3<f64>, w: &Vector3<f64>) -> Phase {
    Phase::from_fn(|i, _| if i < 3 { momentum[i] } else { w[i - 3] })
}

/// The Lie–Poisson equations of the declared top's limit.
fn rate(top: &HeavyTop, z: &Phase) -> Phase {
    let (momentum, w) = (z.fixed_rows::<3>(0).into(), z.fixed_rows::<3>(3).into());
    let (torque, turn) = top.lie_poisson(&momentum, &w).expect("a regular inertia");
    phase(&torque, &turn)
}

/// The solution after the time `t`, by the classical Runge–Kutta method with compensated sums.
pub fn solution(top: &HeavyTop, start: Phase, t: f64, steps: u32) -> Phase {
    let h = t / f64::from(steps);
    let (mut z, mut lost) = (start, Phase::zeros());
    for _ in 0..steps {
        let change = change(z, h, |z| rate(top, &z)) + lost;
        let next = z + change;
        lost = change - (next - z);
        z = next;
    }
    z
}
