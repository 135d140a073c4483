//! The continuous equations of a reduced Lagrangian `l(ξ, w)`, \[RDAE, sections 1.1 to 1.3 and 2.1\].
//!
//! ```text
//! ⟨μ, η⟩         = d/ds l(ξ + sη, w)                       (1.14)
//! ⟨Mη, ζ⟩        = d/ds ⟨μ(ξ + sζ, w), η⟩
//! ⟨∂l/∂w ⋄ w, η⟩ = −d/ds l(ξ, exp(sη̂)·w)                   (2.1)
//! ⟨a, η⟩         = d/ds ⟨μ(ξ, exp(sξ̂)·w), η⟩
//! ```
//!
//! With them `M ξ̇ = ad*_ξ μ + ∂l/∂w ⋄ w + a` and `ẇ = −ξ·w` are (1.4) and (2.2).

use std::collections::BTreeMap;

use super::{Declared, Derived, Refusal, action, unit};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{
    Expression, Rational, Stage, Structure, SymbolId, Symbols, Variance, Variations, substitute, variation,
};

/// A continuous Lagrangian with the symbols that it is written in.
#[derive(Clone, Debug)]
pub(crate) struct DeclaredContinuous {
    pub(crate) group: Group,
    pub(crate) symbols: Symbols,
    /// `l(ξ, w)`.
    pub(crate) expression: Expression,
    /// The components of `ξ`.
    pub(crate) velocity: SymbolId,
    /// The matrix `ξ̂`; on SO(3), where it is that of a cross product, none.
    pub(crate) velocity_matrix: Option<SymbolId>,
    /// The advected parameters `w`.
    pub(crate) advected: Vec<(SymbolId, Variance)>,
}

/// How `ξ` follows from `μ`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Inverse {
    /// `l` is quadratic in `ξ`, with the same second derivative for all `w`.
    Constant,
    /// `l` is quadratic in `ξ`.
    Varying,
    /// It isn't.
    Nonlinear,
}

/// All that follows from `l`. Covectors are linear in `η`, the second derivative in `η` and `ζ`.
#[derive(Clone, Debug)]
pub(crate) struct Continuous {
    pub(crate) group: Group,
    pub(crate) symbols: Symbols,
    pub(crate) velocity: SymbolId,
    pub(crate) velocity_matrix: Option<SymbolId>,
    pub(crate) advected: Vec<(SymbolId, Variance)>,
    /// `η` and `ζ`, in components.
    pub(crate) directions: [SymbolId; 2],
    /// `η̂` and `ζ̂`; on SO(3) none.
    pub(crate) direction_matrices: Option<[SymbolId; 2]>,
    pub(crate) lagrangian: Expression,
    /// `μ`.
    pub(crate) momentum: Expression,
    /// `M`.
    pub(crate) hessian: Expression,
    /// `∂l/∂w ⋄ w`.
    pub(crate) diamond: Expression,
    /// The same along any matrix, which the symbol stands for.
    pub(crate) any: SymbolId,
    pub(crate) diamond_of_any: Expression,
    /// `(∂²l/∂w∂ξ)(ξ·w)`.
    pub(crate) advection: Expression,
    pub(crate) inverse: Inverse,
}

impl Continuous {
    /// Whether there is a kinetic part.
    pub(crate) fn has_kinetic(&self) -> bool {
        !self.hessian.is_zero()
    }

    /// The momentum `s(w)` at rest.
    pub(crate) fn bias(&self) -> Expression {
        self.at_rest(&self.momentum)
    }

    /// `V(w) = −l(0, w)`.
    pub(crate) fn potential(&self) -> Expression {
        self.at_rest(&self.lagrangian).scaled(-Rational::ONE)
    }

    pub(super) fn at_rest(&self, expression: &Expression) -> Expression {
        let rest = Expression::zero((self.group.dimension(), 1));
        let mut map = BTreeMap::from([(self.velocity, rest)]);
        let size = self.group.size;
        map.extend(self.velocity_matrix.map(|matrix| (matrix, Expression::zero((size, size)))));
        substitute(expression, &map, &self.symbols)
    }
}

