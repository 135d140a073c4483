use liestep::{SO3, lagrangian};

#[lagrangian(
    group = SO3,
    l_d = log(vee(F)).norm_squared() / h + 0.0 * m,
)]
struct Body {
    m: f64,
}

fn main() {}
