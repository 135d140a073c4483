//! Estimates of a motion from its readings.

use liestep::gradients::Plant;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::model::{Model, SMALL, away, by_displacement, displaced};
use crate::riccati::{End, Stage, Value, add_square, of_state};
use crate::verdict::{ControlError, Verdict};

/// The eigenvalue, relative to the largest, below which readings don't determine a direction: a zero after rounding.
const UNSEEN: f64 = 1e-13;
/// The damping, relative to the readings' own second derivatives, at which a step is given up.
const MOST_DAMPING: f64 = 1e8;
/// The ratio of the steps of a search to those of the one before: a phase that is known over a time is off by less than a turn
/// over three times as long.
const GROWTH: usize = 3;

/// The residuals of a state's readings, by the number of steps before it and the constants.
type Readings<'a, M> = dyn Fn(usize, &<M as Plant>::Motion, &[f64]) -> Vec<f64> + 'a;
/// The stepper as a function of the constants.
type StepperOf<'a, M> = dyn Fn(&[f64]) -> Option<M> + 'a;

#[doc = include_str!("estimate.md")]
pub struct Estimate<'a, M: Plant> {
    stepper: &'a M,
    start: M::State,
    steps: usize,
    /// The number of steps of the first search.
    first: usize,
    readings: Box<Readings<'a, M>>,
    constants: Vec<f64>,
    scales: Vec<f64>,
    stepper_of: Option<Box<StepperOf<'a, M>>>,
    like: M::Input,
    places: Vec<usize>,
    deviations: Vec<f64>,
    known: DMatrix<f64>,
    tolerance: f64,
    most: usize,
}

/// The motion that suits the readings best.
#[derive(Clone, Debug)]
pub struct Fit<M: Plant> {
    /// The stepper with the fitted constants.
    pub stepper: M,
    /// The states, one more than there are steps.
    pub states: Vec<M::State>,
    /// The input of each step.
    pub inputs: Vec<M::Input>,
    /// The fitted constants.
    pub constants: Vec<f64>,
    /// The covariance of displacements of the start, its momentum and the constants, of `2n + c` rows for a group of
    /// dimension `n` and `c` constants, in the units of both places; zero along directions that aren't determined.
    pub covariance: DMatrix<f64>,
    /// The sum of all squares, in variances.
    pub squares: f64,
    /// The length of the last step, standard deviations.
    pub step: f64,
    /// The number of iterations.
    pub iterations: usize,
    /// The reason why the search stopped.
    pub verdict: Verdict,
}

/// A motion, and its residuals from the readings.
struct Trial<M: Plant> {
    model: Model<M>,
    states: Vec<M::State>,
    inputs: Vec<DVector<f64>>,
    constants: DVector<f64>,
    /// One vector for each state.
    readings: Vec<DVector<f64>>,
    /// The differences of the start and the constants from the first guess.
    away: DVector<f64>,
    squares: f64,
}

impl<'a, M: Plant> Estimate<'a, M> {
    /// The estimate of a motion of this number of steps, from near this state. For the state after each number of
    /// steps, from zero on, `readings` returns predicted minus measured values in standard deviations; it gets the
    /// constants, too.
    ///
    /// Derivatives of the readings are differences of fourth order.
    #[must_use]
    pub fn new(
        stepper: &'a M,
        start: M::State,
        steps: usize,
        readings: impl Fn(usize, &M::Motion, &[f64]) -> Vec<f64> + 'a,
    ) -> Self {
        let states = 2 * stepper.dimension();
        Self {
            stepper,
            start,
            steps,
            first: steps,
            readings: Box::new(readings),
            constants: Vec::new(),
            scales: Vec::new(),
            stepper_of: None,
            like: stepper.free(),
            places: Vec::new(),
            deviations: Vec::new(),
            known: DMatrix::zeros(states, states),
            tolerance: 1e-8,
            most: 100,
        }
    }

    /// Adds unknown constants: their first guesses, and changes of them that make a difference.
    #[must_use]
    pub fn unknowns(self, guesses: Vec<f64>, scales: Vec<f64>) -> Self {
        let states = 2 * self.stepper.dimension() + guesses.len();
        Self { constants: guesses, scales, known: DMatrix::zeros(states, states), ..self }
    }

    /// Sets the stepper as a function of the constants, with the same step; without it they act on the readings alone.
    #[must_use]
    pub fn steppers(self, of: impl Fn(&[f64]) -> Option<M> + 'a) -> Self {
        Self { stepper_of: Some(Box::new(of)), ..self }
    }

