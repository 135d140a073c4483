//! What tells one scene from another.

/// Is shown what a scene is made of, by [`DiscreteLagrangian::describe`](crate::DiscreteLagrangian::describe).
pub trait SceneVisitor<T> {
    /// A term begins, with this [`DERIVATION`](crate::DiscreteLagrangian::DERIVATION).
    fn term(&mut self, derivation: &'static str);

    /// One scalar of a field of the last term.
    fn parameter(&mut self, field: &'static str, value: T);
}
