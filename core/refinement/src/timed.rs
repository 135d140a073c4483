//! Work and precision: the runs of a refinement, timed. No other file of this package uses a clock.

use std::time::{Duration, Instant};

use liestep::SetupError;
use liestep::accuracy::End;
use liestep::groups::{Advected, LieGroup};
use liestep::motion::{Integrator, Motion};

use crate::runs::{PreparedRun, Reference, RefinementError, plan};
use crate::table::{Measurement, Refinement};

/// The effort of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// The longest time, s: the first run that takes longer is the last.
    pub longest: f64,
    /// The time in which each run is repeated, a thousand times at most; the shortest counts, which other programs
    /// disturb least. A run that fails isn't repeated.
    pub repeated: Duration,
}

/// The most repetitions; more find nothing shorter.
const MOST_REPETITIONS: u32 = 1000;

/// Runs of up to 0.1 s, each repeated for 10 ms.
impl Default for Effort {
    fn default() -> Self {
        Self { longest: 0.1, repeated: Duration::from_millis(10) }
    }
}

impl Effort {
    /// The result of a run, and the time of its fastest repetition, s.
    ///
    /// # Errors
    ///
    /// The error of the run.
    pub fn time<X, E>(&self, mut run: impl FnMut() -> Result<X, E>) -> Result<(X, f64), E> {
        let started = Instant::now();
        let (mut best, mut repetitions) = (Duration::MAX, 0);
        loop {
            let start = Instant::now();
            let result = run()?;
            best = best.min(start.elapsed());
            repetitions += 1;
            if repetitions == MOST_REPETITIONS || started.elapsed() > self.repeated {
                return Ok((result, best.as_secs_f64()));
            }
        }
    }
}

/// The largest error of a run that follows the motion; others are left out.
const LARGEST_ERROR: f64 = 0.5;

/// Whether an error is a number, and small enough for the run to follow the motion.
fn is_near(error: f64) -> bool {
    error < LARGEST_ERROR
}

/// The smallest error that isn't due to rounding.
const SMALLEST_ERROR: f64 = 1e-14;
/// The error above which errors may rise and fall; smaller ones that rise are due to rounding.
const NEAR_ROUNDING: f64 = 1e-10;
/// The number of runs in a row without an improvement after which errors are due to rounding.
const NO_BETTER: u32 = 3;

/// The search for the run from which shorter steps gain nothing.
#[derive(Default)]
struct Progress {
    best: Option<f64>,
    no_better: u32,
}

impl Progress {
    fn is_done(&mut self, effort: Effort, error: f64, seconds: f64) -> bool {
        // A run of another motion, or without a number, is no better and no worse.
        if !is_near(error) {
            return seconds > effort.longest;
        }
        let is_better = self.best.is_none_or(|best| error < best);
        self.no_better = if is_better { 0 } else { self.no_better + 1 };
        if is_better {
            self.best = Some(error);
        }
        let is_plateau = error < NEAR_ROUNDING && self.no_better >= NO_BETTER;
        seconds > effort.longest || error < SMALLEST_ERROR || is_plateau
    }
}

impl Refinement {
    /// Errors and times of anything that runs with a parameter: a rival, written otherwise or in another library.
    ///
    /// `prepare` sets up a run for a step (or a tolerance), outside of the measured time, and `error` evaluates the end
    /// of the run. Runs that fail, and those with errors of 0.5 and more, are left out; shorter steps aren't tried once
    /// a run is longer than the effort allows, or errors have stopped falling.
    ///
    /// # Examples
    ///
    /// Euler's method for `y' = −y`:
    ///
    /// ```
    /// use liestep_refinement::{Effort, Refinement};
    ///
    /// let costs = Refinement::timed(
    ///     (4..10).map(|k| 0.5_f64.powi(k)),
    ///     Effort::default(),
    ///     |h: f64| Some(move || Some((0..(1.0 / h) as u32).fold(1.0, |y, _| y - h * y))),
    ///     |y: &f64| (y - (-1_f64).exp()).abs(),
    /// );
    /// assert!((costs.order_above(0.0).ok_or("too few errors")? - 1.0).abs() < 0.05);
    /// assert!(costs.seconds_to(1e-2) <= costs.seconds_to(2e-3));
    /// # Ok::<(), &str>(())
    /// ```
    pub fn timed<X, R: FnMut() -> Option<X>>(
        parameters: impl IntoIterator<Item = f64>,
        effort: Effort,
        mut prepare: impl FnMut(f64) -> Option<R>,
        mut error: impl FnMut(&X) -> f64,
    ) -> Self {
        let (mut rows, mut progress) = (Vec::new(), Progress::default());
        for step in parameters {
            // A step may be too long to be solvable; the next is shorter.
            let Some(mut run) = prepare(step) else { continue };
            let Ok((end, seconds)) = effort.time(|| run().ok_or(())) else { continue };
            let error = error(&end);
            if is_near(error) {
                rows.push(Measurement { step, error, iterations: None, seconds: Some(seconds) });
            }
            if progress.is_done(effort, error, seconds) {
                break;
            }
        }
        rows.into_iter().collect()
    }
}

