//! A step of the search: its direction by the quadratic programme, its length by a line search.

use liestep::StepError;
use liestep::gradients::Plant;
use nalgebra::DVector;

use crate::model::Model;
use crate::riccati::{End, Solution, Stage, add_square, of_state, solve};
use crate::search::{Course, FOUND, Limit, Search, course};
use crate::verdict::Verdict;

/// The largest part of the room to its bound that a step of an input may take.
const ROOM: f64 = 0.995;
/// The least decrease of a step, as a share of the predicted one: Armijo's.
const ARMIJO: f64 = 1e-4;
/// The shortest step that is tried, as a share of the whole step.
const SHORTEST: f64 = 1e-7;
/// The largest change of the duration, as a share of it.
const DURATION: f64 = 0.3;
/// The residual below which the corner of the optimum is near.
const NEAR: f64 = 1e-4;
/// The attempts to make a programme convex: the weight of the condition's square, in multipliers, and the damping, in
/// the least second derivative by an input.
const CONVEX: [(f64, f64); 7] =
    [(0.0, 0.0), (10.0, 0.0), (1e3, 0.0), (1e3, 1.0), (1e3, 10.0), (1e3, 100.0), (1e3, 1e4)];

impl<M: Plant> Search<'_, '_, M> {
    /// Makes a step that is better by the merit `cost + barrier + penalty · |miss|`; the error has the step of the
    /// motion that failed, if one did.
    pub(crate) fn improve(
        &mut self,
        mut stages: Vec<Stage>,
        mut end: End,
        covectors: &[DVector<f64>],
    ) -> Result<(), Option<(usize, StepError)>> {
        self.add_barrier(&mut stages, &mut end);
        let solution = self.direction(stages, &end, covectors).ok_or(None)?;
        let longer = solution.states[0].sum();
        let mut longest = (DURATION * self.course.model.duration / longer.abs()).min(1.0);
        // The cost is proportional to the duration.
        let mut slope = longer * self.cost(&self.course) / self.course.model.duration;
        let effort = self.control.cost.effort * self.course.model.stepper.step_size();
        let by_inputs = self.course.inputs.iter().zip(&solution.inputs).map(|(now, change)| now.dot(change));
        slope += effort * by_inputs.sum::<f64>();
        // The changes of slacks and multipliers, `δs` and `β/s − z − z/s δs`, and the longest steps of both.
        let mut changes = Vec::with_capacity(self.sides.len());
        let (mut of_multipliers, mut squares) = (1.0_f64, solution.multipliers.norm_squared());
        for side in &self.sides {
            let (now, distance) = (side.multiplier, side.distance(&self.course));
            let further = match side.limit {
                Limit::Input(input, sign, _) => sign * solution.inputs[side.step][input],
                Limit::Kept(place) => {
                    self.course.slopes[place].dot(&solution.states[side.step]) + side.gap(&self.course)
                }
            };
            let change = (self.barrier - now * further) / distance - now;
            if further < 0.0 {
                longest = longest.min(ROOM * distance / -further);
            }
            if change < -ROOM * now {
                of_multipliers = of_multipliers.min(ROOM * now / -change);
            }
            if let Limit::Kept(_) = side.limit {
                squares += (now + change).powi(2);
            }
            slope -= self.barrier * further / distance;
            changes.push((further, change));
        }
        let distance = self.distance(&self.course);
        if self.is_nearest {
            // The merit is half the squared distance, and any decrease will do.
            (slope, self.penalty) = (0.0, 0.0);
        } else if distance > 0.0 {
            self.penalty = self.penalty.max(1.1 * slope / (0.9 * distance)).max(1.1 * squares.sqrt());
            slope -= self.penalty * distance;
        }
        let merit = self.merit(&self.course);
        // At the level of rounding the step is taken without a decrease.
        let rounding = 1e-13 * (1.0 + merit.abs());
        let (mut share, mut in_the_way) = (longest, None);
        while share > SHORTEST {
            match self.course_after(&solution, &changes, share) {
                Ok(Some(course)) if self.merit(&course) <= merit + ARMIJO * share * slope.min(0.0) + rounding => {
                    for (side, (_, change)) in self.sides.iter_mut().zip(changes) {
                        side.multiplier += of_multipliers * change;
                    }
                    if !self.is_nearest {
                        self.multipliers += (&solution.multipliers - &self.multipliers) * share;
                    }
                    self.course = course;
                    return Ok(());
                }
                Ok(_) => {}
                Err(error) => in_the_way = Some(error),
            }
            share *= 0.5;
        }
        Err(in_the_way)
    }

