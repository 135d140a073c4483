//! Ensembles: many motions of one kind, run on all cores or on a cluster.
//!
//! Members are drawn by a seed or read from a table, run eight at a time in SIMD lanes and on all cores, and recorded
//! in files that stay whole if the process is killed. Results are a function of the plan alone, to the last bit.
//!
//! ```
//! use liestep::effects::{Gravity, PrincipalBody};
//! use liestep::mechanics::DiagonalNonstandardInertia;
//! use liestep::{SO3, Stepper};
//! use liestep_ensemble::{Ensemble, Local, Reduction, Store};
//! use nalgebra::Vector3;
//!
//! let ensemble = Ensemble::new("tilted tops", 100, 1_000, |member| {
//!     let moments = Vector3::new(3.0, 3.0, member.normal("J_3", 4.0, 0.1));
//!     let body = PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(moments)? };
//!     let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
//!     let stepper = Stepper::new(body + gravity, 0.01)?;
//!     let tilt = member.uniform("tilt", 0.2..0.6);
//!     let state = stepper.start(SO3::exp(Vector3::x() * tilt), Vector3::new(0.0, 0.0, 12.0))?;
//!     Ok((stepper, state))
//! })
//! .seed(7)
//! .keep(["x", "y", "z"], |run| (run.state.attitude().as_matrix() * Vector3::z()).into())
//! .reduce("energy", Reduction::Moments, |run| run.stepper.energy(run.state));
//! # let out = std::env::temp_dir().join(format!("liestep-ensemble-page-{}", std::process::id()));
//! # let _ = std::fs::remove_dir_all(&out);
//!
//! let report = ensemble.run(&Local::threads(0), &Store::folder(&out)?)?; // goes on where it was
//! assert_eq!((report.outcome.finished, report.outcome.failed()), (100, 0));
//! println!("{:?}", report.reduced("energy"));
//! # std::fs::remove_dir_all(&out)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Parts
//!
//! ```text
//! Ensemble       members, steps, seed or table, recorded columns        → fingerprint
//! member k       a function of the seed and k, or of row k
//! chunk c        a function of the plan and c: members in lanes, failures with their errors
//! Store          a folder of shards, one file per chunk: written whole or not at all
//! Engine         assigns chunks to workers: threads here, shares of a job array, MPI
//! ```
//!
//! | to | use |
//! |---|---|
//! | draw members | [`Member`] |
//! | read members from a table | [`Table`], [`Ensemble::over`] |
//! | keep columns at the end, or at times | [`Ensemble::keep`], [`Ensemble::every`] |
//! | keep columns where members cross a surface, or end there | [`Ensemble::section`], [`Section::until`] |
//! | moments, histograms and quantiles of the ends, or of crossings | [`Ensemble::reduce`], [`Section::reduce`] |
//! | find out which members failed, when and why | [`Ensemble::shards`], [`MemberFailure`] |
//! | read the files elsewhere | [`Store`] |
//! | use several machines | [`engines`] |

mod chunk;
mod draw;
mod engine;
pub mod engines;
mod ensemble;
mod failure;
mod group;
mod name;
mod outcome;
mod reduce;
mod report;
mod section;
mod shard;
mod sizes;
mod store;
mod table;

pub use draw::Member;
pub use engine::{Engine, Local, MakeChunk, share_of};
pub use ensemble::{Ensemble, Run};
pub use failure::{Failure, MemberFailure};
pub use outcome::{Outcome, Passages};
pub use reduce::{Histogram, Moments, Quantiles, Reduction, Summary};
pub use report::{Progress, Report};
pub use section::Section;
pub use shard::{Crossings, Rows, Shard, Status};
pub use store::{Fault, Store, StoreError};
pub use table::{Table, TableError};
