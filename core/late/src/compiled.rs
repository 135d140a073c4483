//! Compiled effects as texts with numbers.

use liestep::mechanics::{Effect, SceneVisitor};

use crate::declaration::Declaration;
use crate::error::LateError;

impl Declaration {
    /// The declaration of a compiled effect, derived from the text that the macro stores, and the
    /// [numbers](Self::numbers) of the effect's parameters.
    ///
    /// # Errors
    ///
    /// The effect has no text, like a sum, whose terms are added by [`sum`](Self::sum); or an error of
    /// [`parse`](Self::parse).
    pub fn like<E: Effect<Scalar = f64>>(effect: &E) -> Result<(&'static Self, Vec<f64>), LateError> {
        let declaration = Self::parse(E::DECLARATION)?;
        Ok((declaration, declaration.described(&numbers(effect))?))
    }
}

/// The numbers of an effect, as it describes them: those of all parameters of its declaration, in their order, a diagonal
/// inertia by its tensor. [`Declaration::described`] makes those of a declaration of them.
#[must_use]
pub fn numbers<E: Effect<Scalar = f64>>(effect: &E) -> Vec<f64> {
    let mut numbers = Numbers(Vec::new());
    effect.describe(&mut numbers);
    numbers.0
}

struct Numbers(Vec<f64>);

impl SceneVisitor<f64> for Numbers {
    fn term(&mut self, _: &str) {}

    fn parameter(&mut self, _: &str, value: f64) {
        self.0.push(value);
    }
}