    /// Adds unknown inputs of each step: as [`Control::input`](crate::Control::input), about the scalars of `like` with
    /// these standard deviations, one for each place.
    #[must_use]
    pub fn inputs(self, like: M::Input, places: Vec<usize>, deviations: Vec<f64>) -> Self {
        Self { like, places, deviations, ..self }
    }

    /// Sets the prior information: the inverse of the covariance about the first guess, in the order of
    /// [`Fit::covariance`]. Call it after [`unknowns`](Self::unknowns), which resets it.
    #[must_use]
    pub fn known(self, information: DMatrix<f64>) -> Self {
        Self { known: information, ..self }
    }

    /// Sets the longest last step, in standard deviations, and the most iterations; the defaults are `1e-8` and 100.
    #[must_use]
    pub fn until(self, tolerance: f64, most: usize) -> Self {
        Self { tolerance, most, ..self }
    }

    /// Sets the number of steps whose readings the first search has; each search after it has three times as many, and begins
    /// where the one before ended. By default all readings are taken at once. The squares of a long motion have minima far from
    /// the least one, where guess and motion are turns apart.
    #[must_use]
    pub fn growing_from(self, steps: usize) -> Self {
        Self { first: steps, ..self }
    }

    /// Searches for the least squares; the [verdict](Fit::verdict) says whether they were found.
    ///
    /// # Errors
    ///
    /// [`ControlError`] if the search can't start.
    pub fn solve(&self) -> Result<Fit<M>, ControlError> {
        self.stepper.check()?;
        let (scalars, states) = (M::numbers(&self.like).len(), 2 * self.stepper.dimension() + self.constants.len());
        let is_size = |size: &f64| *size > 0.0 && size.is_finite();
        let are_places = self.places.iter().all(|place| *place < scalars) && self.places.len() == self.deviations.len();
        let checks = [
            ("number of steps", self.steps > 0),
            ("unknown", self.constants.len() == self.scales.len() && self.scales.iter().all(is_size)),
            ("input", are_places && self.deviations.iter().all(is_size)),
            ("prior knowledge", self.known.shape() == (states, states) && self.known.iter().all(|x| x.is_finite())),
        ];
        if let Some((what, _)) = checks.iter().find(|(_, is_right)| !is_right) {
            return Err(ControlError::Unusable(what));
        }
        let mut steps = self.first.clamp(1, self.steps);
        let mut fit = self.searched(steps, &self.start, &self.constants)?;
        while steps < self.steps {
            steps = steps.saturating_mul(GROWTH).min(self.steps);
            let before = fit.iterations;
            fit = self.searched(steps, &fit.states[0], &fit.constants)?;
            fit.iterations += before;
        }
        Ok(fit)
    }

    /// The least squares of the readings of so many steps, from near this start and these constants.
    fn searched(&self, steps: usize, start: &M::State, constants: &[f64]) -> Result<Fit<M>, ControlError> {
        let inputs = vec![self.given(); steps];
        let mut trial = self
            .trial(start, inputs, DVector::from_column_slice(constants))
            .map_err(|(step, error)| ControlError::Step(step, error))?
            .ok_or(ControlError::Unusable("reading"))?;
        let (mut damping, mut iterations) = (0.0, 0);
        let (verdict, covariance, step) = loop {
            let Some((stages, value)) = self.value(&trial) else { return Err(ControlError::Unusable("derivative")) };
            let seen = Directions::new(&value);
            let step = seen.decrease(&value).sqrt();
            if step <= self.tolerance {
                let verdict = seen.unseen.clone().map_or(Verdict::Converged, |direction| Verdict::Unseen { direction });
                break (verdict, seen.covariance(), step);
            }
            if iterations == self.most {
                break (Verdict::Exhausted, seen.covariance(), step);
            }
            iterations += 1;
            match self.improve(&trial, &stages, (&value, &seen), &mut damping) {
                Some(better) => trial = better,
                None => break (Verdict::Stalled(None), seen.covariance(), step),
            }
        };
        let Trial { model, states, inputs, constants, squares, .. } = trial;
        let inputs = inputs.iter().map(|chosen| model.input(chosen.as_slice())).collect();
        let (stepper, constants) = (model.stepper, constants.as_slice().to_vec());
        Ok(Fit { stepper, states, inputs, constants, covariance, squares, step, iterations, verdict })
    }

