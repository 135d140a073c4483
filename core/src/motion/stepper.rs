//! The stepper: a flow on momenta with reconstruction.

use crate::error::{SetupError, StepError};
use crate::groups::{Advected, LieGroup, SO3};
use crate::mechanics::{
    AxiallyInvariant, DiscreteLagrangian, Effect, Group, LeftInvariant, Regular, Scalar, Vector, energy,
    momentum_of_velocity, velocity_of_momentum,
};
use crate::motion::flows::{DiscreteLiePoisson, Stepped};
use crate::motion::state::State;
use crate::numbers::{Coordinates as _, Work, at_best_in_lanes, real, reported};
use crate::solving::{Continued, Solvability};
use crate::with::Remedy;
use nalgebra::{SimdBool as _, SimdPartialOrd as _, SimdRealField as _};

/// What a step did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepReport {
    /// Newton iterations, of several lanes those of the slowest; above 20 where the first guess had to be given up. The
    /// last may have been made with the Jacobian of the one before.
    ///
    /// Where the [Jacobian is dear](Effect::JACOBIAN_IS_DEAR) they are residuals, up to eight, to which come
    /// the iterations with the Jacobian where these weren't enough.
    pub iterations: u32,
    /// What was done in the place of this step; only by a [`RemediedStepper`](crate::with::RemediedStepper).
    pub remedy: Option<Remedy>,
}

/// An integrator with a fixed step for a declared Lagrangian.
///
/// # Contract
///
/// - A step satisfies its momentum equation to rounding on the branch of the identity, or returns an error and leaves
///   the state as it was.
/// - With a scalar of several [lanes](crate::numbers::Real#lanes) all of them move or none does, each as it would alone.
/// - The same state gives the same next state, bit for bit. In Cayley coordinates no library function is called, so
///   that holds from machine to machine.
/// - Nothing is allocated, and no loop is unbounded.
///
/// # Examples
///
/// ```
/// use liestep::{DiagonalNonstandardInertia, SO3, Stepper, lagrangian};
/// use nalgebra::Vector3;
///
/// /// A free rigid body.
/// #[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
/// struct Body {
///     J_d: DiagonalNonstandardInertia,
/// }
///
/// let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
/// let stepper = Stepper::new(Body { J_d }, 0.01)?;
/// let mut state = stepper.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02))?;
/// let before = state.spatial_momentum();
/// for _ in 0..1000 {
///     stepper.step(&mut state)?;
/// }
/// assert!((state.spatial_momentum() - before).norm() < 1e-12);
/// # use liestep::LieGroup;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Stepper<L: Effect> {
    flow: DiscreteLiePoisson<L>,
}

impl<L: Effect> Stepper<L> {
    /// Checks the parameters and folds the constants for the step `h`, in seconds.
    ///
    /// # Errors
    ///
    /// As [`DiscreteLiePoisson::new`].
    pub fn new(lagrangian: L, h: Scalar<L>) -> Result<Self, SetupError>
    where
        L: Regular,
    {
        DiscreteLiePoisson::new(lagrangian, h).map(|flow| Self { flow })
    }

    /// A motion from an attitude (body to space) and a body velocity, on SO(3) in rad/s.
    ///
    /// The momentum is that of the continuous Lagrangian, `μ_0 = J Ω_0` for a rigid body: the half kick of the
    /// potential is inside (2.7).
    ///
    /// # Errors
    ///
    /// [`SetupError`] where the attitude isn't in the group or something isn't finite.
    pub fn start(
        &self,
        attitude: impl Into<Group<L>>,
        velocity: Vector<L>,
    ) -> Result<State<Group<L>, L::Advected>, SetupError> {
        if !velocity.is_finite() {
            return Err(SetupError::NonFinite { what: "velocity" });
        }
        let attitude = attitude.into();
        let w = self.lagrangian().advected().seen_from(&attitude);
        let momentum = momentum_of_velocity(self.lagrangian(), &velocity, &w);
        self.start_with_momentum(attitude, momentum)
    }

