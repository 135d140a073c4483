//! Steppers and flows derived from a stepper.

use super::Stepper;
use crate::error::SetupError;
use crate::mechanics::{DiscreteLagrangian, Effect};
use crate::motion::flows::DiscreteLiePoisson;
use crate::motion::plan::Plan;

/// # Wrap
///
/// The inverse stepper, and the flow on momenta alone; wrappers of steps follow below.
impl<S: Effect, P: Plan<S>> Stepper<S, P> {
    /// The stepper of `−h`, which undoes the steps of this one exactly.
    ///
    /// The Lagrangian `l_d` must be [self-adjoint](crate::mechanics::Facts::is_self_adjoint); any other is refused at compile
    /// time:
    ///
    /// ```compile_fail,E0080
    /// use liestep::effects::RigidBody;
    /// use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
    /// use nalgebra::Vector3;
    ///
    /// #[lagrangian(group = SO3, advected(w = up), l_d = -h * weight * w.dot(&rho))]
    /// #[derive(Clone)]
    /// struct OneSided {
    ///     weight: f64,
    ///     rho: Vector3<f64>,
    ///     up: Vector3<f64>,
    /// }
    ///
    /// let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap() };
    /// let weight = OneSided { weight: 9.81, rho: Vector3::z(), up: Vector3::z() };
    /// let _ = Stepper::new(body + weight, 0.01).unwrap().inverse();
    /// ```
    ///
    /// # Errors
    ///
    /// [`SetupError`] if the scene has no step of `−h`.
    pub fn inverse(&self) -> Result<Self, SetupError>
    where
        S: DiscreteLagrangian + Clone,
    {
        const {
            assert!(
                S::FACTS.is_self_adjoint,
                "a step of -h undoes one of h only where l_d(F, w, h) = -l_d(F^-1, F^-1 w, -h)"
            );
            assert!(
                !P::FACTS.counts_time,
                "counted steps go on counting: reverse the clock, and the function of the values"
            );
        }
        let plan = self.plan.refolded(&self.scene, -self.step_size())?;
        Ok(Self { scene: self.scene.clone(), plan })
    }
}

impl<S: Effect> Stepper<S> {
    /// The flow on momenta, (2.8), of the same scene and step.
    #[must_use]
    pub fn flow(&self) -> DiscreteLiePoisson<S>
    where
        S: Clone,
    {
        DiscreteLiePoisson::of(self.scene.clone(), self.plan.clone())
    }
}
