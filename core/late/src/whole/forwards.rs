//! Derivatives of motions along directions: changes of a start and of parameters, the state transition matrix, exponents.

use liestep::StepError;
use liestep::motion::Propagator as _;
use liestep_derivation::Array;
use nalgebra::DMatrix;

use super::derivatives::{Derivatives, Reading, Row};
use super::limit::Limit;
use super::linear::{are_finite, dot};
use super::slopes::{Back, Slopes};
use super::tangent::TangentCode;
use super::varied::Room;
use crate::code::Backend;

/// A change of a motion's start and parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// A displacement of the attitude at the start.
    pub displacement: Vec<f64>,
    /// A change of the momentum at the start.
    pub momentum: Vec<f64>,
    /// Changes of all numbers of the parameters; of those that change with time by a constant.
    pub parameters: Vec<f64>,
}

/// A code that isn't there.
const UNKNOWN: StepError = StepError::NonFinite { what: "derivative" };

/// The change of as many outputs of a map along a direction, by its transpose.
fn pushed<B: Backend<f64>>(
    back: &Back<'_, B>,
    count: usize,
    (by_state, by_numbers): (&[f64], &[f64]),
    pull: impl Fn(&[f64], &mut Slopes) -> Option<f64>,
) -> Vec<f64> {
    let (mut seeds, mut made) = (vec![0.0; count], Vec::with_capacity(count));
    for k in 0..count {
        let mut slopes = back.none();
        seeds[k] = 1.0;
        let more = pull(&seeds, &mut slopes).unwrap_or(0.0);
        seeds[k] = 0.0;
        made.push(dot(&slopes.by_state, by_state) + dot(&slopes.by_numbers, by_numbers) + more);
    }
    made
}

impl<B: Backend<f64>> Derivatives<B> {
    /// The direction in which the start has this change of its velocity, if that is given, and the attitude and the parameters
    /// those of a direction: its momentum is replaced.
    pub fn with_velocity(&self, start: &[f64], velocity: &[f64], change: &[f64], direction: &mut Direction) {
        let (back, sizes) = (self.back(), &self.varied.whole.codes.sizes);
        let (numbers, attitude) = (self.varied.numbers_at(0.0), &start[..sizes.entries]);
        let advected = back.view(&numbers, attitude);
        let mut state = vec![0.0; 2 * sizes.n + sizes.carried];
        state[..sizes.n].copy_from_slice(&direction.displacement);
        direction.momentum = pushed(&back, sizes.n, (&state, &direction.parameters), |seeds, slopes| {
            let by_velocity = back.through_momentum((&numbers, &advected), velocity, seeds, slopes);
            back.through_view(&numbers, attitude, slopes);
            Some(dot(&by_velocity, change))
        });
    }

    /// The changes of all that is read of some states of a motion, along a change of its start and its parameters; the rows stand in
    /// order of time.
    ///
    /// # Errors
    ///
    /// The errors of [`gradient`](Self::gradient).
    pub fn along(&self, start: &[f64], direction: &Direction, rows: &[Row]) -> Result<Vec<Reading>, StepError> {
        let sizes = &self.varied.whole.codes.sizes;
        let lengths = [direction.displacement.len(), direction.momentum.len(), direction.parameters.len()];
        if lengths != [sizes.n, sizes.n, self.varied.whole.numbers().len()] {
            return Err(UNKNOWN);
        }
        let mut room = self.roomy(start)?;
        let advected = vec![0.0; sizes.carried];
        let mut change = [direction.displacement.as_slice(), &direction.momentum, &advected].concat();
        let (mut changes, mut steps) = (Changes::of(self, &direction.parameters), 0);
        if self.varied.is_steady() {
            self.see(self.varied.whole.numbers(), &start[..sizes.entries], &direction.parameters, &mut change);
        }
        let mut made = Vec::with_capacity(rows.len());
        for row in rows {
            while steps < row.steps {
                changes.step(&mut room, [self.varied.time_of(steps), self.varied.step_size()], &mut change)?;
                steps += 1;
            }
            let mut time = self.varied.time_of(steps);
            if row.fraction == 0.0 {
                made.push(self.read_along(time, &room, (&change, direction)));
                continue;
            }
            let (mut part, mut own) = (self.varied.roomy()?, change.clone());
            part.state.copy_from_slice(&room.state);
            let length = self.varied.step_size() * row.fraction;
            self.varied.forget(&mut part, [time, length])?;
            Changes::of(self, &direction.parameters).step(&mut part, [time, length], &mut own)?;
            time += length;
            made.push(self.read_along(time, &part, (&own, direction)));
        }
        let is_finite = |one: &Reading| {
            [&one.velocity, &one.momentum, &one.attitude, &one.energy, &one.spatial_momentum]
                .iter()
                .all(|list| are_finite(list))
        };
        if made.iter().all(is_finite) { Ok(made) } else { Err(UNKNOWN) }
    }

