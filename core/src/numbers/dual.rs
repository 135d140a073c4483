//! Numbers with their derivatives along three directions, for functions in closed form.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::numbers::scalar::{Mask, Real, real};
use nalgebra::SimdBool;

/// The scalar of a closed form: a real, or one with its derivatives.
///
/// This trait has fewer functions than a [`Real`], whose fifty would each need a derivative, under the same names.
#[hot]
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    type Mask: SimdBool;

    fn number(value: f64) -> Self;
    fn simd_default_epsilon() -> Self;
    fn simd_sqrt(self) -> Self;
    fn simd_abs(self) -> Self;
    fn simd_max(self, other: Self) -> Self;
    fn simd_lt(self, other: Self) -> Self::Mask;
    fn simd_le(self, other: Self) -> Self::Mask;
    fn select(self, mask: Self::Mask, other: Self) -> Self;

    /// Zero in the lanes in which the value is rounding only. The derivative stays.
    fn vanishing(self, mask: Self::Mask) -> Self;

    fn zero() -> Self {
        Self::number(0.0)
    }

    fn one() -> Self {
        Self::number(1.0)
    }

    fn simd_gt(self, other: Self) -> Self::Mask {
        other.simd_lt(self)
    }

    fn simd_ge(self, other: Self) -> Self::Mask {
        other.simd_le(self)
    }
}

#[hot]
impl<T: Real> Number for T {
    type Mask = Mask<T>;

    fn number(value: f64) -> Self {
        real(value)
    }

    fn simd_default_epsilon() -> Self {
        <T as nalgebra::SimdRealField>::simd_default_epsilon()
    }

    fn simd_sqrt(self) -> Self {
        nalgebra::SimdComplexField::simd_sqrt(self)
    }

    fn simd_abs(self) -> Self {
        nalgebra::SimdComplexField::simd_abs(self)
    }

    fn simd_max(self, other: Self) -> Self {
        nalgebra::SimdPartialOrd::simd_max(self, other)
    }

    fn simd_lt(self, other: Self) -> Self::Mask {
        nalgebra::SimdPartialOrd::simd_lt(self, other)
    }

    fn simd_le(self, other: Self) -> Self::Mask {
        nalgebra::SimdPartialOrd::simd_le(self, other)
    }

    fn select(self, mask: Self::Mask, other: Self) -> Self {
        nalgebra::SimdValue::select(self, mask, other)
    }

    fn vanishing(self, mask: Self::Mask) -> Self {
        nalgebra::SimdValue::select(T::zero(), mask, self)
    }
}

/// A number and its derivatives. Comparisons use the value.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dual<T> {
    pub(crate) value: T,
    pub(crate) slopes: [T; 3],
}

#[hot]
impl<T: Real> Dual<T> {
    /// A constant.
    pub(crate) fn constant(value: T) -> Self {
        Self { value, slopes: [T::zero(); 3] }
    }

    /// A variable along one of the directions.
    pub(crate) fn along(value: T, direction: usize) -> Self {
        Self { value, slopes: core::array::from_fn(|k| if k == direction { T::one() } else { T::zero() }) }
    }

    /// The chain rule: a function of the number, from its value and its derivative.
    fn chained(self, value: T, slope: T) -> Self {
        Self { value, slopes: self.slopes.map(|own| own * slope) }
    }

    fn zip(self, other: Self, value: T, slope: impl Fn(T, T) -> T) -> Self {
        Self { value, slopes: core::array::from_fn(|k| slope(self.slopes[k], other.slopes[k])) }
    }
}

operation!([T: Real] Dual<T>, Add add |a, b| a.zip(b, a.value + b.value, |a, b| a + b));
operation!([T: Real] Dual<T>, Sub sub |a, b| a.zip(b, a.value - b.value, |a, b| a - b));
// Clippy suspects the sum in the product rule.
operation!([T: Real] #[allow(clippy::suspicious_arithmetic_impl)] Dual<T>, Mul mul |a, b| {
    a.zip(b, a.value * b.value, |of_a, of_b| of_a * b.value + a.value * of_b)
});
operation!([T: Real] Dual<T>, Div div |a, b| {
    let (inverse, ratio) = (T::one() / b.value, a.value / b.value);
    a.zip(b, ratio, |of_a, of_b| (of_a - ratio * of_b) * inverse)
});

impl<T: Real> Neg for Dual<T> {
    type Output = Self;

    #[hot]
    fn neg(self) -> Self {
        self.chained(-self.value, -T::one())
    }
}

#[hot]
impl<T: Real> Number for Dual<T> {
    type Mask = Mask<T>;

    fn number(value: f64) -> Self {
        Self::constant(real(value))
    }

    fn simd_default_epsilon() -> Self {
        Self::constant(<T as nalgebra::SimdRealField>::simd_default_epsilon())
    }

    fn simd_sqrt(self) -> Self {
        let root = nalgebra::SimdComplexField::simd_sqrt(self.value);
        self.chained(root, real::<T>(0.5) / root)
    }

    fn simd_abs(self) -> Self {
        (-self).select(self.simd_lt(Self::zero()), self)
    }

    fn simd_max(self, other: Self) -> Self {
        other.select(self.simd_lt(other), self)
    }

    fn simd_lt(self, other: Self) -> Self::Mask {
        nalgebra::SimdPartialOrd::simd_lt(self.value, other.value)
    }

    fn simd_le(self, other: Self) -> Self::Mask {
        nalgebra::SimdPartialOrd::simd_le(self.value, other.value)
    }

    fn select(self, mask: Self::Mask, other: Self) -> Self {
        let value = nalgebra::SimdValue::select(self.value, mask, other.value);
        self.zip(other, value, |a, b| nalgebra::SimdValue::select(a, mask, b))
    }

    fn vanishing(self, mask: Self::Mask) -> Self {
        Self { value: nalgebra::SimdValue::select(T::zero(), mask, self.value), slopes: self.slopes }
    }
}

#[cfg(test)]
mod tests {
    use super::{Dual, Number};

    /// A function with every operation, in both branches of those that have two.
    fn function<N: Number>([x, y, z]: [N; 3]) -> N {
        let root = (x * y / z + N::number(0.3)).simd_sqrt();
        let sizes = (x - y).simd_abs() * (y - x).simd_abs() + (y - z).simd_max(x) * (x - z).simd_max(y);
        let chosen = (root * z).select(x.simd_gt(y), -root) + (x / root).select(x.simd_ge(y), z / y);
        chosen * sizes - root * N::number(2.0).vanishing(x.simd_gt(z))
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        const SMALL: f64 = 1e-5;
        for at in [[0.7_f64, 1.9, 1.1], [1.9, 0.7, 1.1], [1.2, 1.3, 0.4]] {
            let found: Dual<f64> = function([0, 1, 2].map(|k| Dual::along(at[k], k)));
            assert!((found.value - function::<f64>(at)).abs() < 1e-15);
            for k in 0..3 {
                let moved = |by: f64| function([0, 1, 2].map(|j| if j == k { at[j] + by } else { at[j] }));
                let slope = (moved(SMALL) - moved(-SMALL)) / (2.0 * SMALL);
                assert!((found.slopes[k] - slope).abs() < 1e-8, "{at:?}, {k}: {}, not {slope}", found.slopes[k]);
            }
        }
    }

    /// A value that is zero but for rounding keeps its derivative.
    #[test]
    fn what_vanishes_keeps_its_derivative() {
        let varied = Dual::along(1e-20_f64, 1).vanishing(true);
        assert_eq!((varied.value, varied.slopes), (0.0, [0.0, 1.0, 0.0]));
    }
}
