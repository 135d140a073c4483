//! The stepper: a scene, a method, and all that is put around a step.

use alloc::string::String;

use crate::error::{SetupError, StepError};
use crate::groups::{Advected as _, LieGroup, SO3};
use crate::mechanics::{
    AxiallyInvariant, DiscreteLagrangian, Effect, Group, LeftInvariant, Regular, Scalar, Term, Vector, check_inertia,
    check_velocity, energy, momentum_of_velocity, velocity_of_momentum,
};
use crate::motion::declared::Declared;
use crate::motion::flows::DiscreteLiePoisson;
use crate::motion::plan::{Next, Plan, Steerable, run_called};
use crate::motion::report::StepReport;
use crate::motion::state::State;
use crate::motion::summation::Motion;
use crate::numbers::{Coordinates as _, InLanes, Kernel, Lanes, Vectors, dispatch, real, reported};
use crate::solving::Solvability;
use nalgebra::{SimdBool as _, SimdComplexField as _, SimdPartialOrd as _, SimdRealField as _};

/// The state of a scene `S` that is stepped by the plan `P`.
pub(crate) type StateOf<S, P> = State<Group<S>, <S as Term>::Advected, <P as Plan<S>>::Kept>;

/// An integrator with a fixed step: a scene, and a method whose constants are folded for it.
///
/// ```text
/// Stepper::new(scene, h)                          its own step, of the order of the declared Lagrangian
/// Stepper::composed(scene, h, scheme)             symmetric compositions of it, to order 10
/// Stepper::split(scene, h, flow, scheme)          kinetic flow and kicks by turns, to order 10
/// Stepper::processed(scene, h, flow, scheme)      the same between the ends of a processor, for fewer flows a step
/// Stepper::collocated::<PAIRS>(scene, h)          Gauss collocation, to any order
/// Stepper::for_accuracy(scene, accuracy, …)       the cheapest of all these
/// ```
///
/// Whatever the method `P`, a motion is [started](Self::start), [stepped](Self::step) and read in the same way, and
/// [compensated](Self::compensated) sums, [substeps](Self::or_substeps), control forces and checkpoints go with it.
///
/// # Contract
///
/// - A step satisfies its momentum equation to rounding on the branch of the identity, or returns an error and leaves
///   the state as it was.
/// - With a scalar of several [lanes](crate::numbers::Real#lanes) all of them move or none does, each as it would alone.
/// - The same state gives the same next state, bit for bit. In Cayley coordinates no library function is called, so
///   that holds from machine to machine.
/// - An inertia that depends on what is advected or given is checked where a motion starts, and nowhere after that: a
///   scene in which it can become degenerate has to look itself.
/// - Nothing is allocated, and no loop is unbounded.
///
/// # Examples
///
/// ```
/// use liestep::{SO3, Stepper, lagrangian};
/// use liestep::mechanics::DiagonalNonstandardInertia;
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
/// # use liestep::groups::LieGroup;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Stepper<S: Effect, P = Declared<S>> {
    pub(crate) scene: S,
    pub(crate) plan: P,
}

impl<S: Effect> Stepper<S> {
    /// Checks the parameters and folds the constants for the step `h`, in seconds.
    ///
    /// A negative `h` is the inverse map of `−h` where `l_d` is self-adjoint; `h = 0` is the identity.
    ///
    /// # Errors
    ///
    /// [`SetupError`] for a parameter or a step that can't be used, and for a degenerate kinetic part. Of several lanes
    /// it doesn't tell which: steppers that are made one by one and [gathered](Lanes::gathered) do.
    pub fn new(scene: S, h: Scalar<S>) -> Result<Self, SetupError>
    where
        S: Regular,
    {
        let plan = Declared::new(&scene, h)?;
        Ok(Self { scene, plan })
    }
}

