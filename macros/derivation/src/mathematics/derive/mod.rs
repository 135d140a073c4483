//! The derivation of an integrator's terms from `l_d`, in the order of the thesis. Knows no token.

mod action;
mod algebra;
mod cayley;
mod closed;
mod constraint;
mod continuous;
mod diamond;
mod energy;
mod force;
mod kick_derivative;
mod limit;
mod momentum_equation;
mod momentum_maps;
mod self_adjoint;
mod series;
mod transport;

use std::collections::BTreeMap;

use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Expression, Rational, Stage, Structure, SymbolId, Symbols};

pub use action::{AdvectedSymbol, View};
pub use algebra::{hat, linear_forms, unit};
pub use cayley::ClearedSystem;
pub use closed::{ClosedLet, Let};
pub use constraint::{Body, DeclaredConstraint};
pub use continuous::{Continuous, ContinuousLagrangian, Element, Inverse, continuous, of_limit};
pub use force::{Displacements, ForceError};
pub use limit::{ContinuousSource, Limit};
pub use self_adjoint::SelfAdjointness;
pub use series::LimitError;

/// A declared Lagrangian and its symbols.
#[derive(Clone, Debug)]
pub struct DeclaredFunction {
    pub group: Group,
    pub symbols: Symbols,
    /// The closed `let`s, in their order; empty if the expression is small enough to be multiplied out.
    pub lets: Vec<Let>,
    /// The Lagrangian `l_d`, or the virtual work of a force.
    pub expression: Expression,
    /// The increments `F`, one for each factor of the group.
    pub increments: Vec<SymbolId>,
    /// The step `h`.
    pub step: SymbolId,
    /// The advected parameters `w`.
    pub advected: Vec<AdvectedSymbol>,
    /// The displacements of a force's virtual work; a Lagrangian has none.
    pub displacements: Option<Displacements>,
    /// Whether the derivatives of a step are requested.
    pub has_derivatives: bool,
    /// The continuous Lagrangian that was discretised.
    pub discretised: Option<ContinuousSource>,
}

/// The reason why nothing can be derived.
#[derive(Clone, Copy, Debug)]
pub enum Refusal {
    Limit(LimitError),
    Force(ForceError),
    /// A coefficient left the range of exact arithmetic.
    Overflow,
}

/// The symbols that the derivation adds for each factor of the group.
#[derive(Clone, Copy, Debug)]
pub struct OfFactor {
    /// The increment `F` itself.
    pub increment: SymbolId,
    /// The component `E_k` of a covector.
    pub first: SymbolId,
    /// The direction `E_j` of a Jacobian's column.
    pub second: SymbolId,
    /// `D = F − I`.
    pub small: SymbolId,
    /// `F⁻¹`.
    pub inverse: SymbolId,
    /// `D⁻ = F⁻¹ − I`.
    pub small_inverse: SymbolId,
    /// The increment `F⁺` of the next step, for printed equations.
    pub next_increment: SymbolId,
    /// `ξ̂` in the limit `F = exp(hξ̂)`.
    velocity: SymbolId,
}

/// The symbols that the derivation adds.
#[derive(Clone, Debug)]
pub struct Directions {
    pub factors: Vec<OfFactor>,
    /// The covector `a` on the right side of the momentum equation; in a Newton system `(h/2) a`.
    pub target: SymbolId,
    /// The Cayley vector `y` of `F = cay(2y)`.
    pub coordinates: SymbolId,
    /// `1 + |y|²`, the denominator of the Cayley map.
    pub denominator: SymbolId,
    /// A variation `δy`.
    pub coordinate_direction: SymbolId,
    /// The new advected parameters `w⁺ = F⁻¹·w`.
    pub next: Vec<SymbolId>,
    /// The body velocity `v` that a kick is differentiated along.
    pub along: SymbolId,
    /// A scalar variable for derivatives of functions.
    scratch: SymbolId,
}

