use liestep::groups::{MixedTensor, SE3};
use liestep::mechanics::{Effect, Term as _};
use liestep::{NonstandardInertia, SO3, Stepper, force, lagrangian};
use nalgebra::{Matrix3, Vector3};

#[lagrangian(group = SO3, advected = up, l_d = -h * w.dot(&(rho + F * rho)))]
struct AdvectedAsAValue {
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = upp), l_d = -h * w.dot(&(rho + F * rho)))]
struct AdvectedFieldMissing {
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = -h * F[(2, 2)] * w[0])]
struct AdvectedFieldNotAVector {
    up: f64,
}

#[lagrangian(group = SO3, l_d = -h * w.dot(&(rho + F * rho)))]
struct AdvectedNameNotDeclared {
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(up = up), l_d = -h * up.dot(&(F * rho)))]
struct AdvectedNameOfAField {
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(F = up), l_d = -h * w.dot(&(F * rho)))]
struct Top {
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(log = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * log.dot(&rho),
)]
struct Logarithm {
    J_d: NonstandardInertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[force(group = SO3, advected(eta = up), work = h * eta.dot(&eta_next))]
struct Push {
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct AdvectedNameUnused {
    J_d: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(group = SE3, advected(S = field), l_d = -h * S[(0, 0)] * F[(0, 3)])]
struct AdvectedTensorOfAnotherSize {
    field: MixedTensor<f64, 3>,
}

#[lagrangian(
    group = SO3,
    advected(a = up, b = north, c = east, d = sun, e = moon, f = star, g = magnet),
    l_d = -h * (a + b + c + d + e + f + g).dot(&(F * rho)),
)]
struct AdvectedTooMany {
    rho: Vector3<f64>,
    up: Vector3<f64>,
    north: Vector3<f64>,
    east: Vector3<f64>,
    sun: Vector3<f64>,
    moon: Vector3<f64>,
    star: Vector3<f64>,
    magnet: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up, w = up), l_d = -h * w.dot(&(rho + F * rho)))]
struct AdvectedTwice {
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SE3, advected(w = up), l_d = -h * w[0] * F[(0, 3)])]
struct AdvectedVectorOfAnotherSize {
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(up), l_d = -h * w.dot(&(rho + F * rho)))]
struct AdvectedWithoutAName {
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = (((F - I) * A * (F - I).transpose()).trace() - k * (F * B).trace()) / h)]
struct MatrixNotPromisedToBeSymmetric {
    k: f64,
    A: Matrix3<f64>,
    B: Matrix3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = -h * w.dot(F * rho))]
struct ReferenceMissing {
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = -h * w.dot(&(F * rho)) - h * up.dot(&rho))]
struct SpatialFieldUsed {
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    l_d = {
        let a = F.trace() + F[(0, 1)] + F[(0, 2)] + F[(1, 0)];
        let b = (F * A).trace() + A[(0, 1)] + A[(0, 2)] + A[(1, 0)];
        (a + b).powi(4) / h
    },
)]
struct TooManyTerms {
    A: Matrix3<f64>,
}

// Who uses them reads no second message.
fn run() {
    let _ = |scene: AdvectedAsAValue| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), AdvectedAsAValue::DERIVATION)
    };
    let _ = |scene: AdvectedFieldMissing| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), AdvectedFieldMissing::DERIVATION)
    };
    let _ = |scene: AdvectedFieldNotAVector| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), AdvectedFieldNotAVector::DERIVATION)
    };
    let _ = |scene: ReferenceMissing| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), ReferenceMissing::DERIVATION)
    };
}

fn main() {}
