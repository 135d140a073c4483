//! Ensembles: many motions at once.
//!
//! Before: [gradients](super::gradients). Next: [a Lagrangian in a file](super::late).
//!
//! # Which way
//!
//! | you have | take |
//! |---|---|
//! | a hundred motions, of any kind | a loop, or threads: a [`Stepper`](crate::Stepper) is `Send` and `Sync` where its scene is, an [`AnyStepper`](crate::motion::AnyStepper) isn't |
//! | bodies of one kind, one core | lanes: [`Batch`](crate::motion::Batch) |
//! | thousands and millions, all cores, a cluster, results in files | the package `liestep-ensemble` in `core/ensemble` |
//! | a scene file with a table `ensemble` or `sweep` | the program `liestep` |
//!
//! # Threads
//!
//! Nothing is shared by two motions but what doesn't change, so that the threads of the standard library are enough:
//!
//! ```
//! use liestep::prelude::*;
//! use std::thread;
//!
//! fn height_after(tilt: f64) -> Result<f64, Box<dyn std::error::Error + Send + Sync>> {
//!     let J_d = DiagonalNonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).map_err(|e| e.to_string())?;
//!     let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
//!     let stepper = Stepper::new(PrincipalBody { J_d } + gravity, 0.01)?;
//!     let mut state = stepper.start(SO3::exp(Vector3::x() * tilt), Vector3::new(0.0, 0.0, 12.0))?;
//!     stepper.run(&mut state, 500)?;
//!     Ok((state.attitude().matrix() * Vector3::z()).z)
//! }
//!
//! let tilts = [0.1, 0.2, 0.3, 0.4];
//! let heights = thread::scope(|scope| {
//!     let runs = tilts.map(|tilt| scope.spawn(move || height_after(tilt)));
//!     runs.map(|run| run.join().map_err(|_| "a thread has panicked".into()).and_then(|height| height))
//! });
//! for (height, tilt) in heights.into_iter().zip(tilts) {
//!     let height = height.map_err(|e| e.to_string())?;
//!     assert!(height <= tilt.cos() + 1e-9 && height > 0.5); // it falls, and the spin holds it
//! }
//! # Ok::<(), String>(())
//! ```
//!
//! # Lanes
//!
//! A scene that is generic over its scalar, as the effects of the library are, is stepped by SIMD lanes: four or eight scenes
//! at once, each with the bits that it has alone. It may be one body, bodies that are declared together, as a top on a
//! cart, or a [system](crate::mechanics::Placed) of many with springs between them; bodies in joints and chains go one by
//! one. [`Batch`](crate::motion::Batch) puts steppers and states into lanes and takes them out; where the step of one has
//! no solution that one stops with its error, and the others go on. Its page has a listing. Eight tops in `f64` gain 3.9
//! times with AVX2, without compiling for one machine (`cargo bench --bench lanes`), scenes of several bodies 1.2 to 2.0
//! times.
//!
//! # Members, files, clusters
//!
//! `liestep-ensemble` draws members by a seed or reads them from a table, runs them in lanes and on all cores, and keeps
//! columns, moments and histograms:
//!
//! ```text
//! let ensemble = Ensemble::new("tilted tops", 100_000, 1_000, |member| {
//!     let tilt = member.uniform("tilt", 0.2..0.6);
//!     …
//!     Ok((stepper, state))
//! })
//! .seed(7)
//! .keep(["x", "y", "z"], |run| (run.state.attitude().as_matrix() * Vector3::z()).into())
//! .reduce("energy", Reduction::Moments, |run| run.stepper.energy(run.state));
//! let report = ensemble.run(&Local::threads(0), &Store::folder("tops")?)?;
//! ```
//!
//! * What comes out is a function of the plan alone, to the last bit: of no number of threads, and of no order.
//! * It is written as shards, each whole or not there. A run that was killed goes on where it was.
//! * A member that fails is counted, with its error, its step and its number.
//! * Several machines share a folder, as the jobs of an array or by MPI.
//!
//! The first page of its documentation (`cargo doc --open -p liestep-ensemble`) has the listing in full, as a test. How soon a
//! satellite is lost and where a top is chaotic: `cargo run --release --example ensemble`.
