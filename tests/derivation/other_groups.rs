//! Lagrangians on groups other than SO(3): on the largest, and with all kinds of advected parameters, every derived
//! term compared with central differences of the declared `l_d` and the staged step with the unstaged terms; and
//! reversible steps.

use checks::random::Random;
use checks::structure::{System, momenta, reversal, stages};
use liestep::groups::{ContravariantTensor, ContravariantVector, CovariantTensor, MixedTensor};
use liestep::groups::{R2, SE23, SL2, SO2, SU2};
use liestep::lagrangian;
use nalgebra::{Matrix4, SMatrix, SVector, Vector2, Vector3, Vector4};

/// A planar pendulum.
#[lagrangian(
    group = SO2,
    advected(w = up),
    l_d = inertia * (2.0 - F.trace()) / h - 0.5 * h * weight * w.dot(&(rho + F * rho)),
)]
#[derive(Clone)]
struct Pendulum {
    inertia: f64,
    weight: f64,
    rho: Vector2<f64>,
    up: Vector2<f64>,
}

/// An extended pose, with matrices of a size for which nalgebra has no names.
#[lagrangian(
    group = SE23,
    advected(w = covector),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * k * w.dot(&(r + F * r)),
)]
#[derive(Clone)]
struct ExtendedPose {
    J: SMatrix<f64, 5, 5>,
    k: f64,
    r: SVector<f64, 5>,
    covector: SVector<f64, 5>,
}

/// A top in unit quaternions, with a potential that changes under a rotation by 2π.
#[lagrangian(
    group = SU2,
    advected(w = up),
    l_d = ((F - I) * J * (F - I).transpose()).trace() * 2.0 / h - 0.5 * h * k * w.dot(&(rho + F * rho)),
)]
#[derive(Clone)]
struct Quaternion {
    J: Matrix4<f64>,
    k: f64,
    rho: Vector4<f64>,
    up: Vector4<f64>,
}

/// A particle in the plane, in uniform gravity.
#[lagrangian(
    group = R2,
    advected(w = up),
    l_d = m * (F - I).norm_squared() / (2.0 * h) - 0.5 * h * m * g * w.dot(&(origin + F * origin)),
)]
#[derive(Clone)]
struct Particle {
    m: f64,
    g: f64,
    origin: Vector3<f64>,
    up: Vector3<f64>,
}

/// A system with every kind of advected parameter on SL(2), whose representation isn't orthogonal.
#[lagrangian(
    group = SL2,
    advected(w = covector, v = vector, S = tensor, B = form, A = map),
    l_d = {
        let potential = w.dot(&(F * r)) + (F.transpose() * covariant).dot(&v) + (S * F).trace() + (B * F * r).dot(&r)
            + (A * F).trace() * w.dot(&v) + (S * B).trace() + (A * S * F).trace();
        ((F - I) * (F - I).transpose()).trace() * m / (2.0 * h) - 0.5 * h * potential
    },
)]
struct Kinds {
    m: f64,
    r: Vector2<f64>,
    covariant: Vector2<f64>,
    covector: Vector2<f64>,
    vector: ContravariantVector<f64, 2>,
    tensor: ContravariantTensor<f64, 2>,
    form: CovariantTensor<f64, 2>,
    map: MixedTensor<f64, 2>,
}

fn kinds() -> Kinds {
    let mut r = Random::new(8);
    Kinds {
        m: 1.5,
        r: column(&mut r),
        covariant: column(&mut r),
        covector: column(&mut r),
        vector: ContravariantVector(column(&mut r)),
        tensor: ContravariantTensor(tensor(&mut r)),
        form: CovariantTensor(tensor(&mut r)),
        map: MixedTensor(tensor(&mut r)),
    }
}

/// A symmetric positive definite matrix.
pub(crate) fn tensor<const N: usize>(r: &mut Random) -> SMatrix<f64, N, N> {
    let root = SMatrix::<f64, N, N>::from_fn(|_, _| r.signed());
    root * root.transpose() + SMatrix::identity()
}

pub(crate) fn column<const N: usize>(r: &mut Random) -> SVector<f64, N> {
    SVector::from_fn(|_, _| r.signed())
}

fn pendulum() -> Pendulum {
    Pendulum { inertia: 1.3, weight: 9.81, rho: Vector2::new(0.1, -0.4), up: Vector2::y() }
}

fn extended_pose() -> ExtendedPose {
    let mut r = Random::new(3);
    ExtendedPose { J: tensor(&mut r), k: 0.7, r: column(&mut r), covector: column(&mut r) }
}

fn quaternion() -> Quaternion {
    let mut r = Random::new(2);
    Quaternion { J: tensor(&mut r), k: 0.7, rho: column(&mut r), up: column(&mut r) }
}

fn particle() -> Particle {
    Particle { m: 2.0, g: 9.81, origin: Vector3::z(), up: Vector3::y() }
}

/// Compares the derived terms with the declared `l_d`, and the step in stages with the terms.
fn derived_terms(system: &impl System) {
    momenta::assert_momenta(system, 3);
    stages::assert_stages(system, 4);
}

/// The largest group; `tests/long/random_lagrangians` has the others.
#[test]
fn se23() {
    derived_terms(&extended_pose());
}

/// All five kinds at once, each in a term of its own and in one with another.
#[test]
fn kinds_of_advected_parameters() {
    derived_terms(&kinds());
}

/// If `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)`, a step of `−h` undoes one of `h`; `tests/systems/structure.rs` has other
/// groups, and `one_sided.rs` there the counterexamples.
#[test]
fn self_adjoint_declarations_reverse() {
    let ours = [
        reversal::error_of_return(&pendulum(), 0.01, 9),
        reversal::error_of_return(&extended_pose(), 0.01, 9),
        reversal::error_of_return(&quaternion(), 0.01, 9),
        reversal::error_of_return(&particle(), 0.01, 9),
    ];
    assert!(ours.iter().all(|&error| error <= 1e-14), "{ours:?}");
}
