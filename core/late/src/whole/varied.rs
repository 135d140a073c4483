//! Steps whose parameters change with time, or whose lengths differ.

use std::fmt;
use std::rc::Rc;
use std::sync::Arc;

use liestep::motion::{Cost, Layout, Propagator, Remedy, StepReport};
use liestep::with::{Clock, Method};
use liestep::{SetupError, StepError};

use super::composed::Stages;
use super::course::Course;
use super::lengths::{Lengths, MEMORY, Memory, Rate};
use super::linear::are_finite;
use super::step::{Increment, StepCodes};
use super::stepper::{Whole, write_or_nan};
use crate::code::{Backend, Interpreter};

/// A stepper of a declaration whose parameters change with time, or whose steps have lengths of their own; by
/// [`Whole::driven`], [`Whole::with_clock`] and [`Whole::with_density`].
///
/// Each step has the numbers of its middle, or their means over it; in a composition each stage has those of its own time, so that the order
/// of the method stays where the numbers change smoothly. A state has the numbers of its own time, and so do its energy and
/// velocity. A part of a step is a step of its length.
///
/// # Examples
///
/// Damping as a kinetic energy that grows, by Caldirola and Kanai: `l = e^{γt} (ẋ² − ω² x²)/2`.
///
/// ```
/// use liestep::motion::Propagator as _;
/// use liestep_late::{Declaration, Whole};
///
/// let oscillator = Declaration::parse(
///     "#[lagrangian(group = R1, velocity = v, advected(p = fixed), discretise = trapezoid(Cayley),
///     l = m * v[0].powi(2) / 2.0 - k * p[0].powi(2) / 2.0)]
///     struct Oscillator { m: f64, k: f64, fixed: Point1<f64> }",
/// )?;
/// let numbers = oscillator.numbers(&[("m", &[1.0]), ("k", &[4.0]), ("fixed", &[0.0])])?;
/// let whole: Whole = Whole::of(oscillator, &numbers, 0.01, "composition Suzuki 4".parse()?)?;
/// let damped = whole.driven(|time: f64, numbers: &mut [f64]| {
///     let growth = (0.2 * time).exp();
///     (numbers[0], numbers[1]) = (growth, 4.0 * growth);
/// })?;
/// let mut state = damped.start(&[1.0, 1.0, 0.0, 1.0], &[0.0])?;
/// damped.run(&mut state, 1000)?;
/// let rate = (4.0_f64 - 0.01).sqrt();
/// let expected = (-1.0_f64).exp() * ((10.0 * rate).cos() + 0.1 / rate * (10.0 * rate).sin());
/// assert!((state[1] - expected).abs() < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Varied<B: Backend<f64> = Interpreter> {
    /// The stepper with the numbers of the start, and the unit of the steps.
    pub(super) whole: Whole<B>,
    pub(super) course: Option<Rc<dyn Course>>,
    pub(super) lengths: Lengths,
    layout: Layout,
    /// For each stage its begin and its length as fractions of the step.
    pub(super) stages: Vec<[f64; 2]>,
}

impl<B: Backend<f64>> Clone for Varied<B> {
    fn clone(&self) -> Self {
        let (whole, course, lengths) = (self.whole.clone(), self.course.clone(), self.lengths.clone());
        Self { whole, course, lengths, layout: self.layout.clone(), stages: self.stages.clone() }
    }
}

impl<B: Backend<f64>> fmt::Debug for Varied<B> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let is_driven = self.course.is_some();
        f.debug_struct("Varied").field("whole", &self.whole).field("is_driven", &is_driven).finish_non_exhaustive()
    }
}

/// The room of a step: a stepper for each stage, and a state of [`Whole`].
pub(super) struct Room<B: Backend<f64>> {
    pub(super) stages: Vec<Whole<B>>,
    pub(super) state: Vec<f64>,
    numbers: Vec<f64>,
    rest: Vec<f64>,
}

/// A value that isn't finite, or a time without one.
const GIVEN: StepError = StepError::NonFinite { what: "value given to the step" };
const OF_THIS_LENGTH: StepError = StepError::NonFinite { what: "constants of a step of this length" };

fn finite(numbers: &[f64]) -> Result<(), StepError> {
    if are_finite(numbers) { Ok(()) } else { Err(GIVEN) }
}

