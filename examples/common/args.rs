//! Arguments that both examples take, checked before anything is computed.

use std::fmt;
use std::path::PathBuf;

/// The step, the span and where the results go.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Common {
    /// The step, s.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.01, value_parser = positive)]
    pub(crate) step: f64,
    /// The time to simulate, s.
    #[arg(long, value_name = "SECONDS", default_value_t = 200.0, value_parser = positive)]
    pub(crate) time: f64,
    /// The folder for the figures [default: out/ and the example's name].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Also write every series as CSV, next to the figures.
    #[arg(long)]
    pub(crate) csv: bool,
}

/// A finite number of equal steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Schedule {
    /// The step, s.
    pub(crate) step: f64,
    /// How many.
    pub(crate) steps: u64,
    /// A sample is kept every so many steps.
    pub(crate) stride: u64,
}

/// A span and a step that don't make a run.
#[derive(Debug)]
pub(crate) enum NoSchedule {
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
const MOST_SAMPLES: u64 = 50_000;

impl Common {
    /// The whole number of steps nearest to the time asked for.
    pub(crate) fn schedule(&self) -> Result<Schedule, NoSchedule> {
        let (step, time) = (self.step, self.time);
        let steps = (time / step).round();
        if steps < 1.0 {
            return Err(NoSchedule::Empty { step, time });
        }
        if steps > MOST_STEPS {
            return Err(NoSchedule::Endless { steps });
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // between 1 and MOST_STEPS
        let steps = steps as u64;
        Ok(Schedule { step, steps, stride: steps.div_ceil(MOST_SAMPLES) })
    }

    /// The folder asked for, or `out/` and the example's name.
    pub(crate) fn folder(&self, example: &str) -> PathBuf {
        self.out.clone().unwrap_or_else(|| PathBuf::from("out").join(example))
    }
}

impl Schedule {
    /// The time after so many steps, s.
    #[allow(clippy::cast_precision_loss)] // MOST_STEPS is below 2⁵³
    pub(crate) fn time_after(&self, steps: u64) -> f64 {
        self.step * steps as f64
    }

    /// The time at the end, s.
    pub(crate) fn end(&self) -> f64 {
        self.time_after(self.steps)
    }
}

fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "not a number; write seconds, as in 0.01".to_owned())?;
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err("must be a finite number above zero".to_owned()) }
}
