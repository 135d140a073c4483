//! Kinetic-potential splittings: the free body's motion and the potential's kicks in alternation.

mod axes;
mod exact_body;
mod kick;
mod kinetic_flow;
mod linearised;
mod processed;
mod quaternion;
mod scheme;
mod spin;

pub use exact_body::ExactBody;
pub(crate) use kick::{has_force_gradient, torque};
pub(crate) use kinetic_flow::inverse_inertia;
pub use kinetic_flow::{KineticFlow, SymmetricBody, Turn};
pub use linearised::DifferentiableFlow;
pub use processed::{Inside, ProcessedScheme, ProcessedSplitting};
pub use scheme::{Flow, SplittingScheme};

use alloc::vec::Vec;

use crate::error::{SetupError, StepError};
use crate::groups::{Advected, SO3};
use crate::mechanics::{
    DiscreteLagrangian, Effect, Operations, Regular, RigidScene, Scalar, SceneVisitor, Term, constant_inertia,
};
use crate::motion::{
    Cost, Motion, OwnStep, Plan, PlanFacts, Runs, STEPS_BETWEEN_CHECKS, Steerable, Stepper, Summation, Variable, is_due,
};
use crate::numbers::{Coordinates, Real, Vectors, count, largest_lane, real, reported};
use nalgebra::{
    Matrix3, SimdBool as _, SimdComplexField as _, SimdPartialOrd as _, SimdRealField as _, SimdValue, Vector3,
};

/// The plan of [`Stepper::split`](crate::Stepper::split), for a body on SO(3) under a potential: `l_d = K(F) − (h/2) (V(w) + V(F⁻¹·w))` with its step in shares.
///
/// The shares `a_i` and `b_i` of a [`SplittingScheme`] are the durations of the kinetic flow over `a_i h` and of kicks
/// `p ← p + b_i h τ(w)` in alternation. A [`KineticFlow`] replaces the kinetic part of the declared Lagrangian: it is
/// exact, or declared with a higher order. That part causes nearly all of the error of (3.13). Every stage is a Poisson
/// map that conserves the momentum maps, so the step is, too. A scheme with force gradients adds to a kick a share of
/// `−½ τ·J⁻¹τ`, the potential's commutator with the kinetic energy, whose torque is derived as `τ` is. With force
/// gradients two to five flows reach an order that takes six to fourteen without.
///
/// # Contract
///
/// The contract is that of [`Stepper`](crate::Stepper). Over many steps ([`Stepper::run`](crate::Stepper::run)) the
/// last flow of a step and the first of the next, being of one kind, are merged.
///
/// # Examples
///
/// ```
/// use liestep::effects::{Gravity, RigidBody};
/// use liestep::mechanics::Inertia;
/// use liestep::methods::{SplittingScheme, SymmetricBody};
/// use liestep::Stepper;
/// use nalgebra::{UnitQuaternion, Vector3};
///
/// let J = Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0))?;
/// let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
/// let top = RigidBody { J_d: J.to_nonstandard() } + gravity;
/// let stepper = Stepper::split(top, 0.05, SymmetricBody::new(&J)?, SplittingScheme::NYSTROM_11)?;
/// let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
/// let mut state = stepper.start(attitude, Vector3::new(0.5, 2.0, 12.0))?;
/// let energy: f64 = stepper.energy(&state);
/// stepper.run(&mut state, 200)?;
/// assert!((stepper.energy(&state) - energy).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Source
///
/// \[BM02\], \[ML95\], \[BCF13\], with force gradients \[Ch97\], \[OMF02\]; see [`conventions`](crate::conventions).
#[derive(Clone, Debug, Lanes, InLanes)]
pub struct Splitting<S: Effect, K: KineticFlow<Scalar<S>>> {
    #[shared]
    scheme: SplittingScheme,
    torque: S::Constants,
    /// The inverse inertia `J⁻¹`, for force gradients.
    inverse_inertia: Matrix3<Scalar<S>>,
    kinetic: K,
    h: Scalar<S>,
    /// The first share of a run.
    first: Stages<K::Drift, Scalar<S>>,
    /// A step from the end of its first share to the end of the next step's first share, which is merged with the last.
    step: Stages<K::Drift, Scalar<S>>,
    /// The stages from the end of the first share to the end of a run.
    last: Stages<K::Drift, Scalar<S>>,
    /// The sum of the [spins](KineticFlow::spin) of a step's drifts, if they commute with all its stages.
    spin: Option<Spin<Scalar<S>>>,
}

