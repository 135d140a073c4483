#![doc = include_str!("../README.md")]
//!
//! # Inside
//!
//! `effect → term → declaration → code`: a [`Declaration`] is what was derived of a text, with its stages as straight-line code for
//! an interpreter; a [`Late`] is one with numbers, and an [`Effect`](liestep::mechanics::Effect) as any other. `carried` compares
//! what is advected with the type that carries it.
#![forbid(unsafe_code)]

mod carried;
mod code;
mod declaration;
mod effect;
mod term;

pub use carried::Slots;
pub use declaration::{Declaration, LateError, Mistake, kept};
pub use effect::{Constants, StepTerms};
pub use term::Late;
