//! Which engine when.
//!
//! Chunks are independent, and a shard is the same whoever makes it, so that an ensemble may be begun by one engine and
//! ended by another, in one folder.
//!
//! | you have | take | when a process dies |
//! |---|---|---|
//! | one machine | [`Local::threads`](crate::Local::threads) | the next run goes on from the shards that are there |
//! | a cluster with MPI | `liestep-ensemble-mpi`, in `core/ensemble/mpi` | MPI ends the job; the next run goes on |
//! | arrays of jobs (Slurm, Kubernetes, GNU parallel), anything else that starts programs | [`Local::share`](crate::Local::share) behind an option `--shard i/n` | the scheduler starts that share again |
//! | another scheduler to be written for | [`Engine`](crate::Engine), or [`Ensemble::chunk`](crate::Ensemble::chunk) and [`Store::write`](crate::Store::write) | its own matter |
//!
//! `core/ensemble/mpi/run` compares the files of threads, of 1 to 4 processes of MPI, of a share by threads with the rest by
//! MPI, and of a job one process of which was killed: they are the same.
//!
//! MPI hands out chunks as they are asked for, so that slow ones don't hold up the rest; shares are fixed beforehand, and
//! cost nothing: no dependency and no server. Both need a folder that all processes see.
//!
//! # Shares
//!
//! A program that reads `--shard` by [`share_of`](crate::share_of), as the example `ensemble` does, is an array of jobs of
//! Slurm,
//!
//! ```text
//! #!/bin/bash
//! #SBATCH --array=0-31
//! #SBATCH --cpus-per-task=8
//! srun ./ensemble --shard "$SLURM_ARRAY_TASK_ID/32" --threads 8 --out /shared/out
//! ```
//!
//! an indexed job of Kubernetes,
//!
//! ```text
//! spec:
//!   completions: 32
//!   parallelism: 32
//!   completionMode: Indexed
//!   template:
//!     spec:
//!       restartPolicy: OnFailure
//!       containers:
//!         - name: ensemble
//!           image: ensemble
//!           command: ["sh", "-c", "./ensemble --shard $JOB_COMPLETION_INDEX/32 --out /shared/out"]
//! ```
//!
//! or, on machines without a scheduler, `seq 0 31 | parallel ./ensemble --shard {}/32 --out /shared/out`. These files are
//! written after the schedulers' documentation; what they call is tested, the schedulers aren't here to be.
//!
//! # Size of chunks
//!
//! A chunk is what is lost by a kill, and what two writes to the disk are paid for: a second's work is a good size, and
//! what is taken if nothing is said. Of members that take minutes one is a chunk.
