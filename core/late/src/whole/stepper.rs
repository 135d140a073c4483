//! The stepper: a declaration with numbers, a step and a method.

use std::sync::Arc;

use liestep::__private::largest_fraction;
use liestep::motion::{Cost, Layout, Propagator, Remedy, StepReport};
use liestep::with::{Method, Scheme};
use liestep::{SetupError, StepError};
use liestep_derivation::Array;
use thiserror::Error;

use super::codes::{Codes, rare};
use super::composed::Stages;
use super::diagnosis::Step;
use super::linear::are_finite;
use super::step::StepCodes;
use crate::code::{Backend, Interpreter};
use crate::declaration::Declaration;
use crate::error::LateError;

/// A stepper of a declaration on any group, whose states are slices of numbers.
///
/// Groups by generators that are written in the text are among them, and any advected parameters. `B` runs the programs of a
/// step. Steppers of one declaration share its code, see [`with`](Self::with).
///
/// # Examples
///
/// A motion on SL(3), whose group is a part of the text.
///
/// ```
/// use liestep::motion::Propagator as _;
/// use liestep_late::{Declaration, Whole};
///
/// let flow = Declaration::parse(
///     "#[lagrangian(
///         group = SL3,
///         generators = [
///             [[0., 1., 0.], [0., 0., 0.], [0., 0., 0.]], [[0., 0., 1.], [0., 0., 0.], [0., 0., 0.]],
///             [[0., 0., 0.], [0., 0., 1.], [0., 0., 0.]], [[0., 0., 0.], [1., 0., 0.], [0., 0., 0.]],
///             [[0., 0., 0.], [0., 0., 0.], [1., 0., 0.]], [[0., 0., 0.], [0., 0., 0.], [0., 1., 0.]],
///             [[1., 0., 0.], [0., -1., 0.], [0., 0., 0.]], [[0., 0., 0.], [0., 1., 0.], [0., 0., -1.]],
///         ],
///         l_d = (((F - I) * J * (F - I).transpose()).trace()
///             + ((I - inverse(F)) * J * (I - inverse(F)).transpose()).trace()) / (4 * h),
///     )]
///     struct Flow { J: Matrix3<f64> }",
/// )?;
/// let numbers = flow.numbers(&[("J", &[1.0, 0.1, 0.0, 0.1, 1.2, 0.0, 0.0, 0.0, 1.5])])?;
/// let stepper: Whole = Whole::of(flow, &numbers, 0.01, "composition Suzuki 4".parse()?)?;
/// let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
/// let mut state = stepper.start(&identity, &[0.1, 0.2, -0.1, 0.3, 0.0, 0.1, -0.2, 0.1])?;
/// let energy = stepper.energy(&state);
/// stepper.run(&mut state, 100)?;
/// assert!((stepper.energy(&state) - energy).abs() < 1e-9 * energy);
/// assert!(stepper.defect(&state) < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Whole<B: Backend<f64> = Interpreter> {
    pub(super) codes: Arc<Codes<B>>,
    pub(super) numbers: Arc<[f64]>,
    pub(super) h: f64,
    pub(super) method: Method,
    pub(super) stages: Stages,
    /// The places of the parameters that are inputs of the [`Plant`](liestep::gradients::Plant); none for forces.
    pub(super) inputs: Option<Arc<[usize]>>,
}

impl<B: Backend<f64>> Clone for Whole<B> {
    fn clone(&self) -> Self {
        let (codes, numbers, stages) = (Arc::clone(&self.codes), Arc::clone(&self.numbers), self.stages.clone());
        Self { codes, numbers, h: self.h, method: self.method, stages, inputs: self.inputs.clone() }
    }
}

