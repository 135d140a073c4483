//! Forces on several bodies: what is derived of their virtual work, and what a motor does to a wheel.

use liestep::groups::{Advected, Given, LieGroup as _, R1, R3};
use liestep::laws::samples::{Random, derivative};
use liestep::mechanics::{Effect, Force, Term};
use liestep::{SO3, Stepper, force};
use nalgebra::{Matrix3, SVector, Vector3};

use super::translated::gyrostat;
use super::{element, part};

/// Of no physics: different at both ends, with terms of all kinds.
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

/// The stages against the declared virtual work, at random increments.
#[test]
fn stages_follow_from_the_virtual_work() {
    type Group = <Push as Term>::Group;
    const D: usize = 9;
    let mut r = Random::new(17);
    for _ in 0..10 {
        let push =
            Push { k: r.signed(), c: r.signed(), A: r.sample(), rho: r.sample(), up: r.sample(), wind: r.sample() };
        let (h, half): (f64, SVector<f64, D>) = (0.1, r.sample::<SVector<f64, D>>() * 0.4);
        let at = element::<Group, D>(&(half * 2.0));
        let (f, far) = (at.matrix(), r.sample());
        let w = push.advected().seen_from(&element::<Group, D>(&far));
        let unit = |k: usize, s: f64| SVector::<f64, D>::from_fn(|i, _| if i == k { s } else { 0.0 });
        let works = |f: &_, k: usize| {
            let [along, zero] = [unit(k, 1.0), SVector::zeros()];
            [push.virtual_work(f, &w, h, &along, &zero), push.virtual_work(f, &w, h, &zero, &along)]
        };
        let [before, after] = [0, 1].map(|end| SVector::<f64, D>::from_fn(|k, _| works(&f, k)[end]));
        let constants = push.constants(h);
        let kick = Push::kick_before(&constants, &w);
        // U = −(f⁻ − kick_before), and the system is a multiple of U − a.
        let a: SVector<f64, D> = r.sample();
        let terms = Push::step_terms(&constants, &a, &w);
        let (residual, jacobian) = Push::newton_system(&constants, &terms, &half);
        let expected = (kick - before - a) * (0.5 * h);
        assert!((residual - expected).norm() < 1e-13 * (1.0 + before.norm()), "{residual} {expected}");
        for j in 0..D {
            let slope = derivative(|s| Push::newton_system(&constants, &terms, &(half + unit(j, s))).0);
            assert!((jacobian.column(j) - slope).norm() < 1e-9 * (1.0 + slope.norm()), "column {j}");
            let slope = derivative(|s| {
                let turned = element::<Group, D>(&unit(j, s)).compose(&at).matrix();
                SVector::<f64, D>::from_fn(|k, _| -works(&turned, k)[0])
            });
            let column = push.momentum_jacobian(&f, &w, h).column(j).into_owned();
            assert!((column - slope).norm() < 1e-9 * (1.0 + slope.norm()), "column {j}: {column} {slope}");
        }
        let next = Advected::<Group>::advect(&w, &at.increment());
        let expected = at.adjoint_transpose(&(before - kick)) + after;
        let found = Push::kick_after(&constants, &at.increment(), &next);
        assert!((found - expected).norm() < 1e-13 * (1.0 + expected.norm()), "{found} {expected}");
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
    /// On the wheel, N m.
    torque: f64,
}

/// A motor gives its wheel what it takes from the body: `R Π` is kept, and the wheel's momentum grows by `h u` a step.
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
        // For a while braked.
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
