//! The energy of every declared system oscillates by an amount of order `h²`, and doesn't drift.

use checks::structure::System;
use liestep::Stepper;

use checks::samples::{self, Start};

const STEP: f64 = 0.02;

/// The largest distances of the energy from that at the start, one for each of several stretches of a motion.
fn deviations<L: System + Clone, const COUNT: usize>(
    system: &L,
    (attitude, velocity): Start<L::Group>,
    h: f64,
    steps: [u32; COUNT],
) -> [f64; COUNT] {
    let stepper = Stepper::new(system.clone(), h).unwrap();
    let mut state = stepper.start(attitude, velocity).unwrap();
    let start = stepper.energy(&state);
    steps.map(|steps| {
        (0..steps).fold(0.0_f64, |largest, _| {
            stepper.step(&mut state).unwrap();
            largest.max((stepper.energy(&state) - start).abs())
        })
    })
}

fn assert_bounded<L: System + Clone>(system: &L, start: Start<L::Group>) {
    // The run is so short that irregular motions still agree for both steps.
    let [coarse] = deviations(system, start, STEP, [500]);
    let [fine] = deviations(system, start, 0.5 * STEP, [1000]);
    let [early, late] = deviations(system, start, STEP, [10_000, 10_000]);
    println!("{early:.3e} then {late:.3e}; at half the step less by the factor {:.3}", coarse / fine);
    assert!((coarse / fine - 4.0).abs() < 0.05, "{coarse:e} becomes {fine:e} at half the step");
    // A steady drift would double the error. Irregular motions reach new configurations in the second half.
    assert!(late < 1.5 * early, "{early:e} in the first half and {late:e} in the second");
}

macro_rules! bounded {
    ($($system:ident $start:ident)+) => {$(
        #[test]
        fn $system() {
            assert_bounded(&samples::$system(), samples::$start());
        }
    )+};
}

bounded! {
    heavy_top on_so3 full_top on_so3 cayley_top on_so3 satellite on_so3 orbiting_body in_orbit spring on_so3
    sliding_top on_so3 magnet on_so3 tethered_plate on_se2 elastic_flow on_sl2
}

/// The body floats in balance, as a heavier one sinks faster and faster, until a step has no solution.
#[test]
fn underwater_body() {
    let mut body = samples::underwater_body();
    body.weight[3] = 0.0;
    assert_bounded(&body, samples::on_se3());
}