/// The rotation `exp(−s p_3 E_3)`, by its `s`.
#[derive(Clone, Copy, Debug, Lanes)]
struct Spin<T> {
    angle: T,
}

/// A share of the step, with its constants folded.
#[derive(Clone)]
enum Share<D, T> {
    Drift(D),
    Kick(Kick<T>),
}

/// Alternating shares in pairs: a drift and the kick after it compile to code without branches, in which the motion
/// stays in registers.
#[derive(Clone, Debug, Lanes)]
struct Stages<D, T> {
    /// The kick before the first drift, if the splitting begins with one.
    lead: Option<Kick<T>>,
    stages: Vec<Stage<D, T>>,
}

/// A drift, and the kick after it unless the drift is the last share.
#[derive(Clone, Debug, Lanes)]
struct Stage<D, T> {
    drift: D,
    kick: Option<Kick<T>>,
}

type StagesOf<S, K> = Stages<<K as KineticFlow<Scalar<S>>>::Drift, Scalar<S>>;

impl<D, T> FromIterator<Share<D, T>> for Stages<D, T> {
    fn from_iter<I: IntoIterator<Item = Share<D, T>>>(shares: I) -> Self {
        shares.into_iter().fold(Self { lead: None, stages: Vec::new() }, Self::and)
    }
}

impl<D, T> Stages<D, T> {
    /// Appends a share.
    fn and(mut self, share: Share<D, T>) -> Self {
        match share {
            Share::Drift(drift) => self.stages.push(Stage { drift, kick: None }),
            Share::Kick(kick) => {
                let place = self.stages.last_mut().map_or(&mut self.lead, |stage| &mut stage.kick);
                debug_assert!(place.is_none(), "drifts and kicks alternate");
                *place = Some(kick);
            }
        }
        self
    }
}

#[derive(Clone, Copy, Debug, Lanes)]
struct Kick<T> {
    /// The duration of the torque, s.
    time: T,
    /// The inverse inertia times the share of the force gradient, s³/(kg m²).
    mobility: Option<Matrix3<T>>,
}

/// # Make: a splitting
impl<S: Effect> Stepper<S> {
    /// A kinetic-potential splitting with this flow of the free body and the coefficients of a scheme; see [`Splitting`].
    ///
    /// # Errors
    ///
    /// [`SetupError::NotSeparable`], [`SetupError::VaryingInertia`], [`SetupError::InertiaMismatch`] and
    /// [`SetupError::BiasMismatch`] if the Lagrangian can't be split or the flow isn't that of its body;
    /// [`SetupError::NoForceGradient`] if the scheme has force gradients and the scene was declared without; otherwise
    /// the errors of [`Stepper::new`].
    pub fn split<K>(
        scene: S,
        h: Scalar<S>,
        flow: K,
        scheme: SplittingScheme,
    ) -> Result<Stepper<S, Splitting<S, K>>, SetupError>
    where
        S: DiscreteLagrangian<Group = SO3<<S as Term>::Scalar>> + Regular,
        K: KineticFlow<Scalar<S>>,
    {
        // The own step's plan is constructed only to check the scene and the step.
        OwnStep::new(&scene, h)?;
        let plan = Splitting::new(&scene, h, flow, scheme)?;
        Ok(Stepper { scene, plan })
    }
}

impl<S: RigidScene, K: KineticFlow<Scalar<S>>> Splitting<S, K> {
    fn new(scene: &S, h: Scalar<S>, kinetic: K, scheme: SplittingScheme) -> Result<Self, SetupError> {
        let mut splitting = Self::folded(scene, h, kinetic, scheme)?;
        // A separate spin costs about as much as three drifts save.
        let drifts = scheme.shares().filter(|(flow, _)| *flow == Flow::Drift).count();
        if drifts > 3 && splitting.is_without_torque(scene) {
            splitting.spin = splitting.spin_of_a_step();
        }
        Ok(splitting)
    }

