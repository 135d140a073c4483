//! A declaration as programs: what a library runs that reads a Lagrangian while it runs itself.
//!
//! The stages are those that an expansion emits, made of the same kernel: whoever runs them operation by operation has
//! the bits of the compiled step. Numbers come in arrays: those of a matrix row by row, of several things one after the
//! other, in the order of the declaration.
//!
//! Deliberately not here: any mathematical decision, and how a program is run. The room knows all below itself.

mod build;
mod sources;

use proc_macro2::TokenStream;

use crate::declared::errors::{Errors, Mistake};
use crate::declared::{Declaration, Role, parse};
use crate::expand::{self, Judgement};
pub use crate::mathematics::symbolic::Function;
use crate::mathematics::symbolic::work;

/// Straight-line code on numbers. Registers hold the inputs, then the literals, then the result of each operation.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// Where the inputs come from.
    pub inputs: Vec<Source>,
    /// The numbers of the declaration.
    pub literals: Vec<f64>,
    /// In the order in which they are made.
    pub operations: Vec<Operation>,
    /// The registers of the results.
    pub outputs: Vec<u32>,
}

/// An array of numbers that inputs are read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Array {
    /// The step `h`.
    Step,
    /// The numbers of the parameters.
    Parameters,
    /// What the constants' program has computed.
    Constants,
    /// What is advected or given, `w`.
    Advected,
    /// The same after the step, `w⁺`.
    Next,
    /// The increment `F`.
    Element,
    /// `F − I`.
    Increment,
    /// `F⁻¹`.
    Inverse,
    /// `F⁻¹ − I`.
    InverseIncrement,
    /// Half the coordinates of `F`.
    Half,
    /// The velocity.
    Velocity,
    /// The right side `a` of the momentum equation.
    Target,
}

impl Array {
    /// How many there are.
    pub const COUNT: usize = 12;

    /// Each of them, in order.
    #[rustfmt::skip]
    pub const ALL: [Self; Self::COUNT] = [
        Self::Step, Self::Parameters, Self::Constants, Self::Advected, Self::Next, Self::Element, Self::Increment,
        Self::Inverse, Self::InverseIncrement, Self::Half, Self::Velocity, Self::Target,
    ];
}

/// The place of a number in an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Source {
    /// The array.
    pub array: Array,
    /// From zero.
    pub at: usize,
}

impl Source {
    /// The place `at` of an array.
    #[must_use]
    pub const fn new(array: Array, at: usize) -> Self {
        Self { array, at }
    }
}

/// One operation: on registers, on values that stand for them, or, where its kind alone counts, on `()`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // their names say it
pub enum Operation<R = u32> {
    Negate(R),
    Add(R, R),
    Subtract(R, R),
    Multiply(R, R),
    Divide(R, R),
    /// A function of one number.
    Apply(Function, R),
}

impl<R: Copy> Operation<R> {
    /// What it reads; the only one twice.
    #[must_use]
    pub fn read(self) -> [R; 2] {
        match self {
            Self::Negate(a) | Self::Apply(_, a) => [a, a],
            Self::Add(a, b) | Self::Subtract(a, b) | Self::Multiply(a, b) | Self::Divide(a, b) => [a, b],
        }
    }

    /// The same operation on others; on the first of them alone, if it reads one.
    #[must_use]
    pub fn of<S>(self, [a, b]: [S; 2]) -> Operation<S> {
        match self {
            Self::Negate(_) => Operation::Negate(a),
            Self::Add(..) => Operation::Add(a, b),
            Self::Subtract(..) => Operation::Subtract(a, b),
            Self::Multiply(..) => Operation::Multiply(a, b),
            Self::Divide(..) => Operation::Divide(a, b),
            Self::Apply(function, _) => Operation::Apply(function, a),
        }
    }
}

impl Operation {
    /// The registers that it reads; the only one twice.
    #[must_use]
    pub fn operands(self) -> [usize; 2] {
        self.read().map(|register| register as usize)
    }
}

