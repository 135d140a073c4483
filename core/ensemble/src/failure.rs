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

            /// One of each variant.
            #[cfg(test)]
            fn samples() -> Vec<Self> {
                vec![$($($error::$variant { $($field: Part::read("3").unwrap()),* }.into()),+),+]
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
    use liestep::SetupError;

    #[test]
    fn a_failure_is_read_as_it_was_written() {
        let others = [
            SetupError::SingularKinetic { determinant: 1e-300 / 3.0, body: None }.into(),
            SetupError::Parameter { field: "rho", cause: "is not finite" }.into(),
            SetupError::InvalidStep { step: f64::INFINITY }.into(),
            Failure::Other("no such column".to_owned()),
            Failure::Other(String::new()),
        ];
        let variants = Failure::samples();
        assert_eq!(variants.len(), 33);
        for failure in variants.into_iter().chain(others) {
            assert_ne!(matches!(failure, Failure::Other(_)), failure.to_line().contains("Error."), "{failure:?}");
            assert_eq!(Failure::of_line(&failure.to_line()), Some(failure.clone()), "{failure:?}");
        }
        assert_eq!(Failure::of_line("StepError.AngleWithoutDigits"), None);
        assert_eq!(Failure::of_line("StepError.Tomorrow|1.0"), None);
    }
}
