//! Plans of a motion on SO(3), by `liestep-control`.

use std::cell::RefCell;

use liestep::gradients::Input;
use liestep::groups::LieGroup as _;
use liestep::mechanics::WithKinetic;
use liestep::motion::OwnStep;
use liestep::recording::{Column, Sink as _};
use liestep::{SO3, Stepper};
use liestep_control::{Control, ControlError, ControlPlan, Cost, Residual, Target, Verdict};
use liestep_late::{Declaration, LateError};
use nalgebra::{Matrix3, Vector3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::ensemble::columns;
use crate::failure::Failure;
use crate::run::listed;
use crate::scene::{Four, Late};
use crate::start::Start;
use crate::table::Columns;

/// The type of all scenes on SO(3), whatever their terms.
type Scene = Late<SO3, Four, WithKinetic>;

/// The task of a plan: start, goal, inputs, bounds and cost.
#[derive(FromPyObject)]
pub(crate) struct Task {
    step: f64,
    steps: usize,
    start: Start,
    /// The goal; attitude or velocity may be free.
    goal: Start,
    /// The axes of the body with a torque.
    axes: Vec<usize>,
    /// The least, the largest and the first torque about each axis in each step, N m.
    torques: Vec<[f64; 3]>,
    /// An axis of the body, a direction of space, and the cosine of the angle between both, which isn't exceeded.
    cones: Vec<([f64; 3], [f64; 3], f64)>,
    is_shortest: bool,
    tolerance: f64,
    most: usize,
    /// The function that is called with the number of iterations and the residual; `False` ends the search.
    progress: Option<Py<PyAny>>,
}

/// The plan, and the exception raised during its search.
type PlanResult = (ControlPlan<Scene, OwnStep<Scene>>, Option<PyErr>);

impl Task {
    fn solve(&self, terms: &[&'static Declaration], numbers: &[f64]) -> Result<PlanResult, Failure> {
        // A sum with more than four vectors advects the directions of space instead.
        let scene = match Scene::of(Declaration::sum(terms)?) {
            Err(LateError::Advected { .. }) => Scene::of(Declaration::sum_in_frames(terms)?)?,
            other => other?,
        };
        let scene = scene.with_all(numbers)?.differentiable()?;
        let stepper = Stepper::new(scene, self.step).map_err(|error| Failure::setup(&error))?;
        let factors = SO3::<f64>::factors();
        let attitude = |place: &Start| {
            place.attitude(&factors).map(|entries| SO3::from_matrix_unchecked(Matrix3::from_row_slice(&entries)))
        };
        let at = |place: &Start| {
            let velocity = Vector3::from_column_slice(place.velocity(&factors)?);
            stepper.start(attitude(place)?, velocity).map_err(|error| Failure::setup(&error))
        };
        let (goes_anywhere, ends_anyhow) = (self.goal.attitude.is_empty(), self.goal.velocity.is_empty());
        let target = Target {
            attitude: if goes_anywhere { None } else { Some(attitude(&self.goal)?) },
            momentum: if ends_anyhow { None } else { Some(at(&self.goal)?.momentum()) },
        };
        let raised = RefCell::new(None);
        let goes_on = |iteration: usize, residual: &Residual| {
            let asked = Python::attach(|py| {
                py.check_signals()?;
                let Some(progress) = &self.progress else { return Ok(true) };
                Ok(progress.call1(py, (iteration, residual.largest()))?.extract::<Option<bool>>(py)?.unwrap_or(true))
            });
            asked.unwrap_or_else(|error: PyErr| {
                raised.replace(Some(error));
                false
            })
        };
        let torque = |step: usize, axis: usize| {
            self.torques.get(step * self.axes.len() + axis).copied().unwrap_or([f64::NAN; 3])
        };
        let (time, effort) = if self.is_shortest { (1.0, 0.0) } else { (0.0, 1.0) };
        let control = Control::new(&stepper, at(&self.start)?, self.steps, target)
            .input(Input::Force(Vector3::zeros()), self.axes.iter().copied())
            .bounds(|step, axis| (torque(step, axis)[0], torque(step, axis)[1]))
            .guess(|step, axis| torque(step, axis)[2])
            .minimise(Cost { time, effort })
            .until(self.tolerance, self.most)
            .progress(goes_on);
        let control = self.cones.iter().fold(control, |control, &(axis, direction, cosine)| {
            let [axis, direction] = [axis, direction].map(Vector3::from);
            control.keep(move |_, motion| cosine - direction.dot(&(motion.attitude().as_matrix() * axis)))
        });
        let plan = control.solve().map_err(|error| match error {
            ControlError::Step(..) => Failure::step(&error),
            _ => Failure::setup(&error),
        })?;
        drop(control);
        Ok((plan, raised.into_inner()))
    }
}

/// A plan of the sum of these terms, which were declared with `gradients`, as Python sees it.
pub(crate) fn plan<'py>(
    py: Python<'py>,
    terms: &[&'static Declaration],
    numbers: &[f64],
    task: &Task,
) -> PyResult<Bound<'py, PyDict>> {
    let (plan, raised) = py.detach(|| task.solve(terms, numbers))?;
    let dictionary = PyDict::new(py);
    let table = |columns: Vec<Column>, rows: Vec<f64>| {
        let mut table = Columns::new(rows.len() / columns.len());
        let written = table.begin(&columns).and_then(|()| table.write(&rows));
        written.map_err(|error| Failure::Of("MemoryError", error.to_string()))?;
        Py::new(py, table.into_table())
    };
    let (mut states, mut attitude) = (Vec::new(), [0.0; 4]);
    for state in &plan.states {
        state.attitude().write_numbers(&mut attitude);
        states.push(plan.stepper.time(state));
        states.extend(attitude);
        states.extend(listed(&plan.stepper.velocity(state)).into_iter().chain(listed(&state.momentum())));
        states.push(plan.stepper.energy(state));
    }
    dictionary.set_item("table", table(columns(&SO3::<f64>::factors()), states)?)?;
    let torques = ["x", "y", "z"].map(|axis| Column { name: format!("torque_{axis}"), unit: "N m".to_owned() });
    dictionary.set_item("inputs", table(torques.into(), plan.inputs.iter().flat_map(Input::scalars).collect())?)?;
    let (verdict, why, certificate) = match plan.verdict {
        Verdict::Converged => ("converged", None, None),
        Verdict::Infeasible { direction, gap } => ("infeasible", None, Some((direction, gap))),
        Verdict::Exhausted => ("exhausted", None, None),
        Verdict::Cancelled => ("cancelled", None, None),
        Verdict::Stalled(way) => ("stalled", way.map(|(step, error)| format!("step {step}: {error}")), None),
        other => ("other", Some(format!("{other:?}")), None),
    };
    dictionary.set_item("verdict", verdict)?;
    dictionary.set_item("why", why)?;
    dictionary.set_item("certificate", certificate)?;
    dictionary.set_item("step", plan.stepper.step_size())?;
    dictionary.set_item("duration", plan.duration)?;
    dictionary.set_item("cost", plan.cost)?;
    dictionary.set_item("residual", plan.residual.largest())?;
    dictionary.set_item("multipliers", plan.multipliers)?;
    dictionary.set_item("steps", plan.inputs.len())?;
    dictionary.set_item("iterations", plan.iterations)?;
    dictionary.set_item("failure", raised)?;
    Ok(dictionary)
}
