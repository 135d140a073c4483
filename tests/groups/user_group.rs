//! A user's kind of parameter, and the computed properties of a user's group, the affine maps `x ↦ a x + b`. Its
//! declaration, with its laws as tests, is in `examples/how-to-add-a-group.rs`.

use checks::affine::Affine;
use liestep::groups::{Advected, CayleyRetraction, ExponentialRetraction, LieGroup as _, NotInGroup, Retraction as _};
use liestep::numbers::Entries;
use nalgebra::{Matrix2, Vector2};

mod density {
    liestep::advected_laws!(super::Affine, super::Density);
}

/// A user's parameter: a mass per length, which is divided by `a` when a map stretches the line by `a`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Density(f64);

impl Advected<Affine> for Density {
    /// The inverse map `f⁻¹` stretches by `1/a`.
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

#[test]
fn what_is_not_affine_is_refused() {
    let element = |a: f64, b: f64| Affine::try_from(Matrix2::new(a, b, 0.0, 1.0));
    assert_eq!(element(2.0, 1.0).unwrap().inverse(), element(0.5, -0.5).unwrap());
    let error = Affine::try_from(Matrix2::new(2.0, 1.0, 0.25, 1.0)).unwrap_err();
    assert_eq!(error, NotInGroup { defect: 0.25 });
    assert!(error.to_string().contains("2.5e-1"));
    // The relation concerns the second row only.
    assert!(element(f64::NAN, 0.0).is_err() && element(1.0, f64::INFINITY).is_err());
}

/// The bracket `[E_1, E_2] = E_2`, so that `ad*` maps the second component to the first.
#[test]
fn the_bracket_is_computed_from_the_generators() {
    let (x, y) = (Vector2::<f64>::x(), Vector2::y());
    assert_eq!(Affine::lie_bracket(&x, &y), y);
    assert_eq!(Affine::lie_bracket_transpose(&x, &y), y);
    assert_eq!(Affine::lie_bracket_transpose(&y, &y), -x);
}

/// The map `exp` of `(s, t)` is `(eˢ, t (eˢ − 1)/s)`; the Cayley map has `(1 + s/2)/(1 − s/2)` in place of `eˢ`.
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
