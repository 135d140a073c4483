//! How each term of a declared expression goes as `h → 0`, with `F = exp(h ξ̂)` and numbers for all else.
//!
//! Of a Lagrangian only differences count: what is the same for all `F` and `w` changes no equation. A potential is what
//! depends on `w` where `F = I`, and goes like `h`, as does the work of a force.

use std::rc::Rc;

use super::evaluation::Evaluation;
use super::number::Number as _;
use super::residue::Residue;
use super::sample::{Element, draws};
use super::series::Series;
use super::value::Value;
use super::{displacements, exponential, increments, parameters, velocities};
use crate::declared::{Declaration, Kind, Name, Role, Shape, Tree};
use crate::mathematics::symbolic::Function;

/// A sum may be taken apart as often; what is shared by `let`s is written down more often than a person would.
const MOST_SPLITS: usize = 200;

/// A sum isn't looked for below more factors than these.
const MOST_FACTORS: usize = 10;

/// What is wrong with a term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TermMistake {
    /// A divisor is zero, whatever the parameters.
    ZeroDivisor,
    /// A root or a logarithm of what is zero, whatever the parameters.
    FunctionOfZero,
    /// A root of an odd power of `h`, or a logarithm of any.
    FunctionOfStep,
    /// A potential goes like that power of `h`, not like the first.
    Potential(i32),
    /// A part with `F` alone goes like that power of `h` along a motion, and vanishes.
    Vanishing(i32),
    /// A part goes like that power of `h` with `F` held fixed, below −1.
    TooSingular(i32),
    /// It is the same for all `F`.
    Constant,
    /// Virtual work goes like that power of `h`, not like the first.
    Work(i32),
    /// There is no work, whatever the parameters.
    NoWork,
}

/// The mistakes of the terms, at their places.
pub(crate) fn term_mistakes(declaration: &Declaration, tree: &Rc<Tree>) -> Vec<(Rc<Tree>, TermMistake)> {
    let points = Points::new(declaration);
    if let Some(found) = singular(tree, &points.turned).or_else(|| function_of_step(tree, &points.moving)) {
        return vec![found];
    }
    // What is made of an `l` goes as it should; a share of it needn't.
    if declaration.continuous.is_some() {
        return Vec::new();
    }
    let mut search = Search {
        role: declaration.role,
        turned: Evaluation::new(&points.turned),
        turned_further: Evaluation::new(&points.turned_further),
        moving: Evaluation::new(&points.moving),
        at_rest: Evaluation::new(&points.at_rest),
        elsewhere: Evaluation::new(&points.elsewhere),
        kept: Vec::new(),
        splits: MOST_SPLITS,
        found: Vec::new(),
    };
    let whole = search.behaviour(tree);
    if search.role == Role::Force && whole.along.is_zero() {
        return vec![(tree.clone(), TermMistake::NoWork)];
    }
    if search.role == Role::Force && !search.is_linear(tree) {
        return Vec::new();
    }
    if search.too_large(tree).is_some() {
        search.report_too_large(tree);
    } else {
        search.report_vanishing(tree, &whole);
    }
    search.found
}

/// Where a value at `F = I` isn't smooth: what is divided by, or under a function, is zero there.
pub(crate) fn not_smooth_at_identity(declaration: &Declaration, tree: &Rc<Tree>) -> Option<(Rc<Tree>, TermMistake)> {
    singular(tree, &Points::new(declaration).at_rest)
}

/// The first part that has no value for any of some parameters, if there is one.
pub(crate) fn without_value(declaration: &Declaration, tree: &Rc<Tree>) -> Option<Rc<Tree>> {
    let points: Vec<super::Values<f64>> = draws(declaration).map(|(_, values)| values).collect();
    let mut at_points: Vec<Evaluation> = points.iter().map(Evaluation::new).collect();
    let mut found = None;
    visit(tree, &mut |part| {
        let mut has_value = at_points.iter_mut().map(|at| at.of(part).entries.iter().all(|entry| entry.is_defined()));
        if found.is_none() && !has_value.any(|has_value| has_value) {
            found = Some(part.clone());
        }
    });
    found
}

type Values = super::Values<Series>;

/// Numbers for all names, with `h` as it is.
struct Points {
    /// At some `F`, and at another.
    turned: Values,
    turned_further: Values,
    /// At `F = exp(h ξ̂)`.
    moving: Values,
    /// At `F = I`, and there with other advected parameters, or of a force with twice the displacements.
    at_rest: Values,
    elsewhere: Values,
}

