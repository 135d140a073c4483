//! Motion: the state of a body, the stepper that advances it, and the flows of the thesis, (2.5) and (2.8).
//!
//! A [`Stepper`] is a scene and a [`Plan`], the method with its constants folded; a [`State`] is a [`Motion`] and the
//! plan's memory from step to step. [`OwnStep`] is the plan of the scene's own step; other plans are in
//! [`methods`](crate::methods), and wrappers of plans in [`with`](crate::with). A [`RightHandSide`] is the continuous
//! motion, for an ODE solver of another library. Every method is an [`Integrator`], by which a motion is read between
//! its steps, and [recorded and stopped](crate::recording).
//!
//! # The seam
//!
//! Below are types: scene, group, method and scalar of a [`Stepper`], which one compiled step knows. Above are values: an
//! [`AnyStepper`] holds a [`Propagator`], and its states are numbers, which a [`Layout`] names. Files, Python and ensembles
//! stand above and know neither the group nor the method. A stepper crosses by [`Stepper::into_any`], and its states get a
//! type again by [`AnyStepper::on_group`].
//!
//! Two invariants: a state that crosses the seam and comes back has the same bits, its memory included; and an error
//! leaves the numbers as they were.

// The first module, because its page comes first in the documentation.
mod stepper;

#[macro_use]
mod integrator;

mod abreast;
mod any;
mod batch;
pub(crate) mod own_step;
#[macro_use]
mod delegated;
mod erasure;
mod flows;
mod increment;
mod kept;
mod limits;
mod on_group;
mod plan;
mod propagator;
mod report;
mod right_hand_side;
mod state;
pub(crate) mod summation;

pub use crate::groups::layout::{Factor, FactorKind};
pub use abreast::{Abreast, Together};
pub use any::{AnyMotion, AnyState, AnyStepper};
pub use batch::{Batch, Batchable};
pub use flows::{DiscreteEulerPoincare, DiscreteLiePoisson, reconstruct};
pub use increment::Increment;
pub(crate) use integrator::write_row;
pub use integrator::{Answer, Integrator, Moment};
pub use kept::Kept;
pub use on_group::{GroupState, GroupStepper};
pub use own_step::OwnStep;
pub(crate) use own_step::half_coordinates;
pub(crate) use plan::explained;
pub use plan::{Cost, NextSteps, Plan, PlanFacts, Runs, Steerable, Variable};
#[doc(hidden)]
pub use propagator::forced;
pub use propagator::{Layout, Propagator};
pub use report::{Remedy, StepReport};
pub use right_hand_side::RightHandSide;
#[doc(hidden)]
pub use state::ElapsedTime;
pub use state::State;
pub(crate) use stepper::check_attitude;
pub use stepper::{StateOf, Stepper};
pub use summation::{Motion, Summation};
pub(crate) use summation::{MotionOf, STEPS_BETWEEN_CHECKS, TOLERATED, is_due, restored};

pub use crate::solving::{Guess, Solvability, WarmStart};
