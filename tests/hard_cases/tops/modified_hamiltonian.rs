//! Backward error analysis of (3.13): the step conserves, up to an oscillation of fourth order,
//!
//! ```text
//! H + h² [ ((Ω·JΩ)|Ω|² − γ·J⁻¹γ)/24 + V̈/12 − τ·J⁻¹τ/24 ],      γ = Ω × JΩ,   τ = m g w × ρ,
//! V̈ = m g [ (w × Ω) × Ω + w × J⁻¹(JΩ × Ω) ]·ρ
//! ```
//!
//! while `H` itself oscillates at second order. A wrong sign or factor anywhere in the step, or in this, leaves the
//! order at two.

use declarations::HeavyTop;
use declarations::Motion;
use liestep::Stepper;
use nalgebra::Vector3;
use workbench::measure::{four_halvings, order, steps_in};

/// The bracket above, without its `h²`.
fn correction(top: &HeavyTop, velocity: &Vector3<f64>, w: &Vector3<f64>) -> f64 {
    let (j, weight) = (top.moments(), top.m * top.g);
    let momentum = j.component_mul(velocity);
    let gyroscopic = velocity.cross(&momentum);
    let torque = w.cross(&top.rho) * weight;
    let acceleration = w.cross(velocity).cross(velocity) + w.cross(&(-gyroscopic).component_div(&j));
    let kinetic = velocity.dot(&momentum) * velocity.norm_squared() - gyroscopic.dot(&gyroscopic.component_div(&j));
    kinetic / 24.0 + weight * acceleration.dot(&top.rho) / 12.0 - torque.dot(&torque.component_div(&j)) / 24.0
}

/// Largest less smallest value of `H`, and of `H` with its correction, along ten seconds.
fn oscillations(motion: &Motion, h: f64) -> (f64, f64) {
    let stepper = Stepper::new(motion.top.clone(), h).unwrap();
    let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
    let mut range = [(f64::INFINITY, f64::NEG_INFINITY); 2];
    for _ in 0..steps_in(10.0, h) {
        stepper.step(&mut state).unwrap();
        let energy = stepper.energy(&state);
        let corrected = energy + h * h * correction(&motion.top, &stepper.velocity(&state), &state.advected());
        for (range, value) in range.iter_mut().zip([energy, corrected]) {
            *range = (range.0.min(value), range.1.max(value));
        }
    }
    (range[0].1 - range[0].0, range[1].1 - range[1].0)
}

fn assert_orders_two_and_four(motion: &Motion, coarsest: f64) {
    let measured = four_halvings(coarsest).map(|h| (h, oscillations(motion, h)));
    // Rounding of a sum of about 300 J over some thousand steps.
    let plateau = 1e-11;
    let plain = order(&measured.map(|(h, range)| (h, range.0)), plateau);
    let corrected = order(&measured.map(|(h, range)| (h, range.1)), plateau);
    println!("orders {plain:.4} and {corrected:.4}; {measured:?}");
    assert!((plain - 2.0).abs() < 0.1, "H: order {plain}, {measured:?}");
    assert!((corrected - 4.0).abs() < 0.1, "corrected H: order {corrected}, {measured:?}");
}

#[test]
fn t2_looping_top() {
    assert_orders_two_and_four(&Motion::looping(), 0.01);
}

/// Every term of the correction takes part only without symmetry.
#[test]
fn t2_asymmetric_top() {
    let mut motion = Motion::looping();
    motion.top = HeavyTop::asymmetric();
    assert_orders_two_and_four(&motion, 0.005);
}
