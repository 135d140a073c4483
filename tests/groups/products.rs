//! The laws of a product of groups, of its retraction and of what several bodies see, on the same group as matrices: a
//! product is the group of block-diagonal ones.

use liestep::groups::{CayleyRetraction, Configuration, Factor, LieGroup, Relative, Retraction, SE2, SeenFrom};
use liestep::numbers::{Blocks, Mask};
use liestep::prelude::*;
use nalgebra::{Matrix3, Matrix6, SMatrix, Vector3, Vector6};

type Product = (SO3, SE2);

/// The elements of the product as matrices with two blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Embedded(Matrix6<f64>);

fn blocks(matrix: &Matrix6<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
    (matrix.fixed_view::<3, 3>(0, 0).into_owned(), matrix.fixed_view::<3, 3>(3, 3).into_owned())
}

fn matrix((first, second): &(Matrix3<f64>, Matrix3<f64>)) -> Matrix6<f64> {
    let mut matrix = Matrix6::zeros();
    matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(first);
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(second);
    matrix
}

impl Embedded {
    fn product(&self) -> Product {
        Product::from_matrix_unchecked(blocks(&self.0))
    }

    fn of(product: &Product) -> Self {
        Self(matrix(&product.matrix()))
    }
}

impl LieGroup for Embedded {
    type Scalar = f64;
    type Vector = Vector6<f64>;
    type Matrix = Matrix6<f64>;

    const DIMENSION: usize = Product::DIMENSION;
    const FACTORS: Blocks = Product::FACTORS;

    fn identity() -> Self {
        Self::of(&Product::identity())
    }

    fn compose(&self, right: &Self) -> Self {
        Self::of(&self.product().compose(&right.product()))
    }

    fn inverse(&self) -> Self {
        Self::of(&self.product().inverse())
    }

    fn matrix(&self) -> Matrix6<f64> {
        self.0
    }

    fn from_matrix_unchecked(matrix: Matrix6<f64>) -> Self {
        Self(matrix)
    }

    fn hat(components: &Vector6<f64>) -> Matrix6<f64> {
        matrix(&Product::hat(components))
    }

    fn vee(matrix: &Matrix6<f64>) -> Vector6<f64> {
        Product::vee(&blocks(matrix))
    }

    fn adjoint(&self, velocity: &Vector6<f64>) -> Vector6<f64> {
        self.product().adjoint(velocity)
    }

    fn adjoint_transpose(&self, momentum: &Vector6<f64>) -> Vector6<f64> {
        self.product().adjoint_transpose(momentum)
    }

    fn lie_bracket(xi: &Vector6<f64>, eta: &Vector6<f64>) -> Vector6<f64> {
        Product::lie_bracket(xi, eta)
    }

    fn lie_bracket_transpose(xi: &Vector6<f64>, momentum: &Vector6<f64>) -> Vector6<f64> {
        Product::lie_bracket_transpose(xi, momentum)
    }

    fn from_increment(increment: &Matrix6<f64>) -> Self {
        let across = increment - matrix(&blocks(increment));
        Self(Self::of(&Product::from_increment(&blocks(increment))).0 + across)
    }

    fn increment(&self) -> Matrix6<f64> {
        matrix(&self.product().increment())
    }

    fn inverse_increment(increment: &Matrix6<f64>) -> Matrix6<f64> {
        matrix(&Product::inverse_increment(&blocks(increment)))
    }

    fn change(&self, increment: &Matrix6<f64>) -> Matrix6<f64> {
        matrix(&self.product().change(&blocks(increment)))
    }

    fn advance(&self, increment: &Matrix6<f64>) -> Self {
        Self::of(&self.product().advance(&blocks(increment)))
    }

    fn adjoint_transpose_increment(increment: &Matrix6<f64>, momentum: &Vector6<f64>) -> Vector6<f64> {
        Product::adjoint_transpose_increment(&blocks(increment), momentum)
    }

    fn defect(&self) -> f64 {
        self.product().defect() + (self.0 - matrix(&blocks(&self.0))).norm()
    }
}

macro_rules! factor {
    ($place:literal: $of:ty, $entry:tt) => {
        impl Factor<$place> for Embedded {
            type Of = $of;

            fn factor(&self) -> $of {
                self.product().$entry
            }

            fn of_matrix(matrix: &Matrix6<f64>) -> Matrix3<f64> {
                blocks(matrix).$entry
            }

            fn components(joined: &Vector6<f64>) -> Vector3<f64> {
                <Product as Factor<$place>>::components(joined)
            }
        }
    };
}

factor!(0: SO3, 0);
factor!(1: SE2, 1);

/// The product's own Cayley map.
struct ByFactors;

impl Retraction<Embedded> for ByFactors {
    fn increment(xi: &Vector6<f64>) -> Matrix6<f64> {
        matrix(&<CayleyRetraction as Retraction<Product>>::increment(xi))
    }

    fn local_coordinates(element: &Embedded) -> Option<Vector6<f64>> {
        <CayleyRetraction as Retraction<Product>>::local_coordinates(&element.product())
    }

    fn tangent(xi: &Vector6<f64>) -> Matrix6<f64> {
        <CayleyRetraction as Retraction<Product>>::tangent(xi)
    }