impl Points {
    fn new(declaration: &Declaration) -> Self {
        let (group, mut number) = (&declaration.group, Residue::stream(1));
        let turned = [(); 2].map(|()| {
            let element = Element::by_cayley(group, &mut number);
            // Of a group without such points any matrix will do.
            element.unwrap_or_else(|| Element::by_exponentials(group, &mut number)).matrix.over(Series::constant)
        });
        let mut number = || Series::constant(number());
        let speeds: Vec<Series> = group.generators.iter().map(|_| number()).collect();
        let velocity = Value::combination(group.size, &group.generators, &speeds);
        let mut at_rest = Values::from([(Name::Step, Value::scalar(Series::STEP))]);
        at_rest.extend(increments(group, &Value::identity(group.size)));
        at_rest.extend(velocities(group, &speeds));
        at_rest.extend(displacements(group, &mut number));
        at_rest.extend(parameters(declaration, &mut number));
        let mut elsewhere = at_rest.clone();
        let others = parameters(declaration, &mut number).into_iter();
        let is_moved = |name: Name| declaration.role != Role::Force && matches!(name, Name::Advected(_));
        elsewhere.extend(others.filter(|(name, _)| is_moved(*name)));
        for (name, value) in &mut elsewhere {
            if matches!(name, Name::DisplacementBefore(_) | Name::DisplacementAfter(_)) {
                *value = value.plus(value);
            }
        }
        let with_increment = |increment: &Value<Series>| {
            let mut values = at_rest.clone();
            values.extend(increments(group, increment));
            values
        };
        let moving = exponential(group, &velocity.map(|entry| entry * Series::STEP));
        let [turned, turned_further] = turned.each_ref().map(with_increment);
        Self { turned, turned_further, moving: with_increment(&moving), elsewhere, at_rest }
    }
}

/// How a term goes.
struct Behaviour {
    /// With `F = exp(h ξ̂)`; of a Lagrangian, the difference to `F = I`.
    along: Series,
    /// At `F = I`; of a Lagrangian, the difference to other advected parameters.
    at_rest: Series,
    /// At `F = I`.
    value: Series,
    /// Between two fixed `F`.
    fixed: Series,
}

struct Search<'a> {
    role: Role,
    turned: Evaluation<'a, Series>,
    turned_further: Evaluation<'a, Series>,
    moving: Evaluation<'a, Series>,
    at_rest: Evaluation<'a, Series>,
    elsewhere: Evaluation<'a, Series>,
    /// What has been evaluated stays, as its place says what it is.
    kept: Vec<Rc<Tree>>,
    /// How many sums may still be taken apart.
    splits: usize,
    found: Vec<(Rc<Tree>, TermMistake)>,
}

impl Search<'_> {
    /// As [`split_within`], while there aren't too many.
    fn split(&mut self, tree: &Rc<Tree>) -> Option<[Rc<Tree>; 2]> {
        self.splits = self.splits.checked_sub(1)?;
        split_within(tree, MOST_FACTORS)
    }

    fn behaviour(&mut self, tree: &Rc<Tree>) -> Behaviour {
        self.kept.push(tree.clone());
        let [moving, value] = [&mut self.moving, &mut self.at_rest].map(|at| at.of(tree).first());
        if self.role == Role::Force {
            return Behaviour { along: moving, at_rest: value, value, fixed: value };
        }
        let [elsewhere, turned, further] =
            [&mut self.elsewhere, &mut self.turned, &mut self.turned_further].map(|at| at.of(tree).first());
        Behaviour { along: moving - value, at_rest: value - elsewhere, value, fixed: turned - further }
    }

    /// What keeps the limit `h → 0` from existing, if anything does. A first derivative of the kinetic part isn't meant.
    fn too_large(&mut self, tree: &Rc<Tree>) -> Option<TermMistake> {
        let Behaviour { along, at_rest, fixed, .. } = self.behaviour(tree);
        if ![along, at_rest, fixed].iter().all(|series| series.is_defined()) {
            return None;
        }
        let is_low = |series: Series| series.order().filter(|&order| order < 1);
        if self.role == Role::Force {
            return is_low(along).map(TermMistake::Work);
        }
        is_low(at_rest).map(TermMistake::Potential).or_else(|| {
            let power = fixed.order().filter(|&power| power < -1)?;
            is_low(along).map(|_| TermMistake::TooSingular(power))
        })
    }

    /// Whether virtual work is linear in the displacements, as far as twice of them tell.
    fn is_linear(&mut self, tree: &Rc<Tree>) -> bool {
        let [once, twice] = [&mut self.at_rest, &mut self.elsewhere].map(|at| at.of(tree).first());
        (once + once - twice).is_zero()
    }

    /// At the terms that are too large; what cancels in a sum isn't one of them.
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

    /// At the terms that a smaller step makes ever less important, or that never do anything.
    fn report_vanishing(&mut self, tree: &Rc<Tree>, whole: &Behaviour) {
        if let Some(parts) = self.split(tree) {
            for part in &parts {
                self.report_vanishing(part, whole);
            }
            return;
        }
        let Behaviour { along, at_rest, value, fixed } = self.behaviour(tree);
        if ![along, at_rest, value].iter().all(|series| series.is_defined()) {
            return;
        }
        let names = Names::of(tree);
        // Once too often, or a square of what is small that isn't over `h`; higher powers are corrections.
        let is_square = along
            .order()
            .zip(fixed.order())
            .is_some_and(|(order, power)| order - power == 2 && (power == 0 || power > 0 && value.is_zero()));
        let is_low = |series: Series| series.order().is_some_and(|order| order < 1);
        let vanishing = if names.has_advected {
            // What is zero at F = I is a correction, as the difference of a potential at both ends is.
            at_rest.order().filter(|&order| order == 2).map(TermMistake::Potential)
        } else if self.role == Role::Force {
            along.order().filter(|&order| order == 2).map(TermMistake::Work)
        } else {
            along.order().filter(|_| is_square).map(TermMistake::Vanishing)
        };
        let mistake = match (self.role, vanishing) {
            _ if names.has_power => None,
            (Role::Force, Some(TermMistake::Potential(order))) => Some(TermMistake::Work(order)),
            (_, Some(mistake)) => Some(mistake),
            (Role::Force, None) => None,
            // Unless it is there to be cancelled.
            (_, None) => {
                let is_constant = along.is_zero() && at_rest.is_zero() && names.has_increment;
                (is_constant && is_low(value) && is_low(whole.value)).then_some(TermMistake::Constant)
            }
        };
        self.found.extend(mistake.map(|mistake| (tree.clone(), mistake)));
    }
}

