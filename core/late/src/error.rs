//! Why a text or its numbers can't be used.

use thiserror::Error;

/// A mistake of a text, where it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// What is wrong, then what to write.
    pub message: String,
    /// The line, from one; zero where a mistake has no place.
    pub line: usize,
    /// The column, from one.
    pub column: usize,
}

/// Why a text or its numbers can't be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum LateError {
    /// The text has mistakes.
    #[error("{}", listed(.0))]
    Mistakes(Vec<Mistake>),
    /// The text is longer than the given number of bytes.
    #[error("the text is longer than {0} bytes")]
    TooLong(usize),
    /// To derive it takes too long: it was given up.
    #[error("this takes too long to be derived: declare parts as terms of their own, and add them")]
    TooMuchWork,
    /// As many declarations are kept as may be, see [`kept`](crate::kept).
    #[error("{0} declarations are kept already: declare each text once")]
    TooMany(usize),
    /// The step has more operations or numbers than an interpreter has names for.
    #[error("the step of this declaration is too large to be interpreted")]
    TooLarge,
    /// It takes a function that the library doesn't have: one of these families of a higher order.
    #[error("a step of this declaration needs {0}, and there is none of this order")]
    Function(String),
    /// The program couldn't be made for this machine, and why.
    #[error("no machine code can be made: {0}")]
    Machine(String),
    /// A step of it isn't written in C, and why.
    #[error("{0}")]
    C(&'static str),
    /// It is a sum of no declarations.
    #[error("a sum has a declaration at least")]
    Nothing,
    /// It is a sum of a declaration with a pace, whose energy is that of all terms.
    #[error("a Lagrangian with a pace has all its terms in its text")]
    Pace,
    /// The derivatives of its steps weren't asked for.
    #[error(
        "the derivatives of the steps weren't derived: write the word `gradients` into the declaration, of each term"
    )]
    NoGradients,
    /// The declaration is on another group.
    #[error("the declaration is on {declared}: take that group")]
    Group {
        /// The group of the declaration.
        declared: String,
    },
    /// Another type carries what is advected or given.
    #[error("the declaration has {declared}: take a type that carries these")]
    Advected {
        /// What is declared.
        declared: String,
    },
    /// The declaration has no kinetic part, or one of another kind.
    #[error("the declaration is `{declared}`: take this kinetic part")]
    Kinetic {
        /// The kind of the declaration.
        declared: &'static str,
    },
    /// There is no parameter of this name.
    #[error("there is no parameter `{name}`; there are {known}")]
    Unknown {
        /// The name.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// A parameter has another number of numbers.
    #[error("`{name}` has {expected} numbers, and {found} were given")]
    Size {
        /// The name.
        name: String,
        /// How many there are to be.
        expected: usize,
        /// How many were given.
        found: usize,
    },
}

/// The mistakes, one a line.
fn listed(mistakes: &[Mistake]) -> String {
    let lines = mistakes.iter().map(|Mistake { message, line, column }| format!("{line}:{column}: {message}"));
    lines.collect::<Vec<_>>().join("\n")
}
