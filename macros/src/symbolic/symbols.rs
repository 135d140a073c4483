//! The symbols of one declaration.

/// An index into [`Symbols`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct SymbolId(pub(crate) usize);

/// What is known of a matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Structure {
    /// Nothing.
    General,
    /// `Sᵀ = S`.
    Symmetric,
    /// Zero off the diagonal.
    Diagonal,
    /// `Aᵀ = −A`: an algebra element of an orthogonal group.
    Skew,
    /// `FᵀF = FFᵀ = I`, `det F = 1`.
    Orthogonal,
}

/// When the value of a symbol is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Stage {
    /// With the parameters and the step: once for a stepper.
    Construction,
    /// With the state: once a step.
    Step,
    /// With the unknown: once a Newton iteration.
    Iteration,
}

/// A named scalar (shape 1 × 1), vector or matrix.
#[derive(Clone, Debug)]
pub(crate) struct Symbol {
    pub(crate) name: String,
    pub(crate) shape: (usize, usize),
    pub(crate) structure: Structure,
    pub(crate) stage: Stage,
}

/// All symbols of a declaration, in the order of their creation.
#[derive(Clone, Debug, Default)]
pub(crate) struct Symbols(Vec<Symbol>);

impl Symbols {
    pub(crate) fn add(
        &mut self,
        name: impl Into<String>,
        shape: (usize, usize),
        structure: Structure,
        stage: Stage,
    ) -> SymbolId {
        self.0.push(Symbol { name: name.into(), shape, structure, stage });
        SymbolId(self.0.len() - 1)
    }

    pub(crate) fn get(&self, id: SymbolId) -> &Symbol {
        &self.0[id.0]
    }
}