/// # Wrap: parameters and lengths of steps
impl<B: Backend<f64>> Whole<B> {
    /// A stepper whose parameters change with time, by any [`Course`]. The numbers of the start are those at the time zero.
    ///
    /// # Errors
    ///
    /// The errors of [`with`](Self::with) for the numbers at the time zero.
    pub fn driven(&self, course: impl Course + 'static) -> Result<Varied<B>, SetupError> {
        self.varied().driven(course)
    }

    /// A stepper with the lengths of a clock, in units of this one's `h`. After the last length of a clock that isn't
    /// repeated a step is [`StepError::NoLength`].
    #[must_use]
    pub fn with_clock(&self, clock: Clock) -> Varied<B> {
        Varied { lengths: Lengths::Clock(clock), ..self.varied() }
    }

    /// A stepper of steps of `h/ρ`, the first about `h`. The argument is the rate `G = d/dt ln ρ` of the desired density of
    /// steps, 1/s, as a function of a state's numbers and of the body velocity, see
    /// [`Stepper::with_density`](liestep::Stepper::with_density).
    #[must_use]
    pub fn with_density(&self, rate: impl Fn(&[f64], &[f64]) -> f64 + 'static) -> Varied<B> {
        let rate: Rc<Rate> = Rc::new(rate);
        Varied { lengths: Lengths::Density(rate), ..self.varied() }
    }

    pub(super) fn varied(&self) -> Varied<B> {
        let mut begin = 0.0;
        let share = |share| {
            begin += share;
            [begin - share, share]
        };
        let stages = self.stages.shares().map(share).collect();
        let mut layout = self.codes.layout.clone();
        layout.memory += MEMORY;
        Varied { whole: self.clone(), course: None, lengths: Lengths::Equal, layout, stages }
    }
}

impl<B: Backend<f64>> Varied<B> {
    /// The stepper whose parameters change with time, too.
    ///
    /// # Errors
    ///
    /// The errors of [`Whole::with`] for the numbers at the time zero.
    pub fn driven(self, course: impl Course + 'static) -> Result<Self, SetupError> {
        self.along(Rc::new(course))
    }

    pub(super) fn along(self, course: Rc<dyn Course>) -> Result<Self, SetupError> {
        let mut numbers = self.whole.numbers().to_vec();
        course.at(0.0, &mut numbers);
        let whole = self.whole.with(&numbers, self.whole.h)?;
        Ok(Self { whole, course: Some(course), ..self })
    }

