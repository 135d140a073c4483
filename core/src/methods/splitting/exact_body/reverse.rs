//! The derivative of a drift in the polynomials' range, along one covector, in reverse mode.
//!
//! An adjoint needs only `c · ε` of the turn `ε` of the increment, `δF = ε̂ F`, but its derivatives with respect to
//! momentum and moments at once. Each line of the closed form is differentiated in reverse, from the last to the first;
//! only the functions have forward slopes. Let `F = exp(2v̂) F_a`, with `v = (1 + I) u` and the quaternion `Q` of
//! `F_a`:
//!
//! ```text
//! c · ε = c · dexp(2v̂) 2δv + 2 ⟨g Q, δQ⟩/|Q|²        g = exp(−2v̂) c        dexp(x̂) = I + c₂(|x|²) x̂ + c₃(|x|²) x̂²
//! ```
//!
//! The functions of the half angle suffice, as `2 c₂(4q)` is the square of `sin √q/√q` and
//! `4 c₃(4q) = c₂(q) + c₃(q) cos √q`. In this file `by_x` is the derivative of `c · ε` with respect to `x`.

use nalgebra::{SimdBool as _, Vector3};

use super::Form;
use super::series::{Functions, Invariants, LONG, SHORT, Start, long, short};
use crate::groups::rotation_coefficients;
use crate::groups::rotation_functions::stumpff;
use crate::numbers::{Dual, Real, real};

/// The derivatives with respect to `u`; to `A`, `B`, `B − A` and `−AB`; and to `K_b`, `K_a`, `n` and `μ`.
type By<T> = ([T; 3], [T; 4], [T; 4]);

#[hot]
fn twice<T: Real>(x: T) -> T {
    x + x
}

#[hot]
impl<T: Real> Form<T> {
    /// The derivatives of `c · ε` with respect to `u`, and to `A` and `B`; `None` if the drift is too long for the
    /// polynomials, or if lanes need different polynomials.
    pub(super) fn reversed(&self, u: [T; 3], c: [T; 3]) -> Option<([T; 3], [T; 2])> {
        let invariants = self.invariants(u);
        let (Start { e, x, y, c: pole }, size) = (invariants.start(), invariants.size());
        let [x, y, pole] = [(x, 0), (y, 1), (pole, 2)].map(|(value, k)| Dual::along(value, k));
        let start = Start { e: Dual::constant(e), x, y, c: pole };
        let (is_short, is_long) = (size.simd_le(real(SHORT)), size.simd_le(real(LONG)));
        let functions = match (is_short.all(), is_short.any() || !is_long.all()) {
            (true, _) => short(&start),
            (false, false) => long(&start),
            (false, true) => return None,
        };
        let bend = -(self.c_squared * self.difference(u));
        let more = bend * functions.integral.value;
        let (along, c) = (Vector3::from(u), Vector3::from(c));
        let v = along * (T::one() + more);
        let q = v.norm_squared();
        let (sinc, versine) = rotation_coefficients(q);
        let (cosine, square) = (T::one() - q * versine, sinc * sinc);
        let across = v.cross(&c);
        let again = v.cross(&across);
        let by_half_v = c - across * square + again * (versine + stumpff::<T, 3>(q) * cosine);
        let g = c + (again * square - across * (cosine * sinc)) * real::<T>(2.0);
        let mut by = self.whole_back(u, &invariants, [functions.n.value, functions.mu.value], g.into());
        let by_v = by_half_v + by_half_v;
        by.0 = (Vector3::from(by.0) + by_v * (T::one() + more)).into();
        let by_more = by_v.dot(&along);
        let by_integral = [by_more * bend, by_more * functions.integral.value];
        Some(self.functions_back(by, u, (&invariants, &functions), by_integral))
    }

