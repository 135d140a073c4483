//! Controls of `group_laws.rs`: each law refuses a group, a retraction or a parameter that violates it.

use liestep::groups::{Advected, CayleyRetraction, ExponentialRetraction, LieGroup, Retraction, SE2};
use liestep::laws::{advected, group, retraction};
use liestep::numbers::{Coordinates, Entries};
use nalgebra::{Matrix3, Vector3};
use std::panic::catch_unwind;

/// The group SE(2) with one defect.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DefectiveGroup<const WHAT: usize>(SE2);

const PRODUCT: usize = 0;
const INVERSE: usize = 1;
const HAT: usize = 2;
const BRACKET: usize = 3;
const ADJOINT: usize = 4;
const ADJOINT_TRANSPOSE: usize = 5;
const BRACKET_TRANSPOSE: usize = 6;
const ADVANCE: usize = 7;
const ADJOINT_INCREMENT: usize = 8;
const CANCELLATION: usize = 9;
const DEFECT: usize = 10;
const NOTHING: usize = 11;
const BRACKET_SCALE: usize = 12;
const POISSON: usize = 13;
const INVERSE_INCREMENT: usize = 14;
const ADJOINT_MATRIX: usize = 15;

/// The vector with the opposite sign of its last component, for one of the defects.
fn turned<const WHAT: usize>(v: Vector3<f64>, what: usize) -> Vector3<f64> {
    if WHAT == what { Vector3::new(v.x, v.y, -v.z) } else { v }
}

impl<const WHAT: usize> LieGroup for DefectiveGroup<WHAT> {
    type Scalar = f64;
    type Vector = Vector3<f64>;
    type Matrix = Matrix3<f64>;

    const DIMENSION: usize = 3;

    fn identity() -> Self {
        Self(SE2::identity())
    }

    fn compose(&self, right: &Self) -> Self {
        Self(if WHAT == PRODUCT { right.0.compose(&self.0) } else { self.0.compose(&right.0) })
    }

    fn inverse(&self) -> Self {
        Self(if WHAT == INVERSE { SE2::from_matrix_unchecked(self.matrix().transpose()) } else { self.0.inverse() })
    }

    fn matrix(&self) -> Matrix3<f64> {
        self.0.matrix()
    }

    fn from_matrix_unchecked(matrix: Matrix3<f64>) -> Self {
        Self(SE2::from_matrix_unchecked(matrix))
    }

    fn hat(components: &Vector3<f64>) -> Matrix3<f64> {
        SE2::hat(&turned::<WHAT>(*components, HAT))
    }

    fn vee(matrix: &Matrix3<f64>) -> Vector3<f64> {
        SE2::vee(matrix)
    }

    fn adjoint(&self, velocity: &Vector3<f64>) -> Vector3<f64> {
        turned::<WHAT>(self.0.adjoint(velocity), ADJOINT)
    }

    fn adjoint_matrix(&self) -> Matrix3<f64> {
        let matrix = <Vector3<f64> as Coordinates<f64>>::square(|k| self.adjoint(&Coordinates::<f64>::axis(k)));
        if WHAT == ADJOINT_MATRIX { matrix.transpose() } else { matrix }
    }

    fn adjoint_transpose(&self, momentum: &Vector3<f64>) -> Vector3<f64> {
        turned::<WHAT>(self.0.adjoint_transpose(momentum), ADJOINT_TRANSPOSE)
    }

    fn lie_bracket(xi: &Vector3<f64>, eta: &Vector3<f64>) -> Vector3<f64> {
        let scale = if WHAT == BRACKET_SCALE { -1.0 } else { 1.0 };
        turned::<WHAT>(SE2::lie_bracket(xi, eta), BRACKET) * scale
    }

    fn lie_bracket_transpose(xi: &Vector3<f64>, momentum: &Vector3<f64>) -> Vector3<f64> {
        turned::<WHAT>(SE2::lie_bracket_transpose(xi, momentum), BRACKET_TRANSPOSE)
    }

