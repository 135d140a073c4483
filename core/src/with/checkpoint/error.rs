//! Why a checkpoint isn't taken.

use alloc::string::String;
use thiserror::Error;

/// Why a checkpoint can't be resumed.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The file was written by another version of this crate, in another layout.
    #[error(
        "the checkpoint has the format {found}, this version reads {known}; resume it with the version that wrote it"
    )]
    AnotherFormat {
        /// The number in the file.
        found: u32,
        /// The one that is understood.
        known: u32,
    },
    /// The checkpoint is of another scene: another Lagrangian, other fields, or another scalar.
    #[error(
        "the checkpoint is of another scene (another Lagrangian or scalar); resume it with the stepper that it was made by"
    )]
    AnotherScene,
    /// A parameter had another value.
    #[error(
        "parameter `{field}` is {stored:e} in the checkpoint and {own:e} here; build the stepper with the checkpoint's parameters, or start a new motion from its attitude and momentum"
    )]
    AnotherParameter {
        /// The field of the Lagrangian.
        field: &'static str,
        /// A scalar of it in the checkpoint.
        stored: f64,
        /// That scalar in the stepper.
        own: f64,
    },
    /// The step had another size.
    #[error(
        "the step is {stored:e} s in the checkpoint and {own:e} s here; build the stepper with the checkpoint's step"
    )]
    AnotherStep {
        /// In the checkpoint, s.
        stored: f64,
        /// Here, s.
        own: f64,
    },
    /// The checkpoint was made by another method, or one with other coefficients.
    #[error(
        "the checkpoint was made by the method \"{stored}\", this stepper's is \"{own}\"; resume it with the checkpoint's method and let the stepper `adopt` the state"
    )]
    AnotherMethod {
        /// The name of the checkpoint's.
        stored: String,
        /// The name of the stepper's.
        own: String,
    },
    /// A list doesn't have the length that it has in this scene.
    #[error(
        "the checkpoint's {what} has {found} numbers instead of {expected}; take another file, this one is damaged"
    )]
    WrongSize {
        /// Which one.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The one expected.
        expected: usize,
    },
    /// A number is NaN or infinite.
    #[error("the checkpoint's {what} has a number that is not finite; take another file, this one is damaged")]
    NonFinite {
        /// The list that has it.
        what: &'static str,
    },
    /// The attitude isn't in the group.
    #[error(
        "the checkpoint's attitude is not in the group (defect {defect:e}); take another file, this one is damaged"
    )]
    NotInGroup {
        /// How far the matrix is from the relation of the group.
        defect: f64,
    },
    /// The advected parameters aren't those that the attitude sees.
    #[error(
        "the checkpoint's advected parameters differ by {distance:e} from what its attitude sees; take another file, this one is damaged"
    )]
    NotAdvected {
        /// How far they are.
        distance: f64,
    },
    /// What the method keeps from step to step can't be this.
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