    fn is_near_identity(xi: &Vector6<f64>) -> Mask<f64> {
        <CayleyRetraction as Retraction<Product>>::is_near_identity(xi)
    }
}

mod group {
    liestep::lie_group_laws!(super::Embedded);
}

mod retraction {
    liestep::retraction_laws!(super::Embedded, super::ByFactors);
}

mod seen_by_the_first {
    liestep::advected_laws!(super::Embedded, super::SeenFrom<0, nalgebra::Vector3<f64>>);
}

mod seen_by_the_second {
    liestep::advected_laws!(super::Embedded, super::SeenFrom<1, liestep::groups::ContravariantVector<f64, 3>>);
}

mod one_seen_by_the_other {
    liestep::advected_laws!(super::Embedded, super::Relative<0, 1, nalgebra::Matrix3<f64>>);
}

mod the_second_in_space {
    liestep::advected_laws!(super::Embedded, super::Configuration<1, nalgebra::Matrix3<f64>>);
}

/// Each body is near on its own.
#[test]
fn a_product_is_near_where_all_its_factors_are() {
    let near = |x: f64, y: f64| {
        let xi = Vector6::new(x, 0.0, 0.0, y, 0.0, 0.0);
        <CayleyRetraction as Retraction<(SO3, SO3)>>::is_near_identity(&xi)
    };
    assert!(near(1.9, 1.9) && !near(2.1, 0.0) && !near(0.0, 2.1));
}

/// Where roundings have taken one of them from the group, the other stays as it is.
#[test]
fn what_is_far_is_restored_by_itself() {
    let good = SO3::from(nalgebra::UnitQuaternion::from_scaled_axis(Vector3::new(0.3, -0.4, 0.9)));
    let bad = SO3::from_matrix_unchecked(good.matrix() * (1.0 + 1e-9));
    assert!((good, good).restored().is_none());
    let (restored, _) = (good, bad).restored().unwrap();
    assert_eq!(restored.0, good);
    assert!(restored.1.defect() < 1e-15 && (good, bad).defect() > 1e-9);
}

type Four = (SO3, SE2, SO3, SE2);

/// Three and four factors are in the order of the tuple, and their components too.
#[test]
fn components_are_in_the_order_of_the_factors() {
    type Three = (SO3, SE2, SO3);
    let xi = SMatrix::<f64, 9, 1>::from_fn(|k, _| f64::from(u8::try_from(k).unwrap()));
    assert_eq!(<Three as Factor<1>>::components(&xi), Vector3::new(3.0, 4.0, 5.0));
    assert_eq!(Three::hat(&xi).2, SO3::hat(&Vector3::new(6.0, 7.0, 8.0)));
    assert_eq!(Three::vee(&Three::hat(&xi)), xi);
    assert!(Three::FACTORS.end_at(3) && Three::FACTORS.end_at(6) && !Three::FACTORS.end_at(4));
    let xi = SMatrix::<f64, 12, 1>::from_fn(|k, _| f64::from(u8::try_from(k).unwrap()));
    assert_eq!(<Four as Factor<3>>::components(&xi), Vector3::new(9.0, 10.0, 11.0));
    assert_eq!(Four::vee(&Four::hat(&xi)), xi);
    assert_eq!(Four::DIMENSION, 12);
    let f = <CayleyRetraction as Retraction<Four>>::retract(&(xi * 0.05));
    let back = <CayleyRetraction as Retraction<Four>>::local_coordinates(&f).unwrap();
    assert!((back - xi * 0.05).norm() < 1e-14);
}

/// In a table, one factor after the other.
#[test]
fn numbers_of_a_product_are_those_of_its_factors() {
    let names: Vec<_> = Product::named_numbers().into_iter().map(|(name, unit)| format!("{name} {unit}")).collect();
    let expected = "q_w_1 1,q_x_1 1,q_y_1 1,q_z_1 1,\
        g_11_2 ,g_12_2 ,g_13_2 ,g_21_2 ,g_22_2 ,g_23_2 ,g_31_2 ,g_32_2 ,g_33_2 ";
    assert_eq!(names.join(","), expected);
    let components: Vec<_> = Product::named_components().into_iter().map(|(name, units)| (name, units[0])).collect();
    let expected = [("x_1", "rad/s"), ("y_1", "rad/s"), ("z_1", "rad/s"), ("1_2", ""), ("2_2", ""), ("3_2", "")];
    assert_eq!(components, expected.map(|(name, unit)| (name.to_owned(), unit)));

    let second = SE2::from_matrix_unchecked(Matrix3::new(0.6, -0.8, 3.0, 0.8, 0.6, 4.0, 0.0, 0.0, 1.0));
    // The quaternion before was the other one.
    let mut numbers = [0.0; 14];
    numbers[0] = -1.0;
    assert_eq!((SO3::identity(), second).write_numbers(&mut numbers).len(), 1);
    let expected: [f64; 14] = [-1.0, 0.0, 0.0, 0.0, 0.6, -0.8, 3.0, 0.8, 0.6, 4.0, 0.0, 0.0, 1.0, 0.0];
    assert!(numbers.iter().zip(expected).all(|(number, expected)| (number - expected).abs() < 1e-15), "{numbers:?}");
}
