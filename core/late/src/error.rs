//! Why a text or its numbers can't be used.

use std::fmt;

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
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LateError {
    /// The text has mistakes.
    Mistakes(Vec<Mistake>),
    /// The text is longer than the given number of bytes.
    TooLong(usize),
    /// To derive it takes too long: it was given up.
    TooMuchWork,
    /// As many declarations are kept as may be, see [`kept`].
    TooMany(usize),
    /// The step has more operations or numbers than an interpreter has names for.
    TooLarge,
    /// It takes a function that the library doesn't have: one of these families of a higher order.
    Function(String),
    /// The program couldn't be made for this machine, and why.
    Machine(String),
    /// A step of it isn't written in C, and why.
    C(&'static str),
    /// The declaration is on another group.
    Group {
        /// The group of the declaration.
        declared: String,
    },
    /// Another type carries what is advected or given.
    Advected {
        /// What is declared.
        declared: String,
    },
    /// The declaration has no kinetic part, or one of another kind.
    Kinetic {
        /// The kind of the declaration.
        declared: &'static str,
    },
    /// There is no parameter of this name.
    Unknown {
        /// The name.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// A parameter has another number of numbers.
    Size {
        /// The name.
        name: String,
        /// How many there are to be.
        expected: usize,
        /// How many were given.
        found: usize,
    },
}

impl fmt::Display for LateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mistakes(mistakes) => {
                for (at, Mistake { message, line, column }) in mistakes.iter().enumerate() {
                    let separator = if at == 0 { "" } else { "\n" };
                    write!(f, "{separator}{line}:{column}: {message}")?;
                }
                Ok(())
            }
            Self::TooLong(most) => write!(f, "the text is longer than {most} bytes"),
            Self::TooMuchWork => {
                f.write_str("this takes too long to be derived: declare parts as terms of their own, and add them")
            }
            Self::TooMany(most) => write!(f, "{most} declarations are kept already: declare each text once"),
            Self::TooLarge => f.write_str("the step of this declaration is too large to be interpreted"),
            Self::Function(function) => {
                write!(f, "a step of this declaration needs {function}, and there is none of this order")
            }
            Self::C(cause) => f.write_str(cause),
            Self::Machine(cause) => write!(f, "no machine code can be made: {cause}"),
            Self::Group { declared } => write!(f, "the declaration is on {declared}: take that group"),
            Self::Advected { declared } => write!(f, "the declaration has {declared}: take a type that carries these"),
            Self::Kinetic { declared } => write!(f, "the declaration is `{declared}`: take this kinetic part"),
            Self::Unknown { name, known } => write!(f, "there is no parameter `{name}`; there are {known}"),
            Self::Size { name, expected, found } => {
                write!(f, "`{name}` has {expected} numbers, and {found} were given")
            }
        }
    }
}

impl std::error::Error for LateError {}
