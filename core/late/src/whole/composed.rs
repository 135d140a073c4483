//! Symmetric compositions of a step, on numbers.

use std::sync::Arc;

use liestep::methods::CompositionScheme;
use liestep::motion::{Layout, Propagator, StepReport};
use liestep::{SetupError, StepError};

use super::family::WholeFamily;
use super::stepper::{OF_THIS_LAYOUT, Whole};
use crate::code::Backend;

/// A symmetric composition of a [`Whole`]: each stage has a memory of its own.
#[derive(Clone, Debug)]
pub struct WholeComposed<B: Backend<f64>> {
    step: Whole<B>,
    /// The steps of distinct coefficients, and the index of each stage's among them.
    parts: Vec<Whole<B>>,
    stages: Vec<usize>,
    layout: Layout,
}

impl<B: Backend<f64>> WholeComposed<B> {
    /// The composition of steps of these numbers, whose stages make a step of `h`, s.
    ///
    /// # Errors
    ///
    /// [`SetupError::NotSelfAdjoint`] if a step of `−h` doesn't undo one of `h`, and the errors of [`Whole::new`].
    pub fn new(
        family: &Arc<WholeFamily<B>>,
        numbers: &[f64],
        h: f64,
        scheme: CompositionScheme,
    ) -> Result<Self, SetupError> {
        if !family.declaration.is_self_adjoint {
            return Err(SetupError::NotSelfAdjoint);
        }
        let step = Whole::new(family, numbers, h)?;
        let (mut distinct, mut stages): (Vec<f64>, Vec<usize>) = (Vec::new(), Vec::new());
        for gamma in scheme.stages() {
            let known = distinct.iter().position(|other| other.to_bits() == gamma.to_bits());
            stages.push(known.unwrap_or(distinct.len()));
            if known.is_none() {
                distinct.push(gamma);
            }
        }
        let parts = distinct.iter().map(|gamma| step.of_step(h * gamma)).collect::<Result<Vec<_>, _>>()?;
        let layout = Layout { memory: 3 * family.sizes.n * stages.len(), ..family.layout.clone() };
        Ok(Self { step, parts, stages, layout })
    }

    /// The number of a stage's memory.
    fn memory(&self) -> usize {
        3 * self.step.family.sizes.n
    }

    fn started(&self, own: &[f64]) -> Box<[f64]> {
        let sizes = &self.step.family.sizes;
        let (now, ratios) = (&own[..sizes.history()], self.stages.iter().map(|part| self.parts[*part].h / self.step.h));
        let memory = &own[sizes.history()..own.len() - 1];
        let mut state = now.to_vec();
        // Increments are proportional to the step.
        for ratio in ratios {
            let ratio = if ratio.is_finite() { ratio } else { 0.0 };
            state.extend(memory.iter().map(|number| number * ratio));
        }
        state.push(own[own.len() - 1]);
        state.into()
    }

    fn own(&self, state: &[f64]) -> Result<Vec<f64>, StepError> {
        let sizes = &self.step.family.sizes;
        if state.len() != self.layout.state() {
            return Err(OF_THIS_LAYOUT);
        }
        Ok([&state[..sizes.history() + self.memory()], &state[state.len() - 1..]].concat())
    }
}

impl<B: Backend<f64>> Propagator for WholeComposed<B> {
    fn layout(&self) -> &Layout {
        &self.layout
    }

    fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError> {
        self.step.start(attitude, velocity).map(|own| self.started(&own))
    }

    fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        let sizes = &self.step.family.sizes;
        if state.len() != self.layout.state() {
            return Err(OF_THIS_LAYOUT);
        }
        let (here, memory, steps) = (sizes.history(), self.memory(), state[state.len() - 1]);
        let (mut next, mut scratch, mut iterations) = (state.to_vec(), self.step.scratch(), 0);
        let mut own = vec![0.0; sizes.state()];
        own[..here].copy_from_slice(&state[..here]);
        for (stage, part) in self.stages.iter().enumerate() {
            let place = here + stage * memory;
            own[here..here + memory].copy_from_slice(&next[place..place + memory]);
            own[here + memory] = steps;
            iterations += self.parts[*part].advance(&mut own, &mut scratch)?;
            next[place..place + memory].copy_from_slice(&own[here..here + memory]);
        }
        next[..here].copy_from_slice(&own[..here]);
        if let Some(last) = next.last_mut() {
            *last = steps + 1.0;
        }
        state.copy_from_slice(&next);
        Ok(StepReport::of(iterations))
    }

    fn run(&self, state: &mut [f64], steps: u64) -> Result<u64, StepError> {
        let (mut next, mut iterations) = (state.to_vec(), 0);
        for _ in 0..steps {
            iterations += u64::from(self.step(&mut next)?.iterations);
        }
        state.copy_from_slice(&next);
        Ok(iterations)
    }

    fn part(&self, state: &[f64], fraction: f64) -> Result<Box<[f64]>, StepError> {
        let mut own = self.own(state)?;
        let steps = own[own.len() - 1];
        for part in &self.stages {
            let share = self.parts[*part].h / self.step.h * fraction;
            own = self.step.part(&own, if share.is_finite() { share } else { 0.0 })?.into();
        }
        if let Some(last) = own.last_mut() {
            *last = steps;
        }
        Ok(self.started(&own))
    }

    fn adopt(&self, state: &[f64]) -> Box<[f64]> {
        self.started(&self.step.adopt(state))
    }

    fn step_size(&self) -> f64 {
        self.step.h
    }

    fn velocity(&self, state: &[f64], velocity: &mut [f64]) {
        self.step.velocity(state, velocity);
    }

    fn energy(&self, state: &[f64]) -> f64 {
        self.step.energy(state)
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        self.step.spatial_momentum(state, momentum);
    }

    fn defect(&self, state: &[f64]) -> f64 {
        self.step.defect(state)
    }
}
