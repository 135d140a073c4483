//! A chain of three links over a million steps and more.

use checks::drift::tenths;
use declarations::motions::{chain3, start3};

/// Checks a hundred thousand stretches of `stretch` steps: the energy stays within its bounds, its means over the two
/// halves differ by at most `of_halves`, and the momentum changes only by rounding. The motion is chaotic, and its
/// largest energy error depends on rounding, so that bound has a margin.
fn assert_bounded(stretch: u64, [of_momentum, of_halves]: [f64; 2]) {
    let (attitudes, velocities) = start3();
    let stepper = chain3().stepper(0.01).unwrap();
    let mut state = stepper.start(attitudes, velocities).unwrap();
    let (energy, vertical) = (stepper.energy(&state), stepper.vertical_momentum(&state));
    let mut moved = 0.0_f64;
    let (means, most) = tenths(|| {
        stepper.run(&mut state, stretch).unwrap();
        moved = moved.max((stepper.vertical_momentum(&state) - vertical).abs());
        stepper.energy(&state) - energy
    });
    let [first, second] = [&means[..5], &means[5..]].map(|half| half.iter().sum::<f64>() / 5.0);
    println!("energy {energy}: within {most:.4}; means of tenths {means:.5?}; momentum {moved:.1e}");
    assert!(most < 0.05 && (first - second).abs() < of_halves, "{most} {means:?}");
    assert!(means.iter().all(|mean| (mean - means[0]).abs() < 2e-3), "{means:?}");
    assert!(moved < of_momentum, "{moved:e}");
}

/// The duration is three hours of motion.
#[test]
fn energy_and_momentum_of_a_million_steps() {
    assert_bounded(10, [1e-12, 7e-4]);
}

/// The duration is eight hours and twenty minutes.
#[test]
#[ignore = "takes a minute: `cargo test -p liestep-accuracy-tests three_million_steps -- --ignored --nocapture`"]
fn three_million_steps() {
    assert_bounded(30, [2e-12, 4e-3]);
}
