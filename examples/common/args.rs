//! Command lines, which are checked before any computation.

use std::error::Error;
use std::ffi::OsString;
use std::fmt;
use std::path::PathBuf;
use std::process::ExitCode;

use lexopt::Arg;

use crate::output::print;

/// An error as a message for the user.
pub type Failure = Box<dyn Error>;

/// Runs an example with its command line, and reports its error.
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
    /// The option that a value is expected for.
    option: String,
}

/// An option without its dashes, or a word that isn't an option.
pub enum Word {
    Option(String),
    Plain(OsString),
}

impl Words {
    /// The next word.
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

    /// The next option, for programs with options only.
    pub fn option(&mut self) -> Result<Option<String>, Failure> {
        match self.word()? {
            None => Ok(None),
            Some(Word::Option(name)) => Ok(Some(name)),
            Some(Word::Plain(word)) => Err(format!("unexpected argument '{}'; see --help", word.display()).into()),
        }
    }

    /// The error of an unknown option.
    pub fn unknown(&self) -> Failure {
        format!("unexpected argument '--{}'; see --help", self.option).into()
    }

    /// The value of the option as a text, which may be empty.
    pub fn text(&mut self) -> Result<String, Failure> {
        let text = self.parser.value().map_err(|error| told(&error))?;
        text.into_string().map_err(|text| self.invalid(&text.display(), "isn't a text in UTF-8"))
    }

    /// The value as a number above zero, s.
    pub fn seconds(&mut self) -> Result<f64, Failure> {
        let text = self.text()?;
        let value: f64 = text.parse().map_err(|_| self.invalid(&text, "is not a number; write seconds, as in 0.01"))?;
        if value.is_finite() && value > 0.0 {
            Ok(value)
        } else {
            Err(self.invalid(&text, "must be a finite number above zero"))
        }
    }

    /// The value as the path of a folder, not empty.
    pub fn folder(&mut self) -> Result<PathBuf, Failure> {
        let folder = self.parser.value().map_err(|error| told(&error))?;
        if folder.is_empty() {
            return Err(format!("a value is required for '--{}'; see --help", self.option).into());
        }
        Ok(folder.into())
    }

    /// The value as one of these names.
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
