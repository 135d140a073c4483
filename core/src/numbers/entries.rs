//! The scalars of a state, visited in order: used by compensated sums, checkpoints and samples of the laws.

use alloc::vec::Vec;

use nalgebra::SMatrix;

use crate::numbers::scalar::{Real, count, counted};

/// A fixed number of scalars in a fixed order.
pub trait Entries<T>: Copy {
    /// The value from the next scalars of a stream, in the order in which [`each`](Self::each) visits them.
    fn from_entries(next: &mut impl FnMut() -> T) -> Self;

    /// Visits the scalars.
    fn each(&self, visit: &mut impl FnMut(T));

    /// The scalars as a slice, if they lie in this order in memory.
    #[hot]
    fn in_place(&self) -> Option<&[T]> {
        None
    }

    /// Combines the scalars at the same places.
    #[must_use]
    fn zip(&self, other: &Self, combine: &mut impl FnMut(T, T) -> T) -> Self;
}

/// Entries of a matrix, row by row.
#[hot]
impl<T: Real, const R: usize, const C: usize> Entries<T> for SMatrix<T, R, C> {
    fn from_entries(next: &mut impl FnMut() -> T) -> Self {
        // nalgebra fills a matrix column by column.
        SMatrix::<T, C, R>::from_fn(|_, _| next()).transpose()
    }

    fn each(&self, visit: &mut impl FnMut(T)) {
        for row in 0..R {
            for column in 0..C {
                visit(self[(row, column)]);
            }
        }
    }

    fn in_place(&self) -> Option<&[T]> {
        (C == 1).then(|| self.as_slice())
    }

    fn zip(&self, other: &Self, combine: &mut impl FnMut(T, T) -> T) -> Self {
        if T::LANES == 1 {
            return self.zip_map(other, combine);
        }
        // The compiler doesn't inline `zip_map` for lanes, and code that isn't inlined can't use the machine's vector
        // instructions.
        let mut combined = *self;
        for column in 0..C {
            for row in 0..R {
                combined[(row, column)] = combine(self[(row, column)], other[(row, column)]);
            }
        }
        combined
    }
}

macro_rules! tuple {
    ($($name:ident $index:tt),*) => {
        #[allow(clippy::unused_unit, unused_variables)] // in the impl of the empty tuple
        #[hot]
        impl<S, $($name: Entries<S>),*> Entries<S> for ($($name,)*) {
            fn from_entries(next: &mut impl FnMut() -> S) -> Self {
                ($($name::from_entries(next),)*)
            }

            fn each(&self, visit: &mut impl FnMut(S)) {
                $(self.$index.each(visit);)*
            }

            fn zip(&self, other: &Self, combine: &mut impl FnMut(S, S) -> S) -> Self {
                ($(self.$index.zip(&other.$index, combine),)*)
            }
        }
    };
}

/// Calls a macro for the tuples of no part and of two to six, with the name and the index of each part.
macro_rules! of_tuples {
    ($tuple:ident) => {
        $tuple!();
        $tuple!(A 0, B 1);
        $tuple!(A 0, B 1, C 2);
        $tuple!(A 0, B 1, C 2, D 3);
        $tuple!(A 0, B 1, C 2, D 3, E 4);
        $tuple!(A 0, B 1, C 2, D 3, E 4, F 5);
    };
}

pub(crate) use of_tuples;

of_tuples!(tuple);

/// Implements `Entries` for a wrapper of one value; the scalar is `S`.
macro_rules! entries_of_value {
    ([$($parameters:tt)*] $type:ty $(, $marker:expr)?) => {
        #[hot]
        impl<S: $crate::numbers::Real, $($parameters)*> $crate::numbers::Entries<S> for $type {
            fn from_entries(next: &mut impl FnMut() -> S) -> Self {
                Self($crate::numbers::Entries::from_entries(next) $(, $marker)?)
            }

            fn each(&self, visit: &mut impl FnMut(S)) {
                $crate::numbers::Entries::each(&self.0, visit);
            }

            fn zip(&self, other: &Self, combine: &mut impl FnMut(S, S) -> S) -> Self {
                Self($crate::numbers::Entries::zip(&self.0, &other.0, combine) $(, $marker)?)
            }
        }
    };
}

pub(crate) use entries_of_value;

/// A copy of a value with other scalars: `scalar` maps each of them, in the order of [`each`](Entries::each).
pub(crate) fn replaced<T: Real, E: Entries<T>>(entries: &E, scalar: &mut dyn FnMut(T) -> T) -> E {
    let mut others = Vec::new();
    entries.each(&mut |entry| others.push(scalar(entry)));
    let mut others = others.into_iter();
    E::from_entries(&mut || others.next().unwrap_or_else(T::zero))
}

/// A flag stored as zero or one; `None` if the number in its place is neither.
pub(crate) fn flag<T: Real>(is_set: bool, number: &mut dyn FnMut(T) -> T) -> Option<bool> {
    counted(number(count(usize::from(is_set)))).filter(|&flag| flag <= 1).map(|flag| flag == 1)
}

/// The sum `a + b`, place by place.
#[hot]
pub(crate) fn sum<T: Real, E: Entries<T>>(a: &E, b: &E) -> E {
    a.zip(b, &mut |a, b| a + b)
}

/// The value with all scalars zero.
pub(crate) fn zero<T: Real, E: Entries<T>>() -> E {
    E::from_entries(&mut T::zero)
}
