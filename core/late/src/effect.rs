//! The stages of a step, by a back end.

use std::sync::Arc;

use liestep::groups::{Advected, CayleyRetraction, LieGroup, Retraction};
use liestep::mechanics::{DiscreteLagrangian, Effect, KineticPart, Limit, Parts, Residual, SceneVisitor};
use liestep::numbers::{Blocks, Coordinates, Entries, Real, real};
use liestep_derivation::{Array, MOST_TERMS, Stages};

use crate::carried::Slots;
use crate::code::{Backend, Given, Interpreted};
use crate::declaration::{All, Declaration, Ready, ready};
use crate::term::{Late, entries, is_finite};

pub(crate) type Matrix<G> = <G as LieGroup>::Matrix;
pub(crate) type Vector<G> = <G as LieGroup>::Vector;
pub(crate) type Square<G> = <Vector<G> as Coordinates<<G as LieGroup>::Scalar>>::Square;

/// The entries of a value, which stand where its size says that there is room: what isn't used costs time to clear.
macro_rules! listed {
    ($name:ident = $value:expr) => {
        let (mut small, mut middle, mut large, mut more);
        let $name: &[G::Scalar] = match (size_of_val($value).div_ceil(size_of::<G::Scalar>()), $value) {
            (0..=3, value) => {
                small = [real::<G::Scalar>(0.0); 3];
                filled(value, &mut small)
            }
            (4..=9, value) => {
                middle = [real::<G::Scalar>(0.0); 9];
                filled(value, &mut middle)
            }
            (10..=18, value) => {
                large = [real::<G::Scalar>(0.0); 18];
                filled(value, &mut large)
            }
            (size, value) => {
                more = vec![real::<G::Scalar>(0.0); size];
                filled(value, &mut more)
            }
        };
    };
}

#[inline]
fn filled<'a, T: Real>(value: &impl Entries<T>, room: &'a mut [T]) -> &'a [T] {
    let mut length = 0;
    value.each(&mut |entry| {
        if let Some(place) = room.get_mut(length) {
            *place = entry;
        }
        length += 1;
    });
    room.get(..length).unwrap_or(room)
}

/// Runs a program, and makes something of what comes out.
#[inline(never)]
fn run<T: Real, B: Backend<T>, R, const N: usize>(
    program: &Ready<B::Code>,
    image: &B::Image,
    given: Given<'_, T, N>,
    make: impl FnOnce(&[T]) -> R,
) -> R {
    // What isn't used costs time to clear.
    if const { size_of::<R>() <= 3 * size_of::<T>() } && program.outputs <= 3 {
        into::<T, B, R, N>(program, image, given, &mut [T::zero(); 3], make)
    } else if program.outputs <= 12 {
        into::<T, B, R, N>(program, image, given, &mut [T::zero(); 12], make)
    } else if const { size_of::<R>() > 12 * size_of::<T>() } && program.outputs <= 48 {
        into::<T, B, R, N>(program, image, given, &mut [T::zero(); 48], make)
    } else {
        into::<T, B, R, N>(program, image, given, &mut vec![T::zero(); program.outputs], make)
    }
}

/// By this room for the outputs.
#[inline]
fn into<T: Real, B: Backend<T>, R, const N: usize>(
    program: &Ready<B::Code>,
    image: &B::Image,
    given: Given<'_, T, N>,
    outputs: &mut [T],
    make: impl FnOnce(&[T]) -> R,
) -> R {
    B::run(&program.code, image, given, outputs);
    make(outputs)
}

/// The same of a program that knows no constants.
pub(crate) fn run_alone<T: Real, B: Backend<T>, R, const N: usize>(
    program: &Ready<B::Code>,
    given: Given<'_, T, N>,
    make: impl FnOnce(&[T]) -> R,
) -> R {
    run::<T, B, R, N>(program, &B::image(&program.code, &[]), given, make)
}

/// The first of these numbers as a vector.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn vector<T: Real, V: Entries<T>>(outputs: &[T]) -> V {
    let mut outputs = outputs.iter().copied();
    V::from_entries(&mut || outputs.next().unwrap_or_else(|| real(f64::NAN)))
}

/// The same as a square matrix, row by row.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn square<G: LieGroup>(outputs: &[G::Scalar]) -> Square<G> {
    Vector::<G>::square(|column| {
        let mut places = (0..).map(|row| column + row * G::DIMENSION);
        let mut next = || places.next().and_then(|place| outputs.get(place).copied());
        Vector::<G>::from_entries(&mut || next().unwrap_or_else(|| real(f64::NAN)))
    })
}

/// The constants of a step.
#[derive(Debug)]
pub struct Constants<T: Real, B: Backend<T> = Interpreted>(pub(crate) Arc<Folded<T, B>>);

