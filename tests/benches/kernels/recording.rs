//! The cost of recording a run, in time and memory.
//!
//! `columns` passes rows to a sink that does nothing, which measures the run's own cost; a sink in a thread of its own
//! adds the transfer of a block. Valgrind counts the instructions of all threads.

use core::hint::black_box;

use liestep::effects::{Gravity, RigidBody};
use liestep::recording::{Background, Column, Csv, Recorder, Sink, SinkError};
use liestep::{NonstandardInertia, Stepper};
use nalgebra::{UnitQuaternion, Vector3};

use crate::kernel::{Effort, Failure, Group, Kernel};
use crate::most_memory;

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
fn run(way: &str, steps: u32) -> Result<(), Failure> {
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
        _ => {
            // The event of the benchmark never happens.
            let event = liestep::recording::Event::crossing();
            stepper.observed(&mut state).event(event, |now| now.momentum().x + 1e3, |_| ()).steps(steps)?;
        }
    }
    black_box(state);
    Ok(())
}

pub(crate) fn groups() -> Vec<Group> {
    let kernel = |way: &'static str| {
        Kernel::new(way, move || {
            Ok(move |steps| {
                run(way, steps)?;
                Ok(0)
            })
        })
    };
    vec![Group::new("", Effort { batch: 20_000, rounds: 100, counted: 20_480 }, WAYS.map(kernel))]
}

/// Prints the most memory of a run of this number of steps, recorded as a file.
pub(crate) fn memory(steps: u32) -> Result<(), Failure> {
    for way in ["csv", "csv in a thread"] {
        run(way, steps)?;
        println!("{steps} steps, {way}: {}", most_memory());
    }
    Ok(())
}