    /// The splitting with the shares of its scheme; unlike `new`, without merged spins.
    fn folded(scene: &S, h: Scalar<S>, kinetic: K, scheme: SplittingScheme) -> Result<Self, SetupError> {
        let inertia = constant_inertia(scene)?;
        let differences = (inertia - K::inertia(&kinetic)).map(nalgebra::SimdComplexField::simd_abs);
        let difference = differences.fold(real(0.0), nalgebra::SimdPartialOrd::simd_max);
        if !difference.simd_le(inertia.trace() * Scalar::<S>::simd_default_epsilon() * real(64.0)).all() {
            return Err(SetupError::InertiaMismatch { difference: reported(difference) });
        }
        if !kick::has_bias_of_flow(scene, &kinetic) {
            return Err(SetupError::BiasMismatch);
        }
        let torque = torque(scene)?;
        let inverse_inertia = inverse_inertia(scene);
        if scheme.has_gradients() && !has_force_gradient(scene) {
            return Err(SetupError::NoForceGradient);
        }
        let all: Vec<_> = scheme.shares().zip(scheme.gradients()).collect();
        let share = |times: f64, share| share_of(&kinetic, &inverse_inertia, Length::of(h, times, share));
        let (outer, joint) = (share(1.0, all[0])?, share(2.0, all[0])?);
        let inner: Stages<_, _> =
            all[1..all.len() - 1].iter().map(|&inner| share(1.0, inner)).collect::<Result<_, _>>()?;
        let (first, step, last) = (Stages::from_iter([outer.clone()]), inner.clone().and(joint), inner.and(outer));
        Ok(Self { scheme, torque, inverse_inertia, kinetic, h, first, step, last, spin: None })
    }

    /// Whether the third component of every kick is zero to the bit, so that a rotation about the third axis doesn't
    /// change the potential.
    fn is_without_torque(&self, scene: &S) -> bool {
        spin::all_samples(scene, |w| {
            let torque: Vector3<Scalar<S>> = S::kick_before(&self.torque, w);
            let gradient = kick::force_gradient::<S, false>(&self.torque, &self.inverse_inertia, w);
            let gradient = gradient.filter(|_| self.scheme.has_gradients()).unwrap_or_else(Vector3::zeros);
            torque.z.simd_eq(real(0.0)).all() && gradient.z.simd_eq(real(0.0)).all()
        })
    }

    /// The sum of a step's spins. A potential that is symmetric about the third body axis, and the rest of a symmetric
    /// body's drift, commute with rotations about that axis, and `p_3` is constant.
    fn spin_of_a_step(&self) -> Option<Spin<Scalar<S>>> {
        if K::OPERATIONS_OF_SPIN == 0 {
            return None;
        }
        let drifts = [&self.first, &self.last].into_iter().flat_map(|shares| &shares.stages);
        let angle = drifts.map(|stage| K::spin(&stage.drift)).try_fold(real(0.0), |all, spin| Some(all + spin?));
        angle.map(|angle| Spin { angle })
    }

    /// The reason why a step from this momentum has a result that isn't finite.
    #[cold]
    fn why_not_finite(&self, momentum: &Vector3<Scalar<S>>) -> StepError {
        // A drift may be longer than the step, or start with a larger momentum.
        const LEAST: f64 = 0.01;
        let velocity = self.inverse_inertia * momentum;
        let turn = largest_lane(Coordinates::dot(&velocity, &velocity).simd_sqrt() * self.h.simd_abs());
        if turn.is_finite() && turn * reported(Scalar::<S>::simd_default_epsilon()) > LEAST {
            return StepError::AngleWithoutDigits { turn };
        }
        StepError::NonFinite { what: "momentum after the step" }
    }

    /// The operations of shares that aren't merged, besides their iterations.
    fn operations(shares: &StagesOf<S, K>) -> f64 {
        let kick = 0.5 * f64::from(S::FACTS.operations.step);
        let kicks = shares.stages.iter().map(|stage| &stage.kick).chain([&shares.lead]).flatten();
        let of_kicks = kicks.map(|made| kick + made.mobility.map_or(0.0, |_| kick + OF_A_FORCE_GRADIENT));
        let drifts = count::<f64>(shares.stages.len());
        drifts * Cost::of_stages(K::OPERATIONS, 1).step + of_kicks.sum::<f64>()
    }

