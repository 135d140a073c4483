//! Every error names its cause, what was measured, the limit where there is one, and what to do.
//!
//! A variant that isn't listed here doesn't compile: the matches are without a wildcard.

#[cfg(feature = "serde")]
use alloc::borrow::ToOwned as _;
use alloc::string::ToString as _;
use std::println;

use super::{SetupError, StepError};
use crate::groups::{NotARotation, NotInGroup};
use crate::mechanics::InertiaError;

/// What a user can do begins with one of these.
const ADVICE: [&str; 12] =
    ["build", "check", "choose", "compose", "give", "normalise", "pass", "project", "resume", "take", "try", "write"];

/// The message has each of the parts, and a last clause that says what to do.
fn assert_says(message: &str, parts: &[&str]) {
    println!("{message}");
    for part in parts {
        assert!(message.contains(part), "no {part:?} in {message:?}");
    }
    let (_, advice) = message.rsplit_once("; ").unwrap_or_else(|| panic!("no advice in {message:?}"));
    assert!(ADVICE.iter().any(|verb| advice.starts_with(verb)), "{message:?} doesn't say what to do");
}

#[test]
fn setup_errors() {
    let errors = [
        SetupError::Parameter { field: "rho", cause: "is not finite" },
        SetupError::BodyParameter { body: 7, field: "m", cause: "isn't a mass" },
        SetupError::Joint { joint: 7, cause: "closes a loop" },
        SetupError::JointParameter { joint: 7, field: "above", cause: "is not finite" },
        SetupError::OffConstraint { joint: 7, by: 0.5 },
        SetupError::OffVelocity { joint: 7, by: 0.5 },
        SetupError::RedundantJoint { joint: 7, pivot: 0.0 },
        SetupError::InvalidStep { step: 1e-300 },
        SetupError::SingularKinetic { determinant: 1e-30, body: None },
        SetupError::SingularKinetic { determinant: 1e-30, body: Some(7) },
        SetupError::NegativeKinetic { pivot: -0.5, body: None },
        SetupError::NegativeKinetic { pivot: -0.5, body: Some(7) },
        SetupError::NonFiniteConstant,
        SetupError::NonFinite { what: "velocity" },
        SetupError::NoVelocity,
        SetupError::AmbiguousVelocity { difference: f64::NAN },
        SetupError::AmbiguousVelocity { difference: 0.5 },
        SetupError::NotInGroup { defect: 0.125 },
        SetupError::NotUnit { what: "direction", length: 0.5 },
        SetupError::NotAxisymmetric { difference: 0.5 },
        SetupError::Spin { spin: 0.5 },
        SetupError::NotSeparable { defect: 0.25 },
        SetupError::InertiaMismatch { difference: 0.5 },
        SetupError::VaryingInertia,
        SetupError::NotSelfAdjoint,
        SetupError::BiasMismatch,
        SetupError::NoForceGradient,
        SetupError::NoSecondDerivatives,
        SetupError::Unlike { lane: 3 },
    ];
    for error in errors {
        let parts: &[&str] = match error {
            SetupError::Parameter { .. } => &["`rho`", "is not finite"],
            SetupError::BodyParameter { .. } => &["`m`", "the body 7", "isn't a mass"],
            SetupError::Joint { .. } => &["the joint 7", "closes a loop"],
            SetupError::JointParameter { .. } => &["`above`", "the joint 7", "is not finite"],
            SetupError::OffConstraint { .. } => {
                &["the joint 7", "open by 5e-1 (in the units of its functions: m,", "`start_nearest`"]
            }
            SetupError::OffVelocity { .. } => &["the joint 7", "by 5e-1 (", "m/s", "`start_nearest`"],
            SetupError::RedundantJoint { .. } => &["the joint 7", "0e0"],
            SetupError::InvalidStep { .. } => &["the step", "1e-300 s"],
            SetupError::SingularKinetic { body: None, .. } => &["the kinetic part is singular", "1e-30"],
            SetupError::SingularKinetic { .. } => {
                &["the kinetic part of the body or factor 7 (from zero) is singular", "1e-30"]
            }
            SetupError::NegativeKinetic { body: None, .. } => {
                &["the kinetic part is negative", "-5e-1", "`.transpose()`"]
            }
            SetupError::NegativeKinetic { .. } => &["part of the body or factor 7 (from zero) is negative", "-5e-1"],
            SetupError::NonFiniteConstant => &["constant", "not finite", "divisor"],
            SetupError::NonFinite { .. } => &["velocity", "not finite"],
            SetupError::NoVelocity => &["no velocity", "initial momentum"],
            SetupError::AmbiguousVelocity { difference } if difference.is_nan() => &["initial velocity", "no momentum"],
            SetupError::AmbiguousVelocity { .. } => &["initial velocity", "another velocity", "5e-1"],
            SetupError::NotInGroup { .. } => &["attitude", "group", "1.25e-1", "more than rounding"],
            SetupError::NotUnit { .. } => &["the direction", "5e-1", "of length one"],
            SetupError::NotAxisymmetric { .. } => &["isn't symmetric about the axis", "5e-1 kg m²"],
            SetupError::Spin { .. } => &["5e-1 rad/s", "about the direction"],
            SetupError::NotSeparable { .. } => &["K(F) − (h/2) (V(w) + V(F⁻¹·w))", "2.5e-1", "more than rounding"],
            SetupError::InertiaMismatch { .. } => &["another body", "5e-1"],
            SetupError::NotSelfAdjoint => &["−h", "undo", "mean"],
            SetupError::VaryingInertia => &["inertia", "advected or given", "same everywhere"],
            SetupError::BiasMismatch => &["momentum at rest", "rotors"],
            SetupError::NoForceGradient => &["`kick_derivative`", "force gradient"],
            SetupError::NoSecondDerivatives => &["`kick_gradient`", "force gradient"],
            SetupError::Unlike { .. } => &["lane 3", "another method"],
        };
        assert_says(&error.to_string(), parts);
    }
}

