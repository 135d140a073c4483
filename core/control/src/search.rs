//! The search: a sequence of quadratic programmes with a barrier.

use liestep::StepError;
use liestep::gradients::Linearisable;
use liestep::groups::{ExponentialRetraction, LieGroup as _, Retraction};
use liestep::mechanics::{Group, SecondDerivatives, Vector};
use liestep::motion::{Plan, StateOf};
use liestep::numbers::Coordinates;
use nalgebra::{DMatrix, DVector};

use crate::control::{Control, Cost};
use crate::model::{Model, flat};
use crate::riccati::{End, Stage};
use crate::verdict::{ControlError, ControlPlan, Residual, Verdict};

/// A motion, and what is left from it to the target.
pub(crate) struct Course<S: SecondDerivatives<Scalar = f64>, P: Plan<S>> {
    pub(crate) model: Model<S, P>,
    pub(crate) inputs: Vec<DVector<f64>>,
    pub(crate) states: Vec<StateOf<S, P>>,
    pub(crate) miss: DVector<f64>,
}

/// One bound of an input, and its multiplier: `sign (u − limit) ≥ 0`.
#[derive(Clone)]
pub(crate) struct Side {
    pub(crate) step: usize,
    pub(crate) input: usize,
    pub(crate) sign: f64,
    limit: f64,
    pub(crate) multiplier: f64,
}

impl Side {
    pub(crate) fn distance(&self, inputs: &[DVector<f64>]) -> f64 {
        self.sign * (inputs[self.step][self.input] - self.limit)
    }
}

/// The state of a search.
pub(crate) struct Search<'c, 'a, S: SecondDerivatives<Scalar = f64>, P: Plan<S>> {
    pub(crate) control: &'c Control<'a, S, P>,
    pub(crate) course: Course<S, P>,
    /// Of the conditions at the end.
    pub(crate) multipliers: DVector<f64>,
    pub(crate) sides: Vec<Side>,
    pub(crate) barrier: f64,
    least_barrier: f64,
    /// The weight of the miss in the merit.
    pub(crate) penalty: f64,
    /// Before the last step.
    pub(crate) residual: Residual,
    /// Whether the miss itself is minimised, and not the cost under the condition that there is none.
    pub(crate) is_nearest: bool,
}

impl<S, P> Control<'_, S, P>
where
    S: SecondDerivatives<Scalar = f64> + Clone,
    P: Linearisable<S> + Clone,
    ExponentialRetraction: Retraction<Group<S>>,
{
    /// Searches an optimum. Whether there is one, the [verdict](ControlPlan::verdict) says.
    ///
    /// # Errors
    ///
    /// [`ControlError`] where the search can't be begun.
    pub fn solve(&self) -> Result<ControlPlan<S, P>, ControlError> {
        self.stepper.linearised()?;
        let scalars = self.like.scalars::<f64>().len();
        let is_new = |(k, place): (usize, &usize)| *place < scalars && !self.places[..k].contains(place);
        let is_input = !self.places.is_empty() && self.places.iter().enumerate().all(is_new);
        let all = || (0..self.steps).flat_map(|step| (0..self.places.len()).map(move |input| (step, input)));
        let is_ordered = |(lower, upper)| lower <= upper && lower < f64::INFINITY && upper > f64::NEG_INFINITY;
        let Cost { time, effort } = self.cost;
        let is_cost = time >= 0.0 && effort >= 0.0 && time + effort > 0.0 && (time + effort).is_finite();
        let checks = [
            ("input", is_input && self.steps > 0),
            ("bounds", all().all(|(step, input)| is_ordered((self.bounds)(step, input)))),
            ("first guess", all().all(|(step, input)| (self.guess)(step, input).is_finite())),
            ("cost", is_cost),
            ("target", self.target.momentum.is_none_or(|momentum| momentum.is_finite())),
        ];
        match checks.iter().find(|(_, is_right)| !is_right) {
            Some((what, _)) => Err(ControlError::Unusable(what)),
            None => Search::begin(self)?.run(),
        }
    }
}

