//! Compensated summation: what rounding takes from a state's sums is kept and added to the next.
//!
//! A step adds small changes to the attitude, the momentum and the advected parameters: `R + R D`, `w + Dᵀ w`,
//! `p + (Dᵀ a + kicks)`. Each sum loses some `ε` of the state, and these losses walk at random; the changes themselves
//! are wrong by some `ε` of a change only. With the losses kept, what is left is the walk of the changes, smaller by
//! the angle of a step: at `h = 10⁻⁴` nothing is seen of it in 10⁷ steps, near a radian a step nothing is gained.

use crate::error::{SetupError, StepError};
use crate::groups::{Advected, LieGroup};
use crate::mechanics::{Effect, Group, Scalar, Vector};
use crate::motion::{State, StepReport, Stepper};
use crate::numbers::{Coordinates as _, Entries, Real, Work, at_best_in_lanes, nowhere, real, zero};
use crate::solving::Continued;
use nalgebra::SimdValue as _;

/// A [`Stepper`] with compensated sums, by [`Stepper::compensated`].
///
/// The step is the same map; only its rounding differs. `cargo bench` shows what it costs.
///
/// # Examples
///
/// ```
/// use liestep::{DiagonalNonstandardInertia, LieGroup, SO3, Stepper, lagrangian};
/// use nalgebra::Vector3;
///
/// /// A free rigid body.
/// #[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
/// struct Body {
///     J_d: DiagonalNonstandardInertia,
/// }
///
/// let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
/// let stepper = Stepper::new(Body { J_d }, 1e-4)?.compensated();
/// let mut state = stepper.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02))?;
/// for _ in 0..1000 {
///     stepper.step(&mut state)?;
/// }
/// assert!(state.state().orthogonality_defect() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct CompensatedStepper<L: Effect> {
    stepper: Stepper<L>,
}

/// A [`State`] and what the rounding of its sums has left behind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompensatedState<G: LieGroup, A: Advected<G>> {
    pub(crate) state: State<G, A>,
    pub(crate) carry: Carry<G, A>,
}

/// The exact sums less the rounded ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Carry<G: LieGroup, A: Advected<G>> {
    pub(crate) attitude: G::Matrix,
    pub(crate) momentum: G::Vector,
    pub(crate) advected: A,
}

impl<G: LieGroup, A: Advected<G>> CompensatedState<G, A> {
    /// The state, rounded.
    #[must_use]
    pub fn state(&self) -> &State<G, A> {
        &self.state
    }
}

impl<G: LieGroup, A: Advected<G>> From<State<G, A>> for CompensatedState<G, A> {
    fn from(state: State<G, A>) -> Self {
        Self { state, carry: Carry { attitude: zero(), momentum: zero(), advected: zero() } }
    }
}

impl<L: Effect> Stepper<L> {
    /// The same step with compensated summation.
    #[must_use]
    pub fn compensated(self) -> CompensatedStepper<L> {
        CompensatedStepper { stepper: self }
    }
}

impl<L: Effect> CompensatedStepper<L> {
    /// The stepper without compensation, for what can be read off a state.
    #[must_use]
    pub fn stepper(&self) -> &Stepper<L> {
        &self.stepper
    }

    /// As [`Stepper::start`].
    ///
    /// # Errors
    ///
    /// As [`Stepper::start`].
    pub fn start(
        &self,
        attitude: impl Into<Group<L>>,
        velocity: Vector<L>,
    ) -> Result<CompensatedState<Group<L>, L::Advected>, SetupError> {
        self.stepper.start(attitude, velocity).map(Into::into)
    }

    /// As [`Stepper::start_with_momentum`].
    ///
    /// # Errors
    ///
    /// As [`Stepper::start_with_momentum`].
    pub fn start_with_momentum(
        &self,
        attitude: impl Into<Group<L>>,
        momentum: Vector<L>,
    ) -> Result<CompensatedState<Group<L>, L::Advected>, SetupError> {
        self.stepper.start_with_momentum(attitude, momentum).map(Into::into)
    }

    /// One step. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// As [`Stepper::step`].
    #[inline]
    pub fn step(&self, state: &mut CompensatedState<Group<L>, L::Advected>) -> Result<StepReport, StepError> {
        at_best_in_lanes::<Scalar<L>, _>(Step(self, state))
    }

    #[inline(always)]
    fn step_as_compiled(&self, state: &mut CompensatedState<Group<L>, L::Advected>) -> Result<StepReport, StepError> {
        let CompensatedState { state: now, carry } = state;
        let flow = self.stepper.flow();
        if flow.step_size() == real(0.0) {
            now.proceed(zero(), nowhere::<Scalar<L>>(), Continued::for_jacobian(L::JACOBIAN_IS_DEAR), || {
                self.stepper.lagrangian().advected()
            });
            return Ok(StepReport { iterations: 0, remedy: None });
        }
        let solved = flow.solve(&now.momentum, &now.advected, &now.guess())?;
        let increment = &solved.root.increment;
        let advected = sum(&now.advected, &now.advected.change(increment), &carry.advected);
        // The kicks are added for themselves: in `a` they are rounded to the digits of the momentum.
        let change = Group::<L>::adjoint_transpose_increment(increment, &solved.a)
            + flow.kicks(&now.advected, increment, &advected.0, &solved.root.kick);
        let momentum = sum(&now.momentum, &change, &carry.momentum);
        if !momentum.0.is_finite() || !advected.0.is_finite() {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        let attitude = sum(&now.attitude.matrix(), &now.attitude.change(increment), &carry.attitude);
        *carry = Carry { attitude: attitude.1, momentum: momentum.1, advected: advected.1 };
        now.attitude = Group::<L>::from_matrix_unchecked(attitude.0);
        now.momentum = momentum.0;
        now.advected = advected.0;
        let root = &solved.root;
        // What is carried belongs to the state before.
        let restored = now.proceed(root.half, root.far, Continued::for_jacobian(L::JACOBIAN_IS_DEAR), || {
            self.stepper.lagrangian().advected()
        });
        if let Some(far) = restored {
            let mut kept = |carry: Scalar<L>, nothing: Scalar<L>| nothing.select(far, carry);
            carry.attitude = carry.attitude.zip(&zero(), &mut kept);
            carry.advected = carry.advected.zip(&zero(), &mut kept);
        }
        Ok(StepReport { iterations: solved.root.iterations, remedy: None })
    }
}

/// A step of this state.
struct Step<'a, L: Effect>(&'a CompensatedStepper<L>, &'a mut CompensatedState<Group<L>, L::Advected>);

impl<L: Effect> Work for Step<'_, L> {
    type Output = Result<StepReport, StepError>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        self.0.step_as_compiled(self.1)
    }
}

/// `a + (b + carry)` rounded, and what the rounding left behind.
///
/// By Knuth's exact transformation, which asks for no order of the sizes: components pass through zero. A stage at a
/// time, as all places go through each side by side.
#[inline(always)]
fn sum<T: Real, E: Entries<T>>(a: &E, b: &E, carry: &E) -> (E, E) {
    let b = b.zip(carry, &mut |b, carry| b + carry);
    let sum = a.zip(&b, &mut |a, b| a + b);
    let rounded = sum.zip(a, &mut |sum, a| sum - a);
    let lost_of_a = a.zip(&sum.zip(&rounded, &mut |sum, b| sum - b), &mut |a, rest| a - rest);
    let lost_of_b = b.zip(&rounded, &mut |b, rounded| b - rounded);
    (sum, lost_of_a.zip(&lost_of_b, &mut |a, b| a + b))
}
