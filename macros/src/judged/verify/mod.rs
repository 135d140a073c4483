//! The self-check: derived terms and the emitted step against the declared expression, before anything is emitted.
//!
//! The declared tree is evaluated on numbers by itself, without the symbolic form, so a wrong rewrite can't agree with
//! itself. First derivatives are compared with its central differences; what is built from them, with them.

mod cayley;
mod constraint;
mod continuous;
mod degree;
mod dual;
mod evaluation;
mod exact;
mod force;
mod inertia;
mod linear;
mod number;
mod orders;
mod residue;
mod reversal;
mod series;
mod step;
mod terms;
#[cfg(test)]
mod tests;
mod value;

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::declared::lower::Lowered;
use crate::declared::{Declaration, FieldKind, Name, Role, Shape, Tree};
use crate::mathematics::derive::{Derived, Seen, SelfAdjointness};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Rational, SymbolId, Variance};
use crate::program::{Graph, Input, Kernel, NodeId};

pub(super) use cayley::{is_cayley_coordinates, nilpotency};
pub(super) use constraint::{Row, constraint};
#[cfg(test)]
pub(crate) use continuous::energy_is_kept;
pub(crate) use continuous::{
    Lagrangian, disagreement, has_limit, kinetic_hessian, limit_disagrees, rest_disagrees, right_symmetries,
};
use evaluation::Evaluation;
pub(super) use force::force;
pub(super) use inertia::{KineticPart, kinetic_part};
use number::Number;
pub(super) use orders::{TermMistake, not_smooth_at_identity, term_mistakes};
use step::Step;
use terms::Terms;
use value::Value;

/// Central differences at this spacing are right to about eight digits.
const SPACING: f64 = 1e-5;
/// What they leave, relative to the size of the terms.
const TOLERANCE: f64 = 1e-5;
/// So many points are compared, of so many that are tried.
const SAMPLES: usize = 3;
const DRAWS: u64 = 60;

/// What is wrong with a derivation, or with the expression that it is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unconfirmed {
    /// A derived term disagrees with the declaration.
    Disagrees(&'static str),
    /// The declaration has no value at any point that was tried.
    NoValue,
    /// Its differences tell nothing at any point that was tried.
    Rough,
    /// It isn't smooth where `F = I`.
    NotSmooth,
}

/// What is found at one point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    /// The declaration has no value there, or differences that tell nothing.
    Untold,
    /// A derived term disagrees with the declaration.
    Disagrees(&'static str),
}

/// Checks all that was derived. The error is the first term that disagrees.
pub(super) fn verify(
    declaration: &Declaration,
    tree: &Rc<Tree>,
    lowered: &Lowered,
    derived: &Derived,
    kernel: &Kernel,
) -> Result<SelfAdjointness, Unconfirmed> {
    let (terms, step) = (Terms::new(derived), Step { derived, kernel });
    let samples = confirmed(Sample::draws(declaration, lowered, derived, tree), |sample| {
        terms.check(sample, tree).and_then(|()| step.check(sample, &terms))
    })?;
    if !samples.iter().any(|sample| terms.are_finite_at_identity(sample)) {
        return Err(Unconfirmed::NotSmooth);
    }
    let exact = || exact::is_self_adjoint(declaration, tree, lowered, derived);
    reversal::self_adjointness(&samples, tree, &derived.adjoint_defect, exact).map_err(Unconfirmed::Disagrees)
}

/// The first points at which what was derived agrees with the declaration.
fn confirmed<S>(
    draws: impl Iterator<Item = S>,
    check: impl Fn(&S) -> Result<(), Fault>,
) -> Result<Vec<S>, Unconfirmed> {
    let (mut samples, mut nothing) = (Vec::new(), Unconfirmed::NoValue);
    for sample in draws {
        match check(&sample) {
            Ok(()) => samples.push(sample),
            Err(Fault::Untold) => nothing = Unconfirmed::Rough,
            Err(Fault::Disagrees(term)) => return Err(Unconfirmed::Disagrees(term)),
        }
        if samples.len() == SAMPLES {
            break;
        }
    }
    if samples.is_empty() { Err(nothing) } else { Ok(samples) }
}

/// The slope of a function at zero.
fn slope(function: &dyn Fn(f64) -> f64, spacing: f64) -> f64 {
    (function(spacing) - function(-spacing)) / (2.0 * spacing)
}

