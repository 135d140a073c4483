//! The references for Python, steps in Rust: `cargo run --release -p liestep-python --example beside -- bits`, `steps` or `members FOLDER`.
//!
//! `bits` prints the momentum of the compiled top (3.13) after a thousand steps; `steps` the seconds of a million steps of the
//! declaration as text, a row each thousand; `members` those of 100,000 members with a hundred steps each.

// Names of fields are the letters of the field of mechanics.
#![allow(non_snake_case)]

use std::time::Instant;

use liestep::motion::AnyStepper;
use liestep::recording::Recorder;
use liestep::with::Method;
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use liestep_ensemble::{Ensemble, Local, Store};
use liestep_late::{Declaration, WholeError, stepper};
use liestep_machine::Machine;
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
#[derive(Clone, Debug)]
struct HeavyTop {
    J_d: NonstandardInertia,
    m: f64,
    g: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

type Error = Box<dyn std::error::Error>;

/// The declaration read at run time, and its numbers.
fn text() -> Result<(&'static Declaration, Vec<f64>), Error> {
    let top = Declaration::parse(
        "#[lagrangian(group = SO3, advected(w = up), l_d =
            ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * m * g * w.dot(&(rho + F * rho)))]
        struct Top { J_d: NonstandardInertia, m: f64, g: f64, rho: Vector3<f64>, up: Vector3<f64> }",
    )?;
    let numbers: [(&str, &[f64]); 5] =
        [("J_d", &[2.0, 2.0, 1.0]), ("m", &[1.0]), ("g", &[9.81]), ("rho", &[0.0, 0.0, 1.0]), ("up", &[0.0, 0.0, 1.0])];
    Ok((top, top.numbers(&numbers)?))
}

/// A stepper of it by machine code, as in Python.
fn machine((top, numbers): &(&'static Declaration, Vec<f64>)) -> Result<AnyStepper, WholeError> {
    stepper::<Machine>(top, numbers, 0.01, Method::default())
}

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

fn main() -> Result<(), Error> {
    let (identity, velocity) = (SO3::identity(), Vector3::new(0.5, 2.0, 12.0));
    let given: Vec<String> = std::env::args().skip(1).collect();
    match given.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["bits"] => {
            let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
            let top = HeavyTop { J_d, m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
            let stepper = Stepper::new(top, 0.01)?;
            let mut state = stepper.start(identity, velocity)?;
            stepper.run(&mut state, 1000)?;
            state.momentum().iter().for_each(|number| println!("{:#018x}", number.to_bits()));
        }
        ["steps"] => {
            let begun = Instant::now();
            let stepper = machine(&text()?)?;
            let mut state = stepper.start(&IDENTITY, velocity.as_slice())?;
            let mut recorder = Recorder::new(&stepper, liestep::recording::Csv::new(Vec::new()));
            stepper.observed(&mut state).every(1000, |now| recorder.record(now)).steps(1_000_000)?;
            println!("{:.4}", begun.elapsed().as_secs_f64());
        }
        ["members", folder] => {
            let text = text()?;
            let make = move |member: &liestep_ensemble::Member<'_>| {
                let stepper = machine(&text).map_err(|error| liestep_ensemble::Failure::Other(error.to_string()))?;
                let velocity = [0.0, 0.0, 12.0].iter().enumerate();
                let velocity = velocity.map(|(k, mean)| member.normal(&format!("velocity.{}", k + 1), *mean, 0.1));
                let state = stepper.start(&IDENTITY, &velocity.collect::<Vec<_>>())?;
                Ok((stepper, state))
            };
            let begun = Instant::now();
            let ensemble = Ensemble::<AnyStepper>::one_by_one("tops", 100_000, 100, make).seed(7);
            ensemble.run(&Local::threads(1), &Store::folder(folder)?)?;
            println!("{:.4}", begun.elapsed().as_secs_f64());
        }
        _ => return Err("beside bits | steps | members FOLDER".into()),
    }
    Ok(())
}
