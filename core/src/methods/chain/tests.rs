//! What needs no solved equations: conservation laws of a step with whatever increments.

use std::println;

use nalgebra::{Matrix3, Vector3};

use super::elimination::{Work, newton, outwards};
use super::{Chain, ChainStepper, Link};
use crate::groups::SO3;
use crate::mechanics::NonstandardInertia;
use crate::numbers::Bodies;

/// What is done in the place of a solution.
type Solve<'a> = &'a dyn Fn(&mut [Work]);

fn link(central: Matrix3<f64>, m: f64, c: [f64; 3], rho: [f64; 3]) -> Link {
    let [c, rho] = [c, rho].map(Vector3::from);
    Link { J_d: NonstandardInertia::new(central + c * c.transpose() * m).unwrap(), m, c, rho }
}

/// Links, their attitudes and their velocities.
type Started = (Chain<3>, [SO3; 3], [Vector3<f64>; 3]);

/// Links without any symmetry, under an oblique vertical.
fn oblique() -> Started {
    let central = Matrix3::new(0.3, 0.02, -0.03, 0.02, 0.2, 0.01, -0.03, 0.01, 0.4);
    let links = [
        link(central, 1.2, [0.1, 0.05, -0.5], [0.1, 0.2, -1.0]),
        link(central, 0.7, [0.05, -0.1, -0.4], [-0.2, 0.1, -0.8]),
        link(central, 0.9, [-0.05, 0.1, -0.3], [0.0; 3]),
    ];
    let attitudes = [0.1, 0.5, -0.4].map(|angle| SO3::from_euler_angles(angle, 0.7, -angle));
    let velocities = [[0.5, -1.0, 2.0], [1.0, 0.3, -0.5], [-0.2, 0.4, 1.5]].map(Vector3::from);
    (Chain { links, g: 9.81, up: Vector3::new(0.6, 0.0, 0.8) }, attitudes, velocities)
}

/// `chain3` of the reference data in `tests/data/several_bodies.json`.
fn reference() -> Started {
    let central = |moments: [f64; 3]| {
        let moments = Vector3::from(moments);
        Matrix3::from_diagonal_element(0.5 * moments.sum()) - Matrix3::from_diagonal(&moments)
    };
    let links = [
        link(central([0.1, 0.12, 0.05]), 1.0, [0.1, 0.0, -0.5], [0.0, 0.2, -1.0]),
        link(central([0.06, 0.05, 0.02]), 0.8, [0.0, 0.05, -0.4], [0.1, 0.0, -0.8]),
        link(central([0.03, 0.025, 0.01]), 0.5, [-0.05, 0.0, -0.3], [0.0, 0.0, -0.6]),
    ];
    let attitudes = [[0.5, 0.0, 0.0], [0.0, 0.7, 0.0], [0.3, -0.2, 0.4]].map(|turn| SO3::exp(turn.into()));
    let velocities = [[0.5, -1.0, 2.0], [1.0, 0.3, -0.5], [-0.7, 2.0, 1.5]].map(Vector3::from);
    (Chain { links, g: 9.81, up: Vector3::z() }, attitudes, velocities)
}

/// The momentum about the vertical is kept by increments that solve nothing: the kicks of a step are moments of forces
/// between links, and of weights. Energy isn't kept by them, and momenta grow with it, to a thousand times what they were in
/// the first case; so what rounding may move is relative to the largest.
#[test]
fn momentum_of_badly_solved_steps() {
    let unsolved = |work: &mut [Work]| {
        for work in &mut *work {
            work.half *= 0.999;
        }
        outwards(work);
    };
    let once = |work: &mut [Work]| {
        newton(work, f64::INFINITY);
    };
    let badly: [(f64, u32, Solve<'_>, f64); 3] =
        [(0.01, 10_000, &unsolved, 1e-3), (0.0025, 10_000, &unsolved, 5e-4), (0.01, 100_000, &once, 1e-10)];
    let cases = [oblique(), reference()].into_iter().flat_map(|started| badly.map(|case| (started, case)));
    for ((chain, attitudes, start), (h, steps, solve, off)) in cases {
        let stepper = ChainStepper::new(chain, h).unwrap();
        let mut state = stepper.start(attitudes, Bodies(start)).unwrap();
        let before = stepper.vertical_momentum(&state);
        let (mut least, mut largest) = (f64::INFINITY, 0.0_f64);
        for _ in 0..steps {
            let mut work = [Work::NONE; 3];
            let mut moving = stepper.moving(&mut state, &mut work);
            moving.prepare();
            outwards(moving.work);
            newton(moving.work, f64::INFINITY);
            solve(moving.work);
            // How far one of Newton's iterations would move them, which isn't made.
            let mut more: [Work; 3] = moving.work.try_into().unwrap();
            let update = newton(&mut more, f64::INFINITY);
            least = least.min((update.update / update.size).sqrt());
            assert!(moving.proceed().is_ok());
            largest = state.momentum().0.iter().map(Vector3::norm).fold(largest, f64::max);
        }
        let moved = (stepper.vertical_momentum(&state) - before).abs();
        println!("h = {h}: moved by {moved:.1e} of {largest:.0}; the increments are off by {least:.1e} at least");
        assert!(moved < 1e-13 * largest && least > off, "{moved:e} {largest} {least:e}");
    }
}
