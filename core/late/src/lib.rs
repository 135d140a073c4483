#![doc = include_str!("../README.md")]
//!
//! # Inside
//!
//! `gradients → effect → term → declaration → sum → {frames, specialised → code} → error`, and
//! `{latex, written} → declaration`: a [`Declaration`] is the derivation of a text, with its stages as straight-line
//! programs, or the `sum` of several; a [`Late`] is one with numbers, and an [`Effect`](liestep::mechanics::Effect) as
//! any other. A [`Backend`] runs the programs: [`Interpreter`] here, machine code in `liestep-machine`. `carried`
//! compares advected parameters with their type. `whole → declaration` makes the steps of any declaration on any group, with
//! slices of numbers for states.
#![forbid(unsafe_code)]

mod carried;
mod code;
mod declaration;
mod effect;
mod error;
mod frames;
mod gradients;
mod latex;
mod specialised;
mod sum;
mod term;
mod whole;
mod written;

pub use carried::Slots;
pub use code::{Backend, Code, Given, Interpreter, StepInputs, UsualStep, applied};
pub use declaration::{Declaration, kept};
pub use effect::{Constants, StepTerms};
pub use error::{LateError, Mistake};
pub use latex::latex;
pub use liestep_derivation::whole::Sizes;
pub use liestep_derivation::{Array, Function, Operation, Program, Role, Source, Stages};
pub use specialised::specialised;
pub use term::{Late, numbers};
pub use whole::{
    BackendInLanes, Between, Course, Paced, Question, QuestionError, Signal, SignalError, Transition, Varied, Whole,
    WholeError, for_accuracy, stepper,
};
pub use written::{c, rust};
