//! The integrators behind one interface, with the arithmetic that their steps are.

use crate::error::{SetupError, StepError};
use crate::groups::{Advected, LieGroup, SO3};
use crate::mechanics::{DiscreteLagrangian, Effect, Group, Operations, Regular, Vector};
use crate::methods::{Composition, Gauss, GaussState, KineticFlow, PreprocessedBody, PreprocessedFlow, Splitting};
use crate::motion::{State, Stepper};

/// Besides what an effect counts, a solve and its reconstruction make so many operations on SO(3).
const OF_A_STAGE: f64 = 150.0;
/// Besides the Newton system, an iteration solves it and looks whether it has settled. These wait for each other, as
/// the products of matrices don't.
const OF_AN_ITERATION: f64 = 90.0;

/// What a force gradient takes besides another kick: products with `J⁻¹`, and that the torque is waited for.
const OF_A_FORCE_GRADIENT: f64 = 120.0;

/// An iteration of collocation makes so many at each of its stages: for the rates of quaternion and momentum, for the
/// parameters that a torque depends on, and for each pair of stages that is summed over. Two stages in SIMD lanes count
/// as one, here and below.
const OF_RATES: f64 = 75.0;
const OF_PARAMETERS: f64 = 35.0;
const OF_A_SUM: f64 = 10.0;
/// Besides its iterations, a step of collocation makes so many, and so many for each pair of pairs in its guess.
const OF_AN_UPDATE: f64 = 50.0;
const OF_A_GUESS: f64 = 32.0;

/// An integrator of a fixed step.
pub(super) trait Method<G: LieGroup, A: Advected<G>> {
    /// The state that a motion starts from.
    fn start(&self, attitude: G, velocity: G::Vector) -> Result<State<G, A>, SetupError>;

    /// Makes so many steps, and says how many operations they were, about. On an error the state is anywhere.
    fn advance(&self, state: &mut State<G, A>, steps: u64) -> Result<f64, StepError>;

    /// As [`advance`](Self::advance) by one; on an error the state is unchanged.
    fn step(&self, state: &mut State<G, A>) -> Result<crate::motion::StepReport, StepError>;

    fn velocity(&self, state: &State<G, A>) -> G::Vector;

    fn energy(&self, state: &State<G, A>) -> f64;
}

/// So many stages with so many iterations in all.
#[allow(clippy::cast_precision_loss)] // an estimate
fn solves(operations: Operations, stages: u64, iterations: u64) -> f64 {
    stages as f64 * (OF_A_STAGE + f64::from(operations.step))
        + iterations as f64 * (OF_AN_ITERATION + f64::from(operations.iteration))
}

impl<L> Method<Group<L>, L::Advected> for Stepper<L>
where
    L: DiscreteLagrangian<Scalar = f64>,
{
    fn start(&self, attitude: Group<L>, velocity: Vector<L>) -> Result<State<Group<L>, L::Advected>, SetupError> {
        self.start(attitude, velocity)
    }

    fn advance(&self, state: &mut State<Group<L>, L::Advected>, steps: u64) -> Result<f64, StepError> {
        let mut iterations = 0;
        for _ in 0..steps {
            iterations += u64::from(self.step(state)?.iterations);
        }
        Ok(solves(L::OPERATIONS, steps, iterations))
    }

    fn step(&self, state: &mut State<Group<L>, L::Advected>) -> Result<crate::motion::StepReport, StepError> {
        self.step(state)
    }

    fn velocity(&self, state: &State<Group<L>, L::Advected>) -> Vector<L> {
        self.velocity(state)
    }

    fn energy(&self, state: &State<Group<L>, L::Advected>) -> f64 {
        self.energy(state)
    }
}

impl<L> Method<Group<L>, L::Advected> for Composition<L>
where
    L: DiscreteLagrangian<Scalar = f64> + Regular + Clone,
{
    fn start(&self, attitude: Group<L>, velocity: Vector<L>) -> Result<State<Group<L>, L::Advected>, SetupError> {
        self.start(attitude, velocity)
    }

    fn advance(&self, state: &mut State<Group<L>, L::Advected>, steps: u64) -> Result<f64, StepError> {
        let (stages, mut iterations) = (self.scheme().stages().count() as u64, 0);
        for _ in 0..steps {
            // What step would do is of no use here, and dear to find out.
            iterations += u64::from(self.all_stages(state)?.iterations);
        }
        Ok(solves(L::OPERATIONS, steps * stages, iterations))
    }

    fn step(&self, state: &mut State<Group<L>, L::Advected>) -> Result<crate::motion::StepReport, StepError> {
        self.step(state)
    }

    fn velocity(&self, state: &State<Group<L>, L::Advected>) -> Vector<L> {
        self.velocity(state)
    }

    fn energy(&self, state: &State<Group<L>, L::Advected>) -> f64 {
        self.energy(state)
    }
}

/// What is left of a drift whose spin has been taken out.
fn without_spin<K: KineticFlow<f64>>() -> Operations {
    let Operations { step, iteration } = K::OPERATIONS;
    Operations { step: step.saturating_sub(K::OPERATIONS_OF_SPIN), iteration }
}

