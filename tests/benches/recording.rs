//! The cost of recording a run, in time and memory.
//!
//! ```text
//! cargo bench --bench recording                       times a step of a run that is recorded at every tenth
//! cargo bench --bench recording -- instructions       counts instructions instead, by valgrind
//! cargo bench --bench recording -- memory 100000000   makes 100000000 steps, recorded as a file, and prints the most memory
//! ```
//!
//! `columns` passes rows to a sink that does nothing, which measures the run's own cost; a sink in a thread of its own
//! adds the transfer of a block. Valgrind counts the instructions of all threads.

mod counting;

use core::hint::black_box;
use std::error::Error;
use std::time::Instant;

use liestep::effects::{Gravity, RigidBody};
use liestep::recording::{Background, Column, Csv, Recorder, Sink, SinkError};
use liestep::{NonstandardInertia, Stepper};
use nalgebra::{UnitQuaternion, Vector3};

use counting::instructions;

const BATCH: u32 = 20_000;
const ROUNDS: u32 = 100;
const COUNTED: u32 = 20_480;
const WAYS: [&str; 6] = ["unobserved", "observed", "columns", "csv", "csv in a thread", "events"];

/// A sink that discards rows.
struct Nowhere;

impl Sink for Nowhere {
    fn begin(&mut self, _: &[Column]) -> Result<(), SinkError> {
        Ok(())
    }

    fn write(&mut self, rows: &[f64]) -> Result<(), SinkError> {
        black_box(rows);
        Ok(())
    }

    fn end(&mut self) -> Result<(), SinkError> {
        Ok(())
    }
}

/// Runs a top for this number of steps.
fn run(way: &str, steps: u32) -> Result<(), Box<dyn Error>> {
    let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 1.5, 1.0))? };
    let top = body + Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let stepper = black_box(Stepper::new(top, 0.01)?);
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
    let mut state = stepper.start(attitude, Vector3::new(0.5, 2.0, 12.0))?;
    let steps = u64::from(steps);
    macro_rules! recorded {
        ($sink:expr) => {{
            let mut recorder = Recorder::new(&stepper, $sink);
            stepper.observed(&mut state).every(10, |now| recorder.record(now)).steps(steps)?;
            recorder.finish()?;
        }};
    }
    match way {
        "unobserved" => drop(stepper.run(&mut state, steps)?),
        "observed" => {
            stepper
                .observed(&mut state)
                .every(10, |now| {
                    black_box(now);
                })
                .steps(steps)?;
        }
        "columns" => recorded!(Nowhere),
        "csv" => recorded!(Csv::new(std::io::sink())),
        "csv in a thread" => recorded!(Background::new(Csv::new(std::io::sink()))),
        "events" => {
            // The event never happens.
            let event = liestep::recording::Event::crossing();
            stepper.observed(&mut state).event(event, |now| now.momentum().x + 1e3, |_| ()).steps(steps)?;
        }
        other => return Err(format!("there is no way `{other}`").into()),
    }
    black_box(state);
    Ok(())
}

/// The best of many rounds of each way, one after the other, so that other load of the machine affects all of them.
fn nanoseconds() -> Result<[f64; WAYS.len()], Box<dyn Error>> {
    let mut best = [f64::INFINITY; WAYS.len()];
    for _ in 0..ROUNDS {
        for (best, way) in best.iter_mut().zip(WAYS) {
            let start = Instant::now();
            run(way, BATCH)?;
            *best = best.min(start.elapsed().as_secs_f64() * 1e9 / f64::from(BATCH));
        }
    }
    Ok(best)
}

fn compare(unit: &str, costs: &[f64]) {
    for (way, cost) in WAYS.iter().zip(costs) {
        println!("{way:<20}{cost:>10.1} {unit} a step{:>+9.1} %", 100.0 * (cost / costs[0] - 1.0));
    }
}

/// The peak memory of this process, as Linux reports it.
fn most_memory() -> Result<String, Box<dyn Error>> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    Ok(line.ok_or("the most memory isn't told here")?.trim().to_owned())
}

fn main() -> Result<(), Box<dyn Error>> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments.as_slice() {
        ["instructions"] => {
            let program = std::env::current_exe()?;
            let counts = WAYS.map(|way| instructions(&program, &["count", way], COUNTED));
            compare("instructions", &counts.into_iter().collect::<Result<Vec<_>, _>>()?);
            Ok(())
        }
        ["count", way, steps] => run(way, steps.parse()?),
        ["memory", steps] => {
            for way in ["csv", "csv in a thread"] {
                run(way, steps.parse()?)?;
                println!("{steps} steps, {way}: {}", most_memory()?);
            }
            Ok(())
        }
        _ => {
            compare("ns", &nanoseconds()?);
            Ok(())
        }
    }
}
