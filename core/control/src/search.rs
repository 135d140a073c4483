//! The search: a sequence of quadratic programmes with a barrier.

use liestep::StepError;
use liestep::gradients::Plant;
use nalgebra::{DMatrix, DVector};

use crate::control::{Control, Cost};
use crate::model::{Model, by_displacement};
use crate::riccati::{End, Stage, add_square, of_state, solve};
use crate::verdict::{ControlError, ControlPlan, Residual, Verdict};

/// The distance from target and constraints of a feasible motion.
pub(crate) const FOUND: f64 = 1e-6;

/// A motion, and its miss of the target.
pub(crate) struct Course<M: Plant> {
    pub(crate) model: Model<M>,
    pub(crate) inputs: Vec<DVector<f64>>,
    pub(crate) states: Vec<M::State>,
    pub(crate) miss: DVector<f64>,
    /// The constrained values, state by state after the start.
    pub(crate) kept: Vec<f64>,
    /// The slacks of the constraints, which are positive, and equal to the values in the end.
    pub(crate) distances: Vec<f64>,
    /// The derivatives of the constrained values.
    pub(crate) slopes: Vec<DVector<f64>>,
}

impl<M: Plant> Course<M> {
    /// The violated constraints, by their places, and their negative values.
    pub(crate) fn broken(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.kept.iter().copied().enumerate().filter(|(_, value)| *value < 0.0)
    }
}

/// One bound or constraint, and its multiplier.
#[derive(Clone)]
pub(crate) struct Side {
    /// The number of the input, or of the state.
    pub(crate) step: usize,
    pub(crate) limit: Limit,
    pub(crate) multiplier: f64,
}

#[derive(Clone, Copy)]
pub(crate) enum Limit {
    /// The bound `sign (u − bound) ≥ 0` of this chosen scalar.
    Input(usize, f64, f64),
    /// The constraint of this place.
    Kept(usize),
}

impl Side {
    pub(crate) fn distance<M: Plant>(&self, course: &Course<M>) -> f64 {
        match self.limit {
            Limit::Input(input, sign, bound) => sign * (course.inputs[self.step][input] - bound),
            Limit::Kept(place) => course.distances[place],
        }
    }

    /// The constrained value minus its slack.
    pub(crate) fn gap<M: Plant>(&self, course: &Course<M>) -> f64 {
        match self.limit {
            Limit::Input(..) => 0.0,
            Limit::Kept(place) => course.kept[place] - course.distances[place],
        }
    }
}

pub(crate) struct Search<'c, 'a, M: Plant> {
    pub(crate) control: &'c Control<'a, M>,
    pub(crate) course: Course<M>,
    /// The multipliers of the conditions at the end.
    pub(crate) multipliers: DVector<f64>,
    pub(crate) sides: Vec<Side>,
    pub(crate) barrier: f64,
    least_barrier: f64,
    /// The weight of the miss in the merit.
    pub(crate) penalty: f64,
    /// The residual before the last step.
    pub(crate) residual: Residual,
    /// Whether the miss itself is minimised, instead of the cost under the condition that there is no miss.
    pub(crate) is_nearest: bool,
}

impl<M: Plant> Control<'_, M> {
    /// Searches for an optimum; the [verdict](ControlPlan::verdict) says whether one was found.
    ///
    /// # Errors
    ///
    /// [`ControlError`] if the search can't start.
    pub fn solve(&self) -> Result<ControlPlan<M>, ControlError> {
        self.stepper.check()?;
        let scalars = M::numbers(&self.like).len();
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
            (
                "target",
                self.target
                    .momentum
                    .as_ref()
                    .is_none_or(|momentum| M::components(momentum).iter().all(|entry| entry.is_finite())),
            ),
        ];
        match checks.iter().find(|(_, is_right)| !is_right) {
            Some((what, _)) => Err(ControlError::Unusable(what)),
            None => Search::begin(self)?.run(),
        }
    }
}

impl<'c, 'a, M: Plant> Search<'c, 'a, M> {
    fn dimension(&self) -> usize {
        self.control.stepper.dimension()
    }