/// Whether a derivative is that of a function at zero, whose terms have that size.
///
/// Where another spacing gives another slope, neither is right: near a pole, or where a function is so steep that its
/// differences lose their digits.
fn compare(term: &'static str, found: f64, function: &dyn Fn(f64) -> f64, size: f64) -> Result<(), Fault> {
    let allowed = TOLERANCE * size;
    let expected = slope(function, SPACING);
    if (found - expected).abs() <= allowed {
        return Ok(());
    }
    let finer = slope(function, 0.1 * SPACING);
    if (found - finer).abs() <= allowed {
        return Ok(());
    }
    let is_told = (finer - expected).abs() <= 0.5 * allowed;
    Err(if is_told { Fault::Disagrees(term) } else { Fault::Untold })
}

/// A function of one number whose values are asked for more than once.
fn remembered<T: Clone>(function: impl Fn(f64) -> T) -> impl Fn(f64) -> T {
    let known = std::cell::RefCell::new(BTreeMap::new());
    move |t| known.borrow_mut().entry(t.to_bits()).or_insert_with(|| function(t)).clone()
}

fn evaluated(graph: &Graph, outputs: &[NodeId], inputs: &BTreeMap<SymbolId, Value>) -> Vec<f64> {
    graph.evaluate(outputs, &|input: Input| {
        inputs.get(&input.symbol).map_or(f64::NAN, |value| value.at(input.row, input.column))
    })
}

/// Numbers between zero and one.
fn stream(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    // A linear congruence (Knuth's MMIX constants) is random enough for sample points.
    #[allow(clippy::cast_precision_loss)] // 53 bits are left
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// `exp(s E_k)`, where `s` is small.
fn turn(group: &Group, k: usize, s: f64) -> Value {
    let entries = group.generators.get(k).map_or(&[][..], Vec::as_slice);
    exponential(group, &Value::square(group.size, entries).map(|entry: f64| s * entry))
}

/// The exponential, by its series, of an element of the algebra that is small or a power of `h`.
fn exponential<T: Number>(group: &Group, exponent: &Value<T>) -> Value<T> {
    by_blocks(group, exponent, |exponent| {
        let mut power = Value::identity(exponent.rows);
        let mut sum = power.clone();
        for order in 1..20 {
            let factor = T::of(Rational::new(1, order));
            power = power.times(exponent).map(|x| x * factor);
            if power.entries.iter().all(|entry| entry.is_lost()) {
                break;
            }
            sum = sum.plus(&power);
        }
        sum
    })
}

/// Numbers for all names.
#[derive(Clone)]
struct Sample<'a, T = f64> {
    derived: &'a Derived,
    /// Of a product all increments, in blocks.
    increment: Value<T>,
    inverse: Value<T>,
    values: BTreeMap<Name, Value<T>>,
    symbols: BTreeMap<SymbolId, Name>,
    advected: Vec<(Name, Variance, Seen)>,
}

impl<'a> Sample<'a> {
    /// The points at which the declaration has a value. The later ones are farther away, and may be anywhere.
    fn draws(
        declaration: &'a Declaration,
        lowered: &'a Lowered,
        derived: &'a Derived,
        tree: &'a Rc<Tree>,
    ) -> impl Iterator<Item = Self> {
        let samples = (1..=DRAWS).map(|seed| Self::new(declaration, lowered, derived, seed));
        samples.filter(|sample| sample.declared(tree).is_finite())
    }

    fn new(declaration: &Declaration, lowered: &Lowered, derived: &'a Derived, seed: u64) -> Self {
        let mut number = stream(seed);
        let group = &declaration.group;
        let (mut increment, mut inverse) = (Value::identity(group.size), Value::identity(group.size));
        for k in 0..group.dimension() {
            let angle = 0.6 * number() - 0.3;
            increment = increment.times(&turn(group, k, angle));
            inverse = turn(group, k, -angle).times(&inverse);
        }
        let mut sample = Self::with_numbers(declaration, lowered, derived, (increment, inverse), &mut number);
        // From one draw in five on, another scale for each parameter, and another sign for scalars.
        let reach = f64::from(u32::try_from(seed / (DRAWS / 5)).unwrap_or(0));
        for (name, value) in sample.values.iter_mut().filter(|_| reach > 0.0) {
            let (scale, sign) = ((8.0 * number() - 2.0).exp2().powf(reach / 4.0), number() < 0.5);
            let kind = match name {
                Name::Field(index) => declaration.fields.get(*index).map(|field| field.kind),
                Name::Advected(index) => Some(declaration.advected_kind(*index)),
                _ => None,
            };
            *value = match kind {
                None | Some(FieldKind::Point(_) | FieldKind::Configuration(_)) => continue,
                Some(FieldKind::Scalar) if sign => value.map(|x| -scale * x),
                Some(_) => value.map(|x| scale * x),
            };
        }
        sample
    }

    /// `F` turned by `exp(s E_k)` from the left.
    fn turned(&self, k: usize, s: f64) -> Value {
        turn(&self.derived.group, k, s).times(&self.increment)
    }