    /// Writes the change of what is advected for those of the attitude and of the numbers.
    fn see(&self, numbers: &[f64], attitude: &[f64], along: &[f64], change: &mut [f64]) {
        let (back, sizes) = (self.back(), &self.varied.whole.codes.sizes);
        let advected = pushed(&back, sizes.carried, (change, along), |seeds, slopes| {
            slopes.by_state[2 * sizes.n..].copy_from_slice(seeds);
            back.through_view(numbers, attitude, slopes);
            None
        });
        change[2 * sizes.n..].copy_from_slice(&advected);
    }

    /// The changes of all that is read of a room's state at a time.
    fn read_along(&self, time: f64, room: &Room<B>, (change, direction): (&[f64], &Direction)) -> Reading {
        let (back, sizes, along) = (self.back(), &self.varied.whole.codes.sizes, &direction.parameters);
        let (numbers, mut change) = (self.varied.numbers_at(time), change.to_vec());
        let (attitude, rest) = room.state[..sizes.history()].split_at(sizes.entries);
        let (momentum, advected) = rest.split_at(sizes.n);
        if !self.varied.is_steady() {
            self.see(&numbers, attitude, along, &mut change);
        }
        let at = (numbers.as_slice(), advected);
        let velocity = Limit { codes: back.codes, numbers: &numbers, advected }.velocity(momentum);
        let both = (change.as_slice(), along.as_slice());
        let entries = self.varied.whole.declaration().displaced(attitude, &change[..sizes.n]);
        Reading {
            velocity: pushed(&back, sizes.n, both, |seeds, slopes| {
                back.through_velocity(at, &velocity, seeds, slopes);
                None
            }),
            momentum: change[sizes.n..2 * sizes.n].to_vec(),
            attitude: entries.iter().zip(attitude).map(|(moved, entry)| moved - entry).collect(),
            energy: pushed(&back, 1, both, |seeds, slopes| {
                let by_velocity = back.through_energy(at, &velocity, seeds[0], slopes);
                back.through_velocity(at, &velocity, &by_velocity, slopes);
                None
            }),
            spatial_momentum: pushed(&back, sizes.n, both, |seeds, slopes| {
                back.through_spatial((attitude, momentum), seeds, slopes);
                None
            }),
        }
    }

    /// The columns of the derivatives after one step by the state before it and by some of the parameters' numbers, each of `2n`
    /// numbers.
    pub(super) fn of_step(&self, state: &[f64], places: &[usize]) -> Result<[Vec<f64>; 2], StepError> {
        let (varied, sizes) = (&self.varied, &self.varied.whole.codes.sizes);
        let start = varied.whole.checked(state)?;
        let mut fresh = start.to_vec();
        varied.whole.see(&mut fresh);
        let time = start[start.len() - 1];
        let mut room = self.roomy(&fresh)?;
        let by_state = self.transition(&fresh, 1)?;
        let mut by_parameters = Vec::with_capacity(2 * sizes.n * places.len());
        for &place in places {
            room.load(&fresh);
            let mut along = vec![0.0; varied.whole.numbers().len()];
            along[place] = 1.0;
            let mut change = vec![0.0; 2 * sizes.n + sizes.carried];
            self.see(varied.whole.numbers(), &fresh[..sizes.entries], &along, &mut change);
            let span = [time * varied.step_size(), varied.step_size()];
            Changes::of(self, &along).step(&mut room, span, &mut change)?;
            by_parameters.extend_from_slice(&change[..2 * sizes.n]);
        }
        if are_finite(&by_parameters) { Ok([by_state, by_parameters]) } else { Err(UNKNOWN) }
    }

    /// The state transition matrix over so many steps: the derivatives of displacement and momentum after them by those at
    /// the start, column by column, each of `2n` numbers.
    ///
    /// # Errors
    ///
    /// The errors of the steps, which have no remedy by substeps here; [`StepError::NonFinite`] if a derivative overflows.
    pub fn transition(&self, start: &[f64], steps: u64) -> Result<Vec<f64>, StepError> {
        let mut columns = DMatrix::identity(2 * self.varied.whole.codes.sizes.n, 2 * self.varied.whole.codes.sizes.n);
        self.each_step(start, steps, columns.as_mut_slice(), &mut |_, _| ())?;
        if are_finite(columns.as_slice()) { Ok(columns.as_slice().to_vec()) } else { Err(UNKNOWN) }
    }

