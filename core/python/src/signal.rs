//! Parameters of terms that change with time: by values at times, or by a function of Python.

use std::sync::{Arc, Mutex, PoisonError};

use liestep_late::{Between, Course};
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::orbit::Along;

/// A signal by values at times, as `liestep.signal` has it.
#[pyclass(frozen, module = "liestep._native")]
pub(crate) struct Signal(liestep_late::Signal);

#[pymethods]
impl Signal {
    #[new]
    fn new(times: Vec<f64>, values: Vec<f64>, are_lines: bool) -> PyResult<Self> {
        let between = if are_lines { Between::Lines } else { Between::Steps };
        let signal = liestep_late::Signal::new(times, values, between);
        Ok(Self(signal.map_err(|error| Failure::setup(&error))?))
    }

    /// The first time with a value, and the last one, s.
    #[getter]
    fn ends(&self) -> [f64; 2] {
        self.0.ends()
    }

    /// The values at these times, one after the other; NaN where there are none.
    #[allow(clippy::needless_pass_by_value)] // as Python gives it
    fn at(&self, times: Vec<f64>) -> Vec<f64> {
        let mut values = vec![0.0; self.0.width() * times.len()];
        for (time, value) in times.iter().zip(values.chunks_mut(self.0.width())) {
            self.0.at(*time, value);
        }
        values
    }
}

/// A parameter that changes with time, as Python describes it.
#[derive(FromPyObject)]
pub(crate) struct Change {
    name: String,
    /// The place of its first number among those of all terms, and how many it has.
    first: usize,
    width: usize,
    /// Whether its values are of length one.
    is_direction: bool,
    source: Source,
}

/// The source of its values.
#[derive(FromPyObject)]
enum Source {
    Signal(Py<Signal>),
    Along(Py<Along>),
    /// The function of a list of times that returns the numbers of all values.
    Function(Py<PyAny>),
}

fn length(vector: &[f64]) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// All parameters of a scene that change with time.
pub(crate) struct Changes {
    all: Vec<Change>,
    /// The first cause, since it was last asked for, why there was no value.
    cause: Mutex<Option<Failure>>,
}

impl Changes {
    pub(crate) fn of(changes: Vec<Change>) -> Self {
        Self { all: changes, cause: Mutex::default() }
    }

    pub(crate) const fn are_none(&self) -> bool {
        self.all.is_empty()
    }

    /// The cause why there was no value, since it was last asked for.
    pub(crate) fn cause(&self) -> Option<Failure> {
        self.cause.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn because(&self, cause: impl FnOnce() -> Failure) {
        self.cause.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(cause);
    }

    /// Writes all values, those of signals by this function.
    fn write(&self, numbers: &mut [f64], time: f64, value: impl Fn(&liestep_late::Signal, &mut [f64])) {
        for change in &self.all {
            let Some(own) = numbers.get_mut(change.first..change.first + change.width) else { continue };
            match &change.source {
                Source::Signal(signal) => value(&signal.get().0, own),
                Source::Along(along) => along.get().write(time, own),
                Source::Function(function) => self.call(change, function, time, own),
            }
            if change.is_direction {
                let length = length(own);
                for part in own.iter_mut() {
                    *part /= length;
                }
            }
            if !own.iter().all(|number| number.is_finite()) {
                self.because(|| {
                    let has = match &change.source {
                        Source::Signal(signal) => match signal.get().0.ends() {
                            [first, f64::INFINITY] => format!(": its signal has values from {first} s on"),
                            [first, last] => format!(": its signal has values from {first} to {last} s"),
                        },
                        _ => String::new(),
                    };
                    Failure::Of("StepError", format!("`{}` has no value about {time} s{has}", change.name))
                });
            }
        }
    }

    fn call(&self, change: &Change, function: &Py<PyAny>, time: f64, value: &mut [f64]) {
        let made = Python::attach(|py| function.call1(py, (vec![time],))?.extract::<Vec<f64>>(py));
        match made {
            Ok(numbers) if numbers.len() == change.width => {
                value.copy_from_slice(&numbers);
                let length = length(value);
                if change.is_direction && (length - 1.0).abs() > liestep_scene::OFF_UNIT {
                    let name = &change.name;
                    let message =
                        format!("`{name}` is a direction, and isn't of length one but of {length} at {time} s");
                    self.because(|| Failure::Of("SetupError", message));
                    value.fill(f64::NAN);
                }
            }
            Ok(_) => value.fill(f64::NAN),
            Err(error) => {
                self.because(|| Failure::Raised(error));
                value.fill(f64::NAN);
            }
        }
    }
}

/// The numbers of a scene's terms as functions of time.
pub(crate) struct SceneCourse(pub(crate) Arc<Changes>);

impl Course for SceneCourse {
    fn at(&self, time: f64, numbers: &mut [f64]) {
        self.0.write(numbers, time, |signal, value| signal.at(time, value));
    }

    fn over(&self, [start, length]: [f64; 2], numbers: &mut [f64]) {
        self.0.write(numbers, start + length * 0.5, |signal, value| signal.mean([start, length], value));
    }
}

/// Derivatives of a scalar by the parameters of a scene that change with time: by a signal's values, or for each step by the value
/// over it.
pub(crate) struct SignalSlopes {
    changes: Arc<Changes>,
    lists: Vec<Vec<f64>>,
    h: f64,
}

impl SignalSlopes {
    fn count(change: &Change, steps: u64) -> usize {
        match &change.source {
            Source::Signal(signal) => signal.get().0.values().len(),
            _ => change.width * usize::try_from(steps).unwrap_or(0),
        }
    }

    pub(crate) fn none(changes: Arc<Changes>, steps: u64, h: f64) -> Self {
        let lists = changes.all.iter().map(|change| vec![0.0; Self::count(change, steps)]).collect();
        Self { changes, lists, h }
    }

    /// Adds the derivatives by all numbers over a span of time, its start and length in s.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a negative one becomes zero
    pub(crate) fn add(&mut self, span: [f64; 2], by_numbers: &[f64]) {
        for (change, list) in self.changes.all.iter().zip(&mut self.lists) {
            let own = by_numbers.get(change.first..change.first + change.width).unwrap_or_default();
            match &change.source {
                Source::Signal(signal) if change.is_direction => {
                    let signal = &signal.get().0;
                    let mut value = vec![0.0; change.width];
                    if span[1] == 0.0 {
                        signal.at(span[0], &mut value);
                    } else {
                        signal.mean(span, &mut value);
                    }
                    // A direction is divided by its length.
                    let size = length(&value);
                    let along: f64 = own.iter().zip(&value).map(|(slope, part)| slope * part / size).sum();
                    let part = |(slope, part): (&f64, &f64)| (slope - along * part / size) / size;
                    let across: Vec<f64> = own.iter().zip(&value).map(part).collect();
                    signal.slopes(span, &across, list);
                }
                Source::Signal(signal) => signal.get().0.slopes(span, own, list),
                _ => {
                    let last = (list.len() / change.width.max(1)).saturating_sub(1);
                    let step = ((span[0] / self.h + 1e-9).floor() as usize).min(last);
                    let places = list.iter_mut().skip(step * change.width);
                    places.zip(own).for_each(|(sum, slope)| *sum += slope);
                }
            }
        }
    }

    pub(crate) fn into_lists(self) -> Vec<Vec<f64>> {
        self.lists
    }
}
