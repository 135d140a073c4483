//! Ensembles: many motions of one scene with random parameters and starts, in files from which a killed run resumes.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use liestep::motion::{AnyStepper, Factor, Integrator as _};
use liestep::recording::Column;
use liestep_ensemble::{Ensemble, Local, Member, MemberFailure, Progress, Report, Store, StoreError};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::run::steps_to;
use crate::start::{Start, started};
use crate::table::Columns;

/// A random number: the name of a parameter, `velocity` or `attitude`, its component, and its distribution.
#[derive(Clone, FromPyObject)]
pub(crate) struct Draw {
    of: String,
    place: usize,
    /// The first numbers of the parameters with this distribution, among the numbers of all terms.
    at: Vec<usize>,
    /// The distribution: `normal` with mean and deviation, or `uniform` from the first number to below the second.
    kind: String,
    first: f64,
    second: f64,
}

pub(crate) type Draws = Vec<Draw>;

impl Draw {
    /// The random number of a component in a member, by a name of its own: `velocity.3`.
    fn number(&self, member: &Member<'_>) -> f64 {
        let name = format!("{}.{}", self.of, self.place + 1);
        match self.kind.as_str() {
            "uniform" => member.uniform(&name, self.first..self.second),
            _ => member.normal(&name, self.first, self.second),
        }
    }
}

/// The members of an ensemble and the share of this process.
#[derive(FromPyObject)]
pub(crate) struct Members {
    /// The name of the plan, which distinguishes it from others.
    name: String,
    members: u64,
    seed: u64,
    until: f64,
    every: Option<u64>,
    chunk: Option<u64>,
    folder: std::path::PathBuf,
    threads: usize,
    share: (u64, u64),
    /// Whether the attitude is random, each rotation as likely.
    turns: bool,
    /// The function that is called with the number of finished chunks and of all.
    progress: Option<Py<PyAny>>,
}

/// The results of a run: its report and the table of all members.
pub(crate) struct Outcome {
    pub(crate) report: Report,
    pub(crate) table: Columns,
    pub(crate) failures: Vec<MemberFailure>,
}

/// Runs the members in other threads, while this one looks for Ctrl-C and reports progress.
pub(crate) fn run_members(
    plan: Members,
    start: &Start,
    draws: Draws,
    (factors, make): (Vec<Factor>, impl Fn(&dyn Fn(&mut [f64])) -> Result<AnyStepper, Failure> + Send + Sync + 'static),
    h: f64,
) -> Result<Outcome, Failure> {
    let (start, turns) = (start.clone(), plan.turns);
    let made = move |member: &Member<'_>| {
        let draw_of = |name: &str, numbers: &mut [f64]| {
            for draw in draws.iter().filter(|draw| draw.of == name) {
                if let Some(place) = numbers.get_mut(draw.place) {
                    *place = draw.number(member);
                }
            }
        };
        let draw_all = |numbers: &mut [f64]| {
            for draw in &draws {
                let drawn = draw.number(member);
                for first in &draw.at {
                    numbers.get_mut(first + draw.place).into_iter().for_each(|number| *number = drawn);
                }
            }
        };
        let stepper = make(&draw_all).map_err(other)?;
        let mut own = start.clone();
        draw_of("velocity", &mut own.velocity);
        draw_of("attitude", &mut own.attitude);
        if turns {
            let drawn = member.rotation("attitude");
            (own.attitude, own.is_quaternion) = (vec![drawn.w, drawn.i, drawn.j, drawn.k], true);
        }
        let state = started(&stepper, &own).map_err(other)?;
        Ok((stepper, state))
    };
    let steps = steps_to(plan.until, h, true)?;
    let mut ensemble = Ensemble::<AnyStepper>::one_by_one(&plan.name, plan.members, steps, made).seed(plan.seed);
    if let Some(every) = plan.every {
        ensemble = ensemble.every(every.max(1));
    }
    if let Some(chunk) = plan.chunk {
        ensemble = ensemble.chunks_of(chunk.max(1));
    }
    let columns = columns(&factors);
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    let entries = factors.iter().map(|factor| factor.kind.columns()).sum();
    ensemble = ensemble.keep_named(&names, move |run, row| {
        let (stepper, state) = (run.stepper, run.state);
        // A recorded row also has the distance from the group, which members leave out.
        let (mut attitude, mut whole) = (vec![0.0; entries], vec![0.0; row.len()]);
        stepper.write(state, &(), &mut attitude, &mut whole);
        row[0] = stepper.time(state);
        row[1..].iter_mut().zip(whole).for_each(|(place, number)| *place = number);
    });
    let store = Store::folder(&plan.folder).map_err(|error| store_error(&error))?;
    let report = in_threads(&ensemble, &store, &plan)?;
    collected(&ensemble, &store, columns, report)
}

