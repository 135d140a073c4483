//! Initial states of a motion.

use super::{StateOf, Stepper};
use crate::error::SetupError;
use crate::groups::{Advected, LieGroup};
use crate::mechanics::{
    Effect, Group, Scalar, Vector, check_constraints, check_inertia, check_velocity, inertia, velocity_of_momentum,
};
use crate::motion::kept::Kept;
use crate::motion::plan::Plan;
use crate::motion::state::{ElapsedTime, State};
use crate::motion::summation::Motion;
use crate::numbers::{Coordinates as _, Real, is_finite, real, reported};
use nalgebra::{SimdBool as _, SimdPartialOrd as _, SimdRealField as _};

/// # Start
///
/// A state from an attitude and a velocity or a momentum, or from a motion of another stepper.
impl<S: Effect, P: Plan<S>> Stepper<S, P> {
    /// A motion from an attitude (body to space) and a body velocity, on SO(3) in rad/s.
    ///
    /// The momentum is that of the continuous Lagrangian, `μ_0 = J Ω_0` for a rigid body: the half kick of the
    /// potential is inside (2.7).
    ///
    /// # Errors
    ///
    /// [`SetupError`] if the attitude isn't in the group, a number isn't finite, or an inertia that depends on advected
    /// or prescribed parameters is degenerate there; [`SetupError::AmbiguousVelocity`] if the continuous limit isn't
    /// quadratic in the velocity, and the inverse Legendre transform of the momentum is another velocity;
    /// [`SetupError::ViolatedConstraint`] and [`SetupError::RedundantConstraint`] of a scene with constraints on velocities.
    pub fn start(&self, attitude: impl Into<Group<S>>, velocity: Vector<S>) -> Result<StateOf<S, P>, SetupError> {
        if !velocity.is_finite() {
            return Err(SetupError::NonFinite { what: "velocity" });
        }
        let attitude = attitude.into();
        check_attitude(&attitude)?;
        let w = self.plan.begun(&self.scene, &attitude, &Vector::<S>::zero());
        let momentum = self.plan.momentum(&self.scene, &attitude, &velocity, &w);
        if !self.scene.facts().is_quadratic {
            let found = self.plan.velocity(&self.scene, &Motion { attitude, momentum, advected: w, steps: 0 });
            check_velocity::<Scalar<S>, _>(&velocity, &found, &momentum, &inertia(&self.scene, &w))?;
        }
        self.start_with_momentum(attitude, momentum)
    }

    /// A motion from an attitude (body to space) and a body momentum, on SO(3) in kg m²/s.
    ///
    /// # Errors
    ///
    /// [`SetupError`] if the attitude isn't in the group, a number isn't finite, or an inertia that depends on advected
    /// or prescribed parameters is degenerate there; [`SetupError::NoVelocity`] if no velocity has this momentum.
    pub fn start_with_momentum(
        &self,
        attitude: impl Into<Group<S>>,
        momentum: Vector<S>,
    ) -> Result<StateOf<S, P>, SetupError> {
        let attitude = attitude.into();
        check_attitude(&attitude)?;
        if !momentum.is_finite() {
            return Err(SetupError::NonFinite { what: "momentum" });
        }
        let w = self.plan.begun(&self.scene, &attitude, &momentum);
        if !self.scene.facts().has_constant_inertia {
            check_inertia::<Group<S>>(&inertia(&self.scene, &w))?;
        }
        if !self.scene.facts().is_quadratic && !velocity_of_momentum(&self.scene, &momentum, &w).is_finite() {
            return Err(SetupError::NoVelocity);
        }
        if const { S::FACTS.constraints > 0 } {
            check_constraints(&self.scene, &velocity_of_momentum(&self.scene, &momentum, &w), &w)?;
        }
        let state = self.begin(attitude, momentum);
        check_range(&state)?;
        Ok(state)
    }

    /// A state with the attitude and momentum, to the bit, of a motion of another scene or another method on the same
    /// group. Its time counts from here.
    ///
    /// Quantities that both scenes conserve stay conserved, because the discrete momentum belongs to a time, not to a
    /// step. As no error is returned, an inertia of this scene that depends on advected parameters isn't checked;
    /// [`start_with_momentum`](Self::start_with_momentum) does that.
    ///
    /// # Examples
    ///
    /// A top is released: it falls freely from here on.
    ///
    /// ```
    /// use liestep::effects::{Gravity, RigidBody};
    /// use liestep::{NonstandardInertia, SO3, Stepper};
    /// use liestep::groups::LieGroup as _;
    /// use nalgebra::Vector3;
    ///
    /// let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))? };
    /// let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::x() };
    /// let (held, free) = (Stepper::new(body + gravity, 0.01)?, Stepper::new(body, 0.01)?);
    /// let mut state = held.start(SO3::identity(), Vector3::new(0.0, 0.0, 10.0))?;
    /// held.step(&mut state)?;
    /// let mut released = free.adopt(&state);
    /// assert_eq!(released.momentum(), state.momentum());
    /// free.step(&mut released)?;
    /// assert!((free.spatial_momentum(&released) - state.spatial_momentum()).norm() < 1e-13);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn adopt<A>(&self, motion: &Motion<Group<S>, A>) -> StateOf<S, P> {
        self.begin(motion.attitude, motion.momentum)
    }

    /// The initial state at this attitude and momentum.
    fn begin(&self, attitude: Group<S>, momentum: Vector<S>) -> StateOf<S, P> {
        let advected = self.plan.begun(&self.scene, &attitude, &momentum);
        let motion = Motion { attitude, momentum, advected, steps: 0 };
        State { motion, kept: self.plan.keep(&self.scene, &motion), elapsed: ElapsedTime::nothing() }
    }
}

/// Checks that the attitude is in the group.
pub(crate) fn check_attitude<G: LieGroup>(attitude: &G) -> Result<(), SetupError> {
    // A unit quaternion or a matrix with twelve printed digits passes; NaN fails.
    let allowed = G::Scalar::simd_default_epsilon() * real(1e4);
    let defect = attitude.defect();
    if defect.simd_le(allowed).all() { Ok(()) } else { Err(SetupError::NotInGroup { defect: reported(defect) }) }
}

/// Checks that numbers computed from finite ones are finite, too: a rotated vector or a velocity may leave the scalar's
/// range.
fn check_range<T: Real, G: LieGroup<Scalar = T>, A: Advected<G>, K: Kept<T>>(
    state: &State<G, A, K>,
) -> Result<(), SetupError> {
    let mut is_kept = true;
    state.kept.each(&mut |number| is_kept &= is_finite(number));
    match (state.motion.advected.is_finite(), is_kept) {
        (false, _) => Err(SetupError::NonFinite { what: "view of what is advected" }),
        (true, false) => Err(SetupError::NonFinite { what: "velocity of the momentum" }),
        (true, true) => Ok(()),
    }
}
