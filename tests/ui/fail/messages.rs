//! How the compiler shows our messages: what they underline, and that who uses the struct reads no second one.

use liestep::mechanics::{Effect, Term as _};
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::{Translation3, Vector3};

macro_rules! use_of {
    ($($scene:ident)*) => {$(
        let _ = |scene: $scene| (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), $scene::DERIVATION);
    )*};
}

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

#[lagrangian(group = SO3, advected(w = up), l_d = -h * w.dot(F * rho))]
struct ReferenceMissing {
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = (F * J_d).trace() / h)]
enum Enumeration {
    Body(NonstandardInertia),
}

#[lagrangian(group = SO3, advected(w = up), l_d = -h * w.dot(&(rho + F * rho)))]
struct FieldTypeUnknown {
    rho: Translation3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct FieldUnused {
    J_d: NonstandardInertia,
    m: f64,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * w.dot(&(rho + F * rho)) - h * m * F.trace(),
)]
struct ScalarsMixed {
    J_d: NonstandardInertia,
    m: f32,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = upp), l_d = (F * J_d).tracee() / (2 * h) - h * w.dot(&(roh + F * rho)) * m)]
struct SeveralMistakes {
    J_d: NonstandardInertia,
    m: f32,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = (F * J_d).trace() / h)]
struct TupleStruct(NonstandardInertia);

// What is asked for doesn't add a message to that of the mistake.
#[lagrangian(group = SO3, gradients, l_d = ((F - I) * K * (F - I).transpose()).trace() / (2.0 * h))]
struct Misspelt {
    J_d: NonstandardInertia,
}

#[lagrangian(l_d = (F * J_d).trace() / h)]
struct GroupMissing {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO4, l_d = (F * J_d).trace() / h)]
struct GroupUnknown {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = { println!("{h}"); (F * J_d).trace() / h })]
struct StatementInABlock {
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

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).tranpose()).trace() / (2.0 * h))]
struct UnknownMethod {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, advected(w = up), l_d = -h * w.dot(&(roh + F * rho)))]
struct UnknownName {
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

#[lagrangian(group = SO3, l_d = -h * (F * rho).dot(&rho).abs())]
struct NotSmooth {
    rho: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = (F - I) * J_d * (F - I).transpose() / (2.0 * h))]
struct LagrangianNotAScalar {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = -h * (m + rho).dot(&(F * rho)))]
struct VectorAddedToScalar {
    m: f64,
    rho: Vector3<f64>,
}

fn main() {
    use_of!(AdvectedAsAValue AdvectedFieldMissing AdvectedFieldNotAVector ReferenceMissing Enumeration FieldTypeUnknown FieldUnused ScalarsMixed SeveralMistakes TupleStruct GroupMissing GroupUnknown StatementInABlock ArgumentUnknown CommaMissing IntegerLiteral LagrangianMissing LagrangianUnfinished UnknownMethod UnknownName NestedTooDeep NotSmooth LagrangianNotAScalar VectorAddedToScalar);
}
