//! The flow of (3.13) with `μ_0 = JΩ_0` converges to the free body at second order in the step, as to the tops of row T1:
//! its momentum is that of the continuous body at the same time, the half kick being inside (2.7).

use declarations::{FreeBody, Motion};
use liestep::Stepper;
use liestep::accuracy::Refinement;
use workbench::measure::{four_halvings, relative, steps_in};

/// Well above what 10⁵ steps lose to rounding in attitude and velocity.
const PLATEAU: f64 = 1e-11;

/// By `Stepper::step`, and not by the runs of the harness, which the orders of the other declarations are measured with.
fn assert_second_order(name: &str, t: f64, coarsest: f64) {
    let motion = Motion::read(name);
    let (attitude, velocity) = motion.at(t);
    let errors = Refinement::of(four_halvings(coarsest).map(|h| {
        let stepper = Stepper::new(FreeBody { J_d: motion.top.J_d.into() }, h).unwrap();
        let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
        for _ in 0..steps_in(t, h) {
            stepper.step(&mut state).unwrap();
        }
        let error =
            relative(state.attitude().as_matrix(), &attitude).hypot(relative(&stepper.velocity(&state), &velocity));
        (h, error)
    }));
    let order = errors.order_above(PLATEAU).expect(name);
    println!("{name} t = {t}: order {order:.4}\n{errors}");
    assert!((order - 2.0).abs() < 0.05, "order {order}\n{errors}");
}

/// The phase error after `t = 10` is ten times that after `t = 1` at the same step, hence the smaller steps.
fn assert_second_order_at_1_and_10(name: &str) {
    assert_second_order(name, 1.0, 1.0 / 200.0);
    assert_second_order(name, 10.0, 1.0 / 1600.0);
}

#[test]
fn b8_symmetric_free_body() {
    assert_second_order_at_1_and_10("free symmetric");
}

/// The flat body `J_1 + J_2 = J_3` through its flip about the intermediate axis.
#[test]
fn b7_asymmetric_free_body() {
    assert_second_order_at_1_and_10("free flip");
}
