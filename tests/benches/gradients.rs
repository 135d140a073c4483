//! The cost of the derivatives of a heavy top's steps, in plain steps of the same method.
//!
//! ```text
//! cargo bench --bench gradients                               times, side by side
//! cargo bench --bench gradients -- instructions               counts instructions, by valgrind
//! cargo bench --bench gradients -- count METHOD NAME 1000     runs 1000 steps with one and nothing else
//! ```
//!
//! The methods are (3.13), a splitting with force gradients and a processed one with outputs after each step, each for
//! a general body and for a symmetric one. The parameters are the three of the attitude and of the momentum at the
//! start, three moments, `m g` and three of the centre of mass, together with `up` and, for the exact flow, the turns
//! of its axes. An `adjoint` has a cost at the end of the run, `costs` has one at each step. All take turns within one
//! run, and the fastest batch of each counts.

mod counting;

use core::hint::black_box;
use std::time::Instant;

use liestep::gradients::{Cotangent, Linearisable, Tape};
use liestep::mechanics::{DiagonalNonstandardInertia, Inertia};
use liestep::methods::{ExactBody, ProcessedScheme, SplittingScheme, SymmetricBody};
use liestep::{SO3, Stepper, lagrangian};
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

const METHODS: [&str; 5] = ["(3.13)", "gradient", "processed", "symmetric gradient", "symmetric processed"];
const NAMES: [&str; 7] = ["step", "transition", "columns", "adjoint", "costs", "checkpoints", "backwards"];
const BATCH: u64 = 1_000;
const ROUNDS: usize = 100;

/// Runs this number of steps, with the derivatives of this name.
type Run = Box<dyn Fn(&str, u64) -> Result<(), Uncounted>>;

/// A method with its initial state, ready to be run.
fn method(name: &str) -> Result<Run, Uncounted> {
    let is_symmetric = name.starts_with("symmetric");
    let moments = if is_symmetric { Vector3::new(2.0, 2.0, 3.5) } else { Vector3::new(2.0, 3.0, 4.5) };
    let J_d = DiagonalNonstandardInertia::from_principal_moments(moments)?;
    let top = Top { J_d, weight: 9.81, rho: Vector3::new(0.3, 0.2, 0.4), up: Vector3::z() };
    let inertia = Inertia::from_principal_moments(moments)?;
    let (flow, h) = (ExactBody::new(&inertia), black_box(0.01));
    let (gradient, processed) = (SplittingScheme::FORCE_GRADIENT_5, ProcessedScheme::SIX_A);
    match name {
        "(3.13)" => ready(Stepper::new(top, h)?),
        "gradient" => ready(Stepper::split(top, h, flow, gradient)?),
        "processed" => ready(Stepper::processed(top, h, flow, processed)?),
        "symmetric gradient" => ready(Stepper::split(top, h, SymmetricBody::new(&inertia)?, gradient)?),
        "symmetric processed" => ready(Stepper::processed(top, h, SymmetricBody::new(&inertia)?, processed)?),
        other => Err(format!("there is no method `{other}`, but {METHODS:?}").into()),
    }
}

fn ready<P: Linearisable<Top> + 'static>(stepper: Stepper<Top, P>) -> Result<Run, Uncounted> {
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
    let start = stepper.start(attitude, Vector3::new(0.5, 2.0, 6.0))?;
    Ok(Box::new(move |name, steps| {
        let (linear, mut state) = (stepper.linearised()?, black_box(start));
        let cost = |n: u64, _: &_| {
            if n == steps || name == "costs" {
                Cotangent { attitude: Vector3::x(), momentum: Vector3::z() }
            } else {
                Cotangent::zero()
            }
        };
        match name {
            "step" => {
                for _ in 0..steps {
                    stepper.step(&mut state)?;
                }
            }
            "transition" | "columns" => {
                // The moments are those of the flow, if there is one, otherwise the diagonal; then weight and centre of
                // mass.
                let moments = linear.numbers(1, "moment").map_or(vec![0, 4, 8], Iterator::collect);
                let all: Vec<_> = moments.into_iter().chain(9..13).collect();
                let mut tangent = linear.tangent(if name == "columns" { &all } else { &[] });
                for _ in 0..steps {
                    linear.step(&mut state, &mut tangent)?;
                }
                black_box(tangent);
            }
            "adjoint" | "costs" | "checkpoints" => {
                let tape = if name == "checkpoints" { Tape::SquareRoot } else { Tape::All };
                black_box(linear.adjoint(&mut state, steps, tape, cost)?);
            }
            "backwards" => {
                black_box(linear.backwards()?.adjoint(&mut state, steps, cost)?);
            }
            other => return Err(format!("there is no `{other}`, but {NAMES:?}").into()),
        }
        black_box(state);
        Ok(())
    }))
}

/// Prints a line for each method and name, with a number per step.
fn table(unit: &str, of: impl Fn(usize, usize) -> f64) {
    for (i, method) in METHODS.iter().enumerate() {
        for (j, name) in NAMES.iter().enumerate() {
            println!("{method:<20}{name:<12}{:>10.1} {unit} a step{:>8.2} steps", of(i, j), of(i, j) / of(i, 0));
        }
    }
}

fn times() -> Result<(), Uncounted> {
    let methods = METHODS.into_iter().map(method).collect::<Result<Vec<_>, _>>()?;
    let mut best = [[f64::INFINITY; NAMES.len()]; METHODS.len()];
    for _ in 0..ROUNDS {
        for (run, best) in methods.iter().zip(&mut best) {
            for (name, best) in NAMES.iter().zip(best) {
                let begin = Instant::now();
                run(name, BATCH)?;
                #[allow(clippy::cast_precision_loss)] // a thousand
                let time = begin.elapsed().as_secs_f64() * 1e9 / BATCH as f64;
                *best = best.min(time);
            }
        }
    }
    table("ns", |i, j| best[i][j]);
    Ok(())
}

fn main() -> Result<(), Uncounted> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["count", by, name, steps] => method(by)?(name, steps.parse()?),
        ["instructions"] => {
            let program = std::env::current_exe()?;
            let counted = |method: &str| -> Result<Vec<f64>, Uncounted> {
                NAMES.iter().map(|name| instructions(&program, &["count", method, name], 2_000)).collect()
            };
            let all = METHODS.into_iter().map(counted).collect::<Result<Vec<_>, _>>()?;
            table("instructions", |i, j| all[i][j]);
            Ok(())
        }
        _ => times(),
    }
}