    /// The values of all symbols at an increment: of the names, and of what the derivation adds.
    fn inputs(&self, f: &Value) -> BTreeMap<SymbolId, Value> {
        let mut inputs: BTreeMap<SymbolId, Value> = BTreeMap::new();
        for (symbol, name) in &self.symbols {
            inputs.extend(self.values.get(name).map(|value| (*symbol, value.clone())));
        }
        for (factor, one) in self.derived.directions.factors.iter().enumerate() {
            let group = &self.derived.group;
            let f = block(group, f, factor);
            if group.factor(factor).is_added {
                let d = translation(&f);
                inputs.extend([(one.small, d.clone()), (one.increment, d)]);
                continue;
            }
            let (inverse, identity) = (f.inverse(), Value::identity(f.rows));
            inputs.insert(one.small, f.zip(&identity, |x, y| x - y));
            inputs.insert(one.increment, f);
            inputs.insert(one.small_inverse, inverse.zip(&identity, |x, y| x - y));
            inputs.insert(one.inverse, inverse);
        }
        inputs
    }

    /// `l_d` at another step.
    fn at_step(&self, tree: &Rc<Tree>, h: f64) -> f64 {
        let mut values = self.values.clone();
        values.insert(Name::Step, Value::scalar(h));
        Evaluation::new(&values).of(tree).first()
    }

    /// `l_d` at another `F`, with all advected parameters moved by a group element, given with its inverse.
    fn moved(&self, tree: &Rc<Tree>, f: &Value, element: (&Value, &Value)) -> f64 {
        let values = self.moved_values(f, element);
        Evaluation::new(&values).of(tree).first()
    }
}

impl<'a, T: Number> Sample<'a, T> {
    /// At a group element, given with its inverse, with numbers that are taken to lie between zero and one.
    fn with_numbers(
        declaration: &Declaration,
        lowered: &Lowered,
        derived: &'a Derived,
        (increment, inverse): (Value<T>, Value<T>),
        mut number: impl FnMut() -> T,
    ) -> Self {
        let mut values = BTreeMap::from_iter(increments(&declaration.group, &increment));
        let tenth = T::of(Rational::new(1, 10));
        values.insert(Name::Step, Value::scalar(tenth + tenth * number()));
        for (index, field) in declaration.fields.iter().enumerate() {
            values.insert(Name::Field(index), parameter(field.kind, &mut number));
        }
        if declaration.role == Role::Force {
            values.extend(displacements(&declaration.group, &mut number));
        }
        let mut advected = Vec::new();
        for index in 0..declaration.advected.len() {
            let kind = declaration.advected_kind(index);
            values.insert(Name::Advected(index), parameter(kind, &mut number));
            let seen = declaration.advected.get(index).map_or(Seen::From(0), |w| w.seen);
            advected.push((Name::Advected(index), kind.variance(), seen));
        }
        let symbols = lowered.names.iter().map(|(name, id)| (*id, *name)).collect();
        Self { derived, increment, inverse, values, symbols, advected }
    }

    /// `l_d` at this point.
    fn declared(&self, tree: &Rc<Tree>) -> T {
        Evaluation::new(&self.values).of(tree).first()
    }

    /// `−l_d` turned back: at `F⁻¹`, `F⁻¹·w` and `−h`.
    fn reversed(&self, tree: &Rc<Tree>) -> T {
        let mut values = self.moved_values(&self.inverse, (&self.inverse, &self.increment));
        if let Some(h) = self.values.get(&Name::Step) {
            values.insert(Name::Step, h.map(|h| -h));
        }
        -Evaluation::new(&values).of(tree).first()
    }

    fn moved_values(&self, f: &Value<T>, (g, inverse): (&Value<T>, &Value<T>)) -> BTreeMap<Name, Value<T>> {
        let mut values = self.values.clone();
        let group = &self.derived.group;
        values.extend(increments(group, f));
        for (name, variance, seen) in &self.advected {
            let Some(w) = self.values.get(name) else { continue };
            let added = |moving: &Value<T>, factor| translation(&block(group, moving, factor));
            let factor = match *seen {
                Seen::From(factor) => factor,
                Seen::Relative { of, from } if group.factor(of).is_added => {
                    values.insert(*name, added(g, from).plus(w).plus(&added(inverse, of)));
                    continue;
                }
                Seen::Configuration(of) if group.factor(of).is_added => {
                    values.insert(*name, w.plus(&added(inverse, of)));
                    continue;
                }
                Seen::Relative { of, from } => {
                    let moved = block(group, g, from).times(w).times(&block(group, inverse, of));
                    values.insert(*name, moved);
                    continue;
                }
                Seen::Configuration(of) => {
                    values.insert(*name, w.times(&block(group, inverse, of)));
                    continue;
                }
            };
            let (g, inverse) = (&block(group, g, factor), &block(group, inverse, factor));
            let moved = match variance {
                Variance::Vector => g.times(w),
                Variance::Covector => inverse.transpose().times(w),
                Variance::Contravariant => g.times(w).times(&g.transpose()),
                Variance::Covariant => inverse.transpose().times(w).times(inverse),
                Variance::Mixed => g.times(w).times(inverse),
                Variance::Fixed => w.clone(),
            };
            values.insert(*name, moved);
        }
        values
    }
}