    /// A motion from an attitude (body to space) and a body momentum, on SO(3) in kg m²/s.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where the attitude isn't in the group or something isn't finite.
    pub fn start_with_momentum(
        &self,
        attitude: impl Into<Group<L>>,
        momentum: Vector<L>,
    ) -> Result<State<Group<L>, L::Advected>, SetupError> {
        let attitude = attitude.into();
        // What a unit quaternion or a matrix printed to a dozen digits leaves; NaN fails it too.
        let allowed = Scalar::<L>::simd_default_epsilon() * real(1e4);
        let defect = attitude.defect();
        if !defect.simd_le(allowed).all() {
            return Err(SetupError::NotInGroup { defect: reported(defect) });
        }
        if !momentum.is_finite() {
            return Err(SetupError::NonFinite { what: "momentum" });
        }
        Ok(self.at(attitude, momentum))
    }

    /// The state of another scene on the same group, to go on in this one: its attitude and momentum are kept to the
    /// bit, and time counts from here.
    ///
    /// What both scenes conserve goes on being conserved, as the discrete momentum belongs to a time, not to a step.
    ///
    /// # Examples
    ///
    /// A top is let go: it falls freely from here on.
    ///
    /// ```
    /// use liestep::effects::{Gravity, RigidBody};
    /// use liestep::{LieGroup as _, NonstandardInertia, SO3, Stepper};
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
    pub fn adopt<A: Advected<Group<L>>>(&self, state: &State<Group<L>, A>) -> State<Group<L>, L::Advected> {
        self.at(state.attitude, state.momentum)
    }

    /// The motion that begins with this attitude and momentum.
    fn at(&self, attitude: Group<L>, momentum: Vector<L>) -> State<Group<L>, L::Advected> {
        let advected = self.lagrangian().advected().seen_from(&attitude);
        // Every retraction has the identity as its derivative at zero, so this is near the first increment.
        let half_step = self.step_size() * real(0.5);
        let half = velocity_of_momentum(self.lagrangian(), &momentum, &advected) * half_step;
        State::new(attitude, momentum, advected, half)
    }

    /// One step. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// [`StepError`] where the momentum equation (2.7) has no solution on the branch of the identity, or a value
    /// isn't finite.
    #[inline]
    pub fn step(&self, state: &mut State<Group<L>, L::Advected>) -> Result<StepReport, StepError> {
        at_best_in_lanes::<Scalar<L>, _>(Step(self, state))
    }

    #[inline(always)]
    fn step_as_compiled(&self, state: &mut State<Group<L>, L::Advected>) -> Result<StepReport, StepError> {
        match self.flow.step_directly(&state.momentum, &state.advected, &state.guess()) {
            Some(stepped) => Ok(self.taken(state, &stepped)),
            None => self.step_carefully(state),
        }
    }

    /// What is rare, to its end: if it came back to the common way, that would have to keep in memory what it has in
    /// registers.
    #[cold]
    #[inline(never)]
    fn step_carefully(&self, state: &mut State<Group<L>, L::Advected>) -> Result<StepReport, StepError> {
        let stepped = self.flow.step_carefully(&state.momentum, &state.advected, &state.guess())?;
        Ok(self.taken(state, &stepped))
    }

    #[inline(always)]
    fn taken(&self, state: &mut State<Group<L>, L::Advected>, stepped: &Stepped<L>) -> StepReport {
        let Stepped { step, half, far } = stepped;
        state.attitude = state.attitude.advance(&step.increment);
        state.momentum = step.momentum;
        state.advected = step.advected;
        state.proceed(*half, *far, Continued::for_jacobian(L::JACOBIAN_IS_DEAR), || self.lagrangian().advected());
        StepReport { iterations: step.iterations, remedy: None }
    }

    /// The states after each step from here on; after an error, nothing more.
    pub fn steps(
        &self,
        state: State<Group<L>, L::Advected>,
    ) -> impl Iterator<Item = Result<State<Group<L>, L::Advected>, StepError>> {
        let mut current = Some(state);
        core::iter::from_fn(move || {
            let mut next = current.take()?;
            Some(self.step(&mut next).map(|_| {
                current = Some(next);
                next
            }))
        })
    }

