use liestep::{NonstandardInertia, SO3, lagrangian};

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * h * (1.0 / h).sin() * F.trace(),
)]
struct Top {
    J_d: NonstandardInertia,
}

fn main() {}
