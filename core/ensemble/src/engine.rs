//! Who makes which chunk.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use crate::store::StoreError;

/// Makes chunks. Which worker makes which, and in what order, changes nothing of what comes out.
pub trait Engine {
    /// Whether this process looks what is missing and says what has become of it; of several one does.
    fn leads(&self) -> bool {
        true
    }

    /// Whether a chunk is one of this engine's, where several have a part each.
    fn has(&self, _chunk: u64) -> bool {
        true
    }

    /// Has every missing chunk made by `make`, once and somewhere; only the one that [leads](Self::leads) knows them, and
    /// calls `tell` for each that another process has made.
    ///
    /// # Errors
    ///
    /// The first error of `make`; what is under way then is given up.
    fn distribute(&self, missing: &[u64], make: &MakeChunk<'_>, tell: &(dyn Fn() + Sync)) -> Result<(), StoreError>;
}

/// Makes a chunk of a number and writes it, unless it is told to stop on the way, which it asks between members and
/// after each [piece](crate::Ensemble::PIECE) of their steps.
pub type MakeChunk<'a> = dyn Fn(u64, &dyn Fn() -> bool) -> Result<(), StoreError> + Sync + 'a;

/// The threads of this process, and if asked for only a share of the chunks: whose numbers leave the rest `share` when
/// divided by `shares`.
///
/// So one program is run several times at once, by an array of jobs for example, over one folder and without
/// a server. The next run makes what is missing, whichever share it was.
#[derive(Debug)]
pub struct Local<'a> {
    threads: usize,
    share: u64,
    shares: u64,
    helps: bool,
    stop: Option<&'a AtomicBool>,
}

impl<'a> Local<'a> {
    /// So many threads; zero means as many as there are cores.
    #[must_use]
    pub fn threads(threads: usize) -> Self {
        Self { threads, share: 0, shares: 1, helps: false, stop: None }
    }

    /// Only this one of the shares.
    ///
    /// # Panics
    ///
    /// Where there is no such share.
    #[must_use]
    pub fn share(mut self, share: u64, shares: u64) -> Self {
        assert!(share < shares, "shares are numbered from zero to {shares}, without it");
        (self.share, self.shares) = (share, shares);
        self
    }

    /// After its share also chunks of others that are missing still, from behind, so that a slow one isn't waited for. Two
    /// may make the same chunk then, and write the same file.
    #[must_use]
    pub fn helping(mut self) -> Self {
        self.helps = true;
        self
    }

    /// Stops within a [piece](crate::Ensemble::PIECE) of steps once this is set, from a handler of signals for example. Chunks that are done are kept.
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
            // Those who help begin at different places.
            others.reverse();
            others.sort_by_key(|chunk| (chunk % self.shares + self.shares - self.share) % self.shares);
            own.append(&mut others);
        }
        let has_failed = AtomicBool::new(false);
        let is_stopped =
            || has_failed.load(Ordering::Relaxed) || self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed));
        let make = |&chunk: &u64| {
            let made = if is_stopped() { Ok(()) } else { make(chunk, &is_stopped) };
            // The others needn't come to the ends of their chunks.
            made.inspect_err(|_| has_failed.store(true, Ordering::Relaxed))
        };
        if self.threads == 1 {
            return own.iter().try_for_each(make);
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads).build();
        let pool = pool.map_err(|error| StoreError::Unwritable { reason: format!("no threads: {error}") })?;
        // One chunk at a time, in about the order of their numbers.
        let left = Mutex::new(own.iter());
        let next = || left.lock().unwrap_or_else(std::sync::PoisonError::into_inner).next();
        let workers = 0..pool.current_num_threads();
        pool.install(|| {
            workers.into_par_iter().with_max_len(1).try_for_each(|_| core::iter::from_fn(next).try_for_each(make))
        })
    }
}

/// `2/8` as the share 2 of 8, for command lines.
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
