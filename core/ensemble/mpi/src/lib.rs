//! The engine that shares an ensemble among the processes of an MPI job.
//!
//! ```no_run
//! # use liestep_ensemble::{Ensemble, Store, StoreError};
//! # use liestep_ensemble_mpi::Mpi;
//! # fn run<M: liestep::motion::Integrator>(ensemble: &Ensemble<M>) -> Result<(), Box<dyn std::error::Error>> {
//! let engine = Mpi::world().ok_or("MPI has been initialised already")?;
//! let report = ensemble.run(&engine, &Store::folder("shared/out")?)?; // in every process
//! if engine.is_first() {
//!     println!("{} finished", report.outcome.finished);
//! }
//! # Ok(())
//! # }
//! ```
//!
//! Every process runs the same code, on a folder that all of them share. The first lists the missing chunks, hands out
//! their numbers, and computes chunks itself between two answers. A worker requests the next number after it has
//! written a shard: 16 bytes each way per chunk, and no rows. The reports of the other processes count their own chunks
//! only.
//!
//! A process that dies ends the job, as is MPI's rule; finished shards stay, and the next run computes the others. An
//! error in one process, or a panic in a member's function, ends all of them with a nonzero code.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

use liestep_ensemble::{Engine, MakeChunk, StoreError};
use mpi::environment::Universe;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator as _, Destination as _, Source as _};

/// The answer to a worker when no number is left.
const NONE: u64 = u64::MAX;
const FIRST: i32 = 0;

/// The engine of all processes of the job.
pub struct Mpi {
    world: SimpleCommunicator,
    /// MPI ends when this field is dropped.
    _universe: Universe,
}

impl Mpi {
    /// The processes that `mpirun` has started; this one alone without it. `None` if MPI has been initialised already.
    #[must_use]
    pub fn world() -> Option<Self> {
        let universe = mpi::initialize()?;
        Some(Self { world: universe.world(), _universe: universe })
    }

    /// Whether this is the process that reports.
    #[must_use]
    pub fn is_first(&self) -> bool {
        self.world.rank() == FIRST
    }

    /// Aborts all processes after an error or a panic of one: the others would wait for it, and MPI for them.
    fn or_abort(&self, make: impl FnOnce() -> Result<(), StoreError>) {
        match catch_unwind(AssertUnwindSafe(make)) {
            Ok(Ok(())) => {}
            Ok(Err(error)) => {
                eprintln!("error in process {}: {error}", self.world.rank());
                self.world.abort(1)
            }
            // The panic's message has been printed already.
            Err(_) => self.world.abort(101),
        }
    }

    /// Hands out the numbers, and computes chunks while no worker waits.
    fn lead(&self, missing: &[u64], make: &MakeChunk<'_>, tell: &(dyn Fn() + Sync)) {
        let (left, workers) = (Cell::new(missing), Cell::new(self.world.size() - 1));
        let next = || {
            let (next, others) = left.get().split_first()?;
            left.set(others);
            Some(*next)
        };
        let answer = |rank: i32| {
            let worker = self.world.process_at_rank(rank);
            if worker.receive::<u64>().0 > 0 {
                tell();
            }
            let number = next().unwrap_or_else(|| {
                workers.set(workers.get() - 1);
                NONE
            });
            worker.send(&number);
        };
        let answer_all = || {
            while let Some(status) = self.world.any_process().immediate_probe() {
                answer(status.source_rank());
            }
            false
        };
        while let Some(chunk) = next() {
            // Workers are answered within this chunk, each time that it calls `is_stopped`.
            self.or_abort(|| make(chunk, &answer_all));
        }
        while workers.get() > 0 {
            answer(self.world.any_process().probe().source_rank());
        }
    }

    /// Computes the chunks that the first process sends.
    fn follow(&self, make: &MakeChunk<'_>) {
        let first = self.world.process_at_rank(FIRST);
        // The number of chunks computed since the last request.
        let mut made = 0_u64;
        loop {
            first.send(&made);
            let (chunk, _) = first.receive::<u64>();
            if chunk == NONE {
                return;
            }
            self.or_abort(|| make(chunk, &|| false));
            made = 1;
        }
    }
}

impl Engine for Mpi {
    fn leads(&self) -> bool {
        self.is_first()
    }

    fn distribute(
        &self,
        missing: &[u64],
        make: &MakeChunk<'_>,
        tell: &(dyn Fn() + Sync),
    ) -> Result<(), StoreError> {
        if self.is_first() {
            self.lead(missing, make, tell);
        } else {
            self.follow(make);
        }
        Ok(())
    }
}