/// A field of the struct.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// What its type promises.
    pub kind: ParameterKind,
}

/// The type of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    /// A number.
    Scalar,
    /// A vector with this many rows; a point is stored without its last coordinate, which is one.
    Vector(usize),
    /// A square matrix with this many rows.
    Matrix(usize),
    /// A symmetric matrix of three rows, `NonstandardInertia` or `Inertia`.
    Inertia,
    /// The diagonal of one.
    DiagonalInertia,
}

impl ParameterKind {
    /// Rows and columns of what is stored.
    #[must_use]
    pub const fn shape(self) -> (usize, usize) {
        match self {
            Self::Scalar => (1, 1),
            Self::Vector(rows) => (rows, 1),
            Self::Matrix(rows) => (rows, rows),
            Self::Inertia => (3, 3),
            Self::DiagonalInertia => (3, 1),
        }
    }

    /// How many numbers are stored.
    #[must_use]
    pub const fn len(self) -> usize {
        let (rows, columns) = self.shape();
        rows * columns
    }

    /// Whether none are.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.len() == 0
    }
}

/// What is advected or given, by how increments move it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Carried {
    /// The field with its value in space; none of a configuration, which is the identity there.
    pub field: Option<usize>,
    /// How it is moved.
    pub action: Action,
    /// Rows and columns of what is stored.
    pub shape: (usize, usize),
}

/// How an increment moves a parameter. Factors of a product are counted from zero; a group that isn't one is its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // as the types of liestep
pub enum Action {
    Covector(usize),
    Contravariant(usize),
    Point(usize),
    ContravariantTensor(usize),
    CovariantTensor(usize),
    MixedTensor(usize),
    /// The configuration of a factor as another sees it.
    Relative {
        of: usize,
        from: usize,
    },
    /// The configuration of a factor in space.
    Configuration(usize),
    /// Not at all.
    Given,
}

/// A factor of the group.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    /// Its name.
    pub name: String,
    /// The generators, each row by row.
    pub generators: Vec<Vec<f64>>,
}

/// The programs of a declaration, or what is made of each.
#[derive(Clone, Debug, PartialEq)]
pub struct Stages<P> {
    /// What the parameters and `h` determine.
    pub constants: P,
    /// As the methods of `Effect`.
    pub kick_before: P,
    /// Residual, then Jacobian. What `a` and `w` determine is computed in each iteration: to hand it on would take as long.
    pub newton_system: P,
    /// The residual; behind it the moving kick, where the solve does better without the Jacobian.
    pub newton_residual: P,
    /// `Ad*_F` of the diamond with `F`.
    pub kick_after: P,
    /// The derivative of the kick before along a velocity.
    pub kick_derivative: Option<P>,
    /// Along `exp(t E_j) F`.
    pub momentum_jacobian: P,
    /// Inertia, bias and potential.
    pub at_rest: P,
    /// The continuous limit at a velocity, where it isn't quadratic: `l`, momentum and Hessian.
    pub at_velocity: Option<[P; 3]>,
    /// Of a Lagrangian, by `F`, `w` and `h`: `l_d`, right and left momentum, diamond, `legendre_minus` and discrete energy.
    pub lagrangian: Option<[P; 6]>,
}

impl<P> Stages<P> {
    /// What is made of each.
    ///
    /// # Errors
    ///
    /// The first.
    pub fn try_map<'a, Q, E>(&'a self, mut make: impl FnMut(&'a P) -> Result<Q, E>) -> Result<Stages<Q>, E> {
        Ok(Stages {
            constants: make(&self.constants)?,
            kick_before: make(&self.kick_before)?,
            newton_system: make(&self.newton_system)?,
            newton_residual: make(&self.newton_residual)?,
            kick_after: make(&self.kick_after)?,
            kick_derivative: self.kick_derivative.as_ref().map(&mut make).transpose()?,
            momentum_jacobian: make(&self.momentum_jacobian)?,
            at_rest: make(&self.at_rest)?,
            at_velocity: match &self.at_velocity {
                Some([l, momentum, hessian]) => Some([make(l)?, make(momentum)?, make(hessian)?]),
                None => None,
            },
            lagrangian: match &self.lagrangian {
                Some([l_d, right, left, diamond, minus, energy]) => {
                    Some([make(l_d)?, make(right)?, make(left)?, make(diamond)?, make(minus)?, make(energy)?])
                }
                None => None,
            },
        })
    }
}

