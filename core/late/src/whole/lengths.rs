//! Lengths of steps: equal ones, those of a clock, and those of a density.

use std::rc::Rc;

use liestep::with::Clock;

/// The rate of a density, 1/s, from a state's numbers and the body velocity.
pub(super) type Rate = dyn Fn(&[f64], &[f64]) -> f64;

/// A rule for the length of each step.
#[derive(Clone)]
pub(super) enum Lengths {
    Equal,
    Clock(Clock),
    Density(Rc<Rate>),
}

/// The number of entries of a memory.
pub(super) const MEMORY: usize = 4;

/// The memory of the lengths: the density `ρ`, which is one at the start, the elapsed time as a compensated sum, and the
/// time since the last whole step.
#[derive(Clone, Copy)]
pub(super) struct Memory(pub(super) [f64; MEMORY]);

impl Memory {
    pub(super) const START: Self = Self([1.0, 0.0, 0.0, 0.0]);

    pub(super) fn read(memory: &[f64]) -> Self {
        let mut own = Self::START;
        own.0.iter_mut().zip(memory).for_each(|(own, number)| *own = *number);
        own
    }

    /// A state of [`Whole`](super::stepper::Whole) with this memory, which stands before the number of steps.
    pub(super) fn within(self, inner: &[f64]) -> Box<[f64]> {
        let (before, last) = inner.split_at(inner.len() - 1);
        before.iter().chain(&self.0).chain(last).copied().collect()
    }

    /// Passes a part of a step.
    pub(super) fn pass(&mut self, length: f64) {
        self.0[3] += length;
    }

    /// Adds the length of a whole step.
    pub(super) fn add(&mut self, length: f64) {
        let [_, sum, carry, _] = self.0;
        let addend = length + carry;
        let after = sum + addend;
        let taken = after - sum;
        (self.0[1], self.0[2]) = (after, (sum - (after - taken)) + (addend - taken));
    }
}

/// The number of steps in a state.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
const fn count(steps: f64) -> u64 {
    steps as u64
}

impl Lengths {
    /// The length ahead of a state or behind it, s, in steps of this unit; NaN if there is none.
    pub(super) fn length(
        &self,
        [unit, steps]: [f64; 2],
        (state, velocity): (&[f64], &impl Fn() -> Vec<f64>),
        (memory, is_ahead): (&[f64], bool),
    ) -> f64 {
        match self {
            Self::Equal => unit,
            Self::Clock(clock) => {
                let steps = count(steps);
                let length = if is_ahead { clock.length(steps) } else { clock.length_before(steps) };
                length.map_or(f64::NAN, |length| unit * length)
            }
            Self::Density(rate) => {
                let half = 0.5 * unit * rate(state, &velocity());
                unit / (memory[0] + if is_ahead { half } else { -half })
            }
        }
    }

    /// The memory after a step of this unit and length that has led to a state.
    pub(super) fn after(
        &self,
        [unit, length]: [f64; 2],
        (state, velocity): (&[f64], &impl Fn() -> Vec<f64>),
        mut memory: Memory,
    ) -> Memory {
        if let Self::Density(rate) = self
            && length != 0.0
        {
            memory.0[0] = unit / length + 0.5 * unit * rate(state, &velocity());
            memory.add(length);
        }
        memory
    }

    /// The time after this number of steps of this unit, s.
    pub(super) fn time(&self, [unit, steps]: [f64; 2], memory: &[f64]) -> f64 {
        let passed = match self {
            Self::Equal => unit * steps,
            Self::Clock(clock) => unit * clock.time(count(steps)),
            Self::Density(_) => memory[1],
        };
        passed + memory[3]
    }
}
