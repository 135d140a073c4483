//! Lanes with different control flow: bodies of a row converge later, turn farther, or are off the group.

use core::fmt::Debug;

use declarations::Alike;
use liestep::groups::LieGroup as _;
use liestep::laws::samples::Random;
use liestep::mechanics::{Along, Each, Placement, Sum};
use liestep::motion::{Batchable, Integrator};
use liestep::numbers::{Bodies, Lanes as _};
use liestep::{SO3, StepError, Stepper};
use nalgebra::Vector3;
use simba::simd::AutoF64x4;

use super::{TurningBody, assert_each_is_alone, compensated, inertia, links, start, together, vector};
use crate::several_bodies::{assert_same, started};

type Row = Sum<Placement<Each<4>, TurningBody<f64>, 4>, Placement<Along<4>, Alike<f64>, 1>>;

/// Four bodies with alignment potentials.
fn row(random: &mut Random) -> Row {
    Each::<4>::of([0, 1, 2, 3].map(|_| TurningBody { J_d: inertia::<f64>(random) }))
        + Along::<4>::of([Alike { kappa: 2.0 + vector(random).x }])
}

/// Compares one step of each lane, from a thousandth to nearly all of its longest one. The lanes converge one after the
/// other, the last after more than `most` iterations, and a converged lane stays as it is.
fn part_in_a_solve<M>(
    started: impl Fn(&mut Random, f64) -> (M, M::State),
    longest: fn(&(M, M::State)) -> f64,
    most: u32,
) where
    M: Batchable<AutoF64x4> + Integrator<State: PartialEq + Debug>,
{
    let parted = |first: u64| {
        let bodies = [(0, 1e-3), (1, 0.3), (2, 0.999_99), (3, 0.9)].map(|(lane, fraction)| {
            let started = |h: f64| started(&mut Random::new(first + lane), h);
            started(fraction * longest(&started(1.0)))
        });
        let alone = bodies.iter().map(|(stepper, state)| {
            let mut state = state.clone();
            let report = stepper.step(&mut state).ok()?;
            Some((report.iterations, state))
        });
        let alone: Vec<_> = alone.collect::<Option<_>>()?;
        let mut iterations: Vec<u32> = alone.iter().map(|alone| alone.0).collect();
        iterations.sort_unstable();
        let do_part = iterations.is_sorted_by(|a, b| a < b) && iterations[3] > most;
        do_part.then_some((bodies, alone, iterations))
    };
    let (bodies, alone, iterations) = (0..100).find_map(|seed| parted(4 * seed)).unwrap();
    println!("{iterations:?}");
    let (stepper, mut state) = together(&bodies);
    assert!(stepper.step(&mut state).unwrap().iterations >= iterations[3]);
    for (lane, (_, alone)) in alone.iter().enumerate() {
        assert_same(&state.lane(lane), alone);
    }
}

#[test]
fn lanes_that_part_in_a_solve() {
    let pendulum = |random: &mut Random, h: f64| started(links(random), h, start(random, 1.0));
    // One lane needs another start than the velocity: from one start there are at most twenty iterations.
    part_in_a_solve(pendulum, |(stepper, state)| stepper.max_step(state), 20);
    let in_a_row = |random: &mut Random, h: f64| {
        let (row, attitudes) = (row(random), [0, 1, 2, 3].map(|_| SO3::exp(vector(random))));
        started(row, h, (attitudes, Bodies([0, 1, 2, 3].map(|_| vector(random) * 5.0))))
    };
    // Bodies of a row have only one start, and one lane is near its limit.
    part_in_a_solve(in_a_row, |(stepper, state)| stepper.max_step(state), 10);
}

