//! An ensemble of tops, run by all processes of a job; the first prints the outcome.
//!
//! ```text
//! mpirun -n 4 tops shared/out          all chunks that are missing
//! tops shared/out --share 2/8          a share of them, by threads: for arrays of jobs, in the same folder
//!
//! Options: --threads N of a share, as many as there are cores without it; --members N; --panics N, a member whose function
//! panics; --tells, the progress
//! ```

use std::error::Error;

use liestep::effects::{Gravity, PrincipalBody};
use liestep::mechanics::{DiagonalNonstandardInertia, Sum};
use liestep::{SO3, Stepper};
use liestep_ensemble::{Ensemble, Local, Progress, Reduction, Store, share_of};
use liestep_ensemble_mpi::Mpi;
use nalgebra::Vector3;

fn tops(members: u64, panics: u64) -> Ensemble<Stepper<Sum<PrincipalBody, Gravity>>> {
    Ensemble::new("tops", members, 2_000, move |member| {
        assert!(member.number() != panics, "the member {panics} panics");
        let moments = Vector3::new(3.0, 3.1, member.normal("J_3", 4.0, 0.1));
        let body = PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(moments)? };
        // One of a hundred tops falls too fast for the step.
        let m = if member.number() % 100 == 50 { 1e3 } else { 1.0 };
        let stepper = Stepper::new(body + Gravity { m, g: 9.81, rho: Vector3::z(), up: Vector3::z() }, 0.02)?;
        let tilt = SO3::exp(Vector3::x() * member.uniform("tilt", 0.2..0.6));
        let state = stepper.start(tilt, Vector3::new(0.0, 0.0, member.uniform("spin", 8.0..12.0)))?;
        Ok((stepper, state))
    })
    .chunks_of(50)
    .keep(["x", "y", "z"], |run| (run.state.attitude().as_matrix() * Vector3::z()).into())
    .reduce("energy", Reduction::Moments, |run| run.stepper.energy(run.state))
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let folder = words.next().ok_or("tops FOLDER [--share I/N] [--threads N] [--members N]")?;
    let (mut members, mut threads, mut share, mut panics, mut tells) = (6_000, 0, None, u64::MAX, false);
    while let Some(option) = words.next() {
        if option == "--tells" {
            tells = true;
            continue;
        }
        let value = words.next().ok_or_else(|| format!("`{option}` has no value"))?;
        match option.as_str() {
            "--share" => share = Some(share_of(&value)?),
            "--threads" => threads = value.parse()?,
            "--members" => members = value.parse()?,
            "--panics" => panics = value.parse()?,
            _ => return Err(format!("there is no option `{option}`").into()),
        }
    }
    let ensemble = tops(members, panics);
    let tell = |now: Progress| {
        if tells {
            println!("{} of {}", now.done, now.chunks);
        }
    };
    let report = match share {
        None => {
            let engine = Mpi::world().ok_or("MPI has been initialised already")?;
            let report = ensemble.run_telling(&engine, &Store::folder(folder)?, &tell)?;
            if !engine.is_first() {
                return Ok(());
            }
            report
        }
        Some((share, shares)) => {
            ensemble.run(&Local::threads(threads).share(share, shares), &Store::folder(folder)?)?
        }
    };
    println!(
        "{} of {} chunks are missing; {} tops finished, {} failed; energy {:?}",
        report.missing,
        report.chunks,
        report.outcome.finished,
        report.outcome.failed(),
        report.reduced("energy"),
    );
    Ok(())
}
