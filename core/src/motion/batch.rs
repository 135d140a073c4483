//! Bodies in lanes, of which each may stop by itself.

use alloc::vec::Vec;

use crate::error::{SetupError, StepError};
use crate::motion::integrator::{Integrator, Moment};
use crate::numbers::{InLanes, Lanes};

/// A stepper that can be one of several in [lanes](crate::numbers::Real#lanes) of the scalar `W`: every one whose scene and
/// method [can](InLanes).
#[diagnostic::on_unimplemented(
    message = "bodies stepped by `{Self}` can't be in lanes of `{W}`",
    label = "can't be put into lanes",
    note = "a scene generic over its scalar can: `struct Top<T> {{ weight: T, … }}`, and `Top<f64>` here",
    note = "of methods the declared step can, compositions of it and splittings, with compensated sums too; others go one by one"
)]
pub trait Batchable<W>:
    Integrator + InLanes<W, Together: Integrator<State: Lanes<Lane = <Self as Integrator>::State>>>
{
}

impl<W, M> Batchable<W> for M where
    M: Integrator + InLanes<W, Together: Integrator<State: Lanes<Lane = <M as Integrator>::State>>>
{
}

/// Several bodies that are moved together in [lanes](crate::numbers::Real#lanes) of the scalar `W`, each with the bits that it
/// has alone and until its own end: one whose step has no solution stops there with its error and its state, and the
/// others go on.
///
/// `M` is the stepper of one of them. They share a method, and may differ in parameters, step and start.
///
/// # Examples
///
/// ```
/// use liestep::effects::{Gravity, PrincipalBody};
/// use liestep::mechanics::DiagonalNonstandardInertia;
/// use liestep::motion::Batch;
/// use liestep::{SO3, StepError, Stepper};
/// use nalgebra::Vector3;
/// use simba::simd::AutoF64x4;
///
/// let J_d = DiagonalNonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
/// let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
/// let bodies = [10.0, 12.0, 1e3].map(|spin| {
///     let stepper = Stepper::new(PrincipalBody { J_d } + gravity, 0.01).unwrap();
///     let state = stepper.start(SO3::exp(Vector3::x() * 0.5), Vector3::new(0.0, 0.0, spin)).unwrap();
///     (stepper, state)
/// });
/// let mut batch = Batch::<AutoF64x4, _>::new(&bodies)?;
/// batch.run(1000);
/// assert!(matches!(batch.error(2), Some(StepError::BeyondSolvable { .. })));
/// let [(stepper, mut alone), ..] = bodies;
/// stepper.run(&mut alone, 1000)?;
/// assert_eq!(batch.state(0), alone);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[repr(align(64))]
pub struct Batch<W, M: Batchable<W>> {
    stepper: M::Together,
    state: <M::Together as Integrator>::State,
    /// A lane whose body has stopped, or that never had one, follows another, body and all, so that nothing in it fails.
    seats: Vec<Seat<M::State>>,
}

/// What has become of the body in the lane of this number.
enum Seat<S> {
    Running,
    Stopped(S, StepError),
}

impl<W, M: Batchable<W>> Batch<W, M> {
    /// These bodies, from the states given.
    ///
    /// # Errors
    ///
    /// [`SetupError::Unlike`] names the first that can't be in a lane beside those before it; of no bodies at all that
    /// is the lane 0.
    ///
    /// # Panics
    ///
    /// Where there are more bodies than lanes.
    pub fn new(bodies: &[(M, M::State)]) -> Result<Self, SetupError> {
        Self::joined(bodies).map_err(|lane| SetupError::Unlike { lane })
    }

    /// As [`new`](Self::new), of as many of these bodies, from the first on, as can be beside each other; with their number.
    /// `None` where there are no bodies.
    ///
    /// # Panics
    ///
    /// Where there are more bodies than lanes.
    #[must_use]
    pub fn of_first(mut bodies: &[(M, M::State)]) -> Option<(Self, usize)> {
        while !bodies.is_empty() {
            match Self::joined(bodies) {
                Ok(batch) => return Some((batch, bodies.len())),
                Err(lane) => bodies = &bodies[..lane],
            }
        }
        None
    }

