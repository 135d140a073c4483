//! From `l(ξ, w)` to `l_d(F, w)`, by substitution into the declared tree.
//!
//! ```text
//! trapezoid    (h/2) (l(ξ, w) + l(ξ, F⁻¹·w))
//! midpoint     h l(ξ, τ(hξ/2)⁻¹·w)
//! chord        h l(ξ, (w + F⁻¹·w)/2)
//! ```
//!
//! with `hξ = τ⁻¹(F)` for the retraction `τ`, or with the matrix `ξ̂ = (F − I)/h` as it is, which isn't in the algebra.
//! What is made is a declared `l_d` like any other, and goes through all that such a one goes through.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::{explain, verify};
use crate::declared::errors::Errors;
use crate::declared::{Coordinates, Declaration, Discretisation, Kind, Name, Quadrature, Shape, Tree};
use crate::mathematics::derive::Seen;
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Function, Rational, Variance};

/// Why a declared `l` can't be discretised as was asked.
#[derive(Clone, Copy, Debug)]
pub(super) enum Misfit {
    /// The group's logarithm isn't known in closed form.
    NoLogarithm,
    /// The group's matrices are too large for a Cayley transform in closed form.
    NoCayley,
    /// The velocity of this factor stands where a matrix that isn't in the algebra can't.
    NotInMatrix(usize),
}

/// The discrete Lagrangian that is made of `l`; `None` where it doesn't fit, which has been reported.
pub(crate) fn discretised(
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

/// Makes parts of a tree, all in the place of the declared one.
#[derive(Clone, Copy)]
struct Build<'a> {
    declaration: &'a Declaration,
    at: &'a Tree,
    /// The factor of the group that it is about.
    factor: usize,
}

