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
use crate::expand::{self, Judged};

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
    pub outputs: Vec<usize>,
}

/// An array, and the place in it, that an input is read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Source {
    /// The step `h`.
    Step,
    /// A number of the parameters.
    Parameter(usize),
    /// What the constants' program has computed.
    Constant(usize),
    /// What the program of the step's terms has computed.
    Term(usize),
    /// What is advected or given, `w`.
    Advected(usize),
    /// The same after the step, `w⁺`.
    Next(usize),
    /// The increment `F`.
    Element(usize),
    /// `F − I`.
    Increment(usize),
    /// `F⁻¹`.
    Inverse(usize),
    /// `F⁻¹ − I`.
    InverseIncrement(usize),
    /// Half the coordinates of `F`.
    Half(usize),
    /// The velocity.
    Velocity(usize),
    /// The right side `a` of the momentum equation.
    Target(usize),
}

/// One operation on registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // their names say it
pub enum Operation {
    Negate(usize),
    Add(usize, usize),
    Subtract(usize, usize),
    Multiply(usize, usize),
    Divide(usize, usize),
    Sqrt(usize),
    Ln(usize),
    Exp(usize),
    Sin(usize),
    Cos(usize),
    /// `c_k`, with `cos √q = 1 − q c_2(q)` and so on.
    Stumpff(u8, usize),
    /// The derivative of this order of `θ/sin θ` by `sin²(θ/2)`.
    LogRatio(u8, usize),
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

/// The derived terms of a discrete Lagrangian, by `F`, `w` and `h`.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // as the methods of `DiscreteLagrangian`
pub struct Terms {
    pub l_d: Program,
    pub right_momentum: Program,
    pub left_momentum: Program,
    pub diamond: Program,
    pub legendre_minus: Program,
    pub discrete_energy: Program,
}

/// The continuous limit at a velocity, where it isn't quadratic.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // as the fields of `Limit`
pub struct AtVelocity {
    pub l: Program,
    pub momentum: Program,
    pub hessian: Program,
}

/// A declaration with the programs of its step.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::struct_excessive_bools)] // facts that have nothing to do with each other
pub struct Staged {
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
    /// What the parameters and `h` determine.
    pub constants: Program,
    /// What `a` and `w` determine: at most [`MOST_TERMS`]; iterations compute the others anew.
    pub terms: Program,
    /// The stages, as methods of `Effect`.
    pub kick_before: Program,
    /// Residual, then Jacobian.
    pub newton_system: Program,
    /// The residual; behind it the moving kick, where the solve does better without the Jacobian.
    pub newton_residual: Program,
    /// `Ad*_F` of the diamond with `F`.
    pub kick_after: Program,
    /// The derivative of the kick before along a velocity.
    pub kick_derivative: Option<Program>,
    /// Along `exp(t E_j) F`.
    pub momentum_jacobian: Program,
    /// Inertia, bias and potential.
    pub at_rest: Program,
    /// Where the limit isn't quadratic.
    pub at_velocity: Option<AtVelocity>,
    /// Of a Lagrangian.
    pub lagrangian: Option<Terms>,
}

/// What is handed to the iterations of a step.
pub const MOST_TERMS: usize = 64;

/// Derives a struct with `#[lagrangian(…)]` or `#[force(…)]` and proves what was derived, as the macro does.
///
/// # Errors
///
/// All mistakes of the declaration.
pub fn staged(text: &TokenStream) -> Result<Staged, Vec<Mistake>> {
    let mut errors = Errors::default();
    let found = of_text(text, &mut errors);
    match found {
        Some(staged) if errors.is_empty() => Ok(staged),
        _ => Err(errors.mistakes()),
    }
}

fn of_text(text: &TokenStream, errors: &mut Errors) -> Option<Staged> {
    let (role, arguments, item) = parse::attribute_and_item(text, errors)?;
    let declaration = parse::declaration(role, &arguments, &item, errors)?;
    let declaration = Declaration { is_text: true, ..declaration };
    match expand::judged(&declaration, errors)? {
        Judged::Steps(steps) => Some(build::staged(&declaration, &steps)),
        Judged::Continuous(_) | Judged::Constraint(_) => {
            errors.push(declaration.item.ident.span(), "without `discretise = …` there are no steps: add it");
            None
        }
    }
}

#[cfg(test)]
mod tests;
