//! Derivatives of motions by their starts, by all parameters, and by parameters that change with time.

use std::sync::Arc;

use liestep::motion::Propagator as _;
use liestep::{SetupError, StepError};

use super::algebra::{displaced, tangent};
use super::lengths::Lengths;
use super::limit::Limit;
use super::linear::are_finite;
use super::slopes::{Back, SlopeCode, Slopes};
use super::stepper::{OF_THIS_LAYOUT, Whole, WholeError};
use super::tape::{Constants, Given, Sums, Tape};
use super::varied::{Room, Varied};
use crate::code::{Backend, Interpreter};

/// Derivatives of a declaration's motions, on any group, by [`Whole::derivatives`] and [`Varied::derivatives`].
///
/// Coordinates are those of [`Transition`](super::Transition): a displacement `ζ` of an attitude is `g exp ζ̂`, on SO(3) in
/// radians about the axes of the body, and a momentum is in the body frame. Derivatives are those of the discrete motion, at any
/// step: nothing but rounding is lost.
///
/// # Examples
///
/// The height of a pendulum after a second, by its start, its mass and its length, beside a difference.
///
/// ```
/// use liestep::motion::Propagator as _;
/// use liestep_late::{Reading, Declaration, Row, Whole};
///
/// let pendulum = Declaration::parse(
///     "#[lagrangian(group = SO3, advected(w = up),
///         l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * m * g * w.dot(&(rho + F * rho)))]
///     struct Pendulum { J_d: NonstandardInertia, m: f64, g: f64, rho: Vector3<f64>, up: Vector3<f64> }",
/// )?;
/// let end = |m: f64| -> Result<_, Box<dyn std::error::Error>> {
///     let numbers = pendulum.numbers(&[
///         ("J_d", &[2.0, 2.0, 1.0]),
///         ("m", &[m]),
///         ("g", &[9.81]),
///         ("rho", &[0.0, 0.0, -1.0]),
///         ("up", &[0.0, 0.0, 1.0]),
///     ])?;
///     let whole: Whole = Whole::of(pendulum, &numbers, 0.01, "step".parse()?)?;
///     let start = whole.start(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], &[0.3, 1.0, 0.0])?;
///     let mut state = start.clone();
///     whole.run(&mut state, 100)?;
///     Ok((whole, start, state[8]))
/// };
/// let (whole, start, _) = end(1.5)?;
/// let mut by_attitude = vec![0.0; 9];
/// by_attitude[8] = 1.0;
/// let height = Reading { attitude: by_attitude, ..Reading::default() };
/// let gradient = whole.derivatives()?.gradient(&start, &[(Row { steps: 100, fraction: 0.0 }, height)], &mut |_, _| ())?;
/// let difference = (end(1.5 + 1e-5)?.2 - end(1.5 - 1e-5)?.2) / 2e-5;
/// // The mass stands behind the nine entries of the inertia.
/// assert!((gradient.parameters[9] - difference).abs() < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Derivatives<B: Backend<f64> = Interpreter> {
    pub(super) varied: Varied<B>,
    pub(super) code: Arc<SlopeCode<B>>,
}

/// A state of a motion: that after so many steps, and a fraction of the next, from zero to below one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The number of whole steps.
    pub steps: u64,
    /// The fraction of the step behind them.
    pub fraction: f64,
}

/// Numbers beside all that is read of a state: its changes, or the derivatives of a scalar by it; an empty list stands for
/// zeros.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// The body velocity's.
    pub velocity: Vec<f64>,
    /// The momentum's, in the body frame.
    pub momentum: Vec<f64>,
    /// The attitude's entries', the matrices of its factors row by row.
    pub attitude: Vec<f64>,
    /// The energy's, one number.
    pub energy: Vec<f64>,
    /// The momentum's in space.
    pub spatial_momentum: Vec<f64>,
}

/// The derivatives of a scalar by a motion's start and parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// The derivatives by a displacement of the attitude at the start.
    pub displacement: Vec<f64>,
    /// The derivatives by the momentum at the start.
    pub momentum: Vec<f64>,
    /// The derivatives by all numbers of the parameters, at this momentum; those that change with time as if they changed by a constant.
    pub parameters: Vec<f64>,
}

/// The most numbers on a tape, of 128 MiB; longer motions are made once more, part by part.
const MOST: usize = 1 << 24;

