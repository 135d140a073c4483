//! The laws of SL(3), whose basis isn't orthogonal, and which the Cayley map leaves: its coordinates are of the second kind.

use liestep::groups::{CayleyRetraction, LieGroup as _, Retraction as _, matrix_group};
use nalgebra::{Matrix3, RealField, SMatrix, SVector};

matrix_group! {
    /// Maps of space that keep volumes.
    type SL3 = [
        [[0.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
    ];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 3, 3>) -> T {
        (m.determinant() - T::one()).abs()
    }

    /// The adjugate: cross products of columns.
    fn inverse<T: RealField + Copy>(m: &SMatrix<T, 3, 3>) -> SMatrix<T, 3, 3> {
        let [a, b, c] = [0, 1, 2].map(|k| m.column(k).into_owned());
        SMatrix::from_rows(&[b.cross(&c).transpose(), c.cross(&a).transpose(), a.cross(&b).transpose()])
    }
}

mod laws {
    liestep::lie_group_laws!(super::SL3);
    liestep::advected_laws!(super::SL3);
    liestep::retraction_laws!(super::SL3, liestep::groups::CayleyRetraction);
}

/// The dual basis of `a = diag(1, −1, 0)` and `b = diag(0, 1, −1)` has `⟨E^a, M⟩ = (2 M_11 − M_22 − M_33)/3`.
#[test]
fn components_are_those_of_the_dual_basis() {
    let m = Matrix3::new(5.0, 1.0, 2.0, 3.0, -1.0, 4.0, 6.0, 7.0, -4.0);
    let expected = SVector::from([1.0, 2.0, 3.0, 4.0, 6.0, 7.0, 5.0, 4.0]);
    assert!((SL3::vee(&m) - expected).norm() < 1e-14);
    // Of a multiple of the identity nothing is left, though its entries pair with the generators.
    assert!(SL3::vee(&Matrix3::<f64>::identity()).norm() < 1e-15);
}

/// The map of one coordinate is the Cayley map of its generator: a shear, or a stretch by `(1 + y)/(1 − y)`.
#[test]
fn single_coordinates_in_closed_form() {
    let along = |k: usize, xi: f64| {
        let mut coordinates = SVector::<f64, 8>::zeros();
        coordinates[k] = xi;
        let element: SL3 = CayleyRetraction::retract(&coordinates);
        element.matrix()
    };
    assert_eq!(along(1, 0.6), Matrix3::new(1.0, 0.0, 0.6, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0));
    let stretch = 1.3 / 0.7;
    assert!((along(6, 0.6) - Matrix3::from_diagonal(&[stretch, 1.0 / stretch, 1.0].into())).norm() < 1e-15);
}
