//! The plan of jointed bodies, and its construction.

roots!();

use super::Constraint;
use super::graph::{Joints, Tree};
use crate::error::SetupError;
use crate::groups::{CayleyRetraction, R3, SO3};
use crate::mechanics::{Effect, Regular};
use crate::motion::Stepper;

/// The group of a body: a rotation, and a translation in the axes of space.
pub(super) type Body = (SO3, R3);

/// A system of rigid bodies with joints: the plan of [`Stepper::jointed`].
///
/// # Contract
///
/// - Gaps of joints stay at rounding, some units in the last place of the distances from the origin.
/// - Velocities satisfy the constraints as well: energies and momenta of a state are those of the jointed system.
/// - A step satisfies its equations to rounding, or is an error, mostly of a body or a joint, and leaves the state as it
///   was.
/// - A step turns each body by less than a right angle, whatever its kinetic term; one that would turn a body farther is
///   [`StepError::UnsolvedBody`](crate::StepError::UnsolvedBody).
/// - Nothing is allocated.
///
/// # Source
///
/// The step (2.7) of \[RDAE\] with the multipliers of constrained variational integrators, \[MW01\], section 3: SHAKE in
/// positions, RATTLE in momenta.
#[derive(Clone, Debug)]
pub struct JointedBodies<S: Effect, C, const K: usize, const N: usize, const T: usize, const L: usize> {
    pub(super) h: f64,
    pub(super) constants: S::Constants,
    pub(super) joints: Joints<C, T, L>,
    pub(super) tree: Tree<N>,
    /// The radius of gyration of each body, m, by which rotations are compared with translations.
    pub(super) lengths: [f64; N],
}

/// # Make: bodies in joints
impl<S: Effect> Stepper<S> {
    /// Bodies with joints; the scene is that of the bodies without joints.
    ///
    /// The group of each body is `(SO3, R3)`: it is translated too, with its centre of mass or any other point as
    /// origin. One joint of each loop is [specified apart](Joints::closed_by). [`JointedBodies`] describes the method
    /// and its cost.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::new`]; [`SetupError::Joint`] and [`SetupError::JointParameter`] name an invalid joint.
    /// [`Stepper::start`] has [`SetupError::OffConstraint`] for a joint that is open, [`SetupError::OffVelocity`] for
    /// velocities that would open it, and [`SetupError::RedundantJoint`] for a joint that is redundant beside the
    /// others, even if only in this configuration; [`start_nearest`](Stepper::start_nearest) closes joints.
    ///
    /// # Examples
    ///
    /// Four rods of 1 m on ball joints, both ends on pivots: a swing.
    ///
    /// ```
    /// use core::array::from_fn;
    /// use liestep::groups::R3;
    /// use liestep::mechanics::Each;
    /// use liestep::methods::{BallJoint, PlacedJoint, Joints};
    /// use liestep::numbers::Bodies;
    /// use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
    /// use nalgebra::{Vector3, Vector6};
    ///
    /// /// A body and its weight.
    /// #[lagrangian(
    ///     group(F = SO3, d = R3),
    ///     advected(x = d.seen_from(space)),
    ///     l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
    ///         - 0.5 * h * m * g * (x + x + d).dot(&up),
    /// )]
    /// #[derive(Clone, Copy, Debug, PartialEq)]
    /// struct Rod {
    ///     J_d: NonstandardInertia, // about the centre of mass
    ///     m: f64,
    ///     g: f64,
    ///     up: Vector3<f64>,
    /// }
    ///
    /// let J_d = NonstandardInertia::from_diagonal(Vector3::new(1.0 / 12.0, 1e-3, 1e-3))?;
    /// let rods = Each::<4>::of([Rod { J_d, m: 1.0, g: 9.81, up: Vector3::z() }]);
    /// let (left, right) = (Vector3::x() * -0.5, Vector3::x() * 0.5);
    /// let pivot = |x: f64, below| BallJoint { above: Vector3::x() * x, below };
    /// let joints = Joints::tree(from_fn::<_, 4, _>(|k| match k {
    ///     0 => PlacedJoint::to_space(pivot(0.0, left), 0),
    ///     _ => PlacedJoint::between(BallJoint { above: right, below: left }, k - 1, k),
    /// }));
    /// let swing = joints.closed_by([PlacedJoint::to_space(pivot(3.0, right), 3)]);
    /// let stepper = Stepper::jointed(rods, swing, 0.01)?;
    ///
    /// // About a garland; it starts at a place next to it where the joints are closed.
    /// let about = from_fn(|k| {
    ///     let tilt = [0.8, 0.3, -0.3, -0.8][k];
    ///     let place = [[0.3, -0.4], [1.1, -0.9], [1.9, -0.9], [2.7, -0.4]][k];
    ///     (SO3::exp(Vector3::y() * tilt), R3::from(Vector3::new(place[0], 0.0, place[1])))
    /// });
    /// let mut state = stepper.start_nearest(about, Bodies([Vector6::y() * 0.3; 4]))?;
    /// let energy = stepper.energy(&state);
    /// stepper.run(&mut state, 1000)?;
    /// assert!(stepper.widest_gap(&state) < 1e-14);
    /// assert!((stepper.energy(&state) - energy).abs() < 1e-2 * energy.abs());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn jointed<C, const K: usize, const N: usize, const T: usize, const L: usize>(
        scene: S,
        joints: Joints<C, T, L>,
        h: f64,
    ) -> Result<Stepper<S, JointedBodies<S, C, K, N, T, L>>, SetupError>
    where
        S: Regular + Effect<Scalar = f64, Group = [Body; N], Retraction = CayleyRetraction>,
        C: Constraint<K>,
    {
        let plan = JointedBodies::new(&scene, joints, h)?;
        Ok(Stepper { scene, plan })
    }
}

impl<S, C, const K: usize, const N: usize, const T: usize, const L: usize> JointedBodies<S, C, K, N, T, L>
where
    S: Effect<Scalar = f64, Group = [Body; N], Retraction = CayleyRetraction>,
    C: Constraint<K>,
{
    pub(super) fn new(scene: &S, joints: Joints<C, T, L>, h: f64) -> Result<Self, SetupError> {
        const {
            assert!(
                S::DENOMINATORS == 0,
                "a term with cleared denominators has another residual than joints are added to"
            );
            assert!(
                !S::LINKS_NEIGHBOURS,
                "bodies in joints can't be coupled within the step; put the potential at its ends"
            );
            assert!(S::IS_QUADRATIC, "joints hold bodies whose continuous limit is quadratic in the velocity");
        }
        // The scene without joints must be a valid one.
        crate::motion::OwnStep::<S>::folded(scene, h)?;
        let tree = joints.planted()?;
        let lengths = scene.inertia(&scene.advected()).0.map(|inertia| {
            let trace = |first: usize| (first..first + 3).map(|k| inertia[(k, k)]).sum::<f64>();
            (trace(0) / trace(3)).sqrt()
        });
        Ok(Self { h, constants: scene.constants(h), joints, tree, lengths })
    }

    /// The joints.
    #[must_use]
    pub fn joints(&self) -> &Joints<C, T, L> {
        &self.joints
    }
}