/// Numbers that don't change from step to step, and what runs with them.
#[derive(Debug)]
pub(crate) struct Folded<T: Real, B: Backend<T>> {
    pub(crate) declaration: &'static Declaration,
    pub(crate) stages: All<B::Code>,
    pub(crate) is_specialised: bool,
    pub(crate) numbers: Vec<T>,
    /// With them the images of programs.
    terms: B::Image,
    kick_before: B::Image,
    newton_system: B::Image,
    newton_residual: B::Image,
    kick_after: B::Image,
    kick_derivative: Option<B::Image>,
}

impl<T: Real, B: Backend<T>> Constants<T, B> {
    pub(crate) fn of(
        declaration: &'static Declaration,
        stages: &All<B::Code>,
        is_specialised: bool,
        numbers: Vec<T>,
    ) -> Self {
        let image = |program: &Ready<B::Code>| B::image(&program.code, &numbers);
        let Stages { terms, kick_before, newton_system, newton_residual, kick_after, kick_derivative, .. } = &**stages;
        let folded = Folded {
            terms: image(terms),
            kick_before: image(kick_before),
            newton_system: image(newton_system),
            newton_residual: image(newton_residual),
            kick_after: image(kick_after),
            kick_derivative: kick_derivative.as_ref().map(image),
            declaration,
            is_specialised,
            numbers,
            stages: Arc::clone(stages),
        };
        Self(Arc::new(folded))
    }
}

impl<T: Real, B: Backend<T>> Clone for Constants<T, B> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T: Real, B: Backend<T>> PartialEq for Constants<T, B> {
    fn eq(&self, other: &Self) -> bool {
        let (one, other) = (&*self.0, &*other.0);
        let is_same = std::ptr::eq(one.declaration, other.declaration) && one.is_specialised == other.is_specialised;
        is_same && one.numbers == other.numbers
    }
}

/// What one solve needs: the right side, what is advected, and what they determine.
#[derive(Clone, Copy, Debug)]
pub struct StepTerms<T, V, W> {
    right_side: V,
    advected: W,
    numbers: [T; MOST_TERMS],
}

impl<G, W, K, B> Late<G, W, K, B>
where
    G: LieGroup,
    W: Advected<G> + Slots,
    B: Backend<G::Scalar>,
{
    /// What a term comes to, by `F`, `w` and `h`.
    fn term<R>(
        &self,
        program: &Ready<B::Code>,
        (f, w, h): (&Matrix<G>, &W, G::Scalar),
        make: impl FnOnce(&[G::Scalar]) -> R,
    ) -> R {
        let inverse = program.reads(Array::Inverse).then(|| G::from_matrix_unchecked(*f).inverse().matrix());
        let (element, advected, inverse) = (entries(f), entries(w), inverse.map_or_else(Vec::new, |it| entries(&it)));
        let given = [
            (Array::Step, std::slice::from_ref(&h)),
            (Array::Parameters, &self.numbers),
            (Array::Advected, &advected),
            (Array::Element, &element),
            (Array::Inverse, &inverse),
        ];
        run_alone::<_, B, _, _>(program, given, make)
    }

    /// A term of a Lagrangian, of which a force has none.
    fn of_lagrangian<R>(
        &self,
        index: usize,
        at: (&Matrix<G>, &W, G::Scalar),
        make: impl FnOnce(&[G::Scalar]) -> R,
    ) -> R {
        match &self.stages.lagrangian {
            Some(terms) => self.term(&terms[index], at, make),
            None => make(&vec![real(0.0); G::DIMENSION]),
        }
    }
}

