//! The order of each term of a declared expression as `h → 0`, with `F = exp(h ξ̂)` and numbers for all other names.
//!
//! Only differences of a Lagrangian count: a term that is constant in `F` and `w` changes no equation. A potential is a
//! term that depends on `w` at `F = I`, and is of the first order in `h`, as is the work of a force.

use std::rc::Rc;

use super::degree::Content;
use super::evaluation::Evaluation;
use super::number::Number as _;
use super::residue::Residue;
use super::sample::{Element, along_motion, draws};
use super::series::Series;
use super::value::Value;
use super::{displacements, increments, parameters, velocities};
use crate::declared::{Declaration, Kind, Name, Role, Shape, Tree, parts};
use crate::mathematics::symbolic::Function;

/// The limit on splitting sums; `let`s can repeat shared terms more often than a person would.
const MOST_SPLITS: usize = 200;

/// The limit on factors around a sum.
const MOST_FACTORS: usize = 10;

/// A mistake in a term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TermMistake {
    /// A divisor is zero for all parameters.
    ZeroDivisor,
    /// The argument of a root or a logarithm is zero for all parameters.
    FunctionOfZero,
    /// A root of an odd power of `h`, or a logarithm of any power.
    FunctionOfStep,
    /// A potential is of this order in `h`, not of the first.
    Potential(i32),
    /// A part with `F` alone is of this order in `h` along a motion, and vanishes.
    Vanishing(i32),
    /// A part is of this order in `h` for a fixed `F`, below −1.
    TooSingular(i32),
    /// The term doesn't depend on `F`.
    Constant,
    /// The term is zero for all `F` and all parameters.
    Zero,
    /// The terms with `F` alone are together the same for all `F`.
    Cancelling,
    /// The whole Lagrangian is the same for all `F`, velocities and advected parameters.
    NoMotion,
    /// Virtual work is of this order in `h`, not of the first.
    Work(i32),
    /// The work is zero for all parameters.
    NoWork,
}

/// The mistakes of the terms, at their places; empty if a constant vanishes in the field alone.
pub fn term_mistakes(declaration: &Declaration, tree: &Rc<Tree>) -> Vec<(Rc<Tree>, TermMistake)> {
    if Content::of_tree(tree).has_multiple {
        return Vec::new();
    }
    let points = points(declaration);
    let [turned, _, moving, ..] = &points;
    if let Some(found) = singular(tree, turned).or_else(|| function_of_step(tree, moving)) {
        return vec![found];
    }
    let is_continuous = declaration.continuous.is_some();
    // The discretisation of an `l` has the right order as a whole; its terms needn't.
    if is_continuous && has(tree, |kind| IS_INCREMENT(kind) || IS_STEP(kind)) {
        return Vec::new();
    }
    let at = points.each_ref().map(Evaluation::new);
    let mut search = Search { role: declaration.role, at, splits: MOST_SPLITS, found: Vec::new() };
    let whole = search.behaviour(tree);
    let terms = search.terms(tree);
    search.report_zero(&terms);
    let is_idle = search.role == Role::Lagrangian && whole.is_idle() && search.found.is_empty();
    if is_idle && !search.has_written_zero(tree) {
        let is_one = terms.len() == 1 && has(tree, IS_INCREMENT);
        return vec![(tree.clone(), if is_one { TermMistake::Constant } else { TermMistake::NoMotion })];
    }
    if is_continuous {
        return search.found;
    }
    search.splits = MOST_SPLITS;
    let is_too_large = search.too_large(tree).is_some();
    match search.role {
        Role::Force if whole.along.is_zero() => return vec![(tree.clone(), TermMistake::NoWork)],
        // Work that isn't linear in the displacements is reported by the derivation.
        Role::Force if !(whole.value - whole.at_rest).is_zero() => {}
        _ if is_too_large => search.report_too_large(tree),
        _ => search.report_vanishing(&terms, &whole),
    }
    if search.found.is_empty() {
        search.report_cancelling(&terms);
    }
    search.found
}

/// The part that isn't smooth at `F = I`: a divisor, or the argument of a function, is zero there.
pub fn not_smooth_at_identity(declaration: &Declaration, tree: &Rc<Tree>) -> Option<(Rc<Tree>, TermMistake)> {
    let [.., at_rest, _] = &points(declaration);
    singular(tree, at_rest)
}