/// The terms derived from `l_d`. Covectors are linear in the direction `E_k`, Jacobians in `E_k` and `E_j`.
#[derive(Clone, Debug)]
pub struct Derivation {
    pub symbols: Symbols,
    pub group: Group,
    pub directions: Directions,
    /// The closed `let`s with their derivatives.
    pub closed: Vec<ClosedLet>,
    /// `w = F·w⁺`.
    pub previous: Vec<(SymbolId, Expression)>,
    /// `(R_F)* δl_d/δF`.
    pub right_momentum: Expression,
    /// `(L_F)* δl_d/δF`.
    pub left_momentum: Expression,
    /// `δl_d/δw ⋄ w`.
    pub diamond: Expression,
    /// The share of each advected parameter, if there are several.
    pub shares: Vec<Expression>,
    /// `μ` of (2.7).
    pub momentum: Expression,
    /// `∂μ_k` along `F ↦ exp(t E_j) F`.
    pub jacobian: Expression,
    /// `−∂l_d/∂h`.
    pub energy: Expression,
    /// `l_d(F, w, h) + l_d(F⁻¹, F⁻¹·w, −h)`, or that of the virtual work: zero if it is self-adjoint by its normal form.
    pub adjoint_defect: Expression,
    /// The two sides of the flow on increments (2.5): `μ(F⁺, w⁺)`, and `(L_F)* δl_d/δF` in `F` and `w⁺`; `None` if
    /// there are closed `let`s.
    pub flow: Option<[Expression; 2]>,
    /// The Lagrangian's limit as `h → 0`.
    pub limit: Limit,
    /// The part of the diamond without `F`.
    pub kick_before: Expression,
    /// The derivative of this kick along `w ↦ exp(−t E_j)·w`, for kinetic-potential splittings: on SO(3), for a
    /// Lagrangian without closed `let`s.
    pub kick_derivative: Option<Expression>,
    /// The part of `μ` that depends on `F`, written in `D = F − I`: its constants cancel exactly, so that a small step
    /// keeps its digits.
    pub unknown: Expression,
    /// `Ad*_F` of the rest of the diamond, in `F` and `w⁺`; its terms in `1/h` are written in `D`.
    pub kick_after: Expression,
    /// The kick after the step in printed form, without `D`.
    pub shown_kick_after: Expression,
    /// `h/2`, the factor of the Newton system, which removes its `1/h`.
    pub half_step: Expression,
    /// The momentum equation in Cayley coordinates without denominators, if it is polynomial in `F`.
    pub cleared: Option<ClearedSystem>,
    /// The momenta to differentiate, if the derivatives of a step are requested.
    pub ends: Option<Ends>,
}

/// The shares in the momenta at both ends of a step, as functions of `D = F − I`, `w` and the parameters.
#[derive(Clone, Debug)]
pub struct Ends {
    /// `μ` of (2.7), and `μ⁺` of (2.6).
    pub momenta: [Expression; 2],
    /// `E·w` for each advected parameter.
    pub moved: Vec<(SymbolId, Expression)>,
}

impl Derivation {
    /// Whether the inertia depends on advected or given parameters.
    pub fn inertia_varies(&self) -> bool {
        self.previous.iter().any(|(w, _)| self.limit.inertia.contains(*w))
    }

    /// Whether all coefficients stayed in the range of exact arithmetic.
    fn is_exact(&self) -> bool {
        let limit = &self.limit;
        let all = [
            &self.right_momentum,
            &self.left_momentum,
            &self.diamond,
            &self.momentum,
            &self.jacobian,
            &self.energy,
            &self.adjoint_defect,
            &limit.slope,
            &limit.inertia,
            &limit.bias,
            &limit.potential,
            &self.kick_before,
            &self.unknown,
            &self.kick_after,
        ];
        let ends = self.ends.iter().flat_map(|ends| &ends.momenta);
        let all = all.into_iter().chain(&self.kick_derivative).chain(&limit.lagrangian).chain(ends);
        let cleared = self.cleared.iter().flat_map(|cleared| [&cleared.residual, &cleared.jacobian]);
        let closed =
            self.closed.iter().flat_map(|one| [&one.value, &one.pairing, &one.tangent.1, &one.multiplier_tangent.1]);
        !all.chain(cleared).chain(closed).any(Expression::has_overflow)
    }
}

