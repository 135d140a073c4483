//! What a text declares, derived once.

use std::collections::BTreeMap;
use std::sync::{LazyLock, Mutex, PoisonError};

use liestep::mechanics::Parts;
use liestep_derivation::{Action, AtVelocity, Carried, Factor, Parameter, Program, Role, Staged, Terms, staged};
use proc_macro2::{LexError, TokenStream};
use thiserror::Error;

use crate::code::Code;

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
    /// As many declarations are kept as may be, see [`kept`].
    #[error("{0} declarations are kept already: declare each text once")]
    TooMany(usize),
    /// The step has more operations or numbers than an interpreter has names for.
    #[error("the step of this declaration is too large to be interpreted")]
    TooLarge,
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
        name: &'static str,
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

/// A declaration with the code of its stages. Each text is derived once and kept as long as the program runs.
#[derive(Debug)]
#[allow(clippy::struct_excessive_bools)] // facts that have nothing to do with each other
pub struct Declaration {
    /// The name of the struct.
    pub name: &'static str,
    /// What was declared.
    pub role: Role,
    /// The factors of the group.
    pub factors: Vec<Factor>,
    /// The parameters.
    pub parameters: Vec<Parameter>,
    /// What is advected or given.
    pub carried: Vec<Carried>,
    /// What was derived, as text.
    pub derivation: &'static str,
    /// Whether there is a kinetic part.
    pub has_kinetic: bool,
    /// Whether a solve does better without the Jacobian.
    pub is_expensive: bool,
    /// Whether a step of `−h` undoes one of `h`.
    pub is_self_adjoint: bool,
    pub(crate) names: Vec<&'static str>,
    pub(crate) parts: Parts,
    pub(crate) denominators: u32,
    pub(crate) has_constant_inertia: bool,
    pub(crate) is_quadratic: bool,
    pub(crate) in_increment: bool,
    pub(crate) constants: Code,
    pub(crate) terms: Code,
    pub(crate) kick_before: Code,
    pub(crate) newton_system: Code,
    pub(crate) newton_residual: Code,
    pub(crate) kick_after: Code,
    pub(crate) kick_derivative: Option<Code>,
    pub(crate) momentum_jacobian: Code,
    pub(crate) at_rest: Code,
    pub(crate) at_velocity: Option<[Code; 3]>,
    pub(crate) lagrangian: Option<Lagrangian>,
}

/// The derived terms of a Lagrangian.
#[derive(Debug)]
pub(crate) struct Lagrangian {
    pub(crate) l_d: Code,
    pub(crate) right_momentum: Code,
    pub(crate) left_momentum: Code,
    pub(crate) diamond: Code,
    pub(crate) legendre_minus: Code,
    pub(crate) discrete_energy: Code,
}

/// A longer text is no Lagrangian that a person has typed.
const LONGEST: usize = 64 * 1024;
/// A large declaration is kept in some 100 kB.
const MOST: usize = 10_000;

/// The declarations of the program, by their texts.
static KEPT: LazyLock<Mutex<BTreeMap<String, &'static Declaration>>> = LazyLock::new(Mutex::default);

/// How many declarations are kept. A text is derived and kept once, however often it is declared; a program may keep
/// 10,000.
#[must_use]
pub fn kept() -> usize {
    KEPT.lock().unwrap_or_else(PoisonError::into_inner).len()
}