/// The first part without a value at all of the drawn parameters, if there is one.
pub fn without_value(declaration: &Declaration, tree: &Rc<Tree>) -> Option<Rc<Tree>> {
    let points: Vec<super::Values<f64>> = draws(declaration).map(|(_, values)| values).collect();
    let mut at_points: Vec<Evaluation> = points.iter().map(Evaluation::new).collect();
    let mut is_defined =
        |part: &Rc<Tree>| at_points.iter_mut().any(|at| at.of(part).entries.iter().all(|entry| entry.is_defined()));
    parts(tree).into_iter().find(|part| !is_defined(part)).cloned()
}

type Values = super::Values<Series>;

/// Numbers for all names, with `h` itself: at some `F`, at another, at `F = exp(h ξ̂)`, at `F = I`, and there with
/// other velocities and advected parameters, or for a force with twice the displacements.
fn points(declaration: &Declaration) -> [Values; 5] {
    let (group, mut number) = (&declaration.group, Residue::stream(1));
    let [turned, turned_further] = [(); 2].map(|()| {
        let element = Element::by_cayley(group, &mut number);
        // A group without Cayley transforms may use any matrix here.
        let element = element.unwrap_or_else(|| Element::by_exponentials(group, &mut number));
        element.matrices.iter().map(|matrix| matrix.over(Series::constant)).collect::<Vec<_>>()
    });
    let mut number = || Series::constant(number());
    let speeds: Vec<Series> = group.generators.iter().map(|_| number()).collect();
    let mut at_rest = Values::from([(Name::Step, Value::scalar(Series::STEP))]);
    at_rest.extend(increments(group, &Element::identity(group).matrices));
    at_rest.extend(velocities(group, &speeds));
    at_rest.extend(displacements(group, &mut number));
    at_rest.extend(parameters(declaration, &mut number));
    let mut elsewhere = at_rest.clone();
    let others = parameters(declaration, &mut number).into_iter();
    let is_moved = |name: Name| declaration.role != Role::Force && matches!(name, Name::Advected(_));
    elsewhere.extend(others.filter(|(name, _)| is_moved(*name)));
    let others: Vec<Series> = group.generators.iter().map(|_| number()).collect();
    elsewhere.extend(velocities(group, &others));
    for (name, value) in &mut elsewhere {
        if matches!(name, Name::DisplacementBefore(_) | Name::DisplacementAfter(_)) {
            *value = value.plus(value);
        }
    }
    let with_increment = |increment: &[Value<Series>]| {
        let mut values = at_rest.clone();
        values.extend(increments(group, increment));
        values
    };
    let moving = with_increment(&along_motion(group, &speeds));
    [with_increment(&turned), with_increment(&turned_further), moving, at_rest, elsewhere]
}

/// The orders of a term in `h`.
struct Behaviour {
    /// The term at `F = exp(h ξ̂)`; for a Lagrangian its difference to `F = I`.
    along: Series,
    /// The term at `F = I`: for a Lagrangian its difference to other velocities and advected parameters, for a force
    /// the difference to twice the displacements.
    at_rest: Series,
    /// The value at `F = I`.
    value: Series,
    /// The difference between two fixed `F`.
    fixed: Series,
    /// The value at a fixed `F`.
    turned: Series,
}

impl Behaviour {
    /// Whether the term is the same for all `F`, velocities and advected parameters, or of a force for all
    /// displacements.
    fn is_idle(&self) -> bool {
        [self.along, self.at_rest, self.fixed].into_iter().all(Series::is_zero)
    }

    fn is_zero(&self) -> bool {
        self.is_idle() && self.value.is_zero() && self.turned.is_zero()
    }
}

struct Search<'a> {
    role: Role,
    /// The evaluations at the points.
    at: [Evaluation<'a, Series>; 5],
    /// The number of sums that may still be split.
    splits: usize,
    found: Vec<(Rc<Tree>, TermMistake)>,
}

