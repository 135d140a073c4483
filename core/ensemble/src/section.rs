//! Columns at the crossings of a surface: Poincaré sections.

use core::any::Any;
use core::fmt;

use liestep::motion::{Batchable, Integrator, Moment};
use liestep::numbers::InLanes;
use liestep::recording::{Event, Run, RunError};
use simba::simd::{AutoF64x8, SimdValue as _};

use crate::Failure;
use crate::reduce::Reduction;
use liestep::numbers::Digest;

/// The number of lanes of `AutoF64x8`.
pub(crate) const LANES: usize = 8;

type Value<M> = dyn Fn(&Moment<'_, M>) -> f64 + Send + Sync;
type Values<M> = dyn Fn(&Moment<'_, M>, &mut Vec<f64>) + Send + Sync;
type Time<M> = fn(&Moment<'_, M>) -> f64;
type Find<M> = fn(&Section<M>, &M, &<M as Integrator>::State, u64) -> Result<Vec<Crossing>, RunError>;

/// A surface, and the columns recorded where members cross it, for [`Ensemble::section`](crate::Ensemble::section).
///
/// The surface is the zero set of a function of the motion; [`sections`](liestep::recording::sections) has some.
/// Crossings lie between the ends of steps and are located as by [`Run::event`], to the bit, and with its guarantee on
/// missed crossings.
///
/// # Examples
///
/// ```
/// use liestep::effects::RigidBody;
/// use liestep::recording::{Event, sections};
/// use liestep::{NonstandardInertia, SO3, Stepper};
/// use liestep_ensemble::{Ensemble, Section};
/// use nalgebra::Vector3;
///
/// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
/// let ensemble = Ensemble::new("bodies", 8, 1_000, move |member| {
///     let stepper = Stepper::new(RigidBody { J_d }, 0.01)?;
///     let state = stepper.start(SO3::identity(), member.direction("Omega"))?;
///     Ok((stepper, state))
/// });
/// // The first axis rises through the horizontal plane.
/// let plane = sections::plane(Vector3::x(), Vector3::z());
/// let horizon = Section::<Stepper<RigidBody<f64>>>::new(Event::rising(), plane);
/// let ensemble = ensemble.section(horizon.keep(["t", "turning"], |now| [now.time(), now.velocity().x]));
/// let shard = ensemble.chunk(0, &|| false).ok_or("it was stopped")?;
/// let crossings = &shard.rows.crossings[0];
/// for (time, row) in crossings.columns[0].iter().zip(&crossings.row) {
///     assert!(*time < 10.0 && shard.rows.member[*row] < 8);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[allow(clippy::type_complexity)] // names of its parts
pub struct Section<M: Integrator> {
    event: Event,
    function: Box<Value<M>>,
    /// The function in lanes, a [`LaneFunction`].
    together: Option<Box<dyn Any + Send + Sync>>,
    only_first: bool,
    pub(crate) ends: bool,
    time: Time<M>,
    find: Find<M>,
    pub(crate) names: Vec<String>,
    columns: Vec<Box<Values<M>>>,
    pub(crate) reductions: Vec<(String, Reduction, Box<Value<M>>)>,
}

/// A section's function of members in lanes.
type LaneFunction<M> = Box<dyn Fn(&Moment<'_, <M as InLanes<AutoF64x8>>::Together>) -> AutoF64x8 + Send + Sync>;

/// The recorded values of one crossing: for the columns, and for the reductions.
pub(crate) struct Crossing {
    /// The time, s.
    pub(crate) time: f64,
    pub(crate) columns: Vec<f64>,
    pub(crate) reduced: Vec<f64>,
}

/// The search for crossings along one member.
pub(crate) struct Watch<S> {
    /// The state before the last steps at whose ends the function was zero, if there are any.
    before: Option<S>,
    /// Whether the function was above zero at the last step checked; `None` for a zero or a NaN.
    above: Option<bool>,
    /// Whether the only crossing to be recorded has been found.
    is_done: bool,
}

/// The last step of a member; its states are taken out of their lane on demand.
pub(crate) struct Place<'a, S> {
    /// The function's value after the step, if it was computed in lanes.
    pub(crate) value: Option<f64>,
    /// The state before the step, or the present one if that was checked already.
    pub(crate) before: &'a dyn Fn() -> S,
    pub(crate) now: &'a dyn Fn() -> S,
}

impl<M: Integrator> Section<M> {
    /// A section at the zeros of a function that the event selects.
    ///
    /// Every step is checked and computed twice if the event has a [bound](Event::curvature), else only those that
    /// cross.
    ///
    /// # Panics
    ///
    /// If the event is [terminal](Event::terminal): a member ends by [`until`](Self::until).
    pub fn new<Y: Into<f64>>(event: Event, function: impl Fn(&Moment<'_, M>) -> Y + Send + Sync + 'static) -> Self
    where
        M::Scalar: Into<f64>,
    {
        assert!(!event.is_terminal(), "members are ended by `until`: leave `terminal` out");
        Self {
            event,
            function: Box::new(move |now| function(now).into()),
            together: None,
            only_first: false,
            ends: false,
            time: |now| now.time().into(),
            find: find::<M>,
            names: Vec::new(),
            columns: Vec::new(),
            reductions: Vec::new(),
        }
    }

    /// Adds the same function for members in lanes, so that only those that cross leave their lanes: `sections::plane`
    /// again, or what is generic over its scalar. Members one by one don't use it.
    #[must_use]
    pub fn in_lanes(
        mut self,
        function: impl Fn(&Moment<'_, <M as InLanes<AutoF64x8>>::Together>) -> AutoF64x8 + Send + Sync + 'static,
    ) -> Self
    where
        M: Batchable<AutoF64x8> + 'static,
    {
        let function: LaneFunction<M> = Box::new(function);
        self.together = Some(Box::new(function));
        self
    }

    /// Records only the first crossing of each member: its first passage.
    #[must_use]
    pub fn first(mut self) -> Self {
        self.only_first = true;
        self
    }

    /// Records only the first crossing, and ends the member with its step, with the status
    /// [`Left`](crate::Status::Left). Reductions of ends leave such members out.
    #[must_use]
    pub fn until(mut self) -> Self {
        (self.only_first, self.ends) = (true, true);
        self
    }

    /// Records columns of these names, a list of numbers for each row of a member: the values at the crossings since
    /// the previous row, in their order.
    #[must_use]
    pub fn keep<const N: usize>(
        mut self,
        names: [&str; N],
        values: impl Fn(&Moment<'_, M>) -> [f64; N] + Send + Sync + 'static,
    ) -> Self {
        self.names.extend(names.map(str::to_owned));
        self.columns.push(Box::new(move |now, row| row.extend(values(now))));
        self
    }

    /// Reduces a value of every crossing, also of members that don't complete their steps.
    #[must_use]
    pub fn reduce(
        mut self,
        name: &str,
        reduction: Reduction,
        value: impl Fn(&Moment<'_, M>) -> f64 + Send + Sync + 'static,
    ) -> Self {
        self.reductions.push((name.to_owned(), reduction, Box::new(value)));
        self
    }

    fn at(&self, now: &Moment<'_, M>) -> Crossing {
        let mut columns = Vec::with_capacity(self.names.len());
        self.columns.iter().for_each(|values| values(now, &mut columns));
        let reduced = self.reductions.iter().map(|(_, _, value)| value(now)).collect();
        Crossing { time: (self.time)(now), columns, reduced }
    }

    /// The watch of a member from its start.
    pub(crate) fn watch(&self, stepper: &M, start: &M::State) -> Result<Watch<M::State>, Failure> {
        // The function may have no value at the start.
        (self.find)(self, stepper, start, 0).map_err(failure)?;
        let above = side((self.function)(&Moment::of_step(stepper, start)));
        Ok(Watch { before: None, above, is_done: false })
    }

    /// The function's values in lanes, if it has them.
    pub(crate) fn lanes(&self, all: &Moment<'_, <M as InLanes<AutoF64x8>>::Together>) -> Option<[f64; LANES]>
    where
        M: Batchable<AutoF64x8> + 'static,
    {
        let values = self.together.as_ref()?.downcast_ref::<LaneFunction<M>>()?(all);
        Some(core::array::from_fn(|lane| values.extract(lane)))
    }

    /// The crossings up to this state that haven't been found yet; `is_last` if no further check follows.
    ///
    /// Steps with a crossing are repeated by the member's own stepper.
    pub(crate) fn look(
        &self,
        watch: &mut Watch<M::State>,
        stepper: &M,
        at: &Place<'_, M::State>,
        is_last: bool,
    ) -> Result<Vec<Crossing>, Failure> {
        if watch.is_done {
            return Ok(Vec::new());
        }
        let value = at.value.unwrap_or_else(|| (self.function)(&Moment::of_step(stepper, &(at.now)())));
        let (above, is_lost) = (side(value), value.is_nan());
        // The next sign decides whether a zero is a crossing; a NaN has no next sign to wait for.
        if above.is_none() && !is_lost && !is_last {
            watch.before.get_or_insert_with(at.before);
            return Ok(Vec::new());
        }
        let crosses = above.is_some() && watch.above.is_some() && above != watch.above;
        let waited = watch.before.take();
        watch.above = above;
        if !crosses && !is_lost && self.event.bound().is_none() {
            return Ok(Vec::new());
        }
        let before = waited.unwrap_or_else(at.before);
        let mut found =
            (self.find)(self, stepper, &before, M::steps(&(at.now)()) - M::steps(&before)).map_err(failure)?;
        if self.only_first {
            found.truncate(1);
            watch.is_done = !found.is_empty();
        }
        Ok(found)
    }

    /// Adds everything of the section but its functions to the digest.
    pub(crate) fn describe(&self, digest: &mut Digest) {
        digest.text(&format!("{:?} {} {}", self.event, self.only_first, self.ends));
        self.names.iter().for_each(|name| digest.text(name));
        for (name, reduction, _) in &self.reductions {
            digest.text(name);
            digest.text(&format!("{reduction:?}"));
        }
    }

    /// The values of all functions of the section at one time.
    pub(crate) fn values(&self, now: &Moment<'_, M>) -> Vec<f64> {
        let Crossing { columns, reduced, .. } = self.at(now);
        [vec![(self.function)(now)], columns, reduced].concat()
    }
}

/// Whether a value is above zero; `None` for a zero or a NaN.
fn side(value: f64) -> Option<bool> {
    (value != 0.0 && !value.is_nan()).then_some(value > 0.0)
}

fn find<M: Integrator>(
    section: &Section<M>,
    stepper: &M,
    before: &M::State,
    steps: u64,
) -> Result<Vec<Crossing>, RunError>
where
    M::Scalar: Into<f64>,
{
    let (mut state, mut found) = (before.clone(), Vec::new());
    let run = Run::new(stepper, &mut state);
    run.event(section.event, &section.function, |now| found.push(section.at(now))).steps(steps)?;
    Ok(found)
}

fn failure(error: RunError) -> Failure {
    match error {
        RunError::Step { cause, .. } => Failure::Step(cause),
        other => Failure::Other(format!("at a section: {other}")),
    }
}

impl<M: Integrator> fmt::Debug for Section<M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { event, names, .. } = self;
        f.debug_struct("Section").field("event", event).field("columns", names).finish_non_exhaustive()
    }
}