/// The reason why a declaration has no stepper with these numbers.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum WholeError {
    /// The declaration has no step.
    #[error(transparent)]
    Declaration(#[from] LateError),
    /// The numbers, the step or the method can't be used.
    #[error(transparent)]
    Setup(#[from] SetupError),
}

/// A state of another layout.
pub(super) const OF_THIS_LAYOUT: StepError = StepError::NonFinite { what: "state of this layout" };

impl<B: Backend<f64>> Whole<B> {
    /// The stepper of a declaration with the [numbers](Declaration::numbers) of all its parameters and the step `h`, s. Code is
    /// written for the first one of a declaration.
    ///
    /// The method is the [step](Scheme::Step) or a [composition](Scheme::Composition), with or without
    /// [substeps](Method::substeps).
    ///
    /// # Errors
    ///
    /// The declaration has no kinetic part or is too large; the errors of [`Stepper::new`](liestep::Stepper::new).
    pub fn of(declaration: &'static Declaration, numbers: &[f64], h: f64, method: Method) -> Result<Self, WholeError> {
        let (expected, found) = (declaration.count(), numbers.len());
        if expected != found {
            return Err(LateError::Size { name: declaration.name.clone(), expected, found }.into());
        }
        Ok(Self::shared(&Codes::of(declaration)?, numbers.into(), h, method)?)
    }

    /// The stepper of the same declaration and method with other numbers, or another step, by the same code.
    ///
    /// A state of this one may be continued; if a value in space is another, start anew or [adopt](Propagator::adopt) it, as
    /// states contain these values as they are seen from the body.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::new`](liestep::Stepper::new).
    pub fn with(&self, numbers: &[f64], h: f64) -> Result<Self, SetupError> {
        SetupError::check_length("parameters", numbers.len(), self.numbers.len())?;
        Ok(Self { inputs: self.inputs.clone(), ..Self::shared(&self.codes, numbers.into(), h, self.method)? })
    }

    fn shared(codes: &Arc<Codes<B>>, numbers: Arc<[f64]>, h: f64, method: Method) -> Result<Self, SetupError> {
        let scheme = match method.scheme {
            Scheme::Step => None,
            Scheme::Composition(scheme) => Some(scheme),
            _ => {
                let cause = "isn't known for declarations that are read: take \"step\" or a \"composition\"";
                return Err(SetupError::Method { cause });
            }
        };
        if method.compensated || method.floor.is_some() {
            let cause = "has a wrapper that isn't known for declarations that are read: take \"substeps\" or none";
            return Err(SetupError::Method { cause });
        }
        let stages = Stages::of(codes, &numbers, h, scheme)?;
        Ok(Self { codes: Arc::clone(codes), numbers, h, method, stages, inputs: None })
    }

    /// The declaration.
    #[must_use]
    pub fn declaration(&self) -> &'static Declaration {
        self.codes.declaration
    }

    /// The numbers of all parameters.
    #[must_use]
    pub fn numbers(&self) -> &[f64] {
        &self.numbers
    }

    /// The stages of a step: the fraction of the step that each takes; its length, the determinant above which a Jacobian serves
    /// twice, and the square of the largest right side; its constants.
    pub(crate) fn stage_numbers(&self) -> impl Iterator<Item = (f64, [f64; 3], &[f64])> {
        let stages = self.stages.numbers();
        stages.map(|(gamma, of)| (gamma, [of.h, of.safe, of.largest_target], of.numbers.as_slice()))
    }

    /// The method.
    #[must_use]
    pub const fn method(&self) -> Method {
        self.method
    }

    /// Compiles the code of a usual step now that is otherwise compiled after some runs.
    pub fn prepare(&self) {
        let usual = self.codes.usual();
        if !B::prepare_step(&usual) {
            usual.programs().for_each(B::prepare);
        }
    }

    /// The state at the start, from an attitude, as the matrices of its factors row by row, and a momentum in the body frame.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::start_with_momentum`](liestep::Stepper::start_with_momentum).
    pub fn start_with_momentum(&self, attitude: &[f64], momentum: &[f64]) -> Result<Box<[f64]>, SetupError> {
        let sizes = &self.codes.sizes;
        SetupError::check_length("attitude", attitude.len(), sizes.entries)?;
        SetupError::check_length("momentum", momentum.len(), sizes.n)?;
        self.check_attitude(attitude)?;
        if !are_finite(momentum) {
            return Err(SetupError::NonFinite { what: "momentum" });
        }
        let advected = self.codes.seen(&self.numbers, attitude);
        let limit = self.numbered().limit(&advected);
        if !self.declaration().has_constant_inertia {
            limit.check_inertia()?;
        }
        limit.check_momentum(momentum)?;
        limit.check_constraints(momentum, &self.stages.first().numbers)?;
        let state = self.begin(attitude, momentum);
        if !are_finite(&state[sizes.advected()..sizes.history()]) {
            return Err(SetupError::NonFinite { what: "view of what is advected" });
        }
        if !are_finite(&state[sizes.history()..]) {
            return Err(SetupError::NonFinite { what: "velocity of the momentum" });
        }
        Ok(state)
    }

    pub(super) fn numbered(&self) -> StepCodes<'_, B> {
        StepCodes::of(&self.codes, &self.numbers)
    }

    /// The state if it has the length of one.
    pub(super) fn checked<'a>(&self, state: &'a [f64]) -> Result<&'a [f64], StepError> {
        if state.len() == self.codes.sizes.state() { Ok(state) } else { Err(OF_THIS_LAYOUT) }
    }

    fn check_attitude(&self, attitude: &[f64]) -> Result<(), SetupError> {
        let defect = rare::<B>(&self.codes.code.defect, &[], [(Array::Attitude, attitude), (Array::Half, &[])])[0];
        // A unit quaternion or a matrix with twelve printed digits passes; NaN fails.
        if defect <= f64::EPSILON * 1e4 { Ok(()) } else { Err(SetupError::NotInGroup { defect }) }
    }

    /// The advected parameters of this stepper's numbers, from the attitude of a state.
    pub(super) fn see(&self, state: &mut [f64]) {
        let sizes = &self.codes.sizes;
        let advected = self.codes.seen(&self.numbers, &state[..sizes.entries]);
        state[sizes.advected()..sizes.history()].copy_from_slice(&advected);
    }

    /// The initial state at this attitude and momentum.
    pub(super) fn begin(&self, attitude: &[f64], momentum: &[f64]) -> Box<[f64]> {
        let sizes = &self.codes.sizes;
        let mut state = vec![0.0; sizes.state()].into_boxed_slice();
        state[..sizes.entries].copy_from_slice(attitude);
        state[sizes.momentum()..sizes.advected()].copy_from_slice(momentum);
        self.see(&mut state);
        self.forget(&mut state);
        state
    }

    /// Writes the memory of a new start: an estimate of half the coordinates of the first increment.
    pub(super) fn forget(&self, state: &mut [f64]) {
        let sizes = &self.codes.sizes;
        let (moving, memory) = state.split_at_mut(sizes.history());
        let limit = self.numbered().limit(&moving[sizes.advected()..]);
        let velocity = limit.estimated_velocity(&moving[sizes.momentum()..sizes.advected()]);
        let half_step = self.stages.first().h * 0.5;
        for (k, velocity) in velocity.iter().enumerate() {
            (memory[k], memory[sizes.n + k], memory[2 * sizes.n + k]) =
                (velocity * half_step, 0.0, velocity * half_step);
        }
    }

    /// One step of a state of the right length.
    #[inline]
    fn step_in(&self, state: &mut [f64], room: &mut [f64]) -> Result<StepReport, StepError> {
        match self.stages.step(self.numbered(), state, room) {
            Ok(iterations) => Ok(StepReport::of(iterations)),
            Err(error) => self.in_parts(state, error),
        }
    }

    /// One step of a state of the right length, by the driver.
    pub(super) fn step_alone(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        self.in_room(|room| self.step_in(state, room))
    }

    /// Makes the step in equal parts, if the method says so; otherwise the error, for the whole step.
    #[cold]
    #[inline(never)]
    fn in_parts(&self, state: &mut [f64], error: StepError) -> Result<StepReport, StepError> {
        if matches!(error, StepError::NonFinite { .. }) {
            return Err(error);
        }
        let mut parts = 2;
        while parts <= self.method.substeps {
            if let Some((mut next, iterations)) = self.substepped(state, parts) {
                let last = next.len() - 1;
                next[last] = state[last] + 1.0;
                // The increment of a part doesn't predict that of a whole step.
                self.forget(&mut next);
                state.copy_from_slice(&next);
                return Ok(StepReport { iterations, remedy: Some(Remedy::Substeps(parts)) });
            }
            let Some(more) = parts.checked_mul(2) else { break };
            parts = more;
        }
        Err(self.explained(state, error))
    }

    /// The state after so many steps of an equal part of `h`, and the sum of their iterations.
    fn substepped(&self, state: &[f64], parts: u32) -> Option<(Vec<f64>, u32)> {
        let small = self.of_length(self.h / f64::from(parts)).ok()?;
        let (mut next, mut room) = (state.to_vec(), vec![0.0; small.room()]);
        let last = next.len() - 1;
        next[last] = 0.0;
        small.forget(&mut next);
        let mut iterations = 0;
        for _ in 0..parts {
            iterations += small.stages.step(small.numbered(), &mut next, &mut room).ok()?;
        }
        Some((next, iterations))
    }

    /// The error of the whole step for that of a stage: it names the largest solvable step.
    pub(super) fn explained(&self, state: &[f64], error: StepError) -> StepError {
        if self.stages.count() == 1 || !matches!(error, StepError::BeyondSolvable { .. }) {
            return error;
        }
        let solvable = |fraction: f64| {
            self.of_length(self.h * fraction).is_ok_and(|part| {
                let (mut next, mut room) = (state.to_vec(), vec![0.0; part.room()]);
                part.forget(&mut next);
                part.stages.step(part.numbered(), &mut next, &mut room).is_ok()
            })
        };
        let largest = largest_fraction(solvable).map_or(0.0, |fraction| self.h * fraction);
        let Ok(whole) = Stages::of(&self.codes, &self.numbers, self.h, None) else { return error };
        let (codes, sizes) = (&*self.codes, &self.codes.sizes);
        let (momentum, advected) =
            (&state[sizes.momentum()..sizes.advected()], &state[sizes.advected()..sizes.history()]);
        let step = Step { codes, numbers: &self.numbers, constants: whole.first(), momentum, advected };
        step.beyond_solvable(largest)
    }

    /// The stepper of these numbers and this method by another step.
    pub(super) fn of_length(&self, h: f64) -> Result<Self, SetupError> {
        self.with(&self.numbers, h)
    }

    pub(super) fn room(&self) -> usize {
        self.stages.room(&self.codes)
    }

    /// Calls a function with the room of a step, on the stack unless it is large.
    #[inline]
    pub(super) fn in_room<R>(&self, run: impl FnOnce(&mut [f64]) -> R) -> R {
        match self.room() {
            size @ 0..=96 => run(&mut [0.0; 96][..size]),
            size @ 97..=384 => run(&mut [0.0; 384][..size]),
            size => run(&mut vec![0.0; size]),
        }
    }
}

