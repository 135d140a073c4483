//! Processed splittings: a kernel step by step, between the two ends of a processor.

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
use crate::motion::{Cost, Motion, OwnStep, Plan, Steerable, Stepper, Summation};
use crate::numbers::{Coordinates, Real, Vectors, real};
use nalgebra::{SimdBool as _, SimdComplexField as _, SimdPartialOrd as _, Vector3};

/// The plan of [`Stepper::processed`](crate::Stepper::processed): a kinetic-potential splitting whose steps are made inside of a processor, so that three drifts give order 6.
///
/// With the kernel `K_h` and the processor `χ_h` of a [`ProcessedScheme`] the motion after `n` steps is
///
/// ```text
/// χ_h K_hⁿ χ_h⁻¹
/// ```
///
/// The kernel's steps go on from one to the next inside; what is read is made of a copy, by `χ_h`, and what is inside
/// isn't changed by that. So a run of many steps ([`Stepper::run`](crate::Stepper::run)) costs the kernel's, and the
/// processor once; single steps make the end of the processor each time, which costs as much as one to two steps.
///
/// # What is kept
///
/// The same as by [`Splitting`]: every stage is a Poisson map that keeps the momentum maps, those of the processor, too. A
/// step of `−h` undoes one of `h`: the processor of both is that of `|h|`.
///
/// # Contract
///
/// As [`Stepper`](crate::Stepper)'s. Steps one by one and at once give the same bits. A control force acts on what is
/// read, and the next step goes inside from there; of several lanes all do, where one was pushed. A body that was stepped
/// by another `h` is in no [`Batch`](crate::motion::Batch) with those that are inside already.
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
    /// [`leave`](Self::leave)'s; reversed and with the other sign, [`enter`](Self::enter)'s.
    #[shared]
    parts: Vec<Part>,
    kernel: Splitting<S, K>,
    /// From what is read to the end of the first share of the kernel, from which its steps are all the same.
    enter: Stages<K::Drift, Scalar<S>>,
    /// From there to what is read.
    leave: Stages<K::Drift, Scalar<S>>,
}

/// # Make: a processed splitting
impl<S: Effect> Stepper<S> {
    /// A processed kinetic-potential splitting with this flow of the free body; see [`ProcessedSplitting`].
    ///
    /// # Errors
    ///
    /// As [`Stepper::split`].
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
        // For its checks of the scene and the step.
        OwnStep::new(&scene, h)?;
        let plan = ProcessedSplitting::new(&scene, h, flow, scheme)?;
        Ok(Stepper { scene, plan })
    }
}

/// A drift or a kick, as a part of the kernel's step and of the processor's, which has no sign, and so the gradient.
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

    /// The lengths of a step and a processor, `times` times.
    fn length<T: Real>(&self, [step, processor]: [T; 2], times: f64) -> Length<T> {
        let time = step * real(times * self.time[0]) + processor * real(times * self.time[1]);
        let cubes = [step, processor].map(|h| h * h * h);
        let gradient = cubes[0] * real(times * self.gradient[0]) + cubes[1] * real(times * self.gradient[1]);
        Length { flow: self.flow, time, gradient: self.has_gradient().then_some(gradient) }
    }
}

/// The way out: to the end of the kernel's step, and on through the processor. Neighbours of one kind are one.
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
        // The kernel's own were asked for with the kernel.
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

    /// What a step goes on from, if that was left there by steps of its own length.
    #[hot]
    fn inside(&self, kept: &Inside<Scalar<S>, S::Advected>) -> Option<InsideMotion<Scalar<S>, S::Advected>> {
        kept.0.filter(|inside| inside.h.simd_eq(self.kernel.h).all())
    }
}

/// A step that is given values goes in and out of the processor with them.
impl<S: Effect, K: KineticFlow<Scalar<S>>> Steerable for ProcessedSplitting<S, K> {}

impl<S: RigidScene, K: KineticFlow<Scalar<S>>> Plan<S> for ProcessedSplitting<S, K> {
    type Kept = Inside<Scalar<S>, S::Advected>;

    const VECTORS: Vectors = <Splitting<S, K> as Plan<S>>::VECTORS;

    fn step_size(&self) -> Scalar<S> {
        self.kernel.h
    }

    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        Self::new(scene, h, self.kernel.kinetic.clone(), self.scheme)
    }

    /// Nothing is known of the inside before the first step.
    fn keep(&self, _: &S, _: &Motion<SO3<Scalar<S>>, S::Advected>) -> Self::Kept {
        Inside(None)
    }

    /// A lane that comes from a step of another length has to enter, and those beside it that don't would lose digits.
    fn is_in_step(&self, kept: &Self::Kept) -> bool {
        kept.0.is_none_or(|inside| {
            let is_there = inside.h.simd_eq(self.kernel.h);
            is_there.all() || !is_there.any()
        })
    }

    const STEPS_BY_RUNS: bool = true;

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
        // A copy, without what is carried: that is of the sums inside.
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

    /// What is inside belongs to the momentum before. Without an impulse nothing is added: what is carried is that of the
    /// sums inside.
    fn push<M: Summation<SO3<Scalar<S>>, S::Advected>>(
        &self,
        _scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        impulse: &Vector3<Scalar<S>>,
    ) -> Result<(), StepError> {
        if !impulse.iter().all(|part| part.simd_eq(real(0.0)).all()) {
            motion.push(impulse);
            kept.0 = None;
        }
        Ok(())
    }

    /// What is inside has seen the values before.
    fn see(&self, motion: &mut Motion<SO3<Scalar<S>>, S::Advected>, kept: &mut Self::Kept, advected: S::Advected) {
        *kept = Inside(None);
        motion.advected = advected;
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
