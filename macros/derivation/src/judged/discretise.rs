//! From `l(ξ, w)` to `l_d(F, w)`, by substitution into the declared tree.
//!
//! ```text
//! trapezoid    (h/2) (l(ξ, w) + l(ξ, F⁻¹·w))
//! midpoint     h l(ξ, τ(hξ/2)⁻¹·w)
//! chord        h l(ξ, (w + F⁻¹·w)/2)
//! ```
//!
//! with `hξ = τ⁻¹(F)` for the retraction `τ`, or with the matrix `ξ̂ = (F − I)/h`, which isn't in the algebra. The
//! result is an `l_d` that is checked and derived like a declared one.

mod build;
mod substitution;

use std::collections::BTreeMap;
use std::rc::Rc;

use build::Build;
use substitution::Substitution;

use super::explain::{self, Misfit};
use crate::declared::errors::Errors;
use crate::declared::{Declaration, Discretisation, Kind, Name, Quadrature, Tree};
use crate::mathematics::symbolic::Rational;

/// The discretisation of `l`; `None` if it doesn't fit the group or `l`, which has been reported.
pub fn discretised(
    declaration: &Declaration,
    tree: &Rc<Tree>,
    asked: Discretisation,
    errors: &mut Errors,
) -> Option<Rc<Tree>> {
    let discrete = discrete(declaration, tree, asked);
    discrete.map_err(|misfit| explain::misfit(misfit, asked, declaration, errors)).ok()
}

fn discrete(declaration: &Declaration, tree: &Rc<Tree>, asked: Discretisation) -> Result<Rc<Tree>, Misfit> {
    let build = Build { declaration, at: tree, factor: 0 };
    let factors = 0..declaration.group.factors().len();
    let velocities = factors.clone().map(|factor| build.of(factor).velocity(asked.coordinates));
    let velocities: Vec<Option<Rc<Tree>>> = velocities.collect::<Result<_, _>>()?;
    let with = |carried: Vec<Rc<Tree>>| {
        let mut substitution =
            Substitution { build: &build, velocities: velocities.clone(), carried, known: BTreeMap::new() };
        substitution.of(tree)
    };
    let number = declaration.advected.len();
    let now = || (0..number).map(|index| build.advected(index)).collect::<Vec<_>>();
    let next = || {
        let whole = |factor| build.of(factor).whole_increment();
        (0..number).map(|index| build.carried(index, &whole)).collect::<Vec<_>>()
    };
    let h = build.scalar(Kind::Name(Name::Step));
    match asked.quadrature {
        Quadrature::Trapezoid => {
            let sum = build.add(with(now())?, with(next())?);
            Ok(build.product(build.product(build.number(Rational::new(1, 2)), h), sum))
        }
        Quadrature::Midpoint => {
            let half = |factor: usize| {
                let velocity = velocities.get(factor).cloned().flatten();
                build.of(factor).half_increment(&velocity.ok_or(Misfit::NotInMatrix(factor))?)
            };
            let halves: Vec<[Rc<Tree>; 2]> = factors.map(half).collect::<Result<_, _>>()?;
            let middle = (0..number).map(|index| build.carried(index, &|factor| halves[factor].clone())).collect();
            Ok(build.product(h, with(middle)?))
        }
        Quadrature::Chord => {
            let middle = now().into_iter().zip(next()).map(|(now, next)| {
                let shape = now.shape;
                let sum = build.tree(shape, Kind::Add(now, next));
                build.scaled(build.number(Rational::new(1, 2)), sum)
            });
            Ok(build.product(h, with(middle.collect())?))
        }
    }
}
