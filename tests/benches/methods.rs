//! The cost of a step of every method in `accuracy-cost`: nanoseconds and instructions.
//!
//! ```text
//! cargo bench --bench methods                                  times a step of each, in three scenes
//! cargo bench --bench methods -- chaotic                       in any of looping, cuspidal, third, chaotic and free
//! cargo bench --bench methods -- instructions chaotic          counts instructions instead, by valgrind
//! cargo bench --bench methods -- count chaotic NAME 1000       runs 1000 steps of one method and nothing else
//! ```
//!
//! The steps are of `h = 0.01 s`. Valgrind supports AVX2 if the machine does, and Gauss collocation uses it: its stages
//! are in vector registers, so that eight cost less than six under gravity. Without vectorisation they would cost twice
//! as much.

mod counting;

use core::hint::black_box;
use std::error::Error;
use std::time::Instant;

use accuracy_cost::methods::{self, Method, Prepared};
use accuracy_cost::scenes::Scene;

use counting::instructions;

const STEP: f64 = 0.01;
/// Long enough to hide the clock, short enough that some batches aren't disturbed by other processes.
const BATCH: u32 = 500;
const ROUNDS: u32 = 40;
/// Enough for a count, and at most a second of the most expensive method.
const COUNTED: u32 = 500;

/// A run of this number of steps.
fn prepared(method: &Method, scene: &Scene, steps: u32) -> Result<Prepared, Box<dyn Error>> {
    let prepared = (method.prepare)(scene, f64::from(steps) * STEP, STEP);
    prepared.ok_or_else(|| format!("{} can't be set up", method.name).into())
}

/// Nanoseconds a step, by the fastest batch.
fn time(method: &Method, scene: &Scene) -> Result<f64, Box<dyn Error>> {
    let run = prepared(method, scene, BATCH)?;
    let mut best = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        black_box(run()).ok_or_else(|| format!("a step of {} failed", method.name))?;
        best = best.min(start.elapsed().as_secs_f64());
    }
    Ok(best * 1e9 / f64::from(BATCH))
}

/// The methods whose steps are of one length.
fn methods(scene: &Scene) -> impl Iterator<Item = Method> {
    methods::all(scene).into_iter().filter(Method::steps_are_equal)
}

/// Prints a line for each method: its cost, and the ratio to the first one's.
fn compare(
    scene: &Scene,
    unit: &str,
    cost: impl Fn(&Method) -> Result<f64, Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    println!("\n{:<44}{unit:>14} a step{:>12}", scene.name, "(3.13) = 1");
    let mut first = None;
    for method in methods(scene) {
        let cost = cost(&method)?;
        println!("{:<44}{cost:>21.1}{:>12.2}", method.name, cost / *first.get_or_insert(cost));
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let all = Scene::all();
    let called =
        |name: &str| all.iter().find(|scene| scene.short == name).ok_or_else(|| format!("there is no scene `{name}`"));
    match arguments.as_slice() {
        ["instructions", name] => {
            let (scene, program) = (called(name)?, std::env::current_exe()?);
            compare(scene, "instructions", |method| instructions(&program, &["count", name, &method.name], COUNTED))
        }
        ["count", scene, name, steps] => {
            let scene = called(scene)?;
            let method = methods(scene).find(|method| method.name == *name);
            let method = method.ok_or_else(|| format!("there is no method `{name}`"))?;
            black_box(prepared(&method, scene, steps.parse()?)?()).ok_or("a step failed")?;
            Ok(())
        }
        names => {
            let names = if names.is_empty() { &["looping", "chaotic", "free"] } else { names };
            names.iter().try_for_each(|name| {
                let scene = called(name)?;
                compare(scene, "ns", |method| time(method, scene))
            })
        }
    }
}
