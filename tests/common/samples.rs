//! One body for each declaration, without any symmetry that the declaration doesn't have.

use declarations::{
    CayleyTop, ElasticFlow, FourthOrderBody, FourthOrderTop, FreeBody, FullTop, HeavyTop, LogTop, LogTraceTop, Magnet,
    OrbitingBody, Satellite, SixthOrderTop, SlidingTop, Spring, TetheredPlate, Top, UnderwaterBody,
};
use liestep::groups::{CovariantTensor, LieGroup, SL2};
use liestep::prelude::*;
use nalgebra::{
    Matrix2, Matrix3, Matrix4, Point2, Point3, UnitComplex, UnitQuaternion, Vector2, Vector3, Vector4, Vector6,
};

/// The initial attitude and velocity of a motion.
pub type Start<G> = (G, <G as LieGroup>::Vector);

/// Calls `$check` in a test of its own for each declaration.
#[macro_export]
macro_rules! every_system {
    ($check:ident: $($name:ident)+) => {
        $(
            #[test]
            fn $name() {
                $check(&$crate::samples::$name(), stringify!($name));
            }
        )+
    };
    ($check:ident) => {
        $crate::every_system! {
            $check: heavy_top full_top free_body log_trace_top cayley_top log_top fourth_order_top sixth_order_top
            fourth_order_body satellite orbiting_body spring sliding_top magnet underwater_body tethered_plate elastic_flow
        }
    };
}
pub use every_system;

pub const MOMENTS: Vector3<f64> = Vector3::new(2.0, 3.0, 4.5);

fn turned_inertia() -> NonstandardInertia {
    let axes = rotation().to_rotation_matrix().into_inner();
    let principal = DiagonalNonstandardInertia::from_principal_moments(MOMENTS).unwrap().to_matrix();
    NonstandardInertia::new(axes * principal * axes.transpose()).unwrap()
}

fn rotation() -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(Vector3::new(0.8, -0.3, 0.4))
}

pub fn on_so3() -> Start<SO3> {
    (rotation().into(), Vector3::new(0.5, 1.0, -1.5))
}

pub fn on_se2() -> Start<SE2> {
    let motion = SE2::from_rotation_and_translation(UnitComplex::new(0.8), Vector2::new(0.5, -0.2));
    (motion, Vector3::new(1.2, 0.4, -0.3))
}

pub fn on_se3() -> Start<SE3> {
    let motion = SE3::from_rotation_and_translation(rotation(), Vector3::new(0.5, -0.2, 0.1));
    (motion, Vector6::new(0.5, 1.0, -0.8, 0.3, 0.9, -0.4))
}

/// A start near a circular orbit of [`orbiting_body`], with a spin so fast that the motion is regular.
pub fn in_orbit() -> Start<SE3> {
    let motion = SE3::from_rotation_and_translation(rotation(), Vector3::zeros());
    let velocity = rotation().inverse_transform_vector(&Vector3::new(-0.4, 0.9, 0.0));
    (motion, Vector6::new(0.1, 0.2, 2.0, velocity.x, velocity.y, velocity.z))
}

pub fn on_sl2() -> Start<SL2> {
    (SL2::try_from(Matrix2::new(1.5, 0.5, 1.0, 1.0)).unwrap(), Vector3::new(0.4, -0.3, 0.8))
}

pub fn heavy_top() -> HeavyTop {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(MOMENTS).unwrap();
    HeavyTop { J_d, m: 1.0, g: 9.81, rho: Vector3::new(0.3, 0.2, 0.4), up: Vector3::z() }
}

pub fn full_top() -> FullTop {
    FullTop { J_d: turned_inertia(), m: 1.0, g: 9.81, rho: Vector3::new(0.3, 0.2, 0.4), up: Vector3::z() }
}

pub fn free_body() -> FreeBody {
    FreeBody { J_d: turned_inertia() }
}

pub fn log_trace_top() -> LogTraceTop {
    LogTraceTop { I1: 3.0, weight: 5.0, rho: Vector3::new(0.1, 0.2, 0.9), up: Vector3::z() }
}

