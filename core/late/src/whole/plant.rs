//! A declaration's stepper as the plant of a control problem.

use liestep::gradients::{Both, Plant};
use liestep::motion::Propagator as _;
use liestep::{SetupError, StepError};
use nalgebra::DMatrix;

use super::algebra::{adjoint, displaced, displacement, tangent};
use super::stepper::Whole;
use super::tangent::TangentCode;
use crate::code::Backend;

impl<B: Backend<f64>> Whole<B> {
    /// The stepper whose inputs as a [`Plant`] are the numbers of the parameters at these places, which hold for a step: the
    /// thrusts of a declared force, the length of a pendulum, a field.
    ///
    /// # Errors
    ///
    /// [`SetupError::Length`] if there is no number at a place.
    pub fn steered(&self, places: Vec<usize>) -> Result<Self, SetupError> {
        let (all, most) = (self.numbers().len(), places.iter().copied().max());
        if most.is_some_and(|most| most >= all) {
            SetupError::check_length("inputs", all, most.unwrap_or(0) + 1)?;
        }
        Ok(Self { inputs: Some(places.into()), ..self.clone() })
    }

    /// The numbers of all parameters with an input; none stands for the parameters' own values.
    fn numbers_with(&self, places: &[usize], input: &[f64]) -> Vec<f64> {
        let mut numbers = self.numbers().to_vec();
        for (place, value) in places.iter().zip(input) {
            numbers[*place] = *value;
        }
        numbers
    }

    /// A step with these values of parameters, and its derivatives.
    fn steered_transition(&self, state: &mut [f64], places: &[usize], input: &[f64]) -> Result<Both, StepError> {
        let numbers = self.numbers_with(places, input);
        let whole = self.with(&numbers, self.h).ok();
        let derivatives = whole.and_then(|whole| whole.derivatives().ok());
        let places = if input.is_empty() { &[] } else { places };
        let both = derivatives.ok_or(StepError::NonFinite { what: "derivative" })?.of_step(state, places)?;
        self.step_with(state, &numbers)?;
        Ok(both)
    }
}

/// An attitude has the matrices of its factors, row by row; an input is a force in the body frame, of a
/// [steered](Whole::steered) stepper the values of its parameters, or empty. Where there are constraints on velocities,
/// neighbouring states satisfy them: reactions take up the rest of a change of the momentum, on which no step depends.
impl<B: Backend<f64>> Plant for Whole<B> {
    type State = Box<[f64]>;
    type Motion = [f64];
    type Attitude = Vec<f64>;
    type Vector = Vec<f64>;
    type Input = Vec<f64>;

    fn dimension(&self) -> usize {
        self.codes.sizes.n
    }

    fn step_size(&self) -> f64 {
        self.h
    }

    fn of_length(&self, h: f64) -> Option<Self> {
        self.with(&self.numbers, h).ok()
    }

    fn check(&self) -> Result<(), SetupError> {
        if self.inputs.is_some() {
            let cause = "has no derivatives of steps by parameters: the declaration is too large";
            return self.derivatives().map(|_| ()).map_err(|_| SetupError::Method { cause });
        }
        let cause = "has no derivatives of steps as long as this one";
        TangentCode::<B>::of(self.declaration()).map(|_| ()).map_err(|_| SetupError::Method { cause })
    }

    fn free(&self) -> Vec<f64> {
        Vec::new()
    }

    /// No force, or the values that the parameters have.
    fn force(&self) -> Vec<f64> {
        let values = |places: &[usize]| places.iter().map(|&place| self.numbers[place]).collect();
        self.inputs.as_deref().map_or_else(|| vec![0.0; self.codes.sizes.n], values)
    }

    fn motion(state: &Box<[f64]>) -> &[f64] {
        state
    }

    fn components(vector: &Vec<f64>) -> Vec<f64> {
        vector.clone()
    }

    fn numbers(input: &Vec<f64>) -> Vec<f64> {
        input.clone()
    }

    fn with_numbers(input: &Vec<f64>, numbers: &[f64]) -> Vec<f64> {
        input.iter().zip(numbers).map(|(_, number)| *number).collect()
    }

    fn adopt(&self, state: &Box<[f64]>) -> Box<[f64]> {
        liestep::motion::Propagator::adopt(self, state)
    }

    fn step(&self, state: &mut Box<[f64]>, force: &Vec<f64>) -> Result<(), StepError> {
        if let Some(places) = &self.inputs {
            return self.step_with(state, &self.numbers_with(places, force)).map(|_| ());
        }
        if force.is_empty() {
            return liestep::motion::Propagator::step(self, state).map(|_| ());
        }
        self.step_forced(state, force).map(|_| ())
    }

    fn transition(&self, state: &mut Box<[f64]>, force: &Vec<f64>) -> Result<Both, StepError> {
        if let Some(places) = &self.inputs {
            return self.steered_transition(state, places, force);
        }
        let none = self.force();
        let found = Self::transition(self, state, if force.is_empty() { &none } else { force })?;
        Ok([found.by_state, if force.is_empty() { Vec::new() } else { found.by_force }])
    }

    fn displaced(&self, state: &Box<[f64]>, change: &[f64]) -> Option<Box<[f64]>> {
        let layout = self.layout();
        let (xi, change) = change.split_at_checked(self.codes.sizes.n)?;
        let attitude = displaced(&self.codes.factors, state.get(layout.attitude())?, xi);
        let (momentum, constants) = (state.get(layout.momentum())?, &self.stages.first().numbers);
        // A change that reactions take up leaves every bit of a momentum, so that readings say exactly nothing about it.
        let change = self.numbered().limit(state.get(layout.advected())?).constrained_change(change, constants);
        let mut momentum: Vec<f64> = momentum.iter().zip(change).map(|(momentum, change)| momentum + change).collect();
        if xi.iter().any(|component| *component != 0.0) {
            let advected = self.codes.seen(&self.numbers, &attitude);
            momentum = self.numbered().limit(&advected).constrained(momentum, constants);
        }
        self.start_with_momentum(&attitude, &momentum).ok()
    }

    fn displacement(&self, from: &Vec<f64>, to: &Box<[f64]>) -> Option<Vec<f64>> {
        let to = to.get(self.layout().attitude())?;
        if from.len() == to.len() { displacement(&self.codes.factors, from, to) } else { None }
    }

    fn displacement_slopes(&self, from: &Vec<f64>, to: &Box<[f64]>) -> Option<Both> {
        let (n, xi) = (self.codes.sizes.n, Plant::displacement(self, from, to)?);
        Some([tangent(&self.codes.factors, &xi)?, DMatrix::<f64>::identity(n, n).as_slice().to_vec()])
    }

    fn attitude(&self, state: &Box<[f64]>) -> Vec<f64> {
        state.get(self.layout().attitude()).map_or_else(Vec::new, <[f64]>::to_vec)
    }

    fn momentum(&self, state: &Box<[f64]>) -> Vec<f64> {
        state.get(self.layout().momentum()).map_or_else(Vec::new, <[f64]>::to_vec)
    }

    fn bracket_transpose(&self, xi: &[f64], momentum: &[f64]) -> Vec<f64> {
        let transposed =
            |ad: DMatrix<f64>| ad.tr_mul(&nalgebra::DVector::from_column_slice(momentum)).as_slice().to_vec();
        adjoint(&self.codes.factors, xi).map_or_else(|| vec![f64::NAN; momentum.len()], transposed)
    }
}
