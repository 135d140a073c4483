//! The steps of a plan, and their first and second derivatives in flat coordinates: a displacement `ζ`, the momentum,
//! and then the constants of the motion, as a free duration.

use liestep::StepError;
use liestep::gradients::Plant;
use nalgebra::{DMatrix, DVector};

use crate::control::Control;
use crate::riccati::Stage;

/// The changes for differences by the duration, and of derivatives: about the third and fourth root of rounding.
pub(crate) const SMALL: f64 = 1e-5;
const COARSE: f64 = 1e-4;

/// The change for differences of fourth order, and for second ones: about the fifth root of rounding.
const FOURTH: f64 = 1e-3;

/// The stepper of a duration, and the kind of its inputs.
pub(crate) struct Model<M: Plant> {
    pub(crate) duration: f64,
    pub(crate) stepper: M,
    /// The number of constants of a motion that are part of its state: a free duration, or the unknowns of an estimate.
    pub(crate) constants: usize,
    /// Differences of the constants that steps depend on: a small change of each, and the steppers with it and with its
    /// opposite.
    pub(crate) beside: Vec<(f64, [M; 2])>,
    pub(crate) like: M::Input,
    pub(crate) places: Vec<usize>,
}

/// The state displaced from this one, by a displacement of its attitude and a change of its momentum. `None` if the
/// stepper can't start there.
pub(crate) fn displaced<M: Plant>(stepper: &M, state: &M::State, x: &DVector<f64>) -> Option<M::State> {
    stepper.displaced(state, &x.as_slice()[..2 * stepper.dimension()])
}

/// The coordinates of a state about an attitude and a momentum, if there are any.
pub(crate) fn away<M: Plant>(stepper: &M, from: &M::State, to: &M::State) -> Option<Vec<f64>> {
    let mut away = stepper.displacement(&stepper.attitude(from), to)?;
    away.extend(stepper.momentum(to).iter().zip(stepper.momentum(from)).map(|(to, from)| to - from));
    Some(away)
}

/// The derivatives of the coordinates of a state about an attitude, by its displacement.
pub(crate) fn by_displacement<M: Plant>(stepper: &M, from: &M::Attitude, to: &M::State) -> Option<DMatrix<f64>> {
    let n = stepper.dimension();
    let [tangent, adjoint] =
        stepper.displacement_slopes(from, to)?.map(|columns| DMatrix::from_column_slice(n, n, &columns));
    tangent.lu().solve(&adjoint)
}

impl<M: Plant> Model<M> {
    /// The model, if the scene can be stepped in this time.
    pub(crate) fn new(control: &Control<'_, M>, duration: f64) -> Option<Self> {
        let (stepper, is_free) = (control.stepper, control.cost.time > 0.0);
        #[allow(clippy::cast_precision_loss)] // exact up to 2⁵³
        let of = |share: f64| stepper.of_length(duration * share / control.steps as f64);
        let beside = if is_free { vec![(SMALL * duration, [of(1.0 + SMALL)?, of(1.0 - SMALL)?])] } else { Vec::new() };
        let stepper = if is_free { of(1.0)? } else { stepper.clone() };
        let (like, places) = (control.like.clone(), control.places.clone());
        Some(Self { duration, stepper, constants: beside.len(), beside, like, places })
    }

    fn dimension(&self) -> usize {
        self.stepper.dimension()
    }

    /// The number of components of a state, with the constants of the motion.
    pub(crate) fn states(&self) -> usize {
        2 * self.dimension() + self.constants
    }

    /// The input with these chosen scalars.
    pub(crate) fn input(&self, chosen: &[f64]) -> M::Input {
        let mut scalars = M::numbers(&self.like);
        for (place, scalar) in self.places.iter().zip(chosen) {
            scalars[*place] = *scalar;
        }
        M::with_numbers(&self.like, &scalars)
    }

    /// The states with these inputs; the error is that of a step, with its number.
    pub(crate) fn run(&self, start: &M::State, inputs: &[DVector<f64>]) -> Result<Vec<M::State>, (usize, StepError)> {
        let mut states = vec![self.stepper.adopt(start)];
        for (k, input) in inputs.iter().enumerate() {
            let mut state = states[k].clone();
            self.stepper.step(&mut state, &self.input(input.as_slice())).map_err(|error| (k, error))?;
            states.push(state);
        }
        Ok(states)
    }

