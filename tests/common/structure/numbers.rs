//! Advected parameters as columns of numbers, and in other scalars.

use liestep::groups::{ContravariantTensor, ContravariantVector, CovariantTensor, MixedTensor};
use liestep::numbers::Entries;
use nalgebra::{Point, RealField, SMatrix, SVector};

/// The same numbers in another scalar.
pub fn lifted<T: RealField + Copy, A: Entries<f64>, B: Entries<T>>(a: &A) -> B {
    let mut entries = Vec::new();
    a.each(&mut |entry| entries.push(entry));
    let mut entries = entries.into_iter();
    B::from_entries(&mut || nalgebra::convert(entries.next().expect("as many")))
}

/// `a + ε b`, for a unit `ε` of another scalar.
pub fn varied<T: RealField + Copy, A: Entries<f64>, B: Entries<T>>(a: &A, b: &A, unit: T) -> B {
    let (a, b): (B, B) = (lifted(a), lifted(b));
    a.zip(&b, &mut |a, b| a + b * unit)
}

/// What can be taken apart into numbers and put together again: the parameters of one kind, none, or several.
pub trait Numbers: Copy {
    /// Appends the numbers.
    fn append(&self, numbers: &mut Vec<f64>);

    /// Takes as many numbers as are needed.
    fn take(numbers: &mut dyn Iterator<Item = f64>) -> Self;

    fn numbers(&self) -> Vec<f64> {
        let mut numbers = Vec::new();
        self.append(&mut numbers);
        numbers
    }

    fn from_numbers(numbers: impl IntoIterator<Item = f64>) -> Self {
        let mut numbers = numbers.into_iter();
        let value = Self::take(&mut numbers);
        assert!(numbers.next().is_none(), "numbers are left");
        value
    }
}

impl Numbers for () {
    fn append(&self, _: &mut Vec<f64>) {}

    fn take(_: &mut dyn Iterator<Item = f64>) -> Self {}
}

impl<const N: usize> Numbers for SVector<f64, N> {
    fn append(&self, numbers: &mut Vec<f64>) {
        numbers.extend(self.iter());
    }

    fn take(numbers: &mut dyn Iterator<Item = f64>) -> Self {
        Self::from_fn(|_, _| numbers.next().expect("too few numbers"))
    }
}

impl<const N: usize> Numbers for Point<f64, N> {
    fn append(&self, numbers: &mut Vec<f64>) {
        self.coords.append(numbers);
    }

    fn take(numbers: &mut dyn Iterator<Item = f64>) -> Self {
        Self::from(SVector::take(numbers))
    }
}

macro_rules! kind {
    ($($kind:ident: $inner:ty),+ $(,)?) => {$(
        impl<const N: usize> Numbers for $kind<f64, N> {
            fn append(&self, numbers: &mut Vec<f64>) {
                numbers.extend(self.0.iter());
            }

            fn take(numbers: &mut dyn Iterator<Item = f64>) -> Self {
                Self(<$inner>::from_fn(|_, _| numbers.next().expect("too few numbers")))
            }
        }
    )+};
}

kind!(
    ContravariantVector: SVector<f64, N>,
    ContravariantTensor: SMatrix<f64, N, N>,
    CovariantTensor: SMatrix<f64, N, N>,
    MixedTensor: SMatrix<f64, N, N>,
);

macro_rules! tuple {
    ($($name:ident $index:tt),+) => {
        impl<$($name: Numbers),+> Numbers for ($($name,)+) {
            fn append(&self, numbers: &mut Vec<f64>) {
                $(self.$index.append(numbers);)+
            }

            fn take(numbers: &mut dyn Iterator<Item = f64>) -> Self {
                ($($name::take(numbers),)+)
            }
        }
    };
}

tuple!(A 0, B 1);
tuple!(A 0, B 1, C 2);
tuple!(A 0, B 1, C 2, D 3, E 4);
