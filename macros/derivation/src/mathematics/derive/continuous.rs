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

use super::{AdvectedSymbol, DeclaredFunction, Derivation, Refusal, View, action, unit};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{
    Expression, Rational, Stage, Structure, SymbolId, Symbols, Variations, substitute, variation,
};

/// A continuous Lagrangian and its symbols.
#[derive(Clone, Debug)]
pub struct ContinuousLagrangian {
    pub group: Group,
    pub symbols: Symbols,
    /// `l(ξ, w)`.
    pub expression: Expression,
    /// `ξ`, one for each factor of the group.
    pub velocities: Vec<Element>,
    /// The advected parameters `w`.
    pub advected: Vec<AdvectedSymbol>,
}

/// An element of the algebra of a factor: its velocity, or a direction along which the velocity is varied.
#[derive(Clone, Copy, Debug)]
pub struct Element {
    pub components: SymbolId,
    /// The matrix `ξ̂`; `None` on SO(3), where it is that of a cross product, and for a translation.
    pub matrix: Option<SymbolId>,
}

impl Element {
    /// The symbols of these names for a factor.
    fn several<const N: usize>(group: &Group, names: [&str; N], stage: Stage, symbols: &mut Symbols) -> [Self; N] {
        let components = names.map(|name| symbols.add(name, (group.dimension(), 1), Structure::General, stage));
        let has_matrix = !group.is_so3 && !group.is_added;
        let structure = if group.orthogonal { Structure::Skew } else { Structure::General };
        let shape = (group.size, group.size);
        let matrices =
            names.map(|name| has_matrix.then(|| symbols.add(format!("hat({name})"), shape, structure, Stage::Step)));
        std::array::from_fn(|at| Self { components: components[at], matrix: matrices[at] })
    }

    /// The symbols of a velocity.
    pub fn new(group: &Group, name: &str, symbols: &mut Symbols) -> Self {
        let [velocity] = Self::several(group, [name], Stage::Step, symbols);
        velocity
    }

    /// An element of the algebra: a matrix, or for a translation a vector.
    fn element(self, group: &Group, symbols: &Symbols) -> Expression {
        let components = Expression::symbol(self.components, symbols);
        match self.matrix {
            Some(matrix) => Expression::symbol(matrix, symbols),
            None if group.is_added => components,
            None => components.hat(symbols),
        }
    }

    /// Whether an expression depends on the element.
    fn is_in(self, expression: &Expression) -> bool {
        expression.contains(self.components) || self.matrix.is_some_and(|matrix| expression.contains(matrix))
    }
}

/// The form of the map from `μ` to `ξ`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inverse {
    /// `l` is quadratic in `ξ`, with the same second derivative for all `w`.
    Constant,
    /// `l` is quadratic in `ξ`.
    Varying,
    /// `l` isn't quadratic in `ξ`.
    Nonlinear,
}

/// The terms derived from `l`. Covectors are linear in `η`, the second derivative in `η` and `ζ`.
#[derive(Clone, Debug)]
pub struct Continuous {
    pub group: Group,
    pub symbols: Symbols,
    /// The velocity of each factor of the group; other lists are by factors, too.
    pub velocities: Vec<Element>,
    pub advected: Vec<AdvectedSymbol>,
    /// The directions `η` and `ζ` of each factor.
    pub directions: Vec<[Element; 2]>,
    pub lagrangian: Expression,
    /// The momentum `μ`.
    pub momentum: Expression,
    /// The second derivative `M` by the velocity.
    pub hessian: Expression,
    /// `∂l/∂w ⋄ w`.
    pub diamond: Expression,
    /// Any matrix of each factor; for a translation, any vector.
    pub any: Vec<SymbolId>,
    /// `∂l/∂w ⋄ w` along these matrices.
    pub diamond_of_any: Expression,
    /// `(∂²l/∂w∂ξ)(ξ·w)`.
    pub advection: Expression,
    pub inverse: Inverse,
}

impl Continuous {
    /// Whether there is a kinetic part.
    pub fn has_kinetic(&self) -> bool {
        !self.hessian.is_zero()
    }

    /// The momentum `s(w)` at rest.
    pub fn bias(&self) -> Expression {
        self.at_rest(&self.momentum)
    }

    /// `V(w) = −l(0, w)`.
    pub fn potential(&self) -> Expression {
        self.at_rest(&self.lagrangian).scaled(-Rational::ONE)
    }

    pub(super) fn at_rest(&self, expression: &Expression) -> Expression {
        let mut map = BTreeMap::new();
        for (velocity, group) in self.velocities.iter().zip(self.group.factors()) {
            map.insert(velocity.components, Expression::zero((group.dimension(), 1)));
            map.extend(velocity.matrix.map(|matrix| (matrix, Expression::zero((group.size, group.size)))));
        }
        substitute(expression, &map, &self.symbols)
    }
}

