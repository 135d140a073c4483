//! Bodies that are declared together, and systems of bodies, in SIMD lanes: each lane has the bits of a scene of its
//! own.

mod rows;

use core::fmt::Debug;

use declarations::{Alike, DoublePendulum, FloatingBody, PointSpring, TwoBodies};
use liestep::groups::{ExponentialRetraction, R1, R2, R3, Retraction as _, SE3};
use liestep::laws::samples::Random;
use liestep::mechanics::{Along, Between, Coupling, Each, On, Pairs, Regular};
use liestep::methods::CompositionScheme;
use liestep::motion::{Batch, Batchable, Integrator, OwnStep};
use liestep::numbers::{Bodies, InLanes, Lanes as _};
use liestep::with::CompensatedSums;
use liestep::{NonstandardInertia, SO3, SetupError, StateOf, StepError, Stepper, lagrangian};
use nalgebra::{Matrix3, RealField, SVector, Vector3, Vector6};
use simba::simd::AutoF64x4;

use super::{assert_same, started};

/// Two bodies with an alignment potential: each is solved separately.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(R = F_1.seen_from(space), Q = F_2.seen_from(F_1)),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
        + 0.5 * h * kappa * (Q.trace() + (F_1.transpose() * Q * F_2).trace())
        + 0.5 * h * kappa * (R.trace() + (R * F_1).trace()),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct AlignedBodies<T> {
    J_1: NonstandardInertia<T>,
    J_2: NonstandardInertia<T>,
    kappa: T,
}

fn inertia<T: RealField + Copy>(random: &mut Random) -> NonstandardInertia<T> {
    let moments = Vector3::new(0.5, 0.6, 0.7) + vector(random) * 0.1;
    NonstandardInertia::from_principal_moments(moments.map(nalgebra::convert::<f64, T>)).unwrap()
}

fn vector(random: &mut Random) -> Vector3<f64> {
    random.sample()
}

fn links(random: &mut Random) -> DoublePendulum {
    let (rho, m_2, s_2) = (vector(random), 0.7, vector(random) * 0.3);
    let J_1 = *inertia::<f64>(random).as_matrix() + rho * rho.transpose() * m_2;
    let J_2 = inertia::<f64>(random).as_matrix() + s_2 * s_2.transpose() / m_2;
    let of = |J: Matrix3<f64>| NonstandardInertia::new(J).unwrap();
    DoublePendulum {
        J_1: of(J_1),
        J_2: of(J_2),
        rho,
        s_1: vector(random) * 0.4 + rho * m_2,
        s_2,
        g: 9.81,
        up: Vector3::z(),
    }
}

type Group = (SO3, SO3);

fn start(random: &mut Random, speed: f64) -> (Group, Vector6<f64>) {
    let turned = [0, 1].map(|_| SO3::exp(vector(random)));
    let velocity: Vector6<f64> = random.sample();
    ((turned[0], turned[1]), velocity * speed)
}

/// Gathers four steppers into lanes; bodies that a batch would step one after another are an error here.
fn together<M: Batchable<AutoF64x4>>(bodies: &[(M, M::State)]) -> (M::Together, InLanesOf<M>) {
    let mut all = (M::Together::splat(&bodies[0].0), InLanesOf::<M>::splat(&bodies[0].1));
    for (lane, (stepper, state)) in bodies.iter().enumerate() {
        assert!(all.0.set_lane(lane, stepper) && all.1.set_lane(lane, state));
    }
    all
}

/// The stepper with compensated sums.
fn compensated<L: Regular<Scalar = f64>>((stepper, state): (Stepper<L>, StateOf<L>)) -> CompensatedRun<L> {
    let stepper = stepper.compensated();
    let state = stepper.adopt(&state);
    (stepper, state)
}

type CompensatedRun<L> = (Stepper<L, CompensatedSums<OwnStep<L>>>, StateOf<L, CompensatedSums<OwnStep<L>>>);

type InLanesOf<M> = <<M as InLanes<AutoF64x4>>::Together as Integrator>::State;

