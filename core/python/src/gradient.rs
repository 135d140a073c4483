//! Derivatives of a run by its start, its parameters and its signals.

use liestep::motion::{AnyStepper, Factor, FactorKind, Propagator as _};
use liestep::with::{Method, Scheme};
use liestep_late::{Derivatives, Direction, Reading, Row};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::failure::Failure;
use crate::scene::{Backend, Scene};
use crate::start::{Start, started};

/// Relative distance of a row's time from a whole number of steps up to which both are equal.
const ROUNDING: f64 = 1e-9;

/// A run whose derivatives are asked for.
#[derive(FromPyObject)]
pub(crate) struct Motion {
    start: Start,
    /// The times of the rows, s, in order.
    times: Vec<f64>,
}

/// Numbers beside the columns of a run, a row after the other: derivatives of a scalar by them. An empty list stands for zeros.
#[derive(FromPyObject)]
pub(crate) struct Covectors {
    velocity: Vec<f64>,
    momentum: Vec<f64>,
    /// Derivatives by the columns of the attitude, and these columns: a quaternion for a rotation.
    attitude: Vec<f64>,
    shown: Vec<f64>,
    /// Derivatives by the entries of the attitude's matrices.
    matrix: Vec<f64>,
    energy: Vec<f64>,
    spatial_momentum: Vec<f64>,
}

/// A row of numbers; none of an empty list.
fn row(list: &[f64], number: usize, width: usize) -> Vec<f64> {
    list.get(number * width..(number + 1) * width).unwrap_or_default().to_vec()
}

/// The rows of these times by steps of the length `h`.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked
fn rows(times: &[f64], h: f64) -> Result<Vec<Row>, Failure> {
    let row = |&time: &f64| {
        let steps = time / h;
        let can_be_counted = (-0.5..9e15).contains(&steps);
        if !can_be_counted {
            return Err(Failure::Of("SetupError", format!("steps of {h} s don't come to {time} s")));
        }
        let near = (steps - steps.round()).abs() <= ROUNDING * steps.max(1.0);
        let (whole, fraction) = if near { (steps.round(), 0.0) } else { (steps.floor(), steps - steps.floor()) };
        Ok(Row { steps: whole as u64, fraction })
    };
    times.iter().map(row).collect()
}

/// The derivatives by an attitude's entries, from those by its columns in a table.
fn by_entries(factors: &[Factor], columns: &[f64], shown: &[f64]) -> Vec<f64> {
    let (mut all, mut first) = (Vec::new(), 0);
    for kind in factors.iter().map(|factor| factor.kind) {
        let own = first..first + kind.columns();
        let (by, at) = (columns.get(own.clone()), shown.get(own.clone()));
        first = own.end;
        let (Some(by), Some(at)) = (by, at) else { continue };
        match kind {
            FactorKind::Rotation => {
                // `δq = q (0, ζ)/2`, and by the entries `R ẑ/2` for a covector `z` of turns.
                let [q, p] = [at, by].map(|list| Quaternion::new(list[0], list[1], list[2], list[3]));
                let turn: Vector3<f64> = (q.conjugate() * p).imag() * 0.5;
                let rotation: Matrix3<f64> = UnitQuaternion::new_normalize(q).to_rotation_matrix().into_inner();
                let entries = rotation * turn.cross_matrix() * 0.5;
                all.extend(entries.transpose().iter());
            }
            FactorKind::Translation(rows) => {
                let entry = |place: usize| {
                    let is_shift = place % rows == rows - 1 && place / rows < rows - 1;
                    if is_shift { by[place / rows] } else { 0.0 }
                };
                all.extend((0..rows * rows).map(entry));
            }
            FactorKind::Matrix(_) => all.extend(by),
        }
    }
    all
}

impl Covectors {
    /// The derivatives by the state of a row.
    fn of(&self, number: usize, factors: &[Factor]) -> Reading {
        let n: usize = factors.iter().map(|factor| factor.components.len()).sum();
        let columns: usize = factors.iter().map(|factor| factor.kind.columns()).sum();
        let entries: usize = factors.iter().map(|factor| factor.kind.rows() * factor.kind.rows()).sum();
        let [by, shown] = [&self.attitude, &self.shown].map(|list| row(list, number, columns));
        let mut attitude = if by.is_empty() { Vec::new() } else { by_entries(factors, &by, &shown) };
        let matrix = row(&self.matrix, number, entries);
        if attitude.is_empty() {
            attitude = matrix;
        } else {
            attitude.iter_mut().zip(&matrix).for_each(|(sum, slope)| *sum += slope);
        }
        Reading {
            velocity: row(&self.velocity, number, n),
            momentum: row(&self.momentum, number, n),
            attitude,
            energy: row(&self.energy, number, 1),
            spatial_momentum: row(&self.spatial_momentum, number, n),
        }
    }
}

/// The derivatives of a scene's motions by a method, and the state at a start.
struct Ready {
    derivatives: Derivatives<Backend>,
    factors: Vec<Factor>,
    state: Box<[f64]>,
    /// The velocity at the start, where that is given.
    velocity: Option<Vec<f64>>,
}

