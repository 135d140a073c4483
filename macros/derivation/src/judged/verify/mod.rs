//! The self-check: derived terms and the emitted step against the declared expression, before anything is emitted.
//!
//! The declared tree is evaluated on numbers by itself, without the symbolic form, so a wrong rewrite can't agree with
//! itself. The numbers are those of the field of `p = 2⁶¹ − 1` elements, where nothing is rounded: two of them are equal, or
//! the derivation is wrong.
//!
//! # Why that is enough
//!
//! 1. *Points.* `F`, and each attitude among the parameters, is a product of Cayley transforms with random numbers for
//!    coordinates ([`Element::by_cayley`]), a symmetric matrix is `Z Zᵀ`, and all else is random. So each relation that
//!    may be used, `FᵀF = I`, `det F = 1`, `Jᵀ = J`, a last coordinate of one, holds at the point. Where `E³ = c E` the
//!    transform of `tE` is in the one-parameter group of `E`, and `(t_1, …, t_n) ↦ cay(t_1 E_1) ⋯ cay(t_n E_n)` has the
//!    derivative `2 E_k` at zero. So the points fill a neighbourhood of the identity, and are dense in the closure, in
//!    Zariski's sense, of the connected group: a rational function that vanishes at all of them vanishes on it.
//! 2. *Directions.* `(I + ε v̂) F` with `ε² = 0` is an element of the group to the order that counts. Dual numbers are exact,
//!    so a slope is the derivative along the group.
//! 3. *Functions.* Let each call `f(u)` stand for a new variable, one for each `f` and each value of `u`, with the relations of
//!    [`residue`](residue::Residue) and no others. The true functions obey these, and so do the derivatives that dual numbers
//!    take: so what is an identity in the variables is one of the true functions, on each of their branches, wherever both
//!    sides have values. In the field the variables are pseudorandom numbers, others at each point: also those of functions of
//!    constants, which would be the same at all points and count once. An identity that needs more, as `√u² = u` or
//!    `sin² + cos² = 1`, fails: that refuses too much, never too little. No derivation needs one.
//! 4. *Sureness.* A difference that isn't zero is a quotient of polynomials with rational coefficients in random numbers. That
//!    at a random point it has a value, and zero for it, has a probability of at most the numerator's degree over `p`, and two
//!    arguments of functions that differ have one value with a probability of their degree over `p` ([`degree`]). Points are
//!    independent, and those without a value are drawn again, a few times at most: what is wrong, whichever it is, passes if it
//!    is zero at some choice of the points that may be drawn. As many are compared as bring the sum over all choices below
//!    `2⁻¹⁰⁰`. That takes the numbers of the stream and the stand-ins for random ones, and it takes numerators that aren't
//!    multiples of `p`; where a constant of the declaration or of a graph is one, nothing is claimed, and nothing is refused for
//!    having no value.
//! 5. *What runs.* The graph of the [`Kernel`] is compared, stage by stage as a stepper calls it, with the derivatives of the
//!    terms that were compared before. A step needs `U(F) = μ + k₀` and `μ⁺ = Ad*_F (μ + k₀) + k₁⁺`: any `k₀` will do that
//!    doesn't depend on `F`, which is checked on the graph. The derivatives of a step are compared as the graph that is
//!    emitted; by the entries of an attitude among the parameters, with those of its momenta and not of the declaration,
//!    as `RᵀR = I` may have been used. Tokens are written from these graphs, and those of the momentum's Jacobian from
//!    the graph that was compared. Those of other single terms are written from graphs that the same code builds again.
//!
//! # Assumptions
//!
//! The tree has the meaning of the tokens, which a test checks on random declarations by evaluating their text
//! separately. The action of a group on advected parameters, which is written here a second time, the library's own
//! Cayley map, transport and solves, and the writing of tokens are right. Where a step is written as programs, `whole`
//! certifies all of these but the tokens.
//!
//! A group whose generators' multiples have no Cayley transforms in it has points that are power series instead,
//! `exp(t v̂_1) ⋯ exp(t v̂_n)`. There all is compared to the order to which series are known, without rounding, and without a
//! bound; so is, at a few points, that a discrete Lagrangian has its continuous one for a limit. What only real numbers have
//! stays with them: whether there is a value at all, and the sign of the inertia.

mod cayley;
mod constraint;
mod continuous;
pub mod degree;
pub mod dual;
pub mod evaluation;
mod exact;
pub mod identities;
mod inertia;
mod linear;
pub mod number;
mod orders;
mod outcome;
pub mod residue;
mod reversal;
pub mod sample;
pub mod series;
pub mod value;
mod velocity;

use std::collections::BTreeMap;

use super::places::variables;
use crate::declared::lower::is_orthogonal;
use crate::declared::{Declaration, FieldKind, Name, Shape};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Rational, SymbolId};
use crate::program::{Graph, Input, Kernel, Node, NodeId};