    /// The adjoint of [`whole`](Self::whole), for the covector `g` of the turn `F_a`, whose quaternion is scaled by `N`
    /// here.
    fn whole_back(&self, u: [T; 3], invariants: &Invariants<T>, [n, mu]: [T; 2], g: [T; 3]) -> By<T> {
        let ([a, b, c], [ga, gb, gc], Invariants { kb, ka, .. }) = (u, g, *invariants);
        let (nn, kk) = (n * n, kb * ka);
        let (base, sum) = (nn - kk, nn + kk);
        let (db, da) = (sum - twice(kb) * n, sum - twice(ka) * n);
        let (mu_c, c_c, base_mu) = (mu * c, self.c_squared * c, base * mu);
        let den = base * base - self.c_squared * (mu_c * mu_c);
        let (x, y) = (a * da, b * db);
        let (a_mu, b_mu) = (self.a * mu_c, self.b * mu_c);
        let in_a = a * den + (x * base - b_mu * y);
        let in_b = b * den + (y * base + a_mu * x);
        let c_end = c * (da * db) + (self.b_less_a * (a * b)) * base_mu;
        let over_mu = n * den + c_c * c_end;
        let (base_a, base_b) = (self.a * base, self.b * base);
        let [w, p, q] = [mu * over_mu, base_a * in_a, base_b * in_b];
        let scale = real::<T>(2.0) / ((p * p + q * q) + w * w);
        let by_w = -(ga * p + gb * q) * scale;
        let by_p = (ga * w - gc * q) * scale;
        let by_q = (gb * w + gc * p) * scale;

        let by_over_mu = by_w * mu;
        let (by_in_a, by_in_b) = (by_p * base_a, by_q * base_b);
        let by_c_end = by_over_mu * c_c;
        let by_den = by_over_mu * n + (by_in_a * a + by_in_b * b);
        let (by_x, by_y) = (by_in_a * base + by_in_b * a_mu, by_in_b * base - by_in_a * b_mu);
        let (of_a_mu, of_b_mu) = (by_in_b * x, by_in_a * y);
        let by_mu_c = (of_a_mu * self.a - of_b_mu * self.b) - twice(by_den * self.c_squared) * mu_c;
        let (by_da, by_db) = (by_x * a + by_c_end * (c * db), by_y * b + by_c_end * (c * da));
        let of_ab = by_c_end * base_mu;
        let by_base_mu = by_c_end * (self.b_less_a * (a * b));
        let (of_base_a, of_base_b) = (by_p * in_a, by_q * in_b);
        let by_base = (of_base_a * self.a + of_base_b * self.b)
            + (by_in_a * x + by_in_b * y)
            + (twice(by_den * base) + by_base_mu * mu);
        let by_sum = by_da + by_db;
        let by_kk = by_sum - by_base;
        let by_u = [
            by_in_a * den + by_x * da + of_ab * (self.b_less_a * b),
            by_in_b * den + by_y * db + of_ab * (self.b_less_a * a),
            by_mu_c * mu + by_c_end * (da * db) + by_over_mu * (self.c_squared * c_end),
        ];
        let by_c_squared = by_over_mu * (c * c_end) - by_den * (mu_c * mu_c);
        let [by_a, by_b] = [of_base_a * base + of_a_mu * mu_c, of_base_b * base - of_b_mu * mu_c];
        let by_n = by_over_mu * den + twice(n * (by_base + by_sum) - (by_db * kb + by_da * ka));
        let by_mu = by_w * over_mu + by_mu_c * c + by_base_mu * base;
        let by_roots = [by_kk * ka - twice(by_db * n), by_kk * kb - twice(by_da * n)];
        (by_u, [by_a, by_b, of_ab * (a * b), by_c_squared], [by_roots[0], by_roots[1], by_n, by_mu])
    }

