//! A declaration with numbers, as a term of a scene.

use std::fmt;
use std::marker::PhantomData;
use std::ops::Add;
use std::sync::Arc;

use liestep::SetupError;
use liestep::groups::{Advected, LieGroup};
use liestep::mechanics::{Effect, KineticPart, SceneVisitor, SharedBy, Sum, Term, WithKinetic};
use liestep::numbers::{Coordinates, Entries, Real, real};
use liestep_derivation::{ParameterKind, Program, Stages};
use nalgebra::Vector1;

use crate::carried::Slots;
use crate::code::{Backend, Interpreter};
use crate::declaration::{All, Declaration, Derivatives, InSpace};
use crate::error::LateError;
use crate::specialised::specialised;

/// Programs with the constants of a stepper written into them.
pub(crate) type Specialise<T> = fn(&Stages<Program>, &[T]) -> Stages<Program>;

/// A declaration that was read while the program runs, with numbers for its parameters: an effect on the group `G`,
/// with the advected or given parameters `W`, as the macro has them, and the kinetic part `K`. The elements of a longer
/// tuple that the declaration doesn't name are zero. `B` runs its programs.
///
/// # Source
///
/// \[RDAE\], section 2.2, as for every [`Effect`].
pub struct Late<G: LieGroup, W = (), K = WithKinetic, B: Backend<G::Scalar> = Interpreter> {
    pub(crate) declaration: &'static Declaration,
    pub(crate) stages: All<B::Code>,
    /// The numbers of all parameters, NaN until they are set.
    pub(crate) numbers: Arc<[G::Scalar]>,
    pub(crate) specialise: Option<Specialise<G::Scalar>>,
    pub(crate) derivatives: Option<Derivatives<B::Code>>,
    pub(crate) types: PhantomData<(W, K)>,
}

impl<G: LieGroup, W, K, B: Backend<G::Scalar>> Clone for Late<G, W, K, B> {
    fn clone(&self) -> Self {
        let (stages, numbers) = (Arc::clone(&self.stages), Arc::clone(&self.numbers));
        let (specialise, derivatives) = (self.specialise, self.derivatives.clone());
        Self { declaration: self.declaration, stages, numbers, specialise, derivatives, types: PhantomData }
    }
}

impl<G: LieGroup, W, K, B: Backend<G::Scalar>> fmt::Debug for Late<G, W, K, B> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct(&self.declaration.name);
        for (index, parameter) in self.declaration.parameters.iter().enumerate() {
            shown.field(&parameter.name, &self.of_parameter(index));
        }
        shown.finish_non_exhaustive()
    }
}

impl<G: LieGroup, W, K, B: Backend<G::Scalar>> PartialEq for Late<G, W, K, B> {
    fn eq(&self, other: &Self) -> bool {
        let is_same = std::ptr::eq(self.declaration, other.declaration);
        is_same && self.numbers == other.numbers && self.specialise.is_some() == other.specialise.is_some()
    }
}

/// Finite in all lanes.
pub(crate) fn is_finite<T: Real>(number: &T) -> bool {
    Coordinates::is_finite(&Vector1::new(*number))
}

impl<G: LieGroup, W: Advected<G> + Slots, K: KineticPart, B: Backend<G::Scalar>> Late<G, W, K, B> {
    /// Derives a struct with `#[lagrangian(…)]` or `#[force(…)]`, and proves the derivation. Its parameters have no
    /// values yet.
    ///
    /// # Errors
    ///
    /// The mistakes of the text; or the declaration isn't one on `G`, with `W` and `K`.
    pub fn parse(text: &str) -> Result<Self, LateError> {
        Self::of(Declaration::parse(text)?)
    }

    /// The effect of a declaration.
    ///
    /// # Errors
    ///
    /// The declaration isn't one on `G`, with `W` and `K`.
    pub fn of(declaration: &'static Declaration) -> Result<Self, LateError> {
        if !has_generators::<G>(declaration) {
            return Err(LateError::Group { declared: declaration.group() });
        }
        let mut slots = Vec::new();
        W::list(&mut slots);
        if !slots.starts_with(&declaration.slots()) {
            return Err(LateError::Advected { declared: format!("{:?}", declaration.slots()) });
        }
        let only_kicks = !declaration.parts.unknown && declaration.has_constant_inertia && declaration.is_quadratic;
        if K::IS_THERE != declaration.has_kinetic || !(K::MAY_BE_UNKNOWN || only_kicks) {
            return Err(LateError::Kinetic { declared: declaration.kinetic() });
        }
        let numbers = declaration.parameters.iter().map(|parameter| parameter.kind.len()).sum();
        let numbers = vec![real(f64::NAN); numbers].into();
        Ok(Self::made(declaration, &declaration.ready::<G::Scalar, B>()?, numbers, None))
    }