    /// The declared Lagrangian.
    #[must_use]
    pub fn lagrangian(&self) -> &L {
        self.flow.lagrangian()
    }

    /// The flow on momenta, (2.8).
    #[must_use]
    pub fn flow(&self) -> &DiscreteLiePoisson<L> {
        &self.flow
    }

    /// The step `h`, s.
    #[must_use]
    pub fn step_size(&self) -> Scalar<L> {
        self.flow.step_size()
    }

    /// The time since the start, `n h`, s; never accumulated.
    #[must_use]
    #[allow(clippy::cast_precision_loss)] // 2⁵³ steps take longer than a career
    pub fn time(&self, state: &State<Group<L>, L::Advected>) -> Scalar<L> {
        self.step_size() * real(state.steps as f64)
    }

    /// The body velocity, on SO(3) in rad/s.
    #[must_use]
    pub fn velocity(&self, state: &State<Group<L>, L::Advected>) -> Vector<L> {
        velocity_of_momentum(self.lagrangian(), &state.momentum, &state.advected)
    }

    /// The energy `½ Ω·JΩ + V(w)` of the continuous system, J. Where the scene is a [`DiscreteLagrangian`] it
    /// oscillates about its initial value, at the order of the scheme, and doesn't drift.
    #[must_use]
    pub fn energy(&self, state: &State<Group<L>, L::Advected>) -> Scalar<L> {
        energy(self.lagrangian(), &state.momentum, &state.advected)
    }

    /// What is proved about the next step; see [`DiscreteLiePoisson::solvability`].
    #[must_use]
    pub fn solvability(&self, state: &State<Group<L>, L::Advected>) -> Solvability {
        self.flow.solvability(&state.momentum, &state.advected)
    }

    /// The stepper of `−h`, which undoes the steps of this one exactly.
    ///
    /// For that `l_d` has to be [self-adjoint](DiscreteLagrangian::SELF_ADJOINT); another is refused when the user's
    /// crate is built:
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
    /// As [`DiscreteLiePoisson::new`].
    pub fn inverse(&self) -> Result<Self, SetupError>
    where
        L: DiscreteLagrangian + Regular + Clone,
    {
        const {
            assert!(L::SELF_ADJOINT, "a step of -h undoes one of h only where l_d(F, w, h) = -l_d(F^-1, F^-1 w, -h)");
        }
        Self::new(self.lagrangian().clone(), -self.step_size())
    }

    /// The spatial momentum, `R Π` on SO(3), in a scene that conserves it: nothing is advected.
    #[must_use]
    pub fn spatial_momentum(&self, state: &State<Group<L>, L::Advected>) -> Vector<L>
    where
        L: LeftInvariant,
    {
        state.spatial_momentum()
    }

    /// The momentum along the advected vector, `Π·w` (`e₃·R Π` for the vertical), in a scene that conserves it: one
    /// vector is advected, (3.20).
    #[must_use]
    pub fn momentum_along_advected(&self, state: &State<Group<L>, L::Advected>) -> Scalar<L>
    where
        L: AxiallyInvariant<Group = SO3<Scalar<L>>>,
    {
        state.momentum().dot(&L::axis(&state.advected))
    }

    /// The largest step from this state up to the stepper's own, s; see [`DiscreteLiePoisson::max_step`].
    #[must_use]
    pub fn max_step(&self, state: &State<Group<L>, L::Advected>) -> Scalar<L> {
        self.flow.max_step(&state.momentum, &state.advected)
    }
}

/// A step of this state.
struct Step<'a, L: Effect>(&'a Stepper<L>, &'a mut State<Group<L>, L::Advected>);

impl<L: Effect> Work for Step<'_, L> {
    type Output = Result<StepReport, StepError>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        self.0.step_as_compiled(self.1)
    }
}
