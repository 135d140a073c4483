//! Initial states of jointed bodies: closed joints, and velocities that satisfy the constraints.

use nalgebra::{SVector, Vector6};

use super::Constraint;
use super::equations::{Equations, Widest};
use super::jointed::{Body, JointedBodies};
use super::places::Places;
use crate::error::SetupError;
use crate::groups::{Advected as _, CayleyRetraction, LieGroup as _, Retraction};
use crate::mechanics::Effect;
use crate::motion::{Motion, State, Stepper, check_attitude};
use crate::numbers::{Bodies, Coordinates as _, Polynomial};
use crate::solving::{LONGEST_DAMPED, MAX_DAMPED_ITERATIONS, WarmStart};

/// The tolerance for gaps at the start, relative to the terms of the functions, and for velocities that open a joint,
/// relative to theirs: twelve printed digits pass.
const PRINTED: f64 = f64::EPSILON * 1e5;
/// The tolerance for gaps in the search for a start: rounding, as after steps.
const CLOSED: f64 = 2.0 * f64::EPSILON;
/// The longest turn in one update of the search for a start, rad; half coordinates have half of it.
const LONGEST: f64 = 2.0 * LONGEST_DAMPED;

/// The state of a system of jointed bodies.
type StateOf<A, const N: usize> =
    State<[Body; N], A, WarmStart<Bodies<Vector6<f64>, N>, Polynomial<Bodies<Vector6<f64>, N>>>>;

impl<S, C, const K: usize, const N: usize, const T: usize, const L: usize> JointedBodies<S, C, K, N, T, L>
where
    S: Effect<Scalar = f64, Group = [Body; N], Retraction = CayleyRetraction>,
    C: Constraint<K>,
{
    /// The joint with the largest gap, in the units of its functions.
    fn largest_gap(&self, places: &Places<N>) -> (usize, f64) {
        let gaps = self.joints.all().map(|(joint, joined)| (joint, places.gap(joined).norm()));
        // A NaN counts as the widest gap.
        gaps.fold((0, 0.0), |widest, gap| if gap.1 <= widest.1 { widest } else { gap })
    }

    /// Equations whose slopes and matrices aren't set yet.
    #[hot]
    pub(super) fn equations(&self) -> Equations<'_, C, K, N, T, L> {
        Equations::new(&self.joints, &self.tree)
    }

    /// The equations of velocities at these places.
    fn of_velocities(&self, scene: &S, places: &Places<N>, advected: &S::Advected) -> Equations<'_, C, K, N, T, L> {
        let mut equations = self.equations();
        equations.set_velocities(places, &scene.inertia(advected).0);
        equations
    }

    /// The impulses of the joints that project velocities `J⁻¹(μ − s)` onto those that satisfy the constraints, at the
    /// least distance in the metric of the inertia. If these aren't unique, the joint that is redundant, and its pivot.
    ///
    /// All contents of `equations` are overwritten.
    pub(super) fn projection(
        equations: &mut Equations<'_, C, K, N, T, L>,
        scene: &S,
        places: &Places<N>,
        advected: &S::Advected,
        momentum: &Bodies<Vector6<f64>, N>,
    ) -> Result<Bodies<Vector6<f64>, N>, (usize, f64)> {
        equations.set_velocities(places, &scene.inertia(advected).0);
        if let Some(redundant) = equations.redundant() {
            return Err(redundant);
        }
        let residual = scene.momentum_bias(advected) - *momentum;
        equations.solve(&residual.0, |_| SVector::zeros());
        Ok(Bodies(equations.reactions()))
    }

    /// Checks that joints are closed, that velocities satisfy the constraints, and that no joint is redundant.
    pub(super) fn check_start(&self, scene: &S, motion: &Motion<[Body; N], S::Advected>) -> Result<(), SetupError> {
        let places = Places::of(&motion.attitude);
        let equations = self.of_velocities(scene, &places, &motion.advected);
        let Widest { joint, by, relative } = equations.widest_gap(&places, &self.lengths);
        // A NaN fails this test.
        let is_closed = relative <= PRINTED;
        if !is_closed {
            return Err(SetupError::OffConstraint { joint, by });
        }
        check_redundance(&equations)?;
        let momentum = motion.momentum - scene.momentum_bias(&motion.advected);
        let velocities = Bodies::solve(&scene.inertia(&motion.advected), &momentum).0;
        // The turning rate that rounding errors of attitudes produce in a step at rest.
        let least = if self.h == 0.0 { 0.0 } else { CLOSED / (PRINTED * self.h.abs()) };
        let Widest { joint, by, relative } = equations.widest_parting(&velocities.0, &self.lengths, least);
        if relative <= PRINTED { Ok(()) } else { Err(SetupError::OffVelocity { joint, by }) }
    }

    /// A configuration with closed joints near this one, by corrections that are least in the metric of the inertia.
    fn closed(&self, scene: &S, attitude: &[Body; N]) -> Result<[Body; N], SetupError> {
        let (mut attitude, mut last) = (*attitude, f64::INFINITY);
        // The joint with the least widest gap so far. An iteration towards an unreachable configuration ends near a
        // singular one.
        let mut nearest = (0, f64::INFINITY);
        for iteration in 0..MAX_DAMPED_ITERATIONS {
            let places = Places::of(&attitude);
            let mut equations = self.of_velocities(scene, &places, &scene.advected().seen_from(&attitude));
            let Widest { relative, .. } = equations.widest_gap(&places, &self.lengths);
            match check_redundance(&equations) {
                Err(_) if iteration > 0 && relative > PRINTED => break,
                checked => checked?,
            }
            if relative <= CLOSED || relative <= PRINTED && relative >= last {
                return Ok(attitude);
            }
            let gap = self.largest_gap(&places);
            nearest = if gap.1 < nearest.1 { gap } else { nearest };
            last = relative;
            equations.solve(&[Vector6::zeros(); N], |joined| places.gap(joined));
            let updates = equations.unknowns.bodies;
            let largest = updates.iter().fold(0.0_f64, |most, update| most.max(update.fixed_rows::<3>(0).norm()));
            let part = if largest > LONGEST { LONGEST / largest } else { 1.0 };
            let increment = <CayleyRetraction as Retraction<[Body; N]>>::increment(&Bodies(updates.map(|u| u * part)));
            attitude = attitude.advance(&increment);
        }
        let (joint, by) = nearest;
        Err(SetupError::OffConstraint { joint, by })
    }
}