    pub(crate) fn begin(control: &'c Control<'a, M>) -> Result<Self, ControlError> {
        #[allow(clippy::cast_precision_loss)] // exact up to 2⁵³
        let duration = control.stepper.step_size() * control.steps as f64;
        let model = Model::new(control, duration).ok_or(ControlError::Unusable("duration"))?;
        for (number, value) in control.kept.iter().enumerate() {
            // A NaN violates the constraint, too.
            match value(0, M::motion(&control.start)) {
                within if within >= 0.0 => {}
                value => return Err(ControlError::Outside(number, value)),
            }
        }
        let inputs = control.first_inputs();
        let course = course(control, model, inputs)
            .map_err(|(step, error)| ControlError::Step(step, error))?
            .ok_or(ControlError::Unusable("target"))?;
        let multipliers = DVector::zeros(course.miss.len());
        let (barrier, residual) = (0.0, Residual { target: f64::INFINITY, ..Residual::default() });
        let (sides, least_barrier, penalty, is_nearest) = (Vec::new(), barrier, 0.0, false);
        let mut search =
            Self { control, course, multipliers, sides, barrier, least_barrier, penalty, residual, is_nearest };
        search.restart(false);
        Ok(search)
    }

    /// The bounds, and the constraints unless the miss is minimised.
    fn sides(&self) -> Vec<Side> {
        let control = self.control;
        let mut sides = Vec::new();
        for (step, input) in (0..control.steps).flat_map(|step| (0..control.places.len()).map(move |k| (step, k))) {
            let (lower, upper) = (control.bounds)(step, input);
            for (sign, limit) in [(1.0, lower), (-1.0, upper)] {
                if limit.is_finite() && lower < upper {
                    sides.push(Side { step, limit: Limit::Input(input, sign, limit), multiplier: 0.0 });
                }
            }
        }
        let of_kept = |place| Side { step: 1 + place / control.kept.len(), limit: Limit::Kept(place), multiplier: 0.0 };
        let kept = if self.is_nearest { 0 } else { self.course.kept.len() };
        sides.extend((0..kept).map(of_kept));
        sides
    }

