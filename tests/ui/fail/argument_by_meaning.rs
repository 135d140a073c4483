use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(SO3, ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Nameless {
    J_d: NonstandardInertia,
}

#[lagrangian(group = "SO3", l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Quoted {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)")]
struct Text {
    J_d: NonstandardInertia,
}

#[lagrangian(group: SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Colon {
    J_d: NonstandardInertia,
}

#[lagrangian(group = (SO3), l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Parentheses {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, crate = "liestep", l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Crate {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, advected(w = "up"), l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Field {
    J_d: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected("w" = up), l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Name {
    J_d: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = self.up), l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Own {
    J_d: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = (F @ J_d).trace() / h)]
struct At {
    J_d: NonstandardInertia,
}

fn main() {}
