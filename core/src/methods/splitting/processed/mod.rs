//! Processed splittings: the steps of a kernel, conjugated by a processor.

mod inside;
mod linearised;
mod scheme;

pub use inside::Inside;
pub use scheme::ProcessedScheme;

use alloc::vec::Vec;

use inside::InsideMotion;

use super::scheme::Flow;
use super::{KineticFlow, Length, Splitting, Stages, has_force_gradient, share_of};
use crate::error::{SetupError, StepError};
use crate::groups::{Advected, SO3};
use crate::mechanics::{DiscreteLagrangian, Effect, Regular, RigidScene, Scalar, SceneVisitor, Term};
use crate::motion::{Cost, Motion, OwnStep, Plan, PlanFacts, Steerable, Stepper, Summation};
use crate::numbers::{Coordinates, Real, real};
use nalgebra::{SimdBool as _, SimdComplexField as _, SimdPartialOrd as _, Vector3};

/// The plan of [`Stepper::processed`](crate::Stepper::processed): a kinetic-potential splitting whose steps are made inside of a processor, so that three drifts give order 6.
///
/// With the kernel `K_h` and the processor `χ_h` of a [`ProcessedScheme`] the motion after `n` steps is
///
/// ```text
/// χ_h K_hⁿ χ_h⁻¹
/// ```
///
/// The kernel's motion continues from step to step. Each output applies `χ_h` to a copy and leaves the kernel's motion
/// unchanged. So a run of many steps ([`Stepper::run`](crate::Stepper::run)) costs the kernel's steps, and the
/// processor once; single steps apply `χ_h` each time, which costs as much as one to two steps.
///
/// # Invariants
///
/// The invariants are those of [`Splitting`]: every stage, including the processor's, is a Poisson map that conserves
/// the momentum maps. A step of `−h` undoes one of `h`, because both have the processor of `|h|`.
///
/// # Contract
///
/// The contract is that of [`Stepper`](crate::Stepper). Single steps and runs have identical bits. A control force acts
/// on the output, and the next step applies the inverse processor to it; after a push of one lane it does so for all
/// lanes. A body that was stepped by another `h` can't share a [`Batch`](crate::motion::Batch) with bodies whose
/// kernel's motion is known.
///
/// # Examples
///
/// ```
/// use liestep::effects::{Gravity, PrincipalBody};
/// use liestep::mechanics::{DiagonalNonstandardInertia, Inertia};
/// use liestep::methods::{ExactBody, ProcessedScheme};
/// use liestep::{SO3, Stepper};
/// use nalgebra::{UnitQuaternion, Vector3};
///
/// let moments = Vector3::new(1.6, 2.6, 3.0);
/// let body = PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(moments)? };
/// let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.1, 0.2, 0.3), up: Vector3::z() };
/// let flow = ExactBody::new(&Inertia::from_principal_moments(moments)?);
/// let stepper = Stepper::processed(body + gravity, 0.05, flow, ProcessedScheme::SIX_A)?;
/// let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
/// let mut state = stepper.start(attitude, Vector3::new(0.5, 2.0, 3.0))?;
/// let energy: f64 = stepper.energy(&state);
/// stepper.run(&mut state, 200)?;
/// assert!((stepper.energy(&state) - energy).abs() < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Source
///
/// \[BCR99\], \[BCM06\]; see [`conventions`](crate::conventions).
#[derive(Clone, Debug, Lanes, InLanes)]
pub struct ProcessedSplitting<S: Effect, K: KineticFlow<Scalar<S>>> {
    #[shared]
    scheme: ProcessedScheme,
    /// The shares of [`leave`](Self::leave); in reverse and with opposite signs those of [`enter`](Self::enter).
    #[shared]
    parts: Vec<Part>,
    kernel: Splitting<S, K>,
    /// The stages from the output to the end of the kernel's first share, where all steps of the kernel begin.
    enter: Stages<K::Drift, Scalar<S>>,
    /// The stages from the end of the kernel's first share to the output.
    leave: Stages<K::Drift, Scalar<S>>,
}

