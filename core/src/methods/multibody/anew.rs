//! Steppers of the same bodies and joints, with other numbers of their terms or with another step.

use super::stepper::MultibodyStepper;
use super::system::Multibody;
use crate::error::SetupError;

impl MultibodyStepper {
    /// The stepper of this system by steps of another length.
    ///
    /// # Errors
    ///
    /// [`SetupError::InvalidStep`] for an impossible one.
    pub fn with_step(&self, h: f64) -> Result<Self, SetupError> {
        self.like(self.system.refolded(1.0), h)
    }

    /// The stepper of a system whose terms have other numbers, or are others, by steps of `h`, s: for torques over time and springs
    /// that age. Its joints are those of this stepper, with the functions that were left out, and a state of the one is a state
    /// of the other. Nothing is joined anew, so that a step by numbers of its own takes little more than another.
    ///
    /// # Errors
    ///
    /// The errors of [`Multibody::stepper`], and [`SetupError::Length`] for another number of bodies.
    ///
    /// # Examples
    ///
    /// A motor between two bodies is on from .7 s to 2.2 s. A step of .4 s has the mean of its torque, so that the impulse
    /// is `3 N m s`.
    ///
    /// ```
    /// use liestep::effects::joints::JointTorque;
    /// use liestep::groups::R3;
    /// use liestep::methods::{Joint, Multibody};
    /// use liestep::{NonstandardInertia, SO3, lagrangian};
    /// use nalgebra::{Vector3, Vector6};
    ///
    /// #[lagrangian(
    ///     group(F = SO3, d = R3),
    ///     l_d = (((F - I) * J_d * (F - I).transpose()).trace() + m * d.norm_squared()) / (2.0 * h),
    /// )]
    /// struct Body {
    ///     J_d: NonstandardInertia,
    ///     m: f64,
    /// }
    ///
    /// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
    /// let system = |torque: f64| {
    ///     let mut system = Multibody::new();
    ///     let both = [(); 2].map(|()| system.body(Body { J_d, m: 2.0 }));
    ///     system.join(Joint::pin([Vector3::zeros(); 2], [Vector3::z(); 2]), Some(both[0]), both[1]);
    ///     system.between(both.map(Some), JointTorque { torque, axis_1: Vector3::z(), axis_2: Vector3::z() });
    ///     system
    /// };
    /// let (h, steps) = (0.4, 10);
    /// let mut stepper = system(0.0).stepper(h)?;
    /// let mut state = stepper.start(&[(SO3::identity(), R3::from(Vector3::zeros())); 2], &[Vector6::zeros(); 2])?;
    /// for step in 0..steps {
    ///     let [begin, end] = [step, step + 1].map(|step| (f64::from(step) * h).clamp(0.7, 2.2));
    ///     stepper = stepper.with(system(2.0 * (end - begin) / h), h)?;
    ///     stepper.step(&mut state)?;
    /// }
    /// assert!((stepper.momentum(&state, 1)[2] - 3.0).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with(&self, system: Multibody, h: f64) -> Result<Self, SetupError> {
        SetupError::check_length("bodies", system.bodies, self.bodies())?;
        let system = Multibody { joints: self.system.joints.clone(), ..system };
        system.check_terms()?;
        self.like(if self.has_point_masses { system.with_point_masses() } else { system }, h)
    }

    /// The stepper of a system with the joints of this one, by steps of this length, s.
    fn like(&self, system: Multibody, h: f64) -> Result<Self, SetupError> {
        let single = Self::of(system, h, Some(self))?;
        match &self.stages {
            Some(stages) => single.composed(stages.scheme),
            None => Ok(single),
        }
    }
}
