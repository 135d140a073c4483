//! Gauss collocation in the quaternion and its momentum: the cheapest Poisson map for high accuracy.
//!
//! [`Candidates::and_gauss`](crate::accuracy::Candidates::and_gauss) makes it one of the methods to be chosen by accuracy, and
//! then finds the step.

mod coefficients;
mod lift;
mod stages;
mod state;

pub use state::GaussState;

use coefficients::Coefficients;
use lift::{Lift, Lifted, each, length_squared};
use stages::{Stages, WeightedRates};

use crate::error::{SetupError, StepError};
use crate::groups::{Advected as _, SO3};
use crate::mechanics::{DiscreteLagrangian, Regular, energy, velocity_of_momentum};
use crate::methods::splitting::torque;
use crate::numbers::{Work, at_best};

use crate::motion::{StepReport, Stepper};
use nalgebra::Vector3;

/// An integrator of order `4 PAIRS` for a body on SO(3) under a potential, by Gauss collocation with `2 PAIRS` stages.
///
/// The continuous Lagrangian `½ Ω·JΩ + s·Ω − V(w)` of the declared one, which must be `K(F) − (h/2) (V(w) + V(F⁻¹·w))`,
/// is integrated in the quaternion and its conjugate momentum. Of the declared `K` only the inertia `J` and the bias
/// `s` remain.
///
/// # What is kept
///
/// Gauss collocation is symplectic, commutes with linear maps, and keeps what is quadratic. Body momentum and advected
/// parameters are functions of quaternion and momentum with the Poisson brackets of the semidirect product, and what
/// else is in these, a turn about a symmetry of the parameters and `p ↦ p + λq`, is a linear symmetry. So the step is a
/// Poisson map of `(Π, w)`. Momentum maps are quadratic, hence kept to rounding: the momentum about the vertical, that
/// of a symmetric top about its axis. Attitudes are rotations and the parameters stay on their orbit by construction.
/// The energy isn't quadratic: its error is of the order of the method and doesn't drift. A step of `−h` undoes one of
/// `h`.
///
/// # What it costs
///
/// The stages are solved to rounding by fixed-point iteration, from the polynomial of the step before; each iteration
/// is `2 PAIRS` right-hand sides, computed several at once in SIMD lanes, by the instructions that the machine is found
/// to have: with AVX2, four at once, which makes 4 and 8 stages cheaper than others. That takes some 13 iterations
/// where a step turns the body by three quarters of a radian, 20 at one and a half, and doesn't converge much beyond.
/// So a coarse result isn't cheap, and a better one costs little more: it is the cheapest Poisson map for an asymmetric
/// top under gravity from an error of 10⁻⁴ on, over long times from the coarsest.
/// `cargo run --release --example accuracy-cost` measures it.
///
/// # Contract
///
/// As [`Stepper`]'s, for one `f64`. The sums over steps are compensated. The stages of the last step are part of the
/// state, so a copy goes on with the same bits.
///
/// # Examples
///
/// ```
/// use liestep::effects::{Gravity, RigidBody};
/// use liestep::{Gauss, SO3, Sum, lagrangian, NonstandardInertia};
/// use nalgebra::{UnitQuaternion, Vector3};
///
/// let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 1.5, 1.0))? };
/// let top = body + Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.1, 0.0, 1.0), up: Vector3::z() };
/// let gauss = Gauss::<_, 4>::new(top, 0.1)?;
/// let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
/// let mut state = gauss.start(attitude, Vector3::new(0.5, 2.0, 3.0))?;
/// let (energy, vertical) = (gauss.energy(&state), state.momentum_along(&Vector3::z()));
/// for _ in 0..1000 {
///     gauss.step(&mut state)?;
/// }
/// assert!((gauss.energy(&state) - energy).abs() < 1e-11);
/// assert!((state.momentum_along(&Vector3::z()) - vertical).abs() < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Source
///
/// \[HLW06\], theorems IV.2.2 and VI.4.2; \[AMM17\] for rounding; see [`conventions`](crate::conventions).
#[derive(Clone, Debug)]
pub struct Gauss<L: DiscreteLagrangian<Group = SO3, Scalar = f64>, const PAIRS: usize> {
    /// Of the same step; it starts motions.
    stepper: Stepper<L>,
    lift: Lift<L>,
    coefficients: Coefficients<PAIRS>,
    /// `h b_k`, of the first half of the stages and of their mirror images.
    weights: [[f64; PAIRS]; 2],
}