    /// The expected input.
    fn given(&self) -> DVector<f64> {
        let scalars = M::numbers(&self.like);
        DVector::from_iterator(self.places.len(), self.places.iter().map(|place| scalars[*place]))
    }

    fn model(&self, constants: &DVector<f64>) -> Option<Model<M>> {
        let (mut stepper, mut beside) = (self.stepper.clone(), Vec::new());
        if let Some(of) = &self.stepper_of {
            stepper = of(constants.as_slice())?;
            for (k, scale) in self.scales.iter().enumerate() {
                let changed = |by: f64| {
                    let mut constants = constants.clone();
                    constants[k] += by;
                    of(constants.as_slice())
                };
                let small = SMALL * scale;
                beside.push((small, [changed(small)?, changed(-small)?]));
            }
        }
        #[allow(clippy::cast_precision_loss)] // exact up to 2⁵³
        let duration = stepper.step_size() * self.steps as f64;
        let (like, places) = (self.like.clone(), self.places.clone());
        Some(Model { duration, stepper, constants: constants.len(), beside, like, places })
    }

    /// The trial of these unknowns, if stepper, coordinates and finite squares exist there.
    fn trial(
        &self,
        start: &M::State,
        inputs: Vec<DVector<f64>>,
        constants: DVector<f64>,
    ) -> Result<Option<Trial<M>>, (usize, liestep::StepError)> {
        let Some(model) = self.model(&constants) else { return Ok(None) };
        let states = model.run(start, &inputs)?;
        let read = |(step, state): (usize, &M::State)| {
            DVector::from_vec((self.readings)(step, M::motion(state), constants.as_slice()))
        };
        let readings: Vec<_> = states.iter().enumerate().map(read).collect();
        let Some(away) = away(&model.stepper, &self.start, start) else { return Ok(None) };
        let away = DVector::from_iterator(
            model.states(),
            away.iter().copied().chain(constants.iter().zip(&self.constants).map(|(now, guess)| now - guess)),
        );
        let given = self.given();
        let of_inputs = inputs.iter().map(|input| (input - &given).component_div(&self.deviations()).norm_squared());
        let squares =
            readings.iter().map(DVector::norm_squared).chain(of_inputs).sum::<f64>() + away.dot(&(&self.known * &away));
        Ok(squares.is_finite().then(|| Trial { model, states, inputs, constants, readings, away, squares }))
    }

    fn deviations(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.deviations)
    }

    /// The Gauss–Newton programme, and its least cost as a function of the start.
    fn value(&self, trial: &Trial<M>) -> Option<(Vec<Stage>, Value)> {
        let Trial { model, states, inputs, constants, readings, away, .. } = trial;
        let (count, deviations, given) = (model.states(), self.deviations(), self.given());
        let stage = |(state, input): (&M::State, &DVector<f64>)| {
            let mut stage = model.blocks(state, input).ok()?;
            let by_input = deviations.map(|deviation| deviation.powi(-2));
            stage.input_gradient = (input - &given).component_mul(&by_input);
            stage.hessian.view_mut((count, count), (input.len(), input.len())).set_diagonal(&by_input);
            Some(stage)
        };
        let mut stages = states.iter().zip(inputs).map(stage).collect::<Option<Vec<_>>>()?;
        let none = DVector::zeros(0);
        let mut end = End {
            by_state: DMatrix::zeros(0, count),
            miss: none.clone(),
            multipliers: none,
            hessian: DMatrix::zeros(count, count),
            gradient: DVector::zeros(count),
        };
        for (step, (state, reading)) in states.iter().zip(readings).enumerate() {
            let values = |state: &M::State, change: &[f64]| {
                let constants: Vec<f64> = constants.iter().zip(change).map(|(now, change)| now + change).collect();
                (self.readings)(step, M::motion(state), &constants)
            };
            let slopes = model.slopes(state, &stages[step.min(inputs.len() - 1)], &self.scales, values)?;
            let (hessian, gradient) = of_state(&mut stages, &mut end, step);
            for (slope, reading) in slopes.row_iter().zip(reading.iter()) {
                let slope = slope.transpose();
                add_square(hessian, &slope, 1.0);
                gradient.axpy(*reading, &slope, 1.0);
            }
        }
        let dimension = self.stepper.dimension();
        let slopes = by_displacement(self.stepper, &self.stepper.attitude(&self.start), &states[0])?;
        let mut known = DMatrix::identity(count, count);
        known.view_mut((0, 0), (dimension, dimension)).copy_from(&slopes);
        let (hessian, gradient) = of_state(&mut stages, &mut end, 0);
        let mut hessian = hessian.view_mut((0, 0), (count, count));
        hessian += known.tr_mul(&(&self.known * &known));
        *gradient += known.tr_mul(&(&self.known * away));
        let value = Value::new(&stages, &end)?;
        Some((stages, value))
    }

    /// A motion with smaller squares: the longest Levenberg–Marquardt step that leads to one.
    fn improve(
        &self,
        trial: &Trial<M>,
        stages: &[Stage],
        (value, seen): (&Value, &Directions),
        damping: &mut f64,
    ) -> Option<Trial<M>> {
        // At the level of rounding the step is taken without a decrease.
        let rounding = 1e-13 * (1.0 + trial.squares);
        while *damping < MOST_DAMPING {
            let solution = value.forwards(stages, seen.step(value, *damping), DVector::zeros(0));
            let change = &solution.states[0];
            let inputs = trial.inputs.iter().zip(&solution.inputs).map(|(now, change)| now + change).collect();
            let constants = &trial.constants + change.rows(change.len() - trial.constants.len(), trial.constants.len());
            let start = displaced(&trial.model.stepper, &trial.states[0], change);
            let better = start.and_then(|start| self.trial(&start, inputs, constants).ok().flatten());
            if let Some(better) = better.filter(|better| better.squares <= trial.squares + rounding) {
                *damping = if *damping < 1e-6 { 0.0 } else { 0.1 * *damping };
                return Some(better);
            }
            *damping = (10.0 * *damping).max(1e-3);
        }
        None
    }
}