    /// The Lyapunov exponents over so many steps, 1/s, in descending order: one for each of the `2n` components
    /// of displacement and momentum. The columns are orthonormalised every `between` steps.
    ///
    /// The exponents of a motion without forces come in pairs `±λ`.
    ///
    /// # Errors
    ///
    /// The errors of [`transition`](Self::transition); [`StepError::NonFinite`] if an exponent isn't a number, as after no
    /// steps.
    ///
    /// # Source
    ///
    /// \[BGGS80\]; see [`conventions`](liestep::conventions).
    pub fn exponents(&self, start: &[f64], steps: u64, between: u64) -> Result<Vec<f64>, StepError> {
        let count = 2 * self.varied.whole.codes.sizes.n;
        let (mut sums, mut columns) = (vec![0.0; count], DMatrix::<f64>::identity(count, count));
        let mut numbers = columns.as_slice().to_vec();
        self.each_step(start, steps, &mut numbers, &mut |made, numbers| {
            if !made.is_multiple_of(between.max(1)) && made != steps {
                return;
            }
            columns.as_mut_slice().copy_from_slice(numbers);
            let (q, r) = columns.clone().qr().unpack();
            sums.iter_mut().enumerate().for_each(|(k, sum)| *sum += r[(k, k)].abs().ln());
            numbers.copy_from_slice(q.as_slice());
        })?;
        let time = self.varied.time_of(steps);
        let mut exponents: Vec<f64> = sums.iter().map(|sum| sum / time).collect();
        // Columns that a symmetry keeps apart stay in the order of the components.
        exponents.sort_by(|a, b| b.total_cmp(a));
        if are_finite(&exponents) { Ok(exponents) } else { Err(StepError::NonFinite { what: "Lyapunov exponent" }) }
    }

    /// Makes steps, and applies their tangent maps to columns; calls a function after each.
    fn each_step(
        &self,
        start: &[f64],
        steps: u64,
        columns: &mut [f64],
        then: &mut impl FnMut(u64, &mut [f64]),
    ) -> Result<(), StepError> {
        let varied = &self.varied;
        let tangent = TangentCode::<B>::of(varied.whole.declaration()).map_err(|_| UNKNOWN)?;
        let (mut room, sizes) = (self.roomy(start)?, &varied.whole.codes.sizes);
        let mut before = Vec::new();
        for made in 1..=steps {
            let span = [varied.time_of(made - 1), varied.step_size()];
            varied.watched(&mut room, span, &mut |stage, state| {
                if before.is_empty() {
                    before.extend_from_slice(state);
                    return;
                }
                tangent.apply(sizes, stage.stages.first(), (&before, state), columns);
                before.clear();
            })?;
            then(made, columns);
        }
        Ok(())
    }
}

/// The changes of a motion from step to step.
struct Changes<'a, B: Backend<f64>> {
    derivatives: &'a Derivatives<B>,
    along: &'a [f64],
    /// Changes of the constants of each stage, where these are always the same.
    constants: Vec<Option<Vec<f64>>>,
}

impl<'a, B: Backend<f64>> Changes<'a, B> {
    fn of(derivatives: &'a Derivatives<B>, along: &'a [f64]) -> Self {
        let constants = vec![None; derivatives.varied.stages.len()];
        Self { derivatives, along, constants }
    }

    /// The change of the constants of a step of the length `h`.
    fn of_constants(&self, numbers: &[f64], h: f64) -> Vec<f64> {
        let back = self.derivatives.back();
        pushed(&back, back.constants(), (&[], self.along), |seeds, slopes| {
            back.through_constants((numbers, h), seeds, &mut slopes.by_numbers);
            None
        })
    }

    /// Makes a step of this start and length in a room, and carries a change through its stages.
    fn step(&mut self, room: &mut Room<B>, span: [f64; 2], change: &mut Vec<f64>) -> Result<(), StepError> {
        let derivatives = self.derivatives;
        let (varied, back) = (&derivatives.varied, derivatives.back());
        let (sizes, is_steady) = (&varied.whole.codes.sizes, varied.is_steady());
        let (mut before, mut stage) = (Vec::new(), 0);
        varied.watched(room, span, &mut |stepper, state| {
            if before.is_empty() {
                before.extend_from_slice(state);
                return;
            }
            if !is_steady {
                derivatives.see(stepper.numbers(), &before[..sizes.entries], self.along, change);
                self.constants[stage] = None;
            }
            if self.constants[stage].is_none() {
                self.constants[stage] = Some(self.of_constants(stepper.numbers(), stepper.h));
            }
            let (turn, rest) = change.split_at(sizes.n);
            let (momentum, advected) = rest.split_at(sizes.n);
            let given = [
                (Array::Half, &state[sizes.history()..sizes.history() + sizes.n]),
                (Array::Momentum, &before[sizes.momentum()..sizes.advected()]),
                (Array::Advected, &before[sizes.advected()..sizes.history()]),
                (Array::Velocity, turn),
                (Array::History, momentum),
                (Array::Next, advected),
                (Array::Factors, self.constants[stage].as_deref().unwrap_or_default()),
            ];
            let mut made = vec![0.0; change.len()];
            B::run(&back.code.forwards.code, &stepper.stages.first().numbers, given, &mut made);
            *change = made;
            before.clear();
            stage += 1;
        })?;
        Ok(())
    }
}
