//! Motions start where joints are closed, with velocities that keep them so.

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

/// How far joints may be open, relative to the terms of their functions, and velocities may part them, relative to
/// theirs: what is left of values that are printed to a dozen digits.
const PRINTED: f64 = f64::EPSILON * 1e5;
/// How far joints of a start that is sought may be open to be closed: roundings, as steps leave them.
const CLOSED: f64 = 2.0 * f64::EPSILON;
/// The longest turn in one update of a start that is sought, rad: that of half coordinates.
const LONGEST: f64 = 2.0 * LONGEST_DAMPED;

/// What a state of joined bodies is.
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
        // What isn't a number is the widest.
        gaps.fold((0, 0.0), |widest, gap| if gap.1 <= widest.1 { widest } else { gap })
    }

    /// Without slopes and matrices.
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

    /// What joints take from momenta whose velocities `J⁻¹(μ − s)` would part them: the impulses that leave the
    /// velocities nearest to these. Where these aren't determined, a joint to blame and its pivot.
    ///
    /// What the equations were of doesn't matter.
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

    /// Whether joints are closed, velocities keep them so, and each of them has something to do.
    pub(super) fn check_start(&self, scene: &S, motion: &Motion<[Body; N], S::Advected>) -> Result<(), SetupError> {
        let places = Places::of(&motion.attitude);
        let equations = self.of_velocities(scene, &places, &motion.advected);
        let Widest { joint, by, relative } = equations.widest_gap(&places, &self.lengths);
        // What isn't a number isn't closed either.
        let is_closed = relative <= PRINTED;
        if !is_closed {
            return Err(SetupError::OffConstraint { joint, by });
        }
        check_redundance(&equations)?;
        let momentum = motion.momentum - scene.momentum_bias(&motion.advected);
        let velocities = Bodies::solve(&scene.inertia(&motion.advected), &momentum).0;
        // What roundings of attitudes in a step leave of rest.
        let least = if self.h == 0.0 { 0.0 } else { CLOSED / (PRINTED * self.h.abs()) };
        let Widest { joint, by, relative } = equations.widest_parting(&velocities.0, &self.lengths, least);
        if relative <= PRINTED { Ok(()) } else { Err(SetupError::OffVelocity { joint, by }) }
    }

    /// Places next to these where joints are closed, by corrections that are least as the inertia measures it.
    fn closed(&self, scene: &S, attitude: &[Body; N]) -> Result<[Body; N], SetupError> {
        let (mut attitude, mut last) = (*attitude, f64::INFINITY);
        // Where joints were nearest to being closed: towards a place that can't be reached they come near a singular one.
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
    /// A motion from a place next to these where joints are closed, by corrections that are least as the inertia measures
    /// it, with those velocities nearest to these, measured so, that keep them closed.
    ///
    /// # Errors
    ///
    /// [`SetupError::OffConstraint`] where no such place is found, with the gap that is left where joints are nearest to
    /// being closed; [`SetupError::RedundantJoint`] where a joint has nothing to do here or there; otherwise as [`start`](Stepper::start).
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
        // The second time for what roundings of the first leave, where bodies are of unlike masses.
        for _ in 0..2 {
            let taken = JointedBodies::projection(&mut equations, &self.scene, &places, &advected, &momentum);
            momentum = momentum - taken.map_err(|(joint, pivot)| SetupError::RedundantJoint { joint, pivot })?;
        }
        self.start_with_momentum(attitude, momentum)
    }

    /// How far the joint that is open farthest is open, m; of a [`PinJoint`](super::PinJoint) with the cosines of its
    /// axes.
    #[must_use]
    pub fn widest_gap(&self, motion: &Motion<[Body; N], S::Advected>) -> f64 {
        self.plan.largest_gap(&Places::of(&motion.attitude)).1
    }
}
