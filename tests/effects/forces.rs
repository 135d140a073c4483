//! Forces by the discrete Lagrange–d'Alembert principle: the terms derived from their virtual work, and their effects.

use checks::structure::forces::assert_stages;
use declarations::{FluidDrag, Thruster};
use liestep::effects::{AirDrag, Drag, MagneticDamping, Thrust, Torque};
use liestep::groups::{SE2, SL2};
use liestep::laws::samples;
use liestep::mechanics::Regular;
use liestep::methods::CompositionScheme;
use liestep::{SO3, Stepper, force};
use nalgebra::{Matrix2, Matrix3, Point2, Vector2, Vector3};
use workbench::measure::relative;

use super::{body, gravity, moved, started};

/// A force without a physical meaning, different at both ends of a step, with terms of all kinds.
#[force(
    group = SO3,
    advected(w = up),
    work = h * k * w.cross(&rho).dot(&eta)
        - c * (A * vee(F)).dot(&eta)
        + h * w.dot(&(F * rho)) * rho.dot(&eta)
        - 3.0 * h * c * vee(F * A).dot(&eta_next)
        + h * k * (F.transpose() * w).cross(&rho).dot(&eta_next),
)]
struct Push {
    k: f64,
    c: f64,
    A: Matrix3<f64>,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

/// Stages of forces of every kind agree with their virtual work, at random increments.
#[test]
fn stages_follow_from_the_virtual_work() {
    let mut r = samples::Random::new(7);
    for _ in 0..10 {
        let J = body().J_d.to_inertia();
        assert_stages(&Drag { c: 1.0 + r.signed(), J }, &mut r);
        assert_stages(&AirDrag { c: 1.0 + r.signed(), air: r.sample(), J }, &mut r);
        assert_stages(&Torque { torque: r.sample() }, &mut r);
        assert_stages(&Thrust { at: r.sample(), thrust: r.sample() }, &mut r);
        assert_stages(&MagneticDamping { k: 1.0 + r.signed(), field: r.sample(), J }, &mut r);
        let push = Push { k: r.signed(), c: r.signed(), A: r.sample(), rho: r.sample(), up: r.sample() };
        assert_stages(&push, &mut r);
        assert_stages(&Thruster { at: r.sample::<Vector3<f64>>().into(), thrust: r.sample() }, &mut r);
        assert_stages(&FluidDrag { C: r.sample() }, &mut r);
        assert_stages(&Shear { k: r.sample(), s: r.sample(), A: r.sample(), line: r.sample() }, &mut r);
        assert_stages(&Pull { u: r.sample(), c: r.signed(), point: r.sample::<Vector2<f64>>().into() }, &mut r);
    }
}

/// A force on a group with generators that aren't orthogonal to each other, with a prescribed matrix.
#[force(
    group = SL2,
    advected(w = line),
    given(K = k),
    work = h * w.dot(&(hat(eta) * (F * w))) - h * (A * hat(eta_next) * F).trace() + h * s.dot(&(K * (eta + eta_next))),
)]
struct Shear {
    k: Matrix3<f64>,
    s: Vector3<f64>,
    A: Matrix2<f64>,
    line: Vector2<f64>,
}

/// A force on the plane towards a point, with a weight for each displacement.
#[force(
    group = SE2,
    advected(p = point),
    given(v = u),
    work = h * v.dot(&eta) - c * h * p.dot(&(hat(eta_next) * p)) * F[(0, 2)] + v.norm_squared() * h * eta_next[2],
)]
struct Pull {
    u: Vector3<f64>,
    c: f64,
    point: Point2<f64>,
}

/// A constant torque about a principal axis increases the momentum by `h τ` a step, and by nothing else.
#[test]
fn a_constant_torque_adds_its_impulse() {
    let stepper = Stepper::new(body() + Torque { torque: Vector3::new(0.0, 0.0, 0.25) }, 0.0625).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::zeros()).unwrap();
    for step in 1..=1000 {
        stepper.step(&mut state).unwrap();
        assert_eq!(state.momentum(), Vector3::new(0.0, 0.0, 0.25 * 0.0625 * f64::from(step)));
    }
}

/// A heavy body with drag, damping in a field and a torque.
fn braked() -> impl Regular<Scalar = f64, Group = SO3, Advected: Copy> + Clone {
    let (drag, torque) = (Drag { c: 0.7, J: body().J_d.to_inertia() }, Vector3::new(0.3, -0.2, 0.1));
    let damping = MagneticDamping { k: 1.5, field: Vector3::new(0.5, -0.7, 0.6), J: drag.J };
    let air = AirDrag { c: 0.4, air: Vector3::new(0.2, 0.5, -0.3), J: drag.J };
    let thrust = Thrust { at: Vector3::x(), thrust: Vector3::new(0.1, 0.2, 0.3) };
    body() + gravity() + drag + Torque { torque } + damping + air + thrust
}

/// The own step of a body with all forces is of second order, compared with a fine step.
#[test]
fn forces_keep_the_order() {
    let at_one = |steps: u32| moved(braked(), 1.0 / f64::from(steps), steps.into()).momentum();
    let truth = at_one(20_000);
    let [coarse, fine] = [100, 200].map(|steps| relative(&at_one(steps), &truth));
    println!("{coarse:e} {fine:e}");
    assert!((coarse / fine - 4.0).abs() < 0.1, "{coarse:e} {fine:e}");
}

/// Compositions of a step with forces have their own orders, and a step of `−h` undoes one of `h`.
#[test]
fn forces_are_composed() {
    let at_one = |scheme, steps: u32| {
        let stepper = Stepper::composed(braked(), 1.0 / f64::from(steps), scheme).unwrap();
        let mut state = stepper.adopt(&started(braked(), 1.0).1);
        stepper.run(&mut state, steps.into()).unwrap();
        state.momentum()
    };
    let truth = at_one(CompositionScheme::KAHAN_LI_8, 400);
    for (scheme, order, steps) in [(CompositionScheme::SUZUKI_4, 4.0, 25), (CompositionScheme::KAHAN_LI_6, 6.0, 20)] {
        let [coarse, fine] = [steps, 2 * steps].map(|steps| relative(&at_one(scheme, steps), &truth));
        println!("{coarse:e} {fine:e}");
        assert!(((coarse / fine).log2() - order).abs() < 0.15, "{order}: {coarse:e} {fine:e}");
    }
    let (forwards, mut state) = started(braked(), 0.05);
    let (backwards, before) = (Stepper::new(braked(), -0.05).unwrap(), state.momentum());
    forwards.run(&mut state, 40).unwrap();
    assert!(relative(&state.momentum(), &before) > 0.1);
    let mut state = backwards.adopt(&state);
    backwards.run(&mut state, 40).unwrap();
    let apart = relative(&state.momentum(), &before);
    assert!(apart < 1e-12, "{apart:e}");
}