    /// The adjoint of the functions, the invariants and the constants of the form; the functions' slopes are those with
    /// respect to `x`, `y` and `c` of their [start](Start).
    fn functions_back(
        &self,
        (by_u, [by_a, by_b, by_b_less_a, by_c_squared], [by_kb, by_ka, by_n, by_mu]): By<T>,
        u: [T; 3],
        (invariants, Functions { n, mu, integral }): (&Invariants<T>, &Functions<Dual<T>>),
        [by_integral, by_bend]: [T; 2],
    ) -> ([T; 3], [T; 2]) {
        let [aa, bb, cc] = u.map(|part| part * part);
        let Invariants { kb, ka, apart, .. } = *invariants;
        let by = |k: usize| n.slopes[k] * by_n + mu.slopes[k] * by_mu + integral.slopes[k] * by_integral;
        let (by_x, by_y, by_c) = (by(0) * real(1.0 / 15.0), by(1) * real(-1.0 / 189.0), by(2));
        let by_e = by_n + by_c;
        let (past_b, past_a, of_y) = (kb + apart, ka - apart, by_y * (kb + ka));
        let by_roots = by_y * (past_b * past_a) + by_e * real(1.0 / 3.0);
        let by_apart = of_y * (past_a - past_b) + twice(by_x * apart);
        let by_kb = by_kb + (by_roots + of_y * past_a + by_x * ka);
        let by_ka = by_ka + (by_roots + of_y * past_b + by_x * kb);
        let (by_of_a, by_of_b, by_of_c) = (by_kb + by_apart, by_ka - by_apart, by_kb + by_ka);
        let (by_difference, of_pole) = (-(by_bend * self.c_squared), -(by_c * self.c_squared));
        let by_aa = by_of_a * self.a_squared + (by_difference * self.a + of_pole);
        let by_bb = by_of_b * self.b_squared + (by_difference * self.b + of_pole);
        let by_cc = by_of_c * self.c_squared + of_pole;
        let by_c_squared = by_c_squared + (by_of_c * cc - by_c * ((aa + bb) + cc)) - by_bend * self.difference(u);
        let (by_a_squared, by_b_squared) = (by_of_a * aa, by_of_b * bb);
        let by_b_less_a = by_b_less_a + (by_b_squared * self.b - by_a_squared * self.a);
        let by_a = (by_a + by_difference * aa) - (by_c_squared * self.b + by_a_squared * self.b_less_a) - by_b_less_a;
        let by_b = (by_b + by_difference * bb) - (by_c_squared * self.a - by_b_squared * self.b_less_a) + by_b_less_a;
        let of_squares = [by_aa, by_bb, by_cc];
        (core::array::from_fn(|k| by_u[k] + twice(of_squares[k] * u[k])), [by_a, by_b])
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::quaternion::product;
    use super::{Form, SHORT};
    use crate::numbers::{Dual, Real, real};
    use nalgebra::SimdBool as _;
    use simba::simd::WideF64x4;

    /// The derivatives of `c · ε` with respect to `u`, and to `A` and `B`, by dual numbers through the drift itself.
    fn by_dual_numbers<T: Real>(form: &Form<T>, u: [T; 3], c: [T; 3]) -> [T; 5] {
        let of = |[a, b]: [Dual<T>; 2], u| {
            let (scale, b_less_a) = (Dual::constant(form.scale), b - a);
            let (a_squared, b_squared) = (-(a * b_less_a), b * b_less_a);
            let turned = Form { scale, a, b, b_less_a, c_squared: -(a * b), a_squared, b_squared }.turned(u);
            let [w, x, y, z] = turned.map(|part| part.value);
            let square = w * w + x * x + y * y + z * z;
            [0, 1, 2].map(|k| {
                let [_, x, y, z] = product(turned.map(|part| part.slopes[k]), [w, -x, -y, -z]);
                (x * c[0] + y * c[1] + z * c[2]) * real(2.0) / square
            })
        };
        let [x, y, z] = of([form.a, form.b].map(Dual::constant), [0, 1, 2].map(|k| Dual::along(u[k], k)));
        let [a, b, _] = of([Dual::along(form.a, 0), Dual::along(form.b, 1)], u.map(Dual::constant));
        [x, y, z, a, b]
    }

    /// Whether the longer polynomials are used, if there are derivatives; asserts that their relative error is below
    /// `bound`.
    fn check<T: Real>(moments: [T; 3], u: [T; 3], bound: f64) -> Option<bool> {
        let (form, c) = (Form::of(moments, real(0.1)), [0.7, -0.4, 1.1].map(real));
        let ([x, y, z], [a, b]) = form.reversed(u, c)?;
        let expected = by_dual_numbers(&form, u, c);
        let size = expected.iter().fold(T::zero(), |size, entry| size.simd_max(entry.simd_abs()));
        for (found, expected) in [x, y, z, a, b].into_iter().zip(expected) {
            let error = (found - expected).simd_abs();
            assert!(error.simd_le(size * real(bound)).all(), "{moments:?}, {u:?}: {error:?} of {size:?}");
        }
        Some(form.invariants(u).size().simd_gt(real(SHORT)).all())
    }

    /// Momenta from rest to beyond the polynomials' range, in general position, about each axis, and near the
    /// separatrix; in doubles, singles and lanes; for a general, a flat and a long body, symmetric ones and a sphere,
    /// with the middle moment last.
    #[test]
    fn it_is_that_of_dual_numbers() {
        let bodies =
            [[4.5, 2.0, 3.0], [5.0, 2.0, 3.0], [3.0, 0.01, 2.995], [2.0, 3.5, 2.0], [3.5, 2.0, 2.0], [2.0, 2.0, 2.0]];
        let directions = [[0.9, -0.7, 1.2], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.5, 1.0]];
        let (mut counts, sizes) = ([0; 3], [1e-9, 1e-3, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 1.0]);
        for (moments, size) in bodies.iter().flat_map(|&moments| sizes.map(|size| (moments, size))) {
            let momenta = directions.map(|direction| direction.map(|part| part * size));
            for u in momenta {
                counts[check(moments, u, 1e-13).map_or(2, usize::from)] += 1;
                check(moments.map(real::<f32>), u.map(real::<f32>), 1e-4);
            }
            let lanes = [0, 1, 2].map(|k| WideF64x4::from([0, 1, 2, 4].map(|lane| momenta[lane][k])));
            check(moments.map(real::<WideF64x4>), lanes, 1e-13);
        }
        assert!(counts.into_iter().all(|count| count > 10), "{counts:?}");
    }
}
