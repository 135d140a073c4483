//! Gauss collocation in the quaternion and its momentum: the cheapest Poisson map for high accuracy.
//!
//! [`Stepper::for_accuracy`](crate::Stepper::for_accuracy) considers it among its methods, and finds the step.

mod coefficients;
mod cotangent;
mod lift;
mod settling;
mod stages;
mod state;

pub use coefficients::Coefficients;
pub use cotangent::{CotangentCarry, CotangentGauss};
pub use settling::{Changes, Next};
pub use state::CollocationMemory;

use lift::{Lift, PhasePoint, length_squared};
use stages::Stages;

use crate::error::{SetupError, StepError};
use crate::groups::SO3;
use crate::mechanics::{DiscreteLagrangian, Effect, Regular, RigidScene, SceneVisitor, constant_inertia};
use crate::methods::splitting::torque;
use crate::motion::{Cost, Motion, OwnStep, Plan, PlanFacts, Runs, Stepper, Summation, Variable};
use crate::numbers::{Vectors, two_sum};
use nalgebra::Vector3;

/// The plan of [`Stepper::collocated`](crate::Stepper::collocated), of order `4 PAIRS`, for a body on SO(3) under a potential, by Gauss collocation with `2 PAIRS` stages.
///
/// The declared Lagrangian must be `K(F) − (h/2) (V(w) + V(F⁻¹·w))`. Its continuous limit `½ Ω·JΩ + s·Ω − V(w)` is
/// integrated in the quaternion and its conjugate momentum; only the inertia `J` and the bias `s` of `K` enter.
///
/// # Invariants
///
/// Gauss collocation is symplectic, commutes with linear maps, and preserves quadratic invariants. Body momentum and
/// advected parameters are functions of quaternion and momentum with the Poisson brackets of the semidirect product.
/// The other coordinates change under linear symmetries: rotations about a symmetry axis of the parameters, and
/// `p ↦ p + λq`. So the step is a Poisson map of `(Π, w)`. Momentum maps are quadratic, hence conserved to rounding:
/// the momentum about the vertical, and that of a symmetric top about its axis. Attitudes are rotations and the
/// parameters stay on their orbit by construction. The energy isn't quadratic: its error is of the order of the method
/// and doesn't drift. A step of `−h` undoes one of `h`.
///
/// # Cost
///
/// The stages are solved to rounding by fixed-point iteration, with the previous step's polynomial as the initial
/// guess. Each iteration evaluates `2 PAIRS` right-hand sides in SIMD lanes, with the instructions detected on the
/// machine: four at once with AVX2, eight with AVX-512 if there are more than four stages. So 4 and 8 stages are
/// cheaper than other numbers. A step that turns the body by three quarters of a radian takes some 13 iterations, by
/// one and a half radians 20; a step much longer doesn't converge. So a coarse result isn't cheap, and a better one
/// costs little more. For an asymmetric top under gravity it is the cheapest Poisson map for errors of 10⁻⁴ and less,
/// over long times for all errors. `cargo run --release -p liestep-accuracy-cost --example accuracy-cost` measures it.
///
/// # Contract
///
/// The contract is that of [`Stepper`](crate::Stepper), for one `f64`. The sums over steps are compensated. The stages
/// of the last step are part of the state, so a copy continues with identical bits.
///
/// # Examples
///
/// ```
/// use liestep::effects::{Gravity, RigidBody};
/// use liestep::{NonstandardInertia, Stepper};
/// use nalgebra::{UnitQuaternion, Vector3};
///
/// let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 1.5, 1.0))? };
/// let top = body + Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.1, 0.0, 1.0), up: Vector3::z() };
/// let stepper = Stepper::collocated::<4>(top, 0.1)?;
/// let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
/// let mut state = stepper.start(attitude, Vector3::new(0.5, 2.0, 3.0))?;
/// let (energy, vertical) = (stepper.energy(&state), state.momentum_along(&Vector3::z()));
/// for _ in 0..1000 {
///     stepper.step(&mut state)?;
/// }
/// assert!((stepper.energy(&state) - energy).abs() < 1e-11);
/// assert!((state.momentum_along(&Vector3::z()) - vertical).abs() < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Source
///
/// \[HLW06\], theorems IV.2.2 and VI.4.2; \[AMM17\] for rounding; see [`conventions`](crate::conventions).
#[derive(Clone, Debug)]
pub struct Gauss<S: Effect, const PAIRS: usize> {
    h: f64,
    lift: Lift<S>,
    coefficients: Coefficients<PAIRS>,
    /// The products `h b_k` for the first half of the stages and for their mirror images.
    weights: [[f64; PAIRS]; 2],
}

/// # Make: collocation
impl<S: Effect> Stepper<S> {
    /// Gauss collocation with `2 PAIRS` stages, of order `4 PAIRS`; see [`Gauss`].
    ///
    /// # Errors
    ///
    /// [`SetupError::NotSeparable`] if the potential can't be separated from the kinetic part; otherwise the errors of
    /// [`Stepper::new`].
    pub fn collocated<const PAIRS: usize>(scene: S, h: f64) -> Result<Stepper<S, Gauss<S, PAIRS>>, SetupError>
    where
        S: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular,
    {
        const {
            assert!(
                PAIRS > 0 && PAIRS <= 8,
                "collocation needs a pair of stages, and doubles have no use for more than 8"
            );
        }
        // The own step's plan is constructed only to check the scene and the step.
        OwnStep::new(&scene, h)?;
        let plan = Gauss::new(&scene, h)?;
        Ok(Stepper { scene, plan })
    }
}