    fn lie_poisson_bracket(momentum: &Vector3<f64>, df: &Vector3<f64>, dk: &Vector3<f64>) -> f64 {
        let dk = turned::<WHAT>(*dk, POISSON);
        -momentum.dot(&Self::lie_bracket(df, &dk))
    }

    fn from_increment(increment: &Matrix3<f64>) -> Self {
        Self(SE2::from_increment(increment))
    }

    fn increment(&self) -> Matrix3<f64> {
        self.0.increment()
    }

    fn inverse_increment(increment: &Matrix3<f64>) -> Matrix3<f64> {
        let sign = if WHAT == INVERSE_INCREMENT { -1.0 } else { 1.0 };
        Self::from_increment(increment).inverse().matrix() * increment * -sign
    }

    fn change(&self, increment: &Matrix3<f64>) -> Matrix3<f64> {
        if WHAT == ADVANCE { increment * self.matrix() } else { self.0.change(increment) }
    }

    fn adjoint_transpose_increment(increment: &Matrix3<f64>, momentum: &Vector3<f64>) -> Vector3<f64> {
        if WHAT == CANCELLATION {
            return SE2::from_increment(increment).adjoint_transpose(momentum) - momentum;
        }
        turned::<WHAT>(SE2::adjoint_transpose_increment(increment, momentum), ADJOINT_INCREMENT)
    }

    fn defect(&self) -> f64 {
        if WHAT == DEFECT { 0.0 } else { self.0.defect() }
    }
}

/// The laws of groups refuse each defect.
fn refused<const WHAT: usize>() -> Vec<&'static str> {
    type G<const WHAT: usize> = DefectiveGroup<WHAT>;
    let laws: [(&str, fn()); 10] = [
        ("group_axioms", group::group_axioms::<G<WHAT>, _, _>),
        ("hat_and_vee", group::hat_and_vee::<G<WHAT>, _, _>),
        ("brackets", group::brackets::<G<WHAT>, _, _>),
        ("adjoint_action", group::adjoint_action::<G<WHAT>, _, _>),
        ("pairings", group::pairings::<G<WHAT>, _, _>),
        ("brackets_are_derivatives", group::brackets_are_derivatives::<G<WHAT>, _, _>),
        ("variations", group::variations::<G<WHAT>, _, _>),
        ("lie_poisson_brackets", group::lie_poisson_brackets::<G<WHAT>, _, _>),
        ("increments", group::increments::<G<WHAT>, _, _>),
        ("the_relation_tells", group::the_relation_tells::<G<WHAT>, _, _>),
    ];
    laws.into_iter().filter(|(_, law)| catch_unwind(law).is_err()).map(|(name, _)| name).collect()
}

#[test]
fn laws_of_groups() {
    assert_eq!(refused::<NOTHING>(), [""; 0]);
    assert!(refused::<PRODUCT>().contains(&"group_axioms"));
    assert!(refused::<PRODUCT>().contains(&"adjoint_action"));
    assert_eq!(refused::<INVERSE>(), ["group_axioms", "increments"]);
    assert!(refused::<HAT>().contains(&"hat_and_vee"));
    for law in
        ["brackets", "adjoint_action", "pairings", "brackets_are_derivatives", "variations", "lie_poisson_brackets"]
    {
        assert!(refused::<BRACKET>().contains(&law), "{law}");
        assert!(refused::<BRACKET_SCALE>().contains(&law) || law == "adjoint_action", "{law}");
    }
    assert!(refused::<ADJOINT>().contains(&"adjoint_action"));
    assert!(refused::<ADJOINT>().contains(&"pairings"));
    assert_eq!(refused::<ADJOINT_MATRIX>(), ["adjoint_action"]);
    assert!(refused::<ADJOINT_TRANSPOSE>().contains(&"pairings"));
    assert!(refused::<BRACKET_TRANSPOSE>().contains(&"brackets_are_derivatives"));
    assert_eq!(refused::<POISSON>(), ["lie_poisson_brackets"]);
    assert_eq!(refused::<ADVANCE>(), ["increments"]);
    assert_eq!(refused::<ADJOINT_INCREMENT>(), ["increments"]);
    assert_eq!(refused::<CANCELLATION>(), ["increments"]);
    assert_eq!(refused::<INVERSE_INCREMENT>(), ["increments"]);
    assert_eq!(refused::<DEFECT>(), ["the_relation_tells"]);
}

