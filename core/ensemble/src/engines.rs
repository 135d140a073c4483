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
//! cost nothing: no dependency and no server. With [`Local::helping`](crate::Local::helping) those that are done make chunks of
//! others, from behind. Both need a folder that all processes see.
//!
//! A process that begins lists the names that are there, and reads the beginning of one file. At its end it reads the
//! beginnings of its own files, of some 1.5 kB each, for their sums; once all chunks are there, of all: of 10⁹ members in 4,097
//! files of 10 MB one part in 6,000. That nothing has been damaged since it was written is asked by
//! [`Store::verified`](crate::Store::verified), which reads every byte.
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
//! of which a part may be submitted again (`--array=3`: what counts is the number of shares, and not `SLURM_ARRAY_TASK_COUNT`,
//! that of the tasks that are submitted together),
//! an indexed job of Kubernetes, `core/ensemble/elsewhere/kubernetes.yaml`, or, on machines without a scheduler,
//! `seq 0 31 | parallel ./ensemble --shard {}/32 --out /shared/out`.
//!
//! # Dask and Ray
//!
//! Their tasks are shares, too: a function that starts the program, given to all numbers of shares.
//!
//! ```python
//! def make(share):
//!     subprocess.run(["./ensemble", "--shard", f"{share}/32", "--out", "/shared/out"], check=True)
//!
//! client.gather(client.map(make, range(32), retries=3))               # dask.distributed
//!
//! task = ray.remote(max_retries=3, retry_exceptions=True)(make)       # ray
//! ray.get([task.remote(share) for share in range(32)])
//! ```
//!
//! A task that is tried again makes what is missing of its share. That its program is killed is an exception to Ray, which
//! it doesn't try again unless it is told to.
//!
//! # What was run
//!
//! `core/ensemble/elsewhere/run` runs the example `ensemble` by threads; by the job file of Slurm and by the command in that
//! of Kubernetes, for each of four shares with the environment that the scheduler gives, and one of Slurm's as it is
//! submitted again; and by Dask and Ray, with two workers on one machine, one program of which is killed, where Python has
//! them (`--install` fetches them). It compares all files, and reads them with polars and pandas, crossings of sections
//! among them. Of the schedulers themselves none was run: that `sbatch` and
//! `kubectl` accept the files is not tested.
//!
//! # Size of chunks
//!
//! A chunk is what is lost by a kill, and what two writes to the disk are paid for: a second's work is a good size. If nothing
//! is said it is that, by what a step of the method costs, or less, so that 64 threads have some. Of members that take
//! minutes one is a chunk.
