#![doc = include_str!("../README.md")]
//!
//! # Inside
//!
//! `certificate → written → {whole → declaration, emitted → declaration}`, `{compiled, latex} → declaration → sum → error` and `declaration → code →
//! error`: a [`Declaration`] is the
//! derivation of a text, with its stages as straight-line programs, or the `sum` of several. A [`Backend`] runs programs:
//! [`Interpreter`] here, machine code in `liestep-machine`. `whole → declaration` makes the steps of any declaration on any
//! group, with slices of numbers for states: [`Whole`].
#![forbid(unsafe_code)]

mod certificate;
mod code;
mod compiled;
mod declaration;
mod emitted;
mod error;
mod latex;
mod sum;
mod whole;
mod written;

pub use certificate::certificate;
pub use code::{Backend, Code, Given, Interpreter, StepInputs, UsualStep, applied};
pub use compiled::numbers;
pub use declaration::{Declaration, kept};
pub use error::{LateError, Mistake};
pub use latex::latex;
pub use liestep_derivation::whole::Sizes;
pub use liestep_derivation::{Array, Function, Operation, Program, Role, Source, Stages};
pub use whole::{
    BackendInLanes, Between, Course, Derivatives, Direction, Gradient, Paced, Question, QuestionError, Reading, Row,
    Signal, SignalError, Transition, Varied, Whole, WholeError, for_accuracy, layout, stepper,
};
pub use written::{Sums, c, constant, gpu, header, is_exact, javascript, numbered, prefix, rust};
