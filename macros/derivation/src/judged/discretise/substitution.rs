//! A continuous Lagrangian evaluated at the velocity and the parameters of a step.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::build::Build;
use crate::declared::{Kind, Name, Shape, Tree, parts};
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
    /// `a·vee(ξ̂)`. Both are equal on the algebra; for the matrix `(F − I)/h` they are the terms of (3.13). Products of
    /// sums are sums of products.
    fn form(&mut self, a: &Rc<Tree>, b: &Rc<Tree>) -> Result<Option<Rc<Tree>>, Misfit> {
        if !self.moves(a) && !self.moves(b) {
            return Ok(None);
        }
        let (Some(left), Some(right)) = (self.affine(a), self.affine(b)) else { return Ok(None) };
        let mut sum: Option<Rc<Tree>> = None;
        for (one, other) in left.iter().flat_map(|one| right.iter().map(move |other| (one, other))) {
            let Some(product) = self.paired(one, other)? else { return Ok(None) };
            sum = Some(match sum {
                Some(sum) => self.build.add(sum, product),
                None => product,
            });
        }
        Ok(sum)
    }

    /// Whether the matrix of a velocity that is outside the algebra is a part of this.
    fn moves(&self, tree: &Rc<Tree>) -> bool {
        self.velocities.iter().any(Option::is_none) && parts(tree).iter().any(|part| self.in_matrix(part).is_some())
    }

    /// A vector as a sum of products of matrices with a velocity of a factor SO(3), whose `ξ̂` is a matrix outside the
    /// algebra, or with a vector; `None` for any other expression, or for a long sum. A `let` is opened.
    fn affine(&self, tree: &Rc<Tree>) -> Option<Vec<Image>> {
        if let Some(factor) = self.in_matrix(tree) {
            let is_so3 = self.build.of(factor).group().is_so3;
            return is_so3.then(|| vec![Image { matrices: Vec::new(), of: Of::Velocity(factor) }]);
        }
        if !self.moves(tree) {
            return Some(vec![Image { matrices: Vec::new(), of: Of::Vector(tree.clone()) }]);
        }
        let minus = || self.build.number(Rational::integer(-1));
        let both = |a: Vec<Image>, b: Vec<Image>| Some([a, b].concat()).filter(|sum| sum.len() <= MOST_IMAGES);
        match &tree.kind {
            Kind::Bound(_, a) => self.affine(a),
            Kind::Negate(a) => Some(self.scaled(&minus(), self.affine(a)?)),
            Kind::Add(a, b) => both(self.affine(a)?, self.affine(b)?),
            Kind::Subtract(a, b) => both(self.affine(a)?, self.scaled(&minus(), self.affine(b)?)),
            Kind::Multiply(a, b) if a.shape == Shape::Scalar => Some(self.scaled(a, self.affine(b)?)),
            Kind::Multiply(a, b) if b.shape == Shape::Scalar => Some(self.scaled(b, self.affine(a)?)),
            Kind::Multiply(a, b) if !self.moves(a) => Self::turned(a, self.affine(b)?),
            Kind::Divide(a, b) => {
                let one = self.build.number(Rational::ONE);
                Some(self.scaled(&self.build.divided(one, b.clone()), self.affine(a)?))
            }
            Kind::Cross(a, b) if !self.moves(a) => {
                let hat = self.build.tree(IN_SPACE, Kind::CrossMatrix(a.clone()));
                Self::turned(&hat, self.affine(b)?)
            }
            Kind::Cross(a, b) if !self.moves(b) => {
                let hat = self.build.tree(IN_SPACE, Kind::CrossMatrix(b.clone()));
                Some(self.scaled(&minus(), Self::turned(&hat, self.affine(a)?)?))
            }
            _ => None,
        }
    }

    fn scaled(&self, by: &Rc<Tree>, images: Vec<Image>) -> Vec<Image> {
        let one = |Image { matrices, of }| match of {
            Of::Velocity(factor) => {
                let own = self.build.of(factor);
                Image { matrices, of }.behind(&own.scaled(by.clone(), own.identity()))
            }
            Of::Vector(vector) => Image { matrices, of: Of::Vector(self.build.scaled(by.clone(), vector)) },
        };
        images.into_iter().map(one).collect()
    }

    /// The images under one more matrix; `None` if that isn't of vectors in space.
    fn turned(matrix: &Rc<Tree>, images: Vec<Image>) -> Option<Vec<Image>> {
        (matrix.shape == IN_SPACE).then(|| images.into_iter().map(|image| image.behind(matrix)).collect())
    }

    fn factors(&mut self, factors: &[Rc<Tree>]) -> Result<Vec<Rc<Tree>>, Misfit> {
        factors.iter().map(|factor| self.of(factor)).collect()
    }

    /// The product of two images; `None` for the velocities of two bodies, which don't form a trace of one matrix.
    fn paired(&mut self, one: &Image, other: &Image) -> Result<Option<Rc<Tree>>, Misfit> {
        let (left, right) = (self.factors(&one.matrices)?, self.factors(&other.matrices)?);
        let (factor, matrices, fixed) = match (&one.of, &other.of) {
            (Of::Velocity(a), Of::Velocity(b)) if a != b => return Ok(None),
            (Of::Velocity(factor), Of::Velocity(_)) => return Ok(Some(self.square(*factor, &left, right))),
            (Of::Velocity(factor), Of::Vector(vector)) => (*factor, left, self.image(&right, vector)?),
            (Of::Vector(vector), Of::Velocity(factor)) => (*factor, right, self.image(&left, vector)?),
            (Of::Vector(a), Of::Vector(b)) => {
                let (a, b) = (self.image(&left, a)?, self.image(&right, b)?);
                return Ok(Some(self.build.scalar(Kind::Dot(a, b))));
            }
        };
        // `(A vee((F − I)/h))·b`.
        let build = self.build.of(factor);
        let vector = build.components(build.difference_quotient());
        let image = matrices.iter().rev().fold(vector, |image, factor| build.times(factor, &image));
        Ok(Some(build.scalar(Kind::Dot(image, fixed))))
    }

    fn image(&mut self, matrices: &[Rc<Tree>], vector: &Rc<Tree>) -> Result<Rc<Tree>, Misfit> {
        let vector = self.of(vector)?;
        Ok(matrices.iter().rev().fold(vector, |image, matrix| self.build.times(matrix, &image)))
    }

    /// `tr(ξ̂ S_d ξ̂ᵀ)`.
    fn square(&self, factor: usize, left: &[Rc<Tree>], right: Vec<Rc<Tree>>) -> Rc<Tree> {
        let build = &self.build.of(factor);
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
        build.trace(&product)
    }
}

/// The shape of the matrices of rotations.
const IN_SPACE: Shape = Shape::Matrix(3, 3);

/// The limit on the products of a vector's sum: a momentum that a person writes has fewer.
const MOST_IMAGES: usize = 12;

/// The image `A_1 A_2 … v` of a velocity, or of a vector.
#[derive(Clone)]
struct Image {
    matrices: Vec<Rc<Tree>>,
    of: Of,
}

impl Image {
    fn behind(self, matrix: &Rc<Tree>) -> Self {
        Self { matrices: [vec![matrix.clone()], self.matrices].concat(), of: self.of }
    }
}

#[derive(Clone)]
enum Of {
    Velocity(usize),
    Vector(Rc<Tree>),
}
