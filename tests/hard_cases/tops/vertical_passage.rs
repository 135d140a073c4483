//! Straight up and straight down, where Euler angles are undefined, are attitudes like any other: a top that passes
//! through them does so without more iterations, with the accuracy of the scheme, and keeping its invariants.

use declarations::HeavyTop;
use liestep::{SO3, State, Stepper};
use nalgebra::{UnitQuaternion, Vector3};
use workbench::heavy_top::continuous::{phase, solution};
use workbench::measure::{four_halvings, order, relative, steps_in};

/// How near to the vertical the axis comes.
const MISS: f64 = 5e-7;
/// Its rate there, and a spin.
const VELOCITY: Vector3<f64> = Vector3::new(1.0, 0.3, 2.0);

/// The top at its passage. `vertical` is 1 for straight up, −1 for straight down.
fn at_passage(stepper: &Stepper<HeavyTop>, vertical: f64) -> State<SO3, Vector3<f64>> {
    let down = if vertical < 0.0 { core::f64::consts::PI } else { 0.0 };
    // The miss is across the motion.
    let across = VELOCITY.xy().normalize();
    let miss = UnitQuaternion::from_scaled_axis(Vector3::new(-across.y, across.x, 0.0) * MISS);
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::x() * down) * miss;
    stepper.start(attitude, VELOCITY).unwrap()
}

/// Passes at `t = 0`, coming from `t = −1`, and returns the error at `t = 1`.
fn pass(vertical: f64, h: f64) -> f64 {
    let top = HeavyTop::thesis();
    let [forth, back] = [h, -h].map(|h| Stepper::new(top.clone(), h).unwrap());
    let mut state = at_passage(&forth, vertical);
    let expected = solution(&top, phase(&state.momentum(), &state.advected()), 1.0, 4000);
    let steps = steps_in(1.0, h);
    for _ in 0..steps {
        back.step(&mut state).unwrap();
    }

    let casimir = state.momentum().dot(&state.advected());
    let mut nearest = f64::INFINITY;
    // The most iterations and the largest change of the energy in a step, elsewhere and at the passage.
    let mut most = [0, 0];
    let mut change = [0.0_f64, 0.0];
    // The first step starts from the guess of a step back.
    forth.step(&mut state).unwrap();
    for step in 2..=2 * steps {
        let energy = forth.energy(&state);
        let iterations = forth.step(&mut state).unwrap().iterations;
        let place = usize::from(step.abs_diff(steps) < 3);
        most[place] = most[place].max(iterations);
        change[place] = change[place].max((forth.energy(&state) - energy).abs());
        nearest = nearest.min(state.advected().xy().norm());
        // Less than a rounding in each of up to 3200 steps, at random.
        assert!((state.advected().norm() - 1.0).abs() < 1e-13);
        assert!((state.momentum().dot(&state.advected()) - casimir).abs() < 1e-12);
    }
    println!("h = {h}: nearest {nearest:.1e}, iterations {most:?}, energy steps {change:?}");
    // The way back and forth loses some roundings, far less than a thousandth of the miss.
    assert!(nearest < 1e-6 && (nearest - MISS).abs() < 1e-9);
    assert!(most[1] <= most[0] && most[0] <= 4, "{most:?}");
    assert!(change[1] <= change[0], "{change:?}");
    assert!(state.orthogonality_defect() < 1e-13);
    relative(&phase(&state.momentum(), &state.advected()), &expected)
}

fn assert_passes(vertical: f64) {
    let errors = four_halvings(0.01).map(|h| (h, pass(vertical, h)));
    let order = order(&errors, 1e-11);
    println!("order {order:.4}, {errors:?}");
    assert!((order - 2.0).abs() < 0.05, "{errors:?}");
}

#[test]
fn t6_straight_up() {
    assert_passes(1.0);
}

#[test]
fn t6_straight_down() {
    assert_passes(-1.0);
}
