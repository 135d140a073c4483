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

impl Failure {
    /// A name, numbers and texts: `step.solvable 0.01 0.005 1.5`, `setup.parameter|rho|is not finite`.
    pub(crate) fn to_line(&self) -> String {
        let (name, numbers, texts): (&str, Vec<f64>, Vec<&str>) = match self {
            Self::Setup(error) => of_setup(error),
            Self::Inertia(error) => of_inertia(error),
            Self::Step(error) => of_step(error),
            Self::Other(_) => ("", vec![], vec![]),
        };
        if name.is_empty() {
            // Also what a later version of the library may say.
            return format!("other|{}", self.to_string().replace(['\n', '|'], " "));
        }
        let numbers = numbers.iter().map(|number| format!(" {number:?}"));
        let texts = texts.iter().map(|text| format!("|{text}"));
        core::iter::once(name.to_owned()).chain(numbers).chain(texts).collect()
    }

    pub(crate) fn of_line(line: &str) -> Option<Self> {
        let mut texts = line.split('|');
        let mut words = texts.next()?.split(' ');
        let name = words.next()?;
        let mut number = || words.next()?.parse::<f64>().ok();
        let mut text = || texts.next().map(interned);
        Some(match name {
            "setup.parameter" => SetupError::Parameter { field: text()?, cause: text()? }.into(),
            "setup.body" => SetupError::BodyParameter { body: whole(number()?), field: text()?, cause: text()? }.into(),
            "setup.joint" => SetupError::Joint { joint: whole(number()?), cause: text()? }.into(),
            "setup.joint-field" => {
                SetupError::JointParameter { joint: whole(number()?), field: text()?, cause: text()? }.into()
            }
            "setup.open" => SetupError::OffConstraint { joint: whole(number()?), by: number()? }.into(),
            "setup.opening" => SetupError::OffVelocity { joint: whole(number()?), by: number()? }.into(),
            "setup.redundant" => SetupError::RedundantJoint { joint: whole(number()?), pivot: number()? }.into(),
            "setup.step" => SetupError::InvalidStep { step: number()? }.into(),
            "setup.singular" => {
                SetupError::SingularKinetic { determinant: number()?, body: number().map(whole) }.into()
            }
            "setup.negative" => SetupError::NegativeKinetic { pivot: number()?, body: number().map(whole) }.into(),
            "setup.constant" => SetupError::NonFiniteConstant.into(),
            "setup.finite" => SetupError::NonFinite { what: text()? }.into(),
            "setup.group" => SetupError::NotInGroup { defect: number()? }.into(),
            "setup.separable" => SetupError::NotSeparable { defect: number()? }.into(),
            "setup.inertia" => SetupError::InertiaMismatch { difference: number()? }.into(),
            "setup.varying" => SetupError::VaryingInertia.into(),
            "setup.second" => SetupError::NoSecondDerivatives.into(),
            "setup.bias" => SetupError::BiasMismatch.into(),
            "setup.gradient" => SetupError::NoForceGradient.into(),
            "inertia.finite" => InertiaError::NotFinite.into(),
            "inertia.symmetric" => InertiaError::NotSymmetric { defect: number()? }.into(),
            "inertia.diagonal" => InertiaError::NotDiagonal { largest: number()? }.into(),
            "inertia.triangle" => InertiaError::TriangleInequality { smallest: number()? }.into(),
            "inertia.singular" => InertiaError::Singular { smallest: number()? }.into(),
            "inertia.range" => InertiaError::OutOfRange { trace: number()? }.into(),
            "step.finite" => StepError::NonFinite { what: text()? }.into(),
            "step.solvable" => {
                let (step, largest, turn) = (number()?, number()?, number()?);
                StepError::BeyondSolvable { step, largest, turn, body: number().map(whole) }.into()
            }
            "step.angle" => StepError::AngleWithoutDigits { turn: number()? }.into(),
            "step.body" => {
                StepError::UnsolvedBody { body: whole(number()?), turn: number()?, determinant: number()? }.into()
            }
            "step.joint" => StepError::SingularJoint { joint: whole(number()?), pivot: number()? }.into(),
            "step.converged" => {
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // it was a `u32`
                let iterations = number()? as u32;
                StepError::NotConverged { iterations, residual: number()? }.into()
            }
            "step.branch" => StepError::WrongBranch { determinant: number()? }.into(),
            "step.singular" => StepError::Singular.into(),
            "other" => Self::Other(texts.next()?.to_owned()),
            _ => return None,
        })
    }
}