/// Derives all terms of a Lagrangian or of a force.
pub fn derive(declared: &DeclaredFunction) -> Result<Derivation, Refusal> {
    let derived = match &declared.displacements {
        None => lagrangian(declared).map_err(Refusal::Limit)?,
        Some(displacements) => force::force(declared, displacements).map_err(Refusal::Force)?,
    };
    if derived.is_exact() { Ok(derived) } else { Err(Refusal::Overflow) }
}

fn lagrangian(declared: &DeclaredFunction) -> Result<Derivation, LimitError> {
    let mut symbols = declared.symbols.clone();
    let directions = directions(declared, &mut symbols);
    let (mut closed, lagrangian) = closed::multipliers(&declared.lets, &declared.expression, &mut symbols);
    let context = Context { declared, lagrangian: &lagrangian, symbols: &symbols, directions: &directions };
    closed::tangents(&context, &mut closed);
    let right_momentum = momentum_maps::right(&context);
    let left_momentum = momentum_maps::left(&context);
    let diamond = diamond::diamond(&context);
    let momentum = momentum_equation::momentum(&right_momentum, &diamond);
    let jacobian = momentum_equation::jacobian(&context, &momentum, &closed);
    let energy = energy::discrete(&context);
    let adjoint_defect = self_adjoint::defect(&context);
    let limit = limit::limit(&context, &momentum)?;
    let parts = transport::parts(&context, &momentum, &diamond);
    // The derivative doesn't vary multipliers of closed `let`s; a zero kick has a zero derivative in any case.
    let kick_derivative = (declared.group.is_so3 && (closed.is_empty() || parts.kick_before.is_zero()))
        .then(|| kick_derivative::kick_derivative(&context, &parts.kick_before));
    let flow = closed.is_empty().then(|| transport::increments(&context, &momentum, &left_momentum));
    let cleared = if closed.is_empty() { cayley::cleared(&context, &parts.unknown) } else { None };
    let ends = context.ends(&closed, [&momentum, &left_momentum]);
    let unknown =
        if closed.is_empty() { transport::in_small_increment(&context, &parts.unknown) } else { parts.unknown };
    Ok(Derivation {
        group: declared.group.clone(),
        right_momentum,
        left_momentum,
        diamond,
        shares: diamond::shares(&context),
        momentum,
        jacobian,
        energy,
        adjoint_defect,
        flow,
        limit,
        kick_before: parts.kick_before,
        kick_derivative,
        unknown,
        kick_after: transport::with_small_increment(&context, &parts.kick_after),
        shown_kick_after: parts.kick_after,
        previous: transport::previous(&context),
        half_step: context.half_step(),
        cleared,
        ends,
        closed,
        directions,
        symbols,
    })
}