impl<B: Backend<f64>> Whole<B> {
    /// The derivatives of the motions of this stepper. Their code is written with the first of a declaration.
    ///
    /// # Errors
    ///
    /// The declaration needs a function that has no derivative, or is too large.
    pub fn derivatives(&self) -> Result<Derivatives<B>, WholeError> {
        self.varied().derivatives()
    }
}

impl<B: Backend<f64>> Varied<B> {
    /// The derivatives of the motions of this stepper, see [`Whole::derivatives`].
    ///
    /// # Errors
    ///
    /// The errors of [`Whole::derivatives`]; the steps have lengths of their own.
    pub fn derivatives(&self) -> Result<Derivatives<B>, WholeError> {
        if !matches!(self.lengths, Lengths::Equal) {
            let cause = "has steps of different lengths, whose derivatives aren't known: take equal ones";
            return Err(SetupError::Method { cause }.into());
        }
        let code = SlopeCode::<B>::of(self.whole.declaration())?;
        Ok(Derivatives { varied: self.clone(), code })
    }
}

impl<B: Backend<f64>> Derivatives<B> {
    pub(super) fn back(&self) -> Back<'_, B> {
        Back { codes: &self.varied.whole.codes, code: &self.code }
    }

    /// A room with a state, whose memory of lengths is left out.
    pub(super) fn roomy(&self, state: &[f64]) -> Result<Room<B>, StepError> {
        let mut room = self.varied.roomy()?;
        let (inner, own) = (room.state.len(), state.len());
        if own != inner && self.varied.layout().checked(state).is_err() {
            return Err(OF_THIS_LAYOUT);
        }
        room.load(state);
        Ok(room)
    }

    /// The constants of the stages, where they don't change.
    pub(super) fn constants(room: &Room<B>) -> Vec<Constants> {
        room.stages.iter().map(|stage| (stage.stages.first().numbers.clone(), stage.h)).collect()
    }

    /// The gradient of a scalar of some states of a motion, of which there are the derivatives by each; the rows stand in order of
    /// time. The start is a state of the stepper.
    ///
    /// The function `given` gets the derivatives by all parameters for each span of time, where parameters change, with the span's
    /// start and length in s: by their mean over it, or by their value, where the length is zero.
    ///
    /// A motion is made anew, and its stages are stored, as many as fit into 128 MiB; then the rest is made once more.
    ///
    /// # Errors
    ///
    /// The errors of the steps, which have no remedy by substeps here; [`StepError::NonFinite`] if a derivative overflows, as
    /// in chaos, or if a list has another length.
    pub fn gradient(&self, start: &[f64], rows: &[(Row, Reading)], given: Given<'_>) -> Result<Gradient, StepError> {
        let varied = &self.varied;
        rows.iter().try_for_each(|(_, by)| self.check(by))?;
        let mut room = self.roomy(start)?;
        let constants = Self::constants(&room);
        let back = self.back();
        let mut pass = Pass {
            derivatives: self,
            slopes: back.none(),
            sums: Sums {
                by_constants: constants.iter().map(|(own, _)| vec![0.0; own.len()]).collect(),
                given,
                total: vec![0.0; varied.whole.numbers().len()],
            },
            constants,
            back,
            rows,
            left: rows.len(),
        };
        let last = rows.last().map_or(0, |(row, _)| row.steps);
        let most = varied.steps_within(MOST);
        let (mut tape, mut begins) = (Tape::default(), vec![room.state.clone()]);
        for begin in (most..last).step_by(usize::try_from(most).unwrap_or(usize::MAX)) {
            self.make(&mut room, begin - most..begin, None)?;
            begins.push(room.state.clone());
        }
        let mut end = None;
        for (number, begin) in (0..).map(|number: u64| number * most).zip(&begins).collect::<Vec<_>>().into_iter().rev()
        {
            let steps = number..last.min(number.saturating_add(most));
            room.state.copy_from_slice(begin);
            tape.clear();
            self.make(&mut room, steps.clone(), Some(&mut tape))?;
            if end.is_none() {
                end = Some(room.state[..varied.whole.codes.sizes.history()].to_vec());
                pass.read(&mut room, last, end.as_deref().unwrap_or_default())?;
            }
            for step in steps.clone().rev() {
                let place = usize::try_from(step - steps.start).unwrap_or(usize::MAX);
                pass.step(&tape, place);
                pass.read(&mut room, step, varied.before(&tape, place))?;
            }
        }
        pass.finish(start)
    }

    /// The derivatives by the velocity at the start, if it is given, in the place of those by the momentum: other parameters, and
    /// another attitude, have another momentum at this velocity. Returns the derivatives by the velocity.
    pub fn at_velocity(&self, start: &[f64], velocity: &[f64], gradient: &mut Gradient) -> Vec<f64> {
        let (back, sizes) = (self.back(), &self.varied.whole.codes.sizes);
        let (numbers, attitude) = (self.varied.numbers_at(0.0), &start[..sizes.entries]);
        let advected = back.view(&numbers, attitude);
        let mut slopes = back.none();
        let by_velocity = back.through_momentum((&numbers, &advected), velocity, &gradient.momentum, &mut slopes);
        back.through_view(&numbers, attitude, &mut slopes);
        let add = |sum: &mut Vec<f64>, addends: &[f64]| sum.iter_mut().zip(addends).for_each(|(sum, one)| *sum += one);
        add(&mut gradient.displacement, &slopes.by_state);
        add(&mut gradient.parameters, &slopes.by_numbers);
        by_velocity
    }

    /// The attitude `g exp ζ̂`, the matrices of its factors row by row.
    #[must_use]
    pub fn displaced(&self, attitude: &[f64], displacement: &[f64]) -> Vec<f64> {
        displaced(&self.varied.whole.codes.factors, attitude, displacement)
    }

    /// The derivatives of a displacement after `ζ` by `ζ`, `exp(ζ̂)⁻¹ d exp(ζ̂)`, column by column.
    #[must_use]
    pub fn displacement_slopes(&self, displacement: &[f64]) -> Option<Vec<f64>> {
        tangent(&self.varied.whole.codes.factors, displacement)
    }

    /// Makes steps in a room, on a tape if there is one.
    fn make(
        &self,
        room: &mut Room<B>,
        steps: std::ops::Range<u64>,
        mut tape: Option<&mut Tape>,
    ) -> Result<(), StepError> {
        let h = self.varied.step_size();
        for _ in steps {
            let span = [h * room.state[room.state.len() - 1], h];
            match &mut tape {
                Some(tape) => self.varied.record(room, span, tape)?,
                None => self.varied.watched(room, span, &mut |_, _| ()).map(|_| ())?,
            }
        }
        Ok(())
    }

    pub(super) fn check(&self, by: &Reading) -> Result<(), StepError> {
        let sizes = &self.varied.whole.codes.sizes;
        let lists = [
            (&by.velocity, sizes.n),
            (&by.momentum, sizes.n),
            (&by.attitude, sizes.entries),
            (&by.energy, 1),
            (&by.spatial_momentum, sizes.n),
        ];
        let is_right = |(list, count): &(&Vec<f64>, usize)| list.is_empty() || list.len() == *count;
        if lists.iter().all(is_right) { Ok(()) } else { Err(StepError::NonFinite { what: "derivative by a state" }) }
    }

    /// Adds the derivatives by what is read of a state, without its memory.
    pub(super) fn read(&self, numbers: &[f64], state: &[f64], by: &Reading, slopes: &mut Slopes) {
        let (back, sizes) = (self.back(), &self.varied.whole.codes.sizes);
        let (attitude, rest) = state.split_at(sizes.entries);
        let (momentum, advected) = rest.split_at(sizes.n);
        let advected = if self.varied.is_steady() { advected.to_vec() } else { back.view(numbers, attitude) };
        if !by.attitude.is_empty() {
            back.through_attitude(&by.attitude, attitude, slopes);
        }
        slopes.by_state[sizes.n..2 * sizes.n].iter_mut().zip(&by.momentum).for_each(|(sum, slope)| *sum += slope);
        if !by.spatial_momentum.is_empty() {
            back.through_spatial((attitude, momentum), &by.spatial_momentum, slopes);
        }
        if by.velocity.is_empty() && by.energy.is_empty() {
            return;
        }
        let limit = Limit { codes: back.codes, numbers, advected: &advected };
        let velocity = limit.velocity(momentum);
        let mut by_velocity = vec![0.0; sizes.n];
        if let [energy] = by.energy[..] {
            by_velocity = back.through_energy((numbers, &advected), &velocity, energy, slopes);
        }
        by_velocity.iter_mut().zip(&by.velocity).for_each(|(sum, slope)| *sum += slope);
        back.through_velocity((numbers, &advected), &velocity, &by_velocity, slopes);
    }
}

