//! A step of the search: its direction by the quadratic programme, its length by a line search.

use liestep::StepError;
use liestep::gradients::Linearisable;
use liestep::groups::{ExponentialRetraction, Retraction};
use liestep::mechanics::{Group, SecondDerivatives};
use nalgebra::DVector;

use crate::model::Model;
use crate::riccati::{End, Solution, Stage, solve};
use crate::search::{Course, Search, miss};
use crate::verdict::Verdict;

/// How near to its bound a step may bring an input, as a share of the room.
const ROOM: f64 = 0.995;
/// The decrease that a step has to have, as a share of the one foretold: Armijo's.
const ARMIJO: f64 = 1e-4;
/// The shortest step that is tried, as a share of the whole.
const SHORTEST: f64 = 1e-7;
/// The largest change of the duration, as a share of it.
const DURATION: f64 = 0.3;
/// The residual below which a corner is near.
const NEAR: f64 = 1e-4;
/// What is tried in turn to make a programme convex: the weight of the condition's square, in multipliers, and the damping,
/// in the least second derivative by an input.
const CONVEX: [(f64, f64); 7] =
    [(0.0, 0.0), (10.0, 0.0), (1e3, 0.0), (1e3, 1.0), (1e3, 10.0), (1e3, 100.0), (1e3, 1e4)];

