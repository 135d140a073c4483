//! The failure of a member.

use liestep::mechanics::InertiaError;
use liestep::{SetupError, StepError};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The reason why a member couldn't be constructed, or stepped to its end.
#[derive(Clone, Debug, PartialEq, Error, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Failure {
    /// The scene or the initial state is impossible.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// The inertia is that of no body.
    #[error(transparent)]
    Inertia(#[from] InertiaError),
    /// A step has no solution.
    #[error(transparent)]
    Step(#[from] StepError),
    /// Another reason, in words.
    #[error("{0}")]
    Other(String),
}

/// A failed member, and the number of steps that it completed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MemberFailure {
    /// The member's number.
    pub member: u64,
    /// The completed steps; zero if the member couldn't be constructed.
    pub steps: u64,
    /// Whether the member could be constructed, and failed later.
    pub was_made: bool,
    /// The reason of the failure.
    pub failure: Failure,
}

#[cfg(test)]
mod tests {
    use super::{Failure, MemberFailure};
    use liestep::mechanics::InertiaError;
    use liestep::{SetupError, StepError};

    /// Failures with fields of each type and with none are read back, floats to their last bit.
    #[test]
    fn a_failure_is_read_as_it_was_written() {
        let failures: [Failure; 12] = [
            SetupError::SingularKinetic { determinant: 1e-300 / 3.0, body: None }.into(),
            SetupError::NegativeKinetic { pivot: -0.1, body: Some(7) }.into(),
            SetupError::Parameter { field: "rho", cause: "is not finite" }.into(),
            SetupError::InvalidStep { step: f64::INFINITY }.into(),
            SetupError::NoForceGradient.into(),
            InertiaError::NotFinite.into(),
            InertiaError::NotPositive { what: "mass", value: -1e300 }.into(),
            StepError::NotConverged { iterations: 7, residual: f64::MIN_POSITIVE }.into(),
            StepError::NonFinite { what: "momentum" }.into(),
            StepError::Singular.into(),
            Failure::Other("two\nlines | \"one\" \u{1b}".to_owned()),
            Failure::Other(String::new()),
        ];
        for failure in failures {
            let failed = MemberFailure { member: u64::MAX, steps: 3, was_made: true, failure };
            let text = toml::to_string(&failed).unwrap();
            assert_eq!(toml::from_str(&text), Ok(failed), "{text}");
        }
        assert!(toml::from_str::<Failure>("Step.Tomorrow.turn = 1.0").is_err());
    }
}
