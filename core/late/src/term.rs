//! A declaration with numbers, as a term of a scene.

use std::fmt;
use std::marker::PhantomData;
use std::ops::Add;
use std::sync::Arc;

use liestep::SetupError;
use liestep::groups::{Advected, LieGroup};
use liestep::mechanics::{KineticPart, SharedBy, Sum, Term, WithKinetic};
use liestep::numbers::{Coordinates, Entries, Real, real};
use liestep_derivation::ParameterKind;
use nalgebra::Vector1;

use crate::carried::Slots;
use crate::declaration::{Declaration, LateError};

/// A declaration that was read while the program runs, with numbers for its parameters: an effect on the group `G`, with
/// what is advected or given in `W`, as the macro would have it, and the kinetic part `K`. In a longer tuple what the
/// declaration doesn't name is zero.
///
/// # Source
///
/// As of every [`Effect`]: \[RDAE\], section 2.2.
pub struct Late<G: LieGroup, W = (), K = WithKinetic> {
    pub(crate) declaration: &'static Declaration,
    /// Of all parameters, NaN where none was given.
    pub(crate) numbers: Arc<[G::Scalar]>,
    types: PhantomData<(W, K)>,
}

impl<G: LieGroup, W, K> Clone for Late<G, W, K> {
    fn clone(&self) -> Self {
        Self { declaration: self.declaration, numbers: Arc::clone(&self.numbers), types: PhantomData }
    }
}

impl<G: LieGroup, W, K> fmt::Debug for Late<G, W, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct(self.declaration.name);
        for (index, name) in self.declaration.names.iter().enumerate() {
            shown.field(name, &self.of_parameter(index));
        }
        shown.finish_non_exhaustive()
    }
}

impl<G: LieGroup, W, K> PartialEq for Late<G, W, K> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.declaration, other.declaration) && self.numbers == other.numbers
    }
}

/// In all lanes.
pub(crate) fn is_finite<T: Real>(number: &T) -> bool {
    Coordinates::is_finite(&Vector1::new(*number))
}

impl<G: LieGroup, W: Advected<G> + Slots, K: KineticPart> Late<G, W, K> {
    /// Derives a struct with `#[lagrangian(…)]` or `#[force(…)]`, and proves what was derived. Its parameters have no
    /// values yet.
    ///
    /// # Errors
    ///
    /// The mistakes of the text; or the declaration isn't one on `G`, with `W` and `K`.
    pub fn parse(text: &str) -> Result<Self, LateError> {
        Self::of(Declaration::parse(text)?)
    }

    /// Of a declaration that was derived.
    ///
    /// # Errors
    ///
    /// Where it isn't one on `G`, with `W` and `K`.
    pub fn of(declaration: &'static Declaration) -> Result<Self, LateError> {
        if !has_generators::<G>(declaration) {
            return Err(LateError::Group { declared: declaration.group() });
        }
        let mut slots = Vec::new();
        W::list(&mut slots);
        if !slots.starts_with(&declaration.slots()) {
            return Err(LateError::Advected { declared: format!("{:?}", declaration.slots()) });
        }
        if (K::IS_THERE, K::JACOBIAN_IS_EXPENSIVE) != (declaration.has_kinetic, declaration.is_expensive) {
            return Err(LateError::Kinetic { declared: declaration.kinetic() });
        }
        let numbers = declaration.parameters.iter().map(|parameter| parameter.kind.len()).sum();
        Ok(Self { declaration, numbers: vec![real(f64::NAN); numbers].into(), types: PhantomData })
    }
}

impl<G: LieGroup, W, K> Late<G, W, K> {
    /// With a value for a parameter, that of a matrix row by row. An inertia may be given by its three moments.
    ///
    /// # Errors
    ///
    /// Where there is no such parameter, or where it has another number of numbers.
    pub fn with(mut self, name: &str, value: &[G::Scalar]) -> Result<Self, LateError> {
        let names = &self.declaration.names;
        let Some(index) = names.iter().position(|known| *known == name) else {
            let known = names.join(", ");
            return Err(LateError::Unknown { name: name.to_owned(), known });
        };
        let (start, expected) = self.declaration.place(index);
        let kind = self.declaration.parameters[index].kind;
        let mut numbers = self.numbers.to_vec();
        let place = &mut numbers[start..start + expected];
        if kind == ParameterKind::Inertia && value.len() == 3 {
            let on_diagonal =
                |entry: usize| if entry.is_multiple_of(4) { value[entry / 4] } else { real::<G::Scalar>(0.0) };
            place.iter_mut().enumerate().for_each(|(entry, number)| *number = on_diagonal(entry));
        } else if value.len() == expected {
            place.copy_from_slice(value);
        } else {
            return Err(LateError::Size { name: names[index], expected, found: value.len() });
        }
        self.numbers = numbers.into();
        Ok(self)
    }

    /// What was derived.
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
        own.extend(std::iter::repeat_n(own_entries(factor), 1).map(|entries| (component, entries)));
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

fn own_entries(factor: &liestep_derivation::Factor) -> usize {
    factor.generators.first().map_or(0, Vec::len)
}

fn entries<T: Real>(value: &impl Entries<T>) -> Vec<T> {
    let mut list = Vec::new();
    value.each(&mut |entry| list.push(entry));
    list
}

impl<G, W, K> Term for Late<G, W, K>
where
    G: LieGroup,
    W: Advected<G> + Slots,
{
    type Scalar = G::Scalar;
    type Group = G;
    type Advected = W;

    fn validate(&self) -> Result<(), SetupError> {
        for (index, &field) in self.declaration.names.iter().enumerate() {
            let value = self.of_parameter(index);
            if !value.iter().all(is_finite) {
                return Err(SetupError::Parameter { field, cause: "is not finite, or wasn't given" });
            }
            let is_inertia = self.declaration.parameters[index].kind == ParameterKind::Inertia;
            if is_inertia && (0..9).any(|entry| value[entry] != value[entry % 3 * 3 + entry / 3]) {
                return Err(SetupError::Parameter { field, cause: "is not symmetric" });
            }
        }
        Ok(())
    }

    fn advected(&self) -> W {
        let of_carried = self.declaration.carried.iter().flat_map(|carried| {
            let Some(field) = carried.field else {
                // A configuration is the identity in space.
                let rows = carried.shape.0;
                return (0..rows * rows).map(|at| real(f64::from(u8::from(at / rows == at % rows)))).collect();
            };
            self.of_parameter(field).to_vec()
        });
        let mut numbers = of_carried.collect::<Vec<_>>().into_iter();
        W::from_entries(&mut || numbers.next().unwrap_or_else(|| real(0.0)))
    }
}

impl<G, W, K, C> Add<C> for Late<G, W, K>
where
    G: LieGroup,
    W: Advected<G> + Slots,
    C: Term,
    C::Group: SharedBy<G, Self, C>,
{
    type Output = Sum<Self, C>;

    fn add(self, other: C) -> Sum<Self, C> {
        Sum::new(self, other)
    }
}
