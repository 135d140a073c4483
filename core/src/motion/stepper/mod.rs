//! The stepper: a scene, a method, and all functions around a step.

// The order is that of the stepper's page in the documentation.
mod make;
mod read;
mod start;
mod step;
mod wrap;

pub(crate) use start::check_attitude;

use crate::mechanics::{Effect, Group, Term};
use crate::motion::own_step::OwnStep;
use crate::motion::plan::Plan;
use crate::motion::state::State;

/// The state of a scene `S` with the plan `P`, by default its own step.
pub type StateOf<S, P = OwnStep<S>> = State<Group<S>, <S as Term>::Advected, <P as Plan<S>>::Kept>;

/// An integrator with a fixed step: a scene, and a method whose constants are folded for it.
///
/// ```text
/// Stepper::new(scene, h)                          its own step, of the order of the declared Lagrangian
/// Stepper::composed(scene, h, scheme)             symmetric compositions of it, to order 10
/// Stepper::split(scene, h, flow, scheme)          kinetic flow and kicks in turn, to order 10
/// Stepper::processed(scene, h, flow, scheme)      the same between the ends of a processor, for fewer flows a step
/// Stepper::collocated::<PAIRS>(scene, h)          Gauss collocation, to any order
/// Stepper::for_accuracy(scene, accuracy, …)       the cheapest of all these
/// ```
///
/// A motion by any method `P` is [started](Self::start), [stepped](Self::step) and read in the same way, and
/// [compensated](Self::compensated) sums, [substeps](Self::or_substeps), control forces and checkpoints are available.
///
/// # Contract
///
/// - A step satisfies its momentum equation to rounding on the branch of the identity, or returns an error and leaves
///   the state as it was.
///   The step of (3.13) exists up to `hΩ` = 1 rad about a principal axis, and the phase of a spin is off by the part `(hΩ)²/6`: a
///   fast spin takes a shorter step or [another kinetic term](crate::effects), `GeodesicBody` or `CayleyBody`.
/// - With a scalar of several [lanes](crate::numbers::Real#lanes) all of them move or none does, each as it would alone.
/// - The same state gives the same next state, bit for bit. In Cayley coordinates no library function is called, so
///   that holds from machine to machine.
/// - An inertia that depends on advected or prescribed parameters is checked only at the start of a motion: a
///   scene in which it can become degenerate has to check it itself.
/// - Nothing is allocated, except with constraints on velocities and for an error; no loop is unbounded.
///
/// # Examples
///
/// ```
/// use liestep::effects::PrincipalBody;
/// use liestep::groups::LieGroup as _;
/// use liestep::{SO3, Stepper};
/// use liestep::mechanics::DiagonalNonstandardInertia;
/// use nalgebra::Vector3;
///
/// let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
/// let stepper = Stepper::new(PrincipalBody { J_d }, 0.01)?;
/// let mut state = stepper.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02))?;
/// let before = state.spatial_momentum();
/// for _ in 0..1000 {
///     stepper.step(&mut state)?;
/// }
/// assert!((state.spatial_momentum() - before).norm() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Lanes, InLanes)]
pub struct Stepper<S: Effect, P = OwnStep<S>> {
    pub(crate) scene: S,
    pub(crate) plan: P,
}
