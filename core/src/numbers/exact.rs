//! Error-free sums and products: the rounded result and its rounding error.

use crate::numbers::entries::Entries;
use crate::numbers::scalar::{Real, real};
use nalgebra::SimdBool as _;

/// `a + b` rounded and its rounding error, by Knuth's sum, which works for any order of the sizes.
#[hot]
#[must_use]
pub fn two_sum<T: Real>(a: T, b: T) -> (T, T) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// `a + (b + carry)` rounded and its rounding error, place by place.
///
/// Each stage runs over all places, so that one vector instruction acts on many.
#[hot]
pub(crate) fn carried_sum<T: Real, E: Entries<T>>(a: &E, b: &E, carry: &E) -> (E, E) {
    let b = b.zip(carry, &mut |b, carry| b + carry);
    let sum = a.zip(&b, &mut |a, b| a + b);
    let rounded = sum.zip(a, &mut |sum, a| sum - a);
    let lost_of_a = a.zip(&sum.zip(&rounded, &mut |sum, b| sum - b), &mut |a, rest| a - rest);
    let lost_of_b = b.zip(&rounded, &mut |b, rounded| b - rounded);
    (sum, lost_of_a.zip(&lost_of_b, &mut |a, b| a + b))
}

/// `a²` rounded and its rounding error, by Dekker's product.
#[hot]
pub(crate) fn two_square<T: Real>(a: T) -> (T, T) {
    // Dekker's splitting constant, for 53 digits or for 24.
    let single = T::simd_default_epsilon().simd_gt(real(1e-10)).any();
    let split = a * real(if single { 4_097.0 } else { 134_217_729.0 });
    let high = split - (split - a);
    let low = a - high;
    let product = a * a;
    (product, ((high * high - product) + (high * low + high * low)) + low * low)
}

#[cfg(test)]
mod tests {
    use super::{carried_sum, two_square, two_sum};
    use nalgebra::Vector2;

    #[test]
    fn a_square_is_exact_in_two_numbers() {
        // (1 + 2⁻³⁰)² = 1 + 2⁻²⁹ + 2⁻⁶⁰.
        let (product, rest) = two_square(1.0 + 2.0_f64.powi(-30));
        assert_eq!((product, rest), (1.0 + 2.0_f64.powi(-29), 2.0_f64.powi(-60)));
    }

    #[test]
    fn a_sum_is_exact_in_two_numbers() {
        let small = 2.0_f64.powi(-60);
        assert_eq!(two_sum(1.0, small), (1.0, small));
        assert_eq!(two_sum(small, 1.0), (1.0, small));
        let (sum, carry) = carried_sum(&Vector2::new(1.0, small), &Vector2::new(small, 1.0), &Vector2::new(small, 0.0));
        assert_eq!((sum, carry), (Vector2::new(1.0, 1.0), Vector2::new(2.0 * small, small)));
    }
}
