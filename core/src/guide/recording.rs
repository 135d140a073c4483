//! Recording, events, and the motion between two steps.
//!
//! Before: [what is conserved](super::conserved). Next: [gradients](super::gradients).
//!
//! # A run that is recorded
//!
//! [`observed`](crate::motion::Stepper::observed) makes a run of any stepper. It shows the motion to closures, every so many
//! steps or at given times; they may record it, stop the run, or fail. Memory doesn't grow with the run, and the steps are
//! those of a run that nobody looks at.
//!
//! ```
//! use liestep::prelude::*;
//! use liestep::recording::{Csv, Event, Reason, Recorder, sections};
//!
//! let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
//! let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
//! let top = Stepper::new(RigidBody { J_d } + gravity, 0.01)?;
//! let mut state = top.start(SO3::from_euler_angles(0.0, 0.8, 0.0), Vector3::new(0.5, 2.0, 12.0))?;
//!
//! let mut file = Recorder::new(&top, Csv::new(Vec::new())) // or Csv::create("top.csv")?
//!     .quantity("height", "m", |now| (now.attitude().matrix() * Vector3::z()).z);
//! let mut turns = Vec::new();
//! let ended = top
//!     .observed(&mut state)
//!     .every(10, |now| file.record(now))
//!     // Where the axis stops rising and where it stops falling.
//!     .event(Event::crossing(), sections::passage(Vector3::z(), Vector3::z()), |now| turns.push(now.time()))
//!     .stop_when(|now| now.velocity().norm() > 100.0)
//!     .until(20.0)?;
//! let text = String::from_utf8(file.finish()?.into_inner()?)?;
//!
//! assert!(matches!(ended.reason, Reason::Done) && ended.steps == 2000);
//! assert!(text.starts_with("t,q_w,q_x,q_y,q_z,velocity_x,") && text.lines().count() == 202);
//! assert!(turns.len() > 20 && turns.is_sorted());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | | |
//! |---|---|
//! | the columns, with their units | [`Recorder`](crate::recording::Recorder) |
//! | to memory, to CSV, by a thread of its own | [`Table`](crate::recording::Table), [`Csv`](crate::recording::Csv), [`Background`](crate::recording::Background) |
//! | to Arrow | `liestep_arrow::ArrowStream`, the package in `core/arrow` |
//! | to a format of one's own | [`Sink`](crate::recording::Sink): three functions |
//! | when a run stops, and what it returns | [`Run`](crate::recording::Run), [`RunReport`](crate::recording::RunReport), [`RunError`](crate::recording::RunError) |
//! | what the files mean elsewhere | [`files`](super::files) |
//! | what it costs | `cargo bench --bench recording` |
//!
//! `cargo bench --bench recording` compares runs of a heavy top with rows at every tenth step to an unobserved one. With the
//! columns above a run takes 1.05 times as long. With CSV it takes 1.4 to 1.5 times as long, so that a row costs four to five
//! steps, and less where another thread has a core to itself. A run of a hundred million steps and its file takes 4 MB of
//! memory (`cargo bench --bench recording -- memory 100000000`).
//!
//! # Between two steps
//!
//! The motion a fraction of a step after a state is a step of the same method with that fraction of `h`. So it has the
//! method's order, stays in the group and keeps the momentum maps, and no interpolation is fitted:
//! [`part`](crate::motion::Integrator::part) and [`state_at`](crate::motion::Integrator::state_at).
//!
//! Events are located on it until their time has no further digit. Of a function that changes its sign over a step one
//! zero is found in any case. With a bound of the second derivative
//! ([`Event::curvature`](crate::recording::Event::curvature)) none is missed. [`sections`](crate::recording::sections) has
//! functions ready made: a plane, a cone, the passage of the vertical, the end of a tumble.
//!
//! A symmetric free body turns steadily about its momentum, so the times are known:
//!
//! ```
//! use liestep::prelude::*;
//! use liestep::recording::{Event, sections};
//!
//! let body = RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(2.0, 2.0, 1.0))? };
//! let stepper = Stepper::composed(body, 0.05, liestep::methods::CompositionScheme::SUZUKI_4)?;
//! let mut state = stepper.start(SO3::identity(), Vector3::new(1.0, 0.0, 2.0))?;
//! let period = std::f64::consts::TAU * 2.0 / state.spatial_momentum().norm();
//!
//! // Its axis passes the plane of momentum and start: twice a turn, at the start to begin with.
//! let normal = state.spatial_momentum().cross(&Vector3::z());
//! let mut times = Vec::new();
//! stepper
//!     .observed(&mut state)
//!     .event(Event::crossing(), sections::plane(Vector3::z(), normal), |now| times.push(now.time()))
//!     .until(10.0 * period + 0.1)?;
//! let late: Vec<f64> = (1..).map(|k| 0.5 * period * f64::from(k)).zip(&times).map(|(t, found)| found - t).collect();
//! assert!(times.len() == 20 && late.iter().all(|late| late.abs() < 1e-3), "{late:?}");
//! assert!((late[19] / late[9] - 2.0).abs() < 0.1); // the phase grows with time
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # In a game, by frame times
//!
//! A renderer has times of its own: 16 ms, 17 ms, once 100 ms, and half of that in slow motion. [`Frames`](crate::recording::Frames)
//! makes the whole steps that are due and shows a part of the next one. Nothing lags, and the motion is the same at any frame
//! rate, to the bit. A real toy spins at 100 to 300 rad/s, which is more than a step of 1/60 s can turn, 90°:
//! `or_substeps` divides such steps. In single precision:
//!
//! ```
//! use liestep::effects::{Gravity, RigidBody};
//! use liestep::nalgebra::{UnitQuaternion, Vector3};
//! use liestep::recording::Frames;
//! use liestep::{NonstandardInertia, StepError, Stepper};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A toy: 50 g, its centre of mass 3 cm above the tip. J_d about the tip, kg m².
//! let J_d = NonstandardInertia::from_diagonal(Vector3::new(1e-5_f32, 1e-5, 5.5e-5))?;
//! let gravity = Gravity { m: 0.05, g: 9.81, rho: Vector3::new(0.0, 0.0, 0.03), up: Vector3::z() };
//! let toy = Stepper::new(RigidBody { J_d } + gravity, 1.0 / 60.0)?.or_substeps(64);
//! let tilted = UnitQuaternion::from_scaled_axis(Vector3::new(0.2, 0.0, 0.0));
//! let state = toy.start(tilted, Vector3::new(0.0, 0.0, 300.0))?;
//!
//! // Two seconds at 144 Hz, and at 30 Hz with one frame that comes late.
//! let mut smooth = Frames::new(toy.clone(), state);
//! for _ in 0..288 {
//!     let now = smooth.advance(1.0 / 144.0)?;
//!     let shown: UnitQuaternion<f32> = now.attitude().into(); // for the renderer
//!     assert!((shown * Vector3::z()).z > 0.8);
//! }
//! let mut rough = Frames::new(toy, state).with_at_most(20);
//! for frame in 0..58 {
//!     rough.advance(if frame == 30 { 0.1 } else { 1.0 / 30.0 })?;
//! }
//! assert!((smooth.time() - rough.time()).abs() < 1e-4);
//! assert_eq!(smooth.state().steps(), rough.state().steps());
//! assert_eq!(smooth.state().momentum(), rough.state().momentum());
//!
//! // Slow motion is a smaller time, and a pause none.
//! smooth.advance(0.25 / 144.0)?;
//! smooth.advance(0.0)?;
//! # Ok(())
//! # }
//! ```
//!
//! With the features `glam033` and `mint` quaternions and vectors become those of a renderer by `into()`; the attitude does
//! by way of `UnitQuaternion`. Nothing here needs an engine: in Bevy, `advance` is called by a system with the `Time` of the
//! frame, and the quaternion is a `Transform`'s. `cargo run --release --example frame-times` is such a loop, with a clock.
//!
//! # Going on another day
//!
//! With the feature `serde`, `stepper.checkpoint(&state)` is a state as numbers, in any format of serde, and
//! `stepper.resume(…)` goes on from it with the same bits, or says why it can't: another scene, another step, a file that has
//! been changed.
