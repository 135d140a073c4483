//! One rotation about a body axis by an angle in proportion to the momentum about it, and how many there are.

use crate::groups::rotation_coefficients;
use crate::numbers::{Numbers, Real, real};

/// Shares of the first and the second axis by turns, from the first to the middle one. \[FR90\]
pub(super) const SEVEN: [f64; 5] =
    [0.675_603_595_979_828_8, 1.351_207_191_959_657_6, -0.175_603_595_979_828_8, -1.702_414_383_919_315_3, 0.0];

/// Likewise. Of order 4, and of order 6 in the term of the first axis: its shares `b` at the times `c` that those of
/// the second, `a`, add up to have `Σ b c² = 1/3` and `Σ b c⁴ = 1/5`; with `Σ a d² = 1/3`, where `d` are the sums of
/// the `b` before each, these are three conditions for three unknowns, and solved. The kind is that of \[ML95\].
pub(super) const NINE: [f64; 5] = [
    0.095_364_558_526_317_94,
    0.627_486_550_465_928_5,
    1.096_765_141_814_988_4,
    -0.127_486_550_465_928_5,
    -1.384_259_400_682_612_7,
];

/// Squares of half an angle up to here lose less than a rounding where the polynomials end: `q⁶/12!` is 1e-16.
const REACH: f64 = 0.06;

/// Rates beyond this have powers that a single hasn't.
const LARGEST_RATE: f64 = 1e3;

/// A rotation by `2 κ p`.
#[derive(Clone, Copy, Debug, Lanes)]
pub(super) struct Rotor<T> {
    /// `κ`.
    rate: T,
    /// Of `sin(κ p)/p` and `cos(κ p)`, in powers of `p²`: that `κ` is in them is a product less to wait for.
    sine: Numbers<T, 6>,
    cosine: Numbers<T, 6>,
}

impl<T: Real> Rotor<T> {
    pub(super) fn new(rate: T) -> Self {
        let mut rotor = Self { rate, sine: Numbers([rate; 6]), cosine: Numbers([T::one(); 6]) };
        let (square, mut n) = (rate * rate, 1.0);
        for k in 1..6 {
            rotor.cosine.0[k] = rotor.cosine.0[k - 1] * square * real(-1.0 / (n * (n + 1.0)));
            rotor.sine.0[k] = rotor.sine.0[k - 1] * square * real(-1.0 / ((n + 1.0) * (n + 2.0)));
            n += 2.0;
        }
        rotor
    }

    /// The largest `p²` that [`near`](Self::near) is for, none being less than zero.
    pub(super) fn reach(&self) -> T {
        let square = self.rate * self.rate;
        (real::<T>(REACH) / square).select(square.simd_le(real(LARGEST_RATE * LARGEST_RATE)), real(-1.0))
    }

    /// `sin(κ p)/p` and `cos(κ p)` of `p²`. Pairs don't wait for each other.
    #[hot]
    pub(super) fn near(&self, q: T) -> (T, T) {
        let q2 = q * q;
        let q4 = q2 * q2;
        let polynomial = |a: &[T; 6]| (a[0] + q * a[1]) + (q2 * (a[2] + q * a[3]) + q4 * (a[4] + q * a[5]));
        (polynomial(&self.sine.0), polynomial(&self.cosine.0))
    }

    /// The same for any angle.
    #[hot]
    pub(super) fn anywhere(&self, q: T) -> (T, T) {
        let square = self.rate * self.rate * q;
        let (sinc, versine) = rotation_coefficients(square);
        (self.rate * sinc, T::one() - square * versine)
    }
}

#[cfg(test)]
mod tests {
    use super::{NINE, REACH, Rotor, SEVEN};
    use alloc::vec::Vec;

    /// All shares of each axis, in order, of a palindrome given to its middle.
    fn apart(half: &[f64]) -> [Vec<f64>; 2] {
        let all: Vec<_> = half.iter().chain(half.iter().rev().skip(1)).copied().collect();
        [0, 1].map(|axis| all.iter().skip(axis).step_by(2).copied().collect())
    }

    /// `Σ b c^n`, the `c` being the sums of the `a` before, of which there are so many more as `b` come first.
    fn moment(b: &[f64], a: &[f64], before_first: usize, power: i32) -> f64 {
        let at = |k: usize| a[..k + before_first].iter().sum::<f64>();
        b.iter().enumerate().map(|(k, b)| b * at(k).powi(power)).sum()
    }

    fn assert_near(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-15, "{found} instead of {expected}");
    }

    #[test]
    fn both_are_of_order_4() {
        for half in [&SEVEN[..4], &NINE[..]] {
            let [first, second] = apart(half);
            assert_near(first.iter().sum(), 1.0);
            assert_near(second.iter().sum(), 1.0);
            assert_near(moment(&first, &second, 0, 2), 1.0 / 3.0);
            assert_near(moment(&second, &first, 1, 2), 1.0 / 3.0);
        }
    }

    #[test]
    fn nine_are_of_order_6_in_the_first() {
        let [first, second] = apart(&NINE);
        assert_near(moment(&first, &second, 0, 4), 0.2);
    }

    /// Up to the largest argument, and by the other way beyond.
    #[test]
    fn they_are_sine_and_cosine() {
        for rate in [-0.3, 1.7, 40.0] {
            let rotor = Rotor::new(rate);
            let largest: f64 = REACH / (rate * rate);
            assert_near(rotor.reach(), largest);
            for part in [0.0, 0.01, 0.4, 1.0, 1.001, 50.0, 1e4] {
                let q = part * largest;
                let p = q.sqrt();
                let (s, c) = (rate * p).sin_cos();
                let found = if part > 1.0 { rotor.anywhere(q) } else { rotor.near(q) };
                // A rounding of the angle is in proportion to it.
                let allowed = 1e-15 * (1.0 + (rate * p).abs());
                let missed = (found.0 * p - s).abs().max((found.1 - c).abs());
                assert!(missed < allowed, "{rate}, {part}: {missed:e}");
            }
        }
    }

    #[test]
    fn rates_without_powers_have_no_polynomials() {
        assert!(Rotor::new(2e4_f32).reach() < 0.0);
        assert!(Rotor::new(9e2_f32).near(0.06 / 8.1e5).0.is_finite());
        assert!(Rotor::new(0.0_f64).reach() > f64::MAX);
    }
}
