//! The cost of a step of the heavy top with each declared Lagrangian, as a multiple of a step of (3.13).
//!
//! ```text
//! cargo bench --bench kinetic-terms
//! cargo bench --bench kinetic-terms -- count L6 1000       runs 1000 steps of one and nothing else
//! ```
//!
//! All tops are the same body with a full inertia tensor. They take turns within one run, and the fastest batch of each
//! counts. Instructions a step are a difference of two counts, as in `heavy_top_step.rs`.

use core::hint::black_box;
use std::time::Instant;

use declarations::{CayleyTop, FourthOrderTop, FullTop, LogTop, SixthOrderTop};
use liestep::mechanics::{DiscreteLagrangian, Inertia, Regular};
use liestep::{SO3, Stepper};
use nalgebra::{UnitQuaternion, Vector3};

const STEPS: [f64; 2] = [0.01, 0.05];
/// Short enough that some batches aren't disturbed by other processes.
const BATCH: u32 = 500;
const ROUNDS: usize = 200;

const MOMENTS: Vector3<f64> = Vector3::new(3.0, 3.0, 4.0);
const WEIGHT: f64 = 9.81;

/// A batch of steps: nanoseconds and Newton iterations a step.
type Batch = Box<dyn FnMut(u32) -> (f64, f64)>;

fn batches<L>(lagrangian: L, h: f64) -> Batch
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Regular + 'static,
{
    let stepper = Stepper::new(lagrangian, h).expect("a usable step");
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
    let mut state = stepper.start(attitude, Vector3::new(0.5, 2.15, 12.09)).expect("a usable start");
    Box::new(move |steps| {
        let start = Instant::now();
        let mut iterations = 0;
        for _ in 0..steps {
            iterations += black_box(&stepper).step(&mut state).expect("a solvable step").iterations;
        }
        (start.elapsed().as_secs_f64() * 1e9 / f64::from(steps), f64::from(iterations) / f64::from(steps))
    })
}

fn all(h: f64) -> [(&'static str, Batch); 5] {
    let J = Inertia::from_principal_moments(MOMENTS).expect("a body");
    let (weight, rho, up) = (WEIGHT, Vector3::z(), Vector3::z());
    let full = FullTop { J_d: J.to_nonstandard(), m: 1.0, g: weight, rho, up };
    [
        ("(3.13)", batches(full, h)),
        ("Cayley", batches(CayleyTop { J, weight, rho, up }, h)),
        ("log", batches(LogTop { J, weight, rho, up }, h)),
        ("L4", batches(FourthOrderTop { J, weight, rho, up }, h)),
        ("L6", batches(SixthOrderTop { J, weight, rho, up }, h)),
    ]
}

fn compare(h: f64) {
    let mut tops = all(h);
    let mut best = [(f64::INFINITY, 0.0); 5];
    for _ in 0..ROUNDS {
        for ((_, batch), best) in tops.iter_mut().zip(&mut best) {
            let found = batch(BATCH);
            if found.0 < best.0 {
                *best = found;
            }
        }
    }
    println!("{:<12}{:>12}{:>12}{:>12}", format!("h = {h}"), "ns a step", "(3.13) = 1", "iterations");
    for ((name, _), (time, iterations)) in tops.iter().zip(best) {
        println!("{name:<12}{time:>12.1}{:>12.1}{iterations:>12.2}", time / best[0].0);
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["count", name, steps] => {
            let steps = steps.parse().expect("a number of steps");
            let mut tops = all(STEPS[0]);
            let (_, batch) = tops.iter_mut().find(|(known, _)| known == name).expect("(3.13), Cayley, log, L4 or L6");
            black_box(batch(steps));
        }
        _ => STEPS.into_iter().for_each(compare),
    }
}