impl Search<'_> {
    /// The two terms of [`split_within`], until the limit on splits.
    fn split(&mut self, tree: &Rc<Tree>) -> Option<[Rc<Tree>; 2]> {
        self.splits = self.splits.checked_sub(1)?;
        split_within(tree, MOST_FACTORS)
    }

    fn behaviour(&mut self, tree: &Rc<Tree>) -> Behaviour {
        let [turned, further, moving, value, elsewhere] = self.at.each_mut().map(|at| at.of(tree).first());
        if self.role == Role::Force {
            return Behaviour { along: moving, at_rest: elsewhere - value, value, fixed: value, turned };
        }
        Behaviour { along: moving - value, at_rest: value - elsewhere, value, fixed: turned - further, turned }
    }

    /// The mistake for which the limit `h → 0` doesn't exist, if there is one. The first derivative of the kinetic part
    /// is checked elsewhere.
    fn too_large(&mut self, tree: &Rc<Tree>) -> Option<TermMistake> {
        let Behaviour { along, at_rest, fixed, .. } = self.behaviour(tree);
        if ![along, at_rest, fixed].iter().all(|series| series.is_defined()) {
            return None;
        }
        if self.role == Role::Force {
            return low(along).map(TermMistake::Work);
        }
        low(at_rest).map(TermMistake::Potential).or_else(|| {
            let power = fixed.order().filter(|&power| power < -1)?;
            low(along).map(|_| TermMistake::TooSingular(power))
        })
    }

    /// Reports the terms that are too large, unless they cancel in a sum.
    fn report_too_large(&mut self, tree: &Rc<Tree>) {
        let Some(mistake) = self.too_large(tree) else { return };
        let before = self.found.len();
        for part in self.split(tree).into_iter().flatten() {
            self.report_too_large(&part);
        }
        if self.found.len() == before {
            self.found.push((tree.clone(), mistake));
        }
    }

    /// The terms of a sum; a sum that is zero is one term.
    fn terms(&mut self, tree: &Rc<Tree>) -> Vec<Rc<Tree>> {
        let is_zero = self.behaviour(tree).is_zero();
        match (!is_zero).then(|| self.split(tree)).flatten() {
            Some(parts) => parts.iter().flat_map(|part| self.terms(part)).collect(),
            None => vec![tree.clone()],
        }
    }

    /// Whether a written number in the term, or a result of written numbers alone, is zero: a macro may have written
    /// it.
    fn has_written_zero(&mut self, tree: &Rc<Tree>) -> bool {
        let [at, ..] = &mut self.at;
        let is_number =
            |part: &Rc<Tree>| part.shape == Shape::Scalar && !has(part, |kind| matches!(kind, Kind::Name(_)));
        parts(tree).into_iter().any(|part| is_number(part) && at.of(part).first().is_zero())
    }

    /// Reports the terms that are zero on the whole group, at their places.
    fn report_zero(&mut self, terms: &[Rc<Tree>]) {
        for term in terms {
            if self.behaviour(term).is_zero() && !self.has_written_zero(term) {
                self.found.push((term.clone(), TermMistake::Zero));
            }
        }
    }

    /// Reports terms with `F` alone whose sum is constant, at the first of them.
    fn report_cancelling(&mut self, terms: &[Rc<Tree>]) {
        let is_meant = |term: &&Rc<Tree>| has(term, IS_INCREMENT) && !has(term, IS_ADVECTED);
        let mut with_increment = terms.iter().filter(is_meant).peekable();
        let Some(first) = with_increment.peek().filter(|_| self.role == Role::Lagrangian).copied() else { return };
        let mut sum = [Series::ZERO; 2];
        for term in with_increment {
            let Behaviour { along, fixed, .. } = self.behaviour(term);
            sum = [sum[0] + along, sum[1] + fixed];
        }
        if sum.into_iter().all(Series::is_zero) && !terms.iter().any(|term| self.has_written_zero(term)) {
            self.found.push((first.clone(), TermMistake::Cancelling));
        }
    }

    /// Reports the terms whose effect vanishes with the step, or that have none.
    fn report_vanishing(&mut self, terms: &[Rc<Tree>], whole: &Behaviour) {
        for term in terms {
            let mistake = self.vanishing(term, whole);
            self.found.extend(mistake.map(|mistake| (term.clone(), mistake)));
        }
    }

    fn vanishing(&mut self, term: &Rc<Tree>, whole: &Behaviour) -> Option<TermMistake> {
        let Behaviour { along, at_rest, value, fixed, .. } = self.behaviour(term);
        if ![along, at_rest, value].iter().all(|series| series.is_defined()) {
            return None;
        }
        let second = |series: Series| series.order().filter(|&order| order == 2);
        let mistake = if has(term, IS_POWER) {
            None
        } else if self.role == Role::Force {
            second(if has(term, IS_ADVECTED) { at_rest } else { along }).map(TermMistake::Work)
        } else if has(term, IS_ADVECTED) {
            // A term that is zero at F = I is a correction, as the difference of a potential at both ends is.
            second(at_rest).map(TermMistake::Potential)
        } else {
            // The term has one factor too many, or is a square of a small quantity that isn't over `h`; higher powers
            // are corrections.
            let is_square =
                |&(order, power): &(i32, i32)| order - power == 2 && (power == 0 || power > 0 && value.is_zero());
            along.order().zip(fixed.order()).filter(is_square).map(|(order, _)| TermMistake::Vanishing(order))
        };
        // A constant that another term cancels is right.
        let is_idle = || along.is_zero() && at_rest.is_zero() && has(term, IS_INCREMENT) && !has(term, IS_POWER);
        let is_constant = || self.role != Role::Force && is_idle() && low(value).and(low(whole.value)).is_some();
        mistake.or_else(|| is_constant().then_some(TermMistake::Constant))
    }
}

