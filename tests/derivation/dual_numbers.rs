//! The derived terms of a discrete Lagrangian compared with its hyper-dual numbers, on any matrix group; and the rules
//! of `discretise` by hand.

use std::collections::BTreeMap;

use checks::structure::numbers::{lifted, numbers, varied};
use checks::structure::{Group, Vector, axis, norm, norm_of_map, random_advected};
use liestep::groups::{Advected as _, LieGroup};
use liestep::laws::samples::Random;
use liestep::mechanics::DiscreteLagrangian;
use liestep::numbers::{Coordinates as _, Entries};
use nalgebra::{Matrix3, RealField, SMatrix, SVector, Vector3, convert};
use num_dual::HyperDual64;

/// The bound is some dozens of roundings of the compared numbers, and the effect of a rounding of the increment on
/// them.
const ROUNDING: f64 = 1e-14;

/// Checks `l_d` and every derived term, at the identity, near it and at random increments; and the relations of the
/// momenta, `(L_F)* δl_d/δF = Ad*_F (R_F)* δl_d/δF` and `μ⁺ = Ad*_F (μ + δl_d/δw ⋄ w)`.
///
/// Each error is relative to the term's own size, and to that of cancelling terms of `l_d`, `cancelling`, J s.
///
/// `H` is the group of the hyper-dual numbers, and `far` the largest size of an increment's coordinates.
pub(crate) fn assert_terms<L, H, W>(
    name: &str,
    (system, h, cancelling): (&L, f64, f64),
    l_d: impl Fn(&H::Matrix, &W, HyperDual64) -> HyperDual64,
    (seed, far): (u64, f64),
) where
    L: DiscreteLagrangian<Scalar = f64, Group: Group>,
    H: LieGroup<Scalar = HyperDual64>,
    W: Entries<HyperDual64>,
{
    let (mut random, dimension) = (Random::new(seed), L::Group::DIMENSION);
    let step = HyperDual64::from(h);
    let units = [HyperDual64::new(0.0, 1.0, 0.0, 0.0), HyperDual64::new(0.0, 0.0, 1.0, 0.0)];
    let product = |a: &H::Matrix, b: &H::Matrix| {
        let [a, b] = [a, b].map(|matrix| H::from_matrix_unchecked(*matrix));
        a.compose(&b).matrix()
    };
    let hat = |k: usize, s: f64| L::Group::hat(&axis(k, s));
    // exp(ε E_k) is exact here, as ε² = 0.
    let turned =
        |k: usize, unit: HyperDual64| -> H::Matrix { varied(&L::Group::identity().matrix(), &hat(k, 1.0), unit) };
    let mut worst = BTreeMap::<&str, f64>::new();
    for size in [0.0, 1e-8, 0.1, 0.5, far] {
        let element = L::Group::along(&random.sample(), size);
        let (f, w) = (element.matrix(), random_advected(system, &mut random));
        let (long, still): (H::Matrix, W) = (lifted(&f), lifted(&w));
        let [right, left] = [system.right_momentum(&f, &w, h), system.left_momentum(&f, &w, h)];
        let [diamond, momentum] = [system.diamond(&f, &w, h), system.legendre_minus(&f, &w, h)];
        let (value, jacobian) = (system.l_d(&f, &w, h), system.momentum_jacobian(&f, &w, h));
        let mut close = |what: &'static str, found: f64, expected: f64, scale: f64, cancelling: f64| {
            let error = (found - expected).abs();
            let most = worst.entry(what).or_default();
            *most = most.max(error / (scale + f64::MIN_POSITIVE));
            assert!(
                error <= ROUNDING * (scale + cancelling),
                "{name}, {what}: {found} and {expected}, {error:e} of {scale:e} and {cancelling:e}, at {size}"
            );
        };
        let of_value = value.abs() + h * norm(&right);
        let of_momenta = norm(&right) + norm(&left) + norm_of_map::<L>(&jacobian);
        let of_diamond = norm(&diamond) + of_value;
        close("l_d", value, l_d(&long, &still, step).re, of_value, cancelling);
        for k in 0..dimension {
            let turn = turned(k, units[0]);
            let carried = varied(&w, &w.rate(&hat(k, -1.0)), units[0]);
            let before = product(&turn, &long);
            let [right, left, diamond, momentum] = [&right, &left, &diamond, &momentum].map(|of| numbers(of)[k]);
            close("right momentum", right, l_d(&before, &still, step).eps1, of_momenta, cancelling);
            close("left momentum", left, l_d(&product(&long, &turn), &still, step).eps1, of_momenta, cancelling);
            close("diamond", diamond, -l_d(&long, &carried, step).eps1, of_diamond, cancelling);
            close("momentum", momentum, l_d(&before, &carried, step).eps1, of_momenta, cancelling);
            for j in 0..dimension {
                let moved = product(&turn, &product(&turned(j, units[1]), &long));
                let found = numbers(&Vector::<L>::column(&jacobian, j))[k];
                close("Jacobian", found, l_d(&moved, &carried, step).eps1eps2, of_momenta, cancelling);
            }
        }
        let energy = -l_d(&long, &still, step + units[0]).eps1;
        // The cancelling terms have at most h³ in the denominator.
        let of_energy = energy.abs() + of_value / h;
        close("energy", system.discrete_energy(&f, &w, h), energy, of_energy, 3.0 * cancelling / h);
        let moved = element.adjoint_transpose(&(momentum + diamond));
        let apart = norm(&(left - element.adjoint_transpose(&right)));
        close("left = Ad* right", apart, 0.0, of_momenta, cancelling);
        let apart = norm(&(system.legendre_plus(&f, &w, h) - moved));
        close("μ⁺ = Ad* (μ + diamond)", apart, 0.0, of_momenta, cancelling);
    }
    let worst: Vec<String> = worst.iter().map(|(what, error)| format!("{what} {error:.1e}")).collect();
    println!("{name}, h = {h}: off by at most {}", worst.join(", "));
}