    /// Adds `z/s` to the second derivatives, and `−(β − z g)/s` to the gradient, with the gap `g` between a value and
    /// its slack.
    fn add_barrier(&self, stages: &mut [Stage], end: &mut End) {
        let states = self.course.model.states();
        for side in &self.sides {
            let (distance, multiplier) = (side.distance(&self.course), side.multiplier);
            let (weight, push) =
                (multiplier / distance, (self.barrier - multiplier * side.gap(&self.course)) / distance);
            match side.limit {
                Limit::Input(input, sign, _) => {
                    let stage = &mut stages[side.step];
                    stage.hessian[(states + input, states + input)] += weight;
                    stage.input_gradient[input] -= sign * push;
                }
                Limit::Kept(place) => {
                    let slope = &self.course.slopes[place];
                    let (hessian, gradient) = of_state(stages, end, side.step);
                    add_square(hessian, slope, weight);
                    gradient.axpy(-push, slope, 1.0);
                }
            }
        }
    }

    /// The solution of the programme, with the second derivatives of the steps if they help, else without.
    ///
    /// A cost of time alone has its optimum in a corner, where second derivatives don't matter; on the way there they
    /// are those of a saddle. They are used near the corner only.
    fn direction(&self, mut stages: Vec<Stage>, end: &End, covectors: &[DVector<f64>]) -> Option<Solution> {
        let is_far_from_its_corner = self.control.cost.effort == 0.0 && self.residual.largest() > NEAR;
        let is_nearest = self.is_nearest && self.course.model.constants == 0;
        let constants = self.course.model.constants;
        if !is_nearest && (self.multipliers.amax() == 0.0 || is_far_from_its_corner) {
            return solve(&stages, end, constants);
        }
        // Only the second derivatives are copied, as memory limits a long plan.
        let plain: Vec<_> = stages.iter().map(|stage| stage.hessian.clone()).collect();
        let bent = self.bend(&mut stages, end.clone(), covectors);
        bent.and_then(|end| self.convex(&mut stages, &end)).or_else(|| {
            stages.iter_mut().zip(plain).for_each(|(stage, plain)| stage.hessian = plain);
            solve(&stages, end, constants)
        })
    }

    /// Adds the second derivatives of the steps and of the constraints. `None` if a neighbouring step fails.
    fn bend(&self, stages: &mut [Stage], mut end: End, covectors: &[DVector<f64>]) -> Option<End> {
        let Course { model, states, inputs, .. } = &self.course;
        for (step, stage) in stages.iter_mut().enumerate() {
            stage.hessian += model.bending(&states[step], &inputs[step], stage, &covectors[step + 1])?;
        }
        let of_sides = self.sides.iter().filter_map(|side| match side.limit {
            Limit::Kept(place) => Some((place, -side.multiplier)),
            Limit::Input(..) => None,
        });
        let broken = self.course.broken().filter(|_| self.is_nearest);
        for (place, weight) in of_sides.chain(broken) {
            let (step, number) = (1 + place / self.control.kept.len(), place % self.control.kept.len());
            let value = |state: &M::State| self.control.kept[number](step, M::motion(state));
            let curvature = model.curvature(&states[step], &stages[step - 1], value)?;
            let mut hessian = of_state(stages, &mut end, step).0.view_mut((0, 0), curvature.shape());
            hessian += curvature * weight;
        }
        Some(end)
    }