/// Compares four bodies in lanes with each alone.
fn assert_each_is_alone<M>(bodies: &[(M, M::State)], steps: u64)
where
    M: Batchable<AutoF64x4> + Integrator<State: PartialEq + Debug>,
{
    let (stepper, mut state) = together(bodies);
    stepper.run(&mut state, steps).unwrap();
    for (lane, (stepper, alone)) in bodies.iter().enumerate() {
        let mut alone = alone.clone();
        stepper.run(&mut alone, steps).unwrap();
        assert_same(&state.lane(lane), &alone);
    }
    let mut batch = Batch::<AutoF64x4, M>::new(bodies).unwrap();
    for run in 0..4 {
        batch.run(steps / 4);
        for (lane, (stepper, state)) in bodies.iter().enumerate() {
            let mut alone = state.clone();
            stepper.run(&mut alone, steps / 4 * (run + 1)).unwrap();
            assert_same(&batch.state(lane), &alone);
        }
    }
}

/// Checks that a body whose step has no solution stops with the error that it has alone, and that the others continue
/// as alone.
fn stopped<M>(bodies: &[(M, M::State)], stopped: usize, steps: u64) -> StepError
where
    M: Batchable<AutoF64x4> + Integrator<State: PartialEq + Debug>,
{
    let mut batch = Batch::<AutoF64x4, M>::new(bodies).unwrap();
    batch.run(steps);
    assert!(batch.running().eq((0..bodies.len()).filter(|&lane| lane != stopped)));
    for (lane, (stepper, state)) in bodies.iter().enumerate() {
        let mut alone = state.clone();
        // Single steps end at the state before the failed one.
        let error = (0..steps).find_map(|_| stepper.step(&mut alone).err());
        assert_eq!(batch.error(lane), error.as_ref(), "{lane}");
        assert_same(&batch.state(lane), &alone);
    }
    batch.error(stopped).unwrap().clone()
}

#[test]
fn each_lane_of_a_double_pendulum_is_one() {
    let random = &mut Random::new(31);
    let mut bodies = [0, 1, 2, 3].map(|_| started(links(random), 0.01, start(random, 1.0)));
    assert_each_is_alone(&bodies, 200);

    // A body that turns too far stops alone.
    let fast = bodies[2].0.start(start(random, 1.0).0, Vector6::z() * 500.0).unwrap();
    bodies[2].1 = fast;
    let error = stopped(&bodies, 2, 50);
    assert!(matches!(error, StepError::BeyondSolvable { .. }), "{error:?}");
    // The speed is such that the first step has a solution, and a later one has none.
    let (attitude, velocity) = start(random, 1.0);
    let turning = |speed: f64| bodies[2].0.start(attitude, velocity * speed).unwrap();
    let made = |speed: f64| {
        let mut state = turning(speed);
        (0..50).take_while(|_| bodies[2].0.step(&mut state).is_ok()).count()
    };
    let speed = (1..10_000).map(|k| 1.001_f64.powi(k)).find(|&speed| made(speed) < 50).unwrap();
    assert!(made(speed) > 1);
    let turning = turning(speed);
    bodies[2].1 = turning;
    stopped(&bodies, 2, 50);
}

#[test]
fn each_lane_of_bodies_that_are_solved_apart_is_one() {
    let random = &mut Random::new(32);
    let mut scene = || AlignedBodies { J_1: inertia::<f64>(random), J_2: inertia(random), kappa: 2.0 };
    let scenes = [scene(), scene(), scene(), scene()];
    let starts = [0, 1, 2, 3].map(|_| start(random, 2.0));
    let composed = |k: usize| {
        let stepper = Stepper::composed(scenes[k], 0.05, CompositionScheme::SUZUKI_4).unwrap();
        let state = stepper.start(starts[k].0, starts[k].1).unwrap();
        (stepper, state)
    };
    assert_each_is_alone(&[0, 1, 2, 3].map(composed), 200);
}

