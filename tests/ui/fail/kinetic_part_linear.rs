use liestep::{SO3, lagrangian};

#[lagrangian(group = SO3, l_d = k * ((F - I).norm_squared() + F[(0, 1)]) / h)]
struct Body {
    k: f64,
}

fn main() {}
