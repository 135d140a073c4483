//! The stepper as a propagator: steps, runs and parts of steps of slices.

use alloc::boxed::Box;
use alloc::vec::Vec;

use nalgebra::{Vector3, Vector6};

use super::state::body_of;
use super::stepper::MultibodyStepper;
use super::workspace::with_workspace;
use crate::error::{SetupError, StepError};
use crate::groups::LieGroup as _;
use crate::motion::{Cost, Layout, Propagator, StepReport};

/// The operations of a body in a stage of a step, and in an iteration: products and factors of matrices of order six.
const OF_A_BODY: [f64; 2] = [2e3, 4e3];

impl MultibodyStepper {
    /// Makes `steps` steps; on an error the state is unchanged. Returns the sum of their iterations.
    ///
    /// # Errors
    ///
    /// The errors of [`step`](Self::step).
    pub fn run(&self, state: &mut [f64], steps: u64) -> Result<u64, StepError> {
        self.check(state)?;
        with_workspace(|work| {
            let mut before = core::mem::take(&mut work.before);
            before.clear();
            before.extend_from_slice(state);
            let mut iterations = 0;
            let made = (0..steps).try_for_each(|step| {
                let ends = [step == 0, step + 1 == steps];
                iterations += u64::from(self.step_of_run(state, work, None, ends)?.iterations);
                Ok(())
            });
            if made.is_err() {
                state.copy_from_slice(&before);
            }
            work.before = before;
            made.map(|()| iterations)
        })
    }

    /// Makes one step; on an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// [`StepError`] that names a body or a joint, see the type's contract.
    pub fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        self.check(state)?;
        with_workspace(|work| self.step_in(state, work, None))
    }
}

impl Propagator for MultibodyStepper {
    fn layout(&self) -> &Layout {
        &self.layout
    }

    fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError> {
        SetupError::check_length("attitude", attitude.len(), self.layout.entries())?;
        SetupError::check_length("velocity", velocity.len(), self.layout.components())?;
        let bodies: Vec<_> = attitude.chunks(self.offsets.attitudes() / self.bodies()).map(body_of).collect();
        let velocities: Vec<_> = velocity.chunks(6).map(Vector6::from_column_slice).collect();
        Self::start(self, &bodies, &velocities)
    }

    fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        Self::step(self, state)
    }

    fn step_forced(&self, state: &mut [f64], force: &[f64]) -> Result<StepReport, StepError> {
        let (forces, rest) = force.as_chunks::<6>();
        if !rest.is_empty() {
            return Err(StepError::NonFinite { what: "control force" });
        }
        let forces: Vec<_> = forces.iter().copied().map(Vector6::from).collect();
        Self::step_forced(self, state, &forces)
    }

    fn run(&self, state: &mut [f64], steps: u64) -> Result<u64, StepError> {
        Self::run(self, state, steps)
    }

    fn part(&self, state: &[f64], fraction: f64) -> Result<Box<[f64]>, StepError> {
        self.check(state)?;
        let mut next = state.to_vec();
        // So small a change would be lost in rounding.
        if fraction.abs() >= f64::EPSILON * f64::EPSILON {
            let part =
                self.with_step(self.h * fraction).map_err(|_| StepError::NonFinite { what: "part of the step" })?;
            part.begin(&mut next);
            part.step(&mut next)?;
            self.offsets.set_steps(&mut next, self.offsets.steps(state));
        }
        self.begin(&mut next);
        Ok(next.into())
    }

    fn adopt(&self, state: &[f64]) -> Box<[f64]> {
        let known = self.offsets.attitudes() + 6 * self.bodies();
        let mut adopted = self.offsets.zeros();
        if state.len() < known {
            adopted.fill(f64::NAN);
            return adopted.into();
        }
        adopted[..known].copy_from_slice(&state[..known]);
        self.begin(&mut adopted);
        adopted.into()
    }

    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)] // counts of bodies and of stages
    fn cost(&self) -> Option<Cost> {
        let stages = self.stages.as_ref().map_or(1, |stages| stages.gammas().count());
        let [step, iteration] = OF_A_BODY.map(|of_a_body| of_a_body * self.bodies() as f64);
        Some(Cost { step: stages as f64 * step, iteration, fewest: 2 * stages as u32, once: 0.0 })
    }

    fn gap(&self, state: &[f64]) -> f64 {
        self.widest_gap(state)
    }

    fn joint_forces(&self, state: &[f64]) -> Result<Vec<[Vector3<f64>; 2]>, StepError> {
        Self::joint_forces(self, state)
    }

    fn step_size(&self) -> f64 {
        self.h
    }

    fn velocity(&self, state: &[f64], velocity: &mut [f64]) {
        let is_state = self.check(state).is_ok();
        let velocities =
            if is_state { self.velocities_of(&self.attitudes(state), &self.momenta(state)) } else { Vec::new() };
        for (body, components) in velocity.chunks_exact_mut(6).enumerate() {
            let of_body = velocities.get(body).copied().unwrap_or_else(|| Vector6::repeat(f64::NAN));
            components.copy_from_slice(of_body.as_slice());
        }
    }

    fn energy(&self, state: &[f64]) -> f64 {
        Self::energy(self, state)
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let is_state = self.check(state).is_ok();
        for (body, components) in momentum.chunks_exact_mut(6).enumerate() {
            let of_body = (is_state && body < self.bodies())
                .then(|| self.attitude(state, body).inverse().adjoint_transpose(&self.momentum(state, body)));
            components.copy_from_slice(of_body.unwrap_or_else(|| Vector6::repeat(f64::NAN)).as_slice());
        }
    }

    fn defect(&self, state: &[f64]) -> f64 {
        if self.check(state).is_err() {
            return f64::NAN;
        }
        (0..self.bodies()).map(|body| self.attitude(state, body).defect()).sum()
    }
}
