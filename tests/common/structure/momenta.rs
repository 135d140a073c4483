//! P2: the momenta are derivatives of the declared `l_d`, and hang together as the theory says.
//!
//! ```text
//! (L_F)* δl_d/δF = Ad*_F (R_F)* δl_d/δF,     μ⁺ = Ad*_F (μ + δl_d/δw ⋄ w)
//! ```

use liestep::groups::{Advected as _, LieGroup as _};
use liestep::laws::samples::derivative;
use liestep::laws::samples::{Random, along};
use nalgebra::SVector;

use super::{System, random_advected, turn};

/// Two products of small matrices, relative to the entries of the momenta.
const ROUNDING: f64 = 1e-13;

/// The six-point differences leave 10⁻¹³ of what they differentiate, which exceeds its derivatives some ten times.
const DIFFERENCES: f64 = 1e-11;

fn gradient<const D: usize>(value: impl Fn(usize, f64) -> f64) -> SVector<f64, D> {
    SVector::from_fn(|k, _| derivative(|s| value(k, s)))
}

/// Every derived term against differences of the declared `l_d`, at the identity, next to it and at random increments.
pub fn assert_momenta<L: System<N, D>, const N: usize, const D: usize>(l: &L, seed: u64) {
    let mut random = Random::new(seed);
    let h = 0.05;
    for size in [0.0, 1e-8, 0.1, 0.5, 0.5] {
        let xi: SVector<f64, D> = random.sample();
        let element = along::<L::Group, N, D>(&xi, size);
        let (f, w) = (element.matrix(), random_advected(l, &mut random));
        let exp = |k, s| turn::<L, N, D>(k, s).matrix();
        // What an attitude g sees is g⁻¹ · w.
        let carried = |k, s: f64| w.seen_from(&turn::<L, N, D>(k, -s));

        let (right, left) = (l.right_momentum(&f, &w, h), l.left_momentum(&f, &w, h));
        let (diamond, momentum) = (l.diamond(&f, &w, h), l.legendre_minus(&f, &w, h));
        let jacobian = l.momentum_jacobian(&f, &w, h);
        let scale = l.l_d(&f, &w, h).abs() + right.norm() + left.norm() + diamond.norm() + jacobian.norm();
        let close = |what: &str, found: SVector<f64, D>, expected: SVector<f64, D>, allowed: f64| {
            let error = (found - expected).norm();
            assert!(error <= allowed * scale, "{what}: off by {error:e} of {scale:e} at {size}");
        };
        close("right", right, gradient::<D>(|k, s| l.l_d(&(exp(k, s) * f), &w, h)), DIFFERENCES);
        close("left", left, gradient::<D>(|k, s| l.l_d(&(f * exp(k, s)), &w, h)), DIFFERENCES);
        close("diamond", diamond, -gradient::<D>(|k, s| l.l_d(&f, &carried(k, s), h)), DIFFERENCES);
        let joint = gradient::<D>(|k, s| l.l_d(&(exp(k, s) * f), &carried(k, s), h));
        close("momentum", momentum, joint, DIFFERENCES);
        for j in 0..D {
            let column = derivative(|s| l.legendre_minus(&(exp(j, s) * f), &w, h));
            close("Jacobian", jacobian.column(j).into_owned(), column, DIFFERENCES);
        }
        // `1/h` has the seventh derivative `7!/h⁸`, of which the six points of a fiftieth of `h` leave 10⁻⁹ of `1/h²`.
        let rate = derivative(|s| l.l_d(&f, &w, h + s));
        assert!((l.discrete_energy(&f, &w, h) + rate).abs() <= 1e-8 * scale / h, "energy");

        close("left = Ad* right", left, element.adjoint_transpose(&right), ROUNDING);
        let moved = element.adjoint_transpose(&(momentum + diamond));
        close("μ⁺ = Ad* (μ + diamond)", l.legendre_plus(&f, &w, h), moved, ROUNDING);
    }
}
