//! Scenes with parameters that are prescribed for each step.

use declarations::{FluidDrag, Flyer, Thruster, Torquer};
use liestep::effects::{Dipole, GravityGradient, RigidBody};
use liestep::groups::{Given, SE3};
use liestep::laws::samples::Random;
use liestep::mechanics::{Scene, Sum};
use liestep::methods::{CompositionScheme, ExactBody, ProcessedScheme, SplittingScheme, SymmetricBody};
use liestep::motion::Steerable;
use liestep::prelude::*;
use liestep::{StepError, Stepper};
use nalgebra::{Matrix3, Matrix4, Point3, Rotation3, SVector, Vector2, Vector3, Vector4};
use workbench::measure::relative;
use workbench::runge_kutta;

type Values = ((), (Vector3<f64>, Given<f64, 3>));

fn body() -> RigidBody {
    RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.5)).unwrap() }
}

fn torquer((field, Given(moment)): (Vector3<f64>, Given<f64, 3>)) -> Torquer {
    Torquer { moment, field }
}

/// Checks that a step with prescribed values is the step of a scene with these values, by any method.
fn is_the_step_of_such_a_scene<S, P>(make: impl Fn(Torquer) -> Stepper<S, P>)
where
    S: Scene<Scalar = f64, Group = SO3, Advected = Values>,
    P: Steerable<S>,
{
    steps_of_such_a_scene(Vector3::new(0.5, -1.0, 2.0), make);
}

/// Compares steps with prescribed values with those of scenes with these values, and returns how many needed a remedy.
/// The scene's own values are none, so that whatever is found out about them when the step is set up is found out about
/// nothing.
fn steps_of_such_a_scene<S, P>(velocity: Vector3<f64>, make: impl Fn(Torquer) -> Stepper<S, P>) -> usize
where
    S: Scene<Scalar = f64, Group = SO3, Advected = Values>,
    P: Steerable<S>,
{
    let mut random = Random::new(3);
    let own = Torquer { moment: Vector3::zeros(), field: Vector3::zeros() };
    let driven = make(own);
    let mut state = driven.start(SO3::identity(), velocity).unwrap();
    let mut remedied = 0;
    for _ in 0..20 {
        let values: Values = ((), (random.sample(), Given(random.sample())));
        let such = make(torquer(values.1));
        let mut expected = such.adopt(&state);
        such.step(&mut expected).unwrap();
        remedied += usize::from(driven.step_with(&mut state, &values).unwrap().remedy.is_some());
        let apart = relative(&state.momentum(), &expected.momentum());
        assert!(apart < 1e-13, "{apart:e}");
        assert!((state.attitude().as_matrix() - expected.attitude().as_matrix()).norm() < 1e-13);
        // The scene's own values are in the state between the steps.
        let (seen, Given(moment)) = state.advected().1;
        assert!((seen - state.attitude().as_matrix().transpose() * own.field).norm() < 1e-13);
        assert_eq!(moment, own.moment);
    }
    remedied
}

#[test]
fn given_values_are_those_of_the_scene() {
    is_the_step_of_such_a_scene(|torquer| Stepper::new(body() + torquer, 0.1).unwrap());
    is_the_step_of_such_a_scene(|torquer| Stepper::new(body() + torquer, 0.1).unwrap().compensated());
    let fast = Vector3::new(10.0, -20.0, 30.0);
    let substepped = |torquer| Stepper::new(body() + torquer, 0.1).unwrap().or_substeps(64);
    assert!(steps_of_such_a_scene(fast, substepped) > 10);
    is_the_step_of_such_a_scene(|torquer| {
        Stepper::composed(body() + torquer, 0.1, CompositionScheme::SUZUKI_4).unwrap()
    });
    is_the_step_of_such_a_scene(|torquer| {
        let flow = SymmetricBody::new(&body().J_d.to_inertia()).unwrap();
        Stepper::split(body() + torquer, 0.1, flow, SplittingScheme::STRANG).unwrap()
    });
    // A scheme with so many drifts merges a symmetric body's spins, if no torque acts about its axis.
    is_the_step_of_such_a_scene(|torquer| {
        let flow = SymmetricBody::new(&body().J_d.to_inertia()).unwrap();
        Stepper::split(body() + torquer, 0.1, flow, SplittingScheme::NYSTROM_11).unwrap()
    });
    is_the_step_of_such_a_scene(|torquer| {
        let flow = ExactBody::new(&body().J_d.to_inertia());
        Stepper::processed(body() + torquer, 0.1, flow, ProcessedScheme::SIX_A).unwrap()
    });
}

