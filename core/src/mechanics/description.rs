//! Descriptions of scenes, by which they are distinguished.

/// The visitor of a scene's description, for [`Effect::describe`](crate::mechanics::Effect::describe).
pub trait SceneVisitor<T> {
    /// The beginning of a term with this [`DERIVATION`](crate::mechanics::Effect::DERIVATION).
    fn term(&mut self, derivation: &'static str);

    /// A scalar of a field of the latest term.
    fn parameter(&mut self, field: &'static str, value: T);
}
