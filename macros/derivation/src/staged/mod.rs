//! A declaration as programs, for a library that reads Lagrangians at run time.
//!
//! The stages are those that an expansion emits, from the same kernel: running them operation by operation gives the
//! bits of the compiled step. Numbers are in arrays: those of a matrix by rows, and those of several parameters one
//! after the other, in the order of the declaration.
//!
//! Deliberately not here: any mathematical decision, and the execution of a program. The room knows all below itself.

mod build;
mod constraints;
mod sources;

use proc_macro2::TokenStream;

use crate::declared::errors::{Errors, Mistake};
use crate::declared::{Declaration, Role, parse};
use crate::expand::{self, Judgement};
use crate::mathematics::symbolic::work;
pub use crate::mathematics::symbolic::{Function, Variance};
pub(crate) use constraints::Constants;
pub use constraints::{Constraint, Constraints};

/// Straight-line code on numbers. Registers hold the inputs, then the literals, then the result of each operation.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// The places of the inputs.
    pub inputs: Vec<Source>,
    /// The constants of the declaration.
    pub literals: Vec<f64>,
    /// The operations, in the order of execution.
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
    /// The results of the constants' program.
    Constants,
    /// The advected and given parameters, `w`.
    Advected,
    /// The advected and given parameters after the step, `w⁺`.
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
    /// The attitude, or the configuration.
    Attitude,
    /// The momentum.
    Momentum,
    /// Half the coordinates of the last increment, and their difference to those before.
    History,
    /// The determinants of a Jacobian, and its factors.
    Factors,
}

impl Array {
    /// The number of arrays.
    pub const COUNT: usize = 16;

    /// All arrays, in order.
    #[rustfmt::skip]
    pub const ALL: [Self; Self::COUNT] = [
        Self::Step, Self::Parameters, Self::Constants, Self::Advected, Self::Next, Self::Element, Self::Increment,
        Self::Inverse, Self::InverseIncrement, Self::Half, Self::Velocity, Self::Target, Self::Attitude, Self::Momentum,
        Self::History, Self::Factors,
    ];
}

/// The place of a number in an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Source {
    /// The array.
    pub array: Array,
    /// The index, from zero.
    pub at: usize,
}

impl Source {
    /// The place `at` of an array.
    #[must_use]
    pub const fn new(array: Array, at: usize) -> Self {
        Self { array, at }
    }
}

/// One operation: on registers, on values in their place, or on `()`, if only its kind counts.
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
    /// The operands; a single one twice.
    #[must_use]
    pub fn read(self) -> [R; 2] {
        match self {
            Self::Negate(a) | Self::Apply(_, a) => [a, a],
            Self::Add(a, b) | Self::Subtract(a, b) | Self::Multiply(a, b) | Self::Divide(a, b) => [a, b],
        }
    }

    /// The operation on other operands, or on the first of them alone, if it has one.
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
    /// The registers of the operands; a single one twice.
    #[must_use]
    pub fn operands(self) -> [usize; 2] {
        self.read().map(|register| register as usize)
    }
}

/// A field of the struct.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name of the field.
    pub name: String,
    /// The type of the field's value.
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
    /// A diagonal inertia, by its diagonal.
    DiagonalInertia,
}

impl ParameterKind {
    /// The rows and columns of the stored value.
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

    /// The number of stored entries.
    #[must_use]
    pub const fn len(self) -> usize {
        let (rows, columns) = self.shape();
        rows * columns
    }

    /// Whether no entries are stored.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.len() == 0
    }
}

/// An advected or given parameter, by the action of increments on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Carried {
    /// The field with its value in space; `None` for a configuration, whose value there is the identity.
    pub field: Option<usize>,
    /// The action of an increment.
    pub action: Action,
    /// The rows and columns of the stored value.
    pub shape: (usize, usize),
}

/// The action of an increment on a parameter. Factors of a product are counted from zero; any other group is one
/// factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // as the types of liestep
pub enum Action {
    Moved(Variance, usize),
    Point(usize),
    /// The configuration of a factor relative to another.
    Relative {
        of: usize,
        from: usize,
    },
    /// The configuration of a factor in space.
    Configuration(usize),
    /// A parameter prescribed for each step, on which the group doesn't act.
    Given,
}

/// A factor of the group.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    /// Name of the advected parameter.
    pub name: String,
    /// The generators, each by rows.
    pub generators: Vec<Vec<f64>>,
}