/// The block of a matrix that belongs to a factor of the group; of a group that isn't a product all of it.
fn block<T: Number>(group: &Group, all: &Value<T>, factor: usize) -> Value<T> {
    let (start, size) = (group.row_of(factor), group.factors().get(factor).map_or(0, |factor| factor.size));
    Value::new(size, size, |row, column| all.at(start + row, start + column))
}

/// The increments of all factors.
fn increments<T: Number>(group: &Group, all: &Value<T>) -> Vec<(Name, Value<T>)> {
    let value = |factor: usize| {
        let own = block(group, all, factor);
        if group.factor(factor).is_added { translation(&own) } else { own }
    };
    (0..group.factors().len()).map(|factor| (Name::Increment(factor), value(factor))).collect()
}

/// Displacements of all factors, at the beginning of a step and at its end.
fn displacements<T: Number>(group: &Group, number: &mut impl FnMut() -> T) -> Vec<(Name, Value<T>)> {
    let factors = group.factors().iter().enumerate();
    let of_factor = factors.flat_map(|(factor, own)| {
        let names = [Name::DisplacementBefore(factor), Name::DisplacementAfter(factor)];
        names.map(|name| (name, FieldKind::Vector(own.dimension())))
    });
    of_factor.map(|(name, kind)| (name, parameter(kind, number))).collect()
}

/// The velocities of all factors, of the components of all.
fn velocities<T: Number>(group: &Group, components: &[T]) -> Vec<(Name, Value<T>)> {
    let value = |(factor, own): (usize, &Group)| {
        let entries = components.iter().skip(group.component_of(factor)).take(own.dimension()).copied().collect();
        (Name::Velocity(factor), Value { rows: own.dimension(), columns: 1, entries })
    };
    group.factors().iter().enumerate().map(value).collect()
}

/// `d` of the matrix `[I, d; 0, 1]`.
fn translation<T: Number>(matrix: &Value<T>) -> Value<T> {
    Value::new(matrix.rows - 1, 1, |row, _| matrix.at(row, matrix.rows - 1))
}

/// The inverse of an element, block by block.
fn inverse_of<T: Number>(group: &Group, all: &Value<T>) -> Value<T> {
    by_blocks(group, all, Value::inverse)
}

/// What is made of each block, in its place.
fn by_blocks<T: Number>(group: &Group, all: &Value<T>, of_block: impl Fn(&Value<T>) -> Value<T>) -> Value<T> {
    let blocks: Vec<(usize, Value<T>)> =
        (0..group.factors().len()).map(|factor| (group.row_of(factor), of_block(&block(group, all, factor)))).collect();
    Value::new(group.size, group.size, |row, column| {
        let own = blocks.iter().rev().find(|(start, _)| *start <= row);
        let entry = own.and_then(|(start, own)| own.checked_at(row - start, column.checked_sub(*start)?));
        entry.unwrap_or(T::ZERO)
    })
}

/// A value that has what a field's type promises.
fn parameter<T: Number>(kind: FieldKind, number: &mut impl FnMut() -> T) -> Value<T> {
    let Shape::Matrix(rows, columns) = kind.shape() else {
        return Value::scalar(T::of(Rational::new(1, 2)) + number());
    };
    let two = T::ONE + T::ONE;
    let entries: Vec<T> = (0..rows * columns).map(|_| two * number() - T::ONE).collect();
    let any = Value { rows, columns, entries };
    match kind {
        FieldKind::Point(_) => Value::new(rows, 1, |row, _| if row + 1 < rows { any.at(row, 0) } else { T::ONE }),
        FieldKind::SymmetricInertia => any.times(&any.transpose()),
        FieldKind::DiagonalInertia => Value::diagonal(rows, |row| T::ONE + any.at(row, row)),
        // A Cayley transform is a rotation, whatever the skew matrix.
        FieldKind::Configuration(_) => {
            let skew = any.zip(&any.transpose(), |x, y| x - y);
            let identity = Value::identity(rows);
            identity.zip(&skew, |x, y| x - y).inverse().times(&identity.plus(&skew))
        }
        _ => any,
    }
}