/// # Make: a processed splitting
impl<S: Effect> Stepper<S> {
    /// A processed kinetic-potential splitting with this flow of the free body; see [`ProcessedSplitting`].
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::split`].
    pub fn processed<K>(
        scene: S,
        h: Scalar<S>,
        flow: K,
        scheme: ProcessedScheme,
    ) -> Result<Stepper<S, ProcessedSplitting<S, K>>, SetupError>
    where
        S: DiscreteLagrangian<Group = SO3<<S as Term>::Scalar>> + Regular,
        K: KineticFlow<Scalar<S>>,
    {
        // The own step's plan is constructed only to check the scene and the step.
        OwnStep::new(&scene, h)?;
        let plan = ProcessedSplitting::new(&scene, h, flow, scheme)?;
        Ok(Stepper { scene, plan })
    }
}

/// A drift or a kick as a multiple of the kernel's step and of the processor's, which has no sign; its force gradient
/// likewise.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    flow: Flow,
    time: [f64; 2],
    gradient: [f64; 2],
}

impl Part {
    fn has_gradient(&self) -> bool {
        self.gradient.iter().any(|gradient| gradient.abs() > 0.0)
    }

    /// The length for a step and a processor, multiplied by `times`.
    fn length<T: Real>(&self, [step, processor]: [T; 2], times: f64) -> Length<T> {
        let time = step * real(times * self.time[0]) + processor * real(times * self.time[1]);
        let cubes = [step, processor].map(|h| h * h * h);
        let gradient = cubes[0] * real(times * self.gradient[0]) + cubes[1] * real(times * self.gradient[1]);
        Length { flow: self.flow, time, gradient: self.has_gradient().then_some(gradient) }
    }
}

/// The shares from the kernel's motion to the output: the end of the kernel's step, then the processor. Neighbours of
/// one kind are merged.
fn way_out(scheme: &ProcessedScheme) -> Vec<Part> {
    let kernel = scheme.kernel();
    let back = kernel.shares().zip(kernel.gradients()).take(1).map(|((flow, share), gradient)| Part {
        flow,
        time: [-share, 0.0],
        gradient: [-gradient, 0.0],
    });
    let processor =
        scheme.processor().map(|(flow, share, gradient)| Part { flow, time: [0.0, share], gradient: [0.0, gradient] });
    let mut parts: Vec<Part> = Vec::new();
    for part in
        back.chain(processor).filter(|part| part.has_gradient() || part.time.iter().any(|time| time.abs() > 0.0))
    {
        match parts.last_mut().filter(|last| last.flow == part.flow) {
            Some(last) => {
                for k in 0..2 {
                    last.time[k] += part.time[k];
                    last.gradient[k] += part.gradient[k];
                }
            }
            None => parts.push(part),
        }
    }
    parts
}

impl<S: RigidScene, K: KineticFlow<Scalar<S>>> ProcessedSplitting<S, K> {
    fn new(scene: &S, h: Scalar<S>, kinetic: K, scheme: ProcessedScheme) -> Result<Self, SetupError> {
        let kernel = Splitting::folded(scene, h, kinetic, scheme.kernel())?;
        let parts = way_out(&scheme);
        // The kernel's own force gradients were checked with the kernel.
        if parts.iter().any(Part::has_gradient) && !has_force_gradient(scene) {
            return Err(SetupError::NoForceGradient);
        }
        let folded = |part: &Part, sign: f64| {
            share_of(&kernel.kinetic, &kernel.inverse_inertia, part.length([h, h.simd_abs()], sign))
        };
        let leave = parts.iter().map(|part| folded(part, 1.0)).collect::<Result<_, _>>()?;
        let enter = parts.iter().rev().map(|part| folded(part, -1.0)).collect::<Result<_, _>>()?;
        Ok(Self { scheme, parts, kernel, enter, leave })
    }

    /// The coefficients.
    #[must_use]
    pub fn scheme(&self) -> &ProcessedScheme {
        &self.scheme
    }

    /// The kernel's motion, if it was left by steps of this length.
    #[hot]
    fn inside(&self, kept: &Inside<Scalar<S>, S::Advected>) -> Option<InsideMotion<Scalar<S>, S::Advected>> {
        kept.0.filter(|inside| inside.h.simd_eq(self.kernel.h).all())
    }
}

/// A step with prescribed parameters applies the processor and its inverse with them.
impl<S: RigidScene, K: KineticFlow<Scalar<S>>> Steerable<S> for ProcessedSplitting<S, K> {
    /// The kernel's motion was computed with the old values, so it is discarded.
    fn see(&self, motion: &mut Motion<SO3<Scalar<S>>, S::Advected>, kept: &mut Self::Kept, advected: S::Advected) {
        *kept = Inside(None);
        motion.advected = advected;
    }
}

impl<S: RigidScene, K: KineticFlow<Scalar<S>>> Plan<S> for ProcessedSplitting<S, K> {
    type Kept = Inside<Scalar<S>, S::Advected>;

    const FACTS: PlanFacts = <Splitting<S, K> as Plan<S>>::FACTS;

    fn step_size(&self) -> Scalar<S> {
        self.kernel.h
    }

    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        Self::new(scene, h, self.kernel.kinetic.clone(), self.scheme)
    }

    /// The kernel's motion isn't known before the first step.
    fn keep(&self, _: &S, _: &Motion<SO3<Scalar<S>>, S::Advected>) -> Self::Kept {
        Inside(None)
    }

    #[hot]
    fn run<M: Summation<SO3<Scalar<S>>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        steps: u64,
    ) -> Result<u64, StepError> {
        if steps == 0 {
            return Ok(0);
        }
        let (mut next, mut iterations) = (*motion, 0);
        let inside = self.inside(kept);
        let enter = if inside.is_some() { None } else { Some(&self.enter) };
        if let Some(inside) = inside {
            next.show(inside.after(next.now().steps));
        }
        let all = self.kernel.make_steps::<true, M>(scene, &mut next, (enter, &self.kernel.step), steps)?;
        // A copy without the compensation of the sums, which belongs to the kernel's motion.
        let inside = *next.now();
        let mut read = inside;
        self.kernel.make_all::<true, _>(&self.leave, &mut read, &mut iterations)?;
        if !(Coordinates::is_finite(&read.momentum) && Advected::is_finite(&read.advected)) {
            return Err(self.kernel.why_not_finite(&motion.now().momentum));
        }
        next.show(read);
        (*motion, kept.0) = (next, Some(InsideMotion::of(&inside, self.kernel.h)));
        Ok(all + u64::from(iterations))
    }

    /// After a push the kernel's motion is obsolete. An impulse of zero isn't added, because the compensation belongs
    /// to the kernel's sums.
    fn push<M: Summation<SO3<Scalar<S>>, S::Advected>>(
        &self,
        _scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        impulse: &Vector3<Scalar<S>>,
    ) {
        if !impulse.iter().all(|part| part.simd_eq(real(0.0)).all()) {
            motion.push(impulse);
            kept.0 = None;
        }
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        visitor.term(self.scheme.name());
        for (_, share, gradient) in self.scheme.processor() {
            visitor.parameter("processor", real(share));
            visitor.parameter("gradient", real(gradient));
        }
        self.kernel.describe(visitor);
    }

    fn cost(&self) -> Cost {
        let [enter, leave] = [&self.enter, &self.leave].map(Splitting::<S, K>::operations);
        Cost { once: enter + leave, ..self.kernel.cost() }
    }
}
