//! Arguments that both examples take, checked before anything is computed.

use std::fmt;
use std::path::PathBuf;

/// The step, the span and where the results go.
#[derive(clap::Args, Clone, Debug)]
pub struct Common {
    /// The step, s.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.01, value_parser = positive)]
    pub step: f64,
    /// The time to simulate, s.
    #[arg(long, value_name = "SECONDS", default_value_t = 200.0, value_parser = positive)]
    pub time: f64,
    /// The folder for the figures [default: out/ and the example's name].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Also write every series as CSV, next to the figures.
    #[arg(long)]
    pub csv: bool,
}

/// A finite number of equal steps.
#[derive(Clone, Copy, Debug)]
pub struct Schedule {
    /// The step, s.
    pub step: f64,
    /// How many.
    pub steps: u64,
}

/// A stretch of a run whose samples are equally far apart.
#[derive(Clone, Copy, Debug)]
pub struct Stretch {
    /// Where it ends, in steps from the start.
    pub end: u64,
    /// A sample is kept every so many steps.
    pub stride: u64,
}

/// A span and a step that don't make a run.
#[derive(Debug)]
pub enum NoSchedule {
    Empty { step: f64, time: f64 },
    Endless { steps: f64 },
}

impl fmt::Display for NoSchedule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty { step, time } => {
                write!(f, "--time {time} is shorter than one --step {step}; nothing would happen")
            }
            Self::Endless { steps } => {
                write!(f, "--time over --step makes {steps:.1e} steps, more than {MOST_STEPS:.0e}; take a larger step")
            }
        }
    }
}

impl std::error::Error for NoSchedule {}

/// About an hour of stepping.
const MOST_STEPS: f64 = 1e10;

/// More samples than a figure has room for, few enough for any memory.
const MOST_SAMPLES: u64 = 20_000;

/// The beginning that is kept in detail, s: two flips of the free body.
const BEGINNING: f64 = 20.0;

/// The end that is kept in detail, s: from 100 s to 200 s in the thesis.
pub const ENDING: f64 = 100.0;

impl Common {
    /// The whole number of steps nearest to the time asked for.
    pub fn schedule(&self) -> Result<Schedule, NoSchedule> {
        let (step, time) = (self.step, self.time);
        let steps = (time / step).round();
        if steps < 1.0 {
            return Err(NoSchedule::Empty { step, time });
        }
        if steps > MOST_STEPS {
            return Err(NoSchedule::Endless { steps });
        }
        Ok(Schedule { step, steps: whole(steps) })
    }

    /// The folder asked for, or `out/` and the example's name.
    pub fn folder(&self, example: &str) -> PathBuf {
        self.out.clone().unwrap_or_else(|| PathBuf::from("out").join(example))
    }
}

impl Schedule {
    /// The time after so many steps, s.
    #[allow(clippy::cast_precision_loss)] // MOST_STEPS is below 2⁵³
    pub fn time_after(&self, steps: u64) -> f64 {
        self.step * steps as f64
    }

    /// The time at the end, s.
    pub fn end(&self) -> f64 {
        self.time_after(self.steps)
    }

    /// The beginning, the middle and the end, each with as many samples as can be drawn.
    pub fn stretches(&self) -> [Stretch; 3] {
        let beginning = whole(BEGINNING / self.step).min(self.steps);
        let ending = self.steps.saturating_sub(whole(ENDING / self.step)).max(beginning);
        let mut start = 0;
        [beginning, ending, self.steps].map(|end| {
            let stride = (end - start).div_ceil(MOST_SAMPLES).max(1);
            start = end;
            Stretch { end, stride }
        })
    }
}

/// The nearest whole number of steps; beyond the most that are allowed, that.
fn whole(steps: f64) -> u64 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped
    let whole = steps.round().clamp(0.0, MOST_STEPS) as u64;
    whole
}

fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "not a number; write seconds, as in 0.01".to_owned())?;
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err("must be a finite number above zero".to_owned()) }
}
