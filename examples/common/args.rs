//! Command lines, checked before anything is computed.

use std::error::Error;
use std::ffi::OsString;
use std::fmt;
use std::path::PathBuf;
use std::process::ExitCode;

use lexopt::Arg;

use crate::output::print;
use crate::table::short;

/// What is wrong, in words.
pub type Failure = Box<dyn Error>;

/// Runs an example on its command line, and says what went wrong.
pub fn example(help: &str, run: impl FnOnce(&mut Words) -> Result<(), Failure>) -> ExitCode {
    let asked = std::env::args_os().skip(1).any(|word| word == "--help" || word == "-h");
    let outcome = if asked {
        print(help).map_err(Failure::from)
    } else {
        run(&mut Words { parser: lexopt::Parser::from_env(), option: String::new() })
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The words of a command line, from the first on.
pub struct Words {
    parser: lexopt::Parser,
    /// That which a value is wanted for.
    option: String,
}

/// An option without its dashes, or what belongs to none.
pub enum Word {
    Option(String),
    Plain(OsString),
}

impl Words {
    /// The next one.
    pub fn word(&mut self) -> Result<Option<Word>, Failure> {
        let word = match self.parser.next().map_err(|error| told(&error))? {
            None => return Ok(None),
            Some(Arg::Value(word)) => Word::Plain(word),
            Some(Arg::Long(name)) => Word::Option(name.to_owned()),
            Some(Arg::Short(letter)) => return Err(format!("unexpected argument '-{letter}'; see --help").into()),
        };
        if let Word::Option(name) = &word {
            self.option.clone_from(name);
        }
        Ok(Some(word))
    }

    /// The next option, where there is nothing else.
    pub fn option(&mut self) -> Result<Option<String>, Failure> {
        match self.word()? {
            None => Ok(None),
            Some(Word::Option(name)) => Ok(Some(name)),
            Some(Word::Plain(word)) => Err(format!("unexpected argument '{}'; see --help", word.display()).into()),
        }
    }

    /// Says that there is no such option.
    pub fn unknown(&self) -> Failure {
        format!("unexpected argument '--{}'; see --help", self.option).into()
    }

    /// The text that the option is given, which may be empty.
    pub fn text(&mut self) -> Result<String, Failure> {
        let text = self.parser.value().map_err(|error| told(&error))?;
        text.into_string().map_err(|text| self.invalid(&text.display(), "isn't a text in UTF-8"))
    }

    /// A number above zero, s.
    pub fn seconds(&mut self) -> Result<f64, Failure> {
        let text = self.text()?;
        let value: f64 = text.parse().map_err(|_| self.invalid(&text, "is not a number; write seconds, as in 0.01"))?;
        if value.is_finite() && value > 0.0 {
            Ok(value)
        } else {
            Err(self.invalid(&text, "must be a finite number above zero"))
        }
    }

    /// A whole number above zero.
    pub fn count<T: std::str::FromStr + Default + PartialOrd>(&mut self) -> Result<T, Failure> {
        let text = self.text()?;
        let count = text.parse().ok().filter(|count| *count > T::default());
        count.ok_or_else(|| self.invalid(&text, "is not a whole number above zero"))
    }

    /// A folder, which has a name.
    pub fn folder(&mut self) -> Result<PathBuf, Failure> {
        let folder = self.parser.value().map_err(|error| told(&error))?;
        if folder.is_empty() {
            return Err(format!("a value is required for '--{}'; see --help", self.option).into());
        }
        Ok(folder.into())
    }

    /// One of these, by its name.
    pub fn one_of<T: Copy>(&mut self, all: &[(&str, T)]) -> Result<T, Failure> {
        let text = self.text()?;
        let found = all.iter().find(|(name, _)| name.eq_ignore_ascii_case(&text));
        found.map(|(_, value)| *value).ok_or_else(|| {
            let names: Vec<_> = all.iter().map(|(name, _)| *name).collect();
            self.invalid(&text, &format!("is none of {}", names.join(", ")))
        })
    }

    fn invalid(&self, text: &dyn fmt::Display, why: &str) -> Failure {
        format!("invalid value '{text}' for '--{}': it {why}", self.option).into()
    }
}

fn told(error: &lexopt::Error) -> Failure {
    match error {
        lexopt::Error::MissingValue { option } => {
            format!("a value is required for '{}'; see --help", option.as_deref().unwrap_or_default())
        }
        lexopt::Error::UnexpectedValue { option, value } => {
            format!("unexpected value '{}' for '{option}'; see --help", value.display())
        }
        other => other.to_string(),
    }
    .into()
}

/// The step, the span and where the results go.
#[derive(Clone, Debug)]
pub struct Common {
    /// The step, s.
    pub step: f64,
    /// The time to simulate, s.
    pub time: f64,
    /// The folder for the figures.
    pub out: Option<PathBuf>,
    /// Whether every series is also written as CSV, next to the figures.
    pub csv: bool,
}

/// The options of [`Common`], as `--help` tells them.
#[macro_export]
macro_rules! common_help {
    () => {
        "      --step <SECONDS>  The step, s [default: 0.01]
      --time <SECONDS>  The time to simulate, s [default: 200]
      --out <DIR>       The folder for the figures [default: out/ and the example's name]
      --csv             Also write every series as CSV, next to the figures
  -h, --help            Print this
"
    };
}

impl Default for Common {
    fn default() -> Self {
        Self { step: 0.01, time: 200.0, out: None, csv: false }
    }
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
    /// The number of steps between two samples.
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
                let (time, step) = (short(*time), short(*step));
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

/// The beginning that is kept in detail, s.
const BEGINNING: f64 = 20.0;

/// The end that is kept in detail, s: from 100 s to 200 s in the thesis.
pub const ENDING: f64 = 100.0;

impl Common {
    /// Takes the option in hand, if it is one of these.
    pub fn take(&mut self, option: &str, words: &mut Words) -> Result<(), Failure> {
        match option {
            "step" => self.step = words.seconds()?,
            "time" => self.time = words.seconds()?,
            "out" => self.out = Some(words.folder()?),
            "csv" => self.csv = true,
            _ => return Err(words.unknown()),
        }
        Ok(())
    }

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
    /// The time after this number of steps, s.
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