/// The number of a body or a joint.
#[allow(clippy::cast_precision_loss)] // far fewer than a float counts
fn count(body: usize) -> f64 {
    body as f64
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // it was a `usize`
fn whole(number: f64) -> usize {
    number as usize
}

/// Numbers, and that of a body if there is one.
fn and_body(numbers: &[f64], body: Option<usize>) -> Vec<f64> {
    numbers.iter().copied().chain(body.map(count)).collect()
}

type Parts<'a> = (&'a str, Vec<f64>, Vec<&'a str>);

fn of_setup(error: &SetupError) -> Parts<'_> {
    match error {
        SetupError::Parameter { field, cause } => ("setup.parameter", vec![], vec![field, cause]),
        SetupError::BodyParameter { body, field, cause } => ("setup.body", vec![count(*body)], vec![field, cause]),
        SetupError::Joint { joint, cause } => ("setup.joint", vec![count(*joint)], vec![cause]),
        SetupError::JointParameter { joint, field, cause } => {
            ("setup.joint-field", vec![count(*joint)], vec![field, cause])
        }
        SetupError::OffConstraint { joint, by } => ("setup.open", vec![count(*joint), *by], vec![]),
        SetupError::OffVelocity { joint, by } => ("setup.opening", vec![count(*joint), *by], vec![]),
        SetupError::RedundantJoint { joint, pivot } => ("setup.redundant", vec![count(*joint), *pivot], vec![]),
        SetupError::InvalidStep { step } => ("setup.step", vec![*step], vec![]),
        SetupError::SingularKinetic { determinant, body } => {
            ("setup.singular", and_body(&[*determinant], *body), vec![])
        }
        SetupError::NegativeKinetic { pivot, body } => ("setup.negative", and_body(&[*pivot], *body), vec![]),
        SetupError::NonFiniteConstant => ("setup.constant", vec![], vec![]),
        SetupError::NonFinite { what } => ("setup.finite", vec![], vec![what]),
        SetupError::NotInGroup { defect } => ("setup.group", vec![*defect], vec![]),
        SetupError::NotSeparable { defect } => ("setup.separable", vec![*defect], vec![]),
        SetupError::InertiaMismatch { difference } => ("setup.inertia", vec![*difference], vec![]),
        SetupError::VaryingInertia => ("setup.varying", vec![], vec![]),
        SetupError::NoSecondDerivatives => ("setup.second", vec![], vec![]),
        SetupError::BiasMismatch => ("setup.bias", vec![], vec![]),
        SetupError::NoForceGradient => ("setup.gradient", vec![], vec![]),
        _ => ("", vec![], vec![]),
    }
}

fn of_inertia(error: &InertiaError) -> Parts<'_> {
    match error {
        InertiaError::NotFinite => ("inertia.finite", vec![], vec![]),
        InertiaError::NotSymmetric { defect } => ("inertia.symmetric", vec![*defect], vec![]),
        InertiaError::NotDiagonal { largest } => ("inertia.diagonal", vec![*largest], vec![]),
        InertiaError::TriangleInequality { smallest } => ("inertia.triangle", vec![*smallest], vec![]),
        InertiaError::Singular { smallest } => ("inertia.singular", vec![*smallest], vec![]),
        InertiaError::OutOfRange { trace } => ("inertia.range", vec![*trace], vec![]),
        _ => ("", vec![], vec![]),
    }
}

fn of_step(error: &StepError) -> Parts<'_> {
    match error {
        StepError::NonFinite { what } => ("step.finite", vec![], vec![what]),
        StepError::BeyondSolvable { step, largest, turn, body } => {
            ("step.solvable", and_body(&[*step, *largest, *turn], *body), vec![])
        }
        StepError::AngleWithoutDigits { turn } => ("step.angle", vec![*turn], vec![]),
        StepError::NotConverged { iterations, residual } => {
            ("step.converged", vec![f64::from(*iterations), *residual], vec![])
        }
        StepError::WrongBranch { determinant } => ("step.branch", vec![*determinant], vec![]),
        StepError::Singular => ("step.singular", vec![], vec![]),
        StepError::SingularJoint { joint, pivot } => ("step.joint", vec![count(*joint), *pivot], vec![]),
        StepError::UnsolvedBody { body, turn, determinant } => {
            ("step.body", vec![count(*body), *turn, *determinant], vec![])
        }
        _ => ("", vec![], vec![]),
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
        assert_eq!(Failure::of_line("step.angle"), None);
        assert_eq!(Failure::of_line("step.tomorrow 1.0"), None);
    }
}
