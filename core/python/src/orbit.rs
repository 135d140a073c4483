//! Orbits, and what changes along them.

use liestep::with::Kepler;
use nalgebra::Vector3;
use pyo3::prelude::*;

use crate::failure::Failure;

/// An orbit, by the keys of a scene's file.
#[pyclass(frozen, module = "liestep._native")]
pub(crate) struct Orbit(Kepler);

#[pymethods]
impl Orbit {
    #[new]
    fn new(text: &str) -> PyResult<Self> {
        Ok(Self(liestep_scene::orbit(text).map_err(Failure::from)?))
    }

    /// The period, s.
    #[getter]
    const fn period(&self) -> f64 {
        self.0.period()
    }

    /// The places at these times, one after the other, in semi-major axes.
    #[allow(clippy::needless_pass_by_value)] // as Python gives it
    fn places(&self, times: Vec<f64>) -> Vec<f64> {
        times.iter().flat_map(|&time| self.0.place(time).data.0[0]).collect()
    }

    /// The axes of the local vertical at a time, row by row.
    fn local_vertical(&self, time: f64) -> Vec<f64> {
        self.0.local_vertical(time).transpose().as_slice().to_vec()
    }
}

/// A quantity along an orbit.
#[derive(Clone, Copy)]
enum Quantity {
    /// The direction of the mass.
    Nadir,
    /// The distance from the mass, in semi-major axes.
    Distance,
    /// The angular velocity of the direction of the mass.
    Turning,
    /// The field of a dipole by its value above the equator.
    Field(Vector3<f64>),
}

/// A function of time along an orbit.
#[pyclass(frozen, module = "liestep._native")]
pub(crate) struct Along {
    orbit: Kepler,
    quantity: Quantity,
}

impl Along {
    /// Writes the value at a time, s.
    pub(crate) fn write(&self, time: f64, value: &mut [f64]) {
        let vector = match self.quantity {
            Quantity::Nadir => -self.orbit.place(time).normalize(),
            Quantity::Distance => Vector3::repeat(self.orbit.place(time).norm()),
            Quantity::Turning => self.orbit.turning(time),
            Quantity::Field(equator) => self.orbit.dipole_field(equator, time),
        };
        value.iter_mut().zip(vector.iter()).for_each(|(place, part)| *place = *part);
    }
}

#[pymethods]
impl Along {
    #[new]
    fn new(orbit: &Orbit, name: &str, equator: Option<[f64; 3]>) -> PyResult<Self> {
        let quantity = match (name, equator) {
            ("nadir", None) => Quantity::Nadir,
            ("distance", None) => Quantity::Distance,
            ("turning", None) => Quantity::Turning,
            ("field", Some(equator)) => Quantity::Field(equator.into()),
            _ => return Err(Failure::Of("SetupError", format!("no quantity along an orbit is called `{name}`")).into()),
        };
        Ok(Self { orbit: orbit.0, quantity })
    }

    /// The values at these times, one after the other.
    #[allow(clippy::needless_pass_by_value)] // as Python gives it
    fn at(&self, times: Vec<f64>) -> Vec<f64> {
        let width = if matches!(self.quantity, Quantity::Distance) { 1 } else { 3 };
        let mut values = vec![0.0; width * times.len()];
        for (time, value) in times.iter().zip(values.chunks_mut(width)) {
            self.write(*time, value);
        }
        values
    }
}
