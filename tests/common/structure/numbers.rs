//! Advected parameters as columns of numbers, and in other scalars.

use liestep::numbers::Entries;
use nalgebra::{DVector, RealField};

/// The value converted to another scalar.
pub fn lifted<T: RealField + Copy, A: Entries<f64>, B: Entries<T>>(a: &A) -> B {
    let entries = numbers(a);
    let mut entries = entries.iter();
    B::from_entries(&mut || nalgebra::convert(*entries.next().expect("as many")))
}

/// The value `a + ε b`, for a unit `ε` of another scalar.
pub fn varied<T: RealField + Copy, A: Entries<f64>, B: Entries<T>>(a: &A, b: &A, unit: T) -> B {
    let (a, b): (B, B) = (lifted(a), lifted(b));
    a.zip(&b, &mut |a, b| a + b * unit)
}

/// The numbers of a value in a column.
pub fn numbers(of: &impl Entries<f64>) -> DVector<f64> {
    let mut numbers = Vec::new();
    of.each(&mut |number| numbers.push(number));
    DVector::from_vec(numbers)
}

/// The value with these numbers.
pub fn from_numbers<A: Entries<f64>>(numbers: impl IntoIterator<Item = f64>) -> A {
    let mut numbers = numbers.into_iter();
    let value = A::from_entries(&mut || numbers.next().expect("too few numbers"));
    assert!(numbers.next().is_none(), "numbers are left");
    value
}