    fn memory<'a>(&self, state: &'a [f64]) -> &'a [f64] {
        &state[self.whole.codes.sizes.state() - 1..state.len() - 1]
    }

    fn room(&self) -> Result<Room<B>, SetupError> {
        let own = |&[_, share]: &[f64; 2]| -> Result<Whole<B>, SetupError> {
            let (codes, h) = (Arc::clone(&self.whole.codes), self.whole.h * share);
            let stages = Stages::of(&codes, &self.whole.numbers, h, None)?;
            let (numbers, method) = (self.whole.numbers.to_vec().into(), Method::default());
            Ok(Whole { codes, numbers, h, method, stages, inputs: None })
        };
        let stages = self.stages.iter().map(own).collect::<Result<_, _>>()?;
        let state = vec![0.0; self.whole.codes.sizes.state()];
        Ok(Room { stages, state, numbers: self.whole.numbers.to_vec(), rest: vec![0.0; self.whole.room()] })
    }

    /// The numbers at a time.
    pub(super) fn numbers_at(&self, time: f64) -> Vec<f64> {
        let mut numbers = self.whole.numbers.to_vec();
        if let Some(course) = &self.course {
            course.at(time, &mut numbers);
        }
        numbers
    }

    /// The length of the step ahead of a state or behind it, s; NaN if there is none.
    fn length_of(&self, state: &[f64], is_ahead: bool) -> f64 {
        let (unit, steps) = (self.whole.h, state[state.len() - 1]);
        let velocity = || {
            let mut velocity = vec![0.0; self.whole.codes.sizes.n];
            self.velocity(state, &mut velocity);
            velocity
        };
        self.lengths.length([unit, steps], (state, &velocity), (self.memory(state), is_ahead))
    }

    /// The length of a step, if it is valid: of the sign of the unit, and long enough to change the rounded time.
    fn checked_length(&self, state: &[f64], is_ahead: bool) -> Result<f64, StepError> {
        if matches!(self.lengths, Lengths::Equal) {
            return Ok(self.whole.h);
        }
        let (length, unit, now) = (self.length_of(state, is_ahead), self.whole.h, self.time(state));
        let goes_on = length.is_finite() && length * unit.signum() > 0.0 && (now + length).to_bits() != now.to_bits();
        if goes_on || (unit == 0.0 && length == 0.0) { Ok(length) } else { Err(StepError::NoLength { length }) }
    }

    /// One step of a state of the right length. After an error the state is as it was.
    fn step_in(&self, state: &mut [f64], room: &mut Room<B>) -> Result<StepReport, StepError> {
        let (length, start, last) = (self.checked_length(state, true)?, self.time(state), state.len() - 1);
        let sizes = &self.whole.codes.sizes;
        let before = Memory::read(self.memory(state));
        // The memory of increments is that of steps of the unit.
        let (ratio, back) = (length / self.whole.h, self.whole.h / length);
        let has_ratio = ratio.is_finite() && back.is_finite();
        room.load(state);
        if has_ratio {
            room.state[sizes.history()..sizes.state() - 1].iter_mut().for_each(|entry| *entry *= ratio);
        } else {
            self.forget(room, [start, length])?;
        }
        let report = match self.advance(room, [start, length]) {
            Ok(iterations) => StepReport::of(iterations),
            Err(error) => self.in_parts(room, state, [start, length], error)?,
        };
        if has_ratio {
            room.state[sizes.history()..sizes.state() - 1].iter_mut().for_each(|entry| *entry *= back);
        }
        let inner = room.state.len() - 1;
        state[..inner].copy_from_slice(&room.state[..inner]);
        state[last] = room.state[inner];
        let velocity = || {
            let numbered = StepCodes::of(&self.whole.codes, &room.numbers);
            let limit = numbered.limit(&room.state[sizes.advected()..sizes.history()]);
            limit.velocity(&room.state[sizes.momentum()..sizes.advected()])
        };
        let after = self.lengths.after([self.whole.h, length], (&room.state, &velocity), before);
        state[inner..last].copy_from_slice(&after.0);
        Ok(report)
    }

    /// Takes the numbers of a stage of this start and length, and shows a state their values in space.
    fn enter(
        &self,
        stage: &mut Whole<B>,
        numbers: &mut [f64],
        span: [f64; 2],
        state: &mut [f64],
    ) -> Result<(), StepError> {
        let Some(course) = &self.course else {
            if stage.h.to_bits() == span[1].to_bits() {
                return Ok(());
            }
            return stage.take(numbers, span[1]).map_err(|_| OF_THIS_LENGTH);
        };
        course.over(span, numbers);
        finite(numbers)?;
        stage.take(numbers, span[1]).map_err(|_| GIVEN)?;
        stage.see(state);
        Ok(())
    }

    /// Makes one step of this start and length in a room's state, and counts it.
    fn advance(&self, room: &mut Room<B>, span: [f64; 2]) -> Result<u32, StepError> {
        self.watched(room, span, &mut |_, _| ())
    }

    /// One step, whose stages are watched: `watch` gets the stepper of each and the state before it, and then after it.
    pub(super) fn watched(
        &self,
        room: &mut Room<B>,
        [start, length]: [f64; 2],
        watch: &mut impl FnMut(&Whole<B>, &[f64]),
    ) -> Result<u32, StepError> {
        let Room { stages, state, numbers, rest: room } = room;
        let of = |stage: usize| {
            let [begin, share] = self.stages[stage];
            [start + length * begin, length * share]
        };
        let iterations = if self.whole.stages.is_single() {
            let stage = &mut stages[0];
            self.enter(stage, numbers, of(0), state)?;
            watch(stage, state);
            let iterations = match stage.stages.step_in_one_piece(stage.numbered(), state) {
                Some(iterations) => iterations,
                None => stage.stages.step(stage.numbered(), state, room)?,
            };
            watch(stage, state);
            iterations
        } else {
            let mut make = |number: usize, next: &mut [f64], room: &mut [f64]| -> Result<Increment, StepError> {
                let stage = &mut stages[number];
                self.enter(stage, numbers, of(number), next)?;
                watch(stage, next);
                let made = stage.numbered().increment(stage.stages.first(), next, room)?;
                watch(stage, next);
                Ok(made)
            };
            self.whole.stages.each(self.whole.numbered(), state, room, &mut make)?
        };
        let Some(course) = &self.course else { return Ok(iterations) };
        course.at(start + length, numbers);
        finite(numbers)?;
        let sizes = &self.whole.codes.sizes;
        let seen = self.whole.codes.seen(numbers, &state[..sizes.entries]);
        state[sizes.advected()..sizes.history()].copy_from_slice(&seen);
        Ok(iterations)
    }

    /// Gives a room's state the memory of a new start, for a step of this start and length.
    pub(super) fn forget(&self, room: &mut Room<B>, [start, length]: [f64; 2]) -> Result<(), StepError> {
        let [_, share] = self.stages[0];
        let Room { stages, state, numbers, .. } = room;
        self.enter(&mut stages[0], numbers, [start, length * share], state)?;
        stages[0].forget(state);
        Ok(())
    }

    /// Gives a room's state the memory of a new start, for the step ahead of this time. Where no values lie ahead, as at the
    /// end of a signal, those of the time serve. What is advected is left as it is.
    fn look_ahead(&self, room: &mut Room<B>, time: f64) -> Result<(), StepError> {
        let sizes = &self.whole.codes.sizes;
        let carried = sizes.advected()..sizes.history();
        let advected = room.state[carried.clone()].to_vec();
        if let Err(error) = self.forget(room, [time, self.whole.h]) {
            let Room { stages, state, numbers, .. } = &mut *room;
            *numbers = self.numbers_at(time);
            finite(numbers)?;
            stages[0].take(numbers, self.whole.h * self.stages[0][1]).map_err(|_| error)?;
            stages[0].forget(state);
        }
        room.state[carried].copy_from_slice(&advected);
        Ok(())
    }

    /// Makes the step in equal parts, if the method says so; otherwise the error, for the whole step.
    #[cold]
    #[inline(never)]
    fn in_parts(
        &self,
        room: &mut Room<B>,
        state: &[f64],
        [start, length]: [f64; 2],
        error: StepError,
    ) -> Result<StepReport, StepError> {
        if matches!(error, StepError::NonFinite { .. }) {
            return Err(error);
        }
        let (last, mut parts) = (room.state.len() - 1, 2);
        while parts <= self.whole.method.substeps {
            room.load(state);
            let part = length / f64::from(parts);
            self.forget(room, [start, part])?;
            room.state[last] = 0.0;
            let each = (0..parts).map(|number| self.advance(room, [start + part * f64::from(number), part]));
            if let Ok(iterations) = each.sum::<Result<u32, StepError>>() {
                room.state[last] = state[state.len() - 1] + 1.0;
                // The increment of a part doesn't predict that of a whole step.
                self.look_ahead(room, start + length)?;
                return Ok(StepReport { iterations, remedy: Some(Remedy::Substeps(parts)) });
            }
            let Some(more) = parts.checked_mul(2) else { break };
            parts = more;
        }
        room.load(state);
        if let Some(course) = &self.course {
            course.over([start, length], &mut room.numbers);
        }
        let whole = self.whole.with(&room.numbers, length);
        Err(whole.map_or_else(|_| error.clone(), |whole| whole.explained(&room.state, error.clone())))
    }

    fn stretch(&self, state: &mut [f64], steps: u64, room: &mut Room<B>) -> Result<u64, StepError> {
        let mut iterations = 0;
        for _ in 0..steps {
            iterations += u64::from(self.step_in(state, room)?.iterations);
        }
        Ok(iterations)
    }

    pub(super) fn roomy(&self) -> Result<Room<B>, StepError> {
        self.room().map_err(|_| OF_THIS_LENGTH)
    }
}

