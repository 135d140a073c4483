//! A declaration's stepper whose inputs are values of its own parameters, as the plant of a control problem.

use liestep::gradients::{Both, Plant};
use liestep::{SetupError, StepError};

use super::stepper::{Whole, check_length};
use crate::code::Backend;

/// A stepper some of whose parameters have other values in each step, by [`Whole::steered`]: the thrusts of a declared force, the
/// length of a pendulum, a field.
///
/// The inputs of this plant are these values, which hold for a step.
#[derive(Clone, Debug)]
pub struct Steered<B: Backend<f64>> {
    whole: Whole<B>,
    places: Vec<usize>,
}

impl<B: Backend<f64>> Whole<B> {
    /// The stepper whose inputs are the numbers of the parameters at these places.
    ///
    /// # Errors
    ///
    /// [`SetupError::Length`] if there is no number at a place.
    pub fn steered(&self, places: Vec<usize>) -> Result<Steered<B>, SetupError> {
        let (all, most) = (self.numbers().len(), places.iter().copied().max());
        if most.is_some_and(|most| most >= all) {
            check_length("inputs", self.numbers(), most.unwrap_or(0) + 1)?;
        }
        Ok(Steered { whole: self.clone(), places })
    }
}

impl<B: Backend<f64>> Steered<B> {
    /// The stepper with the parameters' own values.
    #[must_use]
    pub const fn whole(&self) -> &Whole<B> {
        &self.whole
    }

    /// The numbers of all parameters with an input; none stands for the parameters' own values.
    fn numbers_with(&self, input: &[f64]) -> Vec<f64> {
        let mut numbers = self.whole.numbers().to_vec();
        for (place, value) in self.places.iter().zip(input) {
            numbers[*place] = *value;
        }
        numbers
    }
}

impl<B: Backend<f64>> Plant for Steered<B> {
    type State = Box<[f64]>;
    type Motion = [f64];
    type Attitude = Vec<f64>;
    type Vector = Vec<f64>;
    type Input = Vec<f64>;

    fn dimension(&self) -> usize {
        self.whole.dimension()
    }

    fn step_size(&self) -> f64 {
        Plant::step_size(&self.whole)
    }

    fn of_length(&self, h: f64) -> Option<Self> {
        Some(Self { whole: Plant::of_length(&self.whole, h)?, places: self.places.clone() })
    }

    fn check(&self) -> Result<(), SetupError> {
        let cause = "has no derivatives of steps by parameters: the declaration is too large";
        self.whole.derivatives().map(|_| ()).map_err(|_| SetupError::Method { cause })
    }

    fn free(&self) -> Vec<f64> {
        Vec::new()
    }

    /// The values that the parameters have.
    fn force(&self) -> Vec<f64> {
        self.places.iter().map(|&place| self.whole.numbers()[place]).collect()
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
        Whole::<B>::with_numbers(input, numbers)
    }

    fn adopt(&self, state: &Box<[f64]>) -> Box<[f64]> {
        Plant::adopt(&self.whole, state)
    }

    fn step(&self, state: &mut Box<[f64]>, input: &Vec<f64>) -> Result<(), StepError> {
        self.whole.step_with(state, &self.numbers_with(input)).map(|_| ())
    }

    fn transition(&self, state: &mut Box<[f64]>, input: &Vec<f64>) -> Result<Both, StepError> {
        let unknown = StepError::NonFinite { what: "derivative" };
        let numbers = self.numbers_with(input);
        let derivatives = self
            .whole
            .with(&numbers, Plant::step_size(&self.whole))
            .ok()
            .and_then(|whole| whole.derivatives().ok())
            .ok_or(unknown)?;
        let places = if input.is_empty() { &[][..] } else { &self.places };
        let both = derivatives.of_step(state, places)?;
        self.whole.step_with(state, &numbers)?;
        Ok(both)
    }

    fn displaced(&self, state: &Box<[f64]>, change: &[f64]) -> Option<Box<[f64]>> {
        Plant::displaced(&self.whole, state, change)
    }

    fn displacement(&self, from: &Vec<f64>, to: &Box<[f64]>) -> Option<Vec<f64>> {
        Plant::displacement(&self.whole, from, to)
    }

    fn displacement_slopes(&self, from: &Vec<f64>, to: &Box<[f64]>) -> Option<Both> {
        Plant::displacement_slopes(&self.whole, from, to)
    }

    fn attitude(&self, state: &Box<[f64]>) -> Vec<f64> {
        Plant::attitude(&self.whole, state)
    }

    fn momentum(&self, state: &Box<[f64]>) -> Vec<f64> {
        Plant::momentum(&self.whole, state)
    }

    fn bracket_transpose(&self, xi: &[f64], momentum: &[f64]) -> Vec<f64> {
        self.whole.bracket_transpose(xi, momentum)
    }
}
