//! Bodies in lanes, each of which may stop independently.

use alloc::vec::Vec;

use crate::error::{SetupError, StepError};
use crate::motion::integrator::{Integrator, Moment};
use crate::numbers::{InLanes, Lanes};

/// A stepper that can take a [lane](crate::numbers::Real#lanes) of the scalar `W`: every one whose scene and method
/// [can](InLanes).
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

/// Several bodies that are stepped together in [lanes](crate::numbers::Real#lanes) of the scalar `W`. Each has the same
/// bits as alone, and its own end: a body whose step has no solution stops with its error and its last state, and the
/// others continue.
///
/// `M` is the stepper of a single body. All share a method, and may differ in parameters, step and start.
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
    /// A lane without a running body duplicates another body, so that no step of it fails alone.
    seats: Vec<Seat<M::State>>,
}

/// The status of the body in the lane of this number.
enum Seat<S> {
    Running,
    Stopped(S, StepError),
}

impl<W, M: Batchable<W>> Batch<W, M> {
    /// A batch of these bodies in these states.
    ///
    /// # Errors
    ///
    /// [`SetupError::Unlike`] names the first body that can't share lanes with those before it; without bodies it names
    /// lane 0.
    ///
    /// # Panics
    ///
    /// More bodies than lanes.
    pub fn new(bodies: &[(M, M::State)]) -> Result<Self, SetupError> {
        Self::joined(bodies).map_err(|lane| SetupError::Unlike { lane })
    }

    /// A batch of the longest leading part of these bodies that can share lanes, and its number of bodies. `None` if
    /// there are no bodies.
    ///
    /// # Panics
    ///
    /// More bodies than lanes.
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

    /// A batch of all bodies, or the number of the first one that differs from those before it.
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

    /// Steps every running body `steps` times, as its own [`run_stretches`](Integrator::run_stretches) would.
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

    /// Stops the body whose step is the first to fail, and fills its lane with another. Returns whether there was such
    /// a body, so that the others can be stepped together.
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

    /// Steps each body alone, and then collects those that haven't stopped into lanes again.
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
        // The first body was repeated in all lanes, its own included.
    }

    /// The states in all lanes; the lane of a body that has stopped contains another's.
    #[must_use]
    pub fn states(&self) -> &<M::Together as Integrator>::State {
        &self.state
    }

    /// All lanes at the end of their last step. The lane of a body that has stopped contains another's state.
    #[must_use]
    pub fn together(&self) -> Moment<'_, M::Together> {
        Moment::of_step(&self.stepper, &self.state)
    }

    /// The numbers of the bodies that haven't stopped.
    pub fn running(&self) -> impl Iterator<Item = usize> {
        self.seats.iter().enumerate().filter(|(_, seat)| matches!(seat, Seat::Running)).map(|(lane, _)| lane)
    }

    /// The state of a body; if it has stopped, the state before the step that failed.
    ///
    /// # Panics
    ///
    /// A number without a body.
    #[must_use]
    pub fn state(&self, body: usize) -> M::State {
        match &self.seats[body] {
            Seat::Running => self.state.lane(body),
            Seat::Stopped(state, _) => state.clone(),
        }
    }

    /// The error that stopped a body, if it has stopped.
    ///
    /// # Panics
    ///
    /// A number without a body.
    #[must_use]
    pub fn error(&self, body: usize) -> Option<&StepError> {
        match &self.seats[body] {
            Seat::Running => None,
            Seat::Stopped(_, error) => Some(error),
        }
    }
}