    /// The coefficients.
    #[must_use]
    pub fn scheme(&self) -> &SplittingScheme {
        &self.scheme
    }

    /// The kinetic flow.
    #[must_use]
    pub fn kinetic(&self) -> &K {
        &self.kinetic
    }

    #[hot]
    fn make_all<const WITH_SPIN: bool, M: Summation<SO3<Scalar<S>>, S::Advected>>(
        &self,
        shares: &StagesOf<S, K>,
        motion: &mut M,
        iterations: &mut u32,
    ) -> Result<(), StepError> {
        // The loop isn't a closure, because that wouldn't be compiled for the detected vector instructions.
        if let Some(kick) = &shares.lead {
            self.kick(kick, motion);
        }
        for Stage { drift, kick } in &shares.stages {
            Self::drift::<WITH_SPIN, M>(drift, motion, iterations)?;
            if let Some(kick) = kick {
                self.kick(kick, motion);
            }
        }
        Ok(())
    }

    /// The steps of a run, and their iterations. The run begins with the first shares, if there are any, and its last
    /// step ends with the last ones. `WITH_SPIN` includes spins in the drifts; otherwise a step has one spin at its
    /// end.
    #[hot]
    fn make_steps<const WITH_SPIN: bool, M: Summation<SO3<Scalar<S>>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        (mut first, last): (Option<&StagesOf<S, K>>, &StagesOf<S, K>),
        steps: u64,
    ) -> Result<u64, StepError> {
        let (mut all, mut iterations, mut made) = (0, 0, 0);
        // The beginning is inside of the loop, so that the code is compiled once.
        while made < steps {
            let shares = if made + 1 < steps { &self.step } else { last };
            self.make_all::<WITH_SPIN, M>(first.unwrap_or(shares), motion, &mut iterations)?;
            if first.take().is_some() {
                continue;
            }
            if let Some(Spin { angle }) = self.spin.filter(|_| !WITH_SPIN) {
                spin::turn(angle * motion.now().momentum.z, motion);
                if is_due::<SO3<Scalar<S>>>(motion.now().steps + 1) {
                    spin::make_good(angle * motion.now().momentum.z, STEPS_BETWEEN_CHECKS, motion);
                }
            }
            motion.finish(|| scene.advected());
            all += u64::from(core::mem::take(&mut iterations));
            made += 1;
        }
        Ok(all)
    }

    #[hot]
    fn drift<const WITH_SPIN: bool, M: Summation<SO3<Scalar<S>>, S::Advected>>(
        drift: &K::Drift,
        motion: &mut M,
        iterations: &mut u32,
    ) -> Result<(), StepError> {
        let momentum = motion.now().momentum;
        let turn = if WITH_SPIN { K::advance(drift, &momentum)? } else { K::advance_without_spin(drift, &momentum)? };
        motion.turn_and_push(&turn.increment, &turn.change);
        *iterations += turn.iterations;
        Ok(())
    }

    #[hot]
    fn kick<M: Summation<SO3<Scalar<S>>, S::Advected>>(&self, kick: &Kick<Scalar<S>>, motion: &mut M) {
        let advected = motion.now().advected;
        let torque: Vector3<Scalar<S>> = S::kick_before(&self.torque, &advected);
        let of_torque = torque * kick.time;
        // The gradient exists, because construction refuses a scene without it.
        let change = match &kick.mobility {
            Some(mobility) => {
                let gradient = if K::has_principal_axes(&self.kinetic) {
                    kick::force_gradient::<S, true>(&self.torque, mobility, &advected)
                } else {
                    kick::force_gradient::<S, false>(&self.torque, mobility, &advected)
                };
                of_torque + gradient.unwrap_or_else(Vector3::zeros)
            }
            None => of_torque,
        };
        motion.push(&change);
    }
}

impl<S: RigidScene, K: KineticFlow<Scalar<S>>> Steerable<S> for Splitting<S, K> {}
impl<S: RigidScene, K: KineticFlow<Scalar<S>>> Variable<S> for Splitting<S, K> {}

/// The length of a share.
#[derive(Clone, Copy, Debug)]
struct Length<T> {
    flow: Flow,
    /// The duration, s.
    time: T,
    /// The share of the force gradient in a kick that has one, s³.
    gradient: Option<T>,
}

