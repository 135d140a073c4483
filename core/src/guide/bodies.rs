//! Several bodies that move together.
//!
//! Before: [groups](super::groups). Next: [accuracy and cost](super::accuracy).
//!
//! # A double pendulum
//!
//! Two to four bodies are declared together, each with an increment of its own. Each advected parameter says who sees it:
//!
//! | `advected(…)` | |
//! |---|---|
//! | `w = up.seen_from(F_1)` | the field `up`, as the body of `F_1` sees it |
//! | `Q = F_2.seen_from(F_1)` | `g_1⁻¹ g_2`: brings a vector from the second body to the first |
//! | `R = F_2.seen_from(space)` | `g_2` itself |
//! | `r = d_2.seen_from(d_1)` | the place of one from the other, of increments `d` of `R3` (`R2`, `R1`) |
//!
//! A body that is translated has a factor `d = R3`, and `d` is a vector in the formula; `t = R1` is a scalar.
//! `examples/declarations` has a top on a cart (`top_on_cart.rs`), two asteroids (`two_bodies.rs`), a spacecraft with
//! wheels (`gyrostat.rs`), and a flyer with a load on a cable (`suspended_load.rs`), whose rotors push by
//! [`step_forced`](crate::Stepper::step_forced); `cargo run --release --example several-bodies` draws some of them.
//!
//! Two links on ball joints. The kinetic energy couples them, because the lower link hangs at the upper one's end:
//!
//! ```
//! use liestep::groups::{Factor, LieGroup as _};
//! use liestep::nalgebra::Vector6;
//! use liestep::prelude::*;
//!
//! #[lagrangian(
//!     group(F_1 = SO3, F_2 = SO3),
//!     advected(w_1 = up.seen_from(F_1), w_2 = up.seen_from(F_2), Q = F_2.seen_from(F_1)),
//!     l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
//!         + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
//!         + ((F_1 - I) * rho).dot(&(Q * ((F_2 - I) * s_2))) / h
//!         - 0.5 * h * g * (w_1.dot(&(s_1 + F_1 * s_1)) + w_2.dot(&(s_2 + F_2 * s_2))),
//! )]
//! struct DoublePendulum {
//!     J_1: NonstandardInertia, // about the pivot, with the mass of the lower link at the joint
//!     J_2: NonstandardInertia, // about the joint
//!     rho: Vector3<f64>,       // the joint from the pivot, upper link
//!     s_1: Vector3<f64>,       // first moment of the upper link, with that mass
//!     s_2: Vector3<f64>,       // and of the lower one, about the joint
//!     g: f64,
//!     up: Vector3<f64>,
//! }
//!
//! // Links of 1 kg and 1 m, a little thick.
//! let down = -Vector3::z();
//! let J_1 = NonstandardInertia::from_diagonal(Vector3::new(0.01, 0.01, 1.0 / 3.0 + 1.0))?;
//! let J_2 = NonstandardInertia::from_diagonal(Vector3::new(0.01, 0.01, 1.0 / 3.0))?;
//! let scene = DoublePendulum { J_1, J_2, rho: down, s_1: down * 1.5, s_2: down * 0.5, g: 9.81, up: Vector3::z() };
//! let stepper = Stepper::new(scene, 0.002)?;
//!
//! let tilt = |angle: f64| SO3::exp(Vector3::x() * angle);
//! let mut state = stepper.start((tilt(1.0), tilt(0.4)), Vector6::new(0.0, 0.0, 1.0, 0.0, 0.0, 2.0))?;
//! let energy = stepper.energy(&state);
//! // What both carry about the vertical, each seen in space.
//! let mut vertical = Vec::new();
//! for _ in 0..10 {
//!     let (upper, lower) = state.attitude();
//!     vertical.push((upper.matrix() * state.momentum_of::<0>() + lower.matrix() * state.momentum_of::<1>()).z);
//!     stepper.run(&mut state, 100)?;
//! }
//! assert!(vertical.iter().all(|now: &f64| (now - vertical[0]).abs() < 1e-11));
//! assert!((stepper.energy(&state) - energy).abs() < 1e-2 * energy.abs());
//!
//! let rates = stepper.velocity(&state); // of both, six numbers
//! let _second = <(SO3, SO3) as Factor<1>>::components(&rates);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! States are tuples: `attitude().1` is the second attitude, `momentum_of::<1>()` its momentum. What the bodies keep
//! together, at any tolerance of the solver, is read off the declaration and said in the documentation of the struct; so is
//! whether a step solves for them together or one after the other.
//!
//! # By their velocities
//!
//! The same links by the velocities of both, in the order of the factors. `discretise` makes `l_d` of it, and `rate` hands the
//! equations themselves to a solver:
//!
//! ```
//! use liestep::motion::RightHandSide;
//! use liestep::nalgebra::Vector6;
//! use liestep::prelude::*;
//!
//! #[lagrangian(
//!     group(F_1 = SO3, F_2 = SO3),
//!     velocity(Omega_1, Omega_2),
//!     advected(w_1 = up.seen_from(F_1), w_2 = up.seen_from(F_2), Q = F_2.seen_from(F_1)),
//!     l = 0.5 * Omega_1.dot(&(J_1 * Omega_1)) + 0.5 * Omega_2.dot(&(J_2 * Omega_2))
//!         + Omega_1.cross(&rho).dot(&(Q * Omega_2.cross(&s_2)))
//!         - g * (w_1.dot(&s_1) + w_2.dot(&s_2)),
//!     discretise = trapezoid(Cayley),
//! )]
//! #[derive(Clone)]
//! struct Links {
//!     J_1: Inertia, // about the pivot, with the mass of the lower link at the joint
//!     J_2: Inertia, // about the joint
//!     rho: Vector3<f64>,
//!     s_1: Vector3<f64>,
//!     s_2: Vector3<f64>,
//!     g: f64,
//!     up: Vector3<f64>,
//! }
//!
//! let down = -Vector3::z();
//! let J_1 = NonstandardInertia::from_diagonal(Vector3::new(0.01, 0.01, 1.0 / 3.0 + 1.0))?.to_inertia();
//! let J_2 = NonstandardInertia::from_diagonal(Vector3::new(0.01, 0.01, 1.0 / 3.0))?.to_inertia();
//! let links = Links { J_1, J_2, rho: down, s_1: down * 1.5, s_2: down * 0.5, g: 9.81, up: Vector3::z() };
//! let equations = RightHandSide::new(links.clone())?;
//! let stepper = Stepper::new(links, 0.01)?;
//! let mut state = stepper.start((SO3::identity(), SO3::identity()), Vector6::new(1.0, 0.0, 0.0, 2.0, 0.0, 0.0))?;
//! let (_, rate) = equations.rates(&state.attitude(), &state.momentum())?; // of the momenta
//! assert!(rate.norm() < 1e-12); // they hang, and turn in one plane
//!
//! // Numbers for a solver; here it is that of Euler, whose errors are of first order.
//! let mut numbers = equations.state(&state.attitude(), &state.momentum());
//! let mut rates = vec![0.0; numbers.len()];
//! for _ in 0..1000 {
//!     equations.rate(&numbers, &mut rates)?;
//!     numbers.iter_mut().zip(&rates).for_each(|(number, rate)| *number += 1e-4 * rate);
//! }
//! stepper.run(&mut state, 10)?;
//! let (_, momentum) = equations.parts(&numbers);
//! assert!((momentum - state.momentum()).norm() < 1e-2 * momentum.norm());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What there is, and what isn't
//!
//! | | |
//! |---|---|
//! | more than four bodies | [systems](#many-bodies), below |
//! | compositions to order 10, substeps, compensated sums, [gradients](super::gradients) | yes |
//! | [recording and events](super::recording) | yes; columns have the number of the body behind their names |
//! | the effects of the library | not in such a declaration, as they are of one body; in a system they are put on bodies |
//! | forces by their virtual work | yes: [`force`](macro@crate::force) with `displacement(eta_1, s)`, a name for each factor |
//! | splittings | no: those are of one body |
//! | `l = …`, the continuous Lagrangian, and the continuous equations of an `l_d` | yes: [by their velocities](#by-their-velocities), above |
//! | collocation by [`CotangentGauss`](crate::methods::CotangentGauss) | no: that is of one group |
//! | joints, and loops of them | [of a system](#joints), not of such a declaration |
//! | contact, impacts | no |
//!
//! `tests/systems/several_bodies` has chains, coupled attitudes and a spherical double pendulum, with references of 25
//! digits. By hand any tuple of groups up to four can be written a Lagrangian for:
//! `examples/how-to-write-a-lagrangian-by-hand.rs` says how, for one group.
//!
//! # Many bodies
//!
//! The group of a system of `N` bodies is `[SO3; N]`. A term is declared on one body or on two, is derived once, and is put at
//! places; what is put at places adds with `+`:
//!
//! | places | the term is declared on |
//! |---|---|
//! | [`Each<N>`](crate::mechanics::Each), [`On<K, N>`](crate::mechanics::On) | one body: put at all, or at the body `K` |
//! | [`Along<N>`](crate::mechanics::Along) | two bodies: put at neighbours in a row |
//! | [`Between<A, B, N>`](crate::mechanics::Between), [`Pairs<N>`](crate::mechanics::Pairs) | two bodies: put at `A` and `B`, or at all pairs |
//! | [`Coupled<N>`](crate::mechanics::Coupled) | two bodies, by a potential that depends on where both are within the step: put at neighbours in a row |
//!
//! [`Placed`](crate::mechanics::Placed) has a row of three as a listing. With potentials of the ends of a step each
//! body is solved by itself, and a step has to be short for the stiffest of them. With one of the middle, at `Coupled`
//! places, the row is solved together, and the step isn't bounded by 2/ω of what is stiff there, as a rod. No body may
//! turn by more than a right angle then: such a step is an error that names the body. `examples/elastic-rod.rs` has one
//! either way, and what a step takes: with `times` some 2 µs a body in a row of 10 as of 100, three iterations, and 0.3
//! µs with potentials of the ends. A term that couples velocities doesn't compile there. Links on ball joints couple
//! them, and have a method of their own, whose step takes a time proportional to their number:
//! [`Chain`](crate::methods::Chain). `examples/hanging-chain` draws twenty of them.
//!
//! # Joints
//!
//! Bodies `(SO3, R3)`, declared by `group(F = SO3, d = R3)` and put at places as any, are held together by joints:
//! [`Stepper::jointed`](crate::Stepper::jointed) has a garland between two pivots as a listing, and
//! `examples/ring-of-links.rs` a ring.
//!
//! | | |
//! |---|---|
//! | [`BallJoint`](crate::methods::BallJoint) | a point of one body is a point of another, or of space |
//! | [`PinJoint`](crate::methods::PinJoint) | so is an axis, about which they turn |
//! | [`Joint`](crate::methods::Joint) | either, where a system has both |
//! | [`constraint`](macro@crate::constraint) | functions of the places of two bodies that are zero, declared: a joint of your own, with a strut as a listing at [`Constraint`](crate::methods::Constraint) |
//!
//! [`Joints`](crate::methods::Joints) takes those of trees and, apart, one of each loop, all of one type: joints of several kinds are an
//! enum of your own that implements [`Constraint`](crate::methods::Constraint), as `Joint` does. A motion starts where joints
//! are closed and with velocities that keep them so; [`start_nearest`](crate::Stepper::start_nearest) finds such from
//! others next to them. What can't be is an error that names the joint: one that is open, one that has nothing to do
//! (the fourth pin of a planar linkage: three of its five functions), a loop that has come to a singular position.
//!
//! The step is that of the minimal form, so momenta and energy are kept as ever. A chain of links is faster in
//! coordinates of its own, by [`Chain::stepper`](crate::methods::Chain::stepper).
//!
//! # Directions
//!
//! A spherical pendulum, or a rod in a chain, moves on the sphere S² of directions. It needs no group of its own: a body that is
//! symmetric about its axis, and starts without spin, gets none. [`NonstandardInertia::of_rod`](crate::NonstandardInertia::of_rod)
//! is the inertia of such a rod, and [`pointing`](crate::NonstandardInertia::pointing) makes attitude and velocity of
//! where it points and of how fast. Alone, in a product, in a system or in a chain:
//!
//! ```
//! use liestep::methods::{Chain, Link};
//! use liestep::numbers::Bodies;
//! use liestep::prelude::*;
//!
//! // Uniform rods of one metre: about an end, a third of the mass at the other.
//! let (down, up) = (-Vector3::z(), Vector3::z());
//! let J_d = NonstandardInertia::of_rod(1.0 / 3.0, &down)?;
//! let link = Link { J_d, m: 1.0, c: down * 0.5, rho: down };
//! let stepper = Chain { links: [link; 3], g: 9.81, up }.stepper(0.002)?;
//! let (attitude, velocity) = J_d.pointing(&down, &Vector3::x(), &(up * 2.0))?;
//! let mut state = stepper.start([attitude; 3], Bodies([velocity; 3]))?;
//! stepper.run(&mut state, 500)?;
//! assert!(state.momentum().0.iter().all(|momentum| momentum.z.abs() < 1e-13));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Bodies that don't see each other
//!
//! Bodies without a coupling are no product but a list: run each by its own stepper, or many of one kind in the
//! lanes of [ensembles](super::ensembles). A balanced wheel that spins at a constant momentum in its body is the effect
//! [`Rotor`](crate::effects::Rotor).
