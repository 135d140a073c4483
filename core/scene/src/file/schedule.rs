//! Duration, steps and method of a run: the table `run`.

use std::num::NonZeroU32;

use liestep::with::Scheme;
use serde::Deserialize;

use crate::file::method::scheme;
use crate::file::quantity::{Duration, Number, PositiveScalar, Rate, short};

/// The duration, the steps and the method.
#[derive(Clone, Deserialize)]
#[serde(try_from = "ScheduleTable")]
pub(crate) struct Schedule {
    /// s.
    pub(crate) duration: f64,
    pub(crate) pace: Pace,
    /// Whether the file gives neither step nor accuracy, so that the program chooses both.
    pub(crate) is_left_open: bool,
    pub(crate) method: Scheme,
    /// Number of steps per orbit, which replace equal steps.
    pub(crate) steps_per_orbit: Option<NonZeroU32>,
    /// Density that varies the lengths of the steps; `step` is the first of them.
    pub(crate) density: Option<Density>,
}

/// A density of steps, by the names of [`liestep::with::densities`].
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Density {
    /// Steps of about equal turns; this angular velocity bounds their length.
    Turn(PositiveScalar<Rate>),
}

/// The quantity that determines the step.
#[derive(Clone, Copy)]
pub(crate) enum Pace {
    /// A whole number of equal steps, s.
    Step { step: f64, steps: u32 },
    /// The error at the end.
    Accuracy(f64),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScheduleTable {
    step: Option<PositiveScalar<Duration>>,
    accuracy: Option<PositiveScalar<Number>>,
    steps_per_orbit: Option<NonZeroU32>,
    density: Option<Density>,
    duration: PositiveScalar<Duration>,
    #[serde(default, deserialize_with = "scheme")]
    method: Scheme,
}

/// Default accuracy of a run without a step: at the end the attitude is off by about 1e-6 rad.
const DEFAULT_ACCURACY: f64 = 1e-6;
/// Most steps of a run, which take some minutes.
const MOST_STEPS: f64 = 1e8;

impl TryFrom<ScheduleTable> for Schedule {
    type Error = String;

    fn try_from(table: ScheduleTable) -> Result<Self, String> {
        let duration = table.duration.value;
        let is_left_open = table.step.is_none() && table.accuracy.is_none() && table.steps_per_orbit.is_none();
        let pace = match (table.step, table.accuracy) {
            // Replaced when the orbit is known.
            _ if table.steps_per_orbit.is_some() => Pace::Step { step: duration, steps: 1 },
            (Some(step), _) => Pace::Step { step: step.value, steps: equal_steps(step.value, duration)? },
            (None, Some(accuracy)) => Pace::Accuracy(accuracy.value),
            (None, None) => Pace::Accuracy(DEFAULT_ACCURACY),
        };
        let ScheduleTable { method, steps_per_orbit, density, .. } = table;
        Ok(Self { duration, pace, is_left_open, method, steps_per_orbit, density })
    }
}

/// Largest relative deviation of a duration from a whole number of steps: numbers in messages have these digits.
const ROUNDING: f64 = 1e-9;

/// The number of equal steps in a duration, s; the nearest one if the duration isn't [whole](fraction).
pub(crate) fn equal_steps(step: f64, duration: f64) -> Result<u32, String> {
    if duration < step * (1.0 - ROUNDING) {
        let (duration, step) = (short(duration), short(step));
        return Err(format!("`duration` is {duration} s, shorter than one `step` of {step} s"));
    }
    let steps = (duration / step).round();
    if steps > MOST_STEPS {
        return Err(format!("`duration` makes {steps:.1e} steps, more than {MOST_STEPS:.0e}; take a larger `step`"));
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most the limit above
    let steps = steps as u32;
    Ok(steps)
}

/// The message about a duration that ends within a step, s.
pub(crate) fn fraction(step: f64, duration: f64) -> Option<String> {
    let whole = (duration / step).round() * step;
    ((whole - duration).abs() > ROUNDING * duration).then(|| {
        let [duration, step, whole] = [duration, step, whole].map(short);
        format!("`duration` is {duration} s, which isn't a whole number of steps of {step} s; the nearest is {whole} s")
    })
}