impl<S: Effect, P: Plan<S>> Stepper<S, P> {
    /// A motion from an attitude (body to space) and a body velocity, on SO(3) in rad/s.
    ///
    /// The momentum is that of the continuous Lagrangian, `μ_0 = J Ω_0` for a rigid body: the half kick of the
    /// potential is inside (2.7).
    ///
    /// # Errors
    ///
    /// [`SetupError`] where the attitude isn't in the group, something isn't finite, or an inertia that depends on what
    /// is advected or given is degenerate there; [`SetupError::AmbiguousVelocity`] where the continuous limit isn't
    /// quadratic in the velocity, and the momentum doesn't lead back to this one.
    pub fn start(&self, attitude: impl Into<Group<S>>, velocity: Vector<S>) -> Result<StateOf<S, P>, SetupError> {
        if !velocity.is_finite() {
            return Err(SetupError::NonFinite { what: "velocity" });
        }
        let attitude = attitude.into();
        check_attitude(&attitude)?;
        let w = self.scene.advected().seen_from(&attitude);
        let momentum = momentum_of_velocity(&self.scene, &velocity, &w);
        if !S::IS_QUADRATIC {
            let found = velocity_of_momentum(&self.scene, &momentum, &w);
            check_velocity::<Scalar<S>, _>(&velocity, &found, &momentum, &self.scene.inertia(&w))?;
        }
        self.start_with_momentum(attitude, momentum)
    }