    /// The derivatives of the step from this state, without those of a cost.
    pub(crate) fn blocks(&self, state: &M::State, chosen: &DVector<f64>) -> Result<Stage, StepError> {
        let unknown = || StepError::NonFinite { what: "derivative" };
        let (input, states, count) = (self.input(chosen.as_slice()), self.states(), chosen.len());
        let (mut end, whole) = (state.clone(), 2 * self.dimension());
        let [along_state, along_input] = self.stepper.transition(&mut end, &input)?;
        let mut by_state = DMatrix::identity(states, states);
        let mut by_input = DMatrix::zeros(states, count);
        by_state.view_mut((0, 0), (whole, whole)).copy_from(&DMatrix::from_column_slice(whole, whole, &along_state));
        for (k, place) in self.places.iter().enumerate() {
            by_input.view_mut((0, k), (whole, 1)).copy_from_slice(&along_input[place * whole..(place + 1) * whole]);
        }
        let mut bent = DVector::zeros(states);
        let change = |stepper: &M| {
            let mut other = stepper.adopt(state);
            stepper.step(&mut other, &input)?;
            away(stepper, &end, &other).map(DVector::from_vec).ok_or_else(unknown)
        };
        for (k, (small, [more, less])) in self.beside.iter().enumerate() {
            let (more, less) = (change(more)?, change(less)?);
            by_state.view_mut((0, whole + k), (whole, 1)).copy_from(&((&more - &less) / (2.0 * small)));
            bent.rows_mut(0, whole).copy_from(&((more + less) / (small * small)));
        }
        let (state_gradient, input_gradient) = (DVector::zeros(states), DVector::zeros(count));
        let hessian = DMatrix::zeros(states + count, states + count);
        Ok(Stage { by_state, by_input, state_gradient, input_gradient, hessian, fixed: Vec::new(), bent })
    }

    /// The second derivatives of `λ·x⁺` by state and input, in the coordinates of the exponential, by differences of
    /// the adjoint. `None` if a neighbouring step fails.
    ///
    /// The covector at the end of a neighbouring step is `λ + ½ ad*_y λ`, where `y` is the displacement of that end.
    /// The same effect at the beginning makes the differences of derivatives asymmetric, so their symmetric part is
    /// taken.
    pub(crate) fn bending(
        &self,
        state: &M::State,
        chosen: &DVector<f64>,
        stage: &Stage,
        multipliers: &DVector<f64>,
    ) -> Option<DMatrix<f64>> {
        let (dimension, states, inputs) = (self.dimension(), self.states(), chosen.len());
        let place = &multipliers.as_slice()[..dimension];
        let pull = |stepper: &M, x: &DVector<f64>| -> Option<DVector<f64>> {
            let mut state = displaced(stepper, state, x)?;
            let beyond = &stage.by_state * x.rows(0, states) + &stage.by_input * x.rows(states, inputs);
            let turned = stepper.bracket_transpose(&beyond.as_slice()[..dimension], place);
            let mut end = multipliers.as_slice()[..2 * dimension].to_vec();
            end.iter_mut().zip(turned).for_each(|(entry, turned)| *entry += 0.5 * turned);
            let input = self.input((chosen + x.rows(states, inputs)).as_slice());
            let [start, by_scalars] = stepper.gradient(&mut state, &input, &end).ok()?;
            let mut found = DVector::zeros(states + inputs);
            found.rows_mut(0, 2 * dimension).copy_from_slice(&start);
            for (k, place) in self.places.iter().enumerate() {
                found[states + k] = *by_scalars.get(*place)?;
            }
            Some(found)
        };
        // The momentum that the force causes in one step.
        let momentum = COARSE * self.momentum(stage);
        let force = momentum / stage.by_input.rows(dimension, dimension).amax();
        let mut hessian = DMatrix::zeros(states + inputs, states + inputs);
        for k in (0..2 * dimension).chain(states..states + inputs) {
            let mut x = DVector::zeros(states + inputs);
            x[k] = if k < dimension {
                COARSE
            } else if k < states {
                momentum
            } else {
                force
            };
            let column = (pull(&self.stepper, &x)? - pull(&self.stepper, &-&x)?) / (2.0 * x[k]);
            hessian.set_column(k, &column);
        }
        if let [(small, [longer, shorter])] = &self.beside[..] {
            let (mut x, last) = (DVector::zeros(states + inputs), states - 1);
            x[last] = *small;
            let column = (pull(longer, &x)? - pull(shorter, &-&x)?) / (2.0 * x[last]);
            hessian.set_column(last, &column);
            hessian.set_row(last, &column.transpose());
            hessian[(last, last)] = multipliers.dot(&stage.bent);
        }
        hessian.iter().all(|entry| entry.is_finite()).then(|| (&hessian + hessian.transpose()) * 0.5)
    }
    /// The momentum that turns the body by a radian over the whole duration, estimated by a first step.
    fn momentum(&self, stage: &Stage) -> f64 {
        let dimension = self.dimension();
        let turn = stage.by_state.view((0, dimension), (dimension, dimension)).amax();
        self.stepper.step_size() / (self.duration * turn)
    }

