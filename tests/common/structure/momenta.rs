//! P2: the momenta are derivatives of the declared `l_d`, and satisfy the relations of the theory.
//!
//! ```text
//! (L_F)* δl_d/δF = Ad*_F (R_F)* δl_d/δF,     μ⁺ = Ad*_F (μ + δl_d/δw ⋄ w)
//! ```

use liestep::groups::{Advected as _, LieGroup as _};
use liestep::laws::samples::{Random, derivative};
use liestep::mechanics::DiscreteLagrangian;
use liestep::numbers::Coordinates as _;

use super::numbers::{from_numbers, numbers};
use super::{Group, Vector, gradient, norm, norm_of_map, random_advected};

/// The bound for two products of small matrices, relative to the entries of the momenta.
const ROUNDING: f64 = 1e-13;

/// The six-point differences have an error of 10⁻¹³ relative to the function, which exceeds its derivatives some ten
/// times.
const DIFFERENCES: f64 = 1e-11;

/// Compares every derived term with differences of the declared `l_d`, at the identity, near it and at random
/// increments.
pub fn assert_momenta<L: DiscreteLagrangian<Scalar = f64, Group: Group>>(l: &L, seed: u64) {
    let dimension = L::Group::DIMENSION;
    let mut random = Random::new(seed);
    let h = 0.05;
    for size in [0.0, 1e-8, 0.1, 0.5, 0.5] {
        let element = L::Group::along(&random.sample(), size);
        let (f, w) = (element.matrix(), random_advected(l, &mut random));
        let before = |k, s| L::Group::turn(k, s).compose(&element).matrix();
        let behind = |k, s| element.compose(&L::Group::turn(k, s)).matrix();
        // In the frame of an attitude g the parameters are g⁻¹ · w.
        let carried = |k, s: f64| w.seen_from(&L::Group::turn(k, -s));

        let (right, left) = (l.right_momentum(&f, &w, h), l.left_momentum(&f, &w, h));
        let (diamond, momentum) = (l.diamond(&f, &w, h), l.legendre_minus(&f, &w, h));
        let jacobian = l.momentum_jacobian(&f, &w, h);
        let scale = l.l_d(&f, &w, h).abs() + norm(&right) + norm(&left) + norm(&diamond) + norm_of_map::<L>(&jacobian);
        let close = |what: &str, found: Vector<L>, expected: Vector<L>, allowed: f64| {
            let error = norm(&(found - expected));
            assert!(error <= allowed * scale, "{what}: off by {error:e} of {scale:e} at {size}");
        };
        close("right", right, gradient::<L>(&|k, s| l.l_d(&before(k, s), &w, h)), DIFFERENCES);
        close("left", left, gradient::<L>(&|k, s| l.l_d(&behind(k, s), &w, h)), DIFFERENCES);
        close("diamond", diamond, -gradient::<L>(&|k, s| l.l_d(&f, &carried(k, s), h)), DIFFERENCES);
        let joint = gradient::<L>(&|k, s| l.l_d(&before(k, s), &carried(k, s), h));
        close("momentum", momentum, joint, DIFFERENCES);
        for j in 0..dimension {
            let column = numbers(&derivative(|s| l.legendre_minus(&before(j, s), &w, h)));
            // For several bodies a Jacobian has only the blocks on the diagonal.
            let body = |k| k * L::Group::BODIES / dimension;
            let of_body = (0..dimension).map(|k| if body(k) == body(j) { column[k] } else { 0.0 });
            close("Jacobian", Vector::<L>::column(&jacobian, j), from_numbers(of_body), DIFFERENCES);
        }
        let rate = derivative(|s| l.l_d(&f, &w, h * (1.0 + s))) / h;
        assert!((l.discrete_energy(&f, &w, h) + rate).abs() <= 1e-9 * scale / h, "energy");

        close("left = Ad* right", left, element.adjoint_transpose(&right), ROUNDING);
        let moved = element.adjoint_transpose(&(momentum + diamond));
        close("μ⁺ = Ad* (μ + diamond)", l.legendre_plus(&f, &w, h), moved, ROUNDING);
    }
}