impl Build<'_> {
    fn tree(&self, shape: Shape, kind: Kind) -> Rc<Tree> {
        Tree::until(Tree::new(self.at.span, shape, kind), self.at.end)
    }

    fn scalar(&self, kind: Kind) -> Rc<Tree> {
        self.tree(Shape::Scalar, kind)
    }

    fn number(&self, value: Rational) -> Rc<Tree> {
        self.scalar(Kind::Number(value))
    }

    fn add(&self, a: Rc<Tree>, b: Rc<Tree>) -> Rc<Tree> {
        self.tree(a.shape, Kind::Add(a, b))
    }

    fn subtract(&self, a: Rc<Tree>, b: Rc<Tree>) -> Rc<Tree> {
        self.tree(a.shape, Kind::Subtract(a, b))
    }

    /// Of scalars.
    fn product(&self, a: Rc<Tree>, b: Rc<Tree>) -> Rc<Tree> {
        self.scalar(Kind::Multiply(a, b))
    }

    fn scaled(&self, factor: Rc<Tree>, of: Rc<Tree>) -> Rc<Tree> {
        self.tree(of.shape, Kind::Multiply(factor, of))
    }

    fn times(&self, a: &Rc<Tree>, b: &Rc<Tree>) -> Rc<Tree> {
        let shape = match (a.shape, b.shape) {
            (Shape::Matrix(rows, _), Shape::Matrix(_, columns)) => Shape::Matrix(rows, columns),
            (shape, Shape::Scalar) | (Shape::Scalar, shape) => shape,
        };
        self.tree(shape, Kind::Multiply(a.clone(), b.clone()))
    }

    fn transposed(&self, a: &Rc<Tree>) -> Rc<Tree> {
        let shape = match a.shape {
            Shape::Matrix(rows, columns) => Shape::Matrix(columns, rows),
            Shape::Scalar => Shape::Scalar,
        };
        self.tree(shape, Kind::Transpose(a.clone()))
    }

    fn trace(&self, a: &Rc<Tree>) -> Rc<Tree> {
        self.scalar(Kind::Trace(a.clone()))
    }

    fn divided(&self, a: Rc<Tree>, b: Rc<Tree>) -> Rc<Tree> {
        self.tree(a.shape, Kind::Divide(a, b))
    }

    /// The same about another factor of the group.
    fn of(&self, factor: usize) -> Self {
        Self { factor, ..*self }
    }

    fn group(&self) -> &Group {
        self.declaration.group.factor(self.factor)
    }

    /// The velocity as a function of the increment; none where the matrix `(F − I)/h` stands for `ξ̂`.
    fn velocity(&self, coordinates: Coordinates) -> Result<Option<Rc<Tree>>, Misfit> {
        let velocity = match coordinates {
            _ if self.group().is_added => self.increment(),
            Coordinates::Ambient => return Ok(None),
            Coordinates::Cayley => self.cayley_coordinates()?,
            Coordinates::Exponential => self.logarithm()?,
        };
        let velocity = self.per_step(velocity);
        // A name of its own, so that it is differentiated through as one.
        let name = self.declaration.name_of_velocity(self.factor);
        Ok(Some(self.tree(velocity.shape, Kind::Bound(name, velocity))))
    }

    fn square(&self) -> Shape {
        Shape::Matrix(self.group().size, self.group().size)
    }

    fn identity(&self) -> Rc<Tree> {
        self.tree(self.square(), Kind::Identity)
    }

    /// A matrix, where increments are added a vector, and on a line a scalar.
    fn increment(&self) -> Rc<Tree> {
        let shape = match self.group().shape() {
            (1, 1) => Shape::Scalar,
            (rows, columns) => Shape::Matrix(rows, columns),
        };
        self.tree(shape, Kind::Name(Name::Increment(self.factor)))
    }

    /// `F` and `F⁻¹`.
    fn whole_increment(&self) -> [Rc<Tree>; 2] {
        let increment = self.increment();
        let inverse =
            if self.group().is_added { Kind::Negate(increment.clone()) } else { Kind::Inverse(increment.clone()) };
        let inverse = self.tree(increment.shape, inverse);
        [increment, inverse]
    }

    fn inverse(&self) -> Rc<Tree> {
        let [_, inverse] = self.whole_increment();
        inverse
    }

    fn advected(&self, index: usize) -> Rc<Tree> {
        self.tree(self.declaration.advected_kind(index).shape(), Kind::Name(Name::Advected(index)))
    }

    /// `G⁻¹·w`, with the `G` of each factor and its inverse.
    fn carried(&self, index: usize, element: &dyn Fn(usize) -> [Rc<Tree>; 2]) -> Rc<Tree> {
        let w = self.advected(index);
        let seen = self.declaration.advected.get(index).map_or(Seen::From(0), |w| w.seen);
        let is_added = |factor: usize| self.declaration.group.factor(factor).is_added;
        let by = |factor: usize, part: usize| element(factor)[part].clone();
        let factor = match seen {
            Seen::Relative { of, from } if is_added(of) => {
                return self.add(w, self.subtract(by(of, 0), by(from, 0)));
            }
            Seen::Configuration(of) if is_added(of) => return self.add(w, by(of, 0)),
            Seen::Relative { of, from } => return self.times(&self.times(&by(from, 1), &w), &by(of, 0)),
            Seen::Configuration(of) => return self.times(&w, &by(of, 0)),
            Seen::From(factor) => factor,
        };
        let variance = self.declaration.advected_kind(index).variance();
        if variance == Variance::Fixed {
            return w;
        }
        let [forwards, back] = &element(factor);
        match variance {
            Variance::Vector => self.times(back, &w),
            Variance::Covector => self.times(&self.transposed(forwards), &w),
            Variance::Contravariant => self.times(&self.times(back, &w), &self.transposed(back)),
            Variance::Covariant => self.times(&self.times(&self.transposed(forwards), &w), forwards),
            Variance::Mixed => self.times(&self.times(back, &w), forwards),
            Variance::Fixed => w,
        }
    }

    /// The components of an element of the algebra.
    fn components(&self, element: Rc<Tree>) -> Rc<Tree> {
        if self.group().is_so3 {
            return self.tree(Shape::Matrix(3, 1), Kind::Vee(element));
        }
        let forms = self.group().dual().as_slice().into();
        self.tree(Shape::Matrix(self.group().dimension(), 1), Kind::Components(element, forms))
    }

    /// With a name of its own where its entries are asked for one by one.
    fn named(&self, element: Rc<Tree>) -> Rc<Tree> {
        if self.group().is_so3 { element } else { self.tree(element.shape, Kind::Bound("X".to_owned(), element)) }
    }

    fn per_step(&self, coordinates: Rc<Tree>) -> Rc<Tree> {
        self.divided(coordinates, self.scalar(Kind::Name(Name::Step)))
    }

    /// `ξ` with `cay(ξ̂) = F`, by the shortest of the formulas that are right on the group.
    fn cayley_coordinates(&self) -> Result<Rc<Tree>, Misfit> {
        let element = self.cayley_candidates().into_iter().map(|candidate| self.named(candidate)).find(|candidate| {
            let components = self.components(candidate.clone());
            verify::is_cayley_coordinates(self.group(), Name::Increment(self.factor), &components)
        });
        element.map(|element| self.components(element)).ok_or(Misfit::NoCayley)
    }

    /// Matrices that are `ξ̂ = 2 (F − I)(F + I)⁻¹` on some groups.
    fn cayley_candidates(&self) -> Vec<Rc<Tree>> {
        let number = |value| self.number(Rational::integer(value));
        let (f, one) = (self.increment(), self.identity());
        let small = self.subtract(f.clone(), one);
        let difference = self.subtract(f.clone(), self.inverse());
        let trace = self.trace(&f);
        let plus = |value: i128| self.add(number(value), trace.clone());
        let over = |divisor| self.divided(self.scaled(number(2), difference.clone()), divisor);
        let half = |of: Rc<Tree>| self.scaled(self.number(Rational::new(1, 2)), of);
        let squared = self.times(&small, &small);
        // (I − ω̂/2)(F − I) of rigid motions, as ω̂/2 is S/T with T = 2 + 2 cos θ.
        let rigid = |t: Rc<Tree>| {
            let change = self.times(&difference, &small);
            self.subtract(small.clone(), self.divided(change, t))
        };
        let mut candidates = vec![
            small.clone(),
            self.subtract(small.clone(), half(squared)),
            over(plus(1)),
            over(plus(2)),
            self.divided(self.scaled(number(4), difference.clone()), plus(4)),
            rigid(plus(1)),
            rigid(trace.clone()),
            rigid(plus(-1)),
        ];
        // By Cayley and Hamilton, (F + I)⁻¹ = (1/c) Σ …, by the recursion of Faddeev and LeVerrier.
        if self.group().size <= 4 {
            let sum = self.add(f, self.identity());
            let size = i128::try_from(self.group().size).unwrap_or(1);
            let (mut power, mut last) = (self.identity(), number(1));
            for k in 1..=size {
                let product = self.times(&sum, &power);
                last = self.scaled(self.number(Rational::new(-1, k)), self.trace(&product));
                if k < size {
                    let shift = self.scaled(last.clone(), self.identity());
                    power = self.add(product, shift);
                }
            }
            let inverse = self.divided(power, last);
            candidates.push(self.times(&self.scaled(number(-2), small), &inverse));
        }
        candidates
    }

    /// `ξ` with `exp(ξ̂) = F`.
    fn logarithm(&self) -> Result<Rc<Tree>, Misfit> {
        let (f, small) = (self.increment(), self.subtract(self.increment(), self.identity()));
        if self.group().is_so3 {
            let quarter = self.number(Rational::new(1, 4));
            let rest = self.subtract(self.number(Rational::integer(3)), self.trace(&f));
            let ratio = self.scalar(Kind::Apply(Function::LogRatio(0), self.product(quarter, rest)));
            return Ok(self.scaled(ratio, self.components(f)));
        }
        Ok(self.components(self.nilpotent_logarithm(&small)?))
    }

    /// `log(I + N) = N − N²/2 + …`.
    fn nilpotent_logarithm(&self, small: &Rc<Tree>) -> Result<Rc<Tree>, Misfit> {
        let coefficient = |k| Rational::new(if k % 2 == 1 { 1 } else { -1 }, k);
        Ok(self.named(self.nilpotent_terms(small, coefficient)?))
    }

    /// `exp(hξ̂/2)` and its inverse.
    fn half_increment(&self, velocity: &Rc<Tree>) -> Result<[Rc<Tree>; 2], Misfit> {
        let half = self.number(Rational::new(1, 2));
        if self.group().is_added {
            let forwards = self.scaled(half, self.increment());
            let back = self.tree(forwards.shape, Kind::Negate(forwards.clone()));
            return Ok([forwards, back]);
        }
        if self.group().is_so3 {
            let shift = self.scaled(self.product(half, self.scalar(Kind::Name(Name::Step))), velocity.clone());
            let square = |kind| self.tree(self.square(), kind);
            let q = self.scalar(Kind::Dot(shift.clone(), shift.clone()));
            let coefficient = |k| self.scalar(Kind::Apply(Function::Stumpff(k), q.clone()));
            let hat = square(Kind::CrossMatrix(shift));
            let (odd, even) =
                (self.scaled(coefficient(1), hat.clone()), self.scaled(coefficient(2), self.times(&hat, &hat)));
            let even = self.add(self.identity(), even);
            return Ok([self.add(even.clone(), odd.clone()), self.subtract(even, odd)]);
        }
        let small = self.subtract(self.increment(), self.identity());
        let shift = self.scaled(half, self.nilpotent_logarithm(&small)?);
        let factorial = |k: i128| (1..=k).product::<i128>();
        let forwards = self.nilpotent_terms(&shift, |k| Rational::new(1, factorial(k)))?;
        let back = self.nilpotent_terms(&shift, |k| Rational::new(if k % 2 == 1 { -1 } else { 1 }, factorial(k)))?;
        Ok([self.add(self.identity(), forwards), self.add(self.identity(), back)])
    }

    /// `Σ c_k Nᵏ`, which ends where all generators are strictly triangular.
    fn nilpotent_terms(&self, small: &Rc<Tree>, coefficient: impl Fn(i128) -> Rational) -> Result<Rc<Tree>, Misfit> {
        let Group { size, generators, .. } = self.group();
        let vanishes = |generator: &Vec<Rational>| {
            generator.iter().enumerate().all(|(at, entry)| entry.is_zero() || at / size < at % size)
        };
        if !generators.iter().all(vanishes) {
            return Err(Misfit::NoLogarithm);
        }
        let (mut power, mut sum) = (small.clone(), self.scaled(self.number(coefficient(1)), small.clone()));
        // A generator may have an earlier end, as those of translations have.
        for k in 2..i128::try_from(verify::nilpotency(self.group())).unwrap_or(1) {
            power = self.times(&power, small);
            sum = self.add(sum, self.scaled(self.number(coefficient(k)), power.clone()));
        }
        Ok(sum)
    }

    /// `(F − I)/h`.
    fn difference_quotient(&self) -> Rc<Tree> {
        self.per_step(self.subtract(self.increment(), self.identity()))
    }
}

