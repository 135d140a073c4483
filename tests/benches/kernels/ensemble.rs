//! An ensemble of tops (3.13), and the costs of failures, threads and files. A step of a kernel is a member of 1,000 steps.

use std::path::PathBuf;

use liestep::effects::{Gravity, PrincipalBody, Torque};
use liestep::mechanics::{DiagonalNonstandardInertia, Sum};
use liestep::recording::{Event, sections};
use liestep::{SO3, Stepper};
use liestep_ensemble::{Ensemble, Failure as Failed, Local, Member, Reduction, Section, Store};
use nalgebra::Vector3;

use crate::kernel::{Effort, Failure, Group, Kernel};
use crate::most_memory;

type Top = Stepper<Sum<Sum<PrincipalBody, Gravity>, Torque>>;

const STEPS: u64 = 1_000;
const EFFORT: Effort = Effort { batch: 20_480, rounds: 5, counted: 4_096 };

/// Tops of which one in `failing` is spun up until it is too fast for the step, at some time of the run.
fn tops(members: u64, steps: u64, failing: Option<u64>) -> Ensemble<Top> {
    let make = move |member: &Member<'_>| -> Result<_, Failed> {
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

/// Chunks without files, with this part of members that fail.
fn in_memory(name: &str, failing: Option<u64>, ensemble: fn(Ensemble<Top>) -> Ensemble<Top>) -> Kernel {
    Kernel::new(name, move || {
        Ok(move |members: u32| {
            let ensemble = ensemble(tops(u64::from(members), STEPS, failing));
            let shards = (0..ensemble.chunks()).filter_map(|chunk| ensemble.chunk(chunk, &|| false));
            let failures: usize = shards.map(|shard| shard.outcome.failures.len()).sum();
            let expected = failing.map_or(0, |failing| (u64::from(members) + failing - failing / 2 - 1) / failing);
            assert_eq!(failures as u64, expected, "failures of {members} members");
            Ok(0)
        })
    })
}

/// Chunks into files by a number of threads.
fn written(name: &str, threads: usize) -> Kernel {
    Kernel::new(name, move || {
        Ok(move |members: u32| {
            let folder = folder("written");
            tops(u64::from(members), STEPS, None).run(&Local::threads(threads), &Store::folder(&folder)?)?;
            std::fs::remove_dir_all(folder)?;
            Ok(0)
        })
    })
}

pub(crate) fn groups() -> Vec<Group> {
    /// The third axis passes the plane whose normal is the first.
    macro_rules! plane {
        () => {
            sections::plane(Vector3::z(), Vector3::x())
        };
    }
    macro_rules! section {
        () => {
            Section::<Top>::new(Event::rising(), plane!()).keep(["t"], |now| [now.time()])
        };
    }
    let kernels = [
        in_memory("plain", None, |tops| tops),
        in_memory("one of a hundred fails", Some(100), |tops| tops),
        in_memory("axes pass a plane", None, |tops| tops.section(section!())),
        in_memory("axes pass a plane, in lanes", None, |tops| tops.section(section!().in_lanes(plane!()))),
        written("into files, one thread", 1),
        written("into files, two threads", 2),
    ];
    vec![Group::new("", EFFORT, kernels)]
}

/// Prints the most memory of this number of members of ten steps into files.
pub(crate) fn memory(members: u64) -> Result<(), Failure> {
    let folder = folder("many");
    let report = tops(members, 10, None).chunks_of(16_384).run(&Local::threads(0), &Store::folder(&folder)?)?;
    std::fs::remove_dir_all(folder)?;
    println!("{} finished; the most memory was {}", report.outcome.finished, most_memory());
    Ok(())
}