fn other(failure: Failure) -> liestep_ensemble::Failure {
    let message = match failure {
        Failure::Of(_, message) => message,
        other => PyErr::from(other).to_string(),
    };
    liestep_ensemble::Failure::Other(message)
}

fn store_error(error: &impl std::fmt::Display) -> Failure {
    Failure::Of("StoreError", error.to_string())
}

/// The columns of a member: those of a run without the distance from the group.
pub(crate) fn columns(factors: &[Factor]) -> Vec<Column> {
    let mut columns = Column::of_motions(factors);
    columns.pop();
    columns
}

/// Time between two looks for signals.
const LOOK: Duration = Duration::from_millis(50);

fn in_threads<M>(ensemble: &Ensemble<M>, store: &Store, plan: &Members) -> Result<Report, Failure>
where
    M: liestep::motion::Integrator + 'static,
{
    let (stop, now) = (AtomicBool::new(false), Mutex::new(None::<Progress>));
    let (share, shares) = plan.share;
    if share >= shares {
        return Err(Failure::Of("SetupError", format!("there is no share {share} of {shares}: they count from zero")));
    }
    std::thread::scope(|scope| {
        let work = std::thread::Builder::new().spawn_scoped(scope, || {
            let local = Local::threads(plan.threads).share(share, shares).stopped_by(&stop);
            ensemble.run_telling(&local, store, &|progress| {
                if let Ok(mut now) = now.lock() {
                    *now = Some(progress);
                }
            })
        });
        let work = work.map_err(|error| store_error(&format_args!("no thread starts: {error}")))?;
        let mut raised = None;
        while !work.is_finished() {
            std::thread::park_timeout(LOOK);
            let told = now.lock().ok().and_then(|mut now| now.take());
            let asked = Python::attach(|py| {
                py.check_signals()?;
                match (&plan.progress, told) {
                    (Some(progress), Some(told)) => progress.call1(py, (told.done, told.chunks)).map(|_| ()),
                    _ => Ok(()),
                }
            });
            if let Err(error) = asked {
                stop.store(true, Ordering::Relaxed);
                raised.get_or_insert(error);
            }
        }
        let report = work.join().map_err(|_| Failure::Of("StoreError", "a thread has come to no end".to_owned()))?;
        match raised {
            Some(error) => Err(Failure::Raised(Python::attach(|py| interrupted(py, error, &report, &plan.folder)))),
            None => report.map_err(|error| store_error(&error)),
        }
    })
}

/// The interrupt of a run, with what is kept of it.
fn interrupted(py: Python<'_>, error: PyErr, report: &Result<Report, StoreError>, folder: &Path) -> PyErr {
    match report {
        Ok(Report { chunks, missing, .. }) if error.is_instance_of::<PyKeyboardInterrupt>(py) => {
            let there = chunks - missing;
            let folder = folder.display();
            PyKeyboardInterrupt::new_err(format!(
                "{there} of {chunks} chunks are kept in {folder}; the same `run` goes on there"
            ))
        }
        _ => error,
    }
}

/// The rows of all finished chunks, in the order of the members.
fn collected<M: liestep::motion::Integrator>(
    ensemble: &Ensemble<M>,
    store: &Store,
    columns: Vec<Column>,
    report: Report,
) -> Result<Outcome, Failure> {
    let (mut chunks, mut failures) = (BTreeMap::new(), Vec::new());
    for shard in ensemble.shards(store).map_err(|error| store_error(&error))? {
        let shard = shard.map_err(|fault| store_error(&fault))?;
        failures.extend(shard.outcome.failures);
        chunks.insert(shard.chunk, shard.rows);
    }
    #[allow(clippy::cast_precision_loss)] // a billion members of as many steps at most
    let whole = |number: &u64| *number as f64;
    let plain = |name: &str| Column { name: name.to_owned(), unit: String::new() };
    let mut all = vec![
        (plain("member"), chunks.values().flat_map(|rows| &rows.member).map(whole).collect::<Vec<_>>()),
        (plain("step"), chunks.values().flat_map(|rows| &rows.step).map(whole).collect()),
        (plain("status"), chunks.values().flat_map(|rows| &rows.status).map(|one| f64::from(*one as u8)).collect()),
    ];
    for (place, column) in columns.into_iter().enumerate() {
        let numbers = chunks.values().filter_map(|rows| rows.columns.get(place)).flatten().copied();
        all.push((column, numbers.collect()));
    }
    failures.sort_by_key(|failure| failure.member);
    Ok(Outcome { report, table: Columns::of(all), failures })
}
