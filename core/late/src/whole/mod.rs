//! Steps of any declaration on any group, whose states are slices of numbers.
//!
//! [`Whole`] is one stepper for all declarations that are texts. The derivation writes a step as straight-line programs,
//! from the generators of the group alone; this room runs them, compares numbers and decides: how often to iterate, whether
//! a Jacobian serves twice, whether a solution continues the identity, when rounding errors are taken back. It knows no
//! group; only the coordinates of small changes, for plans and estimates, know rotations.
//!
//! # Invariants
//!
//! - The decisions are those of the compiled step, in the same order, so that both make the same steps to the bit: on SO(3),
//!   products and any matrix group, solves with care included. Where matrices of five rows or more are inverted, steps of
//!   more than half a radian differ by rounding, as pivots are taken on the diagonal.
//! - Code and texts are shared. What depends on numbers and on `h` are the constants alone, so that a sweep derives once.
//! - An error leaves a state as it was, and slices of wrong lengths are errors.
//!
//! Deliberately not here: joints and systems. They are typed, and behind the same
//! [`Propagator`](liestep::motion::Propagator). Methods of SO(3) alone are the library's own, by a scene that runs programs.
//!
//! The files depend on each other in one direction: `methods → {collocation, compensated, course, hamiltonian, rotating}`,
//! `{abreast, collocation, compensated, hamiltonian, lengths} → stepper`, `pace → lengths`, `plant → {algebra, tangent}`,
//! `inputs → tangent → composed`, `{density, forwards → {derivatives → {algebra, tape → slopes → limit}, tangent}} → varied →
//! {course, lengths}` and `stepper → composed → step → diagnosis → {care → iteration, constants} → limit → {codes, linear}`.
//! `signal` needs none of them.

mod abreast;
mod algebra;
mod care;
mod codes;
mod collocation;
mod compensated;
mod composed;
mod constants;
mod course;
mod density;
mod derivatives;
mod diagnosis;
mod forwards;
mod hamiltonian;
mod inputs;
mod iteration;
mod lengths;
mod limit;
mod linear;
mod methods;
mod pace;
mod plant;
mod rotating;
mod signal;
mod slopes;
mod step;
mod stepper;
mod tangent;
mod tape;
mod varied;

pub use abreast::BackendInLanes;
pub use course::Course;
pub use derivatives::{Derivatives, Gradient, Reading, Row};
pub use forwards::Direction;
pub use inputs::Transition;
pub use methods::{Question, QuestionError, for_accuracy, layout, stepper};
pub use pace::Paced;
pub use signal::{Between, Signal, SignalError};
pub use stepper::{Whole, WholeError};
pub use varied::Varied;