/// A step with the scene's own values prescribed is the scene's step to rounding, and that of a dipole.
#[test]
fn a_constant_moment_is_a_dipole() {
    let (moment, field) = (Vector3::new(0.3, -0.2, 0.5), Vector3::new(1.0, 2.0, -0.5));
    let driven = Stepper::new(body() + Torquer { moment: Vector3::zeros(), field: Vector3::z() }, 0.05).unwrap();
    let dipole = Stepper::new(body() + Dipole { moment, field }, 0.05).unwrap();
    let velocity = Vector3::new(0.5, -1.0, 2.0);
    let mut state = driven.start(SO3::identity(), velocity).unwrap();
    let mut expected = dipole.start(SO3::identity(), velocity).unwrap();
    for _ in 0..200 {
        driven.step_with(&mut state, &((), (field, Given(moment)))).unwrap();
        dipole.step(&mut expected).unwrap();
    }
    assert!(relative(&state.momentum(), &expected.momentum()) < 1e-12);
}

#[test]
fn a_step_that_fails_leaves_the_state() {
    let stepper = Stepper::new(body() + Torquer { moment: Vector3::x(), field: Vector3::z() }, 0.1).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.5, -1.0, 2.0)).unwrap();
    let before = state;
    for (field, moment) in [(Vector3::x() * f64::NAN, Vector3::x()), (Vector3::x(), Vector3::y() * f64::INFINITY)] {
        let error = stepper.step_with(&mut state, &((), (field, Given(moment)))).unwrap_err();
        assert_eq!(error, StepError::NonFinite { what: "value given to the step" });
        assert_eq!(state, before);
    }
    // The torque is so large that no step of this length has a solution.
    let error = stepper.step_with(&mut state, &((), (Vector3::x() * 1e4, Given(Vector3::y())))).unwrap_err();
    assert!(matches!(error, StepError::BeyondSolvable { .. }), "{error}");
    assert_eq!(state, before);
}

/// The orbital rate, rad/s.
const RATE: f64 = 0.5;

/// A satellite on a circular orbit in the plane of x and y.
fn satellite(h: f64) -> Stepper<Sum<RigidBody, GravityGradient>> {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.5, 2.5, 3.0)).unwrap();
    let gradient = GravityGradient { GM: RATE * RATE, r: 1.0, J: J_d.to_inertia(), direction: -Vector3::x() };
    Stepper::new(RigidBody { J_d } + gradient, h).unwrap()
}

/// The direction from the satellite to the planet at a time.
fn planet(t: f64) -> Vector3<f64> {
    -Vector3::new((RATE * t).cos(), (RATE * t).sin(), 0.0)
}

/// A libration in the plane of the orbit satisfies `J_z θ'' = −3 n² (J_y − J_x) sin θ cos θ` for the angle to the
/// vertical, which a Runge–Kutta method solves. RK4 on this.
#[test]
fn a_satellite_librates_to_second_order() {
    let accelerated = |theta: f64| -3.0 * RATE * RATE * (2.5 - 1.5) / 3.0 * theta.sin() * theta.cos();
    let rates = |z: Vector2<f64>| Vector2::new(z.y, accelerated(z.x));
    let start = Vector2::new(0.4, 0.0);
    let theta = (0..20_000).fold(start, |z, _| z + runge_kutta::change(z, 1e-3, rates)).x;
    let error = |steps: u32| {
        let stepper = satellite(20.0 / f64::from(steps));
        let start = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.4);
        let mut state = stepper.start(start, Vector3::new(0.0, 0.0, RATE)).unwrap();
        for step in 0..steps {
            let middle = (f64::from(step) + 0.5) * stepper.step_size();
            stepper.step_with(&mut state, &((), planet(middle))).unwrap();
        }
        let expected = Rotation3::from_axis_angle(&Vector3::z_axis(), theta + RATE * 20.0);
        (state.attitude().as_matrix() - expected.matrix()).norm()
    };
    let (coarse, fine) = (error(200), error(400));
    println!("{coarse:e} {fine:e}");
    assert!(coarse < 0.02 && (coarse / fine - 4.0).abs() < 0.1, "{coarse:e} {fine:e}");
}

