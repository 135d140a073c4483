//! What derivatives of the steps of a heavy top cost, in plain steps.
//!
//! ```text
//! cargo bench --bench gradients                        times, side by side
//! cargo bench --bench gradients -- instructions        counts instructions, by valgrind
//! cargo bench --bench gradients -- count NAME 1000     runs 1000 steps with one and nothing else
//! ```
//!
//! The numbers are the three of the attitude and of the momentum at the start, three moments, `m g` and three of the
//! centre of mass, and with them what the declaration has besides: `up`, in the sum also mass and `g` apart. All take
//! turns within one run, and the fastest batch of each counts.

// The letters of the field.
#![allow(non_snake_case)]

mod counting;

use core::hint::black_box;
use std::time::Instant;

use liestep::mechanics::DiagonalNonstandardInertia;
use liestep::motion::linearised::{Cotangent, Tape};
use liestep::{SO3, State, Stepper, lagrangian};
use nalgebra::{UnitQuaternion, Vector3};

use counting::{Uncounted, instructions};

/// (3.13) in principal axes.
#[lagrangian(
    group = SO3,
    advected(w = up),
    gradients,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * weight * w.dot(&(rho + F * rho)),
)]
#[derive(Clone)]
struct Top {
    J_d: DiagonalNonstandardInertia,
    weight: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

type Start = State<SO3, Vector3<f64>>;

const NAMES: [&str; 6] = ["step", "transition", "columns", "adjoint", "checkpoints", "backwards"];
const BATCH: u64 = 1_000;
const ROUNDS: usize = 200;

fn top() -> (Stepper<Top>, Start) {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).expect("a body");
    let top = Top { J_d, weight: 9.81, rho: Vector3::new(0.3, 0.2, 0.4), up: Vector3::z() };
    let stepper = Stepper::new(top, 0.01).expect("a usable step");
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
    let state = stepper.start(attitude, Vector3::new(0.5, 2.0, 6.0)).expect("a usable start");
    (stepper, state)
}

/// So many steps, and the derivatives that the name stands for.
fn run(name: &str, stepper: &Stepper<Top>, start: &Start, steps: u64) {
    let linear = stepper.linearised().expect("derivatives");
    let mut state = *start;
    let cost = |n: u64, _: &_| {
        if n == steps { Cotangent { attitude: Vector3::x(), momentum: Vector3::z() } } else { Cotangent::zero() }
    };
    match name {
        "step" => {
            for _ in 0..steps {
                stepper.step(&mut state).expect("a step");
            }
        }
        "transition" | "columns" => {
            // The moments on the diagonal, the weight, the centre of mass.
            let numbers: &[usize] = if name == "columns" { &[0, 4, 8, 9, 10, 11, 12] } else { &[] };
            let mut tangent = linear.tangent(numbers);
            for _ in 0..steps {
                linear.step(&mut state, &mut tangent).expect("a step");
            }
            black_box(tangent);
        }
        "adjoint" | "checkpoints" => {
            let tape = if name == "adjoint" { Tape::All } else { Tape::SquareRoot };
            black_box(linear.adjoint(&mut state, steps, tape, cost).expect("a gradient"));
        }
        _ => {
            let backwards = linear.backwards().expect("steps back");
            black_box(backwards.adjoint(&mut state, steps, cost).expect("a gradient"));
        }
    }
    black_box(state);
}

fn times() {
    let (stepper, start) = top();
    let mut best = [f64::INFINITY; NAMES.len()];
    for _ in 0..ROUNDS {
        for (name, best) in NAMES.iter().zip(&mut best) {
            let begin = Instant::now();
            run(name, black_box(&stepper), black_box(&start), BATCH);
            #[allow(clippy::cast_precision_loss)] // a thousand
            let time = begin.elapsed().as_secs_f64() * 1e9 / BATCH as f64;
            *best = best.min(time);
        }
    }
    for (name, time) in NAMES.iter().zip(best) {
        println!("{name:<12}{time:>10.1} ns a step{:>8.2} steps", time / best[0]);
    }
}

fn main() -> Result<(), Uncounted> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["count", name, steps] => {
            let (stepper, start) = top();
            run(name, &stepper, &start, steps.parse()?);
        }
        ["instructions"] => {
            let counted = |name: &str| instructions(&std::env::current_exe()?, &["count", name], 2_000);
            let step = counted("step")?;
            for name in NAMES {
                let found = counted(name)?;
                println!("{name:<12}{found:>10.1} instructions a step{:>8.2} steps", found / step);
            }
        }
        _ => times(),
    }
    Ok(())
}
