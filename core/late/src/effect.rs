//! The stages of a step, interpreted.

use std::sync::Arc;

use liestep::groups::{Advected, CayleyRetraction, LieGroup, Retraction};
use liestep::mechanics::{DiscreteLagrangian, Effect, KineticPart, Limit, Residual, SceneVisitor};
use liestep::numbers::{Coordinates, Entries, Real, real};
use liestep_derivation::{MOST_TERMS, Source};

use crate::carried::Slots;
use crate::code::{Arrays, Code};
use crate::declaration::Declaration;
use crate::term::{Late, is_finite};

type Matrix<G> = <G as LieGroup>::Matrix;
type Vector<G> = <G as LieGroup>::Vector;
type Square<G> = <Vector<G> as Coordinates<<G as LieGroup>::Scalar>>::Square;

/// The entries of small values, on the stack.
struct List<T> {
    entries: [T; 16],
    more: Vec<T>,
    length: usize,
}

impl<T: Real> List<T> {
    fn of(value: &impl Entries<T>) -> Self {
        let mut list = Self { entries: [T::zero(); 16], more: Vec::new(), length: 0 };
        value.each(&mut |entry| {
            match list.entries.get_mut(list.length) {
                Some(place) => *place = entry,
                None if list.more.is_empty() => {
                    list.more = list.entries.to_vec();
                    list.more.push(entry);
                }
                None => list.more.push(entry),
            }
            list.length += 1;
        });
        list
    }

    fn get(&self) -> &[T] {
        if self.more.is_empty() { &self.entries[..self.length] } else { &self.more }
    }
}

/// What comes out of a program from the given place on, as a vector.
fn vector<T: Real, V: Entries<T>>(outputs: &dyn Fn(usize) -> T, mut from: usize) -> V {
    V::from_entries(&mut || {
        from += 1;
        outputs(from - 1)
    })
}

/// The same as a square matrix, row by row.
fn square<G: LieGroup>(outputs: &dyn Fn(usize) -> G::Scalar, from: usize) -> Square<G> {
    Vector::<G>::square(|column| {
        let mut entry = from + column;
        Vector::<G>::from_entries(&mut || {
            entry += G::DIMENSION;
            outputs(entry - G::DIMENSION)
        })
    })
}

/// The constants of a step.
#[derive(Clone, Debug)]
pub struct Constants<T> {
    declaration: &'static Declaration,
    folded: Arc<Folded<T>>,
}

/// Numbers that don't change from step to step.
#[derive(Debug, PartialEq)]
struct Folded<T> {
    numbers: Vec<T>,
    /// With them the first registers of each program.
    terms: Box<[T]>,
    kick_before: Box<[T]>,
    newton_system: Box<[T]>,
    newton_residual: Box<[T]>,
    kick_after: Box<[T]>,
    kick_derivative: Box<[T]>,
}

impl<T: PartialEq> PartialEq for Constants<T> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.declaration, other.declaration) && self.folded.numbers == other.folded.numbers
    }
}

/// What one solve needs: the right side, what is advected, and what they determine.
#[derive(Clone, Copy, Debug)]
pub struct StepTerms<T, V, W> {
    right_side: V,
    advected: W,
    numbers: [T; MOST_TERMS],
}

impl<G, W, K> Late<G, W, K>
where
    G: LieGroup,
    W: Advected<G> + Slots,
{
    /// What a term comes to, by `F`, `w` and `h`.
    fn term<R>(
        &self,
        code: &Code,
        (f, w, h): (&Matrix<G>, &W, G::Scalar),
        make: impl FnOnce(&dyn Fn(usize) -> G::Scalar) -> R,
    ) -> R {
        let (element, advected) = (List::of(f), List::of(w));
        let inverse = code.reads(Source::Inverse).then(|| List::of(&G::from_matrix_unchecked(*f).inverse().matrix()));
        let arrays = Arrays {
            step: Some(h),
            parameters: &self.numbers,
            advected: advected.get(),
            element: element.get(),
            inverse: inverse.as_ref().map_or(&[], List::get),
            ..Arrays::default()
        };
        code.run(&code.image(&[]), &arrays, make)
    }
}