/// The order in `h`, if it is below the first.
fn low(series: Series) -> Option<i32> {
    series.order().filter(|&order| order < 1)
}

type Is = fn(&Kind) -> bool;

const IS_INCREMENT: Is = |kind| matches!(kind, Kind::Name(Name::Increment(_)));
const IS_ADVECTED: Is = |kind| matches!(kind, Kind::Name(Name::Advected(_)));
const IS_STEP: Is = |kind| matches!(kind, Kind::Name(Name::Step));
/// `h.powi(n)` with a positive `n` marks a term that is intended to be small.
const IS_POWER: Is = |kind| matches!(kind, Kind::Power(a, exponent) if *exponent > 1 && is_step(a));

/// Whether a part of the tree satisfies the condition.
fn has(tree: &Rc<Tree>, is_meant: Is) -> bool {
    parts(tree).iter().any(|part| is_meant(&part.kind))
}

fn is_step(tree: &Tree) -> bool {
    match &tree.kind {
        Kind::Bound(_, inner) => is_step(inner),
        kind => IS_STEP(kind),
    }
}

/// The two terms of a sum, with the scalar factors and divisors around it; each keeps its own place.
pub(super) fn split_within(tree: &Rc<Tree>, depth: usize) -> Option<[Rc<Tree>; 2]> {
    let depth = depth.checked_sub(1)?;
    let each = |parts: [Rc<Tree>; 2], kind: &dyn Fn(Rc<Tree>) -> Kind| {
        parts.map(|part| Tree::in_place_of(&part.clone(), kind(part)))
    };
    match &tree.kind {
        Kind::Bound(_, inner) => split_within(inner, depth),
        Kind::Add(a, b) => Some([a.clone(), b.clone()]),
        Kind::Subtract(a, b) => Some([a.clone(), Tree::in_place_of(b, Kind::Negate(b.clone()))]),
        Kind::Negate(a) => Some(each(split_within(a, depth)?, &Kind::Negate)),
        Kind::Divide(a, b) => Some(each(split_within(a, depth)?, &|part| Kind::Divide(part, b.clone()))),
        // A product of two moving factors, such as a square, is judged as one term.
        Kind::Multiply(a, b) if tree.shape == Shape::Scalar && !(moves(a) && moves(b)) => {
            match split_within(a, depth) {
                Some(parts) => Some(each(parts, &|part| Kind::Multiply(part, b.clone()))),
                None => Some(each(split_within(b, depth)?, &|part| Kind::Multiply(a.clone(), part))),
            }
        }
        _ => None,
    }
}

/// A function of `h` that has no power series.
fn function_of_step(tree: &Rc<Tree>, values: &Values) -> Option<(Rc<Tree>, TermMistake)> {
    let mut evaluation = Evaluation::new(values);
    let mut is_singular = |part: &Rc<Tree>| {
        let Kind::Apply(function @ (Function::Sqrt | Function::Ln), inner) = &part.kind else { return false };
        let order = evaluation.of(inner).first().order().unwrap_or(0);
        has(inner, IS_STEP) && if *function == Function::Ln { order != 0 } else { order % 2 != 0 }
    };
    let found = parts(tree).into_iter().find(|part| is_singular(part))?;
    Some((found.clone(), TermMistake::FunctionOfStep))
}

/// Whether the tree depends on `F` or on an advected parameter.
fn moves(tree: &Rc<Tree>) -> bool {
    has(tree, |kind| IS_INCREMENT(kind) || IS_ADVECTED(kind))
}

/// The first part that divides by zero, or has zero under a root or a logarithm.
fn singular(tree: &Rc<Tree>, values: &Values) -> Option<(Rc<Tree>, TermMistake)> {
    let mut evaluation = Evaluation::new(values);
    let mut is_zero = |tree: &Rc<Tree>| evaluation.of(tree).first().is_zero();
    parts(tree).into_iter().find_map(|part| match &part.kind {
        Kind::Divide(_, divisor) if is_zero(divisor) => Some((divisor.clone(), TermMistake::ZeroDivisor)),
        Kind::Power(base, exponent) if *exponent < 0 && is_zero(base) => Some((base.clone(), TermMistake::ZeroDivisor)),
        Kind::Apply(Function::Sqrt | Function::Ln, inner) if is_zero(inner) => {
            Some((part.clone(), TermMistake::FunctionOfZero))
        }
        _ => None,
    })
}
