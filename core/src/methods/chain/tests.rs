//! What needs no solved equations: conservation laws of a step with whatever increments.

use std::println;

use nalgebra::{Matrix3, Vector3};

use super::elimination::{newton, velocities};
use super::{Chain, ChainStepper, Link};
use crate::groups::SO3;
use crate::mechanics::NonstandardInertia;
use crate::numbers::Bodies;

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

/// The momentum about the vertical is kept by increments that are off by a thousandth: the kicks of a step are moments of
/// forces between links, and of weights.
#[test]
fn momentum_of_badly_solved_steps() {
    let stepper = ChainStepper::new(chain(), 0.01).unwrap();
    let attitudes = [0.1, 0.5, -0.4].map(|angle| SO3::from_euler_angles(angle, 0.7, -angle));
    let start = [Vector3::new(0.5, -1.0, 2.0), Vector3::new(1.0, 0.3, -0.5), Vector3::new(-0.2, 0.4, 1.5)];
    let mut state = stepper.start(attitudes, Bodies(start)).unwrap();
    let (before, mut least) = (stepper.vertical_momentum(&state), f64::INFINITY);
    for _ in 0..10_000 {
        let badly = |work: &mut [super::elimination::Work; 3], _: &_| {
            let links = &stepper.chain().links[..];
            velocities(links, work);
            for work in work.iter_mut() {
                work.half = work.z * 0.4995;
            }
            // How far one of Newton's iterations would move it, which isn't made.
            let mut solved = *work;
            let update = newton(links, &mut solved, f64::INFINITY);
            least = least.min((update.update / update.size).sqrt());
            Ok(0)
        };
        stepper.step_by(&mut state, badly).unwrap();
    }
    let moved = (stepper.vertical_momentum(&state) - before).abs();
    println!("momentum {before}, moved by {moved:.1e}; the increments are off by {least:.1e} at least");
    assert!(moved < 2e-12 && least > 1e-4, "{moved:e} {least:e}");
}
