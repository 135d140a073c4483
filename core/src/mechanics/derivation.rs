//! The derivation of an effect as a text.

use alloc::string::String;
use alloc::vec::Vec;

use crate::mechanics::description::SceneVisitor;
use crate::mechanics::effect::Effect;

/// The derivation of an effect, and of a sum those of all its terms, each once: constants can't be concatenated.
#[must_use]
pub fn derivation<E: Effect>(effect: &E) -> String {
    let mut texts = Texts(Vec::new());
    effect.describe(&mut texts);
    texts.0.join("\n")
}

struct Texts(Vec<&'static str>);

impl<T> SceneVisitor<T> for Texts {
    fn term(&mut self, derivation: &'static str) {
        if !self.0.contains(&derivation) {
            self.0.push(derivation);
        }
    }

    fn parameter(&mut self, _: &'static str, _: T) {}
}
