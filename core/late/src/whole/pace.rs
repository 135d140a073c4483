//! Steps of a transformed time with a declared pace.

use liestep::motion::{Layout, Propagator, StepReport};
use liestep::{SetupError, StepError};

use super::lengths::{MEMORY, Memory};
use super::linear::are_finite;
use super::stepper::{Whole, write_or_nan};
use crate::code::{Backend, Interpreter};

/// A stepper of equal steps in `τ`, `dt = s dτ`, by a declaration's `pace = s(w)`; by [`Whole::paced`].
///
/// The `h` of the stepper is one of `τ`; times, velocities and energies are those of the time `t`. The energy of a start becomes the
/// number `E_0` of its state.
#[derive(Debug)]
pub struct Paced<B: Backend<f64> = Interpreter> {
    whole: Whole<B>,
    layout: Layout,
    /// The place of `E_0` in a state.
    place: usize,
}

/// An energy, J, in whose rounding all others vanish. It is a power of two, so that dividing by it is exact.
const VAST: f64 = f64::from_bits((1023 + 500) << 52);
/// Limit of the iterations for a part of a step.
const MOST_ITERATIONS: u32 = 30;

/// # Wrap: steps of a transformed time
impl<B: Backend<f64>> Whole<B> {
    /// Steps of `dt = s dτ` with the declared `pace = s(w)`, on any group, as by
    /// [`Stepper::paced`](liestep::Stepper::paced). A step takes `h (s(w) + s(w⁺))/2`, s, which is known when it has been
    /// made.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] if no pace is declared, and [`SetupError::Method`] for another method than the step.
    pub fn paced(&self) -> Result<Paced<B>, SetupError> {
        let Some(energy) = self.declaration().energy else {
            return Err(SetupError::Parameter { field: "pace", cause: "isn't declared, or not of the whole scene" });
        };
        if !self.stages.is_single() {
            let cause = "is around steps of a declared pace: take \"step\"";
            return Err(SetupError::Method { cause });
        }
        let before = &self.declaration().carried[..energy];
        let place = before.iter().map(|one| one.shape.0 * one.shape.1).sum::<usize>();
        let mut layout = self.codes.layout.clone();
        layout.memory += MEMORY;
        Ok(Paced { whole: self.clone(), layout, place: self.codes.sizes.advected() + place })
    }
}

impl<B: Backend<f64>> Paced<B> {
    /// The state of [`Whole`].
    fn inner(&self, state: &[f64]) -> Vec<f64> {
        let (last, count) = (self.whole.codes.sizes.state() - 1, state[state.len() - 1]);
        state[..last].iter().copied().chain([count]).collect()
    }

    fn memory(&self, state: &[f64]) -> Memory {
        Memory::read(&state[self.whole.codes.sizes.state() - 1..state.len() - 1])
    }

    /// The advected parameters of a state with another energy `E_0`.
    fn with_energy(&self, state: &[f64], energy: f64) -> Vec<f64> {
        let sizes = &self.whole.codes.sizes;
        let mut advected = state[sizes.advected()..sizes.history()].to_vec();
        advected[self.place - sizes.advected()] = energy;
        advected
    }

    /// The pace `s(w)`, from the potential `s (V − E_0)` with a vast `E_0`.
    fn pace(&self, state: &[f64]) -> f64 {
        let advected = self.with_energy(state, VAST);
        let rest = vec![0.0; self.whole.codes.sizes.n];
        -self.whole.numbered().limit(&advected).energy(&rest) / VAST
    }

    /// The energy `H`: that of `s (H − E_0)` for `E_0 = 0`, divided by `s`.
    fn energy_of(&self, state: &[f64]) -> f64 {
        let sizes = &self.whole.codes.sizes;
        let advected = self.with_energy(state, 0.0);
        let limit = self.whole.numbered().limit(&advected);
        limit.energy(&limit.velocity(&state[sizes.momentum()..sizes.advected()])) / self.pace(state)
    }

    /// The state of a start at this state of [`Whole`], whose energy it takes.
    fn begun(&self, mut inner: Box<[f64]>) -> Box<[f64]> {
        inner[self.place] = self.energy_of(&inner);
        let mut memory = Memory::START;
        memory.0[0] = self.pace(&inner);
        memory.within(&inner)
    }

    /// The time of a step of this share of `τ` between two paces, s.
    fn passed(&self, share: f64, [before, after]: [f64; 2]) -> f64 {
        share * self.whole.h * 0.5 * (before + after)
    }

