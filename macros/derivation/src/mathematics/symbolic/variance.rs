//! How the group moves an advected parameter.

/// Vectors, covectors, and the three kinds of second rank, in the defining representation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Variance {
    /// `V`.
    Vector,
    /// `V*`, the thesis' case and the default.
    Covector,
    /// `V ⊗ V`.
    Contravariant,
    /// `V* ⊗ V*`.
    Covariant,
    /// `V ⊗ V*`.
    Mixed,
    /// Not at all: what is given for a step, in the trivial representation.
    Fixed,
}

impl Variance {
    /// Whether it is a matrix.
    pub fn is_tensor(self) -> bool {
        matches!(self, Self::Contravariant | Self::Covariant | Self::Mixed)
    }
}