impl<G, W, K> Effect for Late<G, W, K>
where
    G: LieGroup,
    W: Advected<G> + Slots,
    K: KineticPart,
    CayleyRetraction: Retraction<G>,
{
    type Retraction = CayleyRetraction;
    type Kinetic = K;
    type Constants = Constants<G::Scalar>;
    type StepTerms = StepTerms<G::Scalar, Vector<G>, W>;

    // Those of the declaration are asked of a value.
    const INERTIA_IS_CONSTANT: bool = false;
    const IS_QUADRATIC: bool = false;
    const DERIVATION: &'static str = "a declaration that was read while the program runs; see its derivation\n";

    fn derivation(&self) -> String {
        self.declaration.derivation.to_owned()
    }

    fn has_constant_inertia(&self) -> bool {
        self.declaration.has_constant_inertia
    }

    fn is_quadratic(&self) -> bool {
        self.declaration.is_quadratic
    }

    fn denominators(constants: &Self::Constants) -> u32 {
        constants.declaration.denominators
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<G::Scalar>) {
        visitor.term(self.declaration.derivation);
        for (index, name) in self.declaration.names.iter().enumerate() {
            self.of_parameter(index).iter().for_each(|&number| visitor.parameter(name, number));
        }
    }

    fn momentum_jacobian(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Square<G> {
        self.term(&self.declaration.momentum_jacobian, (f, w, h), |outputs| square::<G>(outputs, 0))
    }

    fn limit(&self, velocity: Option<&Vector<G>>, w: &W) -> Limit<Self> {
        let advected = List::of(w);
        let arrays = Arrays { parameters: &self.numbers, advected: advected.get(), ..Arrays::default() };
        if let (Some(velocity), Some([l, momentum, hessian])) = (velocity, &self.declaration.at_velocity) {
            let velocity = List::of(velocity);
            let arrays = Arrays { velocity: velocity.get(), ..arrays };
            let number = |code: &Code| code.run(&code.image(&[]), &arrays, |outputs| outputs(0));
            return Limit {
                l: number(l),
                momentum: momentum.run(&momentum.image(&[]), &arrays, |outputs| vector(outputs, 0)),
                hessian: hessian.run(&hessian.image(&[]), &arrays, |outputs| square::<G>(outputs, 0)),
            };
        }
        let code = &self.declaration.at_rest;
        let entries = G::DIMENSION * G::DIMENSION;
        code.run(&code.image(&[]), &arrays, |outputs| {
            let potential = outputs(entries + G::DIMENSION);
            Limit::quadratic(velocity, square::<G>(outputs, 0), vector(outputs, entries), potential)
        })
    }

    fn constants(&self, h: G::Scalar) -> Self::Constants {
        let Declaration { constants, terms, kick_before, newton_system, newton_residual, kick_after, .. } =
            self.declaration;
        let arrays = Arrays { step: Some(h), parameters: &self.numbers, ..Arrays::default() };
        let numbers: Vec<G::Scalar> =
            constants.run(&constants.image(&[]), &arrays, |outputs| (0..constants.outputs()).map(outputs).collect());
        let image = |code: &Code| code.image(&numbers);
        let folded = Folded {
            terms: image(terms),
            kick_before: image(kick_before),
            newton_system: image(newton_system),
            newton_residual: image(newton_residual),
            kick_after: image(kick_after),
            kick_derivative: self.declaration.kick_derivative.as_ref().map(image).unwrap_or_default(),
            numbers,
        };
        Constants { declaration: self.declaration, folded: Arc::new(folded) }
    }

    fn are_finite(constants: &Self::Constants) -> bool {
        constants.folded.numbers.iter().all(is_finite)
    }

    fn kick_before(constants: &Self::Constants, w: &W) -> Vector<G> {
        if !constants.declaration.parts.kick_before {
            return nothing::<G>();
        }
        let advected = List::of(w);
        let arrays = Arrays { advected: advected.get(), ..Arrays::default() };
        constants.declaration.kick_before.run(&constants.folded.kick_before, &arrays, |outputs| vector(outputs, 0))
    }

    fn kick_derivative(constants: &Self::Constants, w: &W, velocity: &Vector<G>) -> Option<Vector<G>> {
        let code = constants.declaration.kick_derivative.as_ref()?;
        let (advected, velocity) = (List::of(w), List::of(velocity));
        let arrays = Arrays { advected: advected.get(), velocity: velocity.get(), ..Arrays::default() };
        Some(code.run(&constants.folded.kick_derivative, &arrays, |outputs| vector(outputs, 0)))
    }

    fn step_terms(constants: &Self::Constants, a: &Vector<G>, w: &W) -> Self::StepTerms {
        let (target, advected) = (List::of(a), List::of(w));
        let mut numbers = [real::<G::Scalar>(0.0); MOST_TERMS];
        let arrays = Arrays { target: target.get(), advected: advected.get(), ..Arrays::default() };
        let code = &constants.declaration.terms;
        code.run(&constants.folded.terms, &arrays, |outputs| {
            numbers.iter_mut().take(code.outputs()).enumerate().for_each(|(at, number)| *number = outputs(at));
        });
        StepTerms { right_side: *a, advected: *w, numbers }
    }

    fn newton_system(constants: &Self::Constants, terms: &Self::StepTerms, half: &Vector<G>) -> (Vector<G>, Square<G>) {
        let declaration = constants.declaration;
        let code = &declaration.newton_system;
        let image = &constants.folded.newton_system;
        let (residual, jacobian): (Vector<G>, Square<G>) =
            iteration::<G, W, _>((code, image), constants, terms, half, |outputs| {
                (vector(outputs, 0), square::<G>(outputs, G::DIMENSION))
            });
        if !declaration.in_increment {
            return (residual, jacobian);
        }
        let tangent = <CayleyRetraction as Retraction<G>>::tangent_of_half(half);
        (residual, Vector::<G>::square(|k| jacobian * Vector::<G>::column(&tangent, k)))
    }

    fn newton_residual(constants: &Self::Constants, terms: &Self::StepTerms, half: &Vector<G>) -> Residual<Vector<G>> {
        let declaration = constants.declaration;
        let program = (&declaration.newton_residual, &*constants.folded.newton_residual);
        iteration::<G, W, _>(program, constants, terms, half, |outputs| Residual {
            momentum_defect: vector(outputs, 0),
            moving_kick: declaration.is_expensive.then(|| vector(outputs, G::DIMENSION)),
        })
    }

    fn kick_after(constants: &Self::Constants, increment: &Matrix<G>, next: &W) -> Vector<G> {
        if !constants.declaration.parts.kick_after {
            return nothing::<G>();
        }
        let code = &constants.declaration.kick_after;
        let (entries, next) = (List::of(increment), List::of(next));
        let inverse = code.reads(Source::Inverse).then(|| List::of(&G::from_increment(increment).inverse().matrix()));
        let arrays = Arrays {
            increment: entries.get(),
            next: next.get(),
            inverse: inverse.as_ref().map_or(&[], List::get),
            ..Arrays::default()
        };
        code.run(&constants.folded.kick_after, &arrays, |outputs| vector(outputs, 0))
    }
}

/// What changes nothing by being added, not even the sign of a zero.
fn nothing<G: LieGroup>() -> Vector<G> {
    -Vector::<G>::zero()
}

/// What an iteration computes.
fn iteration<G: LieGroup, W: Advected<G>, R>(
    (code, image): (&Code, &[G::Scalar]),
    constants: &Constants<G::Scalar>,
    terms: &StepTerms<G::Scalar, Vector<G>, W>,
    half: &Vector<G>,
    make: impl FnOnce(&dyn Fn(usize) -> G::Scalar) -> R,
) -> R
where
    CayleyRetraction: Retraction<G>,
{
    let coordinates = List::of(half);
    // Off SO(3) the system is written in the increment.
    let increment =
        constants.declaration.in_increment.then(|| <CayleyRetraction as Retraction<G>>::increment_of_half(half));
    let inverse = increment.filter(|_| code.reads(Source::InverseIncrement)).map(|it| G::inverse_increment(&it));
    let [increment, inverse] = [increment, inverse].map(|matrix| matrix.map(|matrix| List::of(&matrix)));
    let is_cut = |kind: fn(usize) -> Source| code.reads(kind);
    let (target, advected) = (
        is_cut(Source::Target).then(|| List::of(&terms.right_side)),
        is_cut(Source::Advected).then(|| List::of(&terms.advected)),
    );
    let arrays = Arrays {
        terms: &terms.numbers,
        half: coordinates.get(),
        increment: increment.as_ref().map_or(&[], List::get),
        inverse_increment: inverse.as_ref().map_or(&[], List::get),
        target: target.as_ref().map_or(&[], List::get),
        advected: advected.as_ref().map_or(&[], List::get),
        ..Arrays::default()
    };
    code.run(image, &arrays, make)
}

impl<G, W, K> DiscreteLagrangian for Late<G, W, K>
where
    G: LieGroup,
    W: Advected<G> + Slots,
    K: KineticPart,
    CayleyRetraction: Retraction<G>,
{
    // Asked of a value.
    const SELF_ADJOINT: bool = true;

    fn is_self_adjoint(&self) -> bool {
        self.declaration.is_self_adjoint
    }

    fn l_d(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> G::Scalar {
        self.declaration
            .lagrangian
            .as_ref()
            .map_or(real(0.0), |terms| self.term(&terms.l_d, (f, w, h), |outputs| outputs(0)))
    }

    fn right_momentum(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Vector<G> {
        self.covector(|terms| &terms.right_momentum, f, w, h)
    }

    fn left_momentum(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Vector<G> {
        self.covector(|terms| &terms.left_momentum, f, w, h)
    }

    fn diamond(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Vector<G> {
        self.covector(|terms| &terms.diamond, f, w, h)
    }

    fn legendre_minus(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Vector<G> {
        self.covector(|terms| &terms.legendre_minus, f, w, h)
    }

    fn discrete_energy(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> G::Scalar {
        let terms = self.declaration.lagrangian.as_ref();
        terms.map_or(real(0.0), |terms| self.term(&terms.discrete_energy, (f, w, h), |outputs| outputs(0)))
    }
}

impl<G, W, K> Late<G, W, K>
where
    G: LieGroup,
    W: Advected<G> + Slots,
{
    fn covector(
        &self,
        code: impl Fn(&crate::declaration::Lagrangian) -> &Code,
        f: &Matrix<G>,
        w: &W,
        h: G::Scalar,
    ) -> Vector<G> {
        let terms = self.declaration.lagrangian.as_ref();
        terms.map_or_else(Vector::<G>::zero, |terms| self.term(code(terms), (f, w, h), |outputs| vector(outputs, 0)))
    }
}
