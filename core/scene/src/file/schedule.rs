//! Duration, steps and method of a run: the table `run` of every scene.

use std::num::NonZeroU32;

use liestep::with::Scheme;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

use crate::file::kepler::Orbit;
use crate::file::method::scheme;
use crate::file::mistake::SpanMessage;
use crate::file::quantity::{Duration, Number, PositiveScalar, Rate, short};
use crate::file::tables::{Document, has, span};

/// The duration, the steps and the method.
#[derive(Clone, Default, Deserialize)]
#[serde(from = "ScheduleTable")]
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
    /// Whether joints that are open at the start are closed.
    pub(crate) nearest: bool,
    /// Whether duration and step are numbers of orbits until the orbit is known.
    in_orbits: [bool; 2],
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

impl Default for Pace {
    fn default() -> Self {
        Self::Step { step: 0.0, steps: 0 }
    }
}

/// A time above zero: in s, or as a number of orbits, `"3 orbits"`.
struct Time {
    number: f64,
    in_orbits: bool,
}

impl<'de> Deserialize<'de> for Time {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        let value = toml::Value::deserialize(source)?;
        let words = value.as_str().and_then(|text| text.trim().split_once(' '));
        if let Some((number, _)) = words.filter(|(_, unit)| ["orbit", "orbits"].contains(&unit.trim())) {
            let number = number.parse::<f64>().ok().filter(|number| *number > 0.0 && number.is_finite());
            let number = number.ok_or_else(|| D::Error::custom("a number of orbits is above zero, as \"3 orbits\""))?;
            return Ok(Self { number, in_orbits: true });
        }
        let time = PositiveScalar::<Duration>::deserialize(value);
        let number = time.map_err(|error| D::Error::custom(error.message()))?.value;
        Ok(Self { number, in_orbits: false })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScheduleTable {
    step: Option<Time>,
    accuracy: Option<PositiveScalar<Number>>,
    steps_per_orbit: Option<NonZeroU32>,
    density: Option<Density>,
    duration: Time,
    #[serde(default, deserialize_with = "scheme")]
    method: Scheme,
    #[serde(default)]
    nearest: bool,
}

/// Default accuracy of a run without a step: at the end the attitude is off by about 1e-6 rad.
const DEFAULT_ACCURACY: f64 = 1e-6;
/// Most steps of a run, which take some minutes.
const MOST_STEPS: f64 = 1e8;

impl From<ScheduleTable> for Schedule {
    fn from(table: ScheduleTable) -> Self {
        let duration = table.duration.number;
        let in_orbits = [table.duration.in_orbits, table.step.as_ref().is_some_and(|step| step.in_orbits)];
        let is_left_open = table.step.is_none() && table.accuracy.is_none() && table.steps_per_orbit.is_none();
        let pace = match (table.step, table.accuracy) {
            // Replaced when the orbit is known.
            _ if table.steps_per_orbit.is_some() => Pace::Step { step: duration, steps: 1 },
            // Counted by `count`.
            (Some(step), _) => Pace::Step { step: step.number, steps: 1 },
            (None, Some(accuracy)) => Pace::Accuracy(accuracy.value),
            (None, None) => Pace::Accuracy(DEFAULT_ACCURACY),
        };
        let ScheduleTable { method, steps_per_orbit, density, nearest, .. } = table;
        Self { duration, pace, is_left_open, method, steps_per_orbit, density, nearest, in_orbits }
    }
}

impl Schedule {
    /// Counts the steps of the file's `step`, where times may be in orbits.
    pub(crate) fn count(&mut self, document: &Document<'_>, orbit: Option<&Orbit>) -> Result<(), SpanMessage> {
        for (key, in_orbits) in ["duration", "step"].into_iter().zip(self.in_orbits) {
            if !in_orbits {
                continue;
            }
            let none =
                || (span(document, &["run", key]), "the file has no table `[orbit]`: give a time in s".to_owned());
            let period = orbit.ok_or_else(none)?.period();
            match (key, &mut self.pace) {
                ("step", Pace::Step { step, .. }) => *step *= period,
                ("step", Pace::Accuracy(_)) => {}
                _ => self.duration *= period,
            }
        }
        if let (Pace::Step { step, steps }, None) = (&mut self.pace, self.steps_per_orbit) {
            *steps =
                equal_steps(*step, self.duration).map_err(|message| (span(document, &["run", "step"]), message))?;
        }
        Ok(())
    }

    /// The conflict of a step with an accuracy or a duration, or of an accuracy with a method.
    pub(crate) fn at_odds(&self, document: &Document<'_>, has_steps_of_its_own: bool) -> Option<SpanMessage> {
        let wrong = |key: &str, message: String| Some((span(document, &["run", key]), message));
        if has(document, "run", "step") && has(document, "run", "accuracy") {
            return wrong("accuracy", "a run has either a `step` or an `accuracy`".to_owned());
        }
        if let Pace::Step { step, .. } = self.pace
            && !has_steps_of_its_own
            && let Some(message) = fraction(step, self.duration)
        {
            let advice = "; a `step` may be in orbits, too, as \"0.001 orbits\"";
            let advice = if self.in_orbits[0] && !self.in_orbits[1] { advice } else { "" };
            return wrong("duration", message + advice);
        }
        if matches!(self.pace, Pace::Accuracy(_)) && has(document, "run", "method") {
            let message =
                "an `accuracy`, which a run without a `step` has, chooses the method; give a `step` to choose it";
            return wrong("method", message.to_owned());
        }
        None
    }

    /// The step, s; none where it is chosen for an accuracy.
    pub(crate) const fn step(&self) -> Option<f64> {
        if let Pace::Step { step, .. } = self.pace { Some(step) } else { None }
    }

    /// The step of a file that gives one, by which its kicks are to be stable, s.
    pub(crate) fn given_step(&self) -> Option<f64> {
        self.step().filter(|_| !self.is_left_open)
    }

    /// Advice where no step is found for an accuracy.
    pub(crate) const fn advice(&self) -> &'static str {
        if self.is_left_open {
            "; a run without a `step` is one for an accuracy of 1e-6: give a `step`, or an `accuracy`"
        } else {
            ""
        }
    }

    /// The steps in words.
    pub(crate) fn about(&self, is_mean: bool) -> String {
        match self.pace {
            Pace::Step { step, .. } if is_mean => {
                format!("{} s by steps of {} s on the average", short(self.duration), short(step))
            }
            Pace::Step { step, steps } => format!("{steps} steps of {} s", short(step)),
            Pace::Accuracy(tolerance) => format!("{} s to {tolerance:e}", short(self.duration)),
        }
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
