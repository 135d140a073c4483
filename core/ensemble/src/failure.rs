//! Why a member has no end, as a value and as a line of a file.

use std::collections::BTreeSet;
use std::sync::Mutex;

use liestep::mechanics::InertiaError;
use liestep::{SetupError, StepError};
use thiserror::Error;

/// Why a member couldn't be made, or couldn't be stepped to its end.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Failure {
    /// Its scene or its start is impossible.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// It has the inertia of no body.
    #[error(transparent)]
    Inertia(#[from] InertiaError),
    /// A step of it has no solution.
    #[error(transparent)]
    Step(#[from] StepError),
    /// Another reason, in words.
    #[error("{0}")]
    Other(String),
}

/// A member that has failed, and the number of steps that it had made.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberFailure {
    /// Its number.
    pub member: u64,
    /// The steps that it made; none where it couldn't be made itself.
    pub steps: u64,
    /// Why there are no more.
    pub failure: Failure,
}

/// What the variants of the library's errors are made of.
trait Part: Sized {
    fn write(&self) -> String;
    fn read(text: &str) -> Option<Self>;
}

/// Parts that are written as they are shown for programmers: floats to their last bit.
macro_rules! plain_parts {
    ($($number:ty),+) => {$(
        impl Part for $number {
            fn write(&self) -> String {
                format!("{self:?}")
            }

            fn read(text: &str) -> Option<Self> {
                text.parse().ok()
            }
        }
    )+};
}

plain_parts!(f64, usize, u32);

impl Part for Option<usize> {
    fn write(&self) -> String {
        self.map_or_else(|| "none".to_owned(), |body| body.to_string())
    }

    fn read(text: &str) -> Option<Self> {
        if text == "none" { Some(None) } else { text.parse().ok().map(Some) }
    }
}

impl Part for &'static str {
    fn write(&self) -> String {
        (*self).to_owned()
    }

    fn read(text: &str) -> Option<Self> {
        Some(interned(text))
    }
}

/// Writes and reads these variants with these fields: `StepError.AngleWithoutDigits|2.0`.
macro_rules! lines {
    ($($failure:ident $error:ident { $($variant:ident { $($field:ident),* })+ })+) => {
        impl Failure {
            /// `None` of another, also of what a later version of the library may say.
            fn parts(&self) -> Option<Vec<String>> {
                match self {
                    $($(Self::$failure($error::$variant { $($field),* }) => Some(vec![
                        concat!(stringify!($error), ".", stringify!($variant)).to_owned(),
                        $($field.write()),*
                    ]),)+)+
                    _ => None,
                }
            }

            pub(crate) fn of_line(line: &str) -> Option<Self> {
                let mut parts = line.split('|');
                match parts.next()? {
                    $($(concat!(stringify!($error), ".", stringify!($variant)) => {
                        Some($error::$variant { $($field: Part::read(parts.next()?)?),* }.into())
                    })+)+
                    "other" => Some(Self::Other(parts.next()?.to_owned())),
                    _ => None,
                }
            }
        }
    };
}

lines! {
    Setup SetupError {
        Parameter { field, cause }
        BodyParameter { body, field, cause }
        Joint { joint, cause }
        JointParameter { joint, field, cause }
        OffConstraint { joint, by }
        OffVelocity { joint, by }
        RedundantJoint { joint, pivot }
        InvalidStep { step }
        SingularKinetic { determinant, body }
        NegativeKinetic { pivot, body }
        NonFiniteConstant {}
        NonFinite { what }
        NotInGroup { defect }
        NotSeparable { defect }
        InertiaMismatch { difference }
        VaryingInertia {}
        NoSecondDerivatives {}
        BiasMismatch {}
        NoForceGradient {}
    }
    Inertia InertiaError {
        NotFinite {}
        NotSymmetric { defect }
        NotDiagonal { largest }
        TriangleInequality { smallest }
        Singular { smallest }
        OutOfRange { trace }
    }
    Step StepError {
        NonFinite { what }
        BeyondSolvable { step, largest, turn, body }
        AngleWithoutDigits { turn }
        NotConverged { iterations, residual }
        WrongBranch { determinant }
        Singular {}
        SingularJoint { joint, pivot }
        UnsolvedBody { body, turn, determinant }
    }
}