/// The discretisations `trapezoid(Cayley)` and `chord(Cayley)` of an `l` on any group of matrices, as a function of
/// `ξ̂` and of a covector.
pub(crate) fn by_cayley<T: RealField + Copy, const N: usize>(
    rule: &str,
    l: impl Fn(&SMatrix<T, N, N>, &SVector<T, N>) -> T,
    (f, w, h): (&SMatrix<T, N, N>, &SVector<T, N>, T),
) -> T {
    let (half, one) = (convert::<f64, T>(0.5), SMatrix::identity());
    let inverse = (f + one).try_inverse().expect("an increment that isn't large");
    let x = (f - one) * inverse * (convert::<f64, T>(2.0) / h);
    let next = f.transpose() * w;
    match rule {
        "trapezoid(Cayley)" => (l(&x, w) + l(&x, &next)) * half * h,
        "chord(Cayley)" => l(&x, &((w + next) * half)) * h,
        _ => panic!("{rule} isn't a rule with Cayley's transform"),
    }
}

/// The discretisation by a rule of `discretise` of an `l` on SO(3), as a function of `ξ·Jξ`, `ξ` and `w`.
pub(crate) fn by_hand<T: RealField + Copy>(
    rule: &str,
    J: &Matrix3<f64>,
    l: impl Fn(T, &Vector3<T>, &Vector3<T>) -> T,
    (f, w, h): (&Matrix3<T>, &Vector3<T>, T),
) -> T {
    let (J, half, one) = (J.map(convert::<f64, T>), convert::<f64, T>(0.5), T::one());
    let skew = |x: &Matrix3<T>| Vector3::new(x.m32 - x.m23, x.m13 - x.m31, x.m21 - x.m12) * half;
    let quadratic = |xi: &Vector3<T>| xi.dot(&(J * xi));
    // The vectors tan(θ/2) and sin(θ/2) along the axis.
    let tangent = skew(f) * (convert::<f64, T>(2.0) / (one + f.trace()));
    let sine = skew(f) / (one + f.trace()).sqrt();
    let (q, xi) = if rule.ends_with("(Cayley)") {
        let xi = tangent * (convert::<f64, T>(2.0) / h);
        (quadratic(&xi), xi)
    } else if rule.ends_with("(exp)") {
        let xi = sine * (arcsine_ratio(sine.dot(&sine)) * convert(2.0) / h);
        (quadratic(&xi), xi)
    } else {
        let (x, nonstandard) = ((f - Matrix3::identity()) / h, Matrix3::identity() * (half * J.trace()) - J);
        ((x * nonstandard * x.transpose()).trace(), skew(&x))
    };
    let next = f.transpose() * w;
    if rule.starts_with("trapezoid") {
        (l(q, &xi, w) + l(q, &xi, &next)) * half * h
    } else if rule.starts_with("chord") {
        l(q, &xi, &((w + next) * half)) * h
    } else {
        // The middle value exp(−hξ/2) w.
        let (mut middle, mut term) = (*w, *w);
        for n in 1..40 {
            term = term.cross(&xi) * (half * h / convert(f64::from(n)));
            middle += term;
        }
        l(q, &xi, &middle) * h
    }
}

/// The function `arcsin(s)/s` of `s²`, by its series `Σ (2n)!/(4ⁿ n!² (2n + 1)) s²ⁿ`.
fn arcsine_ratio<T: RealField + Copy>(square: T) -> T {
    let (mut sum, mut term) = (T::one(), T::one());
    for n in 1..300 {
        let n = f64::from(n);
        term *= square * convert((2.0 * n - 1.0) / (2.0 * n));
        sum += term / convert(2.0 * n + 1.0);
    }
    sum
}
