//! Systems as propagators, their places, and threads that share a stepper.

use alloc::vec::Vec;

use liestep::lagrangian;
use nalgebra::{Vector3, Vector6};

use super::{Body, Multibody};
use crate::error::{SetupError, StepError};
use crate::groups::{R3, SO3};
use crate::mechanics::NonstandardInertia;
use crate::methods::BallJoint;
use crate::motion::Propagator;

/// A body with its weight.
#[lagrangian(
    group(F = SO3, d = R3),
    advected(x = d.seen_from(space), w = e.seen_from(F)),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
        - 0.5 * h * m * g * (x + x + d).dot(&up) - 0.5 * h * c * (w[0] + (F.transpose() * w)[0]),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rod {
    J_d: NonstandardInertia,
    m: f64,
    g: f64,
    c: f64,
    up: Vector3<f64>,
    e: Vector3<f64>,
}

/// A spring between points of two bodies.
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    l_d = -0.25 * h * k * ((r + R_2 * at_2 - R_1 * at_1).norm_squared()
        + (r + d_2 - d_1 + R_2 * F_2 * at_2 - R_1 * F_1 * at_1).norm_squared()),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cord {
    k: f64,
    at_1: Vector3<f64>,
    at_2: Vector3<f64>,
}

const LEFT: Vector3<f64> = Vector3::new(-0.5, 0.0, 0.0);
const RIGHT: Vector3<f64> = Vector3::new(0.5, 0.0, 0.0);

fn rod(m: f64, c: f64) -> Rod {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.1, 0.1) * m).unwrap();
    Rod { J_d, m, g: 9.81, c, up: Vector3::z(), e: Vector3::x() }
}

fn ball(above: Vector3<f64>, below: Vector3<f64>) -> BallJoint {
    BallJoint { above, below }
}

/// Links of one metre in a row from the origin, and the end of the last.
fn row<const N: usize>(tilts: [f64; N]) -> ([Body; N], Vector3<f64>) {
    let mut corner = Vector3::zeros();
    let places = tilts.map(|tilt| {
        let attitude = SO3::exp(Vector3::y() * tilt);
        let along = attitude.as_matrix() * Vector3::x();
        corner += along;
        (attitude, R3::from(corner - along * 0.5))
    });
    (places, corner)
}

/// A system as a propagator: reading and continuing a state, a part of a step, and slices of a wrong length.
#[test]
fn a_system_is_a_propagator() {
    let mut system = Multibody::new();
    let first = system.body(rod(1.0, 0.5));
    let second = system.body(rod(0.5, -0.2));
    system.join(ball(Vector3::zeros(), LEFT), None, first);
    system.join(ball(RIGHT, LEFT), Some(first), second);
    let stepper = system.stepper(0.01).unwrap();
    let (places, _) = row([0.4, 1.1]);
    let propagator: &dyn Propagator = &stepper;
    let mut attitude = Vec::new();
    for (turn, place) in &places {
        attitude.extend(turn.as_matrix().transpose().iter());
        attitude.extend(place.as_matrix().transpose().iter());
    }
    let mut state = propagator.start(&attitude, &[0.0; 12]).unwrap();
    assert_eq!(state, stepper.start(&places, &[Vector6::zeros(); 2]).unwrap());
    assert_eq!(state.len(), propagator.layout().state());
    let start = state.clone();
    propagator.run(&mut state, 200).unwrap();
    let mut other = start.clone();
    (0..200).for_each(|_| _ = propagator.step(&mut other).unwrap());
    assert_eq!(state, other);
    assert!((propagator.time(&state) - 2.0).abs() < 1e-12);
    // Two halves of a step backwards end near the state before it, to the order of the method.
    let next = propagator.part(&state, 1.0).unwrap();
    let back = propagator.part(&next, -1.0).unwrap();
    let off = back.iter().zip(&state).take(62).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-13 && next[..50] != state[..50], "{off:e}");
    assert_eq!(next.last(), state.last());
    assert!(propagator.defect(&state) < 1e-13);
    let (mut momentum, mut velocity) = ([0.0; 12], [0.0; 12]);
    propagator.spatial_momentum(&state, &mut momentum);
    propagator.velocity(&state, &mut velocity);
    assert!((momentum[3] - velocity[3]).abs() < 1e-13 && (momentum[9] - 0.5 * velocity[9]).abs() < 1e-13);

    let short = &mut state[1..];
    assert!(matches!(propagator.step(short), Err(StepError::NonFinite { .. })));
    assert!(matches!(propagator.part(short, 0.5), Err(StepError::NonFinite { .. })));
    assert!(propagator.energy(short).is_nan() && propagator.defect(short).is_nan());
    assert!(propagator.adopt(&short[..10]).iter().all(|number| number.is_nan()));
    assert!(propagator.start(&attitude[1..], &[0.0; 12]).is_err());
}