    /// The part of a step by its share of `τ`, and its pace.
    fn part_of(&self, inner: &[f64], share: f64) -> Result<(Box<[f64]>, f64), StepError> {
        let mut part = self.whole.part(inner, share)?;
        // A correction of rounding errors takes the numbers of the start.
        part[self.place] = inner[self.place];
        let pace = self.pace(&part);
        Ok((part, pace))
    }
}

impl<B: Backend<f64>> Propagator for Paced<B> {
    fn layout(&self) -> &Layout {
        &self.layout
    }

    fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError> {
        // The velocity in `τ` is the one in `t`, times the pace.
        let rest = vec![0.0; velocity.len()];
        let pace = self.pace(&self.whole.start(attitude, &rest)?);
        let fast: Vec<f64> = velocity.iter().map(|velocity| velocity * pace).collect();
        if are_finite(velocity) && !are_finite(&fast) {
            return Err(SetupError::NonFinite { what: "pace" });
        }
        Ok(self.begun(self.whole.start(attitude, &fast)?))
    }

    fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        let (mut inner, mut memory) = (self.inner(self.layout.checked(state)?), self.memory(state));
        let report = self.whole.step(&mut inner)?;
        inner[self.place] = state[self.place];
        let pace = self.pace(&inner);
        memory.add(self.passed(1.0, [memory.0[0], pace]));
        memory.0[0] = pace;
        state.copy_from_slice(&memory.within(&inner));
        Ok(report)
    }

    /// The part of `τ` that takes the time `t`, by Newton's iterations with `dt/dτ = s`.
    fn part(&self, state: &[f64], fraction: f64) -> Result<Box<[f64]>, StepError> {
        let (inner, mut memory) = (self.inner(self.layout.checked(state)?), self.memory(state));
        let before = memory.0[0];
        let way = if fraction > 0.0 { 1.0 } else { -1.0 };
        let (_, last) = self.part_of(&inner, way)?;
        let time = fraction.abs() * self.passed(way, [before, last]);
        let mut share = fraction;
        for _ in 0..MOST_ITERATIONS {
            let (_, pace) = self.part_of(&inner, share)?;
            let missing = time - self.passed(share, [before, pace]);
            if missing.abs() <= 4.0 * f64::EPSILON * time.abs() {
                break;
            }
            share += missing / (self.whole.h * pace);
        }
        let (part, pace) = self.part_of(&inner, share)?;
        memory.0[0] = pace;
        memory.pass(time);
        Ok(memory.within(&part))
    }

    fn adopt(&self, state: &[f64]) -> Box<[f64]> {
        self.begun(self.whole.adopt(state))
    }

    fn cost(&self) -> Option<liestep::motion::Cost> {
        self.whole.cost()
    }

    fn step_size(&self) -> f64 {
        self.whole.h
    }

    fn time(&self, state: &[f64]) -> f64 {
        self.layout.checked(state).map_or(f64::NAN, |state| {
            let Memory([_, time, _, part]) = self.memory(state);
            time + part
        })
    }

    /// The length of a step is known by making the step.
    fn length(&self, state: &[f64]) -> Option<f64> {
        let end = self.layout.checked(state).and_then(|state| self.part_of(&self.inner(state), 1.0));
        Some(end.map_or(f64::NAN, |(_, pace)| self.passed(1.0, [self.memory(state).0[0], pace])))
    }

    fn velocity(&self, state: &[f64], velocity: &mut [f64]) {
        let sizes = &self.whole.codes.sizes;
        let found = self.layout.checked(state).map(|state| {
            let limit = self.whole.numbered().limit(&state[sizes.advected()..sizes.history()]);
            let (pace, fast) = (self.pace(state), limit.velocity(&state[sizes.momentum()..sizes.advected()]));
            fast.into_iter().map(|fast| fast / pace).collect()
        });
        write_or_nan(found.ok(), velocity);
    }

    fn energy(&self, state: &[f64]) -> f64 {
        self.layout.checked(state).map_or(f64::NAN, |state| self.energy_of(state))
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let inner = self.layout.checked(state).map_or_else(|_| Vec::new(), |state| self.inner(state));
        self.whole.spatial_momentum(&inner, momentum);
    }

    fn defect(&self, state: &[f64]) -> f64 {
        self.layout.checked(state).map_or(f64::NAN, |state| self.whole.defect(&self.inner(state)))
    }
}
