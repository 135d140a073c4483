use liestep::mechanics::{Effect, Term as _};
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::Vector3;

#[lagrangian(group = SO3, l_d = { let d = F - I; (d * J_d).trace() / h; })]
struct BlockEndsWithASemicolon {
    J_d: NonstandardInertia,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let inverse = |A: nalgebra::Matrix3<f64>| A.transpose();
        -h * k * w.dot(&(inverse(F) * w))
    },
)]
struct Inverse {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = { let exp = |x: f64| x * x; k * F.trace() / h - h * exp(w.z) })]
struct Exponential {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = { let F = w.z; -h * k * F })]
struct Increment {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = { let h = w.z; k * F.trace() / h - h * h })]
struct Step {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let U = |h: f64, I: f64| h * I;
        k * F.trace() / h - h * U(w.z, w.x)
    },
)]
struct Parameters {
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1), v = up.seen_from(F_2)),
    l_d = {
        let U = |F_2: Vector3<f64>| F_2.z;
        ((F_1 - I) * J * (F_1 - I).transpose() + (F_2 - I) * J * (F_2 - I).transpose()).trace() / (2.0 * h)
            - h * k * (U(w) + U(v))
    },
)]
struct Factor {
    J: NonstandardInertia,
    k: f64,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = { let d = F - I; (F * J_d).trace() / h })]
struct LetUnused {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = { let (a, b) = (F, I); ((a - b) * J_d).trace() / h })]
struct LetWithAPattern {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = { let d: Matrix3<f64> = F - I; (d * J_d).trace() / h })]
struct LetWithAType {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = { let d; (d * J_d).trace() / h })]
struct LetWithoutAValue {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = { println!("{h}"); (F * J_d).trace() / h })]
struct StatementInABlock {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = { let d = (F - I) * J_d; d.dott(&d) / h })]
struct UnknownMethodOnALet {
    J_d: NonstandardInertia,
}

// Who uses them reads no second message.
fn run() {
    let _ = |scene: StatementInABlock| {
        (Stepper::new(scene, 0.01).unwrap().scene().validate().is_ok(), StatementInABlock::DERIVATION)
    };
}

fn main() {}
