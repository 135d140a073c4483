//! The requested accuracy, and the error of a run.

use alloc::vec::Vec;

use crate::groups::LieGroup;
use crate::numbers::{Coordinates as _, Entries};

roots!();

/// The requested error, and the time until which it holds.
///
/// The error at the horizon `T` is that of attitude and body velocity together,
///
/// ```text
/// error² = (|g − g*|/|g*|)² + (|Ω − Ω*|/s)²        s = max(|Ω*(T)|, |Ω(0)|, 1/T)
/// ```
///
/// with the exact `g*`, `Ω*`, and for matrices the Frobenius norm: on SO(3) the first part is `√(8/3) sin(θ/2)` for an
/// attitude wrong by the angle `θ`, about `0.8 θ`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// The largest error at the horizon, up to 0.05: a larger one would be another motion.
    pub tolerance: f64,
    /// The time `T` from the start, s.
    pub horizon: f64,
}

/// The end of a run.
#[derive(Clone, Copy, Debug)]
pub struct End<G: LieGroup> {
    /// The attitude, body to space.
    pub attitude: G,
    /// The body velocity, on SO(3) in rad/s.
    pub velocity: G::Vector,
}

/// The trial runs of a choice.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trials {
    /// Number of trial runs.
    pub runs: u64,
    /// Number of steps of the longest.
    pub most_steps: f64,
    /// The arithmetic of all, in operations on doubles.
    pub operations: f64,
}

/// The start of the runs in numbers, and their horizon.
#[derive(Clone, Debug)]
pub(super) struct Start {
    pub(super) attitude: Vec<f64>,
    pub(super) velocity: Vec<f64>,
    pub(super) horizon: f64,
    /// The units of the numbers of attitude and velocity; empty where all are one.
    units: [Vec<f64>; 2],
    /// A displacement by some roundings, in all directions, and the attitude displaced by it.
    aside: Vec<f64>,
    beside: Vec<f64>,
}

/// Distance of two starts that rounding doesn't distinguish: about the sum of the roundings in the first hundred stages
/// of a run.
const ROUNDINGS: f64 = 16.0 * f64::EPSILON;

/// The components of a displacement by some roundings.
pub(super) fn displacement(components: usize) -> Vec<f64> {
    // The last components are the largest, and signs alternate.
    let weight = |component: usize| (component + 1..components).fold(1.0, |weight: f64, _| weight * -0.8);
    (0..components).map(|component| weight(component) * ROUNDINGS).collect()
}

impl Start {
    pub(super) fn of_numbers(
        [attitude, beside]: [&[f64]; 2],
        velocity: &[f64],
        units: [&[f64]; 2],
        horizon: f64,
    ) -> Self {
        let (aside, units) = (displacement(velocity.len()), units.map(Vec::from));
        Self { attitude: attitude.into(), velocity: velocity.into(), horizon, units, aside, beside: beside.into() }
    }

    pub(super) fn new<G: LieGroup<Scalar = f64>>(attitude: &G, velocity: &G::Vector, horizon: f64) -> Self {
        let axes = (0..G::DIMENSION).map(G::Vector::axis);
        let aside = axes.fold(G::Vector::zero(), |sum, axis| sum * -0.8 + axis) * ROUNDINGS;
        let beside = attitude.compose(&G::from_increment(&G::hat(&aside)));
        let [attitude, beside] = [attitude, &beside].map(|attitude| numbers(&attitude.matrix()));
        let units = [Vec::new(), Vec::new()];
        Self { attitude, velocity: numbers(velocity), horizon, units, aside: numbers(&aside), beside }
    }

    /// This start with another horizon.
    pub(super) fn until(&self, horizon: f64) -> Self {
        Self { horizon, ..self.clone() }
    }

    /// A start that differs by some roundings, in all directions.
    pub(super) fn nearby(&self) -> Self {
        let scale = size(&counted(&self.velocity, &self.units[1])).max(self.horizon.recip());
        let mut velocity = self.velocity.clone();
        for (number, (part, aside)) in velocity.iter_mut().zip(&self.aside).enumerate() {
            *part += aside * scale * self.units[1].get(number).unwrap_or(&1.0);
        }
        Self { attitude: self.beside.clone(), velocity, ..self.clone() }
    }

    /// The end of a run with this attitude and velocity, in the units of this start.
    pub(super) fn end(&self, attitude: &[f64], velocity: &[f64]) -> EndNumbers {
        let [of_attitude, of_velocity] = &self.units;
        EndNumbers { attitude: counted(attitude, of_attitude), velocity: counted(velocity, of_velocity) }
    }

    /// The difference of two ends.
    pub(super) fn apart(&self, end: &EndNumbers, exact: &EndNumbers) -> f64 {
        end.error(exact, &counted(&self.velocity, &self.units[1]), self.horizon)
    }
}

/// Numbers in these units.
fn counted(numbers: &[f64], units: &[f64]) -> Vec<f64> {
    let unit = |at: usize| units.get(at).unwrap_or(&1.0);
    numbers.iter().enumerate().map(|(at, number)| number / unit(at)).collect()
}

/// The end of a run in numbers.
#[derive(Clone, Debug)]
pub(super) struct EndNumbers {
    pub(super) attitude: Vec<f64>,
    pub(super) velocity: Vec<f64>,
}

impl EndNumbers {
    /// The error of [`End::error`].
    pub(super) fn error(&self, exact: &Self, start: &[f64], time: f64) -> f64 {
        let apart = |a: &[f64], b: &[f64]| size(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>());
        let scale = size(start).max(size(&exact.velocity)).max(time.abs().recip());
        let attitudes = apart(&self.attitude, &exact.attitude) / size(&exact.attitude);
        attitudes.hypot(apart(&self.velocity, &exact.velocity) / scale)
    }

    pub(super) fn is_finite(&self) -> bool {
        (size(&self.attitude) + size(&self.velocity)).is_finite()
    }
}

impl<G: LieGroup<Scalar = f64>> End<G> {
    /// The error of this end, as [`Accuracy`] defines it: that of attitude and body velocity together, without a unit.
    ///
    /// `exact` is the exact end of the run. `start` is the body velocity `Ω(0)` at its start, on SO(3) in rad/s. `time`
    /// is the time of the run, s; its sign doesn't matter. The error isn't finite if one of the ends isn't.
    ///
    /// # Examples
    ///
    /// ```
    /// use liestep::SO3;
    /// use liestep::accuracy::End;
    /// use liestep::groups::LieGroup;
    /// use nalgebra::Vector3;
    ///
    /// let exact = End { attitude: SO3::identity(), velocity: Vector3::z() };
    /// let end = End { attitude: SO3::exp(Vector3::z() * 1e-3), ..exact };
    /// assert!((end.error(&exact, &Vector3::z(), 10.0) - 0.816e-3).abs() < 1e-6);
    /// ```
    #[must_use]
    pub fn error(&self, exact: &Self, start: &G::Vector, time: f64) -> f64 {
        self.numbers().error(&exact.numbers(), &numbers(start), time)
    }

    fn numbers(&self) -> EndNumbers {
        EndNumbers { attitude: numbers(&self.attitude.matrix()), velocity: numbers(&self.velocity) }
    }
}

/// The numbers of a vector or a matrix.
fn numbers<E: Entries<f64>>(entries: &E) -> Vec<f64> {
    let mut numbers = Vec::new();
    entries.each(&mut |entry| numbers.push(entry));
    numbers
}

fn size(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |squares, number| squares + number * number).sqrt()
}