    /// Sets the first barrier, an equal share of an estimated cost for each bound, and the multipliers.
    fn restart(&mut self, is_nearest: bool) {
        (self.is_nearest, self.penalty) = (is_nearest, 0.0);
        // A barrier needs room.
        let room = 0.01 * self.course.kept.iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()));
        self.course.distances = self.course.kept.iter().map(|value| value.max(room)).collect();
        self.sides = self.sides();
        let model = &self.course.model;
        let Cost { time, effort } = self.control.cost;
        let of_inputs = self.sides.iter().filter(|side| matches!(side.limit, Limit::Input(..)));
        let squares: f64 = of_inputs.map(|side| side.distance(&self.course).powi(2)).sum();
        let effort = effort * 0.5 * model.stepper.step_size() * squares;
        let cost = match time * model.duration + effort {
            _ if self.is_nearest => 1.0,
            // The effort without bounds, to first order.
            0.0 => self.least_effort().unwrap_or(1.0),
            cost => cost,
        };
        #[allow(clippy::cast_precision_loss)]
        let count = self.sides.len().max(1) as f64;
        self.barrier = if self.sides.is_empty() { 0.0 } else { 0.1 * cost / count };
        self.least_barrier = (1e-9 * self.barrier).min(0.1 * self.control.tolerance.max(0.0));
        for side in &mut self.sides {
            side.multiplier = self.barrier / side.distance(&self.course);
        }
    }

    fn least_effort(&self) -> Option<f64> {
        let (stages, end) = (self.stages().ok()?, self.end()?);
        let solution = solve(&stages, &end, self.course.model.constants)?;
        let squares: f64 = solution.inputs.iter().zip(&self.course.inputs).map(|(a, b)| (a + b).norm_squared()).sum();
        Some(self.control.cost.effort * 0.5 * self.course.model.stepper.step_size() * squares)
            .filter(|cost| *cost > 0.0)
    }

    pub(crate) fn run(mut self) -> Result<ControlPlan<M>, ControlError> {
        let (tolerance, mut iterations) = (self.control.tolerance, 0);
        let mut is_found = false;
        let verdict = loop {
            // The motion is feasible: the search for the optimum goes on from it, once.
            if self.is_nearest && !is_found && self.distance(&self.course) <= FOUND {
                is_found = true;
                self.restart(false);
            }
            let Ok(mut stages) = self.stages() else { break Verdict::Stalled(None) };
            let mut end = self.end().ok_or(ControlError::Unusable("target"))?;
            self.course.slopes = self.slopes(&stages).ok_or(ControlError::Unusable("value that is kept"))?;
            if self.is_nearest {
                self.add_squares(&mut stages, &mut end);
            }
            let covectors = self.covectors(&stages, &end);
            self.residual = self.residual(&stages, &covectors);
            if !(self.control.progress)(iterations, &self.residual) {
                break Verdict::Cancelled;
            }
            let Residual { stationarity, complementarity, .. } = self.residual;
            if self.is_nearest && stationarity.max(complementarity) <= 1e-9 {
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
            match self.improve(stages, end, &covectors) {
                Ok(()) => {}
                Err(in_the_way) if self.is_nearest || self.residual.target.max(self.residual.kept) <= tolerance => {
                    break Verdict::Stalled(in_the_way);
                }
                // Perhaps no motion is feasible: the miss is minimised next.
                Err(_) => {
                    self.restart(true);
                }
            }
        };
        let (cost, residual) = (self.cost(&self.course), self.residual);
        let of_kept = self.sides.iter().filter(|side| matches!(side.limit, Limit::Kept(_)));
        let prices = of_kept.map(|side| side.multiplier).collect();
        let Course { model, inputs, states, .. } = self.course;
        let inputs = inputs.iter().map(|chosen| model.input(chosen.as_slice())).collect();
        let multipliers = self.multipliers.as_slice().to_vec();
        let (duration, stepper) = (model.duration, model.stepper);
        Ok(ControlPlan { stepper, states, inputs, duration, cost, multipliers, prices, residual, iterations, verdict })
    }

    /// The derivatives of the constrained values.
    fn slopes(&self, stages: &[Stage]) -> Option<Vec<DVector<f64>>> {
        let (Course { model, states, .. }, kept) = (&self.course, &self.control.kept);
        let values = |step: usize| {
            move |state: &M::State, _: &[f64]| kept.iter().map(|value| value(step, M::motion(state))).collect()
        };
        let mut found = Vec::with_capacity(self.course.kept.len());
        for (step, stage) in (1..).zip(stages).take_while(|_| !kept.is_empty()) {
            let slopes =
                model.slopes(&states[step], stage, &[], values(step))?.resize_horizontally(model.states(), 0.0);
            found.extend(slopes.row_iter().map(|row| row.transpose()));
        }
        Some(found)
    }

    /// Adds half the squared violation of each constraint.
    fn add_squares(&self, stages: &mut [Stage], end: &mut End) {
        for (place, value) in self.course.broken() {
            let (hessian, gradient) = of_state(stages, end, 1 + place / self.control.kept.len());
            let slope = &self.course.slopes[place];
            add_square(hessian, slope, 1.0);
            gradient.axpy(value, slope, 1.0);
        }
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
            // A small damping makes the least miss convex in inputs without bounds.
            let square = if self.is_nearest { 1e-8 * h } else { weights.effort * h };
            for input in 0..chosen.len() {
                let (lower, upper) = (self.control.bounds)(step, input);
                if lower >= upper {
                    stage.fixed.push(input);
                }
                stage.hessian[(states + input, states + input)] = square;
                if states > 2 * self.dimension() {
                    let mixed = weights.effort * chosen[input] * h / model.duration;
                    stage.hessian[(states + input, states - 1)] = mixed;
                    stage.hessian[(states - 1, states + input)] = mixed;
                }
            }
            if states > 2 * self.dimension() {
                let slope = weights.time + 0.5 * weights.effort * chosen.norm_squared();
                stage.state_gradient[states - 1] = slope * h / model.duration;
            }
            stage.input_gradient = chosen * (weights.effort * h);
            Ok(stage)
        };
        self.course.inputs.iter().enumerate().map(stage).collect()
    }

    pub(crate) fn cost(&self, course: &Course<M>) -> f64 {
        let Cost { time, effort } = self.control.cost;
        let squares: f64 = course.inputs.iter().map(DVector::norm_squared).sum();
        time * course.model.duration + effort * 0.5 * course.model.stepper.step_size() * squares
    }

    /// The condition at the end, or half the squared miss as a cost while that is minimised.
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

    /// The derivatives of the miss by the last state.
    fn by_last_state(&self) -> Option<DMatrix<f64>> {
        let dimension = self.dimension();
        let mut found = DMatrix::zeros(self.course.miss.len(), self.course.model.states());
        let mut row = 0;
        if let Some(target) = &self.control.target.attitude {
            let last = &self.course.states[self.control.steps];
            let derivative = by_displacement(self.control.stepper, target, last)?;
            found.view_mut((0, 0), (dimension, dimension)).copy_from(&derivative);
            row = dimension;
        }
        if self.control.target.momentum.is_some() {
            found.view_mut((row, dimension), (dimension, dimension)).fill_with_identity();
        }
        Some(found)
    }

    /// The derivatives of the Lagrange function by each state, from the first to the last.
    fn covectors(&self, stages: &[Stage], end: &End) -> Vec<DVector<f64>> {
        let last = &end.gradient + end.by_state.tr_mul(&end.multipliers);
        let gradients = stages.iter().map(|stage| stage.state_gradient.clone());
        let mut covectors: Vec<DVector<f64>> = gradients.chain([last]).collect();
        for side in &self.sides {
            if let Limit::Kept(place) = side.limit {
                covectors[side.step].axpy(-side.multiplier, &self.course.slopes[place], 1.0);
            }
        }
        for (k, stage) in stages.iter().enumerate().rev() {
            let carried = stage.by_state.tr_mul(&covectors[k + 1]);
            covectors[k] += carried;
        }
        covectors
    }

    fn residual(&self, stages: &[Stage], covectors: &[DVector<f64>]) -> Residual {
        let slope = |(k, stage): (usize, &Stage)| &stage.input_gradient + stage.by_input.tr_mul(&covectors[k + 1]);
        let mut slopes: Vec<DVector<f64>> = stages.iter().enumerate().map(slope).collect();
        let (mut kept, mut complementarity) = (0.0_f64, 0.0_f64);
        for side in &self.sides {
            if let Limit::Input(input, sign, _) = side.limit {
                slopes[side.step][input] -= sign * side.multiplier;
            }
            kept = kept.max(side.gap(&self.course).abs());
            complementarity = complementarity.max(side.distance(&self.course) * side.multiplier);
        }
        for (slopes, stage) in slopes.iter_mut().zip(stages) {
            stage.fixed.iter().for_each(|&input| slopes[input] = 0.0);
        }
        let by_duration = covectors[0].iter().skip(2 * self.dimension());
        let all = slopes.iter().flatten().chain(by_duration);
        let stationarity = all.fold(0.0_f64, |most, slope| most.max(slope.abs()));
        Residual { stationarity, target: self.course.miss.amax(), kept, complementarity }
    }

    /// Lowers the barrier once its own problem is solved well enough.
    fn lower_barrier(&mut self) {
        let target = if self.is_nearest { 0.0 } else { self.residual.target.max(self.residual.kept) };
        let uneven = |side: &Side| (side.distance(&self.course) * side.multiplier - self.barrier).abs();
        let uneven = self.sides.iter().map(uneven).fold(self.residual.stationarity.max(target), f64::max);
        // A barrier that has overflowed stays where it is.
        while self.barrier.is_finite() && self.barrier > self.least_barrier && uneven <= 10.0 * self.barrier {
            self.barrier = (0.2 * self.barrier).min(self.barrier.powf(1.5)).max(self.least_barrier);
        }
    }
}

