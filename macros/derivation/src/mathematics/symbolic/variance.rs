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

/// The space of the group's matrices, or its dual.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// `V`.
    Own,
    /// `V*`.
    Dual,
}

impl Variance {
    /// The types of fields that say how a field is moved.
    pub const TYPES: [(&str, Self); 4] = [
        ("ContravariantVector", Self::Vector),
        ("ContravariantTensor", Self::Contravariant),
        ("CovariantTensor", Self::Covariant),
        ("MixedTensor", Self::Mixed),
    ];

    /// The spaces of rows and of columns, from which all else follows.
    pub fn spaces(self) -> [Option<Space>; 2] {
        use Space::{Dual, Own};
        match self {
            Self::Vector => [Some(Own), None],
            Self::Covector => [Some(Dual), None],
            Self::Contravariant => [Some(Own); 2],
            Self::Covariant => [Some(Dual); 2],
            Self::Mixed => [Some(Own), Some(Dual)],
            Self::Fixed => [None; 2],
        }
    }

    /// The name in words.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Vector => "vector",
            Self::Covector => "covector",
            Self::Contravariant => "contravariant tensor",
            Self::Covariant => "covariant tensor",
            Self::Mixed => "mixed tensor",
            Self::Fixed => "given",
        }
    }

    /// Whether the parameter is a matrix.
    pub fn is_tensor(self) -> bool {
        self.spaces()[1].is_some()
    }

    /// The factors `A` and `B` of the moved parameter `A w B`, from the matrices of a group element and of its inverse. For an
    /// element of the algebra and its negative they are those of the terms `A w + w B`.
    pub fn sides<M: Clone>(self, [g, inverse]: [&M; 2], transposed: impl Fn(&M) -> M) -> [Option<M>; 2] {
        let [rows, columns] = self.spaces();
        let left = |space| if space == Space::Own { g.clone() } else { transposed(inverse) };
        let right = |space| if space == Space::Own { transposed(g) } else { inverse.clone() };
        [rows.map(left), columns.map(right)]
    }

    /// The moved parameter `A w B`.
    pub fn moved<M: Clone>(
        self,
        w: &M,
        by: [&M; 2],
        transposed: impl Fn(&M) -> M,
        mut times: impl FnMut(&M, &M) -> M,
    ) -> M {
        let [left, right] = self.sides(by, transposed);
        let w = left.map_or_else(|| w.clone(), |left| times(&left, w));
        match right {
            Some(right) => times(&w, &right),
            None => w,
        }
    }
}