/// Derives everything.
pub(crate) fn continuous(declared: DeclaredContinuous) -> Result<Continuous, Refusal> {
    let DeclaredContinuous { group, mut symbols, expression, velocity, velocity_matrix, advected } = declared;
    let expression = if group.is_so3 { expression.with_hats_resolved(&symbols) } else { expression };
    let directions =
        ["η", "ζ"].map(|name| symbols.add(name, (group.dimension(), 1), Structure::General, Stage::Construction));
    let direction_matrices =
        velocity_matrix.map(|_| ["hat(η)", "hat(ζ)"].map(|name| matrix_symbol(&group, name, &mut symbols)));
    let any = symbols.add("X", (group.size, group.size), Structure::General, Stage::Step);
    let xi = Element::new(velocity, velocity_matrix, &symbols);
    let [eta, zeta] =
        [0, 1].map(|at| Element::new(directions[at], direction_matrices.map(|matrices| matrices[at]), &symbols));
    let vary = |of: &Expression, variations: &Variations| {
        let varied = variation(of, variations, &symbols);
        if group.is_so3 { varied.with_hats_resolved(&symbols) } else { varied }
    };
    let along_velocity = |of: &Expression, direction: &Element| {
        let mut variations = Variations::from([(velocity, direction.components.clone())]);
        variations.extend(velocity_matrix.map(|matrix| (matrix, direction.matrix.clone())));
        vary(of, &variations)
    };
    let any_matrix = Expression::symbol(any, &symbols);
    let carried = |of: &Expression, element: &Expression| {
        let moved = advected.iter().map(|&(w, variance)| {
            let moved = action::infinitesimal(&symbols, variance, element, &Expression::symbol(w, &symbols));
            // The last coordinate of a point stays one, whatever the matrix; the algebra leaves it.
            let is_point = *element == any_matrix && symbols.get(w).structure == Structure::Point;
            (w, if is_point { without_last(&moved, &symbols) } else { moved })
        });
        vary(of, &moved.collect())
    };
    let momentum = along_velocity(&expression, &eta);
    let hessian = along_velocity(&momentum, &zeta);
    let diamond = carried(&expression, &eta.matrix).scaled(-Rational::ONE);
    let diamond_of_any = carried(&expression, &any_matrix).scaled(-Rational::ONE);
    let advection = carried(&momentum, &xi.matrix);
    let has_velocity = |of: &Expression| of.contains(velocity) || velocity_matrix.is_some_and(|xi| of.contains(xi));
    let inverse = if has_velocity(&hessian) {
        Inverse::Nonlinear
    } else if advected.iter().any(|&(w, _)| hessian.contains(w)) {
        Inverse::Varying
    } else {
        Inverse::Constant
    };
    let all = [&expression, &momentum, &hessian, &diamond, &diamond_of_any, &advection];
    if all.into_iter().any(Expression::has_overflow) {
        return Err(Refusal::Overflow);
    }
    Ok(Continuous {
        lagrangian: expression,
        momentum,
        hessian,
        diamond,
        any,
        diamond_of_any,
        advection,
        inverse,
        directions,
        direction_matrices,
        group,
        symbols,
        velocity,
        velocity_matrix,
        advected,
    })
}

/// A column with zero for its last entry; the elements of a group of affine maps have it anyway.
fn without_last(column: &Expression, symbols: &Symbols) -> Expression {
    let (size, _) = column.shape();
    let [row, unit] = [true, false].map(|transposed| unit(size - 1, size, transposed, symbols));
    column.clone().minus(unit.times(&row.times(column, symbols), symbols))
}

/// An element of the algebra, in components and as a matrix.
struct Element {
    components: Expression,
    matrix: Expression,
}

impl Element {
    fn new(components: SymbolId, matrix: Option<SymbolId>, symbols: &Symbols) -> Self {
        let components = Expression::symbol(components, symbols);
        let matrix = matrix.map_or_else(|| components.hat(symbols), |matrix| Expression::symbol(matrix, symbols));
        Self { components, matrix }
    }
}

/// A symbol for an element of the algebra as a matrix.
pub(crate) fn matrix_symbol(group: &Group, name: &str, symbols: &mut Symbols) -> SymbolId {
    let structure = if group.orthogonal { Structure::Skew } else { Structure::General };
    symbols.add(name, (group.size, group.size), structure, Stage::Step)
}

/// The limit of a discrete Lagrangian, `l = ½ ξ·Jξ + s(w)·ξ − V(w)`.
pub(crate) fn of_limit(declared: &Declared, derived: &Derived) -> DeclaredContinuous {
    let (group, mut symbols) = (declared.group.clone(), derived.symbols.clone());
    let name = if group.is_so3 { "Ω" } else { "ξ" };
    let velocity = symbols.add(name, (group.dimension(), 1), Structure::General, Stage::Step);
    let velocity_matrix = (!group.is_so3).then(|| matrix_symbol(&group, "hat(ξ)", &mut symbols));
    let matrix = Element::new(velocity, velocity_matrix, &symbols).matrix;
    let directions = &derived.directions;
    let factors = directions.factors.iter();
    let map = factors.flat_map(|one| [one.first, one.second].map(|direction| (direction, matrix.clone()))).collect();
    let along = |expression: &Expression| substitute(expression, &map, &symbols);
    let limit = &derived.limit;
    let advected = declared.advected.iter().map(|w| (w.symbol, w.variance)).collect();
    let kinetic = along(&limit.inertia).scaled(Rational::new(1, 2));
    let expression = kinetic.plus(along(&limit.bias)).minus(limit.potential.clone());
    DeclaredContinuous { group, symbols, expression, velocity, velocity_matrix, advected }
}