/// The course with these inputs, and slacks equal to the values; `None` without finite values and a finite miss.
pub(crate) fn course<M: Plant>(
    control: &Control<'_, M>,
    model: Model<M>,
    inputs: Vec<DVector<f64>>,
) -> Result<Option<Course<M>>, (usize, StepError)> {
    let states = model.run(&control.start, &inputs)?;
    let values = states
        .iter()
        .enumerate()
        .skip(1)
        .flat_map(|(step, state)| control.kept.iter().map(move |value| value(step, M::motion(state))));
    let kept: Vec<f64> = values.collect();
    let Some(miss) = miss(control, &states).filter(|_| kept.iter().all(|value| value.is_finite())) else {
        return Ok(None);
    };
    Ok(Some(Course { model, inputs, states, miss, distances: kept.clone(), kept, slopes: Vec::new() }))
}

/// The miss of the target, in coordinates about it; `None` if these don't reach the end.
pub(crate) fn miss<M: Plant>(control: &Control<'_, M>, states: &[M::State]) -> Option<DVector<f64>> {
    let (last, mut left) = (states.last()?, Vec::new());
    if let Some(target) = &control.target.attitude {
        left.extend(control.stepper.displacement(target, last)?);
    }
    if let Some(target) = &control.target.momentum {
        left.extend(
            control
                .stepper
                .momentum(last)
                .iter()
                .zip(M::components(target))
                .map(|(momentum, target)| momentum - target),
        );
    }
    left.iter().all(|entry| entry.is_finite()).then(|| DVector::from_vec(left))
}