    /// All of them, or the number of the first that is unlike those before it.
    fn joined(bodies: &[(M, M::State)]) -> Result<Self, usize> {
        let ((stepper, state), others) = bodies.split_first().ok_or(0_usize)?;
        let mut batch = Self {
            stepper: Lanes::splat(stepper),
            state: Lanes::splat(state),
            seats: bodies.iter().map(|_| Seat::Running).collect(),
        };
        for (lane, (stepper, state)) in (1..).zip(others) {
            if !batch.set(lane, stepper, state) {
                return Err(lane);
            }
        }
        Ok(batch)
    }

    fn set(&mut self, lane: usize, stepper: &M, state: &M::State) -> bool {
        self.stepper.set_lane(lane, stepper) && self.state.set_lane(lane, state) && self.stepper.is_in_step(&self.state)
    }

    /// Makes `steps` steps of every body that hasn't stopped, as by [`run_stretches`](Integrator::run_stretches) of its own.
    pub fn run(&mut self, steps: u64) {
        if self.running().next().is_none() {
            return;
        }
        let mut before = self.state.clone();
        while self.stepper.attempt(&mut self.state, steps).is_err() {
            self.state = before;
            if !self.stop_one(steps) {
                return self.run_alone(steps);
            }
            if self.running().next().is_none() {
                return;
            }
            before = self.state.clone();
        }
    }

    /// Stops the body whose step fails first within these, and has another in its lane; whether there is such a one. The
    /// others can be moved together then.
    #[cold]
    fn stop_one(&mut self, steps: u64) -> bool {
        let mut state = self.state.clone();
        let fails = (0..steps).find_map(|_| {
            let before = state.clone();
            let fails = |lane: &usize| self.stepper.lane(*lane).attempt(&mut before.lane(*lane), 1).is_err();
            self.stepper.attempt(&mut state, 1).is_err().then(|| self.running().find(fails))
        });
        let Some(lane) = fails.flatten() else { return false };
        let mut alone = self.state.lane(lane);
        let Err(error) = self.stepper.lane(lane).run_stretches(&mut alone, steps, &mut |_, _| 0) else { return false };
        self.seats[lane] = Seat::Stopped(alone, error);
        let other = self.running().next();
        other.is_none_or(|other| self.set(lane, &self.stepper.lane(other), &self.state.lane(other)))
    }

    /// Each body alone, one after another; then those that have moved are together again.
    #[cold]
    fn run_alone(&mut self, steps: u64) {
        let running: Vec<usize> = self.running().collect();
        let mut moved: Vec<(usize, M, M::State)> = Vec::with_capacity(running.len());
        for lane in running {
            let (stepper, mut state) = (self.stepper.lane(lane), self.state.lane(lane));
            match stepper.run_stretches(&mut state, steps, &mut |_, _| 0) {
                Ok(_) => moved.push((lane, stepper, state)),
                Err(error) => self.seats[lane] = Seat::Stopped(state, error),
            }
        }
        let Some(((_, stepper, state), others)) = moved.split_first() else { return };
        (self.stepper, self.state) = (Lanes::splat(stepper), Lanes::splat(state));
        for (lane, stepper, state) in others {
            assert!(self.set(*lane, stepper, state), "what lanes share doesn't depend on where a body is");
        }
        // The first is in all lanes, so in its own, too.
    }

    /// The states in all lanes; the lane of a body that has stopped has another's.
    #[must_use]
    pub fn states(&self) -> &<M::Together as Integrator>::State {
        &self.state
    }

    /// All lanes at the end of their last step. The lane of a body that has stopped shows another.
    #[must_use]
    pub fn together(&self) -> Moment<'_, M::Together> {
        Moment::of_step(&self.stepper, &self.state)
    }

    /// The bodies that haven't stopped, by their numbers.
    pub fn running(&self) -> impl Iterator<Item = usize> {
        self.seats.iter().enumerate().filter(|(_, seat)| matches!(seat, Seat::Running)).map(|(lane, _)| lane)
    }

    /// The state of a body, if it has stopped that before the step that failed.
    ///
    /// # Panics
    ///
    /// Where there is no such body.
    #[must_use]
    pub fn state(&self, body: usize) -> M::State {
        match &self.seats[body] {
            Seat::Running => self.state.lane(body),
            Seat::Stopped(state, _) => state.clone(),
        }
    }

    /// Why a body has stopped, if it has.
    ///
    /// # Panics
    ///
    /// Where there is no such body.
    #[must_use]
    pub fn error(&self, body: usize) -> Option<&StepError> {
        match &self.seats[body] {
            Seat::Running => None,
            Seat::Stopped(_, error) => Some(error),
        }
    }
}
