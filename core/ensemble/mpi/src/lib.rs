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
//! Every process calls the same; the folder is one that all of them see. The first looks what is missing, hands out
//! numbers of chunks and makes chunks itself between two answers. A worker asks for the next number when it has written a
//! shard: 16 bytes each way a chunk, and no rows. The report of the others knows what they made, and no more.
//!
//! A process that dies takes the job with it, as MPI has it; the shards that are there stay, and the next run makes the
//! others. An error in one process, or a panic in a member's function, ends all of them with a code that isn't zero.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

use liestep_ensemble::{Engine, MakeChunk, StoreError};
use mpi::environment::Universe;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator as _, Destination as _, Source as _};

/// What is sent in the place of a number where there is none left.
const NONE: u64 = u64::MAX;
const FIRST: i32 = 0;

/// All processes of the job.
pub struct Mpi {
    world: SimpleCommunicator,
    /// MPI ends with it.
    _universe: Universe,
}

impl Mpi {
    /// The processes that `mpirun` has started; one alone without it. `None` where MPI has been initialised already.
    #[must_use]
    pub fn world() -> Option<Self> {
        let universe = mpi::initialize()?;
        Some(Self { world: universe.world(), _universe: universe })
    }

    /// Whether this is the process that says what has become of it.
    #[must_use]
    pub fn is_first(&self) -> bool {
        self.world.rank() == FIRST
    }

    /// An error or a panic of one is the end of all: the others would wait for it, and MPI for them.
    fn or_abort(&self, make: impl FnOnce() -> Result<(), StoreError>) {
        match catch_unwind(AssertUnwindSafe(make)) {
            Ok(Ok(())) => {}
            Ok(Err(error)) => {
                eprintln!("error in process {}: {error}", self.world.rank());
                self.world.abort(1)
            }
            // Its message is there already.
            Err(_) => self.world.abort(101),
        }
    }

    /// Hands out the numbers, and makes a chunk where nobody asks.
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
            // It answers within its own chunk, each time that it asks whether to stop.
            self.or_abort(|| make(chunk, &answer_all));
        }
        while workers.get() > 0 {
            answer(self.world.any_process().probe().source_rank());
        }
    }

    /// Makes what it is told.
    fn follow(&self, make: &MakeChunk<'_>) {
        let first = self.world.process_at_rank(FIRST);
        // How many it has made since it asked last.
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
