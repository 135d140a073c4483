//! Runs of an integrator with ever shorter steps, and their errors.

use liestep::accuracy::End;
use liestep::groups::{Advected, LieGroup};
use liestep::motion::{Integrator, Motion};
use liestep::{SetupError, StepError};
use thiserror::Error;

use crate::table::{Measurement, Refinement};

/// The reference with which the ends of runs are compared.
#[derive(Clone, Copy, Debug)]
pub enum Reference<G: LieGroup> {
    /// A known state: of a closed form, or of a method that is more accurate by far.
    End(End<G>),
    /// The run with the most steps, which then is no row. If it has `r` times the steps of the run before and errors
    /// fall by the order `p`, the last row's error is too small by the part `r⁻ᵖ`, and the earlier ones by less. It
    /// runs once, before the others, however long it takes.
    Finest,
}

/// The reason why there are no runs to compare.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RefinementError {
    /// The end isn't a finite time other than zero.
    #[error("a run can't end at {time:e} s; choose a finite time other than zero")]
    Time {
        /// The requested time, s.
        time: f64,
    },
    /// There is no number of steps, or only that of the reference; or one is zero.
    #[error("there are no runs to compare; give numbers of steps above zero, with `Reference::Finest` two or more")]
    NoSteps,
    /// A stepper couldn't be constructed, or its motion not be started.
    #[error("with steps of {step:e} s: {cause}")]
    Setup {
        /// The step, s.
        step: f64,
        /// The reason.
        #[source]
        cause: SetupError,
    },
    /// A stepper has another step than requested.
    #[error(
        "a stepper for {asked:e} s was asked for and makes steps of {found:e} s; build it with the step that the closure is given"
    )]
    OtherStep {
        /// The requested step, s.
        asked: f64,
        /// The stepper's own step, s.
        found: f64,
    },
    /// A step had no solution.
    #[error("{cause}")]
    Step {
        /// The step, s.
        step: f64,
        /// The reason.
        #[source]
        cause: StepError,
    },
    /// All runs ended far from the reference: all errors are 0.5 and more.
    #[error("no run ends near the reference, the least error is {least:.1e}; make more steps")]
    OtherMotion {
        /// The least error among the runs.
        least: f64,
    },
    /// An end, or the reference, isn't finite.
    #[error("the run with steps of {step:e} s, or its reference, doesn't end in finite numbers")]
    NonFinite {
        /// The step of the run, s.
        step: f64,
    },
}

/// A run that is ready to start.
pub(crate) struct PreparedRun<I: Integrator> {
    time: f64,
    step: f64,
    steps: u64,
    integrator: I,
    start: I::State,
}

impl<
    G: LieGroup<Scalar = f64>,
    A: Advected<G>,
    I: Integrator<Scalar = f64, Motion = Motion<G, A>, Velocity = G::Vector>,
> PreparedRun<I>
{
    /// A run of this number of equal steps up to a time.
    #[allow(clippy::cast_precision_loss)] // no run has 2⁵³ steps
    pub(crate) fn new(
        family: &mut impl FnMut(f64) -> Result<(I, I::State), SetupError>,
        time: f64,
        steps: u64,
    ) -> Result<Self, RefinementError> {
        /// A bound of the relative rounding of `(time / steps) * steps`, with a margin.
        const ROUNDING: f64 = 1e-12;
        let step = time / steps as f64;
        let (integrator, start) = family(step).map_err(|cause| RefinementError::Setup { step, cause })?;
        let found = integrator.step_size();
        let is_this = (found - step).abs() <= ROUNDING * step.abs();
        if !is_this {
            return Err(RefinementError::OtherStep { asked: step, found });
        }
        Ok(Self { time, step, steps, integrator, start })
    }

    /// The end of the run, and its iterations.
    pub(crate) fn run(&self) -> Result<(End<G>, u64), RefinementError> {
        let mut state = self.start.clone();
        let iterations = self
            .integrator
            .run(&mut state, self.steps)
            .map_err(|cause| RefinementError::Step { step: self.step, cause })?;
        Ok((End { attitude: state.attitude(), velocity: self.integrator.velocity(&state) }, iterations))
    }

    /// The row of a run with this end and this number of iterations.
    #[allow(clippy::cast_precision_loss)] // as above
    pub(crate) fn measurement(
        &self,
        (end, iterations): (End<G>, u64),
        exact: &End<G>,
    ) -> Result<Measurement, RefinementError> {
        let start = End { attitude: self.start.attitude(), velocity: self.integrator.velocity(&self.start) };
        let error = end.error(exact, &start, self.time);
        if !error.is_finite() {
            return Err(RefinementError::NonFinite { step: self.step });
        }
        let iterations = Some(iterations as f64 / self.steps as f64);
        Ok(Measurement { step: self.step, error, iterations, seconds: None })
    }
}

/// The numbers of steps, the fewest first, and the reference, by a run of the most steps if none is known.
#[allow(clippy::type_complexity)] // two things, each named above
pub(crate) fn plan<
    G: LieGroup<Scalar = f64>,
    A: Advected<G>,
    I: Integrator<Scalar = f64, Motion = Motion<G, A>, Velocity = G::Vector>,
>(
    family: &mut impl FnMut(f64) -> Result<(I, I::State), SetupError>,
    time: f64,
    counts: impl IntoIterator<Item = u64>,
    reference: Reference<G>,
) -> Result<(Vec<u64>, End<G>), RefinementError> {
    if !(time.is_finite() && time != 0.0) {
        return Err(RefinementError::Time { time });
    }
    let mut counts: Vec<u64> = counts.into_iter().collect();
    counts.sort_unstable();
    counts.dedup();
    let most = if matches!(reference, Reference::Finest) { counts.pop() } else { None };
    if counts.first().is_none_or(|fewest| *fewest == 0) {
        return Err(RefinementError::NoSteps);
    }
    let exact = match (reference, most) {
        (Reference::End(end), _) => end,
        (Reference::Finest, most) => PreparedRun::new(family, time, most.unwrap_or(0))?.run()?.0,
    };
    Ok((counts, exact))
}

/// Measures how fast the errors of a method fall, by runs to the time `time`, s, with ever more steps.
///
/// The family constructs the stepper for a step, and its start. The error is that of attitude and body velocity
/// together, as [`Accuracy`](liestep::accuracy::Accuracy) defines it. No clock is used, so the table is the same each
/// time.
///
/// # Errors
///
/// [`RefinementError`]: all runs have to complete.
///
/// # Examples
///
/// The orders of three methods are measured on [the page of this package](crate).
pub fn convergence<
    G: LieGroup<Scalar = f64>,
    A: Advected<G>,
    I: Integrator<Scalar = f64, Motion = Motion<G, A>, Velocity = G::Vector>,
>(
    mut family: impl FnMut(f64) -> Result<(I, I::State), SetupError>,
    time: f64,
    counts: impl IntoIterator<Item = u64>,
    reference: Reference<G>,
) -> Result<Refinement, RefinementError> {
    let (counts, exact) = plan(&mut family, time, counts, reference)?;
    let row = |steps| {
        let ready = PreparedRun::new(&mut family, time, steps)?;
        ready.measurement(ready.run()?, &exact)
    };
    counts.into_iter().map(row).collect()
}
