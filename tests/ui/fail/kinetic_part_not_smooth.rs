use liestep::{SO3, lagrangian};

#[lagrangian(group = SO3, l_d = k * (F - I).norm() / h)]
struct Body {
    k: f64,
}

fn main() {}
