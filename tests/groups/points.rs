//! Points, moved by groups of affine maps.

use liestep::groups::{Advected, Heisenberg, LieGroup as _, R1, R2, R3, SE2, SE3};
use liestep::laws::samples::{MatrixLieGroup, ROUNDING, Random};
use nalgebra::{Isometry2, Isometry3, Point, Point2, Point3, SMatrix, Translation3, UnitComplex, UnitQuaternion};

/// The action on a point of `N − 1` coordinates is an action, and the identity leaves it unchanged.
macro_rules! points_are_acted_on {
    ($($name:ident: $group:ty, $size:literal, $coordinates:literal;)+) => {$(
        #[test]
        fn $name() {
            let mut random = Random::new(61);
            for f in random.elements::<$group, $size, { <$group>::DIMENSION }>() {
                let g: $group = random.element();
                let p: Point<f64, $coordinates> = random.sample();
                assert_eq!(p.seen_from(&<$group>::identity()), p);
                let advected = |p: Point<f64, $coordinates>, f: &$group| Advected::<$group>::advect(&p, &f.increment());
                let (at_once, in_turn) = (p.seen_from(&g.compose(&f)), advected(p.seen_from(&g), &f));
                assert!(distance(&at_once, &in_turn, &f, &g) < ROUNDING, "{at_once} {in_turn}");
                let back = advected(advected(p, &f), &f.inverse());
                assert!(distance(&back, &p, &f, &g) < ROUNDING, "{back} {p}");
                let moved = f.inverse().matrix() * p.to_homogeneous();
                let seen: Point<f64, $coordinates> = p.seen_from(&f);
                assert!(distance(&seen, &Point::from_homogeneous(moved).unwrap(), &f, &g) < ROUNDING);
            }
        }
    )+};
}

/// The distance of two points, relative to the elements' displacements.
fn distance<G, const N: usize, const M: usize, const D: usize>(
    p: &Point<f64, N>,
    q: &Point<f64, N>,
    f: &G,
    g: &G,
) -> f64
where
    G: MatrixLieGroup<M, D>,
{
    let size = |g: &G| -> f64 {
        let matrix: SMatrix<f64, M, M> = g.matrix();
        matrix.norm() * g.inverse().matrix().norm()
    };
    (p - q).norm() / (size(f) * size(g)).powi(2)
}

points_are_acted_on! {
    of_the_plane_by_motions: SE2, 3, 2;
    of_space_by_motions: SE3, 4, 3;
    of_the_line_by_translations: R1, 2, 1;
    of_the_plane_by_translations: R2, 3, 2;
    of_space_by_translations: R3, 4, 3;
    of_the_plane_by_shears: Heisenberg, 3, 2;
}

/// The action agrees with nalgebra's isometries.
#[test]
fn motions_are_isometries() {
    let (angle, shift) = (0.7, nalgebra::Vector2::new(0.3, -1.2));
    let plane = Isometry2::new(shift, angle);
    let motion = SE2::from_rotation_and_translation(UnitComplex::new(angle), shift);
    let p = Point2::new(1.5, -0.4);
    assert!((p.seen_from(&motion) - plane.inverse_transform_point(&p)).norm() < 1e-15);
    let (rotation, shift) = (UnitQuaternion::from_euler_angles(0.3, -0.8, 1.1), nalgebra::Vector3::new(0.3, -1.2, 2.0));
    let space = Isometry3::from_parts(Translation3::from(shift), rotation);
    let motion = SE3::from_rotation_and_translation(rotation, shift);
    let p = Point3::new(1.5, -0.4, 0.2);
    assert!((p.seen_from(&motion) - space.inverse_transform_point(&p)).norm() < 1e-15);
    let advected = Advected::<SE3>::advect(&p, &motion.increment());
    assert!((advected - space.inverse_transform_point(&p)).norm() < 1e-14);
}

/// The change of a vector by a small step has all its digits: it isn't a difference of positions.
#[test]
fn small_changes_are_exact() {
    let (rotation, shift) = (UnitQuaternion::identity(), nalgebra::Vector3::new(1e-12, 0.0, 0.0));
    let p = Point3::new(1.0, 2.0, 3.0);
    let change = Advected::<SE3>::change(&p, &SE3::from_rotation_and_translation(rotation, shift).increment());
    assert_eq!(change, Point3::new(-1e-12, 0.0, 0.0));
}
