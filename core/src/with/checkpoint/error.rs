//! Errors of resuming a checkpoint.

use alloc::string::String;
use thiserror::Error;

/// An error of resuming a checkpoint.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The file was written by another version of this crate, in another layout.
    #[error(
        "the checkpoint has the format {found}, this version reads {known}; resume it with the version that wrote it"
    )]
    AnotherFormat {
        /// The format's number in the file.
        found: u32,
        /// The format's number in this version.
        known: u32,
    },
    /// The checkpoint belongs to another scene: another Lagrangian, other fields, or another scalar.
    #[error(
        "the checkpoint is of another scene (another Lagrangian or scalar); resume it with the stepper that it was made by"
    )]
    AnotherScene,
    /// A parameter of the stepper differs from the stored one.
    #[error(
        "parameter `{field}` is {stored:e} in the checkpoint and {own:e} here; build the stepper with the checkpoint's parameters, or start a new motion from its attitude and momentum"
    )]
    AnotherParameter {
        /// The field of the Lagrangian.
        field: &'static str,
        /// A scalar of the field in the checkpoint.
        stored: f64,
        /// Value of that scalar in the stepper.
        own: f64,
    },
    /// The stepper's step differs from the stored one.
    #[error(
        "the step is {stored:e} s in the checkpoint and {own:e} s here; build the stepper with the checkpoint's step"
    )]
    AnotherStep {
        /// The step in the checkpoint, s.
        stored: f64,
        /// The step of the stepper, s.
        own: f64,
    },
    /// The checkpoint was made by another method, or one with other coefficients.
    #[error(
        "the checkpoint was made by the method \"{stored}\", this stepper's is \"{own}\"; resume it with the checkpoint's method and let the stepper `adopt` the state"
    )]
    AnotherMethod {
        /// The name of the checkpoint's method.
        stored: String,
        /// The name of the stepper's method.
        own: String,
    },
    /// A list has another length than in this scene.
    #[error(
        "the checkpoint's {what} has {found} numbers instead of {expected}; take another file, this one is damaged"
    )]
    WrongSize {
        /// Name of the list.
        what: &'static str,
        /// Length of the list.
        found: usize,
        /// Length of the list in this scene.
        expected: usize,
    },
    /// A number is NaN or infinite.
    #[error("the checkpoint's {what} has a number that is not finite; take another file, this one is damaged")]
    NonFinite {
        /// Name of the list with this number.
        what: &'static str,
    },
    /// The attitude isn't in the group.
    #[error(
        "the checkpoint's attitude is not in the group (defect {defect:e}); take another file, this one is damaged"
    )]
    NotInGroup {
        /// Residual of the relation of the group for this matrix.
        defect: f64,
    },
    /// The advected parameters don't belong to the attitude.
    #[error(
        "the checkpoint's advected parameters differ by {distance:e} from what its attitude sees; take another file, this one is damaged"
    )]
    NotAdvected {
        /// Distance from the parameters at this attitude.
        distance: f64,
    },
    /// The method's memory has numbers that no such memory can have.
    #[error(
        "the checkpoint's numbers that the method keeps from step to step can't be such; take another file, this one is damaged"
    )]
    NotKept,
    /// The digest doesn't fit the numbers.
    #[error(
        "the checkpoint's numbers don't fit its digest: the file is damaged, or was read by a parser that rounds; take another, or a parser that keeps every bit (serde_json with its feature `float_roundtrip`)"
    )]
    Altered,
}