#[test]
fn step_errors() {
    let errors = [
        StepError::NonFinite { what: "momentum" },
        StepError::NonFinite { what: "momentum equation" },
        StepError::BeyondSolvable { step: 0.125, largest: 0.0815, turn: 2.5, body: None },
        StepError::BeyondSolvable { step: 0.125, largest: 0.0815, turn: 2.5, body: Some(7) },
        StepError::BeyondSolvable { step: 0.125, largest: f64::NAN, turn: 2.5, body: Some(7) },
        StepError::BeyondSolvable { step: 0.125, largest: 0.0815, turn: 0.0, body: None },
        StepError::AngleWithoutDigits { turn: 5e15 },
        StepError::NotConverged { iterations: 60, residual: 0.5 },
        StepError::NotConverged { iterations: 1, residual: f64::INFINITY },
        StepError::WrongBranch { determinant: -0.25 },
        StepError::NoLength { length: -0.5 },
        StepError::Past { time: 0.25, now: 0.5 },
        StepError::Singular,
        StepError::SingularJoint { joint: 7, pivot: 1e-12 },
        StepError::UnsolvedBody { body: 7, turn: 2.5, determinant: -0.25 },
    ];
    for error in errors {
        let parts: &[&str] = match error {
            StepError::NonFinite { what: "momentum equation" } => &["a force or a potential has no value here"],
            StepError::NonFinite { .. } => &["momentum", "not finite", "choose units"],
            StepError::BeyondSolvable { largest, .. } if largest.is_nan() => &[
                "1.25e-1 s",
                "the body 7 (from zero) would",
                "2.50e0 rad, which is too far; take smaller",
                "or_substeps",
            ],
            StepError::BeyondSolvable { turn: 0.0, .. } => {
                assert!(!error.to_string().contains("rad"), "{error}");
                &["at the step 1.25e-1 s; take steps of at most 8.15e-2 s"]
            }
            StepError::BeyondSolvable { body: Some(_), .. } => &["the body 7 (from zero) would", "2.50e0 rad"],
            StepError::BeyondSolvable { .. } => &[
                "no solution",
                "1.25e-1 s",
                "2.50e0 rad",
                "1.63e0 rad",
                "at most 8.15e-2 s",
                "or_substeps",
                "CayleyBody",
            ],
            StepError::AngleWithoutDigits { .. } => &["5.00e15 rad", "no digit"],
            StepError::NotConverged { iterations: 1, .. } => &["runs out of all bounds", "smaller step"],
            StepError::NotConverged { .. } => &["the iteration", "60 iterations", "5e-1"],
            StepError::WrongBranch { .. } => &["continue the identity", "-2.5e-1", "sign"],
            StepError::NoLength { .. } => &["no length (-5e-1 s)", "clock", "density"],
            StepError::Past { .. } => &["0.25 s", "0.5 s", "before"],
            StepError::Singular => &["Jacobian", "singular"],
            StepError::SingularJoint { .. } => &["the joint 7", "singular", "1e-12"],
            StepError::UnsolvedBody { .. } => &["the body 7", "2.50e0 rad", "-2.5e-1", "smaller steps"],
        };
        assert_says(&error.to_string(), parts);
    }
}