impl<S, P> Search<'_, '_, S, P>
where
    S: SecondDerivatives<Scalar = f64> + Clone,
    P: Linearisable<S> + Clone,
    ExponentialRetraction: Retraction<Group<S>>,
{
    /// Makes a step that is better by the merit `cost + barrier + penalty · |miss|`; an error is a step of the motion that
    /// was in the way.
    pub(crate) fn improve(
        &mut self,
        mut stages: Vec<Stage>,
        end: &End,
        covectors: &[DVector<f64>],
    ) -> Result<(), Option<(usize, StepError)>> {
        let (states, inputs) = (self.course.model.states(), &self.course.inputs);
        // `z/s` in the second derivatives, `∓β/s` in the gradient.
        for side in &self.sides {
            let (stage, distance) = (&mut stages[side.step], side.distance(inputs));
            stage.hessian[(states + side.input, states + side.input)] += side.multiplier / distance;
            stage.input_gradient[side.input] -= side.sign * self.barrier / distance;
        }
        let solution = self.direction(&stages, end, covectors).ok_or(None)?;
        let longer = solution.start.sum();
        let (mut slope, mut longest) = (0.0, (DURATION * self.course.model.duration / longer.abs()).min(1.0));
        for (stage, change) in stages.iter().zip(&solution.inputs) {
            slope += stage.input_gradient.dot(change);
            slope += longer * stage.state_gradient.iter().skip(2 * Self::DIMENSION).sum::<f64>();
        }
        let distance = self.course.miss.norm();
        if self.is_nearest {
            // Its square is the cost, and any decrease will do.
            (slope, self.penalty) = (0.0, 0.0);
        } else if distance > 0.0 {
            self.penalty = self.penalty.max(1.1 * slope / (0.9 * distance)).max(1.1 * solution.multipliers.norm());
            slope -= self.penalty * distance;
        }
        // How the multipliers change, `β/s − z − z/s δs`, and how far both may go.
        let (mut of_multipliers, mut changes) = (1.0_f64, Vec::with_capacity(self.sides.len()));
        for side in &self.sides {
            let (now, room) = (side.multiplier, side.distance(inputs));
            let nearer = -side.sign * solution.inputs[side.step][side.input];
            let change = (self.barrier + now * nearer) / room - now;
            if nearer > 0.0 {
                longest = longest.min(ROOM * room / nearer);
            }
            if change < -ROOM * now {
                of_multipliers = of_multipliers.min(ROOM * now / -change);
            }
            changes.push(change);
        }
        let merit = self.merit(&self.course);
        // Where no digit of the merit is left to be better, the step is taken as it is.
        let rounding = 1e-13 * (1.0 + merit.abs());
        let (mut share, mut in_the_way) = (longest, None);
        while share > SHORTEST {
            match self.course_after(&solution, share) {
                Ok(Some(course)) if self.merit(&course) <= merit + ARMIJO * share * slope.min(0.0) + rounding => {
                    for (side, change) in self.sides.iter_mut().zip(changes) {
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

    /// The programme's solution: with the second derivatives of the steps where they help, else without.
    ///
    /// A cost of time alone has its optimum in a corner, where second derivatives say nothing; on the way there they are those
    /// of a saddle. They are asked for when all corners are known.
    fn direction(&self, stages: &[Stage], end: &End, covectors: &[DVector<f64>]) -> Option<Solution> {
        let is_far_from_its_corner = self.control.cost.effort == 0.0 && self.residual.largest() > NEAR;
        let plain = || solve(stages, end, self.course.model.states() - 2 * Self::DIMENSION);
        if self.multipliers.amax() == 0.0 || self.is_nearest || is_far_from_its_corner {
            return plain();
        }
        let bent = stages.iter().enumerate().map(|(step, stage)| {
            let Course { model, states, inputs, .. } = &self.course;
            let bending = model.bending(&states[step], &inputs[step], stage, &covectors[step + 1])?;
            Some(Stage { hessian: &stage.hessian + bending, ..stage.clone() })
        });
        bent.collect::<Option<Vec<_>>>().and_then(|bent| self.convex(bent, end)).or_else(plain)
    }

    /// The solution of a programme, made convex where it isn't: by a square of the condition, which changes its solution in
    /// nothing, and by a damping of the inputs.
    fn convex(&self, mut stages: Vec<Stage>, end: &End) -> Option<Solution> {
        let (states, size, mut damped) = (self.course.model.states(), self.multipliers.norm(), 0.0);
        let of_inputs =
            stages.iter().flat_map(|stage| stage.hessian.diagonal().iter().skip(states).copied().collect::<Vec<_>>());
        let least = of_inputs.fold(f64::INFINITY, |least, entry| least.min(entry.abs())).max(f64::MIN_POSITIVE);
        CONVEX.into_iter().find_map(|(weight, damping)| {
            for stage in &mut stages {
                for k in states..stage.hessian.nrows() {
                    stage.hessian[(k, k)] += (damping - damped) * least;
                }
            }
            damped = damping;
            let hessian = &end.hessian + end.by_state.tr_mul(&end.by_state) * (weight * size);
            let gradient = &end.gradient + end.by_state.tr_mul(&end.miss) * (weight * size);
            solve(&stages, &End { hessian, gradient, ..end.clone() }, states - 2 * Self::DIMENSION)
        })
    }

    /// `None` where the target can't be seen from the end, or no stepper has such a duration.
    fn course_after(&self, solution: &Solution, share: f64) -> Result<Option<Course<S, P>>, (usize, StepError)> {
        let change = |(now, change): (&DVector<f64>, &DVector<f64>)| now + change * share;
        let inputs: Vec<DVector<f64>> = self.course.inputs.iter().zip(&solution.inputs).map(change).collect();
        let duration = self.course.model.duration + solution.start.sum() * share;
        let Some(model) = Model::new(self.control, duration) else { return Ok(None) };
        let states = model.run(&self.control.start, &inputs)?;
        Ok(miss(self.control, &states).map(|miss| Course { model, inputs, states, miss }))
    }

    fn merit(&self, course: &Course<S, P>) -> f64 {
        let logarithms: f64 = self.sides.iter().map(|side| side.distance(&course.inputs).ln()).sum();
        let merit = if self.is_nearest {
            0.5 * course.miss.norm_squared()
        } else {
            self.cost(course) + self.penalty * course.miss.norm()
        };
        if self.sides.is_empty() { merit } else { merit - self.barrier * logarithms }
    }

    /// The verdict where the miss is least: what the bounds let the inputs take off it, to first order.
    pub(crate) fn nearest(&self, stages: &[Stage], covectors: &[DVector<f64>]) -> Verdict {
        let distance = self.course.miss.norm();
        let mut best = 0.0;
        for side in &self.sides {
            let slope = stages[side.step].by_input.column(side.input).dot(&covectors[side.step + 1]) / distance;
            best += (side.sign * slope).max(0.0) * side.distance(&self.course.inputs);
        }
        let (gap, direction) = (distance - best, (&self.course.miss / distance).as_slice().to_vec());
        if gap > self.control.tolerance { Verdict::Infeasible { direction, gap } } else { Verdict::Stalled(None) }
    }
}
