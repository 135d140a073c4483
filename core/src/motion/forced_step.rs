//! Steps with an input that is given anew each time.

use crate::error::StepError;
use crate::mechanics::{Effect, Group, Vector};
use crate::motion::state::State;
use crate::motion::stepper::{StepReport, Stepper};
use crate::numbers::{Coordinates as _, real};

impl<L: Effect> Stepper<L> {
    /// One step under a control force, which is held over the step; on an error the state is unchanged.
    ///
    /// It is a covector in the body's axes: on SO(3) a torque in N m. By the discrete Lagrange–d'Alembert principle
    /// half of its impulse `h f` is added to the momentum at either end of the step, as by
    /// [`Torque`](crate::effects::Torque), so the scheme stays of second order for inputs that are smooth in time and
    /// taken in the middle of each step. Without a force the momentum is that of [`step`](Self::step), bit for bit.
    ///
    /// # Errors
    ///
    /// [`StepError`] where the force isn't finite, and as [`step`](Self::step); the largest step that an error names is
    /// that for the momentum with half of the impulse.
    ///
    /// # Examples
    ///
    /// A rotation is braked by a torque against the body velocity.
    ///
    /// ```
    /// use liestep::effects::RigidBody;
    /// use liestep::{LieGroup as _, NonstandardInertia, SO3, Stepper};
    /// use nalgebra::Vector3;
    ///
    /// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5))?;
    /// let stepper = Stepper::new(RigidBody { J_d }, 0.01)?;
    /// let mut state = stepper.start(SO3::identity(), Vector3::new(0.5, -1.0, 2.0))?;
    /// for _ in 0..1000 {
    ///     let torque = stepper.velocity(&state) * -2.0;
    ///     stepper.step_with(&mut state, &torque)?;
    /// }
    /// assert!(stepper.velocity(&state).norm() < 0.1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Source
    ///
    /// \[MW01\], section 3.2.
    pub fn step_with(
        &self,
        state: &mut State<Group<L>, L::Advected>,
        force: &Vector<L>,
    ) -> Result<StepReport, StepError> {
        if !force.is_finite() {
            return Err(StepError::NonFinite { what: "control force" });
        }
        let half = *force * (self.step_size() * real(0.5));
        let mut next = *state;
        next.momentum = next.momentum + half;
        let report = self.step(&mut next)?;
        next.momentum = next.momentum + half;
        if !next.momentum.is_finite() {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        *state = next;
        Ok(report)
    }
}
