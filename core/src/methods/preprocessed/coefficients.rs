//! The series of \[HV06\] for the modified moments of inertia.

use nalgebra::Vector3;

use crate::numbers::{Real, real};

/// Terms in `C^{n−k} H^k`, `k = 0, …, n`, of the degrees `n = 1, 2, 3, 4` in turn.
pub(super) const TERMS: usize = 14;

/// The coefficients of `s − 1` and of `d`, `1/Ĩ_j = s/I_j + d`, as functions of `h² C` and `h² H`.
///
/// With `δ = I_1 I_2 I_3`, `σ_a = Σ I_j^a` and `τ_{b,c} = Σ (I_k^b + I_l^b)/I_j^c` over the cyclic permutations.
#[rustfmt::skip]
pub(super) fn series<T: Real>(moments: &Vector3<T>) -> ([T; TERMS], [T; TERMS]) {
    let c = |value: f64| real::<T>(value);
    let sigma = |a: i32| moments.map(|moment| moment.simd_powi(a)).sum();
    let tau = |b: i32, c: i32| {
        let term = |j: usize| {
            let [k, l] = [(j + 1) % 3, (j + 2) % 3];
            (moments[k].simd_powi(b) + moments[l].simd_powi(b)) / moments[j].simd_powi(c)
        };
        term(0) + term(1) + term(2)
    };
    let delta = moments.x * moments.y * moments.z;
    let [d2, d3, d4] = [2, 3, 4].map(|power| delta.simd_powi(power));
    let s = [
        sigma(1) / (delta * c(6.0)),
        -sigma(-1) / c(3.0),

        (sigma(2) - delta * sigma(-1)) / (d2 * c(30.0)),
        (T::one() - tau(1, 1)) / (delta * c(30.0)),
        (sigma(1) * c(3.0) + delta * sigma(-2) * c(2.0)) / (delta * c(60.0)),

        (delta * c(4.0) + sigma(3) * c(17.0) - delta * tau(1, 1) * c(15.0)) / (d3 * c(2520.0)),
        (sigma(1) * c(9.0) + delta * sigma(-2) * c(10.0) - tau(2, 1) * c(6.0)) / (d2 * c(420.0)),
        (delta * tau(1, 2) * c(6.0) - delta * sigma(-1) * c(100.0) + sigma(2) * c(53.0)) / (d2 * c(2520.0)),
        (c(15.0) - delta * sigma(-3) - tau(1, 1) * c(2.0)) / (delta * c(630.0)),

        (sigma(4) * c(62.0) - delta * tau(2, 1) * c(94.0) + d2 * sigma(-2) * c(66.0) + delta * sigma(1) * c(81.0))
            / (d4 * c(45360.0)),
        (-tau(3, 1) * c(77.0) + delta * tau(1, 2) * c(75.0) + sigma(2) * c(214.0) - delta * sigma(-1) * c(240.0))
            / (d3 * c(22680.0)),
        (delta * tau(2, 2) * c(26.0) + sigma(3) * c(55.0) + delta * c(204.0) - d2 * sigma(-3) * c(50.0)
            - delta * tau(1, 1) * c(59.0)) / (d3 * c(7560.0)),
        (delta * sigma(-2) * c(137.0) - delta * tau(1, 3) + sigma(1) * c(3.0) - tau(2, 1) * c(69.0))
            / (d2 * c(11340.0)),
        (d2 * sigma(-4) * c(2.0) + delta * tau(1, 2) * c(5.0) - delta * sigma(-1) * c(171.0) + sigma(2) * c(159.0))
            / (d2 * c(45360.0)),
    ];
    let d = [
        -T::one() / (delta * c(3.0)),
        sigma(1) / (delta * c(6.0)),

        -sigma(1) / (d2 * c(60.0)),
        (delta * sigma(-1) * c(6.0) - sigma(2)) / (d2 * c(60.0)),
        -(c(9.0) + tau(1, 1)) / (delta * c(60.0)),

        (delta * sigma(-1) * c(34.0) - sigma(2) * c(19.0)) / (d3 * c(2520.0)),
        (sigma(3) + delta * tau(1, 1) * c(2.0) - delta * c(85.0)) / (d3 * c(1260.0)),
        (sigma(1) * c(47.0) + tau(2, 1) * c(13.0) - delta * sigma(-2) * c(38.0)) / (d2 * c(2520.0)),
        (delta * sigma(-1) * c(9.0) + delta * tau(1, 2) - sigma(2) * c(11.0)) / (d2 * c(1260.0)),

        (delta * tau(1, 1) * c(60.0) - sigma(3) * c(61.0) - delta * c(247.0)) / (d4 * c(45360.0)),
        (delta * sigma(1) * c(54.0) - sigma(4) + delta * tau(2, 1) * c(218.0) - d2 * sigma(-2) * c(426.0))
            / (d4 * c(45360.0)),
        (delta * sigma(-1) * c(125.0) - tau(3, 1) * c(5.0) - sigma(2) * c(130.0) + delta * tau(1, 2) * c(4.0))
            / (d3 * c(7560.0)),
        (sigma(3) * c(67.0) - delta * c(735.0) - delta * tau(2, 2) * c(15.0) + delta * tau(1, 1) * c(87.0)
            + d2 * sigma(-3) * c(34.0)) / (d3 * c(22680.0)),
        (sigma(1) * c(165.0) - delta * tau(1, 3) - tau(2, 1) * c(9.0) - delta * sigma(-2) * c(145.0))
            / (d2 * c(45360.0)),
    ];
    (s, d)
}

/// The sum of the terms up to a degree.
///
/// Horner's scheme in `H` for each degree, its coefficients multiplied with the powers of `C` on the way.
#[hot]
pub(super) fn sum<T: Real>(coefficients: &[T; TERMS], degree: usize, c: T, h: T) -> T {
    let (mut sum, mut rest) = (T::zero(), coefficients.as_slice());
    for n in 1..=degree {
        let (terms, others) = rest.split_at(n + 1);
        let (homogeneous, _) = terms
            .iter()
            .rev()
            .fold((T::zero(), T::one()), |(total, power), &term| (total * h + term * power, power * c));
        sum += homogeneous;
        rest = others;
    }
    sum
}
