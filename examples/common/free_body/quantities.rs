//! What the figures show, computed in the same way from the samples of every method.

use nalgebra::Vector3;
use plotters::style::RGBColor;

use super::engines::Moments;
use crate::csv;
use crate::run::Record;

/// A state's invariants, and its rates.
#[derive(Clone, Copy)]
pub struct Quantities {
    /// s
    pub time: f64,
    /// J
    pub energy: f64,
    /// `RΠ`, kg m²/s
    pub spatial: Vector3<f64>,
    /// Body frame, rad/s
    pub rates: Vector3<f64>,
    /// The middle axis in space, `R e₂`
    pub axis: Vector3<f64>,
}

/// A method's run, ready to be drawn.
pub struct Series {
    pub name: &'static str,
    pub file: &'static str,
    pub colour: RGBColor,
    pub values: Vec<Quantities>,
    pub iterations: f64,
    pub nanoseconds: f64,
}

impl Series {
    pub fn new(name: &'static str, file: &'static str, colour: RGBColor, body: &Moments, record: &Record) -> Self {
        let quantities = record.samples.iter().map(|(time, sample)| {
            let rates = body.rates(&sample.momentum);
            let energy = 0.5 * rates.dot(&sample.momentum);
            let spatial = sample.attitude * sample.momentum;
            Quantities { time: *time, energy, spatial, rates, axis: sample.attitude.column(1).into() }
        });
        let (iterations, nanoseconds) = (record.iterations, record.nanoseconds);
        Self { name, file, colour, values: quantities.collect(), iterations, nanoseconds }
    }

    /// A quantity of each sample, and nothing where the energy has quadrupled: a run that blows up would press all
    /// others flat.
    pub fn bounded(&self, quantity: impl Fn(&Quantities) -> f64) -> Vec<(f64, f64)> {
        let most = 4.0 * self.values[0].energy;
        let shown = |q: &Quantities| if q.energy <= most { quantity(q) } else { f64::NAN };
        self.values.iter().map(|q| (q.time, shown(q))).collect()
    }

    /// `E/E(0)` of each sample.
    pub fn relative_energy(&self) -> Vec<(f64, f64)> {
        let start = self.values[0].energy;
        self.bounded(|q| q.energy / start)
    }

    /// `|E − E(0)|/E(0)` of each sample.
    pub fn energy_error(&self) -> impl Iterator<Item = (f64, f64)> {
        let start = self.values[0].energy;
        self.values.iter().map(move |q| (q.time, ((q.energy - start) / start).abs()))
    }

    /// `|RΠ − RΠ(0)|/|Π(0)|` of each sample.
    pub fn momentum_error(&self) -> impl Iterator<Item = (f64, f64)> {
        let start = self.values[0].spatial;
        self.values.iter().map(move |q| (q.time, (q.spatial - start).norm() / start.norm()))
    }

    /// When the rate about the middle axis changes sign, interpolated linearly: it is odd about that moment, so the
    /// error is of third order in the samples' distance.
    pub fn flips(&self) -> Vec<f64> {
        let crossing = |pair: &[Quantities]| {
            let (before, after) = (pair[0].rates.y, pair[1].rates.y);
            let share = before / (before - after);
            (before * after < 0.0).then(|| pair[0].time + share * (pair[1].time - pair[0].time))
        };
        self.values.windows(2).filter_map(crossing).collect()
    }

    /// As comma-separated values.
    pub fn csv(&self) -> String {
        let names = [
            "time_s",
            "energy_J",
            "spatial_momentum_x_kg_m2_per_s",
            "spatial_momentum_y_kg_m2_per_s",
            "spatial_momentum_z_kg_m2_per_s",
            "omega_x_rad_per_s",
            "omega_y_rad_per_s",
            "omega_z_rad_per_s",
        ];
        let row = |q: &Quantities| {
            let (p, o) = (q.spatial, q.rates);
            [q.time, q.energy, p.x, p.y, p.z, o.x, o.y, o.z]
        };
        csv::table(names, self.values.iter().map(row))
    }
}
