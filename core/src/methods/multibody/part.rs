//! Terms on a part of a body: on its rotation, on its translation, or on both.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::{Body, Increment};
use crate::groups::{LieGroup, R3, SO3, SquareOf};

/// The group of a term on a body of a [`Multibody`](super::Multibody) system: its rotation, [`SO3`], its translation, [`R3`],
/// or both, `(SO3, R3)`.
#[diagnostic::on_unimplemented(
    message = "a term on `{Self}` isn't one on a body of a system",
    label = "not the group of a body",
    note = "bodies have a rotation and a translation: declare the term on `group = SO3`, on `group(d = R3)`, or on both, `group(F = SO3, d = R3)`",
    note = "a term between two bodies is on two of these, `group(F_1 = SO3, F_2 = SO3)` for example"
)]
pub trait BodyPart: LieGroup<Scalar = f64> {
    /// The part of a body's configuration.
    fn of(body: &Body) -> Self;

    /// The part of an increment `F − I`.
    fn of_increment(increment: &Increment) -> Self::Matrix;

    /// The part of components, those of the rotation before those of the translation.
    fn of_components(components: &Vector6<f64>) -> Self::Vector;

    /// The components of a body with zeros where this part has none.
    fn in_body(part: &Self::Vector) -> Vector6<f64>;

    /// The matrix of a body with zeros where this part has no entries.
    fn square_in_body(part: &SquareOf<Self>) -> Matrix6<f64>;
}

impl BodyPart for Body {
    fn of(body: &Body) -> Self {
        *body
    }

    fn of_increment(increment: &Increment) -> Increment {
        *increment
    }

    fn of_components(components: &Vector6<f64>) -> Vector6<f64> {
        *components
    }

    fn in_body(part: &Vector6<f64>) -> Vector6<f64> {
        *part
    }

    fn square_in_body(part: &Matrix6<f64>) -> Matrix6<f64> {
        *part
    }
}

/// Implements the trait for a factor of the body, whose components begin at this one.
macro_rules! factor {
    ($group:ty, $factor:tt, $first:literal) => {
        impl BodyPart for $group {
            fn of(body: &Body) -> Self {
                body.$factor
            }

            fn of_increment(increment: &Increment) -> Self::Matrix {
                increment.$factor
            }

            fn of_components(components: &Vector6<f64>) -> Vector3<f64> {
                components.fixed_rows::<3>($first).into_owned()
            }

            fn in_body(part: &Vector3<f64>) -> Vector6<f64> {
                let mut all = Vector6::zeros();
                all.fixed_rows_mut::<3>($first).copy_from(part);
                all
            }

            fn square_in_body(part: &Matrix3<f64>) -> Matrix6<f64> {
                let mut all = Matrix6::zeros();
                all.fixed_view_mut::<3, 3>($first, $first).copy_from(part);
                all
            }
        }
    };
}

factor!(SO3, 0, 0);
factor!(R3, 1, 3);
