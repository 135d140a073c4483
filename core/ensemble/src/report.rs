//! Running an ensemble, and what has become of it.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant, SystemTime};

use liestep::motion::Integrator;

use crate::engine::Engine;
use crate::ensemble::Ensemble;
use crate::reduce::Summary;
use crate::store::{Fault, Store, StoreError};

/// What is there of an ensemble after a run; while chunks of other shares are missing, of this one.
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
    /// How many [left](crate::Section::until) before.
    pub left: u64,
    /// How many did neither; [`Store::shards`] has them with their errors.
    pub failed: u64,
    /// The files that were found to be damaged. They are now called `….damaged`, and their chunks were made anew; but for those
    /// that were found at the end, which are left to the next run. Rows are read by a [verified](Store::verified) store only.
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
    /// How long the others will take, as long as those of this run did.
    pub remaining: Duration,
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

    /// As [`run`](Self::run), and tells after each chunk how far it has come; of several processes the one that
    /// [leads](Engine::leads) does.
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
        let is_own = |chunk: u64| engine.has(chunk);
        let look = || {
            let (found, damaged) = store.look(plan, &is_own)?;
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
            // Of others some are there by now.
            if others.contains(&chunk) && store.has(chunk) {
                return Ok(());
            }
            let Some(shard) = self.shard(plan, chunk, is_stopped) else { return Ok(()) };
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
            finished: 0,
            left: 0,
            failed: 0,
            faults,
            reductions: self.all_reductions().map(|(name, reduction)| (name.clone(), reduction.begin())).collect(),
        };
        if leads {
            let is_whole = store.look(plan, &|_| false)?.0.len() as u64 == chunks;
            // In the order of their numbers, as sums are.
            let (found, damaged) = store.survey(plan, &|chunk| is_whole || is_own(chunk), |shard| {
                report.finished += shard.finished;
                report.left += shard.left;
                report.failed += shard.failures.len() as u64;
                report.reductions.iter_mut().zip(&shard.reduced).for_each(|((_, all), part)| all.merge(part));
            })?;
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
