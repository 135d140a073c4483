use liestep::groups::SE3;
use liestep::mechanics::{Effect, Term as _};
use liestep::{NonstandardInertia, SO3, Stepper, force, lagrangian};
use nalgebra::{Matrix2, Point2, Point3, Vector3};

#[lagrangian(
    group = Line,
    generators = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]], [[2.0, -1.0], [0.0, 0.0]]],
    l_d = m * ((F - I) * (F - I).transpose()).trace() / (2.0 * h),
)]
struct GeneratorsDependent {
    m: f64,
}

type Line = ();

#[lagrangian(
    group = Turned,
    generators = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [1e-13, 0.0]]],
    l_d = m * ((F - I) * (F - I).transpose()).trace() / (2.0 * h),
)]
struct GeneratorsNotClosed {
    m: f64,
}

type Turned = ();

#[lagrangian(
    group = SO3,
    generators = [[[0.0, -1.0], [1.0, 0.0]]],
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Body {
    J_d: NonstandardInertia,
}

#[force(group = liestep::SO3, generators = [[[0.0, -1.0], [1.0, 0.0]]], work = h * tau.dot(&eta))]
struct Push {
    tau: Vector3<f64>,
}

#[lagrangian(
    group = Own,
    generators = [[[0, -1], [1, 0]]],
    l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Integers {
    A: Matrix2<f64>,
}

#[lagrangian(group = Own, generators = [[[0.0, -1.0]]], l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h))]
struct Oblong {
    A: Matrix2<f64>,
}

#[lagrangian(group = Own, generators = [], l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h))]
struct Nothing {
    A: Matrix2<f64>,
}

#[lagrangian(
    group = Own,
    generators = [[[0.0, 0.5 + 0.5], [1.0, 0.0]]],
    l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Sum {
    A: Matrix2<f64>,
}

#[lagrangian(group = Own, generators = 5.0, l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h))]
struct Number {
    A: Matrix2<f64>,
}

#[lagrangian(
    group = Own,
    generators = [[[0.0, -1.0], 1.0]],
    l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Row {
    A: Matrix2<f64>,
}

#[lagrangian(
    group = Own,
    generators = [[[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]]],
    l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Large {
    A: Matrix2<f64>,
}

#[lagrangian(l_d = (F * J_d).trace() / h)]
struct GroupMissing {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO4, l_d = (F * J_d).trace() / h)]
struct GroupUnknown {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3<f64>, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct GroupWithArgumentsBody {
    J_d: NonstandardInertia,
}

#[lagrangian(group = liestep::SO3::<f64>, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Path {
    J_d: NonstandardInertia,
}

#[lagrangian(group = Affine<f64>!, l_d = m * (F - I).norm_squared() / h)]
struct Own {
    m: f64,
}

#[force(group = SO3<'static>, work = h * tau.dot(&eta))]
struct GroupWithArgumentsPush {
    tau: Vector3<f64>,
}

liestep::groups::matrix_group! {
    type Open = [[[0.0, 1.0], [0.0, 0.0]], [[0.0, 0.0], [1.0, 0.0]]];

    fn relation<T: nalgebra::RealField + Copy>(_: &nalgebra::SMatrix<T, 2, 2>) -> T {
        T::zero()
    }
}

liestep::groups::matrix_group! {
    type Idle = [[[0.0, 1.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 0.0]]];

    fn relation<T: nalgebra::RealField + Copy>(_: &nalgebra::SMatrix<T, 2, 2>) -> T {
        T::zero()
    }
}

#[lagrangian(group = SE3, l_d = -h * (F * p)[0])]
struct PointOfAnotherSize {
    p: Point2<f64>,
}

#[lagrangian(group = SO3, advected(c = centre), l_d = -h * c.dot(&(F * c)))]
struct PointOffTheAffineGroups {
    centre: Point3<f64>,
}

// Who uses them reads no second message.
fn run() {
    let _ =
        |scene: GroupMissing| (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), GroupMissing::DERIVATION);
    let _ =
        |scene: GroupUnknown| (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), GroupUnknown::DERIVATION);
}

fn main() {}
