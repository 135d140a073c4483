//! The choice of an engine.
//!
//! Chunks are independent, and a shard doesn't depend on the engine that computed it, so that one engine may start an
//! ensemble and another complete it, in one folder.
//!
//! | you have | take | when a process dies |
//! |---|---|---|
//! | one machine | [`Local::threads`](crate::Local::threads) | the next run goes on from the shards that are there |
//! | a cluster with MPI | `liestep-ensemble-mpi`, in `core/ensemble/mpi` | MPI ends the job; the next run goes on |
//! | arrays of jobs (Slurm, Kubernetes, GNU parallel), anything else that starts programs | [`Local::share`](crate::Local::share) behind an option `--share i/n` | the scheduler starts that share again |
//! | another scheduler to be written for | [`Engine`](crate::Engine), or [`Ensemble::chunk`](crate::Ensemble::chunk) and [`Store::write`](crate::Store::write) | its own matter |
//!
//! `core/ensemble/mpi/run` compares the files of threads, of 1 to 4 processes of MPI, of a share by threads with the
//! rest by MPI, and of a job with a killed process: they are identical.
//!
//! MPI hands out chunks on request, so that slow ones don't delay the rest; shares are fixed beforehand, and need no
//! dependency and no server. Processes that are done take chunks of other shares with
//! [`Local::helping`](crate::Local::helping), the last ones first. Both need a folder that all processes share.
//!
//! A starting process lists the files, and reads the heads of three. At its end it reads the heads of its own files, some
//! 1.5 kB each, to sum their outcomes, or those of all files once all chunks exist: one part in 6,000 for 10⁹ members
//! in 4,097 files of 10 MB. [`Store::verified`](crate::Store::verified) reads every byte, and so checks that nothing
//! has been damaged since it was written.
//!
//! # Shares
//!
//! A program that reads `--share` by [`share_of`](crate::share_of), as the example `ensemble` does, runs as an array of
//! jobs of Slurm:
//!
//! ```text
//! #!/bin/bash
//! #SBATCH --array=0-31
//! #SBATCH --cpus-per-task=8
//! srun ./ensemble --share "$SLURM_ARRAY_TASK_ID/32" --threads 8 --out /shared/out
//! ```
//!
//! A part of the array may be submitted again (`--array=3`). Write the number of shares, and not
//! `SLURM_ARRAY_TASK_COUNT`, which counts the tasks that are submitted together.
//!
//! The program also runs as an indexed job of Kubernetes, `core/ensemble/elsewhere/kubernetes.yaml`, or, on machines
//! without a scheduler, by `seq 0 31 | parallel ./ensemble --share {}/32 --out /shared/out`.
//!
//! # Dask and Ray
//!
//! Tasks of Dask and Ray are shares, too: a function that starts the program is mapped over the numbers of the shares.
//!
//! ```python
//! def make(share):
//!     subprocess.run(["./ensemble", "--share", f"{share}/32", "--out", "/shared/out"], check=True)
//!
//! client.gather(client.map(make, range(32), retries=3))               # dask.distributed
//!
//! task = ray.remote(max_retries=3, retry_exceptions=True)(make)       # ray
//! ray.get([task.remote(share) for share in range(32)])
//! ```
//!
//! A repeated task computes what is missing of its share. A killed program is an exception to Ray, which repeats such a
//! task on request only.
//!
//! # Tests
//!
//! `core/ensemble/elsewhere/run` runs the example `ensemble` by threads; by the job file of Slurm and by the command in
//! that of Kubernetes, for each of four shares in the scheduler's environment, and for one of Slurm's as a
//! resubmission; and, if Python has them, by Dask and Ray, with two workers on one machine, one program of which is
//! killed (`--install` fetches them). The script compares all files, and reads them with polars and pandas, crossings
//! of sections included. The schedulers themselves were not run: whether `sbatch` and `kubectl` accept the files is
//! untested.
//!
//! # Size of chunks
//!
//! A kill loses the chunks in progress, and each chunk costs two writes to the disk: a second's work is a good size. The
//! first chunks have a few members, and later ones more and more, [up to that](crate::Ensemble::chunks_of). The number of
//! threads is of no matter, and neither is that of members, so that a folder may grow by more of them. A chunk has one
//! member if members take minutes.
