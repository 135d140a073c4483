//! What tells one scene from another.

/// Is shown what a scene is made of, by [`Effect::describe`](crate::mechanics::Effect::describe).
pub trait SceneVisitor<T> {
    /// A term begins, with this [`DERIVATION`](crate::mechanics::Effect::DERIVATION).
    fn term(&mut self, derivation: &'static str);

    /// One scalar of a field of the last term.
    fn parameter(&mut self, field: &'static str, value: T);
}