fn check_redundance<C: Constraint<K>, const K: usize, const N: usize, const T: usize, const L: usize>(
    equations: &Equations<'_, C, K, N, T, L>,
) -> Result<(), SetupError> {
    match equations.redundant() {
        Some((joint, pivot)) => Err(SetupError::RedundantJoint { joint, pivot }),
        None => Ok(()),
    }
}

/// # Start: bodies in joints
impl<S, C, const K: usize, const N: usize, const T: usize, const L: usize> Stepper<S, JointedBodies<S, C, K, N, T, L>>
where
    S: Effect<Scalar = f64, Group = [Body; N], Retraction = CayleyRetraction>,
    C: Constraint<K>,
{
    /// A motion from a configuration near this one with closed joints, by corrections that are least in the metric of
    /// the inertia; its velocities are the nearest in that metric that satisfy the constraints.
    ///
    /// # Errors
    ///
    /// [`SetupError::OffConstraint`] if no such configuration is found, with the least gap of the search;
    /// [`SetupError::RedundantJoint`] if a joint is redundant here or there; otherwise the errors of
    /// [`start`](Stepper::start).
    pub fn start_nearest(
        &self,
        attitude: [Body; N],
        velocity: Bodies<Vector6<f64>, N>,
    ) -> Result<StateOf<S::Advected, N>, SetupError> {
        if !velocity.is_finite() {
            return Err(SetupError::NonFinite { what: "velocity" });
        }
        check_attitude(&attitude)?;
        let attitude = self.plan.closed(&self.scene, &attitude)?;
        let advected = self.scene.advected().seen_from(&attitude);
        let mut momentum = self.scene.inertia(&advected) * velocity + self.scene.momentum_bias(&advected);
        let places = Places::of(&attitude);
        let mut equations = self.plan.equations();
        // The second projection removes the rounding errors of the first, for bodies of very different masses.
        for _ in 0..2 {
            let taken = JointedBodies::projection(&mut equations, &self.scene, &places, &advected, &momentum);
            momentum = momentum - taken.map_err(|(joint, pivot)| SetupError::RedundantJoint { joint, pivot })?;
        }
        self.start_with_momentum(attitude, momentum)
    }

    /// The widest gap of a joint, m; for a [`PinJoint`](super::PinJoint) the norm includes the cosines of its axes.
    #[must_use]
    pub fn widest_gap(&self, motion: &Motion<[Body; N], S::Advected>) -> f64 {
        self.plan.largest_gap(&Places::of(&motion.attitude)).1
    }
}
