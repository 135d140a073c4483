//! Texts of a step with compensated sums: what rounding takes from attitude, momentum and advected parameters is added to their
//! next changes.
//!
//! They have the functions and the names of the texts without. Sums beside constraints on velocities or a pace aren't compensated.

use super::c::{c_of, gpu_of, header_of, numbered_of};
use super::parts::Parts;
use crate::declaration::Declaration;
use crate::error::LateError;
use crate::whole::Whole;

/// A whole step in C99, as [`c`](super::c()): the bits of the stepper by the method `step, compensated`.
///
/// # Errors
///
/// [`LateError::Step`]: there is no step as programs; [`LateError::Compensated`].
pub fn c(declaration: &Declaration) -> Result<String, LateError> {
    Ok(c_of(&Parts::compensated(declaration)?))
}

/// The part of [`c`] that a unit includes to call the step of another.
///
/// # Errors
///
/// The errors of [`c`].
pub fn header(declaration: &Declaration) -> Result<String, LateError> {
    Ok(header_of(&Parts::compensated(declaration)?))
}

/// The texts that follow [`header`] and [`c`] where the numbers are known, as [`numbered`](super::numbered()).
///
/// # Errors
///
/// The errors of [`c`].
pub fn numbered(whole: &Whole, start: [&[f64]; 3]) -> Result<[String; 2], LateError> {
    Ok(numbered_of(&Parts::compensated(whole.declaration())?, whole, start))
}

/// A step of many members as one text in `OpenCL` C, CUDA and C99, as [`gpu`](super::gpu()).
///
/// # Errors
///
/// The errors of [`c`].
pub fn gpu(declaration: &Declaration) -> Result<String, LateError> {
    Ok(gpu_of(&Parts::compensated(declaration)?))
}
