//! The representations of the group on advected parameters.

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
    /// The trivial representation, for parameters that are prescribed for each step.
    Fixed,
}

impl Variance {
    /// Whether the parameter is a matrix.
    pub fn is_tensor(self) -> bool {
        matches!(self, Self::Contravariant | Self::Covariant | Self::Mixed)
    }
}