impl<L, const PAIRS: usize> Gauss<L, PAIRS>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular,
{
    /// Checks that the Lagrangian has a potential apart from its kinetic part, and folds the constants of the step `h`,
    /// in seconds.
    ///
    /// # Errors
    ///
    /// [`SetupError::NotSeparable`] where that isn't so; otherwise as
    /// [`DiscreteLiePoisson::new`](crate::motion::DiscreteLiePoisson::new).
    pub fn new(lagrangian: L, h: f64) -> Result<Self, SetupError> {
        const {
            assert!(
                PAIRS > 0 && PAIRS <= 8,
                "collocation needs a pair of stages, and doubles have no use for more than 8"
            );
        }
        let stepper = Stepper::new(lagrangian, h)?;
        let torque = torque(stepper.lagrangian())?;
        let lift = Lift::new(stepper.lagrangian(), torque);
        let coefficients = Coefficients::new();
        let weights = [coefficients.weights.map(|weight| h * weight); 2];
        Ok(Self { stepper, lift, coefficients, weights })
    }

    /// One step. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// [`StepError::NotConverged`] where the step is too long for the iteration, [`StepError::NonFinite`] where a value
    /// isn't finite.
    #[inline]
    pub fn step(&self, state: &mut GaussState<PAIRS>) -> Result<StepReport, StepError> {
        at_best(Step(self, state))
    }

    #[inline(always)]
    fn step_as_compiled(&self, state: &mut GaussState<PAIRS>) -> Result<StepReport, StepError> {
        let (y, carry) = (&state.lifted, &state.carry);
        let mut stages = match &state.stages {
            Some(stages) => stages.continued(&self.coefficients),
            None => Stages::constant(&self.lift.rate(y), &self.weights[0]),
        };
        let iterations = stages.solve(&self.coefficients, (y, carry), self)?;
        let (next, left) = compensated(y, &stages.change(), carry);
        if !next.iter().all(|component| component.is_finite()) {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        *state = GaussState { lifted: next, carry: left, stages: Some(stages), steps: state.steps + 1 };
        Ok(StepReport { iterations, remedy: None })
    }

    /// A motion from an attitude (body to space) and a body velocity, rad/s.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where the attitude isn't a rotation or something isn't finite.
    pub fn start(&self, attitude: impl Into<SO3>, velocity: Vector3<f64>) -> Result<GaussState<PAIRS>, SetupError> {
        self.stepper.start(attitude, velocity).map(Into::into)
    }

    /// A motion from an attitude (body to space) and a body momentum, kg m²/s.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where the attitude isn't a rotation or something isn't finite.
    pub fn start_with_momentum(
        &self,
        attitude: impl Into<SO3>,
        momentum: Vector3<f64>,
    ) -> Result<GaussState<PAIRS>, SetupError> {
        self.stepper.start_with_momentum(attitude, momentum).map(Into::into)
    }

    /// A step of the same Lagrangian by its own solve: what starts motions and reads states off.
    pub(crate) fn stepper(&self) -> &Stepper<L> {
        &self.stepper
    }

    /// The declared Lagrangian.
    #[must_use]
    pub fn lagrangian(&self) -> &L {
        self.stepper.lagrangian()
    }

    /// The step `h`, s.
    #[must_use]
    pub fn step_size(&self) -> f64 {
        self.stepper.step_size()
    }

    /// The advected parameters `w = g⁻¹ · a_0`.
    #[must_use]
    pub fn advected(&self, state: &GaussState<PAIRS>) -> L::Advected {
        self.lagrangian().advected().seen_from(&state.attitude())
    }

    /// The body velocity, rad/s.
    #[must_use]
    pub fn velocity(&self, state: &GaussState<PAIRS>) -> Vector3<f64> {
        velocity_of_momentum(self.lagrangian(), &state.momentum(), &self.advected(state))
    }

    /// The energy `½ Ω·JΩ + V(w)`, J; see [`Stepper::energy`].
    #[must_use]
    pub fn energy(&self, state: &GaussState<PAIRS>) -> f64 {
        energy(self.lagrangian(), &state.momentum(), &self.advected(state))
    }
}

impl<L, const PAIRS: usize> WeightedRates for Gauss<L, PAIRS>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3>,
{
    #[inline(always)]
    fn weighted_rate(&self, stage: usize, place: &Lifted) -> Lifted {
        let (weight, rate) = (self.weights.as_flattened()[stage], self.lift.rate(place));
        each(|component| weight * rate[component])
    }
}

/// A step of this state.
struct Step<'a, L: DiscreteLagrangian<Group = SO3, Scalar = f64>, const PAIRS: usize>(
    &'a Gauss<L, PAIRS>,
    &'a mut GaussState<PAIRS>,
);