#[test]
fn terms_and_joints_have_places() {
    let refused = |make: &dyn Fn(&mut Multibody)| {
        let mut system = Multibody::new();
        make(&mut system);
        system.stepper(0.01).unwrap_err()
    };
    assert!(matches!(refused(&|_| ()), SetupError::Place { .. }));
    assert!(matches!(refused(&|system| system.on(0, rod(1.0, 0.0))), SetupError::Place { .. }));
    let cord = Cord { k: 1.0, at_1: LEFT, at_2: RIGHT };
    for bodies in [[Some(0), Some(1)], [Some(0), Some(0)], [None, None]] {
        let error = refused(&|system| {
            system.body(rod(1.0, 0.0));
            system.between(bodies, cord);
        });
        assert!(matches!(error, SetupError::Place { .. }), "{error}");
    }
    let error = refused(&|system| {
        system.body(rod(1.0, 0.0));
        system.body(Rod { g: f64::NAN, ..rod(1.0, 0.0) });
    });
    assert!(matches!(error, SetupError::BodyParameter { body: 1, .. }), "{error}");
    let error = refused(&|system| {
        system.body(rod(1.0, 0.0));
        let J_d = NonstandardInertia::from_principal_moments(Vector3::repeat(1.0)).unwrap();
        system.body(Rod { J_d, m: 0.0, ..rod(1.0, 0.0) });
    });
    assert!(matches!(error, SetupError::SingularKinetic { body: Some(1), .. }), "{error}");
}

/// Threads share a stepper, and systems of several shapes a thread.
#[test]
fn steps_have_the_same_bits_on_every_thread() {
    let of = |links: usize, closed: bool| {
        let mut system = Multibody::new();
        for k in 0..links {
            system.body(rod(1.0, 0.0));
            match k.checked_sub(1) {
                None => system.join(ball(Vector3::zeros(), LEFT), None, 0),
                Some(before) => system.join(ball(RIGHT, LEFT), Some(before), k),
            }
        }
        if closed {
            system.join(ball(Vector3::new(1.5, 0.0, 0.0), RIGHT), None, links - 1);
        }
        let stepper = system.stepper(0.01).unwrap();
        let about: Vec<Body> = (0..links).map(|k| row([0.9, -0.2, -1.3]).0[k % 3]).collect();
        let state = stepper.start_nearest(&about, &alloc::vec![Vector6::repeat(0.1); links]).unwrap();
        (stepper, state)
    };
    let systems = [of(2, false), of(3, true), of(2, false), of(3, false)];
    let run = || {
        let mut states: Vec<_> = systems.iter().map(|(_, state)| state.clone()).collect();
        for _ in 0..50 {
            for ((stepper, _), state) in systems.iter().zip(&mut states) {
                stepper.step(state).unwrap();
            }
        }
        states
    };
    let alone: Vec<_> = systems
        .iter()
        .map(|(stepper, state)| {
            let mut state = state.clone();
            stepper.run(&mut state, 50).unwrap();
            state
        })
        .collect();
    let all = std::thread::scope(|scope| {
        let threads = [(); 3].map(|()| scope.spawn(run));
        threads.map(|thread| thread.join().unwrap())
    });
    for states in all {
        assert_eq!(states, alone);
    }
    assert!(systems[1].0.attitude(&alone[1], 0).0 != SO3::identity());
}