    /// The changes of a state along each coordinate, and of the constants, for differences.
    fn changes(&self, stage: &Stage, constants: &[f64]) -> DVector<f64> {
        let dimension = self.dimension();
        let of = |k| match k {
            _ if k < dimension => 1.0,
            _ if k < 2 * dimension => self.momentum(stage),
            _ => constants[k - 2 * dimension],
        };
        DVector::from_fn(2 * dimension + constants.len(), |k, _| FOURTH * of(k))
    }

    /// The derivatives of values by a state and the constants, row by row; `None` if a neighbouring state doesn't
    /// exist, or values aren't finite.
    pub(crate) fn slopes(
        &self,
        state: &M::State,
        stage: &Stage,
        constants: &[f64],
        values: impl Fn(&M::State, &[f64]) -> Vec<f64>,
    ) -> Option<DMatrix<f64>> {
        let changes = self.changes(stage, constants);
        let column = |k: usize| {
            let at = |times: f64| {
                let mut x = DVector::zeros(changes.len());
                x[k] = times * changes[k];
                let constants = &x.as_slice()[2 * self.dimension()..];
                Some(DVector::from_vec(values(&displaced(&self.stepper, state, &x)?, constants)))
            };
            let [far, near] = [2.0, 1.0].map(|times| Some(at(times)? - at(-times)?));
            Some((near? * 8.0 - far?) / (12.0 * changes[k]))
        };
        let columns = (0..changes.len()).map(column).collect::<Option<Vec<_>>>()?;
        Some(DMatrix::from_columns(&columns)).filter(|found| found.iter().all(|entry| entry.is_finite()))
    }

    /// The second derivatives of a value by a state, in the coordinates of the exponential.
    pub(crate) fn curvature(
        &self,
        state: &M::State,
        stage: &Stage,
        value: impl Fn(&M::State) -> f64,
    ) -> Option<DMatrix<f64>> {
        let (changes, middle) = (self.changes(stage, &[]), 2.0 * value(state));
        let even = |places: [usize; 2]| {
            let mut x = DVector::zeros(changes.len());
            for k in places {
                x[k] += changes[k];
            }
            let [there, opposite] = [displaced(&self.stepper, state, &x)?, displaced(&self.stepper, state, &-x)?];
            Some(value(&there) + value(&opposite) - middle)
        };
        // Twice the change along an axis makes four times the difference.
        let squares = (0..changes.len()).map(|k| Some(even([k, k])? / 4.0)).collect::<Option<Vec<_>>>()?;
        let mut found = DMatrix::zeros(self.states(), self.states());
        for i in 0..changes.len() {
            for j in 0..=i {
                let mixed = if i == j { 2.0 * squares[i] } else { even([i, j])? - squares[i] - squares[j] };
                found[(i, j)] = mixed / (2.0 * changes[i] * changes[j]);
                found[(j, i)] = found[(i, j)];
            }
        }
        Some(found)
    }
}
