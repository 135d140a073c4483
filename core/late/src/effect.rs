//! The stages of a step, run by a back end.

use std::sync::Arc;

use liestep::groups::{Advected, CayleyRetraction, LieGroup, Retraction};
use liestep::mechanics::{DiscreteLagrangian, Effect, KineticPart, Limit, Parts, SceneVisitor};
use liestep::numbers::{Blocks, Coordinates, Entries, Real, real};
use liestep_derivation::Array;

use crate::carried::Slots;
use crate::code::{Backend, Given, Interpreter};
use crate::declaration::{All, Declaration, Ready, ready};
use crate::term::{Late, entries, is_finite};

pub(crate) type Matrix<G> = <G as LieGroup>::Matrix;
pub(crate) type Vector<G> = <G as LieGroup>::Vector;
pub(crate) type Square<G> = <Vector<G> as Coordinates<<G as LieGroup>::Scalar>>::Square;

/// Room for numbers, on the stack unless they are many: clearing unused room costs time.
macro_rules! room {
    ($name:ident: $scalar:ty, $count:expr) => { room!($name: $scalar, $count, least 3, few 6, less 12, more 18, most 48) };
    ($name:ident: $scalar:ty, $count:expr, $($place:ident $most:literal),+) => {
        let mut beyond;
        $(let mut $place;)+
        let $name: &mut [$scalar] = match $count {
            $(0..=$most => {
                $place = [real::<$scalar>(0.0); $most];
                &mut $place
            })+
            count => {
                beyond = vec![real::<$scalar>(0.0); count];
                &mut beyond
            }
        };
    };
}

/// The entries of a value as a slice, copied unless they are contiguous.
macro_rules! listed {
    ($name:ident = $value:expr) => {
        room!(room: G::Scalar, size_of_val($value).div_ceil(size_of::<G::Scalar>()));
        let $name = match $value.in_place() {
            Some(slice) => slice,
            None => filled($value, room),
        };
    };
}

#[cfg_attr(not(debug_assertions), inline(always))]
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

/// The outputs of a program that reads no constants.
pub(crate) fn alone<T: Real, B: Backend<T>, const N: usize>(
    program: &Ready<B::Code>,
    given: Given<'_, T, N>,
) -> Vec<T> {
    let mut outputs = vec![T::zero(); program.outputs];
    B::run(&program.code, &[], given, &mut outputs);
    outputs
}

/// The first of these numbers as a vector.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn vector<T: Real, V: Entries<T>>(outputs: &[T]) -> V {
    let mut outputs = outputs.iter().copied();
    V::from_entries(&mut || outputs.next().unwrap_or_else(|| real(f64::NAN)))
}

/// The first of these numbers as a square matrix, row by row.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn square<G: LieGroup>(outputs: &[G::Scalar]) -> Square<G> {
    Vector::<G>::square(|column| {
        let mut places = (0..).map(|row| column + row * G::DIMENSION);
        let mut next = || places.next().and_then(|place| outputs.get(place).copied());
        Vector::<G>::from_entries(&mut || next().unwrap_or_else(|| real(f64::NAN)))
    })
}

/// The constants of a step: numbers that don't change from step to step, and the programs that read them.
#[derive(Debug)]
pub struct Constants<T: Real, B: Backend<T> = Interpreter> {
    pub(crate) declaration: &'static Declaration,
    pub(crate) stages: All<B::Code>,
    pub(crate) is_specialised: bool,
    pub(crate) numbers: Arc<[T]>,
    /// The kicks before and after, if they depend on constants alone.
    pub(crate) known: [Option<Arc<[T]>>; 2],
}

impl<T: Real, B: Backend<T>> Constants<T, B> {
    pub(crate) fn of(
        declaration: &'static Declaration,
        stages: &All<B::Code>,
        is_specialised: bool,
        numbers: Arc<[T]>,
    ) -> Self {
        let known = [&stages.kick_before, &stages.kick_after].map(|program| {
            program.reads_constants_alone().then(|| {
                let mut kick = vec![T::zero(); program.outputs];
                B::run(&program.code, &numbers, [], &mut kick);
                kick.into()
            })
        });
        Self { declaration, stages: Arc::clone(stages), is_specialised, numbers, known }
    }
}

