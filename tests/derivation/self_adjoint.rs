//! Self-adjointness of declarations, as the macro determines it.

#![allow(dead_code)] // no declaration here is stepped

use declarations::{CayleyTop, FullTop, OrbitingBody, TetheredPlate};
use liestep::groups::{ContravariantVector, LieGroup as _, SE3};
use liestep::mechanics::{DiscreteLagrangian, Effect as _};
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{Matrix4, Point3, UnitQuaternion, Vector3, Vector4};

/// The kinetic term of (3.13) with all of the potential at one end.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * weight * w.dot(&rho),
)]
struct OneEnd {
    J_d: NonstandardInertia,
    weight: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

/// The kinetic term of Bobenko and Suris.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = -(2.0 * I1 / h) * ((1.0 + F.trace()) / 4.0).ln() - 0.5 * h * weight * w.dot(&(rho + F * rho)),
)]
struct LogTrace {
    I1: f64,
    weight: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

/// A rigid body by `J = ∫ X Xᵀ dm` in homogeneous coordinates: isometries preserve its terms, which the normal form
/// can't use.
#[lagrangian(group = SE3, l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h))]
struct Body {
    J: Matrix4<f64>,
}

/// Added mass `a` along the first axis, for the translation in the body frame at the beginning of the step only.
#[lagrangian(group = SE3, l_d = (((F - I) * J * (F - I).transpose()).trace() + a * F[(0, 3)].powi(2)) / (2.0 * h))]
struct AddedMass {
    J: Matrix4<f64>,
    a: f64,
}

/// A body whose point `p` is attracted by a point of space.
#[lagrangian(
    group = SE3,
    advected(c = centre),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h)
        + 0.5 * h * k * (1.0 / (c - p).norm() + 1.0 / (c - F * p).norm()),
)]
struct PointBody {
    J: Matrix4<f64>,
    k: f64,
    p: Point3<f64>,
    centre: Point3<f64>,
}

/// The attracted body with vectors in place of points: `F` doesn't preserve distances of vectors.
#[lagrangian(
    group = SE3,
    advected(c = centre),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h)
        + 0.5 * h * k * (1.0 / (c - p).norm() + 1.0 / (c - F * p).norm()),
)]
struct AttractedVector {
    J: Matrix4<f64>,
    k: f64,
    p: Vector4<f64>,
    centre: ContravariantVector<f64, 4>,
}

/// The added mass at the beginning and at the end, in equal parts.
#[lagrangian(
    group = SE3,
    l_d = {
        let at_the_end = F[(0, 0)] * F[(0, 3)] + F[(1, 0)] * F[(1, 3)] + F[(2, 0)] * F[(2, 3)];
        let squares = 0.5 * (F[(0, 3)].powi(2) + at_the_end.powi(2));
        (((F - I) * J * (F - I).transpose()).trace() + a * squares) / (2.0 * h)
    },
)]
struct SymmetricAddedMass {
    J: Matrix4<f64>,
    a: f64,
}

// The constant is available at compile time, as a composition requires.
const _: () = assert!(FullTop::FACTS.is_self_adjoint && !OneEnd::FACTS.is_self_adjoint);

/// The constant, after checks that the text states it with this sign and with these words on how it was found.
fn found<L: DiscreteLagrangian>(sign: &str, how: &str) -> Option<bool> {
    let (sign, how) = (format!(" {sign} −l_d(F⁻¹, "), format!(" −h)    [{how}"));
    let mut lines = L::DERIVATION.lines().filter(|line| line.contains(&sign) && line.contains(&how));
    lines.next().map(|_| L::FACTS.is_self_adjoint)
}

#[test]
fn it_is_found_by_the_normal_forms() {
    let found = [found::<FullTop>, found::<CayleyTop>, found::<LogTrace>].map(|of| of("=", "by the normal forms"));
    assert_eq!(found, [Some(true); 3]);
}

#[test]
fn it_is_found_at_random_points() {
    let how = "at random points, a wrong one would pass with a probability below 2⁻";
    let all = [found::<Body>, found::<SymmetricAddedMass>, found::<PointBody>];
    let all = all.into_iter().chain([found::<OrbitingBody>, found::<TetheredPlate>]);
    assert!(all.map(|of| of("=", how)).all(|found| found == Some(true)));
}

#[test]
fn it_is_missing() {
    let how = "at random points";
    assert_eq!([found::<OneEnd>("≠", how), found::<AddedMass>("≠", how)], [Some(false); 2]);
    let how = "equal, at random points, if all vectors have 1 for their last coordinate";
    assert_eq!(found::<AttractedVector>("≠", how), Some(false));
}

/// The declaration as a point is used as a hypothesis: of the four coordinates three remain.
#[test]
fn points_are_a_hypothesis() {
    assert!(PointBody::DERIVATION.contains("p₄ = 1, c₄ = 1"), "{}", PointBody::DERIVATION);
    assert!(!AttractedVector::DERIVATION.contains("₄ = 1"));
}

/// The value for a point is that for the vector of its homogeneous coordinates.
#[test]
fn points_are_homogeneous_vectors() {
    let J = Matrix4::from_diagonal(&Vector4::new(1.0, 2.0, 3.0, 1.5));
    let (p, centre) = (Point3::new(0.3, -0.2, 0.5), Point3::new(2.0, 1.0, -1.5));
    let points = PointBody { J, k: 2.0, p, centre };
    let vectors =
        AttractedVector { J, k: 2.0, p: p.to_homogeneous(), centre: ContravariantVector(centre.to_homogeneous()) };
    let f = SE3::from_rotation_and_translation(UnitQuaternion::new(p.coords), Vector3::new(0.1, 0.7, -0.4)).matrix();
    let moved = ContravariantVector(f * vectors.centre.0);
    let [of_points, of_vectors] = [
        [
            points.legendre_minus(&f, &f.transform_point(&centre), 0.1),
            points.legendre_plus(&f, &f.transform_point(&centre), 0.1),
        ],
        [vectors.legendre_minus(&f, &moved, 0.1), vectors.legendre_plus(&f, &moved, 0.1)],
    ];
    for (a, b) in of_points.iter().zip(of_vectors) {
        assert!((a - b).norm() < 1e-13 * b.norm(), "{a} {b}");
    }
}

/// The text contains the declared function.
#[test]
fn values_agree_with_the_words() {
    let (rho, up) = (Vector3::new(0.3, -0.2, 0.5), Vector3::z());
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 1.5, 1.0)).unwrap();
    let f = *nalgebra::Rotation3::new(Vector3::new(0.3, -0.2, 0.1)).matrix();
    let (w, h) = (Vector3::new(0.1, 0.7, -0.4), 0.1);
    let (both, one) = (FullTop { J_d, m: 2.0, g: 1.5, rho, up }, OneEnd { J_d, weight: 3.0, rho, up });
    let back = (f.transpose(), f.transpose() * w, -h);
    assert!((both.l_d(&f, &w, h) + both.l_d(&back.0, &back.1, back.2)).abs() < 1e-14);
    assert!((one.l_d(&f, &w, h) + one.l_d(&back.0, &back.1, back.2)).abs() > 1e-3);
}