/// A top whose pivot slides in the plane, with a wheel on its axis: rotations, translations of the plane and of a line.
#[lagrangian(
    group(F = SO3, d = R2, t = R1),
    advected(R = F.seen_from(space)),
    l_d = {
        let lever = R * ((F - I) * s);
        ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
            + M * d.norm_squared() / (2.0 * h)
            + (d.x * lever.x + d.y * lever.y) / h
            + wheel * (t + vee(F).z).powi(2) / (2.0 * h)
            - 0.5 * h * g * ((R * s).z + (R * (F * s)).z)
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cart<T> {
    J_d: NonstandardInertia<T>,
    s: Vector3<T>,
    M: T,
    wheel: T,
    g: T,
}

#[test]
fn each_lane_of_a_top_on_a_cart_is_one() {
    let random = &mut Random::new(33);
    let mut bodies = [0, 1, 2, 3].map(|_| {
        let (J_d, s) = (inertia::<f64>(random), vector(random) * 0.2);
        let cart = Cart { J_d, s, M: 1.5 + s.x, wheel: 0.1 - 0.1 * s.y, g: 9.81 };
        let (at, velocity): (Vector3<f64>, Vector6<f64>) = (vector(random), random.sample());
        let place = (SO3::exp(vector(random)), R2::from(at.xy()), R1::from(nalgebra::Vector1::new(at.z)));
        started(cart, 0.01, (place, velocity))
    });
    assert_each_is_alone(&bodies, 200);
    // A body that turns too far stops alone.
    let fast = bodies[1].0.start(bodies[1].1.attitude(), Vector6::z() * 500.0).unwrap();
    bodies[1].1 = fast;
    let error = stopped(&bodies, 1, 20);
    assert!(matches!(error, StepError::BeyondSolvable { body: None, .. }), "{error:?}");
}

#[test]
fn each_lane_of_two_bodies_that_attract_each_other_is_one() {
    let random = &mut Random::new(34);
    let started = [0, 1, 2, 3].map(|_| {
        let (K_1, K_2) = (inertia::<f64>(random), inertia::<f64>(random));
        let scene = TwoBodies { m_1: 1.0, m_2: 0.4, K_1, K_2, J_1: K_1.to_inertia(), J_2: K_2.to_inertia(), G: 1.0 };
        let stepper = Stepper::composed(scene, 0.02, CompositionScheme::SUZUKI_4).unwrap();
        let far = R3::from(Vector3::x() * 3.0 + vector(random) * 0.3);
        let place = (SO3::exp(vector(random)), R3::from(vector(random) * 0.1), SO3::exp(vector(random)), far);
        let velocity: SVector<f64, 12> = random.sample();
        let state = stepper.start(place, velocity * 0.5).unwrap();
        (stepper, state)
    });
    assert_each_is_alone(&started, 200);
}

/// A rigid body on SE(3), whose matrix is inverted lane by lane.
#[lagrangian(group = SE3, l_d = ((F - I) * K * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct SE3Body<T> {
    K: nalgebra::Matrix4<T>,
}

#[test]
fn each_lane_of_a_group_that_is_inverted_is_one() {
    let random = &mut Random::new(35);
    let moved = |way: &Vector6<f64>| -> SE3 { ExponentialRetraction::retract(way) };
    let floating = |mass: f64| {
        let K = nalgebra::Matrix4::from_diagonal(&nalgebra::Vector4::new(0.3, 0.4, 0.5, mass));
        Stepper::new(SE3Body { K }, 0.01).unwrap()
    };
    let mut bodies = [0, 1, 2, 3].map(|_| {
        let stepper = floating(2.0 + vector(random).x);
        let (place, velocity): (Vector6<f64>, Vector6<f64>) = (random.sample(), random.sample());
        let state = stepper.start(moved(&place), velocity).unwrap();
        (stepper, state)
    });
    // One body is far from the identity, and so are its increments: it turns by half a radian in a step.
    let far = moved(&Vector6::new(1.8, -2.0, 1.0, 50.0, -30.0, 10.0));
    bodies[1].1 = bodies[1].0.start(far, Vector6::new(30.0, 20.0, -35.0, 100.0, 0.0, 50.0)).unwrap();
    assert_each_is_alone(&bodies, 200);

    // About its third axis a body turns by `sin θ = h μ/(K_1 + K_2)`: the Jacobian is singular at a right angle, and
    // beyond there is no solution.
    let momentum = Vector6::z() * (1.001 * (0.3 + 0.4) / 0.01);
    bodies[2].1 = bodies[2].0.start_with_momentum(bodies[2].1.attitude(), momentum).unwrap();
    let error = stopped(&bodies, 2, 20);
    let StepError::BeyondSolvable { largest, .. } = error else { panic!("{error:?}") };
    // The reported step has six digits.
    assert!((largest * 1.001 / 0.01 - 1.0).abs() < 1e-5, "{largest}");
    // A body without mass has a singular Jacobian everywhere, and is refused at construction.
    let K = nalgebra::Matrix4::from_diagonal(&nalgebra::Vector4::new(0.3, 0.4, 0.5, 0.0));
    assert!(matches!(Stepper::new(SE3Body { K }, 0.01), Err(SetupError::SingularKinetic { body: None, .. })));
}

