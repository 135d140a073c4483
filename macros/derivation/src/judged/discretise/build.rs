//! Parts of a declared tree: increments, velocities, and moved parameters.

use std::rc::Rc;

use crate::declared::{Coordinates, Declaration, Kind, Name, Shape, Tree};
use crate::judged::explain::Misfit;
use crate::judged::verify;
use crate::mathematics::chart::Chart;
use crate::mathematics::derive::View;
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Function, Rational, Variance};

/// A builder for parts of a tree, all with the span of the declared one.
#[derive(Clone, Copy)]
pub(super) struct Build<'a> {
    pub(super) declaration: &'a Declaration,
    pub(super) at: &'a Tree,
    /// The factor of the group that the parts belong to.
    pub(super) factor: usize,
}

impl Build<'_> {
    pub(super) fn tree(&self, shape: Shape, kind: Kind) -> Rc<Tree> {
        Tree::until(Tree::new(self.at.span, shape, kind), self.at.end)
    }

    pub(super) fn scalar(&self, kind: Kind) -> Rc<Tree> {
        self.tree(Shape::Scalar, kind)
    }

    pub(super) fn number(&self, value: Rational) -> Rc<Tree> {
        self.scalar(Kind::Number(value))
    }

    pub(super) fn add(&self, a: Rc<Tree>, b: Rc<Tree>) -> Rc<Tree> {
        self.tree(a.shape, Kind::Add(a, b))
    }

    pub(super) fn subtract(&self, a: Rc<Tree>, b: Rc<Tree>) -> Rc<Tree> {
        self.tree(a.shape, Kind::Subtract(a, b))
    }

    /// The product of two scalars.
    pub(super) fn product(&self, a: Rc<Tree>, b: Rc<Tree>) -> Rc<Tree> {
        self.scalar(Kind::Multiply(a, b))
    }

    pub(super) fn scaled(&self, factor: Rc<Tree>, of: Rc<Tree>) -> Rc<Tree> {
        self.tree(of.shape, Kind::Multiply(factor, of))
    }

    pub(super) fn times(&self, a: &Rc<Tree>, b: &Rc<Tree>) -> Rc<Tree> {
        let shape = match (a.shape, b.shape) {
            (Shape::Matrix(rows, _), Shape::Matrix(_, columns)) => Shape::Matrix(rows, columns),
            (shape, Shape::Scalar) | (Shape::Scalar, shape) => shape,
        };
        self.tree(shape, Kind::Multiply(a.clone(), b.clone()))
    }

    pub(super) fn transposed(&self, a: &Rc<Tree>) -> Rc<Tree> {
        let shape = match a.shape {
            Shape::Matrix(rows, columns) => Shape::Matrix(columns, rows),
            Shape::Scalar => Shape::Scalar,
        };
        self.tree(shape, Kind::Transpose(a.clone()))
    }

    pub(super) fn trace(&self, a: &Rc<Tree>) -> Rc<Tree> {
        self.scalar(Kind::Trace(a.clone()))
    }

    pub(super) fn divided(&self, a: Rc<Tree>, b: Rc<Tree>) -> Rc<Tree> {
        self.tree(a.shape, Kind::Divide(a, b))
    }

    /// The builder for another factor of the group.
    pub(super) fn of(&self, factor: usize) -> Self {
        Self { factor, ..*self }
    }

    pub(super) fn group(&self) -> &Group {
        self.declaration.group.factor(self.factor)
    }

    /// The velocity as a function of the increment; `None` if `ξ̂` is the matrix `(F − I)/h`.
    pub(super) fn velocity(&self, coordinates: Coordinates) -> Result<Option<Rc<Tree>>, Misfit> {
        let velocity = match coordinates {
            _ if self.group().is_added => self.increment(),
            Coordinates::Ambient => return Ok(None),
            Coordinates::Cayley => self.cayley_coordinates()?,
            Coordinates::Exponential => self.logarithm()?,
        };
        let velocity = self.per_step(velocity);
        // The velocity has a name of its own, so that the derivation differentiates through it as one value.
        let name = self.declaration.name_of_velocity(self.factor);
        Ok(Some(self.tree(velocity.shape, Kind::Bound(name, velocity))))
    }

    pub(super) fn square(&self) -> Shape {
        Shape::Matrix(self.group().size, self.group().size)
    }

    pub(super) fn identity(&self) -> Rc<Tree> {
        self.tree(self.square(), Kind::Identity)
    }

    /// The increment: a matrix, or for a translation a vector, on a line a scalar.
    pub(super) fn increment(&self) -> Rc<Tree> {
        let shape = match self.group().shape() {
            (1, 1) => Shape::Scalar,
            (rows, columns) => Shape::Matrix(rows, columns),
        };
        self.tree(shape, Kind::Name(Name::Increment(self.factor)))
    }

    /// The increment `F` of a step, and its inverse `F⁻¹`.
    pub(super) fn whole_increment(&self) -> [Rc<Tree>; 2] {
        let increment = self.increment();
        let inverse =
            if self.group().is_added { Kind::Negate(increment.clone()) } else { Kind::Inverse(increment.clone()) };
        let inverse = self.tree(increment.shape, inverse);
        [increment, inverse]
    }

    pub(super) fn inverse(&self) -> Rc<Tree> {
        let [_, inverse] = self.whole_increment();
        inverse
    }

    pub(super) fn advected(&self, index: usize) -> Rc<Tree> {
        self.tree(self.declaration.advected_kind(index).shape(), Kind::Name(Name::Advected(index)))
    }

    /// `G⁻¹·w`, where `element` returns `G` and `G⁻¹` of each factor.
    pub(super) fn carried(&self, index: usize, element: &dyn Fn(usize) -> [Rc<Tree>; 2]) -> Rc<Tree> {
        let w = self.advected(index);
        let seen = self.declaration.advected.get(index).map_or(View::From(0), |w| w.seen);
        let is_added = |factor: usize| self.declaration.group.factor(factor).is_added;
        let by = |factor: usize, part: usize| element(factor)[part].clone();
        let factor = match seen {
            View::Relative { of, from } if is_added(of) => {
                return self.add(w, self.subtract(by(of, 0), by(from, 0)));
            }
            View::Configuration(of) if is_added(of) => return self.add(w, by(of, 0)),
            View::Relative { of, from } => return self.times(&self.times(&by(from, 1), &w), &by(of, 0)),
            View::Configuration(of) => return self.times(&w, &by(of, 0)),
            View::From(factor) => factor,
        };
        let variance = self.declaration.advected_kind(index).variance();
        if variance == Variance::Fixed {
            return w;
        }
        let [forwards, back] = &element(factor);
        variance.moved(&w, [back, forwards], |matrix| self.transposed(matrix), |a, b| self.times(a, b))
    }

    /// The components of an element of the algebra.
    pub(super) fn components(&self, element: Rc<Tree>) -> Rc<Tree> {
        if self.group().is_so3 {
            return self.tree(Shape::Matrix(3, 1), Kind::Vee(element));
        }
        let forms = self.group().dual().as_slice().into();
        self.tree(Shape::Matrix(self.group().dimension(), 1), Kind::Components(element, forms))
    }

    /// The element under a name of its own if its entries are used one by one.
    pub(super) fn named(&self, element: Rc<Tree>) -> Rc<Tree> {
        if self.group().is_so3 { element } else { self.tree(element.shape, Kind::Bound("X".to_owned(), element)) }
    }

    pub(super) fn per_step(&self, coordinates: Rc<Tree>) -> Rc<Tree> {
        self.divided(coordinates, self.scalar(Kind::Name(Name::Step)))
    }

    /// `ξ` with `cay(ξ̂) = F`, by the shortest of the formulas that hold on the group.
    pub(super) fn cayley_coordinates(&self) -> Result<Rc<Tree>, Misfit> {
        if self.group().chart() != Ok(Chart::Cayley) {
            return Err(Misfit::NoCayley);
        }
        let element = self.cayley_candidates().into_iter().map(|candidate| self.named(candidate)).find(|candidate| {
            let components = self.components(candidate.clone());
            verify::is_cayley_coordinates(self.group(), Name::Increment(self.factor), &components)
        });
        element.map(|element| self.components(element)).ok_or(Misfit::NoCayley)
    }

    /// Matrices that equal `ξ̂ = 2 (F − I)(F + I)⁻¹` on some groups.
    pub(super) fn cayley_candidates(&self) -> Vec<Rc<Tree>> {
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
        // (F + I)⁻¹ = (1/c) Σ … by Cayley and Hamilton, with the recursion of Faddeev and LeVerrier.
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
    pub(super) fn logarithm(&self) -> Result<Rc<Tree>, Misfit> {
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
    pub(super) fn nilpotent_logarithm(&self, small: &Rc<Tree>) -> Result<Rc<Tree>, Misfit> {
        let coefficient = |k| Rational::new(if k % 2 == 1 { 1 } else { -1 }, k);
        Ok(self.named(self.nilpotent_terms(small, coefficient)?))
    }

    /// `exp(hξ̂/2)` and its inverse.
    pub(super) fn half_increment(&self, velocity: &Rc<Tree>) -> Result<[Rc<Tree>; 2], Misfit> {
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

    /// `Σ c_k Nᵏ`, a finite sum if all generators are strictly triangular.
    pub(super) fn nilpotent_terms(
        &self,
        small: &Rc<Tree>,
        coefficient: impl Fn(i128) -> Rational,
    ) -> Result<Rc<Tree>, Misfit> {
        let Group { size, generators, .. } = self.group();
        let vanishes = |generator: &Vec<Rational>| {
            generator.iter().enumerate().all(|(at, entry)| entry.is_zero() || at / size < at % size)
        };
        if !generators.iter().all(vanishes) {
            return Err(Misfit::NoLogarithm);
        }
        let (mut power, mut sum) = (small.clone(), self.scaled(self.number(coefficient(1)), small.clone()));
        // The powers may vanish earlier, as for translations.
        for k in 2..i128::try_from(verify::nilpotency(self.group())).unwrap_or(1) {
            power = self.times(&power, small);
            sum = self.add(sum, self.scaled(self.number(coefficient(k)), power.clone()));
        }
        Ok(sum)
    }

    /// `(F − I)/h`.
    pub(super) fn difference_quotient(&self) -> Rc<Tree> {
        self.per_step(self.subtract(self.increment(), self.identity()))
    }
}
