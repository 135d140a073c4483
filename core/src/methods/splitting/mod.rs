//! Kinetic-potential splittings: the free body's motion and the potential's kicks by turns.

mod angle;
mod bias;
mod kick;
mod kinetic_flow;
mod preprocessed_flow;
mod scheme;
mod spin;
mod split_body;

pub(crate) use kick::{has_force_gradient, torque};
pub(crate) use kinetic_flow::inverse_inertia;
pub use kinetic_flow::{DeclaredDrift, KineticFlow, SymmetricBody, SymmetricDrift, Turn};
pub use preprocessed_flow::{PreprocessedDrift, PreprocessedFlow};
pub use scheme::{Flow, SplittingScheme};
pub use split_body::{SplitBody, SplitDrift};

use crate::error::{SetupError, StepError};
use crate::groups::{Advected, LieGroup as _, SO3};
use crate::mechanics::{DiscreteLagrangian, Regular, energy, velocity_of_momentum};
use crate::motion::{LOOKS, State, StepReport, Stepper};
use crate::numbers::{Coordinates, Real, real, reported};
use nalgebra::{Matrix3, SimdBool as _, Vector3};

/// An integrator for a body on SO(3) under a potential: `l_d = K(F) − (h/2) (V(w) + V(F⁻¹·w))` with its step in shares.
///
/// The shares `a_i` and `b_i` of a [`SplittingScheme`] go to the kinetic flow over `a_i h` and to kicks
/// `p ← p + b_i h τ(w)` by turns. The kinetic part of the declared Lagrangian is replaced by a [`KineticFlow`], exact
/// for a symmetric body or declared with a higher order; that part makes nearly all of the error of (3.13). Every stage
/// is a Poisson map that keeps the momentum maps, so the step is. Schemes with force gradients add to a kick a share of
/// `−½ τ·J⁻¹τ`, the potential's commutator with the kinetic energy, whose torque is derived as `τ` is; with them two to
/// five flows reach an order that takes six to fourteen without.
///
/// # Contract
///
/// As [`Stepper`]'s. Neighbouring flows of one kind are one flow: over many steps ([`advance`](Self::advance)) the last
/// of a step and the first of the next are made together.
///
/// # Examples
///
/// ```
/// use liestep::{Inertia, SO3, Splitting, SplittingScheme, SymmetricBody, lagrangian};
/// use nalgebra::{UnitQuaternion, Vector3};
///
/// /// A heavy top.
/// #[lagrangian(
///     group = SO3,
///     advected(w = up),
///     l_d = {
///         let xi = log(F);
///         xi.dot(&(J * xi)) / (2.0 * h) - 0.5 * h * weight * w.dot(&(rho + F * rho))
///     },
/// )]
/// #[derive(Clone)]
/// struct Top {
///     J: Inertia,
///     weight: f64,
///     rho: Vector3<f64>,
///     up: Vector3<f64>,
/// }
///
/// let J = Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0))?;
/// let top = Top { J, weight: 9.81, rho: Vector3::z(), up: Vector3::z() };
/// let splitting = Splitting::new(top, SymmetricBody::new(&J)?, 0.05, SplittingScheme::NYSTROM_11)?;
/// let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
/// let mut state = splitting.start(attitude, Vector3::new(0.5, 2.0, 12.0))?;
/// let energy = splitting.energy(&state);
/// splitting.advance(&mut state, 200)?;
/// assert!((splitting.energy(&state) - energy).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Source
///
/// \[BM02\], \[ML95\], \[BCF13\], with force gradients \[Ch97\], \[OMF02\]; see [`conventions`](crate::conventions).
#[derive(Clone, Debug)]
pub struct Splitting<L: DiscreteLagrangian<Group = SO3<T>, Scalar = T>, K: KineticFlow<T>, T: Real = f64> {
    scheme: SplittingScheme,
    /// Of the whole step; it starts motions.
    stepper: Stepper<L>,
    torque: L::Constants,
    /// `J⁻¹`, for force gradients.
    inverse_inertia: Matrix3<T>,
    kinetic: K,
    h: T,
    /// The first share of a step, which is the last one too.
    outer: Share<K::Drift, T>,
    inner: Vec<Share<K::Drift, T>>,
    /// The last share of a step and the first of the next.
    joint: Share<K::Drift, T>,
    /// What all the drifts of a step turn about the third body axis, in units of `p_3`, where that can be done at once.
    spin: Option<T>,
}

/// A share of the step, its constants folded.
#[derive(Clone, Debug)]
enum Share<D, T> {
    Drift(D),
    /// The time that the torque acts, s.
    Kick(T),
    /// And the inverse inertia times the share of the force gradient, s³/(kg m²).
    GradientKick(T, Matrix3<T>),
}

