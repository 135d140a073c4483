//! How to declare a group, and a kind of parameter it carries: the affine maps `x ↦ a x + b` of the line, `a > 0`.

use liestep::groups::matrix;
use liestep::groups::{
    Advected, CayleyRetraction, ExponentialRetraction, Generators, LieGroup as _, MatrixGroup, NotInGroup,
    Retraction as _,
};
use liestep::numbers::Entries;
use nalgebra::{Matrix2, RealField, SMatrix, Vector2};

/// The group, under an alias: matrices `[a, b; 0, 1]`, of size 2 and dimension 2.
type Affine<T = f64> = MatrixGroup<AffineGenerators, T, 2, 2>;

/// A marker type names it; the basis of its algebra and the relation of its matrices declare it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct AffineGenerators;

impl Generators<2, 2> for AffineGenerators {
    const GENERATORS: [[[f64; 2]; 2]; 2] = [matrix(&[(0, 0, 1.0)]), matrix(&[(0, 1, 1.0)])];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> T {
        m.m21.abs() + (m.m22 - T::one()).abs()
    }
}

/// Its laws. The first call is all that a declaration needs; the others are for what is used with it.
mod laws {
    use super::{Affine, Density};

    liestep::lie_group_laws!(Affine);
    liestep::advected_laws!(Affine);

    mod cayley {
        liestep::retraction_laws!(super::Affine, liestep::groups::CayleyRetraction);
    }

    mod exponential {
        liestep::retraction_laws!(super::Affine, liestep::groups::ExponentialRetraction);
    }

    mod density {
        liestep::advected_laws!(super::Affine, super::Density);
    }
}

/// A parameter of one's own: a mass per length, which a map that stretches the line by `a` divides by `a`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Density(f64);

impl Advected<Affine> for Density {
    /// `f⁻¹` stretches by `1/a`.
    fn seen_from(&self, attitude: &Affine) -> Self {
        Self(self.0 * attitude.matrix().m11)
    }

    fn change(&self, increment: &Matrix2<f64>) -> Self {
        Self(self.0 * increment.m11)
    }

    fn rate(&self, velocity: &Matrix2<f64>) -> Self {
        Self(self.0 * velocity.m11)
    }

    fn seen_through(&self, matrix: &Matrix2<f64>, _: &Matrix2<f64>) -> Self {
        Self(self.0 * matrix.m11)
    }

    fn is_finite(&self) -> bool {
        self.0.is_finite()
    }
}

impl Entries<f64> for Density {
    fn from_entries(next: &mut impl FnMut() -> f64) -> Self {
        Self(next())
    }

    fn each(&self, visit: &mut impl FnMut(f64)) {
        visit(self.0);
    }

    fn zip(&self, other: &Self, combine: &mut impl FnMut(f64, f64) -> f64) -> Self {
        Self(combine(self.0, other.0))
    }
}

/// An element by its two numbers, checked.
fn affine(a: f64, b: f64) -> Result<Affine, NotInGroup> {
    Affine::try_from(Matrix2::new(a, b, 0.0, 1.0))
}

#[test]
fn an_element_maps_the_line() -> Result<(), NotInGroup> {
    let (f, g) = (affine(2.0, 1.0)?, affine(3.0, 5.0)?);
    // 2 (3 x + 5) + 1
    assert_eq!(f.compose(&g), affine(6.0, 11.0)?);
    assert_eq!(f.inverse(), affine(0.5, -0.5)?);
    Ok(())
}

#[test]
fn what_is_not_affine_is_refused() {
    let error = Affine::try_from(Matrix2::new(2.0, 1.0, 0.25, 1.0)).unwrap_err();
    assert_eq!(error, NotInGroup { defect: 0.25 });
    assert!(error.to_string().contains("2.5e-1"));
    // The relation is about the second row only.
    assert!(affine(f64::NAN, 0.0).is_err() && affine(1.0, f64::INFINITY).is_err());
}

/// `[E_1, E_2] = E_2`, so that `ad*` moves the second component into the first.
#[test]
fn the_bracket_is_computed_from_the_generators() {
    let (x, y) = (Vector2::<f64>::x(), Vector2::y());
    assert_eq!(Affine::lie_bracket(&x, &y), y);
    assert_eq!(Affine::lie_bracket_transpose(&x, &y), y);
    assert_eq!(Affine::lie_bracket_transpose(&y, &y), -x);
}

/// `exp` of `(s, t)` is `(eˢ, t (eˢ − 1)/s)`; the Cayley map has `(1 + s/2)/(1 − s/2)` for `eˢ`.
#[test]
fn the_retractions_in_closed_form() {
    let (s, t) = (0.7_f64, -1.3);
    let xi = Vector2::new(s, t);
    let exponential: Affine = ExponentialRetraction::retract(&xi);
    assert!((exponential.matrix() - Matrix2::new(s.exp(), t * s.exp_m1() / s, 0.0, 1.0)).norm() < 1e-15);
    let cayley: Affine = CayleyRetraction::retract(&xi);
    let (stretch, shift) = ((1.0 + s / 2.0) / (1.0 - s / 2.0), t / (1.0 - s / 2.0));
    assert!((cayley.matrix() - Matrix2::new(stretch, shift, 0.0, 1.0)).norm() < 1e-15);
}