/// Any of the tops that are declared with the same parameters.
fn top<L: Top>() -> L {
    let J = Inertia::from_principal_moments(MOMENTS).unwrap();
    L::new(J, 9.81, Vector3::new(0.3, 0.2, 0.4), Vector3::z())
}

pub fn cayley_top() -> CayleyTop {
    top()
}

pub fn log_top() -> LogTop {
    top()
}

pub fn fourth_order_top() -> FourthOrderTop {
    top()
}

pub fn sixth_order_top() -> SixthOrderTop {
    top()
}

pub fn fourth_order_body() -> FourthOrderBody {
    FourthOrderBody { J: Inertia::from_principal_moments(MOMENTS).unwrap() }
}

/// A satellite so near to the centre that the potential is far from its expansion.
pub fn satellite() -> Satellite {
    let (tip, centre) = (Vector3::new(0.4, 0.3, 1.0), Vector3::new(2.0, 1.0, -1.5));
    Satellite { J_d: turned_inertia(), m: 0.5, tip, GM: 20.0, centre }
}

pub fn orbiting_body() -> OrbitingBody {
    let (m1, m2) = (0.8, 0.5);
    let (p1, p2) = (Point3::new(0.2, 0.1, 0.3), Point3::new(-0.25, 0.1, -0.35));
    // The inertia of both masses, and of a light frame about the origin.
    let own = Matrix4::from_diagonal(&Vector4::new(0.3, 0.2, 0.1, 0.3));
    let moment = |p: Point3<f64>| p.to_homogeneous() * p.to_homogeneous().transpose();
    let J = own + m1 * moment(p1) + m2 * moment(p2);
    let centre = Point3::new(4.5, 2.0, -3.0);
    OrbitingBody { J, m1, p1, m2, p2, GM: 6.0, centre }
}

pub fn spring() -> Spring {
    let (rho, anchor) = (Vector3::new(0.3, 0.2, 0.8), Vector3::new(1.0, 0.2, -1.2));
    Spring { J_d: turned_inertia(), k: 12.0, length: 0.7, rho, anchor }
}

pub fn sliding_top() -> SlidingTop {
    SlidingTop { J_d: turned_inertia(), m: 1.2, g: 9.81, rho: Vector3::new(0.3, 0.2, 0.9), up: Vector3::z() }
}

pub fn magnet() -> Magnet {
    Magnet {
        J_d: turned_inertia(),
        m: Vector3::new(1.0, -0.4, 2.0),
        Q: Matrix3::new(1.0, 0.3, -0.2, 0.3, -1.4, 0.5, -0.2, 0.5, 0.4),
        field: Vector3::new(0.8, 0.3, 1.5),
        gradient: CovariantTensor(Matrix3::new(0.9, -0.4, 0.6, -0.4, 0.7, 0.2, 0.6, 0.2, -1.6)),
    }
}

pub fn underwater_body() -> UnderwaterBody {
    UnderwaterBody {
        J: Matrix4::from_diagonal(&Vector4::new(1.2, 0.8, 0.5, 0.0)),
        M: Matrix4::from_diagonal(&Vector4::new(1.0, 1.8, 3.0, 0.0)),
        origin: Point3::new(0.1, 0.0, -0.2),
        weight: Vector4::new(0.2, -0.1, -1.5, 0.6),
        height: Vector4::z(),
    }
}

pub fn tethered_plate() -> TetheredPlate {
    TetheredPlate {
        J: Matrix3::new(0.8, 0.1, 0.2, 0.1, 0.5, -0.1, 0.2, -0.1, 1.5),
        k: 6.0,
        length: 0.8,
        p: Point2::new(0.4, -0.3),
        anchor: Point2::new(1.5, 1.0),
    }
}

pub fn elastic_flow() -> ElasticFlow {
    ElasticFlow { M: Matrix2::new(2.0, 0.4, 0.4, 1.2), k: 1.5, metric: CovariantTensor(Matrix2::identity()) }
}
