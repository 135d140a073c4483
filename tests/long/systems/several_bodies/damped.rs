//! Chains with friction in their joints: the energy is lost, whatever the friction and the step.

use declarations::FallingBody;
use liestep::effects::joints::JointDamping;
use liestep::groups::R3;
use liestep::methods::{Joint, Multibody};
use liestep::{NonstandardInertia, SO3};
use nalgebra::Vector3;

use super::{Body, six};

/// The number of links.
const LINKS: u8 = 20;
/// The moment of inertia of a link across it, kg m².
const MOMENT: f64 = 0.1;
/// The step, s.
const STEP: f64 = 0.01;

/// Means of the energy over a tenth of the steps each, and the largest excess over its start, of links that hang on a ball joint
/// and turn about all axes. The friction of each joint is `c = x J/h`.
fn tenths(x: f64, steps: u32) -> (Vec<f64>, f64) {
    let mut system = Multibody::new();
    let half = Vector3::z() * -0.5;
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(MOMENT, MOMENT, 0.02)).unwrap();
    for k in 0..usize::from(LINKS) {
        let body = system.body(FallingBody { m: 1.0, J_d, g: 9.81, up: Vector3::z() });
        let before = k.checked_sub(1);
        let above = before.map_or(Vector3::zeros(), |_| half);
        system.join(Joint::ball([above, -half]), before, body);
        if x > 0.0 {
            system.between([before, Some(body)], JointDamping { c: x * MOMENT / STEP });
        }
    }
    let stepper = system.stepper(STEP).unwrap();
    let row: Vec<Body> = (0..LINKS).map(|k| (SO3::identity(), R3::from(half * (1.0 + 2.0 * f64::from(k))))).collect();
    let turning =
        |k: u8| Vector3::new((f64::from(k) * 1.3).sin(), (f64::from(k) * 0.7).cos(), 0.5 - 0.05 * f64::from(k));
    let velocities: Vec<_> = (0..LINKS).map(|k| six(&turning(k), &Vector3::zeros())).collect();
    let mut state = stepper.start_nearest(&row, &velocities).unwrap();
    let start = stepper.energy(&state);
    let (mut means, mut above) = (Vec::new(), 0.0_f64);
    for _ in 0..10 {
        let mut sum = 0.0;
        for _ in 0..steps / 10 {
            stepper.step(&mut state).unwrap_or_else(|error| panic!("x = {x:e}: {error}"));
            let energy = stepper.energy(&state);
            above = above.max(energy - start);
            sum += energy;
        }
        means.push(sum / f64::from(steps / 10));
    }
    (means, above)
}

/// Means of tenths fall, and the energy is above its start by no more than without friction.
fn assert_falls(steps: u32) {
    let (_, band) = tenths(0.0, steps.min(2000));
    for x in [1e-3, 1e-1, 1.0, 1e1, 1e3] {
        let (means, above) = tenths(x, steps);
        println!("{x:e}: {means:?}, above the start by {above:e} (without friction {band:e})");
        // At rest the energy changes by rounding alone.
        let rounding = 1e-12 * means[0].abs();
        assert!(means.windows(2).all(|pair| pair[1] < pair[0] + rounding), "{x:e}: {means:?}");
        assert!(means[9] < means[0] && above <= band, "{x:e}: {above:e}");
    }
}

#[test]
fn a_chain_of_twenty_with_friction() {
    assert_falls(1000);
}

#[test]
#[ignore = "takes ten minutes: `cargo test --release -p liestep-long-tests --test systems chain_of_twenty -- --ignored`"]
fn a_chain_of_twenty_with_friction_for_a_million_steps() {
    assert_falls(1_000_000);
}
