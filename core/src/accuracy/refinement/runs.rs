//! Runs of an integrator with ever shorter steps, and their errors.

use alloc::vec::Vec;
use thiserror::Error;

use super::{Measurement, Refinement};
use crate::accuracy::question::Start;
use crate::error::{SetupError, StepError};
use crate::groups::LieGroup;
use crate::motion::Integrator;

use crate::accuracy::question::End;

/// What the ends of the runs are compared with.
#[derive(Clone, Copy, Debug)]
pub enum Reference<G: LieGroup> {
    /// A state that is known: of a closed form, or of a method that is more accurate by far.
    End(End<G>),
    /// The run with the most steps, which then is no row. Where that has `r` times the steps of the run before and errors
    /// fall by the order `p`, the last row's error is too small by the part `r⁻ᵖ`, and those before by less. It is made
    /// once, before the others, however long it takes.
    Finest,
}

/// Why there are no runs to compare.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RefinementError {
    /// The end isn't a finite time other than zero.
    #[error("a run can't end at {time:e} s; choose a finite time other than zero")]
    Time {
        /// What was asked for, s.
        time: f64,
    },
    /// There is no number of steps, or only that of the reference; or one is zero.
    #[error("there are no runs to compare; give numbers of steps above zero, with `Reference::Finest` two or more")]
    NoSteps,
    /// A stepper couldn't be built, or its motion not be started.
    #[error("with steps of {step:e} s: {cause}")]
    Setup {
        /// Its step, s.
        step: f64,
        /// Why.
        #[source]
        cause: SetupError,
    },
    /// A stepper has another step than it was asked to have.
    #[error(
        "a stepper for {asked:e} s was asked for and makes steps of {found:e} s; build it with the step that the closure is given"
    )]
    OtherStep {
        /// What was asked for, s.
        asked: f64,
        /// What it has, s.
        found: f64,
    },
    /// A step had no solution.
    #[error("{cause}")]
    Step {
        /// The step, s.
        step: f64,
        /// Why.
        #[source]
        cause: StepError,
    },
    /// Runs came to their ends, but none near the reference: all errors are 0.5 and more.
    #[error("no run ends near the reference, the least error is {least:.1e}; make more steps")]
    OtherMotion {
        /// The least error.
        least: f64,
    },
    /// An end, or the reference, isn't made of finite numbers.
    #[error("the run with steps of {step:e} s, or its reference, doesn't end in finite numbers")]
    NonFinite {
        /// The step of the run, s.
        step: f64,
    },
}

/// A run made ready.
pub(super) struct Ready<I: Integrator> {
    pub(super) step: f64,
    steps: u64,
    integrator: I,
    start: I::State,
}

impl<G: LieGroup<Scalar = f64>, I: Integrator<Group = G>> Ready<I> {
    /// A run of this number of equal steps up to a time.
    #[allow(clippy::cast_precision_loss)] // no run has 2⁵³ steps
    pub(super) fn new(
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
        Ok(Self { step, steps, integrator, start })
    }

    /// Where the motion starts, and until when it goes.
    pub(super) fn start(&self, time: f64) -> Start<G> {
        let velocity = self.integrator.velocity(&self.start);
        Start { attitude: self.start.attitude(), velocity, horizon: time.abs() }
    }

    /// Where it ends, and its iterations.
    pub(super) fn run(&self) -> Result<(End<G>, u64), RefinementError> {
        let mut state = self.start.clone();
        let iterations = self
            .integrator
            .run(&mut state, self.steps)
            .map_err(|cause| RefinementError::Step { step: self.step, cause })?;
        Ok((End { attitude: state.attitude(), velocity: self.integrator.velocity(&state) }, iterations))
    }

    #[allow(clippy::cast_precision_loss)] // as above
    pub(super) fn measurement(&self, error: f64, iterations: u64) -> Result<Measurement, RefinementError> {
        if !error.is_finite() {
            return Err(RefinementError::NonFinite { step: self.step });
        }
        let iterations = Some(iterations as f64 / self.steps as f64);
        Ok(Measurement { step: self.step, error, iterations, seconds: None })
    }
}

/// The numbers of steps, the fewest first, and the reference, for which the most steps are made if none is given.
#[allow(clippy::type_complexity)] // two things, each named above
pub(super) fn plan<G: LieGroup<Scalar = f64>, I: Integrator<Group = G>>(
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
    if counts.first() == Some(&0) {
        return Err(RefinementError::NoSteps);
    }
    let exact = match reference {
        Reference::End(end) => end,
        Reference::Finest => {
            let most = counts.pop().ok_or(RefinementError::NoSteps)?;
            if counts.is_empty() {
                return Err(RefinementError::NoSteps);
            }
            Ready::new(family, time, most)?.run()?.0
        }
    };
    if counts.is_empty() { Err(RefinementError::NoSteps) } else { Ok((counts, exact)) }
}

/// How fast the errors of a method fall: runs to the time `time`, s, with ever more steps.
///
/// The family is what makes the stepper for a step, and its start. The error is that of attitude and body velocity
/// together, as [`Accuracy`](crate::accuracy::Accuracy) defines it. No clock is asked, so the table is the same each time.
///
/// # Errors
///
/// [`RefinementError`]: all runs have to come to their ends.
///
/// # Examples
///
/// Of which order is the composition of five steps?
///
/// ```
/// use liestep::accuracy::{Reference, convergence};
/// use liestep::methods::CompositionScheme;
/// use liestep::prelude::*;
///
/// let body = RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))? };
/// let family = |h| {
///     let stepper = Stepper::composed(body, h, CompositionScheme::SUZUKI_4)?;
///     let start = stepper.start(SO3::identity(), Vector3::new(0.3, 2.0, 0.2))?;
///     Ok((stepper, start))
/// };
/// let table = convergence(family, 2.0, [20, 40, 80, 160, 1280], Reference::Finest)?;
/// assert!((table.order_above(1e-13).ok_or("too few errors")? - 4.0).abs() < 0.1, "{table}");
/// println!("{table}\n{}", table.to_csv());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn convergence<G: LieGroup<Scalar = f64>, I: Integrator<Group = G>>(
    mut family: impl FnMut(f64) -> Result<(I, I::State), SetupError>,
    time: f64,
    counts: impl IntoIterator<Item = u64>,
    reference: Reference<G>,
) -> Result<Refinement, RefinementError> {
    let (counts, exact) = plan(&mut family, time, counts, reference)?;
    let mut rows = Vec::with_capacity(counts.len());
    for steps in counts {
        let ready = Ready::new(&mut family, time, steps)?;
        let (end, iterations) = ready.run()?;
        rows.push(ready.measurement(ready.start(time).difference(&end, &exact), iterations)?);
    }
    Ok(Refinement { rows })
}
