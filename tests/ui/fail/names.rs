use liestep::mechanics::{Effect, Term as _};
use liestep::{NonstandardInertia, SO3, Stepper, force, lagrangian};
use nalgebra::Vector3;

#[lagrangian(group = SO3, retraction = Cayley, l_d = (F * J_d).trace() / h)]
struct ArgumentFarFromAll {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, group = SO3, l_d = (F * J_d).trace() / h)]
struct ArgumentTwice {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, advect(w = up), l_d = (F * J_d).trace() / h - h * w.dot(&(F * rho)))]
struct ArgumentUnknown {
    J_d: NonstandardInertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3 l_d = (F * J_d).trace() / h)]
struct CommaMissing {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = -h * (F * rho).w)]
struct ComponentUnknown {
    rho: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = if h > 0.0 { (F * J_d).trace() / h } else { 0.0 })]
struct Condition {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Body {
    J_d: NonstandardInertia,
}

#[force(group = SO3, work = h * J_d.trace() * eta[0])]
#[liestep::lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Damped {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = F.trace() / h)]
fn top() {}

#[lagrangian(group = SO3, l_d = -h * sin(m))]
struct FunctionInsteadOfMethod {
    m: f64,
}

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2 * h))]
struct IntegerLiteral {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3)]
struct LagrangianMissing {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = (F * J_d).trace() /)]
struct LagrangianUnfinished {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0_f64 * h))]
struct LiteralSuffix {
    J_d: NonstandardInertia,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * w.dot(),
)]
struct MethodWithoutItsArgument {
    J_d: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * k * F.trace() - h * k * k,
)]
struct NameUnknownTwice {
    J_d: NonstandardInertia,
}

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * f64::consts::PI * F.trace(),
)]
struct Path {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = -h (m * F.trace()))]
struct ProductWithoutAStar {
    m: f64,
}

#[lagrangian(group = SO3, l_d = m * F.trace() / h - h * atan(m))]
struct UnknownFunction {
    m: f64,
}

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).tranpose()).trace() / (2.0 * h))]
struct UnknownMethod {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = (F * J_d).determinant() / h)]
struct UnknownMethodFarFromAll {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, advected(w = up), l_d = -h * w.dot(&(roh + F * rho)))]
struct UnknownName {
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

// Who uses them reads no second message.
fn run() {
    let _ = |scene: ArgumentUnknown| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), ArgumentUnknown::DERIVATION)
    };
    let _ =
        |scene: CommaMissing| (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), CommaMissing::DERIVATION);
    let _ = |scene: IntegerLiteral| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), IntegerLiteral::DERIVATION)
    };
    let _ = |scene: LagrangianMissing| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), LagrangianMissing::DERIVATION)
    };
    let _ = |scene: LagrangianUnfinished| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), LagrangianUnfinished::DERIVATION)
    };
    let _ = |scene: UnknownMethod| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), UnknownMethod::DERIVATION)
    };
    let _ =
        |scene: UnknownName| (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), UnknownName::DERIVATION);
}

fn main() {}
