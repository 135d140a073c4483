//! Bodies that are declared together, in SIMD lanes: each lane is, bit for bit, a scene of its own.

// The letters of the field.
#![allow(non_snake_case)]

use liestep::laws::samples::Random;
use liestep::methods::CompositionScheme;
use liestep::motion::{Batch, Batchable, Integrator};
use liestep::{NonstandardInertia, SO3, StepError, Stepper, lagrangian};
use nalgebra::{Matrix3, RealField, Vector3, Vector6};
use simba::simd::AutoF64x4;

/// The double pendulum: velocities are coupled, and the inertia depends on where the links are.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w_1 = up.seen_from(F_1), w_2 = up.seen_from(F_2), Q = F_2.seen_from(F_1)),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
        + ((F_1 - I) * rho).dot(&(Q * ((F_2 - I) * s_2))) / h
        - 0.5 * h * g * (w_1.dot(&(s_1 + F_1 * s_1)) + w_2.dot(&(s_2 + F_2 * s_2))),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Links<T> {
    J_1: NonstandardInertia<T>,
    J_2: NonstandardInertia<T>,
    rho: Vector3<T>,
    s_1: Vector3<T>,
    s_2: Vector3<T>,
    g: T,
    up: Vector3<T>,
}

/// Two bodies that would like to stand alike: each is solved for itself.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(R = F_1.seen_from(space), Q = F_2.seen_from(F_1)),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
        + 0.5 * h * kappa * (Q.trace() + (F_1.transpose() * Q * F_2).trace())
        + 0.5 * h * kappa * (R.trace() + (R * F_1).trace()),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Alike<T> {
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

fn links(random: &mut Random) -> Links<f64> {
    let (rho, m_2, s_2) = (vector(random), 0.7, vector(random) * 0.3);
    let J_1 = *inertia::<f64>(random).as_matrix() + rho * rho.transpose() * m_2;
    let J_2 = inertia::<f64>(random).as_matrix() + s_2 * s_2.transpose() / m_2;
    let of = |J: Matrix3<f64>| NonstandardInertia::new(J).unwrap();
    Links { J_1: of(J_1), J_2: of(J_2), rho, s_1: vector(random) * 0.4 + rho * m_2, s_2, g: 9.81, up: Vector3::z() }
}

type Group = (SO3, SO3);

fn start(random: &mut Random, speed: f64) -> (Group, Vector6<f64>) {
    let turned = [0, 1].map(|_| SO3::exp(vector(random)));
    let velocity: Vector6<f64> = random.sample();
    ((turned[0], turned[1]), velocity * speed)
}

/// Four together, against each alone.
fn assert_each_is_alone<M>(bodies: &[(M, M::State)], steps: u64)
where
    M: Batchable<AutoF64x4> + Integrator<State: PartialEq + core::fmt::Debug>,
{
    let mut batch = Batch::<AutoF64x4, M>::new(bodies).unwrap();
    for run in 0..4 {
        batch.run(steps / 4);
        for (lane, (stepper, state)) in bodies.iter().enumerate() {
            let mut alone = state.clone();
            stepper.run(&mut alone, steps / 4 * (run + 1)).unwrap();
            assert_eq!(batch.state(lane), alone, "{lane}");
        }
    }
}

#[test]
fn each_lane_of_a_double_pendulum_is_one() {
    let random = &mut Random::new(31);
    let bodies: Vec<_> = (0..4)
        .map(|_| {
            let stepper = Stepper::new(links(random), 0.01).unwrap();
            let (attitude, velocity) = start(random, 1.0);
            let state = stepper.start(attitude, velocity).unwrap();
            (stepper, state)
        })
        .collect();
    assert_each_is_alone(&bodies, 200);

    // One that turns too far stops by itself.
    let mut bodies = bodies;
    let fast = bodies[2].0.start(start(random, 1.0).0, Vector6::z() * 500.0).unwrap();
    bodies[2].1 = fast;
    let mut batch = Batch::<AutoF64x4, _>::new(&bodies).unwrap();
    batch.run(50);
    assert!(matches!(batch.error(2), Some(StepError::BeyondSolvable { .. })), "{:?}", batch.error(2));
    assert_eq!((batch.state(2), batch.running().count()), (fast, 3));
    let (stepper, mut alone) = bodies[3].clone();
    stepper.run(&mut alone, 50).unwrap();
    assert_eq!(batch.state(3), alone);
}

#[test]
fn each_lane_of_bodies_that_are_solved_apart_is_one() {
    let random = &mut Random::new(32);
    let mut scene = || Alike { J_1: inertia::<f64>(random), J_2: inertia(random), kappa: 2.0 };
    let scenes = [scene(), scene(), scene(), scene()];
    let starts = [0, 1, 2, 3].map(|_| start(random, 2.0));
    let composed = |k: usize| {
        let stepper = Stepper::composed(scenes[k], 0.05, CompositionScheme::SUZUKI_4).unwrap();
        let state = stepper.start(starts[k].0, starts[k].1).unwrap();
        (stepper, state)
    };
    assert_each_is_alone(&[0, 1, 2, 3].map(composed), 200);
}
