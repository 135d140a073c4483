//! The check that a formula is the inverse of the Cayley map on a group, at random points of a finite field.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::evaluation::Evaluation;
use super::number::Number as _;
use super::residue::Residue;
use super::value::Value;
use crate::declared::{Name, Tree};
use crate::mathematics::group::Group;

/// The number of independent points.
const POINTS: u64 = 3;

/// Whether `tree` at `F = cay(ξ̂)` is `ξ`, for random `ξ`; `increment` is the name of `F`.
pub fn is_cayley_coordinates(group: &Group, increment: Name, tree: &Rc<Tree>) -> bool {
    (1..=POINTS).all(|seed| {
        let mut number = Residue::stream(seed);
        let (identity, two) = (Value::identity(group.size), Residue::ONE + Residue::ONE);
        let xi: Vec<Residue> = group.generators.iter().map(|_| number()).collect();
        let half = Value::combination(group.size, &group.generators, &xi).map(|entry| entry / two);
        let (minus, plus) = (identity.zip(&half, |x, y| x - y), identity.plus(&half));
        let values = BTreeMap::from([(increment, minus.inverse().times(&plus))]);
        let found = Evaluation::new(&values).of(tree);
        found.entries.len() == xi.len() && found.entries.iter().zip(&xi).all(|(a, b)| a.is_defined() && a == b)
    })
}

/// The least `n` with `Nⁿ = 0` for all elements `N` of a strictly triangular algebra.
pub fn nilpotency(group: &Group) -> usize {
    let mut number = Residue::stream(1);
    let components: Vec<Residue> = group.generators.iter().map(|_| number()).collect();
    let any = Value::combination(group.size, &group.generators, &components);
    let mut power = any.clone();
    (1..=group.size)
        .find(|_| {
            let vanishes = power.entries.iter().all(|&entry| entry == Residue::ZERO);
            power = power.times(&any);
            vanishes
        })
        .unwrap_or(group.size)
}
