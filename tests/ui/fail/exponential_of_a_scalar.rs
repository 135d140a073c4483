use liestep::{SO3, lagrangian};

#[lagrangian(
    group = SO3,
    l_d = vee(F).norm_squared() * exp(m) / h,
)]
struct Body {
    m: f64,
}

fn main() {}
