//! Functions of joints that the other joints imply: they are left out, and watched.

use alloc::sync::Arc;
use alloc::vec::Vec;

use super::equations::gap_of_all;
use super::functions::Part;
use super::graph::Joint;
use super::stepper::MultibodyStepper;
use super::system::Multibody;
use super::{Body, place};
use crate::error::{SetupError, StepError};

/// The largest gap of a function that is left out, relative to the distances between bodies and to one. Rounding makes some
/// `1e-14` of it; a function that isn't implied any more opens by more within a few steps.
const IMPLIED: f64 = 1e-9;

/// A joint some of whose functions are implied by the joints before it, and how many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Redundancy {
    /// The number of the joint, from zero.
    pub joint: usize,
    /// The number of functions that are left out.
    pub functions: usize,
}

impl Multibody {
    /// The system without those functions of its joints that the other joints imply in this configuration, and what was left
    /// out: the fourth pin of a planar linkage has three such functions, the second hinge of a door five. Impulses of the joints
    /// are unique then; the motion is the same whatever is left out.
    ///
    /// The functions are found by a pivoted elimination of the loops' matrix at rest. The configuration has closed joints, or
    /// nearly so. A step that opens a function which was left out is [`StepError::SingularJoint`]: it was implied in the first
    /// configuration alone.
    ///
    /// # Errors
    ///
    /// The errors of [`stepper`](Self::stepper), and [`SetupError::Length`] unless there is a configuration of each body.
    ///
    /// # Examples
    ///
    /// A door on two hinges.
    ///
    /// ```
    /// use liestep::SO3;
    /// use liestep::effects::RigidBody;
    /// use liestep::groups::R3;
    /// use liestep::methods::{Joint, Multibody};
    /// use liestep::{NonstandardInertia, lagrangian};
    /// use nalgebra::{Vector3, Vector6};
    ///
    /// #[lagrangian(
    ///     group(F = SO3, d = R3),
    ///     l_d = (((F - I) * J_d * (F - I).transpose()).trace() + m * d.norm_squared()) / (2.0 * h),
    /// )]
    /// struct Door {
    ///     J_d: NonstandardInertia,
    ///     m: f64,
    /// }
    ///
    /// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(8.0, 10.0, 2.0))?;
    /// let mut system = Multibody::new();
    /// let door = system.body(Door { J_d, m: 24.0 });
    /// for height in [0.3, 1.7] {
    ///     let hinge = [Vector3::z() * height, Vector3::new(-0.5, 0.0, height - 1.0)];
    ///     system.join(Joint::pin(hinge, [Vector3::z(); 2]), None, door);
    /// }
    /// let start = [(SO3::identity(), R3::from(Vector3::new(0.5, 0.0, 1.0)))];
    /// let (system, left_out) = system.independent(&start)?;
    /// assert_eq!((left_out[0].joint, left_out[0].functions), (1, 5));
    /// let stepper = system.stepper(0.01)?;
    /// let mut state = stepper.start(&start, &[Vector6::new(0.0, 0.0, 1.0, 0.0, 0.5, 0.0)])?;
    /// stepper.run(&mut state, 100)?;
    /// assert!(stepper.widest_gap(&state) < 1e-13);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn independent(mut self, attitudes: &[Body]) -> Result<(Self, Vec<Redundancy>), SetupError> {
        let mut all = Vec::new();
        while let Some((joint, rows)) = self.clone().stepper(1.0)?.independent(attitudes)? {
            let joined = &mut self.joints[joint];
            all.push(Redundancy { joint, functions: joined.functions.rows() - rows.len() });
            let all = Arc::clone(&joined.functions);
            *joined = Joint::new(Arc::new(Part { all, rows }), joined.above, joined.below);
        }
        Ok((self, all))
    }
}

impl MultibodyStepper {
    /// The first joint with functions that others imply, and the numbers of its independent functions.
    fn independent(&self, attitudes: &[Body]) -> Result<Option<(usize, Vec<usize>)>, SetupError> {
        self.check_attitudes(attitudes)?;
        if self.tree.loops.is_empty() {
            return Ok(None);
        }
        let places: Vec<_> = attitudes.iter().map(place).collect();
        Ok(self.of_velocities(attitudes, &places).independent(&self.tree))
    }

    /// Checks that functions which are left out are satisfied at these places, to rounding.
    pub(super) fn check_left_out(&self, places: &[super::Place]) -> Result<(), StepError> {
        for &joint in &self.reduced {
            let Some(gap) = gap_of_all(&self.joints()[joint], places) else { continue };
            let extent = places.iter().map(|place| place.position.norm_squared()).fold(1.0, f64::max);
            let pivot = gap.norm();
            // A NaN is open.
            let is_closed = pivot * pivot <= IMPLIED * IMPLIED * extent;
            if !is_closed {
                return Err(StepError::SingularJoint { joint, pivot });
            }
        }
        Ok(())
    }
}
