//! Plans of a motion on any group, by `liestep-control`.

use std::cell::RefCell;

use liestep::gradients::Plant as _;
use liestep::motion::{AnyStepper, FactorKind, Integrator as _, Propagator as _};
use liestep::recording::{Column, Sink as _};
use liestep::with::Method;
use liestep_control::{Control, ControlError, ControlPlan, Cost, Residual, Target, Verdict};
use liestep_late::{Declaration, Whole};
use nalgebra::{Matrix3, Vector3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::ensemble::columns;
use crate::failure::Failure;
use crate::scene::Backend;
use crate::start::Start;
use crate::table::Columns;

/// The task of a plan: start, goal, inputs, bounds and cost.
#[derive(FromPyObject)]
pub(crate) struct Task {
    step: f64,
    steps: usize,
    start: Start,
    /// The goal; the attitude is free if it is empty.
    goal: Start,
    /// Whether the velocity at the end is free.
    ends_anyhow: bool,
    /// The components of the velocity along which a force acts; or the places of the parameters' numbers that are the inputs.
    axes: Vec<usize>,
    /// The names of the inputs, if they are parameters.
    inputs: Vec<String>,
    /// The least, the largest and the first force along each of them in each step, on SO(3) N m.
    forces: Vec<[f64; 3]>,
    /// An axis of the body, a direction of space, and the cosine of the angle between both, which isn't exceeded.
    cones: Vec<([f64; 3], [f64; 3], f64)>,
    is_shortest: bool,
    tolerance: f64,
    most: usize,
    /// The function that is called with the number of iterations and the residual; `False` ends the search.
    progress: Option<Py<PyAny>>,
}

/// A plan with the stepper of its duration.
pub(crate) struct Planned {
    stepper: Whole<Backend>,
    states: Vec<Box<[f64]>>,
    inputs: Vec<Vec<f64>>,
    figures: Figures,
}

/// The figures of a plan besides its motion.
struct Figures {
    duration: f64,
    cost: f64,
    residual: f64,
    multipliers: Vec<f64>,
    iterations: usize,
    verdict: Verdict,
}

impl Planned {
    fn of(plan: ControlPlan<Whole<Backend>>) -> Self {
        let ControlPlan { stepper, states, inputs, duration, cost, multipliers, residual, iterations, verdict, .. } =
            plan;
        let residual = residual.largest();
        Self {
            stepper,
            states,
            inputs,
            figures: Figures { duration, cost, residual, multipliers, iterations, verdict },
        }
    }
}

/// The plan, and the exception raised during its search.
type PlanResult = (Planned, Option<PyErr>);

impl Task {
    fn solve(&self, terms: &[&'static Declaration], numbers: &[f64]) -> Result<PlanResult, Failure> {
        let stepper = Whole::<Backend>::of(Declaration::sum(terms)?, numbers, self.step, Method::default())?;
        if self.inputs.is_empty() {
            return self.solve_with(&stepper, self.axes.clone());
        }
        let steered = stepper.steered(self.axes.clone()).map_err(|error| Failure::setup(&error))?;
        self.solve_with(&steered, (0..self.axes.len()).collect())
    }

    fn solve_with(&self, stepper: &Whole<Backend>, places: Vec<usize>) -> Result<PlanResult, Failure> {
        let factors = &stepper.layout().factors;
        let at = |place: &Start| {
            let rest = vec![0.0; stepper.dimension()];
            let velocity = if place.velocity.is_empty() { &rest } else { place.velocity(factors)? };
            stepper.start(&place.attitude(factors)?, velocity).map_err(|error| Failure::setup(&error))
        };
        let end = at(&self.goal)?;
        let target = Target {
            attitude: (!self.goal.attitude.is_empty()).then(|| stepper.attitude(&end)),
            momentum: (!self.ends_anyhow).then(|| stepper.momentum(&end)),
        };
        let is_about_a_body = factors.first().is_some_and(|factor| factor.kind == FactorKind::Rotation);
        if !self.cones.is_empty() && !is_about_a_body {
            let message = "an axis that is kept out of a cone is one of a body: the first factor of the group is SO3";
            return Err(Failure::Of("SetupError", message.to_owned()));
        }
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
        let force =
            |step: usize, axis: usize| self.forces.get(step * self.axes.len() + axis).copied().unwrap_or([f64::NAN; 3]);
        let (time, effort) = if self.is_shortest { (1.0, 0.0) } else { (0.0, 1.0) };
        let control = Control::new(stepper, at(&self.start)?, self.steps, target)
            .input(stepper.force(), places)
            .bounds(|step, axis| (force(step, axis)[0], force(step, axis)[1]))
            .guess(|step, axis| force(step, axis)[2])
            .minimise(Cost { time, effort })
            .until(self.tolerance, self.most)
            .progress(goes_on);
        let control = self.cones.iter().fold(control, |control, &(axis, direction, cosine)| {
            let [axis, direction] = [axis, direction].map(Vector3::from);
            control.keep(move |_, state| cosine - direction.dot(&(Matrix3::from_row_slice(&state[..9]) * axis)))
        });
        let plan = control.solve().map_err(|error| match error {
            ControlError::Step(..) => Failure::step(&error),
            _ => Failure::setup(&error),
        })?;
        drop(control);
        Ok((Planned::of(plan), raised.into_inner()))
    }
}

/// A plan of the sum of these terms, as Python sees it.
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
    let Planned { stepper, states: motion, inputs, figures } = plan;
    let any = AnyStepper::new(stepper);
    let (factors, columns) = (&any.layout().factors, columns(&any.layout().factors));
    let of_attitude = factors.iter().map(|factor| factor.kind.columns()).sum();
    let (mut states, mut attitude, mut row) = (Vec::new(), vec![0.0; of_attitude], vec![0.0; columns.len()]);
    for state in motion.iter().filter_map(|state| any.state_of(state)) {
        states.push(any.time(&state));
        any.write(&state, &(), &mut attitude, &mut row);
        states.extend(&row[..columns.len() - 1]);
    }
    dictionary.set_item("table", table(columns, states)?)?;
    let names = factors.iter().flat_map(|factor| &factor.components);
    let of_parameters = task.inputs.iter().map(|name| Column { name: name.clone(), unit: String::new() });
    let forces = names.map(|(name, [velocity, _])| match *velocity {
        "rad/s" => Column { name: format!("torque_{name}"), unit: "N m".to_owned() },
        "m/s" => Column { name: format!("force_{name}"), unit: "N".to_owned() },
        _ => Column { name: format!("force_{name}"), unit: String::new() },
    });
    let of_inputs: Vec<Column> = if task.inputs.is_empty() { forces.collect() } else { of_parameters.collect() };
    let steps = inputs.len();
    dictionary.set_item("inputs", table(of_inputs, inputs.concat())?)?;
    let (verdict, why, certificate) = match figures.verdict {
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
    dictionary.set_item("step", any.step_size())?;
    dictionary.set_item("duration", figures.duration)?;
    dictionary.set_item("cost", figures.cost)?;
    dictionary.set_item("residual", figures.residual)?;
    dictionary.set_item("multipliers", figures.multipliers)?;
    dictionary.set_item("steps", steps)?;
    dictionary.set_item("iterations", figures.iterations)?;
    dictionary.set_item("failure", raised)?;
    Ok(dictionary)
}
