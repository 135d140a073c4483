//! Drifts of any length: the functions over a short part of the drift, doubled repeatedly.
//!
//! Let `s = 1/√n`, `c = √(1 − K_b s²)` and `d = √(1 − K_a s²)`, with signs that change as those of sine and cosine do.
//! Then
//!
//! ```text
//! Q = 1 − K_a K_b s⁴      s⁺ = 2 s c d/Q      c⁺ = (c² − K_b s² d²)/Q      d⁺ = (d² − K_a s² c²)/Q
//! ```
//!
//! are the values at twice the time, and `N`, `C`, `D` and `μ` at half of it are multiples of them. The turn about the
//! momentum is twice that at half the time, followed by one from the tangent to the curve at the point,
//!
//! ```text
//! (1 − K_a K_b s⁴ − ν s² (3 − 2 (K_a + K_b) s² + K_a K_b s⁴),  2 AB (A a² + B b²) s³ c d u)        ν = −AB |u|²
//! ```
//!
//! a quaternion of any length. It is evaluated with `K_a − ν = B (A a² + B b²)` and `K_b − ν = A (A a² + B b²)`, so
//! that nothing cancels near the middle axis, where all are small.

use nalgebra::SimdBool as _;

use super::super::quaternion::Quaternion;
use super::series::{Functions, Invariants, LONG, long};
use super::{About, Form};
use crate::numbers::Number;

/// The limit suffices for every angle that has a significant digit.
const MOST_DOUBLINGS: u32 = 60;

/// The values of the functions at a time; `s` is in units of half the drift.
#[derive(Clone, Copy, Debug)]
struct Point<T> {
    s: T,
    c: T,
    d: T,
}

/// The constants of the doubling formulas.
struct Curve<T: Number> {
    a: T,
    b: T,
    ka: T,
    kb: T,
    /// The sum `A a² + B b²`, set to zero where it is less than the clamping limit.
    h: T,
    /// The product `AB (A a² + B b²)`.
    bend: T,
    /// The square `|u|²`.
    square: T,
    /// The mask of `K_a ≥ K_b`, for which `c` can't be less than zero.
    c_is_larger: T::Mask,
    /// The mask of the separatrix, where `c = d`, and both tend to zero.
    is_separatrix: T::Mask,
}

impl<T: Number> Form<T> {
    /// The drift, from the functions over a part that is short enough, by as many doublings as it takes.
    pub(super) fn doubled(&self, u: [T; 3], invariants: &Invariants<T>) -> Quaternion<T> {
        let (one, half, quarter) = (T::one(), T::number(0.5), T::number(0.25));
        let (size, [a, b, c]) = (invariants.size(), u);
        // The ratio of the part's duration to the drift's, and its square; lanes that are short enough aren't halved
        // further.
        let (mut root, mut part, mut doublings) = (half, quarter, 1);
        while doublings < MOST_DOUBLINGS && (size * part).simd_gt(T::number(LONG)).any() {
            let is_far = (size * part).simd_gt(T::number(LONG));
            (root, part) = ((root * half).select(is_far, root), (part * quarter).select(is_far, part));
            doublings += 1;
        }
        // An angle without a significant digit is NaN.
        let epsilon = T::simd_default_epsilon();
        let part = part.select((size * epsilon * epsilon).simd_lt(one), T::number(f64::NAN));
        let reduced = invariants.scaled(part);
        let Functions { n, integral, .. } = long(&reduced.start());
        let square = one / n;
        let [of_c, of_d] = [reduced.kb, reduced.ka].map(|k| (one - k * square).simd_sqrt());
        let mut point = Point { s: root * square.simd_sqrt(), c: of_c, d: of_d };
        let mut about = About { w: one, f: T::zero() };
        let curve = self.curve(u, invariants);
        let mut reached = part;
        for _ in 0..doublings {
            let is_behind = reached.simd_lt(one);
            about = curve.turned_on(&about, &point).select(is_behind, &about);
            point = curve.doubled(&point).select(is_behind, &point);
            reached = (reached * T::number(4.0)).select(is_behind, reached);
        }
        let end = curve.doubled(&point);
        let (ss, sc, sd, cd) = (end.s * end.s, end.s * end.c, end.s * end.d, end.c * end.d);
        // 1 + AB c² s², as a sum of two terms of one sign.
        let of_c = end.c * end.c + self.a_squared * (a * a) * ss;
        let of_d = end.d * end.d + self.b_squared * (b * b) * ss;
        let den = of_c.select(curve.c_is_larger, of_d);
        let a_end = (a * end.d - self.b * (b * c) * sc) / den;
        let b_end = (b * end.c + self.a * (a * c) * sd) / den;
        let c_end = (c * cd + self.b_less_a * (a * b) * end.s) / den;
        let Point { s, c: of_c, d: of_d } = point;
        let real_part =
            (one + self.c_squared * (c * c_end) * (s * s)) * (of_c * of_d * T::number(2.0)) / curve.base(&point);
        let across = [real_part, s * self.a * (a + a_end), s * self.b * (b + b_end)];
        let longer = one + curve.bend * part * integral;
        let turn = About::turn(curve.square * (longer * longer));
        let turn = About { f: turn.f * longer, ..turn };
        turn.and(&about, curve.square).by(u, across)
    }