impl<B: Backend<f64>> Propagator for Whole<B> {
    fn layout(&self) -> &Layout {
        &self.codes.layout
    }

    fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError> {
        SetupError::check_length("attitude", attitude.len(), self.codes.sizes.entries)?;
        SetupError::check_length("velocity", velocity.len(), self.codes.sizes.n)?;
        if !are_finite(velocity) {
            return Err(SetupError::NonFinite { what: "velocity" });
        }
        self.check_attitude(attitude)?;
        let advected = self.codes.seen(&self.numbers, attitude);
        let limit = self.numbered().limit(&advected);
        let momentum = limit.momentum(velocity);
        if !self.declaration().is_quadratic {
            limit.check_velocity(velocity, &momentum)?;
        }
        self.start_with_momentum(attitude, &momentum)
    }

    fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        self.checked(state)?;
        // A step in one piece needs no room.
        if let Some(iterations) = self.stages.step_in_one_piece(self.numbered(), state) {
            return Ok(StepReport::of(iterations));
        }
        self.step_alone(state)
    }

    fn run(&self, state: &mut [f64], steps: u64) -> Result<u64, StepError> {
        let mut next = self.checked(state)?.to_vec();
        let iterations = self.run_stretches(&mut next, steps, &mut |_, _| 0)?;
        state.copy_from_slice(&next);
        Ok(iterations)
    }

    fn run_stretches(
        &self,
        state: &mut [f64],
        mut steps: u64,
        next: &mut dyn FnMut(&[f64], f64) -> u64,
    ) -> Result<u64, StepError> {
        self.checked(state)?;
        self.in_room(|room| {
            let mut iterations = 0;
            while steps > 0 {
                for _ in 0..steps {
                    let made = match self.stages.step_in_one_piece(self.numbered(), state) {
                        Some(iterations) => iterations,
                        None => self.step_in(state, room)?.iterations,
                    };
                    iterations += u64::from(made);
                }
                steps = next(state, self.time(state));
            }
            Ok(iterations)
        })
    }

    fn part(&self, state: &[f64], fraction: f64) -> Result<Box<[f64]>, StepError> {
        let mut next: Box<[f64]> = self.checked(state)?.into();
        // So small a change would be lost in rounding, and the constants of so short a step may be out of range.
        // NaN isn't tiny.
        let is_tiny = fraction.abs() < f64::EPSILON * f64::EPSILON;
        if !is_tiny {
            let wrong = |_| StepError::NonFinite { what: "part of the step" };
            let part = self.of_length(self.h * fraction).map_err(wrong)?;
            part.forget(&mut next);
            part.step(&mut next)?;
            let last = next.len() - 1;
            next[last] = state[last];
        }
        self.forget(&mut next);
        Ok(next)
    }

    fn adopt(&self, state: &[f64]) -> Box<[f64]> {
        let layout = &self.codes.layout;
        match (state.get(layout.attitude()), state.get(layout.momentum())) {
            (Some(attitude), Some(momentum)) => self.begin(attitude, momentum),
            _ => vec![f64::NAN; layout.state()].into(),
        }
    }

    fn cost(&self) -> Option<Cost> {
        Some(self.codes.cost(self.stages.count()))
    }

    fn step_size(&self) -> f64 {
        self.h
    }

    fn velocity(&self, state: &[f64], velocity: &mut [f64]) {
        write_or_nan(Some(self.velocity_with(state, &self.numbers)), velocity);
    }

    fn energy(&self, state: &[f64]) -> f64 {
        self.energy_with(state, &self.numbers)
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let sizes = &self.codes.sizes;
        let found = self.checked(state).map(|state| {
            let own = (Array::Momentum, &state[sizes.momentum()..sizes.advected()]);
            rare::<B>(&self.codes.code.spatial, &[], [(Array::Attitude, &state[..sizes.entries]), own])
        });
        write_or_nan(found.ok(), momentum);
    }

    fn defect(&self, state: &[f64]) -> f64 {
        let attitude = |state: &[f64]| {
            let given = [(Array::Attitude, &state[..self.codes.sizes.entries]), (Array::Half, &[][..])];
            rare::<B>(&self.codes.code.defect, &[], given)[0]
        };
        self.checked(state).map_or(f64::NAN, attitude)
    }
}

/// Writes these numbers; NaN where there are none.
pub(super) fn write_or_nan(found: Option<Vec<f64>>, places: &mut [f64]) {
    let mut found = found.into_iter().flatten();
    places.fill_with(|| found.next().unwrap_or(f64::NAN));
}