impl<T, L, K> Splitting<L, K, T>
where
    T: Real,
    L: DiscreteLagrangian<Scalar = T, Group = SO3<T>> + Regular,
    K: KineticFlow<T>,
{
    /// Checks that the Lagrangian can be split and that the flow is that of its body, and folds the constants of all
    /// the shares of the step `h`, in seconds.
    ///
    /// # Errors
    ///
    /// [`SetupError::NotSeparable`], [`SetupError::AnotherInertia`] and [`SetupError::AnotherBias`] where that isn't
    /// so; [`SetupError::NoForceGradient`] where the scheme asks for one and the scene was written without; otherwise
    /// as [`DiscreteLiePoisson::new`](crate::motion::DiscreteLiePoisson::new).
    pub fn new(lagrangian: L, kinetic: K, h: T, scheme: SplittingScheme) -> Result<Self, SetupError> {
        let stepper = Stepper::new(lagrangian, h)?;
        let inertia = stepper.lagrangian().inertia();
        let differences = (inertia - kinetic.inertia()).map(nalgebra::SimdComplexField::simd_abs);
        let difference = differences.fold(T::zero(), nalgebra::SimdPartialOrd::simd_max);
        if !difference.simd_le(inertia.trace() * T::simd_default_epsilon() * real(64.0)).all() {
            return Err(SetupError::AnotherInertia { difference: reported(difference) });
        }
        if !bias::is_shared(stepper.lagrangian(), &kinetic) {
            return Err(SetupError::AnotherBias);
        }
        let torque = torque(stepper.lagrangian())?;
        let inverse_inertia = inverse_inertia(stepper.lagrangian());
        if scheme.has_gradients() && !has_force_gradient(stepper.lagrangian()) {
            return Err(SetupError::NoForceGradient);
        }
        let share = |((flow, part), gradient): ((Flow, f64), f64)| -> Result<_, SetupError> {
            let time = h * real(part);
            Ok(match flow {
                Flow::Drift => Share::Drift(kinetic.drift(time)?),
                Flow::Kick if gradient == 0.0 => Share::Kick(time),
                Flow::Kick => Share::GradientKick(time, inverse_inertia * (h * h * h * real(gradient))),
            })
        };
        let all: Vec<_> = scheme.shares().zip(scheme.gradients()).collect();
        let ((flow, part), gradient) = all[0];
        let outer = share(((flow, part), gradient))?;
        let joint = share(((flow, 2.0 * part), 2.0 * gradient))?;
        let inner = all[1..all.len() - 1].iter().copied().map(share).collect::<Result<_, _>>()?;
        let mut splitting =
            Self { scheme, stepper, torque, inverse_inertia, kinetic, h, outer, inner, joint, spin: None };
        // A turn for itself costs about what three others save.
        let drifts = splitting.scheme.shares().filter(|(flow, _)| *flow == Flow::Drift).count();
        if drifts > 3 && splitting.is_without_torque() {
            splitting.take_spin();
        }
        Ok(splitting)
    }

    /// Whether no kick has a third component, to the last bit: then a rotation about the third axis doesn't change the
    /// potential.
    fn is_without_torque(&self) -> bool {
        spin::all_samples(self.stepper.lagrangian(), |w| {
            let torque: Vector3<T> = L::kick_before(&self.torque, w);
            let gradient = kick::force_gradient::<L>(&self.torque, &self.inverse_inertia, w);
            let gradient = gradient.filter(|_| self.scheme.has_gradients()).unwrap_or_else(Vector3::zeros);
            torque.z.simd_eq(T::zero()).all() && gradient.z.simd_eq(T::zero()).all()
        })
    }

    /// A potential that is symmetric about the third body axis commutes with rotations about it, and so does what else
    /// a symmetric body does; `p_3` is constant.
    fn take_spin(&mut self) {
        let (mut outer, mut joint, mut inner) = (self.outer.clone(), self.joint.clone(), self.inner.clone());
        let mut spin = T::zero();
        let shares = inner.iter_mut().map(|share| (share, 1.0));
        for (share, times) in shares.chain([(&mut outer, 2.0), (&mut joint, 0.0)]) {
            if let Share::Drift(drift) = share {
                let Some(taken) = K::take_spin(drift) else { return };
                spin += taken * real(times);
            }
        }
        (self.outer, self.joint, self.inner, self.spin) = (outer, joint, inner, Some(spin));
    }

    /// One step. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// [`StepError`] where an equation of the kinetic flow has no solution, or a value isn't finite.
    #[inline]
    pub fn step(&self, state: &mut State<SO3<T>, L::Advected>) -> Result<StepReport, StepError> {
        self.advance(state, 1)
    }

    /// So many steps, of which the states between aren't asked for. On an error the state is unchanged.
    ///
    /// The last drift of a step and the first of the next are made as one. Where the kinetic flow is exact the result is
    /// that of as many [steps](Self::step) to rounding; elsewhere they differ by some of its error. The iterations of the
    /// report are those of the last step.
    ///
    /// # Errors
    ///
    /// [`StepError`] where an equation of the kinetic flow has no solution, or a value isn't finite.
    pub fn advance(&self, state: &mut State<SO3<T>, L::Advected>, steps: u64) -> Result<StepReport, StepError> {
        let mut next = *state;
        let mut iterations = 0;
        if steps > 0 {
            self.make(&self.outer, &mut next, &mut iterations)?;
        }
        for remaining in (0..steps).rev() {
            iterations = 0;
            for share in &self.inner {
                self.make(share, &mut next, &mut iterations)?;
            }
            let last = if remaining == 0 { &self.outer } else { &self.joint };
            self.make(last, &mut next, &mut iterations)?;
            if let Some(spin) = self.spin {
                spin::turn(spin * next.momentum.z, &mut next);
            }
            next.steps += 1;
            if next.is_due() {
                if let Some(spin) = self.spin {
                    spin::make_good(spin * next.momentum.z, LOOKS, &mut next);
                }
                next.restore(&self.lagrangian().advected());
            }
        }
        if !(Coordinates::is_finite(&next.momentum) && Advected::is_finite(&next.advected)) {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        *state = next;
        Ok(StepReport { iterations, remedy: None })
    }

    #[inline(always)]
    fn make(
        &self,
        share: &Share<K::Drift, T>,
        state: &mut State<SO3<T>, L::Advected>,
        iterations: &mut u32,
    ) -> Result<(), StepError> {
        match share {
            Share::Kick(time) => state.momentum += L::kick_before(&self.torque, &state.advected) * *time,
            Share::GradientKick(time, mobility) => {
                let torque: Vector3<T> = L::kick_before(&self.torque, &state.advected);
                let gradient = kick::force_gradient::<L>(&self.torque, mobility, &state.advected);
                // That there is one was asked when the step was set up.
                state.momentum += torque * *time + gradient.unwrap_or_else(Vector3::zeros);
            }
            Share::Drift(drift) => {
                let turn = K::advance(drift, &state.momentum)?;
                state.attitude = state.attitude.advance(&turn.increment);
                state.advected = state.advected.advect(&turn.increment);
                state.momentum += turn.change;
                *iterations += turn.iterations;
            }
        }
        Ok(())
    }

    /// A motion from an attitude (body to space) and a body velocity, rad/s.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where the attitude isn't a rotation or something isn't finite.
    pub fn start(
        &self,
        attitude: impl Into<SO3<T>>,
        velocity: Vector3<T>,
    ) -> Result<State<SO3<T>, L::Advected>, SetupError> {
        self.stepper.start(attitude, velocity)
    }

    /// A motion from an attitude (body to space) and a body momentum, kg m²/s.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where the attitude isn't a rotation or something isn't finite.
    pub fn start_with_momentum(
        &self,
        attitude: impl Into<SO3<T>>,
        momentum: Vector3<T>,
    ) -> Result<State<SO3<T>, L::Advected>, SetupError> {
        self.stepper.start_with_momentum(attitude, momentum)
    }

    /// Whether the drifts' rotations about the third body axis are made at once, after the others of a step.
    pub(crate) fn has_spin_apart(&self) -> bool {
        self.spin.is_some()
    }

    /// The declared Lagrangian.
    #[must_use]
    pub fn lagrangian(&self) -> &L {
        self.stepper.lagrangian()
    }

    /// The kinetic flow.
    #[must_use]
    pub fn kinetic(&self) -> &K {
        &self.kinetic
    }

    /// The coefficients.
    #[must_use]
    pub fn scheme(&self) -> &SplittingScheme {
        &self.scheme
    }

    /// The step `h`, s.
    #[must_use]
    pub fn step_size(&self) -> T {
        self.h
    }

    /// The body velocity, rad/s.
    #[must_use]
    pub fn velocity(&self, state: &State<SO3<T>, L::Advected>) -> Vector3<T> {
        velocity_of_momentum(self.lagrangian(), &state.momentum, &state.advected)
    }

    /// The energy `½ Ω·JΩ + V(w)`, J; see [`Stepper::energy`].
    #[must_use]
    pub fn energy(&self, state: &State<SO3<T>, L::Advected>) -> T {
        energy(self.lagrangian(), &state.momentum, &state.advected)
    }
}
