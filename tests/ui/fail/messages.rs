//! Messages in the compiler: the tokens that they underline, and no second message where the struct is used.

use liestep::groups::{R3, matrix_group};
use liestep::mechanics::{Effect, Term as _};
use liestep::methods::Constraint;
use liestep::{NonstandardInertia, SO3, Stepper, constraint, lagrangian};
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

// A mistake in a declaration with `gradients` gives no second message.
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

// A declaration that can't be read gives no second message where it is used.
#[lagrangian(group(I = SO3), l_d = ((I - I) * J_d * (I - I).transpose()).trace() / (2.0 * h))]
struct IncrementCalledAsTheIdentity {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, advected(w = up), l_d = (F * J_d).trace() / h - h * w.z)]
struct AdvectedText {
    J_d: NonstandardInertia,
    up: String,
}

#[lagrangian(group = SO3, given(u = missing), l_d = (F * J_d).trace() / h - h * u)]
struct GivenMissing {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = { use core::f64::consts::PI; PI * (F * J_d).trace() / h })]
struct UseInABlock {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = (F * J_d).trace() / h; gradients)]
struct Semicolon {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3,, l_d = (F * J_d).trace() / h)]
struct TwoCommas {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, crate = 3, l_d = (F * J_d).trace() / h)]
struct CrateIsANumber {
    J_d: NonstandardInertia,
}

#[lagrangian(group(d_1 = R3, d_2 = R3), l_d = m * (d_1.dot(&d_2) + d_3.norm_squared()) / (2.0 * h))]
struct IncrementNotDeclared {
    m: f64,
}

#[constraint(group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected(y = d_2.seen_from(d_1)), zero = y.z - k)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct LengthNotDeclared {}

fn held(joint: LengthNotDeclared) -> &'static str {
    Constraint::<1>::name(&joint)
}

// A wrong group is reported once, and not again in a declaration with it.
matrix_group! {
    pub type Crooked = [[[1.0, 2.0]]];
}

#[lagrangian(group = Crooked!, l_d = k * F[(0, 1)].powi(2) / h)]
struct OnCrooked {
    k: f64,
}

fn main() {
    use_of!(IncrementCalledAsTheIdentity AdvectedText GivenMissing UseInABlock Semicolon TwoCommas CrateIsANumber IncrementNotDeclared);
    use_of!(AdvectedAsAValue AdvectedFieldMissing AdvectedFieldNotAVector ReferenceMissing Enumeration FieldTypeUnknown FieldUnused ScalarsMixed SeveralMistakes TupleStruct GroupMissing GroupUnknown StatementInABlock ArgumentUnknown CommaMissing IntegerLiteral LagrangianMissing LagrangianUnfinished UnknownMethod UnknownName NestedTooDeep NotSmooth LagrangianNotAScalar VectorAddedToScalar);
}
