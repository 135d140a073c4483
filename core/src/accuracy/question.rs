//! The requested accuracy, and the error of a run.

use alloc::rc::Rc;
use alloc::vec::Vec;

use super::measure::Measure;
use crate::groups::LieGroup;
use crate::numbers::{Coordinates as _, Entries};

/// The requested error, and the time until which it holds.
///
/// The error at the horizon `T` is the largest one among the parts of the motion, so that none is divided by the motion of another.
/// A rotation, or a group's matrix, is a part with its velocity `Ω` in the body frame,
///
/// ```text
/// error² = (|g − g*|/|g*|)² + (|Ω − Ω*|/s)²        s = max(|Ω*(T)|, |Ω(0)|, 1/T)
/// ```
///
/// with the exact `g*`, `Ω*`, and for matrices the Frobenius norm: on SO(3) the first summand is `√(8/3) sin(θ/2)` for an
/// attitude wrong by the angle `θ`, about `0.8 θ`. A place `x` with its velocity `v` is a part, also the translation of a rigid motion,
///
/// ```text
/// error² = (|x − x*|/l)² + (|v − v*|/s)²        l = max(L, |x*(t) − x(0)|, 10⁻⁶ |x*|)        s = max(|v*(t)|, L/T)
/// ```
///
/// with the length `L` of the system, 10⁻⁹ in the unit of the places where none is known, and the largest way and speed at the times
/// `t` of the start, of parts of `T` by eighths, and of the end. Several translations of one dimension, as in
/// systems of bodies, are also judged relative to their mean, with `x` and `v` less the means: a uniform motion of all takes no digits
/// from the motion within.
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
    measure: Rc<Measure>,
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
        measure: Measure,
        horizon: f64,
    ) -> Self {
        let (aside, measure) = (displacement(velocity.len()), Rc::new(measure));
        Self { attitude: attitude.into(), velocity: velocity.into(), horizon, measure, aside, beside: beside.into() }
    }

    pub(super) fn new<G: LieGroup<Scalar = f64>>(attitude: &G, velocity: &G::Vector, horizon: f64) -> Self {
        let axes = (0..G::DIMENSION).map(G::Vector::axis);
        let aside = axes.fold(G::Vector::zero(), |sum, axis| sum * -0.8 + axis) * ROUNDINGS;
        let beside = attitude.compose(&G::from_increment(&G::hat(&aside)));
        let [attitude, beside] = [attitude, &beside].map(|attitude| numbers(&attitude.matrix()));
        let measure = Rc::new(Measure::new(&G::factors(), None));
        Self { attitude, velocity: numbers(velocity), horizon, measure, aside: numbers(&aside), beside }
    }

    /// This start with another horizon.
    pub(super) fn until(&self, horizon: f64) -> Self {
        Self { horizon, ..self.clone() }
    }

    /// A start that differs by some roundings, in all directions.
    pub(super) fn nearby(&self) -> Self {
        let speeds = self.measure.speeds(&self.velocity, self.horizon);
        let parts = self.velocity.iter().zip(&self.aside).zip(&speeds);
        let velocity = parts.map(|((part, aside), speed)| part + aside * speed).collect();
        Self { attitude: self.measure.displaced(&self.attitude, &self.beside), velocity, ..self.clone() }
    }

    /// Takes up a state of the motion, see [`Measure::see`].
    pub(super) fn see(&mut self, state: &EndNumbers) {
        Rc::make_mut(&mut self.measure).see([&self.attitude, &self.velocity], state.state());
    }

    /// The difference of two ends.
    pub(super) fn apart(&self, end: &EndNumbers, exact: &EndNumbers) -> f64 {
        self.measure.error(end.state(), exact.state(), [&self.attitude, &self.velocity], self.horizon)
    }
}

/// The end of a run in numbers.
#[derive(Clone, Debug)]
pub(super) struct EndNumbers {
    pub(super) attitude: Vec<f64>,
    pub(super) velocity: Vec<f64>,
}

impl EndNumbers {
    fn state(&self) -> [&[f64]; 2] {
        [&self.attitude, &self.velocity]
    }

    pub(super) fn is_finite(&self) -> bool {
        let squares = self.attitude.iter().chain(&self.velocity).map(|number| number * number);
        squares.sum::<f64>().is_finite()
    }
}

impl<G: LieGroup<Scalar = f64>> End<G> {
    /// The error of this end, as [`Accuracy`] defines it by the start and the end: the largest one of its parts, without a unit.
    ///
    /// `exact` is the exact end of the run, and `start` its start, with the body velocity, on SO(3) in rad/s. `time` is the time of the
    /// run, s; its sign doesn't matter. The error isn't finite if one of the ends isn't.
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
    /// assert!((end.error(&exact, &exact, 10.0) - 0.816e-3).abs() < 1e-6);
    /// ```
    #[must_use]
    pub fn error(&self, exact: &Self, start: &Self, time: f64) -> f64 {
        let [end, exact, start] = [self, exact, start].map(Self::numbers);
        Measure::new(&G::factors(), None).error(end.state(), exact.state(), start.state(), time)
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