impl Declaration {
    /// Derives a struct with `#[lagrangian(…)]` or `#[force(…)]`, and proves what was derived.
    ///
    /// # Errors
    ///
    /// The mistakes of the text, each with its line and column, or why it can't be kept.
    pub fn parse(text: &str) -> Result<&'static Self, LateError> {
        if text.len() > LONGEST {
            return Err(LateError::TooLong(LONGEST));
        }
        let known = || KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(declaration) = known().get(text) {
            return Ok(declaration);
        }
        if known().len() >= MOST {
            return Err(LateError::TooMany(MOST));
        }
        let tokens: TokenStream = text.parse().map_err(|error: LexError| {
            let place = error.span().start();
            let message = "a bracket isn't closed or opened, or a sign has no meaning here".to_owned();
            LateError::Mistakes(vec![Mistake { message, line: place.line, column: place.column + 1 }])
        })?;
        let found = staged(&tokens).map_err(|mistakes| {
            let placed = mistakes.into_iter().map(|mistake| {
                let place = mistake.span.start();
                Mistake { message: mistake.message, line: place.line, column: place.column + 1 }
            });
            LateError::Mistakes(placed.collect())
        });
        drop(tokens);
        // What the tokens' places are found by would be kept, too.
        proc_macro2::extra::invalidate_current_thread_spans();
        let declaration = Self::of(found?).ok_or(LateError::TooLarge)?;
        let declaration: &'static Self = Box::leak(Box::new(declaration));
        Ok(known().entry(text.to_owned()).or_insert(declaration))
    }

    fn of(staged: Staged) -> Option<Self> {
        let [unknown, kick_before, kick_after] = staged.parts;
        let code = |program: &Program| Code::of(program);
        let at_velocity = match &staged.at_velocity {
            Some(AtVelocity { l, momentum, hessian }) => Some([code(l)?, code(momentum)?, code(hessian)?]),
            None => None,
        };
        let lagrangian = match &staged.lagrangian {
            Some(terms) => Some(Lagrangian::of(terms)?),
            None => None,
        };
        Some(Self {
            name: leaked(staged.name),
            role: staged.role,
            factors: staged.factors,
            names: staged.parameters.iter().map(|parameter| leaked(parameter.name.clone())).collect(),
            parameters: staged.parameters,
            carried: staged.carried,
            derivation: leaked(staged.derivation),
            has_kinetic: staged.has_kinetic,
            is_expensive: staged.is_expensive,
            is_self_adjoint: staged.is_self_adjoint,
            parts: Parts { unknown, kick_before, kick_after },
            denominators: staged.denominators,
            has_constant_inertia: staged.has_constant_inertia,
            is_quadratic: staged.is_quadratic,
            in_increment: staged.in_increment,
            constants: code(&staged.constants)?,
            terms: code(&staged.terms)?,
            kick_before: code(&staged.kick_before)?,
            newton_system: code(&staged.newton_system)?,
            newton_residual: code(&staged.newton_residual)?,
            kick_after: code(&staged.kick_after)?,
            kick_derivative: match &staged.kick_derivative {
                Some(program) => Some(code(program)?),
                None => None,
            },
            momentum_jacobian: code(&staged.momentum_jacobian)?,
            at_rest: code(&staged.at_rest)?,
            at_velocity,
            lagrangian,
        })
    }

    /// The kinetic part, as its type is called.
    #[must_use]
    pub const fn kinetic(&self) -> &'static str {
        match (self.has_kinetic, self.is_expensive) {
            (false, _) => "WithoutKinetic",
            (true, false) => "WithKinetic",
            (true, true) => "WithExpensiveKinetic",
        }
    }

    /// The group, as it is written.
    #[must_use]
    pub fn group(&self) -> String {
        let names: Vec<&str> = self.factors.iter().map(|factor| factor.name.as_str()).collect();
        if names.len() == 1 { names.concat() } else { format!("({})", names.join(", ")) }
    }

    /// The first of a parameter's numbers among those of all, and how many it has.
    pub(crate) fn place(&self, index: usize) -> (usize, usize) {
        let lengths = || self.parameters.iter().map(|parameter| parameter.kind.len());
        (lengths().take(index).sum(), lengths().nth(index).unwrap_or(0))
    }

    /// Actions with shapes, as a type of advected parameters lists them.
    pub(crate) fn slots(&self) -> Vec<(Action, (usize, usize))> {
        self.carried.iter().map(|carried| (carried.action, carried.shape)).collect()
    }
}

impl Lagrangian {
    fn of(terms: &Terms) -> Option<Self> {
        Some(Self {
            l_d: Code::of(&terms.l_d)?,
            right_momentum: Code::of(&terms.right_momentum)?,
            left_momentum: Code::of(&terms.left_momentum)?,
            diamond: Code::of(&terms.diamond)?,
            legendre_minus: Code::of(&terms.legendre_minus)?,
            discrete_energy: Code::of(&terms.discrete_energy)?,
        })
    }
}

/// Kept as long as the declaration, which is as long as the program runs.
fn leaked(text: String) -> &'static str {
    Box::leak(text.into_boxed_str())
}
