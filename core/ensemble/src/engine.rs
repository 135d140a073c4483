//! Engines, which assign chunks to workers.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use crate::store::StoreError;

/// An engine that computes chunks. The assignment and the order of chunks don't change the results.
pub trait Engine {
    /// Whether this process lists the missing chunks and reports the outcome; one of several processes does.
    fn leads(&self) -> bool {
        true
    }

    /// Whether a chunk belongs to the share of this engine.
    fn has(&self, _chunk: u64) -> bool {
        true
    }

    /// Computes every missing chunk by `make`, once and in some process. The process that [leads](Self::leads) passes
    /// their numbers, and calls `tell` for each chunk of another.
    ///
    /// # Errors
    ///
    /// The first error of `make`, which cancels the chunks in progress.
    fn distribute(&self, missing: &[u64], make: &MakeChunk<'_>, tell: &(dyn Fn() + Sync)) -> Result<(), StoreError>;
}

/// Computes the chunk of a number and writes it. The other argument requests a stop; it is called between members and
/// after each [piece](crate::Ensemble::PIECE) of their steps.
pub type MakeChunk<'a> = dyn Fn(u64, &dyn Fn() -> bool) -> Result<(), StoreError> + Sync + 'a;

/// An engine of this process's threads, for all chunks or for one share: the chunks whose numbers leave the remainder
/// `share` when divided by `shares`.
///
/// Several runs of one program, for example by an array of jobs, can share one folder without a server. A later run
/// computes what is missing, whichever share it belonged to.
#[derive(Debug)]
pub struct Local<'a> {
    threads: usize,
    share: u64,
    shares: u64,
    helps: bool,
    stop: Option<&'a AtomicBool>,
}

impl<'a> Local<'a> {
    /// Sets the number of threads; zero stands for the number of cores.
    #[must_use]
    pub fn threads(threads: usize) -> Self {
        Self { threads, share: 0, shares: 1, helps: false, stop: None }
    }

    /// Restricts the engine to one share.
    ///
    /// # Panics
    ///
    /// If there is no such share.
    #[must_use]
    pub fn share(mut self, share: u64, shares: u64) -> Self {
        assert!(share < shares, "shares are numbered from zero to {shares}, without it");
        (self.share, self.shares) = (share, shares);
        self
    }

    /// Computes missing chunks of other shares after its own, the last ones first, so that nobody waits for a slow
    /// process. Two may compute the same chunk then, and write the same file.
    #[must_use]
    pub fn helping(mut self) -> Self {
        self.helps = true;
        self
    }

    /// Stops within a [piece](crate::Ensemble::PIECE) of steps once this is set, for example by a signal handler.
    /// Finished chunks stay.
    #[must_use]
    pub fn stopped_by(mut self, stop: &'a AtomicBool) -> Self {
        self.stop = Some(stop);
        self
    }
}

impl Engine for Local<'_> {
    fn has(&self, chunk: u64) -> bool {
        chunk % self.shares == self.share
    }

    fn distribute(&self, missing: &[u64], make: &MakeChunk<'_>, _: &(dyn Fn() + Sync)) -> Result<(), StoreError> {
        let (mut own, mut others): (Vec<u64>, Vec<u64>) = missing.iter().partition(|chunk| self.has(**chunk));
        if self.helps {
            // Helpers begin with different shares.
            others.reverse();
            others.sort_by_key(|chunk| (chunk % self.shares + self.shares - self.share) % self.shares);
            own.append(&mut others);
        }
        let has_failed = AtomicBool::new(false);
        let is_stopped =
            || has_failed.load(Ordering::Relaxed) || self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed));
        let make = |&chunk: &u64| {
            let made = if is_stopped() { Ok(()) } else { make(chunk, &is_stopped) };
            // An error stops the other workers within their chunks.
            made.inspect_err(|_| has_failed.store(true, Ordering::Relaxed))
        };
        if self.threads == 1 {
            return own.iter().try_for_each(make);
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads).build();
        let pool = pool.map_err(|error| StoreError::Unwritable { reason: format!("no threads: {error}") })?;
        // Workers take one chunk at a time, in about the order of the numbers.
        let left = Mutex::new(own.iter());
        let next = || left.lock().unwrap_or_else(std::sync::PoisonError::into_inner).next();
        let workers = 0..pool.current_num_threads();
        pool.install(|| {
            workers.into_par_iter().with_max_len(1).try_for_each(|_| core::iter::from_fn(next).try_for_each(make))
        })
    }
}

/// Parses `2/8` as share 2 of 8, for command lines.
///
/// # Errors
///
/// A sentence that says what to write.
pub fn share_of(text: &str) -> Result<(u64, u64), String> {
    let mistake = || format!("`{text}` isn't a share: write `i/n`, from `0/n` to one below `n/n`");
    let (share, shares) = text.split_once('/').ok_or_else(mistake)?;
    match (share.parse(), shares.parse()) {
        (Ok(share), Ok(shares)) if share < shares => Ok((share, shares)),
        _ => Err(mistake()),
    }
}
