//! The elliptic functions of a free body over a short time, as polynomials.

use crate::numbers::Number;

/// The invariants of a motion, in units of half the drift: `K_b`, `K_a` and `ν` aren't negative, and all vanish with
/// the drift.
#[derive(Clone, Copy, Debug)]
pub(super) struct Invariants<T> {
    pub(super) kb: T,
    pub(super) ka: T,
    /// The difference `K_b − K_a`.
    pub(super) apart: T,
    /// The pole `ν = −AB |u|²` of the integrand, which lies between the two.
    pub(super) pole: T,
}

#[hot]
impl<T: Number> Invariants<T> {
    /// The measure of the drift's length that selects the polynomials.
    pub(super) fn size(&self) -> T {
        self.kb.simd_max(self.ka)
    }

    /// The variables of the polynomials.
    pub(super) fn start(&self) -> Start<T> {
        let Self { kb, ka, apart, pole } = *self;
        let (k, sum) = (T::number, kb + ka);
        let x = (apart * apart + kb * ka) * k(1.0 / 15.0);
        // Three times K_b − e and K_a − e.
        let y = (sum * k(-1.0 / 189.0)) * ((kb + apart) * (ka - apart));
        let e = sum * k(1.0 / 3.0);
        Start { e, x, y, c: e - pole }
    }

    /// The invariants for another duration, by the square of the ratio.
    pub(super) fn scaled(&self, part: T) -> Self {
        Self { kb: self.kb * part, ka: self.ka * part, apart: self.apart * part, pole: self.pole * part }
    }
}

/// The functions `n`, `μ` and the integral at half the drift.
#[derive(Clone, Copy, Debug)]
pub(super) struct Functions<T> {
    pub(super) n: T,
    pub(super) mu: T,
    pub(super) integral: T,
}

/// The size up to which the polynomials of [`short`] are exact to a rounding.
///
/// The truncation error is the largest for a symmetric body's spin, where `n = K/sin² √K` and the next coefficient of
/// `μ` is `220 K⁶/π¹²`, and where the integral is that of `tan² √K/K`, with `10 (4/π²)⁶ K⁶ · K/15`: both are below
/// 10⁻¹⁶.
pub(super) const SHORT: f64 = 0.0075;

/// The size up to which the polynomials of [`long`] are exact, whose next terms are `38 · 18 K¹⁰/π²⁰` and
/// `13 (4/π²)⁹ K⁹ · K/21`.
pub(super) const LONG: f64 = 0.05;

/// The polynomials with `℘` to its fifth coefficient and the integral to its fifth, without terms that together are
/// below half a rounding of the angle.
#[hot]
pub(super) fn short<T: Number>(start: &Start<T>) -> Functions<T> {
    let k = T::number;
    let Start { e, x, y, c } = *start;
    let (xx, cc, w5) = (x * x, c * c, x * y * k(3.0 / 11.0));
    let n = ((T::one() + e) + (x + y)) + (xx * k(1.0 / 3.0) + w5);
    let mu = (T::one() - (x + (y + y))) - (xx + w5 * k(4.0));
    let of_0 = (k(2.0 / 33.0) * xx - (k(1.0 / 7.0) * x + k(1.0 / 9.0) * y)) + k(1.0 / 3.0);
    let of_1 = (k(2.0 / 9.0) * x - k(0.2)) + k(2.0 / 11.0) * y;
    let of_2 = k(1.0 / 7.0) - k(3.0 / 11.0) * x;
    let integral = (of_0 + of_1 * c) + cc * ((of_2 - k(1.0 / 9.0) * c) + k(1.0 / 11.0) * cc);
    Functions { n, mu: mu + mu, integral }
}

/// The polynomials with `℘` to its ninth coefficient and the integral to its eighth, with the same omissions.
#[hot]
pub(super) fn long<T: Number>(start: &Start<T>) -> Functions<T> {
    let k = T::number;
    let Start { e, x, y, c } = *start;
    let (xx, yy, xy) = (x * x, y * y, x * y);
    let (w4, w5) = (xx * k(1.0 / 3.0), xy * k(3.0 / 11.0));
    let (w6, w7) = (x * xx * k(2.0 / 39.0) + yy * k(1.0 / 13.0), x * xy * k(2.0 / 33.0));
    let w8 = xx * xx * k(5.0 / 663.0) + y * xy * k(60.0 / 2431.0);
    let w9 = y * (xx * x * k(29.0 / 2717.0) + yy * k(1.0 / 247.0));
    let n = ((T::one() + e) + (x + y)) + ((w4 + w5) + ((w6 + w7) + (w8 + w9)));
    let far = (w6 * k(5.0) + w7 * k(6.0)) + (w8 * k(7.0) + w9 * k(8.0));
    let mu = (T::one() - (x + (y + y))) - ((w4 * k(3.0) + w5 * k(4.0)) + far);
    let (cc, xxx) = (c * c, xx * x);
    let of_0 = (k(-1.0 / 7.0) * x - k(1.0 / 9.0) * y)
        + (k(2.0 / 33.0) * xx + k(19.0 / 143.0) * xy)
        + ((k(4.0 / 65.0) * yy - k(1.0 / 39.0) * xxx) - k(61.0 / 561.0) * (x * xy));
    let of_1 = (k(2.0 / 9.0) * x - k(0.2))
        + (k(2.0 / 11.0) * y - k(7.0 / 39.0) * xx)
        + ((k(82.0 / 663.0) * xxx - k(37.0 / 221.0) * yy) - k(4.0 / 11.0) * xy);
    let of_2 = (k(1.0 / 7.0) - (k(3.0 / 11.0) * x + k(3.0 / 13.0) * y))
        + (k(1.0 / 3.0) * xx + k(123.0 / 187.0) * xy - k(80.0 / 247.0) * xxx);
    let of_3 = (k(4.0 / 13.0) * x - k(1.0 / 9.0)) + (k(4.0 / 15.0) * y - (k(26.0 / 51.0) * xx + k(208.0 / 209.0) * xy));
    let of_4 = k(1.0 / 11.0) - (k(1.0 / 3.0) * x + (k(5.0 / 17.0) * y - k(40.0 / 57.0) * xx));
    let of_5 = k(6.0 / 17.0) * x - (k(1.0 / 13.0) - k(6.0 / 19.0) * y);
    let of_6 = k(1.0 / 15.0) - k(7.0 / 19.0) * x;
    let of_7 = k(1.0 / 19.0) * c - k(1.0 / 17.0);
    let near = (of_0 + of_1 * c) + cc * (of_2 + of_3 * c);
    let integral = near + (cc * cc) * ((of_4 + of_5 * c) + cc * (of_6 + of_7 * c));
    Functions { n, mu: mu + mu, integral: integral + k(1.0 / 3.0) }
}

/// The variables of the polynomials: the mean `e` of the three roots, the first coefficients `x` and `y` of `℘`, and
/// `c` of the integral.
#[derive(Clone, Copy)]
pub(super) struct Start<T> {
    pub(super) e: T,
    pub(super) x: T,
    pub(super) y: T,
    pub(super) c: T,
}
