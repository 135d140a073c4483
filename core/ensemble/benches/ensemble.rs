//! Steps a second of an ensemble of tops (3.13), and the costs of failures, threads and files.
//!
//! ```text
//! cargo bench -p liestep-ensemble --bench steps                     with and without files, on one and two threads, in turns
//! cargo bench -p liestep-ensemble --bench steps -- plain 4096       that many tops and no files: to count instructions
//! cargo bench -p liestep-ensemble --bench steps -- failing 4096     one of a hundred falls too fast at some time
//! cargo bench -p liestep-ensemble --bench steps -- section 4096     axes pass a plane; or `section-in-lanes`
//! cargo bench -p liestep-ensemble --bench steps -- many 10000000    that many of ten steps into files, and the memory for it
//! cargo bench -p liestep-ensemble --bench steps -- splittings       symmetric tops, beside heyoka where Python has it
//! ```

mod splittings;

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use liestep::effects::{Gravity, PrincipalBody, Torque};
use liestep::mechanics::{DiagonalNonstandardInertia, Sum};
use liestep::recording::{Event, sections};
use liestep::{SO3, Stepper};
use liestep_ensemble::{Ensemble, Failure, Local, Member, Reduction, Section, Store};
use nalgebra::Vector3;

type Top = Stepper<Sum<Sum<PrincipalBody, Gravity>, Torque>>;

const STEPS: u64 = 1_000;
const TURNS: usize = 5;

/// Tops of which one in `failing` is spun up until it is too fast for the step, at some time of the run.
fn tops(members: u64, steps: u64, failing: Option<u64>) -> Ensemble<Top> {
    let make = move |member: &Member<'_>| -> Result<_, Failure> {
        let moments = Vector3::new(3.0, member.normal("J_2", 3.1, 0.01), member.normal("J_3", 4.0, 0.01));
        let body = PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(moments)? };
        let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
        let fails = failing.is_some_and(|failing| member.number() % failing == failing / 2);
        // The torque makes it turn by 1.5 rad a step after this number of steps.
        let size = if fails { 6e4 / member.uniform("end", 1.0..1e3) } else { 0.0 };
        let stepper = Stepper::new(body + gravity + Torque { torque: Vector3::z() * size }, 0.01)?;
        let tilt = member.uniform("tilt", 0.2..0.6);
        let spin = member.uniform("spin", 8.0..12.0);
        let state = stepper.start(SO3::exp(Vector3::x() * tilt), Vector3::new(0.0, 0.0, spin))?;
        Ok((stepper, state))
    };
    Ensemble::new("tops", members, steps, make)
        .chunks_of(1024)
        .keep(["x", "y", "z"], |run| (run.state.attitude().as_matrix() * Vector3::z()).into())
        .keep(["energy"], |run| [run.stepper.energy(run.state)])
        .reduce("energy", Reduction::Moments, |run| run.stepper.energy(run.state))
}

fn folder(name: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("liestep-bench-{}-{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&path);
    path
}

/// Computes chunks without files; returns the number of steps and of failures.
fn compute(ensemble: &Ensemble<Top>, members: u64) -> (u64, usize) {
    let shards = (0..ensemble.chunks()).filter_map(|chunk| ensemble.chunk(chunk, &|| false));
    let failures: Vec<u64> = shards.flat_map(|shard| shard.outcome.failures).map(|failed| failed.steps).collect();
    let count = failures.len();
    ((members - count as u64) * STEPS + failures.into_iter().sum::<u64>(), count)
}

/// The time to run into files by a number of threads, s.
fn written(ensemble: &Ensemble<Top>, threads: usize) -> Result<f64, Box<dyn Error>> {
    let folder = folder("written");
    let start = Instant::now();
    ensemble.run(&Local::threads(threads), &Store::folder(&folder)?)?;
    let seconds = start.elapsed().as_secs_f64();
    std::fs::remove_dir_all(folder)?;
    Ok(seconds)
}

/// The peak memory of this process, MB; Linux only.
fn most_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.split_whitespace().next()?.parse::<f64>().ok().map(|kilobytes| kilobytes / 1e3)
}

#[allow(clippy::cast_precision_loss)] // steps
fn main() -> Result<(), Box<dyn Error>> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    if arguments.iter().map(String::as_str).eq(["splittings"]) {
        return splittings::splittings();
    }
    if let [what, members] = arguments.as_slice() {
        let members = members.parse()?;
        match what.as_str() {
            "plain" => println!("steps and failures {:?}", compute(&tops(members, STEPS, None), members)),
            "failing" => println!("steps and failures {:?}", compute(&tops(members, STEPS, Some(100)), members)),
            "section" | "section-in-lanes" => {
                let plane = Section::new(Event::rising(), sections::plane(Vector3::z(), Vector3::x()));
                let plane = plane.keep(["t"], |now| [now.time()]);
                let plane =
                    if what == "section" { plane } else { plane.in_lanes(sections::plane(Vector3::z(), Vector3::x())) };
                println!("steps and failures {:?}", compute(&tops(members, STEPS, None).section(plane), members));
            }
            "many" => {
                let folder = folder("many");
                let report =
                    tops(members, 10, None).chunks_of(16_384).run(&Local::threads(0), &Store::folder(&folder)?)?;
                std::fs::remove_dir_all(folder)?;
                println!("{} finished; the most memory was {:?} MB", report.outcome.finished, most_memory());
            }
            _ => {
                return Err(
                    "splittings; or plain, failing, section, section-in-lanes or many, and a number of members".into(),
                );
            }
        }
        return Ok(());
    }
    let members = 20_480;
    let ensemble = tops(members, STEPS, None);
    let (mut alone, mut one, mut two) = (f64::INFINITY, f64::INFINITY, f64::INFINITY);
    for _ in 0..TURNS {
        let start = Instant::now();
        compute(&ensemble, members);
        alone = alone.min(start.elapsed().as_secs_f64());
        one = one.min(written(&ensemble, 1)?);
        two = two.min(written(&ensemble, 2)?);
    }
    let rate = |seconds: f64| (members * STEPS) as f64 / seconds / 1e6;
    println!("{members} tops of {STEPS} steps, fastest of {TURNS} turns, 10⁶ steps a second");
    println!("chunks without files         {:8.1}", rate(alone));
    println!("into files, one thread       {:8.1}", rate(one));
    println!("into files, two threads      {:8.1}   efficiency {:.2}", rate(two), one / two / 2.0);
    Ok(())
}