impl<L, K> Method<SO3, L::Advected> for Splitting<L, K>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular,
    K: KineticFlow<f64>,
{
    fn start(&self, attitude: SO3, velocity: nalgebra::Vector3<f64>) -> Result<State<SO3, L::Advected>, SetupError> {
        self.start(attitude, velocity)
    }

    #[allow(clippy::cast_precision_loss)] // an estimate
    fn advance(&self, state: &mut State<SO3, L::Advected>, steps: u64) -> Result<f64, StepError> {
        // The iterations change little from step to step, and those of the last are reported.
        let iterations = u64::from(self.advance(state, steps)?.iterations);
        let (drifts, kicks) = (self.scheme().drifts() as u64, self.scheme().kicks() as u64);
        let kick = 0.5 * f64::from(<L as Effect>::OPERATIONS.step);
        let gradients = (steps * self.scheme().gradient_kicks() as u64) as f64 * (kick + OF_A_FORCE_GRADIENT);
        let kicks = (steps * kicks) as f64 * kick + gradients;
        let (drift, turn) = if self.has_spin_apart() {
            (without_spin::<K>(), OF_A_STAGE + f64::from(K::OPERATIONS_OF_SPIN))
        } else {
            (K::OPERATIONS, 0.0)
        };
        Ok(solves(drift, steps * drifts, steps * iterations) + kicks + steps as f64 * turn)
    }

    fn step(&self, state: &mut State<SO3, L::Advected>) -> Result<crate::motion::StepReport, StepError> {
        self.step(state)
    }

    fn velocity(&self, state: &State<SO3, L::Advected>) -> nalgebra::Vector3<f64> {
        self.velocity(state)
    }

    fn energy(&self, state: &State<SO3, L::Advected>) -> f64 {
        self.energy(state)
    }
}

impl Method<SO3, ()> for PreprocessedBody {
    fn start(&self, attitude: SO3, velocity: nalgebra::Vector3<f64>) -> Result<State<SO3, ()>, SetupError> {
        self.start(attitude, velocity)
    }

    fn advance(&self, state: &mut State<SO3, ()>, steps: u64) -> Result<f64, StepError> {
        let mut iterations = 0;
        for _ in 0..steps {
            iterations += u64::from(self.step(state)?.iterations);
        }
        Ok(solves(<PreprocessedFlow as KineticFlow<f64>>::OPERATIONS, steps, iterations))
    }

    fn step(&self, state: &mut State<SO3, ()>) -> Result<crate::motion::StepReport, StepError> {
        self.step(state)
    }

    fn velocity(&self, state: &State<SO3, ()>) -> nalgebra::Vector3<f64> {
        self.velocity(state)
    }

    fn energy(&self, state: &State<SO3, ()>) -> f64 {
        self.energy(state)
    }
}

/// From state to state: what collocation keeps besides attitude and momentum lasts for one call.
///
/// So [`advance`](Method::advance) iterates from the stages of the step before, and [`step`](Method::step), which has
/// none, somewhat longer to the same stages.
impl<L, const PAIRS: usize> Method<SO3, L::Advected> for Gauss<L, PAIRS>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular,
{
    fn start(&self, attitude: SO3, velocity: nalgebra::Vector3<f64>) -> Result<State<SO3, L::Advected>, SetupError> {
        self.stepper().start(attitude, velocity)
    }

    fn advance(&self, state: &mut State<SO3, L::Advected>, steps: u64) -> Result<f64, StepError> {
        let (mut lifted, mut iterations) = (GaussState::from(*state), 0);
        for _ in 0..steps {
            iterations += u64::from(self.step(&mut lifted)?.iterations);
        }
        *state = lowered(self, &lifted, state);
        Ok(collocation::<L, PAIRS>(steps, iterations))
    }

    fn step(&self, state: &mut State<SO3, L::Advected>) -> Result<crate::motion::StepReport, StepError> {
        let mut lifted = GaussState::from(*state);
        let report = self.step(&mut lifted)?;
        *state = lowered(self, &lifted, state);
        Ok(report)
    }

    fn velocity(&self, state: &State<SO3, L::Advected>) -> nalgebra::Vector3<f64> {
        self.stepper().velocity(state)
    }

    fn energy(&self, state: &State<SO3, L::Advected>) -> f64 {
        self.stepper().energy(state)
    }
}

/// The state of this attitude and momentum. The increment that no solve has made is left as at the start.
fn lowered<L, const PAIRS: usize>(
    gauss: &Gauss<L, PAIRS>,
    lifted: &GaussState<PAIRS>,
    start: &State<SO3, L::Advected>,
) -> State<SO3, L::Advected>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular,
{
    let (attitude, momentum, steps) = (lifted.attitude(), lifted.momentum(), lifted.steps());
    State { attitude, momentum, advected: gauss.advected(lifted), steps, ..*start }
}

/// So many steps of collocation with so many iterations in all.
#[allow(clippy::cast_precision_loss)] // an estimate
fn collocation<L: DiscreteLagrangian, const PAIRS: usize>(steps: u64, iterations: u64) -> f64 {
    let pairs = PAIRS as f64;
    // Half of both kicks, and half of that in lanes.
    let torque = if L::PARTS.kick_before { OF_PARAMETERS + 0.25 * f64::from(L::OPERATIONS.step) } else { 0.0 };
    let iteration = 2.0 * pairs * (OF_RATES + torque + OF_A_SUM * pairs);
    steps as f64 * (OF_AN_UPDATE + OF_A_GUESS * pairs * pairs) + iterations as f64 * iteration
}

/// What a step of collocation makes at least, unless nothing but rounding changes from step to step.
pub(super) fn least_of_collocation<L: DiscreteLagrangian, const PAIRS: usize>() -> f64 {
    collocation::<L, PAIRS>(1, 3)
}

/// What a drift makes at least.
pub(super) fn least_of_a_drift<K: KineticFlow<f64>>() -> f64 {
    least(without_spin::<K>())
}

/// What a solve makes at least; with one iteration none is known to have settled.
pub(super) fn least(operations: Operations) -> f64 {
    solves(operations, 1, if operations.iteration > 0 { 2 } else { 0 })
}