impl<L, const PAIRS: usize> Work for Step<'_, L, PAIRS>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular,
{
    type Output = Result<StepReport, StepError>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        self.0.step_as_compiled(self.1)
    }
}

/// `y + (change + carry)` rounded, and what the rounding left behind, by Knuth's exact transformation.
///
/// The last change of the iteration, of the order of rounding, is an error of a sign of its own, which lengthens
/// quaternion and momentum by the same factor; in a million steps momentum maps would lose three digits to it. The
/// length of the quaternion is known, so both are brought back to it, by as little as rounding. With exact stages that
/// is no change.
#[inline(always)]
fn compensated(y: &Lifted, change: &Lifted, carry: &Lifted) -> (Lifted, Lifted) {
    let (mut next, mut left) = (*y, *carry);
    let shorten = 0.5 * (1.0 - length_squared(y)) - (0..4).map(|k| y[k] * carry[k]).sum::<f64>();
    for component in 0..8 {
        let (a, b) = (y[component], change[component] + (carry[component] + shorten * y[component]));
        let sum = a + b;
        let rounded = sum - a;
        left[component] = (a - (sum - rounded)) + (b - rounded);
        next[component] = sum;
    }
    (next, left)
}

#[cfg(test)]
mod tests {
    use super::{Gauss, Vector3};
    use crate::effects::{Gravity, RigidBody};
    use crate::groups::{LieGroup as _, SO3};
    use crate::mechanics::{NonstandardInertia, Sum};

    fn assert_same_digits<const PAIRS: usize>(top: Sum<RigidBody, Gravity>) {
        let gauss = Gauss::<_, PAIRS>::new(top, 0.05).unwrap();
        let mut state = gauss.start(SO3::identity(), Vector3::new(0.5, 2.0, 3.0)).unwrap();
        let mut as_compiled = state;
        for step in 0..1000 {
            let found = gauss.step(&mut state);
            assert_eq!(found, gauss.step_as_compiled(&mut as_compiled), "step {step}");
            assert_eq!(state, as_compiled, "{} stages, step {step}", 2 * PAIRS);
        }
    }

    /// Where the machine has more than the target's common instructions; elsewhere these are the same twice.
    #[test]
    fn the_instructions_of_the_machine_change_no_digit() {
        let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 1.5, 1.0)).unwrap() };
        let top = body + Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.1, 0.2, 1.0), up: Vector3::z() };
        assert_same_digits::<1>(top);
        assert_same_digits::<2>(top);
        assert_same_digits::<3>(top);
        assert_same_digits::<4>(top);
    }
}
