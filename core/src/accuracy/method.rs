//! The integrators behind one interface, with the arithmetic that their steps are.

use crate::advected::Advected;
use crate::composition::Composition;
use crate::effect::{Effect, Group, Vector};
use crate::error::{SetupError, StepError};
use crate::groups::{LieGroup, SO3};
use crate::kinetic::Regular;
use crate::lagrangian::DiscreteLagrangian;
use crate::operations::Operations;
use crate::preprocessed::PreprocessedBody;
use crate::splitting::{KineticFlow, PreprocessedFlow, Splitting};
use crate::state::State;
use crate::stepper::Stepper;

/// Besides what an effect counts, a solve and its reconstruction make so many operations on SO(3).
const OF_A_STAGE: f64 = 150.0;
/// Besides the Newton system, an iteration solves it and looks whether it has settled. These wait for each other, as the
/// products of matrices don't.
const OF_AN_ITERATION: f64 = 90.0;

/// An integrator of a fixed step.
pub(super) trait Method<G: LieGroup, A: Advected<G>> {
    /// The state that a motion starts from.
    fn start(&self, attitude: G, velocity: G::Vector) -> Result<State<G, A>, SetupError>;

    /// Makes so many steps, and says how many operations they were, about. On an error the state is anywhere.
    fn advance(&self, state: &mut State<G, A>, steps: u64) -> Result<f64, StepError>;

    /// As [`advance`](Self::advance) by one; on an error the state is unchanged.
    fn step(&self, state: &mut State<G, A>) -> Result<crate::StepReport, StepError>;

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

    fn step(&self, state: &mut State<Group<L>, L::Advected>) -> Result<crate::StepReport, StepError> {
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

    fn step(&self, state: &mut State<Group<L>, L::Advected>) -> Result<crate::StepReport, StepError> {
        self.step(state)
    }

    fn velocity(&self, state: &State<Group<L>, L::Advected>) -> Vector<L> {
        self.velocity(state)
    }

    fn energy(&self, state: &State<Group<L>, L::Advected>) -> f64 {
        self.energy(state)
    }
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
        Ok(solves(K::OPERATIONS, steps * drifts, steps * iterations) + (steps * kicks) as f64 * kick)
    }

    fn step(&self, state: &mut State<SO3, L::Advected>) -> Result<crate::StepReport, StepError> {
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

    fn step(&self, state: &mut State<SO3, ()>) -> Result<crate::StepReport, StepError> {
        self.step(state)
    }

    fn velocity(&self, state: &State<SO3, ()>) -> nalgebra::Vector3<f64> {
        self.velocity(state)
    }

    fn energy(&self, state: &State<SO3, ()>) -> f64 {
        self.energy(state)
    }
}

/// What a solve makes at least; with one iteration none is known to have settled.
pub(super) fn least(operations: Operations) -> f64 {
    solves(operations, 1, if operations.iteration > 0 { 2 } else { 0 })
}
