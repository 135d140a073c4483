use liestep::groups::{R3, SE3};
use liestep::mechanics::{Effect, Term as _};
use liestep::{NonstandardInertia, SO3, Stepper, force, lagrangian};
use nalgebra::{Translation3, Vector3};

#[lagrangian(group = SO3, l_d = (F * J_d).trace() / h)]
enum Enumeration {
    Body(NonstandardInertia),
}

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * vee * F.trace())]
struct Top0 {
    J_d: NonstandardInertia,
    vee: f64,
}

#[lagrangian(group = SO3, l_d = -h * log * F.trace())]
struct Top1 {
    log: f64,
}

#[lagrangian(group = SO3, l_d = -h * exp * F.trace())]
struct Top2 {
    exp: f64,
}

#[lagrangian(group = SO3, l_d = -h * h * F.trace())]
struct Top3 {
    h: f64,
}

#[lagrangian(group = SO3, l_d = -h * (F * I).trace())]
struct Matrix {
    I: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Unused {
    J_d: NonstandardInertia,
    F: f64,
}

#[force(group = SO3, work = h * eta * eta_next[0])]
struct Push {
    eta: f64,
}

#[force(group = SO3, work = h * vee.dot(&eta))]
struct Turn {
    vee: Vector3<f64>,
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

#[lagrangian(group = SE3, advected(w = up), l_d = -h * w.dot(&(F * rho)))]
struct Body {
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = R3, l_d = m * (F - I).norm_squared() / (2.0 * h) - h * k.dot(&(F * k)))]
struct Point {
    m: f64,
    k: Vector3<f64>,
}

#[lagrangian(group(h = SO3), l_d = ((h - I) * J_d * (h - I).transpose()).trace() / (2.0 * h))]
struct Step {
    J_d: NonstandardInertia,
}

#[lagrangian(group(vee = SO3), l_d = ((vee - I) * J_d * (vee - I).transpose()).trace() / (2.0 * h))]
struct Function {
    J_d: NonstandardInertia,
}

#[lagrangian(group(J_d = SO3), l_d = ((J_d - I) * J_d * (J_d - I).transpose()).trace() / (2.0 * h))]
struct OfAField {
    J_d: NonstandardInertia,
}

#[lagrangian(group(w = SO3), advected(w = up), l_d = ((w - I) * J_d * (w - I).transpose()).trace() / (2.0 * h) - h * w.z)]
struct Advected {
    J_d: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(group(G = SO3), velocity = G, l = 0.5 * G.dot(&(J_d * G)))]
struct Velocity {
    J_d: NonstandardInertia,
}

#[lagrangian(
    group(I = SO3, up = SO3, space = SO3, F = SO3),
    advected(w = up.seen_from(F)),
    l_d = ((F - I) * J_1 * J_2 * (F - I).transpose()).trace() / (2.0 * h) - h * w.z,
)]
struct Several {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = h * J_d.trace())]
struct NoIncrement {
    J_d: NonstandardInertia,
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

#[lagrangian(group = SO3, advected(w = up), l_d = h * J_d.trace())]
struct SeveralUnused {
    J_d: NonstandardInertia,
    m: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = (F * J_d).trace() / h)]
struct TupleStruct(NonstandardInertia);

// Who uses them reads no second message.
fn run() {
    let _ =
        |scene: Enumeration| (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), Enumeration::DERIVATION);
    let _ = |scene: FieldTypeUnknown| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), FieldTypeUnknown::DERIVATION)
    };
    let _ =
        |scene: FieldUnused| (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), FieldUnused::DERIVATION);
    let _ =
        |scene: ScalarsMixed| (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), ScalarsMixed::DERIVATION);
    let _ = |scene: SeveralMistakes| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), SeveralMistakes::DERIVATION)
    };
    let _ =
        |scene: TupleStruct| (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), TupleStruct::DERIVATION);
}

fn main() {}
