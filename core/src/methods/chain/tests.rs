//! What needs no solved equations: conservation laws of a step with whatever increments.

use std::println;

use nalgebra::{Matrix3, Vector3};

use super::elimination::{Work, newton, velocities};
use super::{Chain, ChainStepper, Link};
use crate::groups::SO3;
use crate::mechanics::NonstandardInertia;
use crate::numbers::Bodies;

/// What is done in the place of a solution.
type Solve<'a> = &'a dyn Fn(&[Link], &mut [Work]);

/// Links without any symmetry.
fn chain() -> Chain<3> {
    let link = |m: f64, c: Vector3<f64>, rho: Vector3<f64>| {
        let central = Matrix3::new(0.3, 0.02, -0.03, 0.02, 0.2, 0.01, -0.03, 0.01, 0.4);
        Link { J_d: NonstandardInertia::new(central + c * c.transpose() * m).unwrap(), m, c, rho }
    };
    let links = [
        link(1.2, Vector3::new(0.1, 0.05, -0.5), Vector3::new(0.1, 0.2, -1.0)),
        link(0.7, Vector3::new(0.05, -0.1, -0.4), Vector3::new(-0.2, 0.1, -0.8)),
        link(0.9, Vector3::new(-0.05, 0.1, -0.3), Vector3::zeros()),
    ];
    Chain { links, g: 9.81, up: Vector3::new(0.6, 0.0, 0.8) }
}

/// The momentum about the vertical is kept by increments that solve nothing: the kicks of a step are moments of forces
/// between links, and of weights. Energy isn't kept by them, and momenta grow with it, to a thousand times what they were in
/// the first case; so what rounding may move is relative to the largest.
#[test]
fn momentum_of_badly_solved_steps() {
    let unsolved = |_: &[Link], work: &mut [Work]| work.iter_mut().for_each(|work| work.half *= 0.999);
    let once = |links: &[Link], work: &mut [Work]| {
        newton(links, work, f64::INFINITY);
    };
    let badly: [(f64, u32, Solve<'_>, f64); 3] =
        [(0.01, 10_000, &unsolved, 1e-3), (0.0025, 10_000, &unsolved, 5e-4), (0.01, 100_000, &once, 1e-10)];
    for (h, steps, solve, off) in badly {
        let stepper = ChainStepper::new(chain(), h).unwrap();
        let links = &stepper.chain().links[..];
        let attitudes = [0.1, 0.5, -0.4].map(|angle| SO3::from_euler_angles(angle, 0.7, -angle));
        let start = [Vector3::new(0.5, -1.0, 2.0), Vector3::new(1.0, 0.3, -0.5), Vector3::new(-0.2, 0.4, 1.5)];
        let mut state = stepper.start(attitudes, Bodies(start)).unwrap();
        let before = stepper.vertical_momentum(&state);
        let (mut least, mut largest) = (f64::INFINITY, 0.0_f64);
        for _ in 0..steps {
            let mut work = stepper.prepared(&state);
            velocities(links, &mut work);
            for work in &mut work {
                work.half = work.z * 0.5;
            }
            solve(links, &mut work);
            // How far one of Newton's iterations would move them, which isn't made.
            let update = newton(links, &mut work.clone(), f64::INFINITY);
            least = least.min((update.update / update.size).sqrt());
            stepper.proceed(&mut state, &mut work).unwrap();
            largest = state.momentum().0.iter().map(Vector3::norm).fold(largest, f64::max);
        }
        let moved = (stepper.vertical_momentum(&state) - before).abs();
        println!("h = {h}: moved by {moved:.1e} of {largest:.0}; the increments are off by {least:.1e} at least");
        assert!(moved < 1e-13 * largest && least > off, "{moved:e} {largest} {least:e}");
    }
}
