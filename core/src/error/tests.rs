//! Messages of errors: each names its cause, the measured value, the limit if there is one, and a way out.

#[cfg(feature = "serde")]
use alloc::borrow::ToOwned as _;
use alloc::string::ToString as _;
use std::println;

use super::{SetupError, StepError};
use crate::groups::{NotARotation, NotInGroup};
use crate::mechanics::InertiaError;
#[cfg(feature = "serde")]
use crate::with::CheckpointError;

/// The verbs with which the advice of a message may begin.
const ADVICE: [&str; 12] =
    ["build", "check", "choose", "compose", "give", "normalise", "pass", "project", "resume", "take", "try", "write"];

/// Asserts that the message contains each of the parts, and ends in a clause with advice.
fn assert_says(message: &str, parts: &[&str]) {
    println!("{message}");
    for part in parts {
        assert!(message.contains(part), "no {part:?} in {message:?}");
    }
    let (_, advice) = message.rsplit_once("; ").unwrap_or_else(|| panic!("no advice in {message:?}"));
    assert!(ADVICE.iter().any(|verb| advice.starts_with(verb)), "{message:?} doesn't say what to do");
}

/// Tests the messages of the variants of an error. The match doesn't compile if a variant isn't listed.
macro_rules! errors_say {
    ($test:ident: $Error:ident {
        $($Variant:ident $({ $($field:ident: $value:expr),+ })? => [$($part:literal),+];)+
    }) => {
        #[test]
        fn $test() {
            #[allow(unreachable_patterns)] // a variant may be listed several times
            let _ = |error: &$Error| match error {
                $($Error::$Variant { .. } => (),)+
            };
            $(assert_says(&$Error::$Variant $({ $($field: $value),+ })?.to_string(), &[$($part),+]);)+
        }
    };
}

errors_say!(setup_errors: SetupError {
    Parameter { field: "rho", cause: "is not finite" } => ["`rho`", "is not finite"];
    Method { cause: "needs SO3; take the step" } => ["the method", "needs SO3"];
    Length { what: "velocity", found: 2, expected: 3 } => ["the velocity has 2 numbers", "not 3"];
    BodyParameter { body: 7, field: "m", cause: "isn't a mass" } => ["`m`", "the body 7", "isn't a mass"];
    Place { cause: "a term is at a body that there isn't" } => ["a term", "that there isn't"];
    Joint { joint: 7, cause: "closes a loop" } => ["the joint 7", "closes a loop"];
    JointParameter { joint: 7, field: "above", cause: "is not finite" } => ["`above`", "the joint 7", "is not finite"];
    OffConstraint { joint: 7, by: 0.5 }
        => ["the joint 7", "open by 5e-1 (in the units of its functions: m,", "`start_nearest`"];
    OffVelocity { joint: 7, by: 0.5 } => ["the joint 7", "by 5e-1 (", "m/s", "`start_nearest`"];
    RedundantJoint { joint: 7, pivot: 0.0 } => ["the joint 7", "0e0"];
    ViolatedConstraint { constraint: 1, by: 0.5 } => ["the constraint 1", "5e-1", "one that satisfies it"];
    RedundantConstraint { constraint: 1 } => ["the constraint 1", "those before it", "give independent ones"];
    NoMotion { constraints: 3, dimension: 3 } => ["3 constraints", "of dimension 3", "give fewer"];
    InvalidStep { step: 1e-300 } => ["the step", "1e-300 s"];
    SingularKinetic { determinant: 1e-30, body: None } => ["the kinetic part is singular", "1e-30"];
    SingularKinetic { determinant: 1e-30, body: Some(7) }
        => ["the kinetic part of the body or factor 7 (from zero) is singular", "1e-30"];
    NegativeKinetic { pivot: -0.5, body: None } => ["the kinetic part is negative", "-5e-1", "`.transpose()`"];
    NegativeKinetic { pivot: -0.5, body: Some(7) } => ["part of the body or factor 7 (from zero) is negative", "-5e-1"];
    NonFiniteConstant => ["constant", "not finite", "divisor"];
    NonFinite { what: "velocity" } => ["velocity", "not finite"];
    NoVelocity => ["no velocity", "initial momentum"];
    AmbiguousVelocity { difference: f64::NAN } => ["initial velocity", "no momentum"];
    AmbiguousVelocity { difference: 0.5 } => ["initial velocity", "another velocity", "5e-1"];
    NotInGroup { defect: 0.125 } => ["attitude", "group", "1.25e-1", "more than rounding"];
    NotUnit { what: "direction", length: 0.5 } => ["the direction", "5e-1", "of length one"];
    NotAxisymmetric { difference: 0.5 } => ["isn't symmetric about the axis", "5e-1 kg m²"];
    Spin { spin: 0.5 } => ["5e-1 rad/s", "about the direction"];
    NotSeparable { defect: 0.25 } => ["K(F) − (h/2) (V(w) + V(F⁻¹·w))", "2.5e-1", "more than rounding"];
    InertiaMismatch { difference: 0.5 } => ["another body", "5e-1"];
    NotSelfAdjoint => ["−h", "undo", "mean"];
    VaryingInertia => ["inertia", "advected or given", "same everywhere"];
    BiasMismatch => ["momentum at rest", "rotors"];
    NoForceGradient => ["`kick_derivative`", "force gradient"];
    NoSecondDerivatives => ["`kick_gradient`", "force gradient"];
    Unlike { lane: 3 } => ["lane 3", "another method"];
});