/// A rotating body whose step has no solution about its third axis beyond a right angle.
#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct TurningBody<T> {
    J_d: NonstandardInertia<T>,
}

/// The weight of a body.
#[lagrangian(group = SO3, advected(w = up), l_d = -0.5 * h * weight * w.dot(&(rho + F * rho)))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct HeavyTerm<T> {
    weight: T,
    rho: Vector3<T>,
    up: Vector3<T>,
}

/// Terms at all kinds of places with potentials of the ends of a step.
#[test]
fn each_lane_of_a_row_of_bodies_is_one() {
    const N: usize = 4;
    let random = &mut Random::new(36);
    let bodies = [0, 1, 2, 3].map(|_| {
        let turning = Each::<N>::of([0, 1, 2, 3].map(|_| TurningBody { J_d: inertia::<f64>(random) }));
        let tied = [0, 1, 2].map(|_| Alike { kappa: 2.0 + vector(random).x });
        let weight = HeavyTerm { weight: 2.0 + vector(random).x, rho: vector(random) * 0.3, up: Vector3::z() };
        // The first body has a second inertia.
        let scene = On::<0, N>::of([TurningBody { J_d: inertia::<f64>(random) }])
            + turning
            + Along::<N>::of(tied)
            + Between::<3, 0, N>::of([tied[0]])
            + Pairs::<N>::of([Alike { kappa: 0.1 + 0.1 * vector(random).y }])
            + On::<1, N>::of([weight]);
        let attitudes = [0, 1, 2, 3].map(|_| SO3::exp(vector(random)));
        started(scene, 0.02, (attitudes, Bodies([0, 1, 2, 3].map(|_| vector(random)))))
    });
    assert_each_is_alone(&bodies, 200);
    assert_each_is_alone(&bodies.clone().map(compensated), 200);

    let mut bodies = bodies;
    let mut fast = [Vector3::zeros(); N];
    fast[3] = Vector3::z() * 500.0;
    bodies[2].1 = bodies[2].0.start(bodies[2].1.attitude(), Bodies(fast)).unwrap();
    let error = stopped(&bodies, 2, 20);
    assert!(matches!(error, StepError::BeyondSolvable { body: Some(3), .. }), "{error:?}");
}

/// A spring between points of two bodies, evaluated in the middle of a step.
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    l_d = -0.5 * h * k * (r + (d_2 - d_1 + R_2 * b + R_2 * F_2 * b - R_1 * a - R_1 * F_1 * a) * 0.5).norm_squared(),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct StiffSpring<T> {
    k: T,
    a: Vector3<T>,
    b: Vector3<T>,
}

#[test]
fn each_lane_of_bodies_on_springs_is_one() {
    let random = &mut Random::new(37);
    let parts = [0, 1, 2, 3].map(|_| {
        let bodies =
            Each::<3>::of([0, 1, 2].map(|_| FloatingBody { m: 1.0 + 0.2 * vector(random).x, J_d: inertia(random) }));
        let ends = [0, 1].map(|_| vector(random) * 0.3);
        let places = [0, 1, 2].map(|_| (SO3::exp(vector(random)), R3::from(vector(random))));
        (bodies, ends, (places, Bodies([0, 1, 2].map(|_| random.sample()))))
    });
    let loose = parts.map(|(bodies, [a, b], start)| {
        started(bodies + Along::<3>::of([PointSpring { k: 3.0 + a.x, a, b }]), 0.02, start)
    });
    assert_each_is_alone(&loose, 200);
    let stiff = parts.map(|(bodies, [a, b], start)| {
        started(bodies + Coupling::<3>::of([StiffSpring { k: 30.0 + a.x, a, b }]), 0.02, start)
    });
    assert_each_is_alone(&stiff, 200);
}
