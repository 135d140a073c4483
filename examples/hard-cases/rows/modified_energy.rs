//! T2: backward error analysis of (3.13).

use declarations::{HeavyTop, Motion};
use nalgebra::Vector3;
use workbench::measure::{four_halvings, order, steps_in};

use crate::rivals::started;
use crate::row::{Effort, Failure, Row};

/// The correction of the energy: a step conserves `H` plus `h²` times this, up to an oscillation of fourth order:
///
/// ```text
/// ((Ω·JΩ)|Ω|² − γ·J⁻¹γ)/24 + V̈/12 − τ·J⁻¹τ/24        γ = Ω × JΩ,  τ = m g w × ρ
/// V̈ = m g [(w × Ω) × Ω + w × J⁻¹(JΩ × Ω)]·ρ
/// ```
fn correction(top: &HeavyTop, velocity: &Vector3<f64>, w: &Vector3<f64>) -> f64 {
    let (j, weight) = (top.moments(), top.m * top.g);
    let momentum = j.component_mul(velocity);
    let gyroscopic = velocity.cross(&momentum);
    let torque = w.cross(&top.rho) * weight;
    let acceleration = w.cross(velocity).cross(velocity) + w.cross(&(-gyroscopic).component_div(&j));
    let kinetic = velocity.dot(&momentum) * velocity.norm_squared() - gyroscopic.dot(&gyroscopic.component_div(&j));
    kinetic / 24.0 + weight * acceleration.dot(&top.rho) / 12.0 - torque.dot(&torque.component_div(&j)) / 24.0
}

/// The ranges of `H`, and of `H` with its correction, along ten seconds.
fn oscillations(motion: &Motion, h: f64) -> Result<(f64, f64), Failure> {
    let (stepper, mut state) = started(motion, h)?;
    let mut range = [(f64::INFINITY, f64::NEG_INFINITY); 2];
    for _ in 0..steps_in(10.0, h) {
        stepper.step(&mut state)?;
        let energy = stepper.energy(&state);
        let corrected = energy + h * h * correction(&motion.top, &stepper.velocity(&state), &state.advected());
        for (range, value) in range.iter_mut().zip([energy, corrected]) {
            *range = (range.0.min(value), range.1.max(value));
        }
    }
    Ok((range[0].1 - range[0].0, range[1].1 - range[1].0))
}

pub(crate) fn t2(_: Effort) -> Result<Row, Failure> {
    let mut row = Row::new("T2", "modified Hamiltonian along 10 s", "its oscillation falls with order 4.0 ± 0.1");
    for motion in [Motion::looping(), Motion::chaotic()] {
        let (mut plain, mut modified) = (Vec::new(), Vec::new());
        for h in four_halvings(0.01) {
            let (energy, corrected) = oscillations(&motion, h)?;
            plain.push((h, energy));
            // The limit is the rounding error of a sum of hundreds of J over thousands of steps.
            if corrected > 1e-11 {
                modified.push((h, corrected));
            }
        }
        row = row
            .near(&format!("{}: order of the modified energy", motion.name), order(&modified, 1e-11), 4.0, 0.1)
            .near(&format!("{}: order of H itself", motion.name), order(&plain, 1e-11), 2.0, 0.1);
    }
    Ok(row)
}
