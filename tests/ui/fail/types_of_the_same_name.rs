use liestep::{SO3, lagrangian};

struct Inertia;

struct Vector3<T>([T; 3]);

#[lagrangian(group = SO3, l_d = ((F - I) * A * (F - I).transpose()).trace() / h - h * v.dot(&(F * v)))]
struct Body {
    A: Inertia,
    v: Vector3<f64>,
}

fn main() {}
