//! Errors of texts and of their numbers.

use liestep_derivation::whole::StepRefusal;
use thiserror::Error;

/// A mistake of a text, with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// The mistake, then what to write.
    pub message: String,
    /// The line, from one; zero for a mistake without a place.
    pub line: usize,
    /// The column, from one.
    pub column: usize,
}

/// An error of a text or of its numbers.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum LateError {
    /// The text has mistakes.
    #[error("{}", listed(.0))]
    Mistakes(Vec<Mistake>),
    /// The text is longer than the given number of bytes.
    #[error("the text is longer than {0} bytes")]
    TooLong(usize),
    /// The derivation takes too long, and was given up.
    #[error("this takes too long to be derived: declare parts as terms of their own, and add them")]
    TooMuchWork,
    /// The limit of stored declarations is reached, see [`kept`](crate::kept).
    #[error("{0} declarations are kept already: declare each text once")]
    TooMany(usize),
    /// The step has more operations or numbers than an interpreter has names for.
    #[error("the step of this declaration is too large to be interpreted")]
    TooLarge,
    /// The step needs a function that the library doesn't have: one of these families of a higher order.
    #[error("a step of this declaration needs {0}, and there is none of this order")]
    Function(String),
    /// Machine code can't be generated, for this reason.
    #[error("no machine code can be made: {0}")]
    Machine(String),
    /// The declaration has no step as programs, for this reason.
    #[error(transparent)]
    Step(#[from] StepRefusal),
    /// The text of a step with compensated sums isn't written beside this.
    #[error("sums aren't compensated beside {beside}: take a text without compensated sums")]
    Compensated {
        /// The part of the declaration beside which there are no such sums.
        beside: &'static str,
    },
    /// The sum has no declarations.
    #[error("a sum has a declaration at least")]
    Nothing,
    /// The sum has a declaration with a pace, whose energy is that of all terms.
    #[error("a Lagrangian with a pace has all its terms in its text")]
    Pace,
    /// The sum has a Hamiltonian.
    #[error("a Hamiltonian has all its terms in its text, and no Lagrangian or force beside it")]
    Hamiltonian,
    /// The declaration is on another group.
    #[error("the declaration is on {declared}: take that group")]
    Group {
        /// The group of the declaration.
        declared: String,
    },
    /// No parameter has this name.
    #[error("there is no parameter `{name}`; there are {known}")]
    Unknown {
        /// The name.
        name: String,
        /// The known names.
        known: String,
    },
    /// A parameter has another count of numbers.
    #[error("`{name}` has {expected} numbers, and {found} were given")]
    Size {
        /// The name.
        name: String,
        /// The expected count.
        expected: usize,
        /// The count that was passed.
        found: usize,
    },
}

/// The mistakes, one a line.
fn listed(mistakes: &[Mistake]) -> String {
    let lines = mistakes.iter().map(|Mistake { message, line, column }| format!("{line}:{column}: {message}"));
    lines.collect::<Vec<_>>().join("\n")
}