/// Derives the continuous equations.
pub fn continuous(declared: ContinuousLagrangian) -> Result<Continuous, Refusal> {
    let ContinuousLagrangian { group, mut symbols, expression, velocities, advected } = declared;
    let is_crossed = group.rotates();
    let expression = if is_crossed { expression.with_hats_resolved(&symbols) } else { expression };
    let numbered = |name: &str, factor: usize| {
        if group.is_product() { format!("{name}_{}", factor + 1) } else { name.to_owned() }
    };
    let mut directions = Vec::new();
    for (factor, own) in group.factors().iter().enumerate() {
        let names = ["η", "ζ"].map(|name| numbered(name, factor));
        let names = [names[0].as_str(), names[1].as_str()];
        directions.push(Element::several(own, names, Stage::Construction, &mut symbols));
    }
    let mut any = Vec::new();
    for (factor, own) in group.factors().iter().enumerate() {
        any.push(symbols.add(numbered("X", factor), own.shape(), Structure::General, Stage::Step));
    }
    let vary = |of: &Expression, variations: &Variations| {
        let varied = variation(of, variations, &symbols);
        if is_crossed { varied.with_hats_resolved(&symbols) } else { varied }
    };
    let element = |of: Element, factor: usize| of.element(group.factor(factor), &symbols);
    let along_velocity = |of: &Expression, direction: usize| {
        let mut variations = Variations::new();
        for (factor, (velocity, directions)) in velocities.iter().zip(&directions).enumerate() {
            let direction = directions[direction];
            variations.insert(velocity.components, Expression::symbol(direction.components, &symbols));
            variations.extend(velocity.matrix.map(|matrix| (matrix, element(direction, factor))));
        }
        vary(of, &variations)
    };
    let carried = |of: &Expression, e: &dyn Fn(usize) -> Expression| {
        let moved = advected.iter().map(|&w| (w.symbol, action::along((&group, &symbols), w, e)));
        vary(of, &moved.collect())
    };
    // The last coordinate of a point stays one along every matrix, as it does along the algebra.
    let along_any = |of: &Expression| {
        let e = |factor: usize| Expression::symbol(any[factor], &symbols);
        let moved = advected.iter().map(|&w| {
            let moved = action::along((&group, &symbols), w, &e);
            let is_point = matches!(w.seen, View::From(_)) && symbols.get(w.symbol).structure == Structure::Point;
            (w.symbol, if is_point { without_last(&moved, &symbols) } else { moved })
        });
        vary(of, &moved.collect())
    };
    let momentum = along_velocity(&expression, 0);
    let hessian = along_velocity(&momentum, 1);
    let diamond = carried(&expression, &|factor| element(directions[factor][0], factor)).scaled(-Rational::ONE);
    let diamond_of_any = along_any(&expression).scaled(-Rational::ONE);
    let advection = carried(&momentum, &|factor| element(velocities[factor], factor));
    let inverse = if velocities.iter().any(|velocity| velocity.is_in(&hessian)) {
        Inverse::Nonlinear
    } else if advected.iter().any(|w| hessian.contains(w.symbol)) {
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
        group,
        symbols,
        velocities,
        advected,
    })
}

/// A column with its last entry set to zero, which elements of a group of affine maps leave zero anyway.
fn without_last(column: &Expression, symbols: &Symbols) -> Expression {
    let (size, _) = column.shape();
    let [row, unit] = [true, false].map(|transposed| unit(size - 1, size, transposed, symbols));
    column.clone().minus(unit.times(&row.times(column, symbols), symbols))
}

/// The limit of a discrete Lagrangian: `l = ½ ξ·Jξ + s(w)·ξ − V(w)`, if it is quadratic in `ξ`.
pub fn of_limit(declared: &DeclaredFunction, derived: &Derivation) -> ContinuousLagrangian {
    let (group, mut symbols) = (declared.group.clone(), derived.symbols.clone());
    let mut velocities = Vec::new();
    for (factor, own) in group.factors().iter().enumerate() {
        let name = if own.is_so3 { "Ω" } else { "ξ" };
        let name = if group.is_product() { format!("{name}_{}", factor + 1) } else { name.to_owned() };
        velocities.push(Element::new(own, &name, &mut symbols));
    }
    let directions = &derived.directions;
    let factors = directions.factors.iter().zip(&velocities).zip(group.factors());
    let map = factors.flat_map(|((one, velocity), own)| {
        let element = velocity.element(own, &symbols);
        [one.first, one.second, one.velocity].map(|direction| (direction, element.clone()))
    });
    let map = map.collect();
    let along = |expression: &Expression| substitute(expression, &map, &symbols);
    let limit = &derived.limit;
    let quadratic = || {
        let kinetic = along(&limit.inertia).scaled(Rational::new(1, 2));
        kinetic.plus(along(&limit.bias)).minus(limit.potential.clone())
    };
    let expression = limit.lagrangian.as_ref().map_or_else(quadratic, along);
    let advected = declared.advected.clone();
    ContinuousLagrangian { group, symbols, expression, velocities, advected }
}