/// The way back through a motion.
struct Pass<'a, 'g, B: Backend<f64>> {
    derivatives: &'a Derivatives<B>,
    back: Back<'a, B>,
    constants: Vec<Constants>,
    slopes: Slopes,
    sums: Sums<'g>,
    rows: &'a [(Row, Reading)],
    /// The number of rows that are left.
    left: usize,
}

impl<B: Backend<f64>> Pass<'_, '_, B> {
    fn step(&mut self, tape: &Tape, place: usize) {
        let varied = &self.derivatives.varied;
        varied.back(&self.back, (tape, place), &self.constants, &mut self.slopes, &mut self.sums);
    }

    /// Adds the derivatives by all rows from this state to the next.
    fn read(&mut self, room: &mut Room<B>, steps: u64, state: &[f64]) -> Result<(), StepError> {
        let rows = self.rows;
        while let Some((row, by)) = self.left.checked_sub(1).map(|at| &rows[at]).filter(|(row, _)| row.steps >= steps) {
            self.left -= 1;
            if row.fraction == 0.0 {
                self.row(self.derivatives.varied.time_of(steps), state, by);
            } else {
                self.part(room, (steps, row.fraction), state, by)?;
            }
        }
        Ok(())
    }

    /// Adds the derivatives by a state at a time.
    fn row(&mut self, time: f64, state: &[f64], by: &Reading) {
        let varied = &self.derivatives.varied;
        let numbers = varied.numbers_at(time);
        self.derivatives.read(&numbers, state, by, &mut self.slopes);
        if !varied.is_steady() {
            self.back.through_view(&numbers, &state[..varied.whole.codes.sizes.entries], &mut self.slopes);
            self.sums.hand_on([time, 0.0], &mut self.slopes);
        }
    }

