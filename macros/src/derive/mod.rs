//! From `l_d` to all that an integrator needs, in the order of the thesis. Knows no token.

mod action;
mod cayley;
mod diamond;
mod energy;
mod force;
mod limit;
mod momentum_equation;
mod momentum_maps;
mod transport;

use std::collections::BTreeMap;

use crate::group::Group;
use crate::symbolic::{Expression, Stage, Structure, SymbolId, Symbols, Variance};

pub(crate) use cayley::Cleared;
pub(crate) use force::{Displacements, ForceError, force};
pub(crate) use limit::{Limit, LimitError};

/// A declared Lagrangian with the symbols that it is written in.
#[derive(Clone, Debug)]
pub(crate) struct Declared {
    pub(crate) group: Group,
    pub(crate) symbols: Symbols,
    pub(crate) l_d: Expression,
    /// The increment `F`.
    pub(crate) increment: SymbolId,
    /// The step `h`.
    pub(crate) step: SymbolId,
    /// The advected parameters `w`.
    pub(crate) advected: Vec<(SymbolId, Variance)>,
}

/// The symbols that the derivation adds.
#[derive(Clone, Debug)]
pub(crate) struct Directions {
    /// The component `E_k` of a covector.
    pub(crate) first: SymbolId,
    /// The direction `E_j` of a Jacobian's column.
    pub(crate) second: SymbolId,
    /// The covector `a` that the unknown part of the momentum equation has to equal.
    pub(crate) target: SymbolId,
    /// `D = F − I`.
    pub(crate) small: SymbolId,
    /// `F⁻¹`.
    pub(crate) inverse: SymbolId,
    /// The coordinates `ξ` of `F = cay(ξ)`.
    pub(crate) coordinates: SymbolId,
    /// `4 + |ξ|²`, the denominator of the Cayley map.
    pub(crate) denominator: SymbolId,
    /// A variation `δξ`.
    pub(crate) coordinate_direction: SymbolId,
    /// The new advected parameters `w⁺ = F⁻¹·w`.
    pub(crate) next: Vec<SymbolId>,
}

/// All that follows from `l_d`. Covectors are linear in the direction `E_k`, Jacobians in `E_k` and `E_j`.
#[derive(Clone, Debug)]
pub(crate) struct Derived {
    pub(crate) symbols: Symbols,
    pub(crate) group: Group,
    increment: SymbolId,
    pub(crate) directions: Directions,
    /// `(R_F)* δl_d/δF`.
    pub(crate) right_momentum: Expression,
    /// `(L_F)* δl_d/δF`.
    pub(crate) left_momentum: Expression,
    /// `δl_d/δw ⋄ w`.
    pub(crate) diamond: Expression,
    /// `μ` of (2.7).
    pub(crate) momentum: Expression,
    /// `∂μ_k` along `F ↦ exp(t E_j) F`.
    pub(crate) jacobian: Expression,
    /// `−∂l_d/∂h`.
    pub(crate) energy: Expression,
    /// The Lagrangian's limit as `h → 0`.
    pub(crate) limit: Limit,
    /// The part of the diamond without `F`.
    pub(crate) kick_before: Expression,
    /// The part of `μ` with `F`, written in `D = F − I`: its constants cancel exactly, so that a small step keeps its
    /// digits.
    pub(crate) unknown: Expression,
    /// `Ad*_F` of the rest of the diamond, in `F` and `w⁺`.
    pub(crate) kick_after: Expression,
    /// The momentum equation in Cayley coordinates without denominators, where it is polynomial in `F`.
    pub(crate) cleared: Option<Cleared>,
}

impl Derived {
    /// The increment `F`.
    pub(crate) fn increment(&self) -> SymbolId {
        self.increment
    }
}

/// Derives everything.
pub(crate) fn derive(declared: &Declared) -> Result<Derived, LimitError> {
    let mut symbols = declared.symbols.clone();
    let directions = directions(declared, &mut symbols);
    let context = Context { declared, symbols: &symbols, directions: &directions };
    let right_momentum = momentum_maps::right(&context);
    let left_momentum = momentum_maps::left(&context);
    let diamond = diamond::diamond(&context);
    let momentum = momentum_equation::momentum(&right_momentum, &diamond);
    let jacobian = momentum_equation::jacobian(&context, &momentum);
    let energy = energy::discrete(&context);
    let limit = limit::limit(&context, &momentum)?;
    let parts = transport::parts(&context, &momentum, &diamond);
    let cleared = cayley::cleared(&context, &parts.unknown);
    Ok(Derived {
        group: declared.group.clone(),
        increment: declared.increment,
        right_momentum,
        left_momentum,
        diamond,
        momentum,
        jacobian,
        energy,
        limit,
        kick_before: parts.kick_before,
        unknown: transport::in_small_increment(&context, &parts.unknown),
        kick_after: parts.kick_after,
        cleared,
        directions,
        symbols,
    })
}

/// What every rule needs.
struct Context<'a> {
    declared: &'a Declared,
    symbols: &'a Symbols,
    directions: &'a Directions,
}

impl Context<'_> {
    fn symbol(&self, id: SymbolId) -> Expression {
        Expression::symbol(id, self.symbols)
    }

    fn product(&self, left: &Expression, right: &Expression) -> Expression {
        left.times(right, self.symbols)
    }

    fn substituted(&self, expression: &Expression, map: &BTreeMap<SymbolId, Expression>) -> Expression {
        crate::symbolic::substitute(expression, map, self.symbols)
    }
}

fn directions(declared: &Declared, symbols: &mut Symbols) -> Directions {
    let (size, dimension) = (declared.group.size, declared.group.dimension());
    let structure = if declared.group.orthogonal { Structure::Skew } else { Structure::General };
    let column =
        |symbols: &mut Symbols, name: &str, rows, stage| symbols.add(name, (rows, 1), Structure::General, stage);
    let algebra = |symbols: &mut Symbols, name: &str| symbols.add(name, (size, size), structure, Stage::Construction);
    let inverse = symbols.add("F⁻¹", (size, size), Structure::General, Stage::Iteration);
    symbols.set_inverse(declared.increment, inverse);
    Directions {
        inverse,
        first: algebra(symbols, "E_k"),
        second: algebra(symbols, "E_j"),
        target: column(symbols, "a", dimension, Stage::Step),
        small: symbols.add("D", (size, size), Structure::General, Stage::Iteration),
        coordinates: column(symbols, "ξ", dimension, Stage::Iteration),
        denominator: symbols.add("(4 + |ξ|²)", (1, 1), Structure::General, Stage::Iteration),
        coordinate_direction: column(symbols, "δξ", dimension, Stage::Construction),
        next: declared
            .advected
            .iter()
            .map(|&(w, variance)| {
                let name = format!("{}⁺", symbols.get(w).name);
                let columns = if variance.is_tensor() { size } else { 1 };
                symbols.add(name, (size, columns), Structure::General, Stage::Step)
            })
            .collect(),
    }
}