/// What a term is written with.
#[allow(clippy::struct_excessive_bools)] // four names, of which each is there or isn't
#[derive(Default)]
struct Names {
    has_increment: bool,
    has_step: bool,
    has_advected: bool,
    /// `h.powi(n)` with a positive `n`: its author knows that it is small.
    has_power: bool,
}

impl Names {
    fn of(tree: &Rc<Tree>) -> Self {
        let mut names = Self::default();
        visit(tree, &mut |tree| match &tree.kind {
            Kind::Name(Name::Increment(_)) => names.has_increment = true,
            Kind::Name(Name::Step) => names.has_step = true,
            Kind::Name(Name::Advected(_)) => names.has_advected = true,
            Kind::Power(a, exponent) if *exponent > 1 && is_step(a) => names.has_power = true,
            _ => {}
        });
        names
    }
}

fn is_step(tree: &Tree) -> bool {
    match &tree.kind {
        Kind::Name(Name::Step) => true,
        Kind::Bound(_, inner) => is_step(inner),
        _ => false,
    }
}

/// Every part of a tree once, the inner ones first.
fn visit(tree: &Rc<Tree>, at: &mut dyn FnMut(&Rc<Tree>)) {
    fn inside(tree: &Rc<Tree>, seen: &mut std::collections::BTreeSet<*const Tree>, at: &mut dyn FnMut(&Rc<Tree>)) {
        if seen.insert(Rc::as_ptr(tree)) {
            tree.kind.operands().into_iter().flatten().for_each(|operand| inside(operand, seen, at));
            at(tree);
        }
    }
    inside(tree, &mut std::collections::BTreeSet::new(), at);
}

/// The two terms of a sum, with the scalars that the sum is multiplied or divided by; each has the place of its own.
fn split_within(tree: &Rc<Tree>, depth: usize) -> Option<[Rc<Tree>; 2]> {
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
        // What moves on both sides is judged as one, as its square is.
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
    let (mut evaluation, mut found) = (Evaluation::new(values), None);
    visit(tree, &mut |tree| {
        let Kind::Apply(function @ (Function::Sqrt | Function::Ln), inner) = &tree.kind else { return };
        let order = evaluation.of(inner).first().order().unwrap_or(0);
        let is_singular = if *function == Function::Ln { order != 0 } else { order % 2 != 0 };
        if found.is_none() && is_singular && Names::of(inner).has_step {
            found = Some((tree.clone(), TermMistake::FunctionOfStep));
        }
    });
    found
}

/// Whether it depends on `F` or on what is advected.
fn moves(tree: &Rc<Tree>) -> bool {
    let names = Names::of(tree);
    names.has_increment || names.has_advected
}

/// The first place where zero is divided by or is under a root or a logarithm.
fn singular(tree: &Rc<Tree>, values: &Values) -> Option<(Rc<Tree>, TermMistake)> {
    let mut evaluation = Evaluation::new(values);
    let mut found = None;
    visit(tree, &mut |tree| {
        let mut is_zero = |tree: &Rc<Tree>| found.is_none() && evaluation.of(tree).first().is_zero();
        let mistake = match &tree.kind {
            Kind::Divide(_, divisor) if is_zero(divisor) => (divisor.clone(), TermMistake::ZeroDivisor),
            Kind::Power(base, exponent) if *exponent < 0 && is_zero(base) => (base.clone(), TermMistake::ZeroDivisor),
            Kind::Apply(Function::Sqrt | Function::Ln, inner) if is_zero(inner) => {
                (tree.clone(), TermMistake::FunctionOfZero)
            }
            _ => return,
        };
        found = Some(mistake);
    });
    found
}
