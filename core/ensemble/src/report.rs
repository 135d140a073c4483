//! The run of an ensemble, and its report.

use core::fmt;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant, SystemTime};

use liestep::motion::Integrator;

use crate::engine::Engine;
use crate::ensemble::Ensemble;
use crate::outcome::Outcome;
use crate::reduce::Summary;
use crate::shard::Shard;
use crate::store::{Fault, Plan, Store, StoreError, longest};

/// The report of a run; it covers this share alone while chunks of other shares are missing.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Chunks of the ensemble.
    pub chunks: u64,
    /// Chunks that this process computed in this run.
    pub made: u64,
    /// Chunks still missing: of other shares, or after a stop.
    pub missing: u64,
    /// The outcome of the members; [`Ensemble::shards`] has all failures with their errors.
    pub outcome: Outcome,
    /// The damaged files. They are now called `….damaged`, and their chunks were recomputed, except for those found at
    /// the end, which are left to the next run. Only a [verified](Store::verified) store reads rows.
    pub faults: Vec<Fault>,
    names: Vec<String>,
}

impl Report {
    /// The result of a reduction, over the chunks that exist.
    #[must_use]
    pub fn reduced(&self, name: &str) -> Option<&Summary> {
        self.names.iter().zip(&self.outcome.reduced).find(|(own, _)| *own == name).map(|(_, reduced)| reduced)
    }
}

/// The progress of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Chunks that exist.
    pub done: u64,
    /// All chunks.
    pub chunks: u64,
    /// The estimated time for the missing chunks, by the time of this run's chunks.
    pub remaining: Duration,
}

/// Writes one line, as `57 of 400 chunks, about 12 min left`.
impl fmt::Display for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (left, unit) = match self.remaining.as_secs() {
            seconds @ ..120 => (seconds, "s"),
            seconds @ 120..7200 => (seconds / 60, "min"),
            seconds => (seconds / 3600, "h"),
        };
        write!(f, "{} of {} chunks, about {left} {unit} left", self.done, self.chunks)
    }
}

impl<M: Integrator> Plan for Ensemble<M> {
    fn print(&self) -> u64 {
        self.fingerprint()
    }

    fn members(&self, chunk: u64) -> u64 {
        let range = self.range(chunk);
        range.end - range.start
    }

    fn sample(&self, chunk: u64) -> u64 {
        self.sample(chunk)
    }

    fn outcome(&self, chunk: u64) -> Outcome {
        self.chunk(chunk, &|| false).map_or_else(|| self.nothing(), |shard| shard.outcome)
    }

    fn nothing(&self) -> Outcome {
        self.nothing()
    }
}

impl<M: Integrator> Ensemble<M> {
    /// The shards in a folder, one after another in the order of their chunks, and the faults of other files. A shard of a
    /// plan of more members may have some that this plan hasn't: then its first members are computed.
    ///
    /// # Errors
    ///
    /// [`StoreError::Io`] if a folder can't be read, and [`StoreError::Foreign`] if there are files of an older format.
    pub fn shards(&self, store: &Store) -> Result<impl Iterator<Item = Result<Shard, Fault>>, StoreError> {
        let mut files = Vec::new();
        for of_chunk in store.named()?.chunk_by(|(first, _), (second, _)| first.chunk == second.chunk) {
            files.extend_from_slice(longest(of_chunk));
        }
        files.retain(|(name, _)| self.members(name.chunk) > 0);
        Ok(files.into_iter().map(|(name, path)| {
            let shard = Store::read(&path)?;
            let shorter = || self.chunk(name.chunk, &|| false).unwrap_or_else(|| shard.clone());
            match (shard.plan == self.fingerprint(), name.members > self.members(name.chunk)) {
                (false, _) => Err(Fault::Foreign(path)),
                (true, true) => Ok(shorter()),
                (true, false) => Ok(shard),
            }
        }))
    }

    /// Computes the chunks that are missing in the folder, and reports.
    ///
    /// # Errors
    ///
    /// [`StoreError`] if the folder has files of another plan, or can't be written to. Finished chunks stay.
    pub fn run(&self, engine: &dyn Engine, store: &Store) -> Result<Report, StoreError> {
        self.run_telling(engine, store, &|_| {})
    }

    /// Runs as [`run`](Self::run), and reports the progress after each chunk; of several processes the one that
    /// [leads](Engine::leads) does.
    ///
    /// # Errors
    ///
    /// The errors of [`run`](Self::run).
    pub fn run_telling(
        &self,
        engine: &dyn Engine,
        store: &Store,
        tell: &(dyn Fn(Progress) + Sync),
    ) -> Result<Report, StoreError> {
        let (chunks, begun) = (self.chunks(), SystemTime::now());
        let is_own = |chunk: u64| engine.has(chunk);
        let look = || {
            let (found, damaged) = store.look(self, &is_own)?;
            Store::set_aside(&damaged)?;
            Ok(((0..chunks).filter(|chunk| !found.contains(chunk)).collect(), damaged))
        };
        let looked = if engine.leads() { look() } else { Ok((Vec::new(), Vec::new())) };
        let (missing, faults): (Vec<u64>, Vec<Fault>) = match looked {
            Ok(found) => found,
            Err(error) => {
                // The other processes wait for numbers: there are none.
                engine.distribute(&[], &|_, _| Ok(()), &|| ())?;
                return Err(error);
            }
        };
        let (made, all, before) = (AtomicU64::new(0), AtomicU64::new(0), chunks - missing.len() as u64);
        let (leads, start) = (engine.leads(), Instant::now());
        let others: BTreeSet<u64> = missing.iter().copied().filter(|chunk| !is_own(*chunk)).collect();
        let told = || {
            let all = all.fetch_add(1, Ordering::Relaxed) + 1;
            let (done, spent) = (before + all, start.elapsed().as_secs_f64());
            #[allow(clippy::cast_precision_loss)] // an estimate
            let remaining = spent * chunks.saturating_sub(done) as f64 / all as f64;
            if leads {
                tell(Progress { done, chunks, remaining: Duration::try_from_secs_f64(remaining).unwrap_or_default() });
            }
        };
        let make = |chunk: u64, is_stopped: &dyn Fn() -> bool| {
            // A process of another share may have written the chunk by now.
            if others.contains(&chunk) && store.has(chunk, self.members(chunk)) {
                return Ok(());
            }
            let Some(shard) = self.chunk(chunk, is_stopped) else { return Ok(()) };
            store.write(&shard)?;
            made.fetch_add(1, Ordering::Relaxed);
            told();
            Ok(())
        };
        engine.distribute(&missing, &make, &told)?;
        let mut report = Report {
            chunks,
            made: made.load(Ordering::Relaxed),
            missing: chunks,
            outcome: self.nothing(),
            faults,
            names: self.all_reductions().map(|(name, _)| name.clone()).collect(),
        };
        if leads {
            let (there, _) = store.look(self, &|_| false)?;
            let is_whole = (0..chunks).all(|chunk| there.contains(&chunk));
            let is_told = |chunk: u64| is_whole || is_own(chunk);
            let (found, damaged) = store.survey(self, &is_told, &mut report.outcome)?;
            Store::set_aside(&damaged)?;
            report.faults.extend(damaged);
            report.missing = chunks - found;
            if report.missing == 0 {
                store.sweep(begun)?;
            }
        }
        Ok(report)
    }
}