    fn curve(&self, u: [T; 3], invariants: &Invariants<T>) -> Curve<T> {
        let [a, b, c] = u;
        let Invariants { ka, kb, .. } = *invariants;
        let h = self.difference(u);
        let is_separatrix = (h * self.b_less_a).simd_abs().simd_le(invariants.size() * least::<T>() * least());
        let h = h.vanishing(is_separatrix);
        let (bend, square) = (-(self.c_squared * h), a * a + (b * b + c * c));
        Curve { a: self.a, b: self.b, ka, kb, h, bend, square, c_is_larger: kb.simd_le(ka), is_separatrix }
    }
}

/// The lower limit of `c` and `d` on the separatrix, where they tend to zero and their ratio doesn't: a squared
/// rounding error, whose square is representable in single precision, too.
fn least<T: Number>() -> T {
    T::simd_default_epsilon() * T::simd_default_epsilon()
}

impl<T: Number> Curve<T> {
    /// The denominator `1 − K_a K_b s⁴`.
    fn base(&self, Point { s, c, d }: &Point<T>) -> T {
        let (ss, cc, dd) = (*s * *s, *c * *c, *d * *d);
        (cc + self.kb * ss * dd).select(self.c_is_larger, dd + self.ka * ss * cc)
    }

    fn doubled(&self, point: &Point<T>) -> Point<T> {
        let (Point { s, c, d }, base) = (*point, self.base(point));
        // c² − K_b s² d² = c² d² + (K_a − K_b) s²; for d the sign of the second term is the opposite.
        let (both, apart) = ((c * d) * (c * d), (self.b - self.a) * self.h * (s * s));
        let (of_c, of_d) = ((both + apart) / base, (both - apart) / base);
        let clamped = |x: T, is_clamped: T::Mask| x.simd_max(least()).select(is_clamped, x);
        let is_on = self.is_separatrix;
        Point {
            s: (s + s) * (c * d) / base,
            c: clamped(of_c, self.c_is_larger | is_on),
            d: clamped(of_d, !self.c_is_larger | is_on),
        }
    }

    /// Twice the rotation, followed by that of the tangent.
    fn turned_on(&self, about: &About<T>, point: &Point<T>) -> About<T> {
        let (Point { s, c, d }, square) = (*point, self.square);
        let (ss, cc, dd) = (s * s, c * c, d * d);
        // 1 − ν s², as a sum of two terms of one sign.
        let (of_a, of_b) = (self.a * self.h, self.b * self.h);
        let from_pole = (cc + of_a * ss).select(of_a.simd_ge(T::zero()), dd + of_b * ss);
        let tangent = About {
            w: cc * dd * from_pole + ss * (of_b * cc + of_a * dd),
            f: (self.bend + self.bend) * (ss * s) * (c * d),
        };
        let next = about.and(about, square).and(&tangent, square);
        let length = (next.w * next.w + next.f * next.f * square).simd_sqrt();
        // If both vanish, the body stays at its middle axis.
        let next = About { w: next.w / length, f: next.f / length };
        next.select(length.simd_gt(T::zero()), &About { w: T::one(), f: T::zero() })
    }
}

impl<T: Number> Point<T> {
    fn select(&self, mask: T::Mask, other: &Self) -> Self {
        let Self { s, c, d } = *self;
        Self { s: s.select(mask, other.s), c: c.select(mask, other.c), d: d.select(mask, other.d) }
    }
}