    /// Adds the derivatives by the state after a part of a step.
    fn part(
        &mut self,
        room: &mut Room<B>,
        (steps, fraction): (u64, f64),
        state: &[f64],
        by: &Reading,
    ) -> Result<(), StepError> {
        let varied = &self.derivatives.varied;
        let (start, length) = (varied.time_of(steps), varied.step_size() * fraction);
        room.state[..state.len()].copy_from_slice(state);
        varied.forget(room, [start, length])?;
        let mut tape = Tape::default();
        varied.record(room, [start, length], &mut tape)?;
        let constants = Derivatives::constants(room);
        let before = std::mem::replace(&mut self.slopes, self.back.none());
        self.row(start + length, &room.state[..state.len()], by);
        let own = constants.iter().map(|(own, _)| vec![0.0; own.len()]).collect();
        let by_constants = std::mem::replace(&mut self.sums.by_constants, own);
        varied.back(&self.back, (&tape, 0), &constants, &mut self.slopes, &mut self.sums);
        let own = std::mem::replace(&mut self.sums.by_constants, by_constants);
        if varied.is_steady() {
            for ((_, h), own) in constants.iter().zip(&own) {
                self.back.through_constants((varied.whole.numbers(), *h), own, &mut self.slopes.by_numbers);
            }
        }
        self.slopes.add(&before);
        Ok(())
    }

    /// The derivatives by the start.
    fn finish(mut self, start: &[f64]) -> Result<Gradient, StepError> {
        let varied = &self.derivatives.varied;
        let (n, numbers) = (varied.whole.codes.sizes.n, varied.numbers_at(0.0));
        if varied.is_steady() {
            for ((_, h), own) in self.constants.iter().zip(&self.sums.by_constants) {
                self.back.through_constants((&numbers, *h), own, &mut self.slopes.by_numbers);
            }
        }
        self.back.through_view(&numbers, &start[..varied.whole.codes.sizes.entries], &mut self.slopes);
        let Slopes { by_state, by_numbers, .. } = &self.slopes;
        let parameters: Vec<f64> = by_numbers.iter().zip(&self.sums.total).map(|(own, sum)| own + sum).collect();
        if !are_finite(by_state) || !are_finite(&parameters) {
            return Err(StepError::NonFinite { what: "derivative" });
        }
        Ok(Gradient { displacement: by_state[..n].to_vec(), momentum: by_state[n..2 * n].to_vec(), parameters })
    }
}