/// A composition takes the values of its stages' own times, and has its order; and so has a part of its step.
#[test]
fn a_composition_sees_the_values_of_its_stages() {
    let field = |t: f64| Vector3::new((0.7 * t).sin(), 0.3 * (1.1 * t).cos(), 1.0);
    let scene = || body() + Dipole { moment: Vector3::new(1.0, -0.5, 2.0), field: Vector3::z() };
    let velocity = Vector3::new(0.5, -1.0, 2.0);
    let end = |scheme, steps: u32| {
        let stepper =
            Stepper::composed(scene(), 4.0 / f64::from(steps), scheme).unwrap().driven(move |t| ((), field(t)));
        let mut state = stepper.start(SO3::identity(), velocity).unwrap();
        stepper.run(&mut state, u64::from(steps) - 1).unwrap();
        // The last step as a part of one.
        stepper.part(&state, 1.0).unwrap().momentum()
    };
    let truth = end(CompositionScheme::KAHAN_LI_8, 800);
    let f = |t: f64, y: SVector<f64, 12>| {
        let (R, momentum) =
            (Matrix3::from_column_slice(&y.as_slice()[..9]), Vector3::from_column_slice(&y.as_slice()[9..]));
        let turn = momentum.component_div(&Vector3::new(3.0, 3.0, 4.5));
        let torque = Vector3::new(1.0, -0.5, 2.0).cross(&(R.transpose() * field(t)));
        let (turned, pushed) = (R * turn.cross_matrix(), momentum.cross(&turn) + torque);
        SVector::<f64, 12>::from_iterator(turned.iter().chain(pushed.iter()).copied())
    };
    let mut y = SVector::<f64, 12>::from_iterator(
        Matrix3::identity().iter().copied().chain(velocity.component_mul(&Vector3::new(3.0, 3.0, 4.5)).iter().copied()),
    );
    let h = 4.0 / 4000.0;
    for step in 0..4000_u32 {
        let t = f64::from(step) * h;
        let a = f(t, y);
        let b = f(t + h / 2.0, y + a * (h / 2.0));
        let c = f(t + h / 2.0, y + b * (h / 2.0));
        let d = f(t + h, y + c * h);
        y += (a + (b + c) * 2.0 + d) * (h / 6.0);
    }
    let exact = Vector3::from_column_slice(&y.as_slice()[9..]);
    assert!(relative(&truth, &exact) < 1e-9, "{truth} {exact}");
    let [coarse, fine] = [80, 160].map(|steps| relative(&end(CompositionScheme::SUZUKI_4, steps), &truth));
    println!("{coarse:e} {fine:e}");
    assert!(((coarse / fine).log2() - 4.0).abs() < 0.1, "{coarse:e} {fine:e}");
}

/// The Jacobi integral, conserved as the system doesn't depend on time in the frame of the orbit, oscillates and
/// doesn't drift.
#[test]
fn the_jacobi_integral_of_an_orbit_stays() {
    let stepper = satellite(0.1);
    let start = Rotation3::from_scaled_axis(Vector3::new(0.3, -0.2, 0.4));
    let mut state = stepper.start(start, Vector3::new(0.05, -0.1, RATE)).unwrap();
    let scene = stepper.scene();
    let integral = |state: &liestep::State<SO3, ((), Vector3<f64>)>, t: f64| {
        let velocity = stepper.velocity(state);
        let seen = state.attitude().as_matrix().transpose() * planet(t);
        0.5 * velocity.dot(&state.momentum()) - scene.limit(None, &((), seen)).l - RATE * state.spatial_momentum().z
    };
    let first = integral(&state, 0.0);
    let (mut early, mut late) = (0.0_f64, 0.0_f64);
    for step in 0..200_000_u32 {
        let t = f64::from(step) * 0.1;
        stepper.step_with(&mut state, &((), planet(t + 0.05))).unwrap();
        let off = (integral(&state, t + 0.1) - first).abs();
        if step < 20_000 {
            early = early.max(off);
        } else if step >= 180_000 {
            late = late.max(off);
        }
    }
    println!("{early:e} {late:e}");
    assert!(early > 1e-7 && late < 1.2 * early && late < 1e-3, "{early:e} {late:e}");
}