/// Measures the time that an accuracy costs: as [`convergence`](crate::convergence), with the time of each run, without
/// the construction of the stepper.
///
/// Runs whose stepper can't be constructed, whose step has no solution or whose end isn't made of finite numbers are
/// left out, and so are those with errors of 0.5 and more. The last run is the first that takes longer than the effort
/// allows, or one after which errors have stopped falling.
///
/// [`Reference::Finest`] is one more run, with the most steps, whatever the effort allows. This run comes first, and is
/// neither timed nor repeated. If each number of steps is twice the one before, it takes about as long as all others
/// once; more, if these end early. [`Reference::End`] costs nothing.
///
/// # Errors
///
/// [`RefinementError`] if the plan has no runs or a stepper has another step than requested; if no run is left, that of
/// the last one that failed, or [`OtherMotion`](RefinementError::OtherMotion) if none did.
///
/// # Examples
///
/// The cost of an error of 1e-4 with either kinetic term:
///
/// ```
/// use liestep::effects::CayleyBody;
/// use liestep::mechanics::Regular;
/// use liestep::prelude::*;
/// use liestep_refinement::{Effort, Reference, Refinement, RefinementError, work_precision};
///
/// fn costs<B>(body: B) -> Result<Refinement, RefinementError>
/// where
///     B: Regular<Scalar = f64, Group = SO3> + Copy,
/// {
///     let family = |h| {
///         let stepper = Stepper::new(body, h)?;
///         let start = stepper.start(SO3::identity(), Vector3::new(0.3, 2.0, 0.2))?;
///         Ok((stepper, start))
///     };
///     let counts = (4..12).map(|k| 1 << k);
///     work_precision(family, 2.0, counts, Reference::Finest, Effort::default())
/// }
///
/// let J = Inertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
/// for costs in [costs(RigidBody { J_d: J.to_nonstandard() })?, costs(CayleyBody { J })?] {
///     println!("{costs}\n{:?} s", costs.seconds_to(1e-4));
///     assert!(costs.rows().iter().all(|row| row.seconds > Some(0.0)));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn work_precision<
    G: LieGroup<Scalar = f64>,
    A: Advected<G>,
    I: Integrator<Scalar = f64, Motion = Motion<G, A>, Velocity = G::Vector>,
>(
    mut family: impl FnMut(f64) -> Result<(I, I::State), SetupError>,
    time: f64,
    counts: impl IntoIterator<Item = u64>,
    reference: Reference<G>,
    effort: Effort,
) -> Result<Refinement, RefinementError> {
    let (counts, exact) = plan(&mut family, time, counts, reference)?;
    let (mut rows, mut progress) = (Vec::new(), Progress::default());
    let (mut failure, mut least) = (None, f64::INFINITY);
    for steps in counts {
        // A step may be too long to be taken, or to be solvable; the next is shorter.
        let (row, seconds) = match measured(&mut family, (time, steps), &exact, effort) {
            Ok(measured) => measured,
            // Shorter steps don't help.
            Err(cause @ RefinementError::OtherStep { .. }) => return Err(cause),
            Err(cause) => {
                failure = Some(cause);
                continue;
            }
        };
        least = least.min(row.error);
        if is_near(row.error) {
            rows.push(row);
        }
        if progress.is_done(effort, row.error, seconds) {
            break;
        }
    }
    if rows.is_empty() {
        return Err(failure.unwrap_or(RefinementError::OtherMotion { least }));
    }
    Ok(rows.into_iter().collect())
}

/// A run of this number of steps, with its time, s.
fn measured<
    G: LieGroup<Scalar = f64>,
    A: Advected<G>,
    I: Integrator<Scalar = f64, Motion = Motion<G, A>, Velocity = G::Vector>,
>(
    family: &mut impl FnMut(f64) -> Result<(I, I::State), SetupError>,
    (time, steps): (f64, u64),
    exact: &End<G>,
    effort: Effort,
) -> Result<(Measurement, f64), RefinementError> {
    let ready = PreparedRun::new(family, time, steps)?;
    let (ended, seconds) = effort.time(|| ready.run())?;
    let row = ready.measurement(ended, exact)?;
    Ok((Measurement { seconds: Some(seconds), ..row }, seconds))
}
