//! Forces on several bodies: the terms derived from their virtual work, and the effect of a motor on a wheel.

use checks::structure::forces::assert_stages;
use liestep::groups::{Given, LieGroup as _, R1, R3};
use liestep::laws::samples::Random;
use liestep::{SO3, Stepper, force};
use nalgebra::{Matrix3, SVector, Vector3};

use super::part;
use super::translated::gyrostat;

/// A force without a physical meaning: different at both ends, with terms of all kinds.
#[force(
    group(F_1 = SO3, d = R3, F_2 = SO3),
    advected(w = up.seen_from(F_1), Q = F_2.seen_from(F_1), x = d.seen_from(space)),
    displacement(eta_1, s, eta_2),
    given(v = wind),
    work = h * k * w.cross(&rho).dot(&eta_1) - c * (A * vee(F_2)).dot(&eta_2)
        + h * (Q * (F_2 * rho)).dot(&w) * x.dot(&s) + h * k * (Q * rho).dot(&(F_1 * eta_1))
        + (h * v - c * d).dot(&(s + 2.0 * s_next))
        + h * vee(F_1 * A).dot(&eta_1_next)
        + h * (F_2.transpose() * (Q.transpose() * w)).cross(&rho).dot(&eta_2_next)
        - h * (x + d).dot(&(A * (F_2 * eta_2_next))),
)]
struct Push {
    k: f64,
    c: f64,
    A: Matrix3<f64>,
    rho: Vector3<f64>,
    up: Vector3<f64>,
    wind: Vector3<f64>,
}

/// Compares the stages with the declared virtual work, at random increments.
#[test]
fn stages_follow_from_the_virtual_work() {
    let mut r = Random::new(17);
    for _ in 0..10 {
        let push =
            Push { k: r.signed(), c: r.signed(), A: r.sample(), rho: r.sample(), up: r.sample(), wind: r.sample() };
        assert_stages(&push, &mut r);
    }
}

/// A motor between a spacecraft and its first wheel.
#[force(
    group(F = SO3, t_1 = R1, t_2 = R1, t_3 = R1),
    displacement(eta, s_1, s_2, s_3),
    given(u = torque),
    work = 0.5 * h * u * (s_1 + s_1_next),
)]
#[derive(Clone, Debug)]
struct Motor {
    /// The torque on the wheel, N m.
    torque: f64,
}

/// A motor transfers momentum from the body to its wheel: `R Π` is conserved, and the wheel's momentum grows by `h u` a
/// step.
#[test]
fn a_motor_turns_a_wheel() {
    let (h, steps) = (0.01, 500_u32);
    let stepper = Stepper::new(gyrostat() + Motor { torque: 0.3 }, h).unwrap();
    let attitude = (SO3::exp(Vector3::new(0.3, -0.5, 0.2)), R1::identity(), R1::identity(), R1::identity());
    let velocity = SVector::<f64, 6>::from([0.4, 1.1, -0.7, 3.0, -2.0, 5.0]);
    let mut state = stepper.start(attitude, velocity).unwrap();
    let spatial = |attitude: &SO3, momentum: &SVector<f64, 6>| attitude.as_matrix() * part(momentum, 0);
    let (before, start) = (state.momentum(), spatial(&state.attitude().0, &state.momentum()));
    for step in 0..steps {
        // The motor brakes in the last part.
        let torque = if step < 300 { 0.3 } else { -0.2 };
        stepper.step_with(&mut state, &((), Given::scalar(torque))).unwrap();
    }
    let given = h * (300.0 * 0.3 - 200.0 * 0.2);
    let (after, end) = (state.momentum(), spatial(&state.attitude().0, &state.momentum()));
    let errors = [
        (after[3] - before[3] - given).abs(),
        (after[4] - before[4]).abs().max((after[5] - before[5]).abs()),
        (end - start).norm(),
    ];
    println!("{errors:?}, body turns at {}", stepper.velocity(&state));
    assert!(errors.iter().all(|&error| error < 1e-11), "{errors:?}");
}