impl Failure {
    /// A name and what belongs to it.
    pub(crate) fn to_line(&self) -> String {
        let other = || vec!["other".to_owned(), self.to_string().replace(['\n', '|'], " ")];
        self.parts().unwrap_or_else(other).join("|")
    }
}

/// The library's errors name fields and parts by texts that last as long as the program: of those that files name, one
/// copy each is kept.
fn interned(text: &str) -> &'static str {
    static KNOWN: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut known = KNOWN.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    if let Some(text) = known.get(text) {
        return text;
    }
    let kept: &'static str = Box::leak(text.to_owned().into_boxed_str());
    known.insert(kept);
    kept
}

#[cfg(test)]
mod tests {
    use super::Failure;
    use liestep::mechanics::InertiaError;
    use liestep::{SetupError, StepError};

    #[test]
    fn a_failure_is_read_as_it_was_written() {
        let failures: [Failure; 38] = [
            SetupError::Parameter { field: "rho", cause: "is not finite" }.into(),
            SetupError::BodyParameter { body: 99, field: "m", cause: "is not a mass" }.into(),
            SetupError::Joint { joint: 2, cause: "closes a loop" }.into(),
            SetupError::JointParameter { joint: 2, field: "above", cause: "is not finite" }.into(),
            SetupError::OffConstraint { joint: 99, by: 0.1 }.into(),
            SetupError::OffVelocity { joint: 0, by: 0.1 }.into(),
            SetupError::RedundantJoint { joint: 3, pivot: 1e-17 }.into(),
            SetupError::InvalidStep { step: f64::INFINITY }.into(),
            SetupError::SingularKinetic { determinant: 1e-300, body: None }.into(),
            SetupError::SingularKinetic { determinant: 1e-300, body: Some(3) }.into(),
            SetupError::NegativeKinetic { pivot: -0.1, body: None }.into(),
            SetupError::NegativeKinetic { pivot: -0.1, body: Some(3) }.into(),
            SetupError::NonFiniteConstant.into(),
            SetupError::NonFinite { what: "velocity" }.into(),
            SetupError::NotInGroup { defect: 0.1 }.into(),
            SetupError::NotSeparable { defect: 0.1 }.into(),
            SetupError::InertiaMismatch { difference: 0.1 }.into(),
            SetupError::VaryingInertia.into(),
            SetupError::NoSecondDerivatives.into(),
            SetupError::BiasMismatch.into(),
            SetupError::NoForceGradient.into(),
            InertiaError::NotFinite.into(),
            InertiaError::NotSymmetric { defect: 0.1 }.into(),
            InertiaError::NotDiagonal { largest: 0.1 }.into(),
            InertiaError::TriangleInequality { smallest: -0.1 }.into(),
            InertiaError::Singular { smallest: 0.0 }.into(),
            InertiaError::OutOfRange { trace: 1e300 }.into(),
            StepError::NonFinite { what: "momentum after the step" }.into(),
            StepError::BeyondSolvable { step: 0.1, largest: 1.0 / 3.0, turn: 2.0, body: None }.into(),
            StepError::BeyondSolvable { step: 0.1, largest: 1.0 / 3.0, turn: 2.0, body: Some(3) }.into(),
            StepError::AngleWithoutDigits { turn: 1e20 }.into(),
            StepError::NotConverged { iterations: 20, residual: 0.5 }.into(),
            StepError::WrongBranch { determinant: -1.0 }.into(),
            StepError::Singular.into(),
            StepError::UnsolvedBody { body: 3, turn: 2.0, determinant: -1.0 }.into(),
            StepError::SingularJoint { joint: 3, pivot: -1e-12 }.into(),
            Failure::Other("no such column".to_owned()),
            Failure::Other(String::new()),
        ];
        for failure in failures {
            assert_eq!(Failure::of_line(&failure.to_line()), Some(failure.clone()), "{failure:?}");
        }
        assert_eq!(Failure::of_line("StepError.AngleWithoutDigits"), None);
        assert_eq!(Failure::of_line("StepError.Tomorrow|1.0"), None);
    }
}