    /// A motion from an attitude (body to space) and a body momentum, on SO(3) in kg m²/s.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where the attitude isn't in the group, something isn't finite, or an inertia that depends on what
    /// is advected or given is degenerate there; [`SetupError::NoVelocity`] where no velocity has this momentum.
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
        if !S::INERTIA_IS_CONSTANT {
            let w = self.scene.advected().seen_from(&attitude);
            check_inertia::<Group<S>>(&self.scene.inertia(&w))?;
        }
        if !S::IS_QUADRATIC {
            let w = self.scene.advected().seen_from(&attitude);
            if !velocity_of_momentum(&self.scene, &momentum, &w).is_finite() {
                return Err(SetupError::NoVelocity);
            }
        }
        let state = self.begin(attitude, momentum);
        self.plan.admits(&self.scene, &state.motion)?;
        Ok(state)
    }

    /// One step. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// [`StepError`] where an equation of the method has no solution, for a scene's own step (2.7) on the branch of the
    /// identity, or a value isn't finite. [`StepError::BeyondSolvable`] names the largest step that would do.
    #[hot]
    pub fn step(&self, state: &mut StateOf<S, P>) -> Result<StepReport, StepError> {
        let made = if const { P::STEPS_BY_RUNS } {
            self.run_unexplained(state, 1).map(StepReport::of_run)
        } else {
            dispatch(Step(self, state))
        };
        match made {
            Err(error) if P::EXPLAINS => Err(self.plan.explained(error, &self.scene, &state.motion, &state.kept)),
            made => made,
        }
    }

    /// [`step`](Self::step), called: one copy of it for all that is put around a step.
    #[inline(never)]
    pub(crate) fn step_called(&self, state: &mut StateOf<S, P>) -> Result<StepReport, StepError> {
        self.step(state)
    }

    /// So many steps, of which the states between aren't asked for; returns all their iterations. On an error the state
    /// is unchanged.
    ///
    /// A [splitting](Self::split) makes the last flow of a step and the first of the next as one: where its kinetic flow
    /// is exact the result is that of as many [steps](Self::step) to rounding; elsewhere they differ by some of its
    /// error.
    ///
    /// # Errors
    ///
    /// As [`step`](Self::step).
    pub fn run(&self, state: &mut StateOf<S, P>, steps: u64) -> Result<u64, StepError> {
        let mut next = *state;
        let iterations = self.run_in_place(&mut next, steps, None)?;
        *state = next;
        Ok(iterations)
    }

    /// As [`run`](Self::run), but after an error the state may be anywhere; it goes on as
    /// [`Integrator::run_shown`](crate::motion::Integrator::run_shown) does.
    pub(crate) fn run_in_place(
        &self,
        state: &mut StateOf<S, P>,
        steps: u64,
        next: Next<'_, Group<S>, S::Advected>,
    ) -> Result<u64, StepError> {
        let made = run_called(&self.plan, &self.scene, &mut state.motion, &mut state.kept, (steps, next));
        made.map_err(|error| self.plan.explained(error, &self.scene, &state.motion, &state.kept))
    }

    /// As [`run`](Self::run), but after an error the state may be anywhere, and what would do isn't looked for.
    #[inline]
    pub(crate) fn run_unexplained(&self, state: &mut StateOf<S, P>, steps: u64) -> Result<u64, StepError> {
        run_called(&self.plan, &self.scene, &mut state.motion, &mut state.kept, (steps, None))
    }

    /// One step as a run of one, where that is the same: for callers that would else have another copy of it compiled.
    pub(crate) fn step_or_run(&self, state: &mut StateOf<S, P>) -> Result<StepReport, StepError> {
        if const { P::STEPS_BY_RUNS || P::RUNS_BY_STEPS } {
            self.run_in_place(state, 1, None).map(StepReport::of_run)
        } else {
            self.step_called(state)
        }
    }

    /// The motion after a step of this fraction of `h`; see [`Integrator::part`](crate::motion::Integrator::part).
    pub(crate) fn fraction_of_a_step(
        &self,
        state: &StateOf<S, P>,
        fraction: Scalar<S>,
    ) -> Result<Motion<Group<S>, S::Advected>, StepError> {
        // Nothing of a change so small would be seen, and of a step so small constants may leave the scalar's range.
        let least = Scalar::<S>::simd_default_epsilon() * Scalar::<S>::simd_default_epsilon();
        if fraction.simd_abs().simd_lt(least).all() {
            return Ok(state.motion);
        }
        let scene = &self.scene;
        let part = self.plan.refolded(scene, self.step_size() * fraction);
        let part = part.map_err(|_| StepError::NonFinite { what: "part of the step" })?;
        let mut next = state.motion;
        let mut kept = part.keep(scene, &next);
        run_called(&part, scene, &mut next, &mut kept, (1, None))
            .map_err(|error| part.explained(error, scene, &state.motion, &kept))?;
        next.steps = state.steps;
        Ok(next)
    }

    /// The states after each step from here on; after an error, nothing more.
    pub fn steps(&self, state: StateOf<S, P>) -> impl Iterator<Item = Result<StateOf<S, P>, StepError>> {
        let mut current = Some(state);
        core::iter::from_fn(move || {
            let mut next = current.take()?;
            Some(self.step_called(&mut next).map(|_| {
                current = Some(next);
                next
            }))
        })
    }

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
    /// use liestep::{NonstandardInertia, SO3, Stepper};
    /// use liestep::groups::LieGroup as _;
    /// use nalgebra::Vector3;
    ///
    /// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5))?;
    /// let stepper = Stepper::new(RigidBody { J_d }, 0.01)?;
    /// let mut state = stepper.start(SO3::identity(), Vector3::new(0.5, -1.0, 2.0))?;
    /// for _ in 0..1000 {
    ///     let torque = stepper.velocity(&state) * -2.0;
    ///     stepper.step_forced(&mut state, &torque)?;
    /// }
    /// assert!(stepper.velocity(&state).norm() < 0.1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Source
    ///
    /// \[MW01\], section 3.2.
    pub fn step_forced(&self, state: &mut StateOf<S, P>, force: &Vector<S>) -> Result<StepReport, StepError> {
        if !force.is_finite() {
            return Err(StepError::NonFinite { what: "control force" });
        }
        let half = *force * (self.step_size() * real(0.5));
        let mut next = *state;
        self.plan.push(&self.scene, &mut next.motion, &mut next.kept, &half)?;
        let report = self.step_called(&mut next)?;
        self.plan.push(&self.scene, &mut next.motion, &mut next.kept, &half)?;
        if !next.motion.momentum.is_finite() {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        *state = next;
        Ok(report)
    }

    /// One step in which what is advected has these values in space, in the place of the scene's own; on an error the
    /// state is unchanged.
    ///
    /// It is how a scene is driven: a field that is switched, a direction that goes round with the orbit, and what the
    /// declaration names in `given(…)`, a torque for example. The values are those of `scene.advected()`, in a sum a pair,
    /// and are held over the step: taken in the middle of it, the scheme stays of second order. Each step is variational
    /// by itself. Between the steps the state sees the scene's own values again, which
    /// [`energy`](Self::energy) is computed with. An inertia that depends on the values isn't checked with these.
    ///
    /// # Errors
    ///
    /// [`StepError`] where a value isn't finite, and as [`step`](Self::step).
    ///
    /// # Examples
    ///
    /// A wheel's torque that grows with time.
    ///
    /// ```
    /// use liestep::effects::RigidBody;
    /// use liestep::groups::{Given, LieGroup as _};
    /// use liestep::{NonstandardInertia, SO3, Stepper, force};
    /// use nalgebra::Vector3;
    ///
    /// #[force(group = SO3, given(u = torque), work = 0.5 * h * u * (eta + eta_next)[2])]
    /// struct Wheel {
    ///     torque: f64,
    /// }
    ///
    /// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.0))?;
    /// let stepper = Stepper::new(RigidBody { J_d } + Wheel { torque: 0.0 }, 0.01)?;
    /// let mut state = stepper.start(SO3::identity(), Vector3::zeros())?;
    /// for step in 0..100 {
    ///     let middle = stepper.time(&state) + 0.005;
    ///     stepper.step_with(&mut state, &((), Given::scalar(middle)))?;
    /// }
    /// assert!((state.momentum().z - 0.5_f64).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn step_with(&self, state: &mut StateOf<S, P>, values: &S::Advected) -> Result<StepReport, StepError>
    where
        P: Steerable,
    {
        if !values.is_finite() {
            return Err(StepError::NonFinite { what: "value given to the step" });
        }
        let mut next = *state;
        let State { motion, kept } = &mut next;
        self.plan.see(motion, kept, values.seen_from(&motion.attitude));
        let report = self.step_called(&mut next)?;
        let State { motion, kept } = &mut next;
        self.plan.see(motion, kept, self.scene.advected().seen_from(&motion.attitude));
        *state = next;
        Ok(report)
    }

    /// The state of another scene or of another method on the same group, to go on in this one: its attitude and momentum
    /// are kept to the bit, and time counts from here.
    ///
    /// What both scenes conserve goes on being conserved, as the discrete momentum belongs to a time, not to a step. As
    /// there is no error to return, an inertia of this scene that depends on what is advected isn't checked;
    /// [`start_with_momentum`](Self::start_with_momentum) does that.
    ///
    /// # Examples
    ///
    /// A top is let go: it falls freely from here on.
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

    /// The motion that begins with this attitude and momentum.
    fn begin(&self, attitude: Group<S>, momentum: Vector<S>) -> StateOf<S, P> {
        let advected = self.scene.advected().seen_from(&attitude);
        let motion = Motion { attitude, momentum, advected, steps: 0 };
        State { motion, kept: self.plan.keep(&self.scene, &motion) }
    }

    /// A scene and a plan of one's own, folded for it; `examples/how-to-add-a-method.rs` has one.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] for a parameter of the scene that can't be used.
    pub fn with_plan(scene: S, plan: P) -> Result<Self, SetupError> {
        scene.validate()?;
        Ok(Self { scene, plan })
    }

    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &S {
        &self.scene
    }

    /// What was declared of each term of the scene, and everything derived from it, as text.
    #[must_use]
    pub fn derivation(&self) -> String {
        S::derivation()
    }

    /// The method, folded.
    #[must_use]
    pub fn plan(&self) -> &P {
        &self.plan
    }

    /// The step `h`, s.
    #[must_use]
    pub fn step_size(&self) -> Scalar<S> {
        self.plan.step_size()
    }

    /// The time since the start, `n h`, s; never accumulated.
    #[must_use]
    #[allow(clippy::cast_precision_loss)] // 2⁵³ steps take longer than a career
    pub fn time(&self, motion: &Motion<Group<S>, S::Advected>) -> Scalar<S> {
        self.step_size() * real(motion.steps as f64)
    }

    /// The body velocity, on SO(3) in rad/s.
    ///
    /// Where the continuous limit isn't quadratic in the velocity, a discrete momentum may be one that no velocity has,
    /// though the next step has a solution: the velocity is NaN then, of several lanes in those alone.
    /// Where the [scene](Self::scene) is a [`ContinuousLagrangian`](crate::mechanics::ContinuousLagrangian), its `velocity`
    /// says why, as an error. A [control force](Self::step_forced) and an event that are made of NaN are refused.
    #[must_use]
    pub fn velocity(&self, motion: &Motion<Group<S>, S::Advected>) -> Vector<S> {
        velocity_of_momentum(&self.scene, &motion.momentum, &motion.advected)
    }

    /// The energy of the continuous system, `½ Ω·JΩ + V(w)` where it is quadratic in the velocity, J; where there is no
    /// [`velocity`](Self::velocity) it is NaN, too.
    ///
    /// Where the scene is a [`DiscreteLagrangian`] it oscillates about its initial value, at the order of the scheme, and
    /// doesn't drift.
    #[must_use]
    pub fn energy(&self, motion: &Motion<Group<S>, S::Advected>) -> Scalar<S> {
        energy(&self.scene, &motion.momentum, &motion.advected)
    }

    /// The largest step from this state up to the stepper's own, s, to six digits: that fraction of it whose equations
    /// all have solutions. It is found by bisection, which takes some dozens of steps.
    #[must_use]
    pub fn max_step(&self, state: &StateOf<S, P>) -> Scalar<S> {
        self.plan.max_step(&self.scene, &state.motion, &state.kept)
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
    /// [`SetupError`] where the scene has no step of `−h`.
    pub fn inverse(&self) -> Result<Self, SetupError>
    where
        S: DiscreteLagrangian + Clone,
    {
        const {
            assert!(S::SELF_ADJOINT, "a step of -h undoes one of h only where l_d(F, w, h) = -l_d(F^-1, F^-1 w, -h)");
        }
        let plan = self.plan.refolded(&self.scene, -self.step_size())?;
        Ok(Self { scene: self.scene.clone(), plan })
    }

    /// The spatial momentum, `R Π` on SO(3), in a scene that conserves it: nothing is advected, though values may be given.
    #[must_use]
    pub fn spatial_momentum(&self, motion: &Motion<Group<S>, S::Advected>) -> Vector<S>
    where
        S: LeftInvariant,
    {
        motion.spatial_momentum()
    }

    /// The momentum along the advected vector, `Π·w` (`e₃·R Π` for the vertical), in a scene that conserves it: one
    /// vector is advected, (3.20).
    #[must_use]
    pub fn momentum_along_advected(&self, motion: &Motion<Group<S>, S::Advected>) -> Scalar<S>
    where
        S: AxiallyInvariant<Group = SO3<Scalar<S>>>,
    {
        motion.momentum.dot(&S::axis(&motion.advected))
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

    /// What is proved about the next step: whether it surely has a solution or surely has none, where bounds are known;
    /// see [`DiscreteLiePoisson::solvability`].
    #[must_use]
    pub fn solvability(&self, motion: &Motion<Group<S>, S::Advected>) -> Solvability {
        self.plan.solvability(&self.scene, &motion.momentum, &motion.advected)
    }
}

/// Each lane steps as the stepper that was put into it, to the bit: constants are gathered, not folded again.
impl<S: Effect + Lanes<Lane: Effect>, P: Lanes> Lanes for Stepper<S, P> {
    type Lane = Stepper<S::Lane, P::Lane>;

    fn splat(lane: &Self::Lane) -> Self {
        Self { scene: Lanes::splat(&lane.scene), plan: Lanes::splat(&lane.plan) }
    }

    fn lane(&self, k: usize) -> Self::Lane {
        Stepper { scene: self.scene.lane(k), plan: self.plan.lane(k) }
    }

    fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool {
        self.scene.set_lane(k, &lane.scene) && self.plan.set_lane(k, &lane.plan)
    }
}

impl<W, S, P> InLanes<W> for Stepper<S, P>
where
    S: Effect + InLanes<W, Together: Effect>,
    P: InLanes<W>,
{
    type Together = Stepper<S::Together, P::Together>;
}

/// Whether a motion may start here.
pub(crate) fn check_attitude<G: LieGroup>(attitude: &G) -> Result<(), SetupError> {
    // What a unit quaternion or a matrix printed to a dozen digits leaves; NaN fails it too.
    let allowed = G::Scalar::simd_default_epsilon() * real(1e4);
    let defect = attitude.defect();
    if defect.simd_le(allowed).all() { Ok(()) } else { Err(SetupError::NotInGroup { defect: reported(defect) }) }
}

/// A step of this state.
struct Step<'a, S: Effect, P: Plan<S>>(&'a Stepper<S, P>, &'a mut StateOf<S, P>);

impl<S: Effect, P: Plan<S>> Kernel for Step<'_, S, P> {
    type Output = Result<StepReport, StepError>;
    const VECTORS: Vectors = P::VECTORS;

    #[hot]
    fn run(self) -> Self::Output {
        self.0.plan.step(&self.0.scene, &mut self.1.motion, &mut self.1.kept)
    }
}
