//! The quantities in the figures, computed in the same way from the samples of every method.

use nalgebra::{Matrix3, Vector3};
use plotters::style::RGBColor;

use super::rk4::Body;
use crate::run::{Record, Sample};

/// The invariants of a state, and the other quantities of the figures.
#[derive(Clone, Copy)]
pub struct Quantities {
    /// The time, s.
    pub time: f64,
    /// The distance from the rotations, `‖RᵀR − I‖` in the Frobenius norm.
    pub defect: f64,
    /// The momentum about the vertical, `e₃·RΠ`, kg m²/s.
    pub vertical: f64,
    /// The energy, J.
    pub energy: f64,
    /// The body velocity in the body frame, rad/s.
    pub rates: Vector3<f64>,
    /// The tip `R e₃`, whose length depends on the method's `R`.
    pub tip: Vector3<f64>,
}

/// A method's run for the figures.
pub struct Series {
    pub name: &'static str,
    pub file: &'static str,
    pub colour: RGBColor,
    pub values: Vec<Quantities>,
    pub iterations: f64,
    pub nanoseconds: f64,
}

impl Quantities {
    fn of(body: &Body, time: f64, Sample { attitude, momentum }: &Sample) -> Self {
        let rates = body.inverse_moments.component_mul(momentum);
        Self {
            time,
            defect: (attitude.transpose() * attitude - Matrix3::identity()).norm(),
            vertical: (attitude * momentum).z,
            energy: 0.5 * momentum.dot(&rates) + (attitude * body.lever).z,
            rates,
            tip: attitude.column(2).into(),
        }
    }
}

impl Series {
    pub fn new(name: &'static str, file: &'static str, colour: RGBColor, body: &Body, record: &Record) -> Self {
        let values = record.samples.iter().map(|(time, sample)| Quantities::of(body, *time, sample)).collect();
        Self { name, file, colour, values, iterations: record.iterations, nanoseconds: record.nanoseconds }
    }

    /// The quantities at the start.
    pub fn first(&self) -> Quantities {
        self.values[0]
    }

    /// The quantities between two times.
    pub fn between(&self, start: f64, end: f64) -> &[Quantities] {
        let from = self.values.partition_point(|q| q.time < start);
        let to = self.values.partition_point(|q| q.time <= end);
        &self.values[from..to]
    }

    /// The largest value of a quantity; NaN if it is NaN anywhere, which `f64::max` would ignore.
    pub fn largest(&self, quantity: impl Fn(&Quantities) -> f64) -> f64 {
        self.values.iter().map(quantity).fold(0.0, |most: f64, x| if most.is_nan() || x <= most { most } else { x })
    }

    /// The largest value of a quantity in the last tenth of the run, relative to that in the first: about 1 for an
    /// oscillation, 10 for a linear growth.
    pub fn growth(&self, quantity: impl Fn(&Quantities) -> f64) -> f64 {
        let end = self.values.last().map_or(0.0, |q| q.time);
        let largest = |values: &[Quantities]| values.iter().map(&quantity).fold(0.0, f64::max);
        largest(self.between(0.9 * end, end)) / largest(self.between(0.0, 0.1 * end))
    }

    /// The series as comma-separated values: a line of names, then numbers to their last digit.
    pub fn csv(&self) -> String {
        let names = [
            "time_s",
            "orthogonality_defect",
            "vertical_momentum_kg_m2_per_s",
            "energy_J",
            "omega_x_rad_per_s",
            "omega_y_rad_per_s",
            "omega_z_rad_per_s",
            "tip_x",
            "tip_y",
            "tip_z",
        ];
        let row = |q: &Quantities| {
            let (o, p) = (q.rates, q.tip);
            let numbers = [q.time, q.defect, q.vertical, q.energy, o.x, o.y, o.z, p.x, p.y, p.z];
            "\n".to_owned() + &numbers.map(|number| format!("{number:e}")).join(",")
        };
        names.join(",") + &self.values.iter().map(row).collect::<String>() + "\n"
    }
}