#[test]
fn inertia_errors() {
    let errors = [
        InertiaError::NotFinite,
        InertiaError::NotPositive { what: "m", value: -0.25 },
        InertiaError::NotSymmetric { defect: 0.125 },
        InertiaError::NotDiagonal { largest: 0.125 },
        InertiaError::TriangleInequality { smallest: -0.25 },
        InertiaError::Singular { smallest: 1e-30 },
        InertiaError::OutOfRange { trace: 1e200 },
    ];
    for error in errors {
        let parts: &[&str] = match error {
            InertiaError::NotFinite => &["inertia", "not finite"],
            InertiaError::NotPositive { .. } => &["the m", "-2.5e-1", "not above zero"],
            InertiaError::NotSymmetric { .. } => &["not symmetric", "1.25e-1", "more than rounding"],
            InertiaError::NotDiagonal { .. } => &["not diagonal", "1.25e-1", "principal axes"],
            InertiaError::TriangleInequality { .. } => &["no body", "-2.5e-1", "exceeds the sum of the others"],
            InertiaError::Singular { .. } => &["singular", "1e-30"],
            InertiaError::OutOfRange { .. } => &["trace", "1e200", "out of range"],
        };
        assert_says(&error.to_string(), parts);
    }
}

#[test]
fn matrices_that_are_not_in_a_group() {
    let error = NotARotation { defect: 0.125, determinant: -1.0 };
    assert_says(&error.to_string(), &["not a rotation", "1.25e-1", "det R = -1"]);
    assert_says(&NotInGroup { defect: 0.25 }.to_string(), &["not in the group", "2.5e-1"]);
}

#[cfg(feature = "serde")]
#[test]
fn checkpoint_errors() {
    use crate::with::CheckpointError;
    let errors = [
        CheckpointError::AnotherFormat { found: 7, known: 1 },
        CheckpointError::AnotherScene,
        CheckpointError::AnotherParameter { field: "rho", stored: 0.5, own: 0.25 },
        CheckpointError::AnotherStep { stored: 0.5, own: 0.25 },
        CheckpointError::AnotherMethod { stored: "Gauss".to_owned(), own: "its own step".to_owned() },
        CheckpointError::NotKept,
        CheckpointError::WrongSize { what: "momentum", found: 2, expected: 3 },
        CheckpointError::NonFinite { what: "guess" },
        CheckpointError::NotInGroup { defect: 0.125 },
        CheckpointError::NotAdvected { distance: 0.125 },
        CheckpointError::Altered,
    ];
    for error in errors {
        let parts: &[&str] = match error {
            CheckpointError::AnotherFormat { .. } => &["format 7", "reads 1"],
            CheckpointError::AnotherScene => &["another scene"],
            CheckpointError::AnotherParameter { .. } => &["`rho`", "5e-1 in the checkpoint", "2.5e-1 here"],
            CheckpointError::AnotherStep { .. } => &["step", "5e-1 s in the checkpoint", "2.5e-1 s here"],
            CheckpointError::AnotherMethod { .. } => &["\"Gauss\"", "\"its own step\"", "adopt"],
            CheckpointError::NotKept => &["keeps", "damaged"],
            CheckpointError::WrongSize { .. } => &["momentum", "2 numbers instead of 3", "damaged"],
            CheckpointError::NonFinite { .. } => &["guess", "not finite", "damaged"],
            CheckpointError::NotInGroup { .. } => &["attitude", "group", "1.25e-1", "damaged"],
            CheckpointError::NotAdvected { .. } => &["advected", "1.25e-1", "damaged"],
            CheckpointError::Altered => &["digest", "damaged", "float_roundtrip"],
        };
        assert_says(&error.to_string(), parts);
    }
}