    /// Adds the derivatives of its steps, by the state and by the inputs, for
    /// [`Stepper::linearised`](liestep::Stepper::linearised) and its users. Derivatives by parameters aren't among
    /// them.
    ///
    /// # Errors
    ///
    /// [`LateError::NoGradients`] if the text, or that of a term, is without the word `gradients`.
    pub fn differentiable(mut self) -> Result<Self, LateError> {
        self.derivatives = Some(self.declaration.ready_derivatives::<G::Scalar, B>()?);
        Ok(self)
    }

    /// The declaration of a compiled effect, derived anew, with its numbers.
    ///
    /// # Errors
    ///
    /// The effect has no declaration, like a sum; or an error of [`parse`](Self::parse).
    pub fn like<E: Effect<Scalar = G::Scalar, Group = G, Advected = W>>(effect: &E) -> Result<Self, LateError> {
        Self::parse(E::DECLARATION)?.with_all(&numbers(effect))
    }
}

/// The numbers of an effect, as it describes them: those of all parameters of its declaration, in their order.
#[must_use]
pub fn numbers<E: Effect>(effect: &E) -> Vec<E::Scalar> {
    let mut numbers = Numbers(Vec::new());
    effect.describe(&mut numbers);
    numbers.0
}

struct Numbers<T>(Vec<T>);

impl<T> SceneVisitor<T> for Numbers<T> {
    fn term(&mut self, _: &str) {}

    fn parameter(&mut self, _: &str, value: T) {
        self.0.push(value);
    }
}

impl<G: LieGroup<Scalar = f64>, W, K, B: Backend<f64>> Late<G, W, K, B> {
    /// Uses programs that have all numbers of a stepper written into them: they are faster, and their bits may differ
    /// by rounding from those of the compiled step. Specialising them takes as long as many steps.
    #[must_use]
    pub fn specialised(mut self) -> Self {
        self.specialise = Some(specialised);
        self
    }
}

impl<G: LieGroup, W, K, B: Backend<G::Scalar>> Late<G, W, K, B> {
    /// The effect with these programs and any numbers.
    pub(crate) fn made(
        declaration: &'static Declaration,
        stages: &All<B::Code>,
        numbers: Arc<[G::Scalar]>,
        derivatives: Option<Derivatives<B::Code>>,
    ) -> Self {
        Self { declaration, stages: Arc::clone(stages), numbers, specialise: None, derivatives, types: PhantomData }
    }

    /// Sets a parameter, a matrix row by row. An inertia may be given by its three moments, and a diagonal one by its
    /// tensor.
    ///
    /// # Errors
    ///
    /// No parameter has this name, or it has another number of numbers.
    pub fn with(mut self, name: &str, value: &[G::Scalar]) -> Result<Self, LateError> {
        let parameters = &self.declaration.parameters;
        let Some(index) = parameters.iter().position(|known| known.name == name) else {
            let known: Vec<&str> = parameters.iter().map(|parameter| parameter.name.as_str()).collect();
            return Err(LateError::Unknown { name: name.to_owned(), known: known.join(", ") });
        };
        let (start, expected) = self.declaration.place(index);
        let mut numbers = self.numbers.to_vec();
        let place = &mut numbers[start..start + expected];
        let on_diagonal = |entry: usize| entry.is_multiple_of(4);
        match (parameters[index].kind, value.len()) {
            (_, found) if found == expected => place.copy_from_slice(value),
            (ParameterKind::Inertia, 3) => {
                let entry = |at| if on_diagonal(at) { value[at / 4] } else { real::<G::Scalar>(0.0) };
                place.iter_mut().enumerate().for_each(|(at, number)| *number = entry(at));
            }
            (ParameterKind::DiagonalInertia, 9) if (0..9).all(|at| on_diagonal(at) || value[at] == real(0.0)) => {
                place.iter_mut().zip(value.iter().step_by(4)).for_each(|(number, &value)| *number = value);
            }
            (_, found) => return Err(LateError::Size { name: name.to_owned(), expected, found }),
        }
        self.numbers = numbers.into();
        Ok(self)
    }

