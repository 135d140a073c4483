use liestep::groups::SE2;
use liestep::mechanics::{Effect, Term as _};
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::{Matrix3, Vector3};

#[lagrangian(group = SO3, l_d = (J_d / F).trace() / h)]
struct DivisionByAMatrix {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = vee(F).norm_squared() * exp(m) / h)]
struct ExponentialOfAScalar {
    m: f64,
}

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * F[(0, i)])]
struct IndexNotANumber {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * m[0])]
struct IndexOfAScalar {
    J_d: NonstandardInertia,
    m: f64,
}

#[lagrangian(group = SO3, l_d = -h * (F * rho)[3])]
struct IndexOutOfRange {
    rho: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = { let J = A + A.transpose(); vee(F).dot(&(inverse(J) * vee(F))) / h })]
struct InverseOfAnExpression {
    A: Matrix3<f64>,
}

#[lagrangian(group = SO3, l_d = (F - I) * J_d * (F - I).transpose() / (2.0 * h))]
struct LagrangianNotAScalar {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = log(vee(F)).norm_squared() / h + 0.0 * m)]
struct LogarithmOfAVector {
    m: f64,
}

#[lagrangian(group = SE2, l_d = m * log(F).norm_squared() / h)]
struct LogarithmOffTheRotations {
    m: f64,
}

#[lagrangian(group = SO3, l_d = rho.trace() * F.trace() / h)]
struct MethodOfAnotherShape {
    rho: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = (J_d * F).trace(I) / h)]
struct MethodWithAnArgumentTooMany {
    J_d: NonstandardInertia,
}

// Over `f64` all of these are right.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let mean = 0.5 * (rho + F * rho);
        let turned = m * rho;
        -h * (w.dot(&mean) + (h * F * turned).z)
    },
)]
struct NumberBeforeAVector<T> {
    m: T,
    rho: Vector3<T>,
    up: Vector3<T>,
}

#[lagrangian(group = SO3, l_d = ((F - 1.0) * J_d).trace() / h)]
struct ScalarSubtractedFromMatrix {
    J_d: NonstandardInertia,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * w.transpose() * F * rho,
)]
struct Row {
    J_d: NonstandardInertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * m * (F * J_d))]
struct Untraced {
    J_d: NonstandardInertia,
    m: f64,
}

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * (F * rho))]
struct Lever {
    J_d: NonstandardInertia,
    rho: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = -h * (m + rho).dot(&(F * rho)))]
struct VectorAddedToScalar {
    m: f64,
    rho: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = -h * (rho * F).dot(&rho))]
struct VectorTimesMatrix {
    rho: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * w * rho,
)]
struct VectorTimesVector {
    J_d: NonstandardInertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

// Who uses them reads no second message.
fn run() {
    let _ = |scene: LagrangianNotAScalar| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), LagrangianNotAScalar::DERIVATION)
    };
    let _ = |scene: VectorAddedToScalar| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), VectorAddedToScalar::DERIVATION)
    };
}

fn main() {}
