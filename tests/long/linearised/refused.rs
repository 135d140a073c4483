//! A scene that can't be differentiated: force gradients of a term without the derivatives of its kick.

use checks::solvers::WithoutKickGradient;
use liestep::mechanics::Inertia;
use liestep::methods::{ExactBody, ProcessedScheme, SplittingScheme};
use liestep::{SetupError, Stepper};
use nalgebra::Vector3;

use super::scenes::top;

/// The error is typed, and without force gradients the scene is differentiable.
#[test]
fn force_gradients_without_the_gradient_of_a_kick() {
    let flow = ExactBody::new(&Inertia::from_principal_moments(Vector3::new(2.5, 3.0, 3.5)).expect("a body"));
    let scene = WithoutKickGradient(top::<f64>(None));
    let refused = |scheme| {
        let stepper = Stepper::split(scene.clone(), 0.1, flow, scheme).expect("a stepper");
        stepper.linearised().err()
    };
    assert_eq!(refused(SplittingScheme::FORCE_GRADIENT_4), Some(SetupError::NoSecondDerivatives));
    assert_eq!(refused(SplittingScheme::NYSTROM_6), None);
    let processed = Stepper::processed(scene.clone(), 0.1, flow, ProcessedScheme::SIX_A).expect("a stepper");
    assert_eq!(processed.linearised().err(), Some(SetupError::NoSecondDerivatives));
}
