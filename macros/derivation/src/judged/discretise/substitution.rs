//! A continuous Lagrangian evaluated at the velocity and the parameters of a step.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::build::Build;
use crate::declared::{Kind, Name, Shape, Tree};
use crate::judged::explain::Misfit;
use crate::mathematics::symbolic::Rational;

/// The substitution of the velocity and the advected parameters in `l`.
pub(super) struct Substitution<'a> {
    pub(super) build: &'a Build<'a>,
    /// The velocity of each factor of the group; `None` if `ξ̂` is the matrix `(F − I)/h`.
    pub(super) velocities: Vec<Option<Rc<Tree>>>,
    pub(super) carried: Vec<Rc<Tree>>,
    pub(super) known: BTreeMap<*const Tree, Rc<Tree>>,
}

impl Substitution<'_> {
    pub(super) fn of(&mut self, tree: &Rc<Tree>) -> Result<Rc<Tree>, Misfit> {
        if let Some(known) = self.known.get(&Rc::as_ptr(tree)) {
            return Ok(known.clone());
        }
        let result = self.operation(tree)?;
        self.known.insert(Rc::as_ptr(tree), result.clone());
        Ok(result)
    }

    fn operation(&mut self, tree: &Rc<Tree>) -> Result<Rc<Tree>, Misfit> {
        if let Kind::Hat(a, _) | Kind::CrossMatrix(a) = &tree.kind
            && let Some(factor) = self.in_matrix(a)
        {
            return Ok(self.build.of(factor).difference_quotient());
        }
        let kind = match &tree.kind {
            Kind::Name(Name::Advected(index)) => return Ok(self.carried[*index].clone()),
            Kind::Name(Name::Velocity(factor)) => {
                return self.velocity(*factor).ok_or(Misfit::NotInMatrix(*factor));
            }
            Kind::Number(_) | Kind::Identity | Kind::Name(_) => return Ok(tree.clone()),
            Kind::Dot(a, b) => match self.form(a, b)? {
                Some(form) => return Ok(form),
                None => Kind::Dot(self.of(a)?, self.of(b)?),
            },
            Kind::Negate(a) => Kind::Negate(self.of(a)?),
            Kind::Add(a, b) => Kind::Add(self.of(a)?, self.of(b)?),
            Kind::Subtract(a, b) => Kind::Subtract(self.of(a)?, self.of(b)?),
            Kind::Multiply(a, b) => Kind::Multiply(self.of(a)?, self.of(b)?),
            Kind::Divide(a, b) => Kind::Divide(self.of(a)?, self.of(b)?),
            Kind::Transpose(a) => Kind::Transpose(self.of(a)?),
            Kind::Trace(a) => Kind::Trace(self.of(a)?),
            Kind::Cross(a, b) => Kind::Cross(self.of(a)?, self.of(b)?),
            Kind::CrossMatrix(a) => Kind::CrossMatrix(self.of(a)?),
            Kind::ComponentMultiply(a, b) => Kind::ComponentMultiply(self.of(a)?, self.of(b)?),
            Kind::Power(a, exponent) => Kind::Power(self.of(a)?, *exponent),
            Kind::Apply(function, a) => Kind::Apply(*function, self.of(a)?),
            Kind::Vee(a) => Kind::Vee(self.of(a)?),
            Kind::Hat(a, generators) => Kind::Hat(self.of(a)?, generators.clone()),
            Kind::Components(a, forms) => Kind::Components(self.of(a)?, forms.clone()),
            Kind::Inverse(a) => Kind::Inverse(self.of(a)?),
            Kind::Entry(a, row, column) => Kind::Entry(self.of(a)?, *row, *column),
            Kind::Bound(name, a) => {
                // A matrix `ξ̂` that isn't in the algebra has no vector that a `let` could name.
                if let Some(factor) = self.in_matrix(a) {
                    return Err(Misfit::NotInMatrix(factor));
                }
                Kind::Bound(name.clone(), self.of(a)?)
            }
        };
        Ok(Tree::until(Tree::new(tree.span, tree.shape, kind), tree.end))
    }

    /// The velocity of a factor; `None` if `ξ̂` is a matrix outside the algebra.
    fn velocity(&self, factor: usize) -> Option<Rc<Tree>> {
        self.velocities.get(factor).cloned().flatten()
    }

    /// The factor whose velocity this is, if its `ξ̂` is a matrix outside the algebra.
    fn in_matrix(&self, tree: &Tree) -> Option<usize> {
        match tree.kind {
            Kind::Name(Name::Velocity(factor)) if self.velocity(factor).is_none() => Some(factor),
            _ => None,
        }
    }

    /// Products on SO(3): `(Aξ)·(Bξ)` as `tr(ξ̂ S_d ξ̂ᵀ)` with `S = AᵀB` and `S_d = ½ tr(S) I − S`, and `a·ξ` as
    /// `a·vee(ξ̂)`. Both are equal on the algebra; for the matrix `(F − I)/h` they are the terms of (3.13).
    fn form(&mut self, a: &Rc<Tree>, b: &Rc<Tree>) -> Result<Option<Rc<Tree>>, Misfit> {
        match (self.linear(a), self.linear(b)) {
            // The velocities of two bodies don't form a trace of one matrix.
            (Some((of_left, _)), Some((of_right, _))) if of_left != of_right => Ok(None),
            (Some((factor, left)), Some((_, right))) => {
                let build = &self.build.of(factor);
                let (left, right) = (self.factors(&left)?, self.factors(&right)?);
                let chain = left.iter().rev().map(|factor| build.transposed(factor)).chain(right);
                let form = chain.reduce(|product, factor| build.times(&product, &factor));
                let quotient = build.difference_quotient();
                let half = build.number(Rational::new(1, 2));
                let nonstandard = match form {
                    Some(form) => {
                        let trace = build.product(half, build.trace(&form));
                        build.subtract(build.scaled(trace, build.identity()), form)
                    }
                    None => build.scaled(half, build.identity()),
                };
                let product = build.times(&build.times(&quotient, &nonstandard), &build.transposed(&quotient));
                Ok(Some(build.trace(&product)))
            }
            (Some((factor, form)), None) => self.paired((factor, &form), b).map(Some),
            (None, Some((factor, form))) => self.paired((factor, &form), a).map(Some),
            (None, None) => Ok(None),
        }
    }

    /// The factor SO(3) whose `ξ̂` is a matrix outside the algebra, and the matrices `A_1, A_2, …` of `A_1 A_2 … ξ`.
    fn linear(&self, tree: &Tree) -> Option<(usize, Vec<Rc<Tree>>)> {
        if let Some(factor) = self.in_matrix(tree) {
            return self.build.of(factor).group().is_so3.then(|| (factor, Vec::new()));
        }
        let Kind::Multiply(a, b) = &tree.kind else { return None };
        let (factor, rest) = self.linear(b)?;
        let own = self.build.of(factor);
        // A product of matrices in parentheses is one matrix.
        let matrix = match a.shape {
            Shape::Scalar => own.scaled(a.clone(), own.identity()),
            shape if shape == own.square() => a.clone(),
            Shape::Matrix(..) => return None,
        };
        Some((factor, [vec![matrix], rest].concat()))
    }

    fn factors(&mut self, factors: &[Rc<Tree>]) -> Result<Vec<Rc<Tree>>, Misfit> {
        factors.iter().map(|factor| self.of(factor)).collect()
    }

    /// `(A vee((F − I)/h))·b`.
    fn paired(&mut self, (factor, factors): (usize, &[Rc<Tree>]), other: &Rc<Tree>) -> Result<Rc<Tree>, Misfit> {
        let (build, factors, other) = (self.build.of(factor), self.factors(factors)?, self.of(other)?);
        let vector = build.components(build.difference_quotient());
        let image = factors.iter().rev().fold(vector, |image, factor| build.times(factor, &image));
        Ok(build.scalar(Kind::Dot(image, other)))
    }
}