/// A declaration with the programs of its step.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::struct_excessive_bools)] // facts that have nothing to do with each other
pub struct StagedDeclaration {
    /// The name of the struct.
    pub name: String,
    /// What was declared.
    pub role: Role,
    /// The factors of the group.
    pub factors: Vec<Factor>,
    /// The fields.
    pub parameters: Vec<Parameter>,
    /// What is advected or given.
    pub carried: Vec<Carried>,
    /// Where there is a pace, which of these is the energy `E_0`.
    pub energy: Option<usize>,
    /// What was derived, as text.
    pub derivation: String,
    /// Whether there is a kinetic part.
    pub has_kinetic: bool,
    /// Whether a solve does better without the Jacobian.
    pub is_expensive: bool,
    /// Whether the unknown part, the kick before and that after aren't zero.
    pub parts: [bool; 3],
    /// The power of `1 + |y|²` that the Newton system is multiplied by.
    pub denominators: u32,
    /// Whether the inertia is the same everywhere.
    pub has_constant_inertia: bool,
    /// Whether the continuous limit is quadratic in the velocity.
    pub is_quadratic: bool,
    /// Whether a step of `−h` undoes one of `h`.
    pub is_self_adjoint: bool,
    /// Whether the Newton system is written in `F − I`, so that the retraction brings its Jacobian to coordinates.
    pub in_increment: bool,
    /// The components at which the Jacobian falls into blocks.
    pub blocks: Vec<usize>,
    /// The programs.
    pub programs: Stages<Program>,
    /// Where they are asked for, the derivatives of a step by `F − I`, `w` and `h`, as `SecondDerivatives` has them: the
    /// blocks; matrix and right side of the adjoint's system, with `p` in the array of the velocity; its gradient by the
    /// place and by `w`, with `u` in that of the target; and both momenta by each number of `w`.
    pub derivatives: Option<[Program; 4]>,
}

/// Why nothing was derived.
#[derive(Clone, Debug)]
pub enum Refusal {
    /// All mistakes of the declaration.
    Mistakes(Vec<Mistake>),
    /// It would take more work than it may.
    TooMuchWork,
}

/// What a derivation may take that answers within a second: four times as much as the largest of the repository.
pub const MOST_WORK: u64 = 1_000_000;

/// Derives a struct with `#[lagrangian(…)]` or `#[force(…)]` and proves what was derived, as the macro does, but with no
/// more than this work: products of terms, terms that become programs, and their operations. Beside it stands how much it took.
///
/// # Errors
///
/// Its mistakes; or it takes more.
pub fn staged(text: &TokenStream, most: u64) -> Result<(StagedDeclaration, u64), Refusal> {
    let mut errors = Errors::default();
    let (found, work) = work::within(most, || of_text(text, &mut errors)).ok_or(Refusal::TooMuchWork)?;
    match found {
        Some(staged) if errors.is_empty() => Ok((staged, work)),
        _ => Err(Refusal::Mistakes(errors.mistakes())),
    }
}

fn of_text(text: &TokenStream, errors: &mut Errors) -> Option<StagedDeclaration> {
    let (role, arguments, item) = parse::attribute_and_item(text, errors)?;
    let declaration = parse::declaration(role, &arguments, &item, errors)?;
    let declaration = Declaration { is_text: true, ..declaration };
    match expand::judged(&declaration, errors)? {
        Judgement::Steps(steps) => Some(build::staged(&declaration, &steps)),
        Judgement::Continuous(_) | Judgement::Constraint(_) => {
            errors.push(declaration.item.ident.span(), "without `discretise = …` there are no steps: add it");
            None
        }
    }
}
