//! All identities at random points, as many as are needed.

use std::rc::Rc;

use super::degree::{self, Degree, Largest};
use super::identities::Identities;
use super::number::Number;
use super::residue::Residue;
use super::sample::{Element, Sample};
use super::series::PowerSeries;
use super::value::Value;
use super::{Fault, Sureness, Unconfirmed, exponential};
use crate::declared::lower::Lowered;
use crate::declared::{Declaration, FieldKind, Name, Tree};
use crate::mathematics::group::Group;

/// Compared without a bound.
const POINTS: u32 = 3;
/// With more coincidences than this as many points don't decide about reversal: together they leave a probability of `2⁻⁵⁴`.
const MOST_COINCIDENCES: u64 = 1 << 40;
/// So many more are tried, as one may have no value.
const SPARE: u32 = 5;

/// Numbers that can be told from each other.
pub(super) trait Exact: Number {
    fn stream(seed: u64) -> impl FnMut() -> Self;

    /// A random element of the group, if this kind of numbers has any.
    fn element(group: &Group, number: &mut impl FnMut() -> Self) -> Option<Element<Self>>;

    fn is_defined(self) -> bool;

    fn is(self, other: Self) -> bool;
}

impl Exact for Residue {
    fn stream(seed: u64) -> impl FnMut() -> Self {
        Self::stream(seed)
    }

    fn element(group: &Group, number: &mut impl FnMut() -> Self) -> Option<Element<Self>> {
        Element::by_cayley(group, number)
    }

    fn is_defined(self) -> bool {
        self.is_defined()
    }

    fn is(self, other: Self) -> bool {
        self == other
    }
}

impl Exact for PowerSeries<Residue> {
    fn stream(seed: u64) -> impl FnMut() -> Self {
        let mut number = Residue::stream(seed);
        move || Self::constant(number())
    }

    /// A product of exponentials of multiples of the variable.
    fn element(group: &Group, number: &mut impl FnMut() -> Self) -> Option<Element<Self>> {
        let mut element = Element::identity(group);
        for entries in &group.generators {
            let t = number() * Self::STEP;
            let x = Value::square(group.size, entries).map(|entry: Self| t * entry);
            element.matrix = element.matrix.times(&exponential(group, &x));
            element.inverse = exponential(group, &x.map(|entry| -entry)).times(&element.inverse);
        }
        Some(element)
    }

    fn is_defined(self) -> bool {
        Self::is_defined(&self)
    }

    fn is(self, other: Self) -> bool {
        (self - other).is_zero()
    }
}

/// Of a declaration.
pub(super) struct Check<'a> {
    pub(super) declaration: &'a Declaration,
    pub(super) lowered: &'a Lowered,
    pub(super) identities: Identities<'a>,
}

impl<'a> Check<'a> {
    /// How sure the check is, and the points at which all agrees where they decide about reversal, too.
    pub(super) fn confirmed(&self, tree: &Rc<Tree>) -> Result<(Sureness, Vec<Sample<'a, Residue>>), Unconfirmed> {
        if Residue::element(&self.declaration.group, &mut Residue::stream(1)).is_none() {
            self.points::<PowerSeries<Residue>>(POINTS)?;
            return Ok((Sureness::Series, Vec::new()));
        }
        let (found, decides) = self.sureness(tree);
        let points = self.points(found.map_or(POINTS, |found| found.points))?;
        let sureness = found.map_or(Sureness::TooHigh, |found| Sureness::Certified(found.exponent));
        Ok((sureness, if found.is_some() || decides { points } else { Vec::new() }))
    }

    pub(super) fn sample<T: Number>(&self, element: Element<T>, number: &mut impl FnMut() -> T) -> Sample<'a, T> {
        Sample::with_numbers(self.declaration, self.lowered, self.identities.derived, element, number)
    }

    /// As many points at which everything agrees.
    fn points<T: Exact>(&self, count: u32) -> Result<Vec<Sample<'a, T>>, Unconfirmed> {
        confirmed(count, |seed| {
            let mut number = T::stream(seed);
            let element = T::element(&self.declaration.group, &mut number).ok_or(Fault::Untold)?;
            let sample = self.sample(element, &mut number);
            self.identities.hold(&sample, number, &mut same)?;
            Ok(sample)
        })
    }

    /// That of all, and whether points decide about reversal.
    fn sureness(&self, tree: &Rc<Tree>) -> (Option<degree::Sureness>, bool) {
        let kinds = (0..self.declaration.advected.len()).map(|index| self.declaration.advected_kind(index));
        let kinds: Vec<FieldKind> = kinds.collect();
        let is_attitude = |kind: &&FieldKind| matches!(kind, FieldKind::Configuration(_));
        let attitudes = kinds.iter().filter(is_attitude).count();
        let mut number = Degree::stream();
        let (element, degree) = degree::element(&self.declaration.group, attitudes, &mut number);
        let mut sample = self.sample(element, &mut number);
        for (index, kind) in kinds.iter().enumerate().filter(|(_, kind)| is_attitude(kind)) {
            let rows = kind.shape().rows();
            let entries = (0..rows * rows).map(|_| number().of_element(degree)).collect();
            sample.values.insert(Name::Advected(index), Value { rows, columns: rows, entries });
        }
        let mut largest = Largest::default();
        largest.compared(sample.declared(tree), sample.reversed(tree));
        let decides = largest.coincidences(degree::functions(tree)) <= MOST_COINCIDENCES;
        let compared = self.identities.hold(&sample, number, &mut |_, found, expected| {
            largest.compared(found, expected);
            Ok(())
        });
        (compared.ok().and_then(|()| largest.sureness(self.identities.functions())), decides)
    }

    /// Whether the momentum and its Jacobian have values where a step begins: in the field nothing but a division by zero
    /// and a root or a logarithm of zero hasn't.
    pub(super) fn is_smooth(&self) -> bool {
        let mut number = Residue::stream(1);
        let sample = self.sample(Element::identity(&self.declaration.group), &mut number);
        self.identities.are_smooth_at_identity(&sample, Residue::is_defined)
    }
}

/// Whether both are one number.
pub(super) fn same<T: Exact>(term: &'static str, found: T, expected: T) -> Result<(), Fault> {
    match (found.is_defined(), expected.is_defined()) {
        (_, false) => Err(Fault::Untold),
        (false, true) => Err(Fault::NoValue(term)),
        _ if found.is(expected) => Ok(()),
        _ => Err(Fault::Disagrees(term)),
    }
}

/// The first points at which what was derived agrees with the declaration. A point without values is no agreement.
pub(super) fn confirmed<S>(count: u32, point: impl Fn(u64) -> Result<S, Fault>) -> Result<Vec<S>, Unconfirmed> {
    let (mut found, mut nothing) = (Vec::new(), Unconfirmed::NoValue);
    for seed in 1..=u64::from(count + SPARE) {
        match point(seed) {
            Ok(one) => found.push(one),
            Err(Fault::Untold) => {}
            Err(Fault::NoValue(term)) => nothing = Unconfirmed::Disagrees(term),
            Err(Fault::Disagrees(term)) => return Err(Unconfirmed::Disagrees(term)),
        }
        if u32::try_from(found.len()) == Ok(count) {
            return Ok(found);
        }
    }
    Err(nothing)
}
