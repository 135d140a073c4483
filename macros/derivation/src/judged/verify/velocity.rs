//! The constraints that are linear in the velocities.

use std::rc::Rc;

use super::evaluation::Evaluation;
use super::number::Number as _;
use super::orders::split_within;
use super::residue::Residue;
use super::{parameters, velocities};
use crate::declared::{Declaration, Tree};

/// The limit on terms within terms.
const DEEPEST: usize = 10;

/// The part that isn't linear in the velocities: `c(ξ + η) ≠ c(ξ) + c(η)` at random points, where nothing is rounded.
pub fn not_linear(declaration: &Declaration, tree: &Rc<Tree>) -> Option<Rc<Tree>> {
    let mut number = Residue::stream(1);
    let known = parameters(declaration, &mut number);
    let dimension = declaration.group.dimension();
    let [one, other] = [(); 2].map(|()| (0..dimension).map(|_| number()).collect::<Vec<_>>());
    let sum: Vec<Residue> = one.iter().zip(&other).map(|(&a, &b)| a + b).collect();
    let points = [one, other, sum].map(|velocity| {
        let mut values = known.clone();
        values.extend(velocities(&declaration.group, &velocity));
        values
    });
    let mut at = points.each_ref().map(Evaluation::new);
    let mut is_linear = |part: &Rc<Tree>| {
        let [one, other, sum] = at.each_mut().map(|at| at.of(part).first());
        !sum.is_defined() || sum == one + other
    };
    let mut found = Some(tree.clone()).filter(|tree| !is_linear(tree))?;
    // Terms that cancel in a sum are no mistake, unless one is.
    while let Some(part) = split_within(&found, DEEPEST).and_then(|parts| parts.into_iter().find(|one| !is_linear(one)))
    {
        found = part;
    }
    Some(found)
}
