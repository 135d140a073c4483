use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

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

fn main() {}