impl<T: Real, B: Backend<T>> Clone for Constants<T, B> {
    fn clone(&self) -> Self {
        let (stages, numbers, known) = (Arc::clone(&self.stages), Arc::clone(&self.numbers), self.known.clone());
        Self { declaration: self.declaration, stages, is_specialised: self.is_specialised, numbers, known }
    }
}

impl<T: Real, B: Backend<T>> PartialEq for Constants<T, B> {
    fn eq(&self, other: &Self) -> bool {
        let is_same = std::ptr::eq(self.declaration, other.declaration) && self.is_specialised == other.is_specialised;
        is_same && self.numbers == other.numbers
    }
}

/// The right-hand side of one solve, and the advected parameters.
#[derive(Clone, Copy, Debug)]
pub struct StepTerms<V, W> {
    right_side: V,
    advected: W,
}

impl<G, W, K, B> Late<G, W, K, B>
where
    G: LieGroup,
    W: Advected<G> + Slots,
    B: Backend<G::Scalar>,
{
    /// The value of a term at `F`, `w` and `h`.
    fn term(&self, program: &Ready<B::Code>, (f, w, h): (&Matrix<G>, &W, G::Scalar)) -> Vec<G::Scalar> {
        let inverse = program.reads(Array::Inverse).then(|| G::from_matrix_unchecked(*f).inverse().matrix());
        let (element, advected, inverse) = (entries(f), entries(w), inverse.map_or_else(Vec::new, |it| entries(&it)));
        let given = [
            (Array::Step, std::slice::from_ref(&h)),
            (Array::Parameters, &self.numbers),
            (Array::Advected, &advected),
            (Array::Element, &element),
            (Array::Inverse, &inverse),
        ];
        alone::<_, B, _>(program, given)
    }

    /// A term of the Lagrangian; zero for a force.
    fn of_lagrangian(&self, index: usize, at: (&Matrix<G>, &W, G::Scalar)) -> Vec<G::Scalar> {
        let terms = self.stages.lagrangian.as_ref();
        terms.map_or_else(|| vec![real(0.0); G::DIMENSION], |terms| self.term(&terms[index], at))
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
    type StepTerms = StepTerms<Vector<G>, W>;

    // A value has its declaration's parts; the type allows all, or kicks alone.
    const PARTS: Parts = Parts { unknown: K::MAY_BE_UNKNOWN, ..Parts::ALL };
    const INERTIA_IS_CONSTANT: bool = !K::MAY_BE_UNKNOWN;
    const IS_QUADRATIC: bool = !K::MAY_BE_UNKNOWN;
    const DERIVATION: &'static str = "a declaration that was read while the program runs; see its derivation\n";

    fn derivation(&self) -> String {
        self.declaration.derivation.clone()
    }

    fn has_constant_inertia(&self) -> bool {
        Self::INERTIA_IS_CONSTANT || self.declaration.has_constant_inertia
    }

    fn is_quadratic(&self) -> bool {
        Self::IS_QUADRATIC || self.declaration.is_quadratic
    }

    fn denominators(constants: &Self::Constants) -> u32 {
        constants.declaration.denominators
    }

    fn parts(constants: &Self::Constants) -> Parts {
        constants.declaration.parts
    }

    fn apart(constants: &Self::Constants) -> Blocks {
        constants.declaration.apart
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<G::Scalar>) {
        visitor.term(&self.declaration.derivation);
        for (index, parameter) in self.declaration.parameters.iter().enumerate() {
            self.of_parameter(index).iter().for_each(|&number| visitor.parameter(&parameter.name, number));
        }
    }

    fn momentum_jacobian(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Square<G> {
        square::<G>(&self.term(&self.stages.momentum_jacobian, (f, w, h)))
    }

    fn limit(&self, velocity: Option<&Vector<G>>, w: &W) -> Limit<Self> {
        listed!(advected = w);
        let zero = Vector::<G>::zero();
        listed!(given = velocity.unwrap_or(&zero));
        let given = [(Array::Parameters, &*self.numbers), (Array::Advected, advected), (Array::Velocity, given)];
        if let (Some(_), Some(programs)) = (velocity, &self.stages.at_velocity) {
            let [l, momentum, hessian] = programs.each_ref().map(|program| alone::<_, B, _>(program, given));
            return Limit { l: l[0], momentum: vector(&momentum), hessian: square::<G>(&hessian) };
        }
        // A varying inertia is evaluated in each step.
        let entries = G::DIMENSION * G::DIMENSION;
        room!(outputs: G::Scalar, entries + G::DIMENSION + 1);
        let code = &self.stages.at_rest.code;
        B::run(code, &[], given, outputs);
        let (inertia, bias) = (square::<G>(outputs), vector(&outputs[entries..]));
        Limit::quadratic(velocity, inertia, bias, outputs[entries + G::DIMENSION])
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
        let numbers = alone::<_, B, _>(&self.stages.constants, given);
        let programs = self.specialise.map(|specialise| specialise(&self.declaration.programs, &numbers));
        // A specialised program is no larger than the general one.
        let own = programs.and_then(|programs| ready::<G::Scalar, B>(&programs).ok()).map(Arc::new);
        let is_specialised = own.is_some();
        Constants::of(self.declaration, own.as_ref().unwrap_or(&self.stages), is_specialised, numbers.into())
    }

    fn are_finite(constants: &Self::Constants) -> bool {
        constants.numbers.iter().all(is_finite)
    }

    #[cfg_attr(all(not(debug_assertions), not(feature = "small")), inline(always))]
    fn kick_before(constants: &Self::Constants, w: &W) -> Vector<G> {
        if let Some(kick) = &constants.known[0] {
            return vector(&kick[..G::DIMENSION]);
        }
        listed!(advected = w);
        room!(kick: G::Scalar, G::DIMENSION);
        B::run(&constants.stages.kick_before.code, &constants.numbers, [(Array::Advected, advected)], kick);
        vector(kick)
    }

    fn kick_derivative(constants: &Self::Constants, w: &W, velocity: &Vector<G>) -> Option<Vector<G>> {
        let program = constants.stages.kick_derivative.as_ref()?;
        listed!(advected = w);
        listed!(velocity = velocity);
        room!(derivative: G::Scalar, G::DIMENSION);
        let given = [(Array::Advected, advected), (Array::Velocity, velocity)];
        B::run(&program.code, &constants.numbers, given, derivative);
        Some(vector(derivative))
    }

    #[cfg_attr(all(not(debug_assertions), not(feature = "small")), inline(always))]
    fn step_terms(_: &Self::Constants, a: &Vector<G>, w: &W) -> Self::StepTerms {
        StepTerms { right_side: *a, advected: *w }
    }

    #[cfg_attr(all(not(debug_assertions), not(feature = "small")), inline(always))]
    fn newton_system(constants: &Self::Constants, terms: &Self::StepTerms, half: &Vector<G>) -> (Vector<G>, Square<G>) {
        room!(outputs: G::Scalar, G::DIMENSION * (G::DIMENSION + 1));
        iteration::<G, W, B>((&constants.stages.newton_system, &constants.numbers), terms, half, outputs);
        let (residual, jacobian) = (vector(outputs), square::<G>(&outputs[G::DIMENSION..]));
        if !constants.declaration.in_increment {
            return (residual, jacobian);
        }
        let tangent = <CayleyRetraction as Retraction<G>>::tangent_of_half(half);
        (residual, Vector::<G>::square(|k| jacobian * Vector::<G>::column(&tangent, k)))
    }

    #[cfg_attr(all(not(debug_assertions), not(feature = "small")), inline(always))]
    fn newton_residual(constants: &Self::Constants, terms: &Self::StepTerms, half: &Vector<G>) -> Vector<G> {
        room!(outputs: G::Scalar, G::DIMENSION);
        iteration::<G, W, B>((&constants.stages.newton_residual, &constants.numbers), terms, half, outputs);
        vector(outputs)
    }

    #[cfg_attr(all(not(debug_assertions), not(feature = "small")), inline(always))]
    fn kick_after(constants: &Self::Constants, increment: &Matrix<G>, next: &W) -> Vector<G> {
        if let Some(kick) = &constants.known[1] {
            return vector(&kick[..G::DIMENSION]);
        }
        let program = &constants.stages.kick_after;
        room!(kick: G::Scalar, G::DIMENSION);
        if program.reads(Array::Increment) || program.reads(Array::Inverse) {
            kick_with_more::<G, W, B>((program, &constants.numbers), &{ *increment }, &{ *next }, kick);
        } else {
            let next = *next;
            listed!(next = &next);
            B::run(&program.code, &constants.numbers, [(Array::Next, next)], kick);
        }
        vector(kick)
    }
}

/// Runs a kick that also depends on the increment.
#[inline(never)]
fn kick_with_more<G: LieGroup, W: Advected<G>, B: Backend<G::Scalar>>(
    (program, constants): (&Ready<B::Code>, &[G::Scalar]),
    increment: &Matrix<G>,
    next: &W,
    kick: &mut [G::Scalar],
) {
    let is_read = program.reads(Array::Inverse);
    let inverse = if is_read { G::from_increment(increment).inverse().matrix() } else { *increment };
    listed!(increment = increment);
    listed!(next = next);
    listed!(inverse = &inverse);
    B::run(
        &program.code,
        constants,
        [(Array::Increment, increment), (Array::Next, next), (Array::Inverse, inverse)],
        kick,
    );
}

#[cfg_attr(all(not(debug_assertions), not(feature = "small")), inline(always))]
fn iteration<G: LieGroup, W: Advected<G>, B: Backend<G::Scalar>>(
    (program, constants): (&Ready<B::Code>, &[G::Scalar]),
    terms: &StepTerms<Vector<G>, W>,
    half: &Vector<G>,
    outputs: &mut [G::Scalar],
) where
    CayleyRetraction: Retraction<G>,
{
    // A borrowed value has to stay in memory: only copies are borrowed.
    let half = *half;
    // Off SO(3) the system depends on the increment: a separate function leaves a step on SO(3) short.
    if program.reads(Array::Increment) || program.reads(Array::InverseIncrement) {
        return iteration_with_more::<G, W, B>((program, constants), &{ *terms }, &{ half }, outputs);
    }
    listed!(coordinates = &half);
    listed!(target = &terms.right_side);
    listed!(advected = &terms.advected);
    let given = [(Array::Half, coordinates), (Array::Target, target), (Array::Advected, advected)];
    B::run(&program.code, constants, given, outputs);
}

#[inline(never)]
fn iteration_with_more<G: LieGroup, W: Advected<G>, B: Backend<G::Scalar>>(
    (program, constants): (&Ready<B::Code>, &[G::Scalar]),
    terms: &StepTerms<Vector<G>, W>,
    half: &Vector<G>,
    outputs: &mut [G::Scalar],
) where
    CayleyRetraction: Retraction<G>,
{
    let increment = <CayleyRetraction as Retraction<G>>::increment_of_half(half);
    let is_read = program.reads(Array::InverseIncrement);
    let inverse = if is_read { G::inverse_increment(&increment) } else { increment };
    listed!(coordinates = half);
    listed!(target = &terms.right_side);
    listed!(advected = &terms.advected);
    listed!(increment = &increment);
    listed!(inverse = &inverse);
    let given = [
        (Array::Half, coordinates),
        (Array::Target, target),
        (Array::Advected, advected),
        (Array::Increment, increment),
        (Array::InverseIncrement, inverse),
    ];
    B::run(&program.code, constants, given, outputs);
}

impl<G, W, K, B> DiscreteLagrangian for Late<G, W, K, B>
where
    G: LieGroup,
    W: Advected<G> + Slots,
    K: KineticPart,
    B: Backend<G::Scalar>,
    CayleyRetraction: Retraction<G>,
{
    // Values answer by `is_self_adjoint`.
    const SELF_ADJOINT: bool = true;

    fn is_self_adjoint(&self) -> bool {
        self.declaration.is_self_adjoint
    }

    fn l_d(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> G::Scalar {
        self.of_lagrangian(0, (f, w, h))[0]
    }

    fn right_momentum(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Vector<G> {
        vector(&self.of_lagrangian(1, (f, w, h)))
    }

    fn left_momentum(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Vector<G> {
        vector(&self.of_lagrangian(2, (f, w, h)))
    }

    fn diamond(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Vector<G> {
        vector(&self.of_lagrangian(3, (f, w, h)))
    }

    fn legendre_minus(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> Vector<G> {
        vector(&self.of_lagrangian(4, (f, w, h)))
    }

    fn discrete_energy(&self, f: &Matrix<G>, w: &W, h: G::Scalar) -> G::Scalar {
        self.of_lagrangian(5, (f, w, h))[0]
    }
}
