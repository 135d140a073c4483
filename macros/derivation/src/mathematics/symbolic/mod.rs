//! Mathematics on small matrix expressions; knows no token and no span.
//!
//! Every expression is a sum of terms `rational · scalars · word`, a word being a product of matrices. The constructors
//! maintain this normal form, so that equal expressions are equal values and opposite terms cancel: neighbours cancel
//! by `FᵀF = I`, traces are equal up to rotation and transposition, and declared symmetry is used.

mod cross;
mod display;
mod expression;
mod functions;
mod rational;
mod substitution;
mod symbols;
mod variance;
mod variation;
pub mod word;
pub mod work;

pub use display::{covector_text, matrix_text, text, vector_text};
pub use expression::{Atom, Expression, Monomial, degree, monomial_contains, stage_of, stage_of_monomial};
pub use functions::Function;
pub use rational::Rational;
pub use substitution::substitute;
pub use symbols::{Stage, Structure, SymbolId, Symbols};
pub use variance::{Space, Variance};
pub use variation::{Variations, variation};
pub use word::Factor;
