//! Construction of steppers.

use super::Stepper;
use crate::error::SetupError;
use crate::mechanics::{Effect, Regular, Scalar};
use crate::motion::own_step::OwnStep;
use crate::motion::plan::Plan;

/// # Make
///
/// A stepper from a scene and a step; other methods follow below.
impl<S: Effect> Stepper<S> {
    /// Checks the parameters and folds the constants for the step `h`, in seconds.
    ///
    /// A negative `h` is the inverse map of `−h` if `l_d` is self-adjoint; `h = 0` is the identity.
    ///
    /// # Errors
    ///
    /// [`SetupError`] for an invalid parameter or step, and for a degenerate kinetic part. It doesn't name the lane;
    /// construct single steppers and [gather](crate::numbers::Lanes::gathered) them for that.
    pub fn new(scene: S, h: Scalar<S>) -> Result<Self, SetupError>
    where
        S: Regular,
    {
        let plan = OwnStep::new(&scene, h)?;
        Ok(Self { scene, plan })
    }
}

impl<S: Effect, P: Plan<S>> Stepper<S, P> {
    /// A stepper of a user's scene and plan, folded for each other; `examples/how-to-add-a-method.rs` has one.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] for an invalid parameter of the scene.
    pub fn with_plan(scene: S, plan: P) -> Result<Self, SetupError> {
        scene.validate()?;
        Ok(Self { scene, plan })
    }
}