/// A retraction of SE(2) with one defect.
struct DefectiveRetraction<const WHAT: usize>;

const HALF: usize = 0;
const OFF_THE_GROUP: usize = 1;
const COORDINATES: usize = 2;
const LEFT_TANGENT: usize = 3;
const SUBTRACTED: usize = 4;
const RIGHT: usize = 5;

impl<const WHAT: usize> Retraction<SE2> for DefectiveRetraction<WHAT> {
    fn increment(xi: &Vector3<f64>) -> Matrix3<f64> {
        match WHAT {
            HALF => <CayleyRetraction as Retraction<SE2>>::increment(&(xi * 0.5)),
            OFF_THE_GROUP => SE2::hat(xi),
            SUBTRACTED => <CayleyRetraction as Retraction<SE2>>::retract(xi).matrix() - Matrix3::identity(),
            _ => <CayleyRetraction as Retraction<SE2>>::increment(xi),
        }
    }

    fn local_coordinates(element: &SE2) -> Option<Vector3<f64>> {
        match WHAT {
            HALF => CayleyRetraction::local_coordinates(element).map(|xi: Vector3<f64>| xi * 2.0),
            COORDINATES => ExponentialRetraction::local_coordinates(element),
            _ => CayleyRetraction::local_coordinates(element),
        }
    }

    fn tangent(xi: &Vector3<f64>) -> Matrix3<f64> {
        let xi = if WHAT == LEFT_TANGENT { -xi } else { *xi };
        <CayleyRetraction as Retraction<SE2>>::tangent(&xi) * if WHAT == HALF { 0.5 } else { 1.0 }
    }

    fn is_near(_: &Vector3<f64>, _: f64) -> bool {
        true
    }
}

fn refused_retraction<const WHAT: usize>() -> Vec<&'static str> {
    type R<const WHAT: usize> = DefectiveRetraction<WHAT>;
    let laws: [(&str, fn()); 5] = [
        ("at_zero", retraction::retraction_at_zero::<SE2, R<WHAT>, _, _>),
        ("stays", retraction::retraction_stays_in_the_group::<SE2, R<WHAT>, _, _>),
        ("round_trips", retraction::retraction_round_trips::<SE2, R<WHAT>, _, _>),
        ("tangent", retraction::retraction_tangent::<SE2, R<WHAT>, _, _>),
        ("keeps_digits", retraction::retraction_keeps_digits::<SE2, R<WHAT>, _, _>),
    ];
    laws.into_iter().filter(|(_, law)| catch_unwind(law).is_err()).map(|(name, _)| name).collect()
}

#[test]
fn laws_of_retractions() {
    assert_eq!(refused_retraction::<RIGHT>(), [""; 0]);
    assert!(refused_retraction::<HALF>().contains(&"at_zero"));
    assert!(refused_retraction::<HALF>().contains(&"keeps_digits"));
    assert!(refused_retraction::<OFF_THE_GROUP>().contains(&"stays"));
    assert_eq!(refused_retraction::<COORDINATES>(), ["round_trips"]);
    assert_eq!(refused_retraction::<LEFT_TANGENT>(), ["tangent"]);
    assert!(refused_retraction::<SUBTRACTED>().contains(&"keeps_digits"));
}