impl Scene {
    fn ready(&self, (method, h): (Method, f64), start: &Start) -> Result<Ready, Failure> {
        let is_own = matches!(method.scheme, Scheme::Step | Scheme::Composition(_)) && !method.varies();
        if !is_own || self.has_pace() {
            let message = "derivatives are known of the declared step and of a `composition` of it, without a pace or a \
                           density: make the run by `stepper(h)` or `stepper(h, composition=\"Suzuki 4\")`";
            return Err(Failure::Of("SetupError", message.to_owned()));
        }
        let method = Method { compensated: false, ..method };
        let whole = self.whole((method, h))?;
        let (any, derivatives) = if self.has_changes() {
            let driven = whole.driven(self.course()).map_err(|error| self.caused(Failure::setup(&error)))?;
            let derivatives = driven.derivatives()?;
            (AnyStepper::new(driven), derivatives)
        } else {
            let derivatives = whole.derivatives()?;
            (AnyStepper::new(whole), derivatives)
        };
        let state = started(&any, start)?.numbers().into();
        let factors = any.layout().factors.clone();
        let velocity = (!start.is_by_momentum).then(|| start.velocity.clone());
        Ok(Ready { derivatives, factors, state, velocity })
    }

    /// The gradient of a scalar by whose covectors a run's rows are given.
    pub(crate) fn gradient<'py>(
        &self,
        py: Python<'py>,
        method: (Method, f64),
        motion: &Motion,
        by: &Covectors,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (gradient, by_velocity, signals) = py.detach(|| {
            let ready = self.ready(method, &motion.start)?;
            let places = rows(&motion.times, method.1)?;
            let last = places.last().map_or(0, |row| row.steps + u64::from(row.fraction > 0.0));
            let rows: Vec<(Row, Reading)> =
                places.into_iter().enumerate().map(|(at, row)| (row, by.of(at, &ready.factors))).collect();
            let mut signals = self.slopes(last, method.1);
            let made = ready
                .derivatives
                .gradient(&ready.state, &rows, &mut |span, by_numbers| signals.add(span, by_numbers))
                .map_err(|error| self.caused(Failure::step(&error)));
            let mut gradient = made?;
            let by_velocity =
                ready.velocity.map(|velocity| ready.derivatives.at_velocity(&ready.state, &velocity, &mut gradient));
            Ok::<_, Failure>((gradient, by_velocity, signals))
        })?;
        let dictionary = PyDict::new(py);
        dictionary.set_item("attitude", gradient.displacement)?;
        dictionary.set_item("momentum", gradient.momentum)?;
        dictionary.set_item("velocity", by_velocity)?;
        dictionary.set_item("parameters", gradient.parameters)?;
        dictionary.set_item("signals", signals.into_lists())?;
        Ok(dictionary)
    }

    /// The changes of a run's rows along a change of its start and its parameters.
    pub(crate) fn along<'py>(
        &self,
        py: Python<'py>,
        method: (Method, f64),
        motion: &Motion,
        (turn, velocity, parameters): (Vec<f64>, Vec<f64>, Vec<f64>),
    ) -> PyResult<Bound<'py, PyDict>> {
        let made = py.detach(|| {
            let ready = self.ready(method, &motion.start)?;
            let rows = rows(&motion.times, method.1)?;
            let mut direction = Direction { displacement: turn, momentum: velocity.clone(), parameters };
            if let Some(own) = &ready.velocity {
                ready.derivatives.with_velocity(&ready.state, own, &velocity, &mut direction);
            }
            let made = ready.derivatives.along(&ready.state, &direction, &rows);
            made.map_err(|error| self.caused(Failure::step(&error)))
        })?;
        let dictionary = PyDict::new(py);
        let list = |of: fn(&Reading) -> &Vec<f64>| made.iter().flat_map(of).copied().collect::<Vec<f64>>();
        dictionary.set_item("velocity", list(|one| &one.velocity))?;
        dictionary.set_item("momentum", list(|one| &one.momentum))?;
        dictionary.set_item("matrix", list(|one| &one.attitude))?;
        dictionary.set_item("energy", list(|one| &one.energy))?;
        dictionary.set_item("spatial_momentum", list(|one| &one.spatial_momentum))?;
        Ok(dictionary)
    }

    /// The attitude `g exp ζ̂`.
    pub(crate) fn displaced(&self, attitude: &[f64], turn: &[f64]) -> Result<Vec<f64>, Failure> {
        Ok(self.whole((Method::default(), 1.0))?.derivatives()?.displaced(attitude, turn))
    }

    /// The derivatives of a displacement after `ζ` by `ζ`, column by column.
    pub(crate) fn turn_slopes(&self, turn: &[f64]) -> Result<Vec<f64>, Failure> {
        let found = self.whole((Method::default(), 1.0))?.derivatives()?.displacement_slopes(turn);
        found.ok_or_else(|| Failure::Of("SetupError", "this displacement has no derivatives".to_owned()))
    }

    /// The kinds of the group's factors, and the rows of their matrices.
    pub(crate) fn factors(&self) -> Result<Vec<(&'static str, usize)>, Failure> {
        let whole = self.whole((Method::default(), 1.0))?;
        let kind = |factor: &Factor| match factor.kind {
            FactorKind::Rotation => "rotation",
            FactorKind::Translation(_) => "translation",
            FactorKind::Matrix(_) => "matrix",
        };
        Ok(whole.layout().factors.iter().map(|factor| (kind(factor), factor.kind.rows())).collect())
    }

    /// The state transition matrix over so many steps, column by column, or the exponents, if it is orthonormalised every so many.
    pub(crate) fn transition(
        &self,
        method: (Method, f64),
        start: &Start,
        (steps, between): (u64, Option<u64>),
    ) -> Result<Vec<f64>, Failure> {
        let ready = self.ready(method, start)?;
        let made = match between {
            Some(between) => ready.derivatives.exponents(&ready.state, steps, between),
            None => ready.derivatives.transition(&ready.state, steps),
        };
        made.map_err(|error| self.caused(Failure::step(&error)))
    }
}