fn flyer() -> Flyer {
    Flyer { J: Matrix4::from_diagonal(&Vector4::new(0.75, 1.25, 1.0, 2.0)) }
}

/// A nozzle beside the axis accelerates the body's rotation evenly, so that its velocity is a Fresnel integral.
#[test]
fn a_thruster_beside_the_axis_draws_a_spiral() {
    let (force, arm, end) = (1.5, 0.2, 4.0);
    let turning = force * arm / 2.0;
    // Position at the end by Simpson's rule: x(t) = ∫ (t − s) (f/m) cos(½ a s²) ds.
    let weight = |k: u32| f64::from(if k == 0 || k == 2000 { 1 } else { 2 + 2 * (k % 2) });
    let place = |part: fn(f64) -> f64| {
        let at = |k: u32| f64::from(k) * end / 2000.0;
        let sum: f64 = (0..=2000).map(|k| weight(k) * (end - at(k)) * part(0.5 * turning * at(k) * at(k))).sum();
        sum * end / 6000.0 * force / 2.0
    };
    let expected = Vector3::new(place(f64::cos), place(f64::sin), 0.0);
    let error = |steps: u32| {
        let nozzle = Thruster { at: Point3::new(-1.0, -arm, 0.0), thrust: Vector4::zeros() };
        let stepper = Stepper::new(flyer() + nozzle, end / f64::from(steps)).unwrap();
        let mut state = stepper.start(SE3::identity(), nalgebra::Vector6::zeros()).unwrap();
        for _ in 0..steps {
            stepper.step_with(&mut state, &((), Given(Vector4::new(force, 0.0, 0.0, 0.0)))).unwrap();
        }
        let attitude = state.attitude().matrix();
        (attitude.fixed_view::<3, 1>(0, 3) - expected).norm()
    };
    let (coarse, fine) = (error(100), error(200));
    println!("{coarse:e} {fine:e}");
    assert!(coarse < 1e-2 && (coarse / fine - 4.0).abs() < 0.1, "{coarse:e} {fine:e}");
}

/// Drag alone: the body moves by `m v/c` and turns by `J Ω/c_r` until it rests, and the energy falls in every step.
#[test]
fn drag_stops_a_flyer() {
    let C = Matrix4::from_diagonal(&Vector4::new(0.5, 0.5, 0.5, 0.8));
    let stepper = Stepper::new(flyer() + FluidDrag { C }, 0.05).unwrap();
    let turning_and_moving = nalgebra::Vector6::new(0.0, 0.0, 0.3, 1.0, 0.0, 0.0);
    let mut state = stepper.start(SE3::identity(), turning_and_moving).unwrap();
    let mut energy = stepper.energy(&state);
    for _ in 0..2000 {
        stepper.step(&mut state).unwrap();
        let next = stepper.energy(&state);
        assert!(next <= energy);
        energy = next;
    }
    assert!(energy < 1e-14);
    let end = state.attitude().matrix();
    let turned = end[(1, 0)].atan2(end[(0, 0)]);
    // The inertia and the drag about the axis are J_z = 0.75 + 1.25 and c_z = 0.5 + 0.5.
    assert!((turned - 0.6).abs() < 1e-3, "{turned}");
    let view: Matrix3<f64> = end.fixed_view::<3, 3>(0, 0).into();
    assert!((view.transpose() * view - Matrix3::identity()).norm() < 1e-13);
    // The momentum in space falls as e^(−ct/m) along a line, whatever the body's turn.
    assert!((end[(0, 3)] - 2.5).abs() < 5e-3 && end[(1, 3)].abs() < 5e-3, "{end}");
}