impl<G, W, K, B> Effect for Late<G, W, K, B>
where
    G: LieGroup,
    W: Advected<G> + Slots,
    K: KineticPart,
    B: Backend<G::Scalar>,
    CayleyRetraction: Retraction<G>,
{
    type Retraction = CayleyRetraction;
    type Kinetic = K;
    type Constants = Constants<G::Scalar, B>;
    type StepTerms = StepTerms<G::Scalar, Vector<G>, W>;

    // Those of the declaration are asked of a value.
    const INERTIA_IS_CONSTANT: bool = false;
    const IS_QUADRATIC: bool = false;
    const DERIVATION: &'static str = "a declaration that was read while the program runs; see its derivation\n";

    fn derivation(&self) -> String {
        self.declaration.derivation.clone()
    }

    fn has_constant_inertia(&self) -> bool {
        self.declaration.has_constant_inertia
    }

    fn is_quadratic(&self) -> bool {
        self.declaration.is_quadratic
    }

    fn denominators(constants: &Self::Constants) -> u32 {
        constants.0.declaration.denominators
    }

    fn parts(constants: &Self::Constants) -> Parts {
        constants.0.declaration.parts
    }

    fn apart(constants: &Self::Constants) -> Blocks {
        constants.0.declaration.apart
    }

    fn jacobian_is_expensive(constants: &Self::Constants) -> bool {
        constants.0.declaration.is_expensive()
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<G::Scalar>) {
        visitor.term(&self.declaration.derivation);
        for (index, parameter) in self.declaration.parameters.iter().enumerate() {
            self.of_parameter(index).iter().for_each(|&number| visitor.parameter(&parameter.name, number));
        }
    }

    fn momentum_jacobian(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Square<G> {
        self.term(&self.stages.momentum_jacobian, (f, w, h), square::<G>)
    }

    fn limit(&self, velocity: Option<&Vector<G>>, w: &W) -> Limit<Self> {
        listed!(advected = w);
        listed!(given = velocity.unwrap_or(&Vector::<G>::zero()));
        let arrays = [(Array::Parameters, &*self.numbers), (Array::Advected, advected), (Array::Velocity, given)];
        if let (Some(_), Some([l, momentum, hessian])) = (velocity, &self.stages.at_velocity) {
            return Limit {
                l: run_alone::<_, B, _, _>(l, arrays, |outputs| outputs[0]),
                momentum: run_alone::<_, B, _, _>(momentum, arrays, vector),
                hessian: run_alone::<_, B, _, _>(hessian, arrays, square::<G>),
            };
        }
        let entries = G::DIMENSION * G::DIMENSION;
        run_alone::<_, B, _, _>(&self.stages.at_rest, arrays, |outputs| {
            let (inertia, bias) = (square::<G>(outputs), vector(&outputs[entries..]));
            Limit::quadratic(velocity, inertia, bias, outputs[entries + G::DIMENSION])
        })
    }

    fn with_energy(&self, w: &W, energy: G::Scalar) -> Option<(W, G::Scalar)> {
        let before = &self.declaration.carried[..self.declaration.energy?];
        let place = before.iter().map(|one| one.shape.0 * one.shape.1).sum::<usize>();
        let (mut at, mut before) = (0, energy);
        let w = w.zip(w, &mut |entry, _| {
            at += 1;
            if at == place + 1 { std::mem::replace(&mut before, entry) } else { entry }
        });
        Some((w, before))
    }

    fn constants(&self, h: G::Scalar) -> Self::Constants {
        let given = [(Array::Step, std::slice::from_ref(&h)), (Array::Parameters, &*self.numbers)];
        let constants = &self.stages.constants;
        let numbers = run_alone::<_, B, _, _>(constants, given, |outputs| outputs[..constants.outputs].to_vec());
        let programs = self.specialise.map(|specialise| specialise(&self.declaration.programs, &numbers));
        // What is too large now was too large before, and isn't here.
        let own = programs.and_then(|programs| ready::<G::Scalar, B>(&programs).ok()).map(Arc::new);
        let is_specialised = own.is_some();
        Constants::of(self.declaration, own.as_ref().unwrap_or(&self.stages), is_specialised, numbers)
    }

    fn are_finite(constants: &Self::Constants) -> bool {
        constants.0.numbers.iter().all(is_finite)
    }

    #[inline]
    fn kick_before(constants: &Self::Constants, w: &W) -> Vector<G> {
        let folded = &*constants.0;
        listed!(advected = w);
        let given = [(Array::Constants, &*folded.numbers), (Array::Advected, advected)];
        run::<_, B, _, _>(&folded.stages.kick_before, &folded.kick_before, given, vector)
    }

    fn kick_derivative(constants: &Self::Constants, w: &W, velocity: &Vector<G>) -> Option<Vector<G>> {
        let folded = &*constants.0;
        let (program, image) = (folded.stages.kick_derivative.as_ref()?, folded.kick_derivative.as_ref()?);
        listed!(advected = w);
        listed!(velocity = velocity);
        let given = [(Array::Constants, &*folded.numbers), (Array::Advected, advected), (Array::Velocity, velocity)];
        Some(run::<_, B, _, _>(program, image, given, vector))
    }

    #[inline]
    fn step_terms(constants: &Self::Constants, a: &Vector<G>, w: &W) -> Self::StepTerms {
        let folded = &*constants.0;
        let mut terms = StepTerms { right_side: *a, advected: *w, numbers: [real(0.0); MOST_TERMS] };
        // Where there is nothing to solve, nobody reads them.
        if folded.declaration.parts.unknown {
            listed!(target = a);
            listed!(advected = w);
            let given = [(Array::Constants, &*folded.numbers), (Array::Target, target), (Array::Advected, advected)];
            B::run(&folded.stages.terms.code, &folded.terms, given, &mut terms.numbers);
        }
        terms
    }

    #[inline]
    fn newton_system(constants: &Self::Constants, terms: &Self::StepTerms, half: &Vector<G>) -> (Vector<G>, Square<G>) {
        let folded = &*constants.0;
        let program = (&folded.stages.newton_system, &folded.newton_system);
        let (residual, jacobian): (Vector<G>, Square<G>) =
            iteration::<G, W, B, _>(program, folded, terms, half, |outputs| {
                (vector(outputs), square::<G>(&outputs[G::DIMENSION..]))
            });
        if !folded.declaration.in_increment {
            return (residual, jacobian);
        }
        let tangent = <CayleyRetraction as Retraction<G>>::tangent_of_half(half);
        (residual, Vector::<G>::square(|k| jacobian * Vector::<G>::column(&tangent, k)))
    }

    #[inline]
    fn newton_residual(constants: &Self::Constants, terms: &Self::StepTerms, half: &Vector<G>) -> Residual<Vector<G>> {
        let folded = &*constants.0;
        let program = (&folded.stages.newton_residual, &folded.newton_residual);
        iteration::<G, W, B, _>(program, folded, terms, half, |outputs| Residual {
            momentum_defect: vector(outputs),
            moving_kick: folded.declaration.is_expensive.then(|| vector(&outputs[G::DIMENSION..])),
        })
    }

    #[inline]
    fn kick_after(constants: &Self::Constants, increment: &Matrix<G>, next: &W) -> Vector<G> {
        let folded = &*constants.0;
        let (program, image) = (&folded.stages.kick_after, &folded.kick_after);
        listed!(entries = increment);
        listed!(next = next);
        let given = [(Array::Constants, &*folded.numbers), (Array::Increment, entries), (Array::Next, next)];
        if !program.reads(Array::Inverse) {
            return run::<_, B, _, _>(program, image, given, vector);
        }
        listed!(inverse = &G::from_increment(increment).inverse().matrix());
        let [constants, increment, next] = given;
        run::<_, B, _, _>(program, image, [constants, increment, next, (Array::Inverse, inverse)], vector)
    }
}

/// What an iteration computes.
#[inline]
fn iteration<G: LieGroup, W: Advected<G>, B: Backend<G::Scalar>, R>(
    (program, image): (&Ready<B::Code>, &B::Image),
    folded: &Folded<G::Scalar, B>,
    terms: &StepTerms<G::Scalar, Vector<G>, W>,
    half: &Vector<G>,
    make: impl FnOnce(&[G::Scalar]) -> R,
) -> R
where
    CayleyRetraction: Retraction<G>,
{
    let (constants, numbers) = ((Array::Constants, &*folded.numbers), (Array::Terms, &terms.numbers[..]));
    listed!(coordinates = half);
    let coordinates = (Array::Half, coordinates);
    // Of many terms some are computed anew, and off SO(3) the system is written in the increment.
    let more = [Array::Target, Array::Advected, Array::Increment, Array::InverseIncrement];
    if !more.into_iter().any(|array| program.reads(array)) {
        return run::<_, B, _, _>(program, image, [constants, numbers, coordinates], make);
    }
    let increment = <CayleyRetraction as Retraction<G>>::increment_of_half(half);
    let is_read = program.reads(Array::InverseIncrement);
    let inverse = if is_read { G::inverse_increment(&increment) } else { increment };
    listed!(increment = &increment);
    listed!(inverse = &inverse);
    listed!(target = &terms.right_side);
    listed!(advected = &terms.advected);
    let increments = [(Array::Increment, increment), (Array::InverseIncrement, inverse)];
    let [target, advected] = [(Array::Target, target), (Array::Advected, advected)];
    let given = [constants, numbers, coordinates, increments[0], increments[1], target, advected];
    run::<_, B, _, _>(program, image, given, make)
}

impl<G, W, K, B> DiscreteLagrangian for Late<G, W, K, B>
where
    G: LieGroup,
    W: Advected<G> + Slots,
    K: KineticPart,
    B: Backend<G::Scalar>,
    CayleyRetraction: Retraction<G>,
{
    // Asked of a value.
    const SELF_ADJOINT: bool = true;

    fn is_self_adjoint(&self) -> bool {
        self.declaration.is_self_adjoint
    }

    fn l_d(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> G::Scalar {
        self.of_lagrangian(0, (f, w, h), |outputs| outputs[0])
    }

    fn right_momentum(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Vector<G> {
        self.of_lagrangian(1, (f, w, h), vector)
    }

    fn left_momentum(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Vector<G> {
        self.of_lagrangian(2, (f, w, h), vector)
    }

    fn diamond(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Vector<G> {
        self.of_lagrangian(3, (f, w, h), vector)
    }

    fn legendre_minus(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Vector<G> {
        self.of_lagrangian(4, (f, w, h), vector)
    }

    fn discrete_energy(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> G::Scalar {
        self.of_lagrangian(5, (f, w, h), |outputs| outputs[0])
    }
}