/// Whether a Lagrangian with fewer known properties has the same equations: the terms of one variation, the kicks of
/// the transport form, and the limit. Fast comparisons come first.
pub fn has_equations(declared: &DeclaredFunction, known: &DeclaredFunction, derived: &Derivation) -> bool {
    let values = |of: &[Let]| of.iter().map(|one| one.value.clone()).collect::<Vec<_>>();
    if declared.expression != known.expression || values(&declared.lets) != values(&known.lets) {
        return false;
    }
    let mut symbols = declared.symbols.clone();
    let directions = directions(declared, &mut symbols);
    let (closed, lagrangian) = closed::multipliers(&declared.lets, &declared.expression, &mut symbols);
    let context = Context { declared, lagrangian: &lagrangian, symbols: &symbols, directions: &directions };
    let has_parts = || {
        let parts = transport::parts(&context, &derived.momentum, &derived.diamond);
        parts.kick_before == derived.kick_before && parts.kick_after == derived.shown_kick_after
    };
    let has_limit = |Limit { slope, inertia, bias, potential, .. }: Limit| {
        let known = &derived.limit;
        [slope, inertia, bias, potential].iter().eq([&known.slope, &known.inertia, &known.bias, &known.potential])
    };
    closed.iter().zip(&derived.closed).all(|(one, known)| one.pairing == known.pairing)
        && momentum_maps::right(&context) == derived.right_momentum
        && momentum_maps::left(&context) == derived.left_momentum
        && diamond::diamond(&context) == derived.diamond
        && has_parts()
        && limit::limit(&context, &derived.momentum).is_ok_and(has_limit)
}

/// The inputs of every rule.
struct Context<'a> {
    declared: &'a DeclaredFunction,
    /// The Lagrangian that is varied: `l_d`, with multipliers for its closed `let`s.
    lagrangian: &'a Expression,
    symbols: &'a Symbols,
    directions: &'a Directions,
}

impl Context<'_> {
    fn symbol(&self, id: SymbolId) -> Expression {
        Expression::symbol(id, self.symbols)
    }

    /// `E_k` of a factor.
    fn first(&self, factor: usize) -> Expression {
        self.directions.factors.get(factor).map_or_else(|| Expression::zero((1, 1)), |one| self.symbol(one.first))
    }

    /// `E_j` of a factor.
    fn second(&self, factor: usize) -> Expression {
        self.directions.factors.get(factor).map_or_else(|| Expression::zero((1, 1)), |one| self.symbol(one.second))
    }

    /// `F` of a factor with its inverse.
    fn increment(&self, factor: usize) -> (Expression, Expression) {
        let one = self.directions.factors.get(factor).map(|one| one.increment);
        one.map_or_else(
            || (Expression::zero((1, 1)), Expression::zero((1, 1))),
            |id| {
                let f = self.symbol(id);
                let inverse = if self.is_added(factor) {
                    f.clone().scaled(-Rational::ONE)
                } else {
                    Expression::inverse(id, self.symbols)
                };
                (f, inverse)
            },
        )
    }

    /// `E·w`, with an element of the algebra for each factor.
    fn along(&self, w: AdvectedSymbol, e: &dyn Fn(usize) -> Expression) -> Expression {
        action::along((&self.declared.group, self.symbols), w, e)
    }

    /// Whether the increments of a factor are vectors that are added.
    fn is_added(&self, factor: usize) -> bool {
        self.declared.group.factor(factor).is_added
    }

    /// `E F`, the variation of `F ↦ exp(sE) F`; for a translation `E`.
    fn turned(&self, factor: usize, e: &Expression) -> Expression {
        if self.is_added(factor) { e.clone() } else { self.product(e, &self.increment(factor).0) }
    }

    fn half_step(&self) -> Expression {
        self.symbol(self.declared.step).scaled(Rational::new(1, 2))
    }

    /// The momenta to differentiate, if the derivatives of a step are requested; closed `let`s stay closed.
    fn ends(&self, closed: &[ClosedLet], momenta: [&Expression; 2]) -> Option<Ends> {
        let small = |momentum: &Expression| {
            if closed.is_empty() { transport::in_small_increment(self, momentum) } else { momentum.clone() }
        };
        let moved = self.declared.advected.iter().map(|&w| (w.symbol, self.along(w, &|factor| self.first(factor))));
        self.declared.has_derivatives.then(|| Ends { momenta: momenta.map(small), moved: moved.collect() })
    }

    fn product(&self, left: &Expression, right: &Expression) -> Expression {
        left.times(right, self.symbols)
    }

    /// The components of an element of a factor's algebra with respect to its generators.
    fn components_of(&self, factor: usize, element: &Expression) -> Expression {
        algebra::components(self.declared.group.factor(factor), element, self.symbols)
    }

    fn substituted(&self, expression: &Expression, map: &BTreeMap<SymbolId, Expression>) -> Expression {
        crate::mathematics::symbolic::substitute(expression, map, self.symbols)
    }
}

