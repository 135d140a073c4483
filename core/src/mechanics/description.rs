//! Descriptions of scenes, by which they are distinguished.

/// The visitor of a scene's description, for [`Effect::describe`](crate::mechanics::Effect::describe).
pub trait SceneVisitor<T> {
    /// The beginning of a term, by the text of its [`DERIVATION`](crate::mechanics::Effect::DERIVATION).
    fn term(&mut self, derivation: &'static str);

    /// A scalar of a field, which belongs to the term begun last.
    fn parameter(&mut self, field: &'static str, value: T);
}
