//! Self-adjointness at random points of a finite field, where nothing is rounded.
//!
//! `F` is a product of Cayley transforms `cay(tE_k) = (I − tE_k)⁻¹(I + tE_k)`. Where `E³ = c E`, they are elements of
//! the one-parameter group of `E`, rational in `t`: for all of the built-in groups' generators. The products for all
//! generators have elements near the identity for all that the group has there, so that an identity that holds for them
//! holds for the connected group; and being an identity of rational functions with rational coefficients, it holds in
//! the field as well.

use std::rc::Rc;

use super::number::Number;
use super::residue::Residue;
use super::value::Value;
use super::{Sample, degree, inverse_of};
use crate::declared::lower::Lowered;
use crate::declared::{Declaration, Kind, Tree};
use crate::mathematics::derive::Derived;
use crate::mathematics::group::Group;

/// Independent points.
const POINTS: u64 = 3;
/// With more coincidences than this three points don't decide: together they leave a probability of `2⁻⁶³`.
const MOST_COINCIDENCES: u64 = 1 << 40;

/// Whether `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)`, wrongly yes with a probability below `2⁻⁵⁰`; nothing where the field
/// doesn't say.
pub(super) fn is_self_adjoint(
    declaration: &Declaration,
    tree: &Rc<Tree>,
    lowered: &Lowered,
    derived: &Derived,
) -> Option<bool> {
    if degree::coincidences(tree, derived.group.dimension()) > MOST_COINCIDENCES {
        return None;
    }
    let mut is_equal = true;
    for seed in 1..=POINTS {
        let mut number = Residue::stream(seed);
        let elements = element(&derived.group, &mut number)?;
        let sample = Sample::with_numbers(declaration, lowered, derived, elements, number);
        let (value, reversed) = (sample.declared(tree), sample.reversed(tree));
        if !value.is_defined() || !reversed.is_defined() {
            return None;
        }
        is_equal &= value == reversed;
    }
    // A function may have relations that a random one hasn't.
    if is_equal || !has_function(tree) { Some(is_equal) } else { None }
}

/// A random element with its inverse; nothing where a generator's one-parameter group isn't rational in this way.
fn element(group: &Group, number: &mut impl FnMut() -> Residue) -> Option<(Value<Residue>, Value<Residue>)> {
    let identity = Value::identity(group.size);
    let (mut element, mut inverse) = (identity.clone(), identity.clone());
    for entries in &group.generators {
        let generator = Value::square(group.size, entries);
        if !is_multiple(&generator.times(&generator).times(&generator), &generator) {
            return None;
        }
        let t = number();
        let forwards = identity.zip(&generator, |one, e| one + t * e);
        let backwards = identity.zip(&generator, |one, e| one - t * e);
        element = element.times(&inverse_of(group, &backwards).times(&forwards));
        inverse = inverse_of(group, &forwards).times(&backwards).times(&inverse);
    }
    Some((element, inverse))
}

/// Whether `A = c B` for a number `c`.
fn is_multiple(a: &Value<Residue>, b: &Value<Residue>) -> bool {
    let Some((&first, &scale)) = a.entries.iter().zip(&b.entries).find(|(_, b)| **b != Residue::ZERO) else {
        return false;
    };
    a.entries.iter().zip(&b.entries).all(|(&a, &b)| a * scale == b * first)
}

fn has_function(tree: &Rc<Tree>) -> bool {
    let mut seen = std::collections::BTreeSet::new();
    let mut open = vec![tree];
    while let Some(tree) = open.pop() {
        if matches!(tree.kind, Kind::Apply(..)) {
            return true;
        }
        if seen.insert(Rc::as_ptr(tree)) {
            open.extend(tree.kind.operands().into_iter().flatten());
        }
    }
    false
}