/// The programs of a declaration, or their images under a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Stages<P> {
    /// The values that depend on the parameters and `h` alone.
    pub constants: P,
    /// The kick before the solve, as in `Effect`.
    pub kick_before: P,
    /// The residual, then the Jacobian. Values of `a` and `w` are computed again in each iteration, which takes no
    /// longer than passing them on.
    pub newton_system: P,
    /// The residual.
    pub newton_residual: P,
    /// `Ad*_F` of the diamond with `F`.
    pub kick_after: P,
    /// The derivative of the kick before along a velocity.
    pub kick_derivative: Option<P>,
    /// The Jacobian of the momentum along `exp(t E_j) F`.
    pub momentum_jacobian: P,
    /// The inertia, the bias and the potential at rest.
    pub at_rest: P,
    /// The continuous limit at a velocity, if it isn't quadratic: `l`, momentum and Hessian. Of a Hamiltonian `h`, velocity and
    /// Hessian at a momentum, in the array of velocities.
    pub at_velocity: Option<[P; 3]>,
    /// The terms of a Lagrangian by `F`, `w` and `h`: `l_d`, right and left momentum, diamond, `legendre_minus` and
    /// discrete energy.
    pub lagrangian: Option<[P; 6]>,
}

impl<P> Stages<P> {
    /// Maps all programs.
    ///
    /// # Errors
    ///
    /// The first error of the map.
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
    /// The kind of the declaration.
    pub role: Role,
    /// The factors of the group.
    pub factors: Vec<Factor>,
    /// The fields.
    pub parameters: Vec<Parameter>,
    /// The advected and given parameters.
    pub carried: Vec<Carried>,
    /// The index of the energy `E_0` among the advected and given parameters, if there is a pace.
    pub energy: Option<usize>,
    /// The derivation as text.
    pub derivation: String,
    /// Whether there is a kinetic part.
    pub has_kinetic: bool,
    /// Whether there is a force, of which no Lagrangian is the limit.
    pub has_force: bool,
    /// Whether the unknown part, the kick before the solve and the kick after it are nonzero.
    pub parts: [bool; 3],
    /// The power of `1 + |y|²` that the Newton system is multiplied by.
    pub denominators: u32,
    /// Whether the inertia doesn't depend on the parameters `w`.
    pub has_constant_inertia: bool,
    /// Whether the continuous limit is quadratic in the velocity.
    pub is_quadratic: bool,
    /// Whether a step of `−h` undoes one of `h`.
    pub is_self_adjoint: bool,
    /// Whether the Newton system is written in `F − I`, so that the retraction transforms its Jacobian to coordinates.
    pub in_increment: bool,
    /// The components at which the Jacobian falls into blocks.
    pub blocks: Vec<usize>,
    /// The constraints on velocities.
    pub constraints: Constraints,
    /// The programs.
    pub programs: Stages<Program>,
}

/// The reason why nothing was derived.
#[derive(Clone, Debug)]
pub enum Refusal {
    /// All mistakes of the declaration.
    Mistakes(Vec<Mistake>),
    /// The derivation exceeds the limit on work.
    TooMuchWork,
}

/// The limit on work, for an answer within some seconds: a kinetic energy of twelve velocities on the affine maps of space,
/// by the Cayley map, takes three quarters of it.
pub const MOST_WORK: u64 = 6_000_000;

/// Derives a struct with `#[lagrangian(…)]`, `#[force(…)]`, `#[nonholonomic(…)]` or `#[hamiltonian(…)]` and verifies the derivation, as the macro does, within a
/// limit on work: products of terms, terms that become programs, and their operations. Returns also the work done.
///
/// # Errors
///
/// The mistakes of the declaration, or an excess of work.
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
    // The tangent map of a whole step is written from its programs, so no derivatives are derived.
    let declaration = Declaration { is_text: true, gradients: None, ..declaration };
    match expand::judged(&declaration, errors)? {
        Judgement::Steps(steps) => Some(build::staged(&declaration, &steps)),
        Judgement::Continuous(equations) if role == Role::Hamiltonian => {
            Some(build::hamiltonian(&declaration, &equations))
        }
        Judgement::Continuous(_) | Judgement::Constraint(_) => {
            errors.push(declaration.item.ident.span(), "without `discretise = …` there are no steps: add it");
            None
        }
    }
}
