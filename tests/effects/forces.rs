//! Forces by the discrete Lagrange–d'Alembert principle: what is derived from their virtual work, and what they do.

use declarations::{FluidDrag, Thruster};
use liestep::effects::{Drag, Gravity, MagneticDamping, RigidBody, Thrust, Torque};
use liestep::groups::{Advected as _, LieGroup as _, Retraction as _, SE2, SL2};

use liestep::laws::samples::{self, MatrixLieGroup, along, derivative};
use liestep::mechanics::Force;
use liestep::numbers::Coordinates;
use liestep::{NonstandardInertia, SO3, Stepper, force};
use nalgebra::{Matrix2, Matrix3, Point2, SMatrix, SVector, Vector2, Vector3};
use workbench::measure::relative;

/// A force of no physics, different at both ends, with terms of all kinds.
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

/// `f⁻` and `f⁺` by their components.
fn forces<E, const N: usize, const D: usize>(
    push: &E,
    f: &SMatrix<f64, N, N>,
    w: &E::Advected,
    h: f64,
) -> [SVector<f64, D>; 2]
where
    E: Force<Scalar = f64, Group: MatrixLieGroup<N, D>>,
{
    let zero = SVector::zeros();
    let unit = |k| SVector::from_fn(|i, _| f64::from(u8::from(i == k)));
    let before = SVector::from_fn(|k, _| push.virtual_work(f, w, h, &unit(k), &zero));
    [before, SVector::from_fn(|k, _| push.virtual_work(f, w, h, &zero, &unit(k)))]
}

/// The stages against the declared virtual work, at random increments.
fn check<E, const N: usize, const D: usize>(push: &E, r: &mut samples::Random)
where
    E: Force<Scalar = f64, Group: MatrixLieGroup<N, D>>,
    SVector<f64, D>: Coordinates<f64, Square = SMatrix<f64, D, D>>,
{
    let (h, half) = (0.1, r.sample::<SVector<f64, D>>() * 0.4);
    let element = E::Retraction::retract(&(half * 2.0));
    let f = element.matrix();
    let w = push.advected().seen_from(&along::<E::Group, N, D>(&r.sample(), 1.0));
    let constants = push.constants(h);
    let [before, after] = forces(push, &f, &w, h);
    let kick = E::kick_before(&constants, &w);
    // U = −(f⁻ − kick_before), and newton_system is a multiple of U − a.
    let a: SVector<f64, D> = r.sample();
    let terms = E::step_terms(&constants, &a, &w);
    let (residual, jacobian) = E::newton_system(&constants, &terms, &half);
    let factor = 0.5 * h * (1.0 + half.norm_squared()).powi(E::DENOMINATORS.cast_signed());
    assert!((residual - (kick - before - a) * factor).norm() < 1e-13 * factor * (1.0 + before.norm()));
    for j in 0..D {
        let unit = SVector::<f64, D>::axis(j);
        let slope = derivative(|s| E::newton_system(&constants, &terms, &(half + unit * s)).0);
        assert!((jacobian.column(j) - slope).norm() < 1e-9 * (1.0 + slope.norm()));
        let turned = |s: f64| along::<E::Group, N, D>(&unit, s).compose(&element).matrix();
        let slope = derivative(|s| -forces::<E, N, D>(push, &turned(s), &w, h)[0]);
        assert!((push.momentum_jacobian(&f, &w, h).column(j) - slope).norm() < 1e-9 * (1.0 + slope.norm()));
    }
    let next = w.advect(&element.increment());
    let expected = element.adjoint_transpose(&(before - kick)) + after;
    assert!(
        (E::kick_after(&constants, &element.increment(), &next) - expected).norm() < 1e-13 * (1.0 + expected.norm())
    );
}

#[test]
fn stages_follow_from_the_virtual_work() {
    let mut r = samples::Random::new(7);
    for _ in 0..10 {
        let J = body().J_d.to_inertia();
        check(&Drag { c: 1.0 + r.signed(), J }, &mut r);
        check(&Torque { torque: r.sample() }, &mut r);
        check(&Thrust { at: r.sample(), thrust: r.sample() }, &mut r);
        check(&MagneticDamping { k: 1.0 + r.signed(), field: r.sample(), J }, &mut r);
        let push = Push { k: r.signed(), c: r.signed(), A: r.sample(), rho: r.sample(), up: r.sample() };
        check(&push, &mut r);
        check(&Thruster { at: r.sample::<Vector3<f64>>().into(), thrust: r.sample() }, &mut r);
        check(&FluidDrag { C: r.sample() }, &mut r);
        check(&Shear { k: r.sample(), s: r.sample(), A: r.sample(), line: r.sample() }, &mut r);
        check(&Pull { u: r.sample(), c: r.signed(), point: r.sample::<Vector2<f64>>().into() }, &mut r);
    }
}

/// On a group with generators that aren't orthogonal to each other, with a matrix that is given.
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

/// On the plane, towards a point, with a weight for each displacement.
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

fn body() -> RigidBody {
    RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).unwrap() }
}

/// About a principal axis the momentum of a constant torque grows by `h τ` a step, and by nothing else.
#[test]
fn a_constant_torque_adds_its_impulse() {
    let stepper = Stepper::new(body() + Torque { torque: Vector3::new(0.0, 0.0, 0.25) }, 0.0625).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::zeros()).unwrap();
    for step in 1..=1000 {
        stepper.step(&mut state).unwrap();
        assert_eq!(state.momentum(), Vector3::new(0.0, 0.0, 0.25 * 0.0625 * f64::from(step)));
    }
}

/// A heavy body with drag, a torque and the rest, against a fine step: second order.
#[test]
fn forces_keep_the_order() {
    let scene = || {
        let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.3, 0.2, 0.4), up: Vector3::z() };
        body() + gravity + Drag { c: 0.7, J: body().J_d.to_inertia() } + Torque { torque: Vector3::new(0.3, -0.2, 0.1) }
    };
    let at_one = |steps: u32| {
        let stepper = Stepper::new(scene(), 1.0 / f64::from(steps)).unwrap();
        let mut state = stepper.start(SO3::identity(), Vector3::new(0.5, 1.0, 3.0)).unwrap();
        for _ in 0..steps {
            stepper.step(&mut state).unwrap();
        }
        state.momentum()
    };
    let truth = at_one(20_000);
    let [coarse, fine] = [100, 200].map(|steps| relative(&at_one(steps), &truth));
    println!("{coarse:e} {fine:e}");
    assert!((coarse / fine - 4.0).abs() < 0.1, "{coarse:e} {fine:e}");
}