impl<'c, 'a, S, P> Search<'c, 'a, S, P>
where
    S: SecondDerivatives<Scalar = f64> + Clone,
    P: Linearisable<S> + Clone,
    ExponentialRetraction: Retraction<Group<S>>,
{
    pub(crate) const DIMENSION: usize = Group::<S>::DIMENSION;

    pub(crate) fn begin(control: &'c Control<'a, S, P>) -> Result<Self, ControlError> {
        #[allow(clippy::cast_precision_loss)] // exact up to 2⁵³
        let duration = control.stepper.step_size() * control.steps as f64;
        let model = Model::new(control, duration).ok_or(ControlError::Unusable("duration"))?;
        let inputs = control.first_inputs();
        let states = model.run(&control.start, &inputs).map_err(|(step, error)| ControlError::Step(step, error))?;
        let miss = miss(control, &states).ok_or(ControlError::Unusable("target"))?;
        let mut sides = Vec::new();
        for (step, input) in (0..control.steps).flat_map(|step| (0..control.places.len()).map(move |k| (step, k))) {
            let (lower, upper) = (control.bounds)(step, input);
            for (sign, limit) in [(1.0, lower), (-1.0, upper)] {
                if limit.is_finite() && lower < upper {
                    sides.push(Side { step, input, sign, limit, multiplier: 0.0 });
                }
            }
        }
        let multipliers = DVector::zeros(miss.len());
        let course = Course { model, inputs, states, miss };
        let (barrier, residual) = (0.0, Residual { target: f64::INFINITY, ..Residual::default() });
        let is_nearest = false;
        let least_barrier = barrier;
        let penalty = 0.0;
        let mut search =
            Self { control, course, multipliers, sides, barrier, least_barrier, penalty, residual, is_nearest };
        search.restart();
        Ok(search)
    }

    /// The barrier and the multipliers of the bounds at the beginning: of each its share in what the cost may be.
    fn restart(&mut self) {
        let Course { model, inputs, .. } = &self.course;
        let Cost { time, effort } = self.control.cost;
        let squares: f64 = self.sides.iter().map(|side| side.distance(inputs).powi(2)).sum();
        let effort = effort * 0.5 * model.stepper.step_size() * squares;
        let cost = if self.is_nearest { 1.0 } else { time * model.duration + effort };
        #[allow(clippy::cast_precision_loss)]
        let count = self.sides.len().max(1) as f64;
        self.barrier = if self.sides.is_empty() { 0.0 } else { 0.1 * cost / count };
        self.least_barrier = (1e-9 * self.barrier).min(0.1 * self.control.tolerance);
        for side in &mut self.sides {
            side.multiplier = self.barrier / side.distance(inputs);
        }
    }

    pub(crate) fn run(mut self) -> Result<ControlPlan<S, P>, ControlError> {
        let (tolerance, mut iterations) = (self.control.tolerance, 0);
        let verdict = loop {
            let Ok(stages) = self.stages() else { break Verdict::Stalled(None) };
            let end = self.end().ok_or(ControlError::Unusable("target"))?;
            let covectors = Self::covectors(&stages, &end);
            self.residual = self.residual(&stages, &covectors);
            if !(self.control.progress)(iterations, &self.residual) {
                break Verdict::Cancelled;
            }
            let Residual { stationarity, complementarity, .. } = self.residual;
            if self.is_nearest && stationarity.max(complementarity) <= tolerance.max(1e-9) {
                break self.nearest(&stages, &covectors);
            }
            if !self.is_nearest && self.residual.largest() <= tolerance {
                break Verdict::Converged;
            }
            if iterations >= self.control.most {
                break Verdict::Exhausted;
            }
            iterations += 1;
            self.lower_barrier();
            match self.improve(stages, &end, &covectors) {
                Ok(()) => {}
                Err(in_the_way) if self.is_nearest || self.course.miss.amax() <= tolerance => {
                    break Verdict::Stalled(in_the_way);
                }
                // Perhaps there is no way to the target.
                Err(_) => {
                    self.is_nearest = true;
                    self.restart();
                }
            }
        };
        let (cost, residual) = (self.cost(&self.course), self.residual);
        let Course { model, inputs, states, .. } = self.course;
        let inputs = inputs.iter().map(|chosen| model.input(chosen.as_slice())).collect();
        let multipliers = self.multipliers.as_slice().to_vec();
        let (duration, stepper) = (model.duration, model.stepper);
        Ok(ControlPlan { stepper, states, inputs, duration, cost, multipliers, residual, iterations, verdict })
    }

    /// The blocks of the steps, with the gradients and second derivatives of the cost.
    fn stages(&self) -> Result<Vec<Stage>, StepError> {
        let (model, mut weights) = (&self.course.model, self.control.cost);
        if self.is_nearest {
            weights = Cost::default();
        }
        let (states, h) = (model.states(), model.stepper.step_size());
        let stage = |(step, chosen): (usize, &DVector<f64>)| {
            let mut stage = model.blocks(&self.course.states[step], chosen)?;
            // The nearest has a little of a cost of its own, where no bound has one.
            let square = if self.is_nearest { 1e-8 * h } else { weights.effort * h };
            for input in 0..chosen.len() {
                let (lower, upper) = (self.control.bounds)(step, input);
                if lower >= upper {
                    stage.fixed.push(input);
                }
                stage.hessian[(states + input, states + input)] = square;
                if states > 2 * Self::DIMENSION {
                    let mixed = weights.effort * chosen[input] * h / model.duration;
                    stage.hessian[(states + input, states - 1)] = mixed;
                    stage.hessian[(states - 1, states + input)] = mixed;
                }
            }
            if states > 2 * Self::DIMENSION {
                let slope = weights.time + 0.5 * weights.effort * chosen.norm_squared();
                stage.state_gradient[states - 1] = slope * h / model.duration;
            }
            stage.input_gradient = chosen * (weights.effort * h);
            Ok(stage)
        };
        self.course.inputs.iter().enumerate().map(stage).collect()
    }

    pub(crate) fn cost(&self, course: &Course<S, P>) -> f64 {
        let Cost { time, effort } = self.control.cost;
        let squares: f64 = course.inputs.iter().map(DVector::norm_squared).sum();
        time * course.model.duration + effort * 0.5 * course.model.stepper.step_size() * squares
    }

    /// The condition at the end; of the nearest there is none, but the square of the miss.
    fn end(&self) -> Option<End> {
        let (states, miss) = (self.course.model.states(), self.course.miss.clone());
        let by_state = self.by_last_state()?;
        let (hessian, gradient) = (DMatrix::zeros(states, states), DVector::zeros(states));
        let plain = End { by_state, miss, multipliers: self.multipliers.clone(), hessian, gradient };
        if !self.is_nearest {
            return Some(plain);
        }
        let (hessian, gradient) = (plain.by_state.tr_mul(&plain.by_state), plain.by_state.tr_mul(&plain.miss));
        let (by_state, none) = (DMatrix::zeros(0, states), DVector::zeros(0));
        Some(End { by_state, miss: none.clone(), multipliers: none, hessian, gradient })
    }

    /// The derivatives of the miss: with `exp(ξ) = g_t⁻¹ g` and the tangent `T` of the exponential, `dξ = T⁻¹ Ad ζ`.
    fn by_last_state(&self) -> Option<DMatrix<f64>> {
        let dimension = Self::DIMENSION;
        let mut found = DMatrix::zeros(self.course.miss.len(), self.course.model.states());
        let mut row = 0;
        if let Some(target) = self.control.target.attitude {
            let turn = target.inverse().compose(&self.course.states[self.control.steps].attitude());
            let of = |matrix| {
                let column = |k| flat([&<Vector<S> as Coordinates<f64>>::column(matrix, k)]);
                DMatrix::from_columns(&(0..dimension).map(column).collect::<Vec<_>>())
            };
            let tangent = ExponentialRetraction::tangent(&ExponentialRetraction::local_coordinates(&turn)?);
            let derivative = of(&tangent).lu().solve(&of(&turn.adjoint_matrix()))?;
            found.view_mut((0, 0), (dimension, dimension)).copy_from(&derivative);
            row = dimension;
        }
        if self.control.target.momentum.is_some() {
            found.view_mut((row, dimension), (dimension, dimension)).fill_with_identity();
        }
        Some(found)
    }

    /// The derivatives of the Lagrange function by each state, from the first to the last.
    fn covectors(stages: &[Stage], end: &End) -> Vec<DVector<f64>> {
        let mut covectors = vec![&end.gradient + end.by_state.tr_mul(&end.multipliers)];
        for (k, stage) in stages.iter().rev().enumerate() {
            covectors.push(stage.by_state.tr_mul(&covectors[k]) + &stage.state_gradient);
        }
        covectors.reverse();
        covectors
    }

    fn residual(&self, stages: &[Stage], covectors: &[DVector<f64>]) -> Residual {
        let slope = |(k, stage): (usize, &Stage)| &stage.input_gradient + stage.by_input.tr_mul(&covectors[k + 1]);
        let mut slopes: Vec<DVector<f64>> = stages.iter().enumerate().map(slope).collect();
        let mut complementarity = 0.0_f64;
        for side in &self.sides {
            slopes[side.step][side.input] -= side.sign * side.multiplier;
            complementarity = complementarity.max(side.distance(&self.course.inputs) * side.multiplier);
        }
        for (slopes, stage) in slopes.iter_mut().zip(stages) {
            stage.fixed.iter().for_each(|&input| slopes[input] = 0.0);
        }
        let by_duration = covectors[0].iter().skip(2 * Self::DIMENSION);
        let all = slopes.iter().flatten().chain(by_duration);
        let stationarity = all.fold(0.0_f64, |most, slope| most.max(slope.abs()));
        Residual { stationarity, target: self.course.miss.amax(), complementarity }
    }

    /// The barrier is lowered when its own problem is solved well enough.
    fn lower_barrier(&mut self) {
        let target = if self.is_nearest { 0.0 } else { self.residual.target };
        let uneven = |side: &Side| (side.distance(&self.course.inputs) * side.multiplier - self.barrier).abs();
        let uneven = self.sides.iter().map(uneven).fold(self.residual.stationarity.max(target), f64::max);
        while self.barrier > self.least_barrier && uneven <= 10.0 * self.barrier {
            self.barrier = (0.2 * self.barrier).min(self.barrier.powf(1.5)).max(self.least_barrier);
        }
    }
}

/// What is left to the target, by its coordinates there; `None` where these don't reach.
pub(crate) fn miss<S, P>(control: &Control<'_, S, P>, states: &[StateOf<S, P>]) -> Option<DVector<f64>>
where
    S: SecondDerivatives<Scalar = f64>,
    P: Plan<S>,
    ExponentialRetraction: Retraction<Group<S>>,
{
    let (last, mut left) = (states.last()?, Vec::new());
    if let Some(target) = control.target.attitude {
        left.push(ExponentialRetraction::local_coordinates(&target.inverse().compose(&last.attitude()))?);
    }
    left.extend(control.target.momentum.map(|target| last.momentum() - target));
    let left = flat(&left);
    left.iter().all(|entry| entry.is_finite()).then_some(left)
}