pub use cayley::{is_cayley_coordinates, nilpotency};
pub use constraint::ConstraintSlopes;
pub use constraint::{Row, constraint};
pub use continuous::Motion;
use evaluation::Evaluation;
use identities::{Identities, Terms};
pub use inertia::{KineticPart, kinetic_part};
use number::Number;
pub use orders::{TermMistake, not_smooth_at_identity, term_mistakes, without_value};
pub use outcome::{Findings, Objection, Sureness};
pub use sample::Subject;
use sample::{Element, Sample};
use value::Value;
pub use velocity::not_linear;

/// The number of points with real numbers, and the number of draws that may be tried for them.
const SAMPLES: usize = 3;
const DRAWS: u64 = 60;

type Values<T> = BTreeMap<Name, Value<T>>;

/// The values of all names, converted to another kind of number.
fn over<T: Number, U>(values: &Values<T>, of: impl Fn(T) -> U) -> Values<U> {
    values.iter().map(|(name, value)| (*name, value.over(&of))).collect()
}

/// Verifies the whole derivation. The error is the first term that disagrees.
pub fn verify(of: Subject, kernel: &Kernel) -> Result<Findings, Objection> {
    // Real numbers decide whether there is a value: the field has roots of all its elements.
    if Sample::draws(of).next().is_none() {
        return Err(Objection::NoValue);
    }
    let identities = Identities::new(of, kernel);
    let (sureness, reversed) = identities.confirmed()?;
    if sureness != Sureness::Multiple && !identities.are_smooth() {
        return Err(Objection::NotSmooth);
    }
    let is_symbolic = of.derived.adjoint_defect.is_zero();
    let self_adjointness = reversal::self_adjointness(reversed, is_symbolic).map_err(Objection::Disagrees)?;
    let Identities { stages, terms: Terms { graph, jacobian, .. }, derivatives, .. } = identities;
    let (jacobian, hypotheses) = ((graph, jacobian), Vec::new());
    Ok(Findings { self_adjointness, sureness, stages, jacobian, derivatives, hypotheses })
}

/// The values of operations.
fn evaluated<T: Number>(graph: &Graph, outputs: &[NodeId], inputs: &BTreeMap<SymbolId, Value<T>>) -> Vec<T> {
    evaluated_from(graph, outputs, inputs, &BTreeMap::new())
}

/// The values of operations, some of which are known.
fn evaluated_from<T: Number>(
    graph: &Graph,
    outputs: &[NodeId],
    inputs: &BTreeMap<SymbolId, Value<T>>,
    given: &BTreeMap<NodeId, T>,
) -> Vec<T> {
    let order = graph.reachable_from(outputs, &|id| given.contains_key(&id));
    let mut known = vec![T::UNDEFINED; order.last().map_or(0, |last| last.0 + 1)];
    let input =
        |input: Input| inputs.get(&input.symbol).map_or(T::UNDEFINED, |value| value.at(input.row, input.column));
    for id in order {
        let at = |operand: NodeId| known[operand.0];
        let made = || match graph.node(id) {
            Node::Constant(value) => T::of(value),
            Node::Input(entry) => input(entry),
            Node::Negate(a) => -at(a),
            Node::Add(a, b) => at(a) + at(b),
            Node::Subtract(a, b) => at(a) - at(b),
            Node::Multiply(a, b) => at(a) * at(b),
            Node::Divide(a, b) => at(a) / at(b),
            Node::Apply(function, a) => at(a).apply(function),
        };
        known[id.0] = given.get(&id).copied().unwrap_or_else(made);
    }
    outputs.iter().map(|output| known[output.0]).collect()
}

fn dot<T: Number>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::ZERO, |sum, (&x, &y)| sum + x * y)
}

/// The components of each factor.
fn shares<'a, T>(group: &'a Group, mut components: &'a [T]) -> impl Iterator<Item = (&'a Group, &'a [T])> {
    group.factors().iter().map(move |own| {
        let (share, rest) = components.split_at(own.dimension());
        components = rest;
        (own, share)
    })
}

/// The elements of the factors' algebras with these components.
fn algebra<T: Number>(group: &Group, components: &[T]) -> Vec<Value<T>> {
    shares(group, components).map(|(own, share)| Value::combination(own.size, &own.generators, share)).collect()
}

/// The components of elements of the factors' algebras.
fn components_of<T: Number>(group: &Group, elements: &[Value<T>]) -> Vec<T> {
    let of_factor = |(own, element): (&Group, &Value<T>)| {
        let mut components = vec![T::ZERO; own.dimension()];
        for (k, row, column, share) in own.dual() {
            components[k] = components[k] + T::of(share) * element.at(row, column);
        }
        components
    };
    group.factors().iter().zip(elements).flat_map(of_factor).collect()
}