impl<S: RigidScene<Scalar = f64>, const PAIRS: usize> Gauss<S, PAIRS> {
    pub(crate) const COST: Cost = {
        #[allow(clippy::cast_precision_loss)] // at most eight
        let pairs = PAIRS as f64;
        // The operations of both kicks, with fitted factors (see below).
        let torque =
            if S::FACTS.parts.kick_before { OF_PARAMETERS + 0.125 * (S::FACTS.operations.step as f64) } else { 0.0 };
        let iteration = 2.0 * pairs * (OF_RATES + torque + OF_A_SUM * pairs);
        Cost { step: OF_AN_UPDATE + OF_A_GUESS * pairs * pairs, iteration, fewest: 3, once: 0.0 }
    };

    fn new(scene: &S, h: f64) -> Result<Self, SetupError> {
        constant_inertia(scene)?;
        let lift = Lift::new(scene, torque(scene)?);
        let coefficients = Coefficients::gauss();
        let weights = [coefficients.weights.map(|weight| h * weight); 2];
        Ok(Self { h, lift, coefficients, weights })
    }

    /// A step of quaternion and momentum; returns its iterations.
    #[inline(always)]
    fn advance(&self, kept: &mut CollocationMemory<PAIRS>) -> Result<u32, StepError> {
        let CollocationMemory { lifted: y, carry, stages } = &*kept;
        let mut stages = match stages {
            Some(stages) => stages.continued(&self.coefficients),
            None => Stages::constant(y, (&self.lift, &self.weights)),
        };
        let iterations = stages.solve(&self.coefficients, (y, carry), (&self.lift, &self.weights))?;
        let (next, left) = compensated(y, &stages.change(), carry);
        if !next.iter().all(|component| component.is_finite()) {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        *kept = CollocationMemory { lifted: next, carry: left, stages: Some(stages) };
        Ok(iterations)
    }

    /// The motion after this number of further steps.
    #[inline(always)]
    fn read_off<M: Summation<SO3, S::Advected>>(&self, motion: &mut M, kept: &CollocationMemory<PAIRS>, steps: u64) {
        let (attitude, momentum) = (kept.attitude(), kept.momentum());
        let advected = self.lift.seen_from(&attitude);
        motion.replace(Motion { attitude, momentum, advected, steps: motion.now().steps + steps });
    }
}

impl<S: RigidScene<Scalar = f64>, const PAIRS: usize> Variable<S> for Gauss<S, PAIRS> {}

impl<S: RigidScene<Scalar = f64>, const PAIRS: usize> Plan<S> for Gauss<S, PAIRS> {
    type Kept = CollocationMemory<PAIRS>;

    // Four stages fill four lanes; registers of eight would require shuffles.
    const FACTS: PlanFacts = PlanFacts {
        vectors: if PAIRS > 2 { Vectors::Eight } else { Vectors::Four },
        runs: Runs::AsSteps,
        ..PlanFacts::of::<S>()
    };

    fn step_size(&self) -> f64 {
        self.h
    }

    fn refolded(&self, scene: &S, h: f64) -> Result<Self, SetupError> {
        Self::new(scene, h)
    }

    fn keep(&self, _: &S, motion: &Motion<SO3, S::Advected>) -> Self::Kept {
        CollocationMemory::of(motion.attitude, &motion.momentum)
    }

    /// Attitude and momentum are computed from the quaternion only after the last step. The step fails with
    /// [`StepError::NotConverged`] if it is too long for the iteration.
    #[inline(always)]
    fn run<M: Summation<SO3, S::Advected>>(
        &self,
        _: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        steps: u64,
    ) -> Result<u64, StepError> {
        let mut iterations = 0;
        for _ in 0..steps {
            iterations += u64::from(self.advance(kept)?);
        }
        if steps > 0 {
            self.read_off(motion, kept, steps);
        }
        Ok(iterations)
    }

    fn push<M: Summation<SO3, S::Advected>>(
        &self,
        _scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        impulse: &Vector3<f64>,
    ) {
        motion.push(impulse);
        kept.push(impulse);
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term("Gauss");
        visitor.parameter("pairs of stages", crate::numbers::count(PAIRS));
    }

    fn cost(&self) -> Cost {
        Self::COST
    }
}

/// Operations of an iteration at each of its stages: for the rates of quaternion and momentum, for the parameters that
/// a torque depends on, and for each pair of stages in a sum. The unit is an operation of (3.13). The numbers are
/// fitted to times with AVX-512; `accuracy-cost -- --asked` reports whether they lead to the fastest choice.
const OF_RATES: f64 = 36.0;
const OF_PARAMETERS: f64 = 16.0;
const OF_A_SUM: f64 = 5.0;
/// Operations of a step besides its iterations, and those per pair of pairs in the initial guess.
const OF_AN_UPDATE: f64 = 33.0;
const OF_A_GUESS: f64 = 21.0;

/// The rounded sum `y + (change + carry)`, and its rounding error.
///
/// The last change of the iteration has an error of the order of rounding and of constant sign. The error scales
/// quaternion and momentum by the same factor, and over a million steps would cost momentum maps three digits. The
/// quaternion has length one, so both are rescaled to that, by a factor within rounding of one. Exact stages need no
/// correction.
#[inline(always)]
fn compensated(y: &PhasePoint, change: &PhasePoint, carry: &PhasePoint) -> (PhasePoint, PhasePoint) {
    let (mut next, mut left) = (*y, *carry);
    let shorten = 0.5 * (1.0 - length_squared(y)) - (0..4).map(|k| y[k] * carry[k]).sum::<f64>();
    for component in 0..8 {
        let change = change[component] + (carry[component] + shorten * y[component]);
        (next[component], left[component]) = two_sum(y[component], change);
    }
    (next, left)
}