fn directions(declared: &DeclaredFunction, symbols: &mut Symbols) -> Directions {
    let dimension = declared.group.dimension();
    let is_product = declared.group.is_product();
    let factors: Vec<(usize, &Group, SymbolId)> = {
        let factors = declared.group.factors().iter().zip(&declared.increments).enumerate();
        factors.map(|(place, (group, &increment))| (place, group, increment)).collect()
    };
    // Names have the number of the factor, if there are several.
    let matrices = |symbols: &mut Symbols, name: &str, stage, structure: &dyn Fn(&Group) -> Structure| {
        let of_factor = |&(place, group, _): &(usize, &Group, SymbolId)| {
            let name = if is_product { format!("{name}_{}", place + 1) } else { name.to_owned() };
            symbols.add(name, group.shape(), structure(group), stage)
        };
        factors.iter().map(of_factor).collect::<Vec<SymbolId>>()
    };
    let column =
        |symbols: &mut Symbols, name: &str, rows, stage| symbols.add(name, (rows, 1), Structure::General, stage);
    let general = |_: &Group| Structure::General;
    let algebra = |group: &Group| if group.orthogonal { Structure::Skew } else { Structure::General };
    let inverse = matrices(symbols, "F⁻¹", Stage::Iteration, &general);
    for (&(_, _, increment), &inverse) in factors.iter().zip(&inverse).filter(|((_, group, _), _)| !group.is_added) {
        symbols.set_inverse(increment, inverse);
    }
    let first = matrices(symbols, "E_k", Stage::Construction, &algebra);
    let second = matrices(symbols, "E_j", Stage::Construction, &algebra);
    let target = column(symbols, "a", dimension, Stage::Step);
    let small = matrices(symbols, "D", Stage::Iteration, &general);
    let small_inverse = matrices(symbols, "D⁻", Stage::Iteration, &general);
    let coordinates = column(symbols, "y", dimension, Stage::Iteration);
    let denominator = symbols.add("(1 + |y|²)", (1, 1), Structure::General, Stage::Iteration);
    let coordinate_direction = column(symbols, "δy", dimension, Stage::Construction);
    let velocity = matrices(symbols, "ξ̂", Stage::Construction, &algebra);
    let along = column(symbols, "v", dimension, Stage::Step);
    let scratch = symbols.add("x", (1, 1), Structure::General, Stage::Construction);
    let next = declared.advected.iter().map(|w| {
        let before = symbols.get(w.symbol);
        let (name, shape, structure) = (format!("{}⁺", before.name), before.shape, before.structure);
        symbols.add(name, shape, structure, Stage::Step)
    });
    let next = next.collect();
    let structures: Vec<Structure> = factors.iter().map(|&(_, _, id)| symbols.get(id).structure).collect();
    let next_increment: Vec<SymbolId> = factors
        .iter()
        .zip(structures)
        .map(|(&(place, group, _), structure)| {
            let name = if is_product { format!("F⁺_{}", place + 1) } else { "F⁺".to_owned() };
            symbols.add(name, group.shape(), structure, Stage::Iteration)
        })
        .collect();
    let of_factor = |&(place, _, increment): &(usize, &Group, SymbolId)| OfFactor {
        increment,
        first: first[place],
        second: second[place],
        small: small[place],
        inverse: inverse[place],
        small_inverse: small_inverse[place],
        next_increment: next_increment[place],
        velocity: velocity[place],
    };
    let factors = factors.iter().map(of_factor).collect();
    Directions { factors, target, coordinates, denominator, coordinate_direction, next, along, scratch }
}