/// The directions of the start and the constants, each with the information of the readings on it.
struct Directions {
    /// The lengths that scale the second derivative along each coordinate to one.
    lengths: DVector<f64>,
    /// The eigenvalues, zero if a direction isn't determined, and eigenvectors of the scaled second derivatives.
    squares: SymmetricEigen<f64, nalgebra::Dyn>,
    /// The least determined direction, if it isn't determined.
    unseen: Option<Vec<f64>>,
}

impl Directions {
    fn new(value: &Value) -> Self {
        let lengths = value.square.diagonal().map(|entry| if entry > 0.0 { entry.sqrt().recip() } else { 1.0 });
        let scaled =
            DMatrix::from_fn(lengths.len(), lengths.len(), |i, j| value.square[(i, j)] * lengths[i] * lengths[j]);
        let mut squares = scaled.symmetric_eigen();
        let (least, most) = (squares.eigenvalues.argmin(), squares.eigenvalues.max());
        let is_unseen = |entry: f64| entry <= UNSEEN * most;
        let direction = || squares.eigenvectors.column(least.0).component_mul(&lengths).normalize().as_slice().to_vec();
        let unseen = is_unseen(least.1).then(direction);
        squares.eigenvalues.iter_mut().filter(|entry| is_unseen(**entry)).for_each(|entry| *entry = 0.0);
        Self { lengths, squares, unseen }
    }

    /// The gradient, the second derivative and the direction itself, for each determined direction.
    fn parts<'s>(&'s self, value: &'s Value) -> impl Iterator<Item = (f64, f64, DVector<f64>)> + 's {
        let gradient = value.slopes.column(0).component_mul(&self.lengths);
        let directions = self.squares.eigenvectors.column_iter().zip(self.squares.eigenvalues.iter());
        directions
            .filter(|(_, square)| **square > 0.0)
            .map(move |(direction, square)| (direction.dot(&gradient), *square, direction.component_mul(&self.lengths)))
    }

    /// The decrease of the squares that a whole step predicts.
    fn decrease(&self, value: &Value) -> f64 {
        self.parts(value).map(|(slope, square, _)| slope * slope / square).sum()
    }

    fn step(&self, value: &Value, damping: f64) -> DVector<f64> {
        let zero = DVector::zeros(self.lengths.len());
        self.parts(value).fold(zero, |sum, (slope, square, direction)| sum - direction * (slope / (square + damping)))
    }

    fn covariance(&self) -> DMatrix<f64> {
        let inverses = self.squares.eigenvalues.map(|square| if square > 0.0 { square.recip() } else { 0.0 });
        let scaled =
            &self.squares.eigenvectors * DMatrix::from_diagonal(&inverses) * self.squares.eigenvectors.transpose();
        DMatrix::from_fn(scaled.nrows(), scaled.ncols(), |i, j| scaled[(i, j)] * self.lengths[i] * self.lengths[j])
    }
}
