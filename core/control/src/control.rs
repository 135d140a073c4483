//! The task of optimal control: start, target, inputs, bounds and cost.

use liestep::gradients::Plant;
use liestep::groups::LieGroup;
use liestep::numbers::Coordinates as _;
use nalgebra::DVector;

use crate::verdict::Residual;

/// The target of a motion: an attitude, a momentum in the body's axes (kg m²/s), or both.
#[derive(Clone, Copy, Debug, Default)]
pub struct Target<G, V> {
    /// The attitude at the end; free if there is none.
    pub attitude: Option<G>,
    /// The momentum at the end; free if there is none.
    pub momentum: Option<V>,
}

impl<G: LieGroup> Target<G, G::Vector> {
    /// The target of this attitude, at rest.
    pub fn rest(attitude: impl Into<G>) -> Self {
        Self { attitude: Some(attitude.into()), momentum: Some(G::Vector::zero()) }
    }
}

/// The cost, `time · T + effort · ½∫|u|² dt`; the duration is free if it has a cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// The cost of a second.
    pub time: f64,
    /// The weight of half the integral of the squares, which is exact, as inputs are constant over a step.
    pub effort: f64,
}

/// A constrained value of the state after this number of steps.
pub(crate) type Value<'a, M> = dyn Fn(usize, &<M as Plant>::Motion) -> f64 + 'a;

/// An observer of iterations, which returns whether to go on.
type Watch<'a> = dyn Fn(usize, &Residual) -> bool + 'a;

#[doc = include_str!("control.md")]
pub struct Control<'a, M: Plant> {
    pub(crate) stepper: &'a M,
    pub(crate) start: M::State,
    pub(crate) steps: usize,
    pub(crate) target: Target<M::Attitude, M::Vector>,
    pub(crate) cost: Cost,
    pub(crate) like: M::Input,
    pub(crate) places: Vec<usize>,
    pub(crate) bounds: Box<dyn Fn(usize, usize) -> (f64, f64) + 'a>,
    pub(crate) guess: Box<dyn Fn(usize, usize) -> f64 + 'a>,
    pub(crate) kept: Vec<Box<Value<'a, M>>>,
    pub(crate) progress: Box<Watch<'a>>,
    pub(crate) tolerance: f64,
    pub(crate) most: usize,
}

impl<'a, M: Plant> Control<'a, M> {
    /// The task to reach the target from this state, in this number of steps, by the least effort, with a control force
    /// without bounds: on SO(3) a torque about each axis of the body, N m.
    #[must_use]
    pub fn new(stepper: &'a M, start: M::State, steps: usize, target: Target<M::Attitude, M::Vector>) -> Self {
        Self {
            stepper,
            start,
            steps,
            target,
            cost: Cost { time: 0.0, effort: 1.0 },
            like: stepper.force(),
            places: (0..stepper.dimension()).collect(),
            bounds: Box::new(|_, _| (f64::NEG_INFINITY, f64::INFINITY)),
            guess: Box::new(|_, _| 0.0),
            kept: Vec::new(),
            progress: Box::new(|_, _| true),
            tolerance: 1e-10,
            most: 200,
        }
    }

    /// Selects the inputs of each step: the scalars in these places of an input like this one, each once, in the order
    /// of [`Input::scalars`](liestep::gradients::Input::scalars); the others stay as they are.
    #[must_use]
    pub fn input(self, like: M::Input, places: impl IntoIterator<Item = usize>) -> Self {
        Self { like, places: places.into_iter().collect(), ..self }
    }

    /// Sets the least and the largest value of inputs, by the numbers of step and chosen scalar; equal ones fix the
    /// input.
    #[must_use]
    pub fn bounds(self, bounds: impl Fn(usize, usize) -> (f64, f64) + 'a) -> Self {
        Self { bounds: Box::new(bounds), ..self }
    }

    /// Adds a constraint: a value of the states that is at least zero, by the number of steps before them and the
    /// motion there. The start must satisfy it, the motion of the first guess needn't.
    ///
    /// Its derivatives are differences of fourth order, so it has to be smooth: the cosine of an angle rather than the
    /// angle.
    #[must_use]
    pub fn keep(mut self, value: impl Fn(usize, &M::Motion) -> f64 + 'a) -> Self {
        self.kept.push(Box::new(value));
        self
    }

    /// Sets the cost.
    #[must_use]
    pub fn minimise(self, cost: Cost) -> Self {
        Self { cost, ..self }
    }

    /// Sets the first guess, by the numbers of step and chosen scalar; its duration is that of the stepper's steps.
    #[must_use]
    pub fn guess(self, guess: impl Fn(usize, usize) -> f64 + 'a) -> Self {
        Self { guess: Box::new(guess), ..self }
    }

    /// Reports each iteration, by its number and residual; the search is cancelled if `false` is returned.
    #[must_use]
    pub fn progress(self, progress: impl Fn(usize, &Residual) -> bool + 'a) -> Self {
        Self { progress: Box::new(progress), ..self }
    }

    /// Sets the largest residual of a converged plan, and the most iterations; the defaults are `1e-10` and 200.
    #[must_use]
    pub fn until(self, tolerance: f64, most: usize) -> Self {
        Self { tolerance, most, ..self }
    }

    /// The first guess, moved inside the bounds, as a barrier needs room.
    pub(crate) fn first_inputs(&self) -> Vec<DVector<f64>> {
        let inside = |step, input| {
            let ((lower, upper), guess) = ((self.bounds)(step, input), (self.guess)(step, input));
            let room = 0.05 * (upper - lower).min(1.0 + guess.abs());
            if upper > lower { guess.max(lower + room).min(upper - room) } else { lower }
        };
        (0..self.steps).map(|step| DVector::from_fn(self.places.len(), |input, _| inside(step, input))).collect()
    }
}
