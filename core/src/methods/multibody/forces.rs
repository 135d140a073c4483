//! The forces of joints in a step.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::constraint::Place;
use super::parts;
use super::stepper::MultibodyStepper;
use super::workspace::{Workspace, with_workspace};
use crate::error::StepError;

/// The forces of all joints in a step.
pub(super) struct JointForces {
    /// The multipliers of their functions.
    multipliers: Vec<Vector6<f64>>,
    /// The force of each on its body below, N, and the torque about its point, N m, in space.
    loads: Vec<[Vector3<f64>; 2]>,
}

impl JointForces {
    pub(super) fn zeros(joints: usize) -> Self {
        Self { multipliers: vec![Vector6::zeros(); joints], loads: vec![[Vector3::zeros(); 2]; joints] }
    }

    /// The number of joints.
    pub(super) fn joints(&self) -> usize {
        self.multipliers.len()
    }

    /// Adds a share of the forces of a part, and sets these to zero.
    pub(super) fn take_up(&mut self, part: &mut Self, share: f64) {
        for (sum, part) in self.multipliers.iter_mut().zip(&mut part.multipliers) {
            *sum += core::mem::replace(part, Vector6::zeros()) * share;
        }
        for (sum, part) in self.loads.iter_mut().flatten().zip(part.loads.iter_mut().flatten()) {
            *sum += core::mem::replace(part, Vector3::zeros()) * share;
        }
    }
}

impl MultibodyStepper {
    /// Adds the multipliers of a step's equations, times a factor, and the forces that they are at the beginning of the step or
    /// at its end.
    pub(super) fn add_forces(&self, work: &Workspace, is_end: bool, factor: f64, forces: &mut JointForces) {
        let places = if is_end { &work.next_places } else { &work.places };
        let mut multipliers = vec![Vector6::zeros(); forces.joints()];
        work.equations.add_multipliers(&self.tree, factor, &mut multipliers);
        let axes = Matrix3::identity();
        for (joint, joined) in self.joints().iter().enumerate() {
            let (mut unused, mut slopes) = (Matrix6::zeros(), Matrix6::zeros());
            let (above, below) = (joined.above.map_or(&Place::SPACE, |above| &places[above]), &places[joined.below]);
            joined.functions.slopes([above, below], [None, Some(&axes)], [&mut unused, &mut slopes]);
            let sum = (0..joined.functions.rows())
                .fold(Vector6::zeros(), |sum, row| sum + slopes.column(row) * multipliers[joint][row]);
            let (torque, force) = parts(&sum);
            let arm = below.attitude * joined.functions.point();
            forces.multipliers[joint] += multipliers[joint];
            forces.loads[joint][0] += force;
            forces.loads[joint][1] += torque - arm.cross(&force);
        }
    }

    /// The forces of the joints in the step from this state.
    fn forces(&self, state: &[f64]) -> Result<JointForces, StepError> {
        self.check(state)?;
        let mut forces = JointForces::zeros(self.joints().len());
        if self.h == 0.0 {
            return Ok(forces);
        }
        let mut state = state.to_vec();
        self.offsets.start_from_momenta(&mut state, 0);
        with_workspace(|work| self.step_in(&mut state, work, Some(&mut forces)))?;
        Ok(forces)
    }

    /// The forces of the joints in the step from this state: the multipliers of their functions, N for lengths and N m for
    /// cosines, the mean over the step. Each acts on the body below along the gradient of its function, and is followed
    /// by zeros up to six.
    ///
    /// # Errors
    ///
    /// The errors of [`step`](Self::step).
    ///
    /// # Examples
    ///
    /// A body of one kilogram hangs on a pivot.
    ///
    /// ```
    /// use liestep::groups::{LieGroup as _, R3};
    /// use liestep::methods::{Joint, Multibody};
    /// use liestep::{NonstandardInertia, SO3, lagrangian};
    /// use nalgebra::{Vector3, Vector6};
    ///
    /// #[lagrangian(
    ///     group(F = SO3, d = R3),
    ///     advected(x = d.seen_from(space)),
    ///     l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
    ///         - 0.5 * h * m * g * (x + x + d)[2],
    /// )]
    /// struct Heavy {
    ///     J_d: NonstandardInertia,
    ///     m: f64,
    ///     g: f64,
    /// }
    ///
    /// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(0.1, 0.2, 0.25))?;
    /// let mut system = Multibody::new();
    /// let body = system.body(Heavy { J_d, m: 1.0, g: 9.81 });
    /// system.join(Joint::ball([Vector3::zeros(), Vector3::z() * 0.4]), None, body);
    /// let stepper = system.stepper(0.01)?;
    /// let state = stepper.start(&[(SO3::identity(), R3::from(Vector3::z() * -0.4))], &[Vector6::zeros()])?;
    /// let forces = stepper.reactions(&state)?;
    /// assert!((forces[0] - Vector6::z() * 9.81).norm() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn reactions(&self, state: &[f64]) -> Result<Vec<Vector6<f64>>, StepError> {
        self.forces(state).map(|forces| forces.multipliers)
    }

    /// The forces of the joints on their bodies below in the step from this state, N, and their torques about the joints'
    /// [points](super::Constraint::point) of these bodies, N m, both in the axes of space. They are the means over the step of
    /// second order: the sums of its multipliers along the gradients at its beginning and at its end, each by the place of the
    /// bodies there.
    ///
    /// # Errors
    ///
    /// The errors of [`step`](Self::step).
    pub fn joint_forces(&self, state: &[f64]) -> Result<Vec<[Vector3<f64>; 2]>, StepError> {
        self.forces(state).map(|forces| forces.loads)
    }
}