impl<B: Backend<f64>> Room<B> {
    /// Copies a state without the memory of the lengths.
    pub(super) fn load(&mut self, state: &[f64]) {
        let last = self.state.len() - 1;
        self.state[..last].copy_from_slice(&state[..last]);
        self.state[last] = state[state.len() - 1];
    }
}

impl<B: Backend<f64>> Propagator for Varied<B> {
    fn layout(&self) -> &Layout {
        &self.layout
    }

    fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError> {
        Ok(Memory::START.within(&self.whole.start(attitude, velocity)?))
    }

    fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        self.layout.checked(state)?;
        self.step_in(state, &mut self.roomy()?)
    }

    fn run(&self, state: &mut [f64], steps: u64) -> Result<u64, StepError> {
        let mut next = self.layout.checked(state)?.to_vec();
        let iterations = self.stretch(&mut next, steps, &mut self.roomy()?)?;
        state.copy_from_slice(&next);
        Ok(iterations)
    }

    fn run_stretches(
        &self,
        state: &mut [f64],
        mut steps: u64,
        next: &mut dyn FnMut(&[f64], f64) -> u64,
    ) -> Result<u64, StepError> {
        self.layout.checked(state)?;
        let (mut room, mut iterations) = (self.roomy()?, 0);
        while steps > 0 {
            iterations += self.stretch(state, steps, &mut room)?;
            steps = next(state, self.time(state));
        }
        Ok(iterations)
    }

    fn part(&self, state: &[f64], fraction: f64) -> Result<Box<[f64]>, StepError> {
        self.layout.checked(state)?;
        let mut room = self.roomy()?;
        room.load(state);
        let (start, mut memory) = (self.time(state), Memory::read(self.memory(state)));
        // So small a change would be lost in rounding. NaN isn't tiny.
        let is_tiny = fraction.abs() < f64::EPSILON * f64::EPSILON;
        let length = if is_tiny { 0.0 } else { self.checked_length(state, fraction > 0.0)? * fraction };
        if length != 0.0 {
            let wrong = || StepError::NonFinite { what: "part of the step" };
            if !length.is_finite() {
                return Err(wrong());
            }
            self.forget(&mut room, [start, length])?;
            if let Err(error) = self.advance(&mut room, [start, length]) {
                self.in_parts(&mut room, state, [start, length], error)?;
            }
            memory.pass(length);
        }
        let last = room.state.len() - 1;
        room.state[last] = state[state.len() - 1];
        let mut part = memory.within(&room.state);
        self.look_ahead(&mut room, start + length)?;
        let sizes = &self.whole.codes.sizes;
        part[sizes.history()..last].copy_from_slice(&room.state[sizes.history()..last]);
        Ok(part)
    }

    fn adopt(&self, state: &[f64]) -> Box<[f64]> {
        Memory::START.within(&self.whole.adopt(state))
    }

    fn cost(&self) -> Option<Cost> {
        self.whole.cost()
    }

    fn step_size(&self) -> f64 {
        self.whole.h
    }

    fn time(&self, state: &[f64]) -> f64 {
        self.layout
            .checked(state)
            .map_or(f64::NAN, |state| self.lengths.time([self.whole.h, state[state.len() - 1]], self.memory(state)))
    }

    fn length(&self, state: &[f64]) -> Option<f64> {
        let is_varied = !matches!(self.lengths, Lengths::Equal);
        is_varied.then(|| self.layout.checked(state).map_or(f64::NAN, |state| self.length_of(state, true)))
    }

    fn velocity(&self, state: &[f64], velocity: &mut [f64]) {
        let sizes = &self.whole.codes.sizes;
        let found = self.layout.checked(state).map(|state| {
            let numbers = self.numbers_at(self.time(state));
            let numbered = StepCodes::of(&self.whole.codes, &numbers);
            numbered
                .limit(&state[sizes.advected()..sizes.history()])
                .velocity(&state[sizes.momentum()..sizes.advected()])
        });
        write_or_nan(found.ok(), velocity);
    }

    fn energy(&self, state: &[f64]) -> f64 {
        let sizes = &self.whole.codes.sizes;
        self.layout.checked(state).map_or(f64::NAN, |state| {
            let numbers = self.numbers_at(self.time(state));
            let numbered = StepCodes::of(&self.whole.codes, &numbers);
            let limit = numbered.limit(&state[sizes.advected()..sizes.history()]);
            limit.energy(&limit.velocity(&state[sizes.momentum()..sizes.advected()]))
        })
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let inner = self.layout.checked(state).map_or(&[][..], |state| &state[..self.whole.codes.sizes.state()]);
        self.whole.spatial_momentum(inner, momentum);
    }

    fn defect(&self, state: &[f64]) -> f64 {
        let inner = self.layout.checked(state).map_or(&[][..], |state| &state[..self.whole.codes.sizes.state()]);
        self.whole.defect(inner)
    }
}
