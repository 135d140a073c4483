//! A million steps of 10⁻⁸ s lose no more than rounding in the momentum: `F ≈ I` is never formed, its increment is.

use declarations::Motion;
use liestep::Stepper;
use liestep::groups::LieGroup as _;
use nalgebra::Vector3;
use workbench::heavy_top::continuous::{phase, solution};
use workbench::measure::relative;

#[test]
fn t4_a_million_steps_of_ten_nanoseconds() {
    let motion = Motion::looping();
    let stepper = Stepper::new(motion.top.clone(), 1e-8).unwrap();
    let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
    let start = phase(&state.momentum(), &state.advected());
    for _ in 0..1_000_000 {
        stepper.step(&mut state).unwrap();
    }
    // Runge and Kutta's error over 200 steps of 0.0006 rad is about 10⁻¹⁶ of the turn of 0.12 rad; the scheme's own is
    // `(hΩ)²/6` of it, 3·10⁻¹⁶.
    let expected = solution(&motion.top, start, 0.01, 200);
    let momentum: Vector3<f64> = expected.fixed_rows::<3>(0).into();
    let w: Vector3<f64> = expected.fixed_rows::<3>(3).into();
    let errors = [
        relative(&state.momentum(), &momentum),
        relative(&state.advected(), &w),
        relative(&state.attitude().matrix().row(2).transpose(), &w),
    ];
    println!("{errors:?}");
    // An increment of 10⁻⁷ is rounded to 10⁻²³; only adding it loses half a unit of the sum, at random.
    assert!(errors[0] < 1e-14, "{:e}", errors[0]);
    // A million roundings of numbers of size one, at random.
    assert!(errors[1] < 1e-13 && errors[2] < 1e-13, "{errors:?}");
}