errors_say!(step_errors: StepError {
    NonFinite { what: "momentum" } => ["momentum", "not finite", "choose units"];
    NonFinite { what: "momentum equation" } => ["a force or a potential has no value here"];
    BeyondSolvable { step: 0.125, largest: 0.0815, turn: 2.5, body: None }
        => ["no solution", "1.25e-1 s", "2.50e0 rad", "1.63e0 rad", "at most 8.15e-2 s", "or_substeps", "GeodesicBody", "CayleyBody"];
    BeyondSolvable { step: 0.125, largest: 0.0815, turn: 2.5, body: Some(7) }
        => ["the body 7 (from zero) would", "2.50e0 rad"];
    BeyondSolvable { step: 0.125, largest: f64::NAN, turn: 2.5, body: Some(7) }
        => ["1.25e-1 s", "the body 7 (from zero) would", "2.50e0 rad, which is too far; take smaller", "or_substeps"];
    BeyondSolvable { step: 0.125, largest: 0.0, turn: f64::INFINITY, body: None }
        => ["1.25e-1 s: the body would", "inf rad, which is too far; take smaller steps, or let"];
    BeyondSolvable { step: 0.125, largest: 0.0815, turn: 0.0, body: None }
        => ["at the step 1.25e-1 s; take steps of at most 8.15e-2 s, or let"];
    AngleWithoutDigits { turn: 5e15 } => ["5.00e15 rad", "no digit"];
    NotConverged { iterations: 60, residual: 0.5 } => ["the iteration", "60 iterations", "5e-1"];
    NotConverged { iterations: 1, residual: f64::INFINITY } => ["runs out of all bounds", "smaller step"];
    WrongBranch { determinant: -0.25 } => ["continue the identity", "-2.5e-1", "sign"];
    NoLength { length: -0.5 } => ["no length (-5e-1 s)", "clock", "density"];
    Past { time: 0.25, now: 0.5 } => ["0.25 s", "0.5 s", "before"];
    Singular => ["Jacobian", "singular"];
    SingularJoint { joint: 7, pivot: 1e-12 } => ["the joint 7", "singular", "1e-12"];
    UnsolvedBody { body: 7, turn: 2.5, determinant: -0.25 } => ["the body 7", "2.50e0 rad", "-2.5e-1", "smaller steps"];
});

errors_say!(inertia_errors: InertiaError {
    NotFinite => ["inertia", "not finite"];
    NotPositive { what: "m", value: -0.25 } => ["the m", "-2.5e-1", "not above zero"];
    NotSymmetric { defect: 0.125 } => ["not symmetric", "1.25e-1", "more than rounding"];
    NotDiagonal { largest: 0.125 } => ["not diagonal", "1.25e-1", "principal axes"];
    TriangleInequality { smallest: -0.25 } => ["no body", "-2.5e-1", "exceeds the sum of the others"];
    Singular { smallest: 1e-30 } => ["singular", "1e-30"];
    OutOfRange { trace: 1e200 } => ["trace", "1e200", "out of range"];
});

#[cfg(feature = "serde")]
errors_say!(checkpoint_errors: CheckpointError {
    AnotherFormat { found: 7, known: 1 } => ["format 7", "reads 1"];
    AnotherScene => ["another scene"];
    AnotherParameter { field: "rho", stored: 0.5, own: 0.25 } => ["`rho`", "5e-1 in the checkpoint", "2.5e-1 here"];
    AnotherStep { stored: 0.5, own: 0.25 } => ["step", "5e-1 s in the checkpoint", "2.5e-1 s here"];
    AnotherMethod { stored: "Gauss".to_owned(), own: "its own step".to_owned() }
        => ["\"Gauss\"", "\"its own step\"", "adopt"];
    NotKept => ["keeps", "damaged"];
    WrongSize { what: "momentum", found: 2, expected: 3 } => ["momentum", "2 numbers instead of 3", "damaged"];
    NonFinite { what: "guess" } => ["guess", "not finite", "damaged"];
    NotInGroup { defect: 0.125 } => ["attitude", "group", "1.25e-1", "damaged"];
    NotAdvected { distance: 0.125 } => ["advected", "1.25e-1", "damaged"];
    Altered => ["digest", "damaged", "float_roundtrip"];
});

#[test]
fn matrices_that_are_not_in_a_group() {
    let error = NotARotation { defect: 0.125, determinant: -1.0 };
    assert_says(&error.to_string(), &["not a rotation", "1.25e-1", "det R = -1"]);
    assert_says(&NotInGroup { defect: 0.25 }.to_string(), &["not in the group", "2.5e-1"]);
}
