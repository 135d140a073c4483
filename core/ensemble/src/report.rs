//! Running an ensemble, and what has become of it.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::SystemTime;

use liestep::motion::Integrator;

use crate::engine::Engine;
use crate::ensemble::Ensemble;
use crate::reduce::Summary;
use crate::store::{Fault, Store, StoreError};

/// What is there of an ensemble after a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// How many chunks the ensemble has.
    pub chunks: u64,
    /// How many of them this process made in this run.
    pub made: u64,
    /// How many are still missing: of other shares, or after a stop.
    pub missing: u64,
    /// How many members came to their ends.
    pub finished: u64,
    /// How many didn't; [`Store::shards`] has them with their errors.
    pub failed: u64,
    /// The files that were damaged. They are now called `….damaged`, and their chunks were made anew; but for those that
    /// have only been damaged since this run began, which are left to the next.
    pub faults: Vec<Fault>,
    reductions: Vec<(String, Summary)>,
}

impl Report {
    /// What a reduction has come to, over the chunks that are there.
    #[must_use]
    pub fn reduced(&self, name: &str) -> Option<&Summary> {
        self.reductions.iter().find(|(own, _)| own == name).map(|(_, reduced)| reduced)
    }
}

/// How far a run has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Chunks that are there.
    pub done: u64,
    /// All chunks.
    pub chunks: u64,
}

impl<M: Integrator> Ensemble<M> {
    /// Makes what is missing in the folder, and says what is there then.
    ///
    /// # Errors
    ///
    /// [`StoreError`] where the folder has files of another plan, or can't be written to. Chunks that are done are kept.
    pub fn run(&self, engine: &dyn Engine, store: &Store) -> Result<Report, StoreError> {
        self.run_telling(engine, store, &|_| {})
    }

    /// As [`run`](Self::run), and tells after each chunk of this process how far it has come.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub fn run_telling(
        &self,
        engine: &dyn Engine,
        store: &Store,
        tell: &(dyn Fn(Progress) + Sync),
    ) -> Result<Report, StoreError> {
        let (plan, chunks, begun) = (self.fingerprint(), self.chunks(), SystemTime::now());
        let look = || {
            let (found, damaged) = store.survey(plan, drop)?;
            Store::set_aside(&damaged)?;
            Ok(((0..chunks).filter(|chunk| !found.contains_key(chunk)).collect(), damaged))
        };
        let looked = if engine.leads() { look() } else { Ok((Vec::new(), Vec::new())) };
        let (missing, faults): (Vec<u64>, Vec<Fault>) = match looked {
            Ok(found) => found,
            Err(error) => {
                // The other processes wait for numbers: there are none.
                engine.distribute(&[], &|_, _| Ok(()))?;
                return Err(error);
            }
        };
        let (made, before) = (AtomicU64::new(0), chunks - missing.len() as u64);
        engine.distribute(&missing, &|chunk, is_stopped| {
            let Some(shard) = self.shard(plan, chunk, is_stopped) else { return Ok(()) };
            store.write(&shard)?;
            let made = made.fetch_add(1, Ordering::Relaxed) + 1;
            tell(Progress { done: before + made, chunks });
            Ok(())
        })?;
        let mut report = Report {
            chunks,
            made: made.into_inner(),
            missing: chunks,
            finished: 0,
            failed: 0,
            faults,
            reductions: self.all_reductions().map(|(name, reduction)| (name.clone(), reduction.begin())).collect(),
        };
        if engine.leads() {
            // In the order of their numbers, as sums are.
            let (found, damaged) = store.survey(plan, |shard| {
                report.finished += shard.finished;
                report.failed += shard.failures.len() as u64;
                report.reductions.iter_mut().zip(&shard.reduced).for_each(|((_, all), part)| all.merge(part));
            })?;
            report.faults.extend(damaged);
            report.missing = chunks - found.len() as u64;
            if report.missing == 0 {
                store.sweep(begun)?;
            }
        }
        Ok(report)
    }
}
