//! How a stepper is made.

use super::Stepper;
use crate::error::SetupError;
use crate::mechanics::{Effect, Regular, Scalar};
use crate::motion::declared::OwnStep;
use crate::motion::plan::Plan;

/// # Make
///
/// A scene and a step; other methods below.
impl<S: Effect> Stepper<S> {
    /// Checks the parameters and folds the constants for the step `h`, in seconds.
    ///
    /// A negative `h` is the inverse map of `−h` where `l_d` is self-adjoint; `h = 0` is the identity.
    ///
    /// # Errors
    ///
    /// [`SetupError`] for a parameter or a step that can't be used, and for a degenerate kinetic part. Of several lanes
    /// it doesn't tell which: steppers that are made one by one and [gathered](crate::numbers::Lanes::gathered) do.
    pub fn new(scene: S, h: Scalar<S>) -> Result<Self, SetupError>
    where
        S: Regular,
    {
        let plan = OwnStep::new(&scene, h)?;
        Ok(Self { scene, plan })
    }
}

impl<S: Effect, P: Plan<S>> Stepper<S, P> {
    /// A user's scene and plan, folded for each other; `examples/how-to-add-a-method.rs` has one.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] for a parameter of the scene that can't be used.
    pub fn with_plan(scene: S, plan: P) -> Result<Self, SetupError> {
        scene.validate()?;
        Ok(Self { scene, plan })
    }
}
