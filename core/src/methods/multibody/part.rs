//! Terms on a part of a body: on its rotation, on its translation, or on both.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::{Body, Increment};
use crate::groups::{LieGroup, Pair, R3, SO3, SquareOf};

/// The group of a term on a body of a [`Multibody`](super::Multibody) system: its rotation, [`SO3`], its translation, [`R3`],
/// or both, `(SO3, R3)`. The group of a term between two bodies, `N = 2`, is a [`Pair`] of these.
#[diagnostic::on_unimplemented(
    message = "a term on `{Self}` isn't one on a body of a system",
    label = "not the group of a body",
    note = "bodies have a rotation and a translation: declare the term on `group = SO3`, on `group(d = R3)`, or on both, `group(F = SO3, d = R3)`",
    note = "a term between two bodies is on two of these, `group(F_1 = SO3, F_2 = SO3)` for example"
)]
pub trait BodyPart<const N: usize = 1>: LieGroup<Scalar = f64> {
    /// The part of the bodies' configurations.
    fn of(bodies: [&Body; N]) -> Self;

    /// The part of increments `F − I`.
    fn of_increments(increments: [&Increment; N]) -> Self::Matrix;

    /// The part of each body's components, those of the rotation before those of the translation.
    fn of_components(components: [&Vector6<f64>; N]) -> Self::Vector;

    /// The components of each body with zeros where this part has none.
    fn in_bodies(part: &Self::Vector) -> [Vector6<f64>; N];

    /// The blocks of a matrix of the bodies with zeros where this part has no entries.
    fn squares_in_bodies(part: &SquareOf<Self>) -> [[Matrix6<f64>; N]; N];
}

impl BodyPart for Body {
    fn of([body]: [&Body; 1]) -> Self {
        *body
    }

    fn of_increments([increment]: [&Increment; 1]) -> Increment {
        *increment
    }

    fn of_components([components]: [&Vector6<f64>; 1]) -> Vector6<f64> {
        *components
    }

    fn in_bodies(part: &Vector6<f64>) -> [Vector6<f64>; 1] {
        [*part]
    }

    fn squares_in_bodies(part: &Matrix6<f64>) -> [[Matrix6<f64>; 1]; 1] {
        [[*part]]
    }
}

impl<G: Pair<Body: BodyPart> + LieGroup<Scalar = f64>> BodyPart<2> for G {
    fn of(bodies: [&Body; 2]) -> Self {
        let [first, second] = bodies.map(|body| G::Body::of([body]));
        G::pair(&first, &second)
    }

    fn of_increments(increments: [&Increment; 2]) -> Self::Matrix {
        let [first, second] = increments.map(|increment| G::Body::of_increments([increment]));
        G::matrices(&first, &second)
    }

    fn of_components(components: [&Vector6<f64>; 2]) -> Self::Vector {
        let [first, second] = components.map(|components| G::Body::of_components([components]));
        G::joined(&first, &second)
    }

    fn in_bodies(part: &Self::Vector) -> [Vector6<f64>; 2] {
        G::parts(part).map(|part| G::Body::in_bodies(&part)[0])
    }

    fn squares_in_bodies(part: &SquareOf<Self>) -> [[Matrix6<f64>; 2]; 2] {
        G::blocks(part).map(|row| row.map(|block| G::Body::squares_in_bodies(&block)[0][0]))
    }
}

/// Implements the trait for a factor of the body, whose components begin at this one.
macro_rules! factor {
    ($group:ty, $factor:tt, $first:literal) => {
        impl BodyPart for $group {
            fn of([body]: [&Body; 1]) -> Self {
                body.$factor
            }

            fn of_increments([increment]: [&Increment; 1]) -> Self::Matrix {
                increment.$factor
            }

            fn of_components([components]: [&Vector6<f64>; 1]) -> Vector3<f64> {
                components.fixed_rows::<3>($first).into_owned()
            }

            fn in_bodies(part: &Vector3<f64>) -> [Vector6<f64>; 1] {
                let mut all = Vector6::zeros();
                all.fixed_rows_mut::<3>($first).copy_from(part);
                [all]
            }

            fn squares_in_bodies(part: &Matrix3<f64>) -> [[Matrix6<f64>; 1]; 1] {
                let mut all = Matrix6::zeros();
                all.fixed_view_mut::<3, 3>($first, $first).copy_from(part);
                [[all]]
            }
        }
    };
}

factor!(SO3, 0, 0);
factor!(R3, 1, 3);
