//! Scenes from files: a compiled body with an interpreted program or machine code.

use std::time::Instant;

use liestep::motion::AnyStepper;
use liestep_scene::Spread;

use crate::kernel::{Effort, Failure, Group, Kernel};

/// A file's run samples its motion for a picture, as often in a run as in one twice as long.
const EFFORT: Effort = Effort { batch: 40_000, rounds: 5, counted: 40_000 };

/// The tables of a file besides the body.
const FILES: [(&str, &str); 11] = [
    ("body", ""),
    ("body + gravity", "[gravity]\nm = 1\ng = 9.81\nrho = [0.3, 0.2, 0.4]\nup = [0, 0, 1]"),
    ("body + gravity gradient", "[gravity_gradient]\nGM = 1\nr = 1\ndirection = [0, 0, 1]"),
    ("body + dipole", "[dipole]\nmoment = [0.3, 0.2, 0.4]\nfield = [0, 0, 1]"),
    ("body + spring", "[spring]\nk = 1\nlength = 0.5\nat = [0.3, 0.2, 0.4]\nanchor = [0, 0, 1]"),
    ("body + rotor", "[rotor]\nspin = [0.1, 0.2, 0.3]"),
    ("body + torque", "[torque]\ntorque = [1e-4, 2e-4, 3e-4]"),
    ("body + thrust", "[thrust]\nat = [0.3, 0.2, 0.4]\nthrust = [1e-4, 2e-4, 3e-4]"),
    ("body + drag", "[drag]\nc = 1e-3"),
    ("body + magnetic damping", "[magnetic_damping]\nk = 1e-3\nfield = [0.3, 0.2, 0.4]"),
    ("Cayley body", "[body]\nmoments = [2, 3, 4.5]\nkinetic = \"cayley\""),
];

/// Steps of the files' scenes, without stored states.
pub(crate) fn groups() -> Vec<Group> {
    let kernel = |(name, tables): (&'static str, &'static str)| {
        Kernel::new(name, move || {
            let scene = liestep_scene::Scene::parse("bench.toml", &text(tables))?;
            Ok(move |steps| {
                scene.first(steps)?;
                Ok(0)
            })
        })
    };
    vec![Group::new("", EFFORT, FILES.map(kernel))]
}

fn text(tables: &str) -> String {
    let body = if tables.contains("[body]") { "" } else { "[body]\nmoments = [2, 3, 4.5]\n" };
    format!(
        "title = \"bench\"\n{body}{tables}\n[start]\neuler = [0, 0.8, 0]\nvelocity = [0.5, 2, 12]\n\
         [run]\nstep = 0.01\nduration = 1e6\n[output]\nevery = 1000000\n"
    )
}

const MEMBERS: u32 = 8_000;

/// Prints the time of a member of a file's ensemble of (3.13) before its first step, and the rate of its steps in lanes
/// on one core: the fastest of some rounds.
pub(crate) fn members() -> Result<(), Failure> {
    let draws = "[ensemble]\nmembers = 8000\ndraw.gravity.m = { mean = 1.0, deviation = 0.01 }\n\
                 draw.start.velocity = [0.5, 2, { from = 8.0, to = 12.0 }]\n";
    let scene = liestep_scene::Scene::parse("bench.toml", &format!("{}{draws}", text(FILES[1].1)))?;
    let (drawn, whole) = (scene.ensemble().ok_or("no ensemble")?, scene.whole().ok_or("not one program")?);
    let member = |number: u32| {
        let share = f64::from(number) / f64::from(MEMBERS);
        let number = |_: &str, spread: Spread| match spread {
            Spread::Uniform { from: start, to: end } => start + (end - start) * share,
            Spread::Normal { mean, deviation } => mean + deviation * share,
        };
        drawn.member(&mut { number })?.in_lanes(&whole)
    };
    let (mut making, mut stepping, mut batch) = (f64::INFINITY, f64::INFINITY, None);
    for _ in 0..40 {
        let clock = Instant::now();
        for lanes in 0..MEMBERS / 8 {
            let eight = (8 * lanes..8 * lanes + 8).map(member).collect::<Result<Vec<_>, _>>()?;
            batch = AnyStepper::abreast(&eight);
        }
        making = making.min(clock.elapsed().as_secs_f64() * 1e6 / f64::from(MEMBERS));
        let clock = Instant::now();
        if let Some((batch, 8)) = &mut batch {
            batch.run(MEMBERS.into());
        }
        stepping = stepping.min(clock.elapsed().as_secs_f64() * 1e6 / f64::from(8 * MEMBERS));
    }
    println!("a member: {making:.2} µs of its own; in lanes of eight: {:.1} million steps a second", 1.0 / stepping);
    Ok(())
}