/// A stream of numbers between zero and one.
fn stream(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    // A linear congruence (Knuth's MMIX constants) is random enough for sample points.
    #[allow(clippy::cast_precision_loss)] // 53 bits are left
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The exponential series of an element of the algebra that is small or a power of `h`.
fn exponential<T: Number>(x: &Value<T>) -> Value<T> {
    let one = Value::identity(x.rows);
    let next = |(power, sum): (Value<T>, Value<T>), order| {
        let factor = T::of(Rational::new(1, order));
        let power = power.times(x).map(|entry| entry * factor);
        let sum = sum.plus(&power);
        (power, sum)
    };
    (1..20).fold((one.clone(), one), next).1
}

/// `cay(±x) = (I ∓ x)⁻¹ (I ± x) = I + 2 (x² ± x)/(1 − c)` if `x³ = c x`.
fn cayley<T: Number>(x: &Value<T>, c: T) -> [Value<T>; 2] {
    let (square, share) = (x.times(x), (T::ONE + T::ONE) / (T::ONE - c));
    let of = |x: &Value<T>| Value::identity(x.rows).plus(&square.plus(x).map(|entry| entry * share));
    [of(x), of(&x.map(|entry| -entry))]
}

/// The increments of all factors, from their matrices.
fn increments<T: Number>(group: &Group, matrices: &[Value<T>]) -> Values<T> {
    let value = |(own, matrix): (&Group, &Value<T>)| if own.is_added { translation(matrix) } else { matrix.clone() };
    let values = group.factors().iter().zip(matrices).map(value);
    values.enumerate().map(|(factor, value)| (Name::Increment(factor), value)).collect()
}

/// Values of all fields and advected parameters.
fn parameters<T: Number>(declaration: &Declaration, number: &mut impl FnMut() -> T) -> Values<T> {
    let value = |(name, kind): (Name, FieldKind)| match turned(declaration, name, kind) {
        Some(rows) if rows > 3 => (name, rotation(rows, number)),
        _ => (name, parameter(kind, number)),
    };
    variables(declaration).concat().into_iter().map(value).collect()
}

/// The rows of an attitude among the parameters that is an orthogonal matrix.
fn turned(declaration: &Declaration, name: Name, kind: FieldKind) -> Option<usize> {
    let Name::Advected(index) = name else { return None };
    let is_attitude = matches!(kind, FieldKind::Configuration(_));
    let is_turned = is_attitude && is_orthogonal(&declaration.group, declaration.advected[index].seen);
    is_turned.then(|| kind.shape().rows())
}

/// A random rotation of more than three rows: a product of Cayley transforms of turns in all planes of two axes. That of a
/// skew matrix has no short form there.
fn rotation<T: Number>(rows: usize, number: &mut impl FnMut() -> T) -> Value<T> {
    let planes = (0..rows).flat_map(|row| (0..row).map(move |column| (row, column)));
    planes.fold(Value::identity(rows), |product, (row, column)| {
        let turn = number();
        let [forwards, _] = cayley(
            &Value::new(rows, rows, |i, j| match (i, j) {
                place if place == (row, column) => turn,
                place if place == (column, row) => -turn,
                _ => T::ZERO,
            }),
            -(turn * turn),
        );
        product.times(&forwards)
    })
}

/// Displacements of all factors, at the beginning of a step and at its end.
fn displacements<T: Number>(group: &Group, number: &mut impl FnMut() -> T) -> Values<T> {
    let factors = group.factors().iter().enumerate();
    let of_factor = factors.flat_map(|(factor, own)| {
        let names = [Name::DisplacementBefore(factor), Name::DisplacementAfter(factor)];
        names.map(|name| (name, FieldKind::Vector(own.dimension())))
    });
    of_factor.map(|(name, kind)| (name, parameter(kind, number))).collect()
}

/// The velocities of all factors, from their components.
fn velocities<T: Number>(group: &Group, components: &[T]) -> Values<T> {
    let each = shares(group, components).enumerate();
    each.map(|(factor, (_, own))| (Name::Velocity(factor), Value::column(own))).collect()
}

/// `d` of the matrix `[I, d; 0, 1]`.
fn translation<T: Number>(matrix: &Value<T>) -> Value<T> {
    Value::new(matrix.rows - 1, 1, |row, _| matrix.at(row, matrix.rows - 1))
}

/// A random value with the properties of a field's type.
fn parameter<T: Number>(kind: FieldKind, number: &mut impl FnMut() -> T) -> Value<T> {
    let Shape::Matrix(rows, columns) = kind.shape() else {
        return Value::scalar(T::of(Rational::new(1, 2)) + number());
    };
    let two = T::ONE + T::ONE;
    let any = Value::new(rows, columns, |_, _| two * number() - T::ONE);
    match kind {
        FieldKind::Point(_) => Value::new(rows, 1, |row, _| if row + 1 < rows { any.at(row, 0) } else { T::ONE }),
        FieldKind::SymmetricInertia | FieldKind::StandardInertia => any.times(&any.transpose()),
        FieldKind::DiagonalInertia => Value::diagonal(rows, |row| T::ONE + any.at(row, row)),
        // The Cayley transform of a skew matrix of three rows is a rotation.
        FieldKind::Configuration(_) => {
            let skew = any.zip(&any.transpose(), |x, y| x - y);
            let [rotation, _] = cayley(&skew, skew.times(&skew).trace() * T::of(Rational::new(1, 2)));
            rotation
        }
        _ => any,
    }
}