/// `l` with other values for the velocity and for what is advected.
struct Substitution<'a> {
    build: &'a Build<'a>,
    /// Of each factor of the group; `None` where the matrix `(F − I)/h` stands for `ξ̂`.
    velocities: Vec<Option<Rc<Tree>>>,
    carried: Vec<Rc<Tree>>,
    known: BTreeMap<*const Tree, Rc<Tree>>,
}

impl Substitution<'_> {
    fn of(&mut self, tree: &Rc<Tree>) -> Result<Rc<Tree>, Misfit> {
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
                // Where the matrix stands for the velocity, another name of the velocity is none.
                if let Some(factor) = self.in_matrix(a) {
                    return Err(Misfit::NotInMatrix(factor));
                }
                Kind::Bound(name.clone(), self.of(a)?)
            }
        };
        Ok(Tree::until(Tree::new(tree.span, tree.shape, kind), tree.end))
    }

    /// The velocity of a factor; none where a matrix stands for it.
    fn velocity(&self, factor: usize) -> Option<Rc<Tree>> {
        self.velocities.get(factor).cloned().flatten()
    }

    /// The factor whose velocity this is, where a matrix stands for it.
    fn in_matrix(&self, tree: &Tree) -> Option<usize> {
        match tree.kind {
            Kind::Name(Name::Velocity(factor)) if self.velocity(factor).is_none() => Some(factor),
            _ => None,
        }
    }

    /// On SO(3), `(Aξ)·(Bξ)` as `tr(ξ̂ S_d ξ̂ᵀ)` with `S = AᵀB` and `S_d = ½ tr(S) I − S`, and `a·ξ` as `a·vee(ξ̂)`, which
    /// are the same in the algebra, and for the matrix `(F − I)/h` those of (3.13).
    fn form(&mut self, a: &Rc<Tree>, b: &Rc<Tree>) -> Result<Option<Rc<Tree>>, Misfit> {
        match (self.linear(a), self.linear(b)) {
            // Of two bodies their product is none of one matrix.
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

    /// The factor of the group, one of SO(3) whose velocity a matrix stands for, and the matrices `A_1, A_2, …` of
    /// `A_1 A_2 … ξ`.
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