/// A vector that is advected by `F w` in place of the covector's `Fᵀ w` or the vector's `F⁻¹ w`: an action from the
/// wrong side.
#[derive(Clone, Copy, Debug, PartialEq)]
struct WrongSideVector(Vector3<f64>);

impl Advected<SE2> for WrongSideVector {
    fn seen_from(&self, attitude: &SE2) -> Self {
        Self(attitude.matrix() * self.0)
    }

    fn change(&self, increment: &Matrix3<f64>) -> Self {
        Self(increment * self.0)
    }

    fn rate(&self, velocity: &Matrix3<f64>) -> Self {
        Self(velocity * self.0)
    }

    fn seen_through(&self, matrix: &Matrix3<f64>, _: &Matrix3<f64>) -> Self {
        Self(matrix * self.0)
    }

    fn is_finite(&self) -> bool {
        self.0.iter().all(|entry| entry.is_finite())
    }
}

impl Entries<f64> for WrongSideVector {
    fn from_entries(next: &mut impl FnMut() -> f64) -> Self {
        Self(Entries::from_entries(next))
    }

    fn each(&self, visit: &mut impl FnMut(f64)) {
        self.0.each(visit);
    }

    fn zip(&self, other: &Self, combine: &mut impl FnMut(f64, f64) -> f64) -> Self {
        Self(self.0.zip(&other.0, combine))
    }
}

/// A covector with one defect.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Covector<const WHAT: usize>(Vector3<f64>);

const TURNED_RATE: usize = 0;
const UNTRANSPOSED: usize = 1;
const RIGHT_COVECTOR: usize = 2;

impl<const WHAT: usize> Advected<SE2> for Covector<WHAT> {
    fn seen_from(&self, attitude: &SE2) -> Self {
        Self(attitude.matrix().transpose() * self.0)
    }

    fn change(&self, increment: &Matrix3<f64>) -> Self {
        Self(increment.transpose() * self.0)
    }

    fn rate(&self, velocity: &Matrix3<f64>) -> Self {
        Self(velocity.transpose() * self.0 * if WHAT == TURNED_RATE { -1.0 } else { 1.0 })
    }

    fn seen_through(&self, matrix: &Matrix3<f64>, _: &Matrix3<f64>) -> Self {
        Self(matrix.transpose() * self.0)
    }

    fn pulled_back(&self, attitude: &SE2) -> Self {
        if WHAT == UNTRANSPOSED { self.seen_from(attitude) } else { Self(attitude.matrix() * self.0) }
    }

    fn is_finite(&self) -> bool {
        self.0.iter().all(|entry| entry.is_finite())
    }
}

impl<const WHAT: usize> Entries<f64> for Covector<WHAT> {
    fn from_entries(next: &mut impl FnMut() -> f64) -> Self {
        Self(Entries::from_entries(next))
    }

    fn each(&self, visit: &mut impl FnMut(f64)) {
        self.0.each(visit);
    }

    fn zip(&self, other: &Self, combine: &mut impl FnMut(f64, f64) -> f64) -> Self {
        Self(self.0.zip(&other.0, combine))
    }
}

#[test]
fn laws_of_advected_parameters() {
    advected::parameter_is_acted_on::<SE2, Covector<RIGHT_COVECTOR>, _, _>();
    assert!(catch_unwind(advected::parameter_is_acted_on::<SE2, Covector<TURNED_RATE>, _, _>).is_err());
    assert!(catch_unwind(advected::parameter_is_acted_on::<SE2, Covector<UNTRANSPOSED>, _, _>).is_err());
    assert!(catch_unwind(advected::parameter_is_acted_on::<SE2, WrongSideVector, _, _>).is_err());
    // A wrong inverse makes the contravariant kinds wrong; the group's own laws alone would blame `inverse`.
    assert!(catch_unwind(advected::kinds_move_as_declared::<DefectiveGroup<INVERSE>, _, _>).is_err());
    assert!(catch_unwind(advected::kinds_act::<DefectiveGroup<PRODUCT>, _, _>).is_err());
}
