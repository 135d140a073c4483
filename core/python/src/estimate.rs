//! Estimates of a motion and of parameters from its columns, by `liestep-control`.

use liestep::gradients::Plant as _;
use liestep::motion::Propagator as _;
use liestep::with::Method;
use liestep_control::{ControlError, Estimate, Fit, Verdict};
use liestep_late::{Declaration, Whole};
use nalgebra::DMatrix;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::failure::Failure;
use crate::scene::Backend;
use crate::start::Start;

/// The readings of one quantity.
#[derive(FromPyObject)]
pub(crate) struct Readings {
    /// `velocity`, `momentum`, `spatial_momentum`, `attitude` by the entries of its matrices, or `energy`.
    quantity: String,
    /// The values of each state, one after the other; NaN where there is none.
    values: Vec<f64>,
    /// The standard deviation of each of a state's numbers.
    deviations: Vec<f64>,
}

/// The task of an estimate.
#[derive(FromPyObject)]
pub(crate) struct Task {
    step: f64,
    steps: usize,
    /// The number of steps of the first search.
    first: usize,
    start: Start,
    readings: Vec<Readings>,
    /// The places of the unknown numbers of the parameters, those that are one unknown together.
    unknowns: Vec<Vec<usize>>,
    guesses: Vec<f64>,
    scales: Vec<f64>,
    /// The components of an unknown force of each step, or the places of parameters that are unknown in each step, with the
    /// deviations of both.
    axes: Vec<usize>,
    are_parameters: bool,
    deviations: Vec<f64>,
    /// The inverse variances of what is known about the start and the unknowns.
    known: Vec<f64>,
    tolerance: f64,
    most: usize,
}

/// The readings of a state that isn't finite, or of numbers without a stepper.
fn predicted(task: &Task, whole: &Whole<Backend>, step: usize, state: &[f64], numbers: &[f64]) -> Vec<f64> {
    let layout = whole.layout();
    let mut missed = Vec::new();
    for Readings { quantity, values, deviations } in &task.readings {
        let own = &values[step * deviations.len()..(step + 1) * deviations.len()];
        if own.iter().all(|value| value.is_nan()) {
            continue;
        }
        let found = match quantity.as_str() {
            "velocity" => whole.velocity_with(state, numbers),
            "energy" => vec![whole.energy_with(state, numbers)],
            "momentum" => state[layout.momentum()].to_vec(),
            "attitude" => state[layout.attitude()].to_vec(),
            _ => {
                let mut momentum = vec![0.0; layout.components()];
                whole.spatial_momentum(state, &mut momentum);
                momentum
            }
        };
        let pairs = found.iter().zip(own).zip(deviations).filter(|((_, value), _)| !value.is_nan());
        missed.extend(pairs.map(|((found, value), deviation)| (found - value) / deviation));
    }
    missed
}

/// A fit as Python sees it.
struct Found {
    states: Vec<Box<[f64]>>,
    inputs: Vec<Vec<f64>>,
    constants: Vec<f64>,
    covariance: DMatrix<f64>,
    squares: f64,
    iterations: usize,
    verdict: Verdict,
}

impl Found {
    fn of(fit: Fit<Whole<Backend>>) -> Self {
        let Fit { states, inputs, constants, covariance, squares, iterations, verdict, .. } = fit;
        Self { states, inputs, constants, covariance, squares, iterations, verdict }
    }
}

impl Task {
    fn numbers(&self, numbers: &[f64], constants: &[f64]) -> Vec<f64> {
        let mut numbers = numbers.to_vec();
        for (places, value) in self.unknowns.iter().zip(constants) {
            for &place in places {
                numbers[place] = *value;
            }
        }
        numbers
    }

    fn solve(&self, terms: &[&'static Declaration], numbers: &[f64]) -> Result<Found, Failure> {
        let whole = Whole::<Backend>::of(Declaration::sum(terms)?, numbers, self.step, Method::default())?;
        if !self.are_parameters {
            return self.solve_with(&whole, numbers, self.axes.clone());
        }
        let steered = whole.steered(self.axes.clone()).map_err(|error| Failure::setup(&error))?;
        self.solve_with(&steered, numbers, (0..self.axes.len()).collect())
    }

    fn solve_with(&self, whole: &Whole<Backend>, numbers: &[f64], places: Vec<usize>) -> Result<Found, Failure> {
        let factors = &whole.layout().factors;
        let (attitude, velocity) = (self.start.attitude(factors)?, self.start.velocity(factors)?);
        let start = whole.start(&attitude, velocity).map_err(|error| Failure::setup(&error))?;
        let readings = |step: usize, state: &[f64], constants: &[f64]| {
            predicted(self, whole, step, state, &self.numbers(numbers, constants))
        };
        let stepper = |constants: &[f64]| whole.with(&self.numbers(numbers, constants), self.step).ok();
        let known = DMatrix::from_diagonal(&nalgebra::DVector::from_column_slice(&self.known));
        let mut estimate = Estimate::new(whole, start, self.steps, readings);
        if !self.unknowns.is_empty() {
            estimate = estimate.unknowns(self.guesses.clone(), self.scales.clone()).steppers(stepper);
        }
        if !self.axes.is_empty() {
            estimate = estimate.inputs(whole.force(), places, self.deviations.clone());
        }
        let found = estimate.known(known).until(self.tolerance, self.most).growing_from(self.first).solve();
        found.map(Found::of).map_err(|error| match error {
            ControlError::Step(..) => Failure::step(&error),
            _ => Failure::setup(&error),
        })
    }
}

/// The estimate of the sum of these terms, as Python sees it.
pub(crate) fn estimate<'py>(
    py: Python<'py>,
    terms: &[&'static Declaration],
    numbers: &[f64],
    task: &Task,
) -> PyResult<Bound<'py, PyDict>> {
    let found = py.detach(|| task.solve(terms, numbers))?;
    let whole = py.detach(|| -> Result<_, Failure> {
        let numbers = task.numbers(numbers, &found.constants);
        Ok(Whole::<Backend>::of(Declaration::sum(terms)?, &numbers, task.step, Method::default())?)
    })?;
    let dictionary = PyDict::new(py);
    let start = &found.states[0];
    let mut velocity = vec![0.0; whole.layout().components()];
    whole.velocity(start, &mut velocity);
    dictionary.set_item("velocity", velocity)?;
    dictionary.set_item("attitude", start[whole.layout().attitude()].to_vec())?;
    dictionary.set_item("constants", found.constants)?;
    dictionary.set_item("covariance", found.covariance.transpose().as_slice().to_vec())?;
    dictionary.set_item("squares", found.squares)?;
    dictionary.set_item("iterations", found.iterations)?;
    dictionary.set_item("inputs", if task.axes.is_empty() { Vec::new() } else { found.inputs.concat() })?;
    let (verdict, direction) = match found.verdict {
        Verdict::Converged => ("converged", None),
        Verdict::Unseen { direction } => ("unseen", Some(direction)),
        Verdict::Exhausted => ("exhausted", None),
        _ => ("stalled", None),
    };
    dictionary.set_item("verdict", verdict)?;
    dictionary.set_item("direction", direction)?;
    Ok(dictionary)
}