    /// The solution of a programme that is made convex if it isn't: by a square of the condition, which doesn't change
    /// the solution, and by a damping of the inputs.
    fn convex(&self, stages: &mut [Stage], end: &End) -> Option<Solution> {
        let (states, size, mut damped) = (self.course.model.states(), self.multipliers.norm(), 0.0);
        let of_inputs =
            stages.iter().flat_map(|stage| stage.hessian.diagonal().iter().skip(states).copied().collect::<Vec<_>>());
        let of_miss = stages.iter().map(|stage| 1e-4 * stage.by_input.norm_squared()).fold(0.0, f64::max);
        let least = if self.is_nearest {
            of_miss
        } else {
            of_inputs.fold(f64::INFINITY, |least, entry| least.min(entry.abs())).max(f64::MIN_POSITIVE)
        };
        CONVEX.into_iter().find_map(|(weight, damping)| {
            for stage in &mut *stages {
                for k in states..stage.hessian.nrows() {
                    stage.hessian[(k, k)] += (damping - damped) * least;
                }
            }
            damped = damping;
            let hessian = &end.hessian + end.by_state.tr_mul(&end.by_state) * (weight * size);
            let gradient = &end.gradient + end.by_state.tr_mul(&end.miss) * (weight * size);
            solve(stages, &End { hessian, gradient, ..end.clone() }, self.course.model.constants)
        })
    }

    /// The course after a share of a step. `None` if the target's coordinates don't reach it, or no stepper has such a
    /// duration.
    fn course_after(
        &self,
        solution: &Solution,
        changes: &[(f64, f64)],
        share: f64,
    ) -> Result<Option<Course<M>>, (usize, StepError)> {
        let change = |(now, change): (&DVector<f64>, &DVector<f64>)| now + change * share;
        let inputs: Vec<DVector<f64>> = self.course.inputs.iter().zip(&solution.inputs).map(change).collect();
        let duration = self.course.model.duration + solution.states[0].sum() * share;
        let Some(model) = Model::new(self.control, duration) else { return Ok(None) };
        let mut course = course(self.control, model, inputs)?;
        for (side, (further, _)) in self.sides.iter().zip(changes) {
            if let (Limit::Kept(place), Some(course)) = (side.limit, &mut course) {
                // The slack is the value itself, or the slack's own step if that is larger.
                let distance = &mut course.distances[place];
                *distance = distance.max(self.course.distances[place] + share * further);
            }
        }
        Ok(course)
    }

    /// The distance of a course from the target and from the constraints.
    pub(crate) fn distance(&self, course: &Course<M>) -> f64 {
        let squares: f64 = if self.is_nearest {
            course.broken().map(|(_, value)| value * value).sum()
        } else {
            self.sides.iter().map(|side| side.gap(course).powi(2)).sum()
        };
        (course.miss.norm_squared() + squares).sqrt()
    }

    fn merit(&self, course: &Course<M>) -> f64 {
        let logarithms: f64 = self.sides.iter().map(|side| side.distance(course).ln()).sum();
        let distance = self.distance(course);
        let merit =
            if self.is_nearest { 0.5 * distance * distance } else { self.cost(course) + self.penalty * distance };
        if self.sides.is_empty() { merit } else { merit - self.barrier * logarithms }
    }

    /// The verdict at the least miss, by the decrease that the bounds of the inputs allow, to first order.
    pub(crate) fn nearest(&self, stages: &[Stage], covectors: &[DVector<f64>]) -> Verdict {
        let distance = self.distance(&self.course);
        let mut best = 0.0;
        for side in &self.sides {
            let Limit::Input(input, sign, _) = side.limit else { continue };
            let slope = stages[side.step].by_input.column(input).dot(&covectors[side.step + 1]) / distance;
            best += (sign * slope).max(0.0) * side.distance(&self.course);
        }
        let (gap, kept) = (distance - best, self.course.kept.iter().map(|value| value.min(0.0)));
        let direction = self.course.miss.iter().copied().chain(kept).map(|entry| entry / distance).collect();
        if gap > FOUND { Verdict::Infeasible { direction, gap } } else { Verdict::Stalled(None) }
    }
}
