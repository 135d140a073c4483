//! The symbols of one declaration.

/// An index into [`Symbols`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SymbolId(pub usize);

/// The known structure of a matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Structure {
    /// No known structure.
    General,
    /// `Sᵀ = S`.
    Symmetric,
    /// Zero off the diagonal.
    Diagonal,
    /// `Aᵀ = −A`: an algebra element of an orthogonal group.
    Skew,
    /// A vector whose last entry is one.
    Point,
    /// `FᵀF = FFᵀ = I`.
    Orthogonal,
    /// `FᵀF = FFᵀ = I` and `det F = 1`.
    Rotation,
}

impl Structure {
    /// Whether `Sᵀ = S`.
    pub fn is_symmetric(self) -> bool {
        matches!(self, Self::Symmetric | Self::Diagonal)
    }

    pub fn is_orthogonal(self) -> bool {
        matches!(self, Self::Orthogonal | Self::Rotation)
    }
}

/// The stage at which the value of a symbol is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// The stage of the parameters and the step: once for a stepper.
    Construction,
    /// The stage of the state: once a step.
    Step,
    /// The stage of the unknown: once a Newton iteration.
    Iteration,
}

/// A named scalar (shape 1 × 1), vector or matrix.
#[derive(Clone, Debug)]
pub struct Symbol {
    pub name: String,
    pub shape: (usize, usize),
    pub structure: Structure,
    pub stage: Stage,
}

impl Symbol {
    /// Whether the symbol is an element of so(3), which pairs with vectors.
    pub fn is_rotation(&self) -> bool {
        self.structure == Structure::Skew && self.shape == (3, 3)
    }
}

/// All symbols of a declaration, in the order of their creation.
#[derive(Clone, Debug, Default)]
pub struct Symbols {
    all: Vec<Symbol>,
    /// Matrices, each with the symbol for the entries of its inverse.
    inverses: Vec<(SymbolId, SymbolId)>,
}

impl Symbols {
    pub fn add(
        &mut self,
        name: impl Into<String>,
        shape: (usize, usize),
        structure: Structure,
        stage: Stage,
    ) -> SymbolId {
        self.all.push(Symbol { name: name.into(), shape, structure, stage });
        SymbolId(self.all.len() - 1)
    }

    pub fn get(&self, id: SymbolId) -> &Symbol {
        &self.all[id.0]
    }

    pub fn set_stage(&mut self, id: SymbolId, stage: Stage) {
        self.all[id.0].stage = stage;
    }

    pub fn ids(&self) -> impl Iterator<Item = SymbolId> {
        (0..self.all.len()).map(SymbolId)
    }

    pub fn set_inverse(&mut self, matrix: SymbolId, inverse: SymbolId) {
        self.inverses.retain(|(known, _)| *known != matrix);
        self.inverses.push((matrix, inverse));
    }

    /// The symbol for the entries of the inverse, if one was set.
    pub fn inverse_of(&self, id: SymbolId) -> Option<SymbolId> {
        self.inverses.iter().find(|(matrix, _)| *matrix == id).map(|&(_, inverse)| inverse)
    }
}