    /// Sets all parameters, in their order, a diagonal inertia by its tensor: see [`numbers`].
    ///
    /// # Errors
    ///
    /// The number of numbers is another.
    pub fn with_all(mut self, numbers: &[G::Scalar]) -> Result<Self, LateError> {
        // An effect describes a diagonal inertia by the nine entries of its tensor: every fourth is on the diagonal.
        let described = self.declaration.parameters.iter().map(|parameter| match parameter.kind {
            ParameterKind::DiagonalInertia => (9, 4),
            kind => (kind.len(), 1),
        });
        let (expected, found) = (described.clone().map(|(length, _)| length).sum(), numbers.len());
        if expected != found {
            return Err(LateError::Size { name: self.declaration.name.clone(), expected, found });
        }
        let (mut numbers, mut kept) = (numbers.iter().copied(), Vec::with_capacity(self.numbers.len()));
        described.for_each(|(length, stride)| kept.extend(numbers.by_ref().take(length).step_by(stride)));
        self.numbers = kept.into();
        Ok(self)
    }

    /// The declaration of this effect.
    #[must_use]
    pub const fn declaration(&self) -> &'static Declaration {
        self.declaration
    }

    pub(crate) fn of_parameter(&self, index: usize) -> &[G::Scalar] {
        let (start, length) = self.declaration.place(index);
        &self.numbers[start..start + length]
    }
}

/// Whether the generators of the declaration are those of the group.
fn has_generators<G: LieGroup>(declaration: &Declaration) -> bool {
    let (mut component, mut own) = (0, Vec::new());
    for factor in &declaration.factors {
        own.push((component, factor.generators.first().map_or(0, Vec::len)));
        component += factor.generators.len();
    }
    if component != G::DIMENSION {
        return false;
    }
    (0..G::DIMENSION).all(|k| {
        let found = entries(&G::hat(&G::Vector::axis(k)));
        let mut expected = Vec::new();
        for (factor, (first, size)) in declaration.factors.iter().zip(&own) {
            let generator = k.checked_sub(*first).and_then(|k| factor.generators.get(k));
            expected.extend(generator.cloned().unwrap_or_else(|| vec![0.0; *size]));
        }
        found.len() == expected.len() && found.iter().zip(expected).all(|(&found, expected)| found == real(expected))
    })
}

pub(crate) fn entries<T: Real>(value: &impl Entries<T>) -> Vec<T> {
    let mut list = Vec::new();
    value.each(&mut |entry| list.push(entry));
    list
}

impl<G, W, K, B> Term for Late<G, W, K, B>
where
    G: LieGroup,
    W: Advected<G> + Slots,
    B: Backend<G::Scalar>,
{
    type Scalar = G::Scalar;
    type Group = G;
    type Advected = W;

    fn validate(&self) -> Result<(), SetupError> {
        for (index, parameter) in self.declaration.parameters.iter().enumerate() {
            let (field, value) = (parameter.name.as_str(), self.of_parameter(index));
            if !value.iter().all(is_finite) {
                return Err(SetupError::Parameter { field, cause: "is not finite, or wasn't given" });
            }
            let is_inertia = parameter.kind == ParameterKind::Inertia;
            if is_inertia && (0..9).any(|entry| value[entry] != value[entry % 3 * 3 + entry / 3]) {
                return Err(SetupError::Parameter { field, cause: "is not symmetric" });
            }
        }
        Ok(())
    }

    fn advected(&self) -> W {
        let mut numbers = self.declaration.in_space().flat_map(|(carried, value)| {
            let (rows, columns) = carried.shape;
            let unit = |is_one| real(f64::from(u8::from(is_one)));
            (0..rows * columns).map(move |at| match value {
                InSpace::Parameter(field) => self.of_parameter(field)[at],
                InSpace::Direction(number) => unit(at == number),
                InSpace::Identity => unit(at / rows == at % rows),
            })
        });
        W::from_entries(&mut || numbers.next().unwrap_or_else(|| real(0.0)))
    }
}

impl<G, W, K, B, C> Add<C> for Late<G, W, K, B>
where
    G: LieGroup,
    W: Advected<G> + Slots,
    B: Backend<G::Scalar>,
    C: Term,
    C::Group: SharedBy<G, Self, C>,
{
    type Output = Sum<Self, C>;

    fn add(self, other: C) -> Sum<Self, C> {
        Sum::new(self, other)
    }
}
