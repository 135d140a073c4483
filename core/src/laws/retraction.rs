//! The laws of `Retraction`.

use nalgebra::{SMatrix, SVector};

use super::samples::{
    DIFFERENCE, MatrixLieGroup, ROUNDING, Random, assert_close, assert_small, condition, derivative, eliminated_inverse,
};
use crate::groups::Retraction;

/// A retraction at zero: `τ(0) = e` with the identity as its derivative.
pub fn retraction_at_zero<G: MatrixLieGroup<N, D>, R: Retraction<G>, const N: usize, const D: usize>() {
    let zero = SVector::<f64, D>::zeros();
    assert_close(&R::increment(&zero), &SMatrix::zeros(), 0.0, "τ(0) = e");
    assert_close(&R::tangent(&zero), &SMatrix::identity(), 0.0, "T(0) = I");
    assert_close(&coordinates_of::<G, R, N, D>(&G::identity()), &zero, 0.0, "τ⁻¹(e) = 0");
    assert_small(f64::from(u8::from(!R::is_near_identity(&zero))), 0.0, "zero is near the identity");
}

/// A retraction maps into the group.
pub fn retraction_stays_in_the_group<G: MatrixLieGroup<N, D>, R: Retraction<G>, const N: usize, const D: usize>() {
    for xi in Random::new(11).coordinates() {
        let f = R::retract(&xi);
        assert_small(f.defect(), ROUNDING * condition(&f), "τ(ξ) is in the group");
        let added = R::increment(&xi) + SMatrix::identity();
        assert_close(&f.matrix(), &added, ROUNDING * condition(&f), "τ(ξ) = I + D");
    }
}

/// Local coordinates invert a retraction: `τ⁻¹(τ(ξ)) = ξ` and `τ(τ⁻¹(F)) = F`.
pub fn retraction_round_trips<G: MatrixLieGroup<N, D>, R: Retraction<G>, const N: usize, const D: usize>() {
    let mut random = Random::new(12);
    for xi in random.coordinates() {
        let f = R::retract(&xi);
        let allowed = ROUNDING * condition(&f);
        let returned = coordinates_of::<G, R, N, D>(&f);
        assert_close(&returned, &xi, allowed, "τ⁻¹(τ(ξ)) = ξ");
        assert_close(&R::retract(&returned).matrix(), &f.matrix(), allowed, "τ(τ⁻¹(F)) = F");
    }
    for f in random.elements::<G, N, D>() {
        // Some elements may be out of the retraction's reach.
        if let Some(xi) = R::local_coordinates(&f) {
            let allowed = ROUNDING * condition(&f) * (1.0 + xi.norm_squared());
            assert_close(&R::retract(&xi).matrix(), &f.matrix(), allowed, "τ(τ⁻¹(F)) = F");
        }
    }
}

/// The tangent of a retraction: `dF F⁻¹ = (T dξ)^`.
pub fn retraction_tangent<G: MatrixLieGroup<N, D>, R: Retraction<G>, const N: usize, const D: usize>() {
    for xi in Random::new(13).coordinates() {
        let f: G = R::retract(&xi);
        let tangent = R::tangent(&xi);
        for k in 0..D {
            let mut unit = SVector::<f64, D>::zeros();
            unit[k] = 1.0;
            let rate = derivative(|t| R::retract(&(xi + unit * t)).matrix()) * eliminated_inverse(&f);
            assert_close(&G::hat(&(tangent * unit)), &rate, DIFFERENCE * condition(&f), "dF F⁻¹ = (T dξ)^");
        }
    }
}

/// The increment has all digits of a small `ξ`.
pub fn retraction_keeps_digits<G: MatrixLieGroup<N, D>, R: Retraction<G>, const N: usize, const D: usize>() {
    let mut random = Random::new(14);
    for _ in 0..20 {
        let xi: SVector<f64, D> = random.sample();
        // The second order is 10⁻²⁴; a subtraction of `I` would leave 10⁻¹⁶ on the diagonal.
        let tiny = xi * 1e-12;
        assert_close(&R::increment(&tiny), &G::hat(&tiny), 1e-22, "τ(ξ) − I = ξ̂ to first order");
        // The even part tests diagonals without a first order, as those of rotations: it is quadratic up to 10⁻²¹.
        let even = |scale: f64| R::increment(&(xi * scale)) + R::increment(&(xi * -scale));
        assert_close(&even(4e-6), &(even(2e-6) * 4.0), 1e-19, "the second order of τ(ξ) − I keeps its digits");
    }
}

/// The local coordinates, or NaN out of their reach, which fails every comparison.
fn coordinates_of<G: MatrixLieGroup<N, D>, R: Retraction<G>, const N: usize, const D: usize>(f: &G) -> SVector<f64, D> {
    R::local_coordinates(f).unwrap_or_else(|| SVector::repeat(f64::NAN))
}