impl<T: Real> Length<T> {
    /// A share of a step, and of the force gradient, multiplied by `times`.
    fn of(h: T, times: f64, ((flow, share), gradient): ((Flow, f64), f64)) -> Self {
        let gradient = (gradient != 0.0).then(|| h * h * h * real(times * gradient));
        Self { flow, time: h * real(times * share), gradient }
    }
}

/// A drift or a kick of this length.
fn share_of<T: Real, K: KineticFlow<T>>(
    kinetic: &K,
    inverse_inertia: &Matrix3<T>,
    Length { flow, time, gradient }: Length<T>,
) -> Result<Share<K::Drift, T>, SetupError> {
    Ok(match flow {
        Flow::Drift => Share::Drift(kinetic.drift(time)?),
        Flow::Kick => Share::Kick(Kick { time, mobility: gradient.map(|gradient| inverse_inertia * gradient) }),
    })
}

impl<S: RigidScene, K: KineticFlow<Scalar<S>>> Plan<S> for Splitting<S, K> {
    type Kept = ();

    /// A single body is faster by instructions with three operands, which save copies. A symmetric one, whose turn is
    /// short, is faster by more registers, too. For other bodies the widest registers are slower: the entries of an
    /// increment are packed and unpacked, and the next kick waits for that. Lanes in arrays are slower with the widest,
    /// too. `cargo bench -p liestep-lanes --bench vectors` compares all three.
    const FACTS: PlanFacts = PlanFacts {
        vectors: if <Scalar<S> as SimdValue>::LANES == 1 && K::OPERATIONS_OF_SPIN > 0 {
            Vectors::Eight
        } else {
            Vectors::Four
        },
        runs: Runs::AsSteps,
        ..PlanFacts::of::<S>()
    };

    fn step_size(&self) -> Scalar<S> {
        self.h
    }

    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        Self::new(scene, h, self.kinetic.clone(), self.scheme)
    }

    fn keep(&self, _: &S, _: &Motion<SO3<Scalar<S>>, S::Advected>) {}

    /// The last drift of a step and the first of the next are merged.
    #[hot]
    fn run<M: Summation<SO3<Scalar<S>>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        (): &mut (),
        steps: u64,
    ) -> Result<u64, StepError> {
        let (mut next, ends) = (*motion, (Some(&self.first), &self.last));
        let iterations = if const { K::OPERATIONS_OF_SPIN > 0 } && self.spin.is_some() {
            self.make_steps::<false, M>(scene, &mut next, ends, steps)?
        } else {
            self.make_steps::<true, M>(scene, &mut next, ends, steps)?
        };
        let end = next.now();
        if !(Coordinates::is_finite(&end.momentum) && Advected::is_finite(&end.advected)) {
            return Err(self.why_not_finite(&motion.now().momentum));
        }
        *motion = next;
        Ok(iterations)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        visitor.term(self.scheme.name());
        for ((_, share), gradient) in self.scheme.shares().zip(self.scheme.gradients()) {
            visitor.parameter("share", real(share));
            visitor.parameter("gradient", real(gradient));
        }
        K::describe(&self.kinetic, visitor);
    }

    fn cost(&self) -> Cost {
        let kicks: f64 = count(self.scheme.kicks());
        let kick = 0.5 * f64::from(S::FACTS.operations.step);
        let gradients = count::<f64>(self.scheme.gradient_kicks()) * (kick + OF_A_FORCE_GRADIENT);
        let Operations { step, iteration } = K::OPERATIONS;
        let (step, turn) = match self.spin {
            Some(_) => (step.saturating_sub(K::OPERATIONS_OF_SPIN), OF_A_TURN + f64::from(K::OPERATIONS_OF_SPIN)),
            None => (step, 0.0),
        };
        let drifts =
            Cost::of_stages(Operations { step, iteration }, u32::try_from(self.scheme.drifts()).unwrap_or(u32::MAX));
        Cost { step: drifts.step + kicks * kick + gradients + turn, ..drifts }
    }
}

/// Operations of a force gradient besides those of a second kick: products with `J⁻¹`, and the wait for the torque.
const OF_A_FORCE_GRADIENT: f64 = 120.0;
/// Cost of a separate rotation besides its own operations.
const OF_A_TURN: f64 = 150.0;