/// After an increment far from the identity the next guess is that increment, in its lane alone: the other lanes use
/// the line through their last two.
#[test]
fn lanes_that_are_far_guess_by_themselves() {
    let random = &mut Random::new(37);
    let bodies = [0, 1, 2, 3].map(|lane| {
        let row = row(random);
        let mut velocities = [0, 1, 2, 3].map(|_| vector(random) * 3.0);
        if lane == 2 {
            // The body turns by 75° a step, about a principal axis.
            velocities[1] = Vector3::z() * (75.0_f64.to_radians().sin() / 0.02);
        }
        started(row, 0.02, ([0, 1, 2, 3].map(|_| SO3::exp(vector(random))), Bodies(velocities)))
    });
    assert_each_is_alone(&bodies, 20);
    let (stepper, mut state) = bodies[2].clone();
    stepper.step(&mut state).unwrap();
    assert!(bodies[2].1.attitude()[1].inverse().compose(&state.attitude()[1]).log().norm() > 1.2);
}

/// An attitude as far from the group as a start may be, and farther than the limit of corrections: `RᵀR − I` is `2√3`
/// times this, 1.4e-12.
fn off(attitude: SO3) -> SO3 {
    SO3::from_matrix_unchecked(attitude.matrix() * (1.0 + 4e-13))
}

/// In each lane only the body off the group is restored, and its relative parameters with it; all others stay as they
/// are.
#[test]
fn what_is_off_the_group_is_restored_lane_by_lane() {
    let random = &mut Random::new(38);
    let bodies = [0, 1, 2, 3].map(|lane| {
        let row = row(random);
        let mut attitudes = [0, 1, 2, 3].map(|_| SO3::exp(vector(random)));
        for (of, body) in [(1, 2), (3, 0)] {
            if lane == of {
                attitudes[body] = off(attitudes[body]);
            }
        }
        started(row, 0.02, (attitudes, Bodies([0, 1, 2, 3].map(|_| vector(random)))))
    });
    let defect = |(stepper, state): &(Stepper<Row>, <Stepper<Row> as Integrator>::State), steps: u64| {
        let mut state = *state;
        stepper.run(&mut state, steps).unwrap();
        state.attitude().defect()
    };
    assert!(defect(&bodies[1], 0) > 1e-12 && defect(&bodies[1], 1100) < 1e-13);
    assert_each_is_alone(&bodies, 1100);
    assert_each_is_alone(&bodies.map(compensated), 1100);

    let pendulums = [0, 1, 2, 3].map(|lane| {
        let (links, ((first, second), velocity)) = (links(random), start(random, 1.0));
        let attitudes = match lane {
            0 => (first, off(second)),
            2 => (off(first), second),
            _ => (first, second),
        };
        started(links, 0.005, (attitudes, velocity))
    });
    assert_each_is_alone(&pendulums, 1100);
}

/// If several lanes have no solution, the error names the lane that would turn farthest, and the body in it that would.
#[test]
fn the_farthest_body_of_all_lanes_is_named() {
    let h = 0.02;
    for bodies_of in [[3, 1], [1, 3], [2, 2]] {
        let random = &mut Random::new(39);
        let bodies = [0, 1, 2, 3].map(|lane| {
            let (row, attitudes) = (row(random), [0, 1, 2, 3].map(|_| SO3::exp(vector(random))));
            let mut velocities = [0, 1, 2, 3].map(|_| vector(random));
            match lane {
                0 => velocities[bodies_of[0]] = Vector3::z() * 500.0,
                2 => velocities[bodies_of[1]] = Vector3::x() * 700.0,
                _ => {}
            }
            started(row, h, (attitudes, Bodies(velocities)))
        });
        let (stepper, mut state) = together(&bodies);
        let error = stepper.step(&mut state).unwrap_err();
        let StepError::BeyondSolvable { turn, body, .. } = error else { panic!("{error:?}") };
        assert_eq!(body, Some(bodies_of[1]), "{error:?}");
        // The kick changes the velocity only by `h κ/J`, a ten-thousandth.
        assert!((turn / (700.0 * h) - 1.0).abs() < 1e-2, "{turn}");
        for (lane, (_, start)) in bodies.iter().enumerate() {
            assert_same(&state.lane(lane), start);
        }
    }
}
