use liestep::mechanics::{Effect, Term as _};
use liestep::{NonstandardInertia, SO3, Stepper, force, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * w.dot(&rho) * m / (m - m),
)]
struct DivisorZero {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 1.0 / 0.0 * h * m * w.dot(&rho),
)]
struct DivisorZeroLiteral {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = -h * m * w.dot(&rho) / (F - F).trace())]
struct DivisorZeroTrace {
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = -h * (F * rho).dot(&rho).powi(2.5))]
struct ExponentNotAWholeNumber {
    rho: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = -h * (F * rho).dot(&rho).powi(17))]
struct ExponentTooLarge {
    rho: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = -h * (w.dot(&rho).max(0.0) + w.dot(&(F * rho)).signum()))]
struct Maximum {
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    l_d = ((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((F)))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))).trace() / h,
)]
struct NestedTooDeep {
    J_d: NonstandardInertia,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * m * (-w.norm_squared() - rho.norm_squared()).ln(),
)]
struct NoValueAnywhere {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = -h * (F * rho).dot(&rho).abs())]
struct NotSmooth {
    rho: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = -h * m * (F - I).norm() * w.dot(&rho))]
struct PotentialNotSmooth {
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = -h * m * log(F).norm() * w.dot(&rho))]
struct PotentialOfALength {
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = -h * m * (w.dot(&(F * rho)) - w.dot(&rho)).sqrt())]
struct PotentialOfARoot {
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = h * (((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h * h) - m * w.dot(&rho) / h),
)]
struct PotentialOverStep {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = -h * m * w.dot(&rho) / (3.0 - F.trace()))]
struct PotentialWithAPole {
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = -0.5 * h * h * m * w.dot(&(rho + F * rho)))]
struct PotentialWithASquareOfTheStep {
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = -0.5 * m * w.dot(&(rho + F * rho)))]
struct PotentialWithoutStep {
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * h * (1.0 / h).sin() * F.trace(),
)]
struct StepUnderAFunction {
    J_d: NonstandardInertia,
}

#[force(group = SO3, work = 0.5 * tau.dot(&(eta + eta_next)) - c * vee(F).dot(&eta))]
struct Push {
    tau: Vector3<f64>,
    c: f64,
}

#[force(group = SO3, work = -c * vee(F).dot(&eta) / h)]
struct Drag {
    c: f64,
}

#[force(group = SO3, work = -h * c * vee(F).dot(&eta))]
struct VanishingDrag {
    c: f64,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * m * w.dot(&rho) * 0.0 / 0.0,
)]
struct ZeroOverZero {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

// Who uses them reads no second message.
fn run() {
    let _ = |scene: NestedTooDeep| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), NestedTooDeep::DERIVATION)
    };
    let _ = |scene: NotSmooth| (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), NotSmooth::DERIVATION);
}

fn main() {}
